//! Damage to files: bytes, and what their formats are made of.

use std::ops::Range;

use super::random::Random;

/// What a file is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// Words, numbers and brackets.
    Text,
    /// Bytes and 32-bit words.
    Binary,
    /// Chunks of a length, a kind and as many bytes, the first of them text.
    Glb,
}

impl Form {
    /// The form of a file's bytes, most of which are text or not.
    pub fn of(bytes: &[u8]) -> Self {
        if bytes.starts_with(b"glTF") {
            Self::Glb
        } else if std::str::from_utf8(bytes).is_ok() {
            Self::Text
        } else {
            Self::Binary
        }
    }
}

/// The longest file that is made, in bytes.
const LONGEST: usize = 1 << 20;

/// One of the seeds, damaged in one to eight ways.
pub fn damaged(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    let form = Form::of(&bytes);
    for _ in 0..random.power(4) {
        match (form, random.below(3)) {
            (_, 0) => damage_bytes(random, &mut bytes, seeds),
            (Form::Text, _) => damage_text(random, &mut bytes),
            (Form::Binary, _) => damage_word(random, &mut bytes),
            (Form::Glb, 1) => damage_glb_header(random, &mut bytes),
            (Form::Glb, _) => damage_glb_text(random, &mut bytes),
        }
        bytes.truncate(LONGEST);
    }
    bytes
}

/// A range of up to `longest` of `total` bytes.
fn range(random: &mut Random, total: usize, longest: usize) -> Range<usize> {
    let start = random.below(total + 1);
    start..(start + random.below(longest + 1)).min(total)
}

fn damage_bytes(random: &mut Random, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
    let place = range(random, bytes.len(), 64);
    match random.below(7) {
        0 => {
            if let Some(byte) = bytes.get_mut(place.start) {
                *byte ^= 1 << random.below(8);
            }
        }
        1 => {
            if let Some(byte) = bytes.get_mut(place.start) {
                *byte = random.word() as u8;
            }
        }
        2 => drop(bytes.drain(place)),
        3 => bytes.truncate(place.start),
        4 => {
            let again = bytes[place.clone()].repeat(1 + random.below(40));
            bytes.splice(place.start..place.start, again);
        }
        5 => {
            let count = random.power(14);
            let byte = random.word() as u8;
            bytes.splice(place.start..place.start, vec![byte; count]);
        }
        _ => {
            let other = &seeds[random.below(seeds.len())];
            let longest = random.power(14);
            let part = range(random, other.len(), longest);
            bytes.splice(place, other[part].iter().copied());
        }
    }
}

/// Numbers that readers get wrong.
const NUMBERS: &[&str] = &[
    "NaN",
    "inf",
    "-inf",
    "1e999",
    "-1e39",
    "3.4e38",
    "1e-46",
    "-0.0",
    "0",
    "-1",
    "1",
    "2",
    "0.5",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "99999999999999999999999",
    "1_000",
    "0x1F",
    ".5",
    "5.",
    "+3",
    "1.0.0",
    "1e",
    "00012",
    "true",
];

/// Pieces of the formats in places that are not theirs.
const PIECES: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    ";",
    "=",
    "\"",
    "'",
    "r#\"",
    "\"#",
    "/*",
    "*/",
    "//",
    "\\",
    "\n",
    "\r\n",
    "\t",
    "\0",
    "\u{feff}",
    "é",
    "𝛑",
    "Some(",
    "None",
    "()",
    "[]",
    "{}",
    "null",
    "#![enable(implicit_some)]",
    "\"\\u{110000}\"",
    "\"\\ud800\"",
    "version: 2",
    "f 1 2 3\n",
    "v 0 0 0\n",
    "g body\n",
    "-",
    "/",
    "..",
    "e",
    "%00",
    "data:",
];

fn damage_text(random: &mut Random, bytes: &mut Vec<u8>) {
    let tokens = tokens(bytes);
    if tokens.is_empty() {
        return bytes.extend(random.pick(PIECES).bytes());
    }
    let token = tokens[random.below(tokens.len())].clone();
    let is_number = |token: &&Range<usize>| {
        let first = bytes[token.start];
        first.is_ascii_digit() || first == b'-'
    };
    match random.below(10) {
        0..5 => {
            let numbers: Vec<_> = tokens.iter().filter(is_number).collect();
            if !numbers.is_empty() {
                let number = numbers[random.below(numbers.len())].clone();
                bytes.splice(number, random.pick(NUMBERS).bytes());
            }
        }
        5 => drop(bytes.drain(token)),
        6 => {
            let other = tokens[random.below(tokens.len())].clone();
            let other = bytes[other].to_vec();
            bytes.splice(token, other);
        }
        7 => {
            bytes.splice(token.start..token.start, random.pick(PIECES).bytes());
        }
        8 => {
            // From this token to another, over and over.
            let last = tokens[random.below(tokens.len())].clone();
            let part = token.start.min(last.start)..token.end.max(last.end);
            let times = random.power(12).min(LONGEST / part.len().max(1));
            let again = bytes[part.clone()].repeat(times);
            bytes.splice(part.end..part.end, again);
        }
        _ => {
            let piece = random.pick(PIECES);
            let times = random.power(18);
            let many = piece.repeat(times);
            bytes.splice(token, many.into_bytes());
        }
    }
}

/// Where words, numbers and single marks stand.
fn tokens(bytes: &[u8]) -> Vec<Range<usize>> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.+".contains(&byte) || byte >= 128;
    let mut tokens: Vec<Range<usize>> = Vec::new();
    for (i, &byte) in bytes.iter().enumerate() {
        match tokens.last_mut() {
            Some(last) if last.end == i && is_word(byte) && is_word(bytes[last.start]) => {
                last.end = i + 1;
            }
            _ if byte.is_ascii_whitespace() => {}
            _ => tokens.push(i..i + 1),
        }
    }
    tokens
}

/// Words that readers get wrong: counts, infinity, NaN, a subnormal and a huge number.
const WORDS: &[&u32] = &[
    &0,
    &1,
    &2,
    &0x7FFF_FFFF,
    &0x8000_0000,
    &u32::MAX,
    &0x7F80_0000,
    &0xFF80_0000,
    &0x7FC0_0000,
    &1,
    &0x7F7F_FFFF,
    &0xFF7F_FFFF,
    &0x0080_0000,
    &64,
    &160,
];

fn damage_word(random: &mut Random, bytes: &mut [u8]) {
    // Every second time in the header.
    let words = match random.below(2) {
        0 => (bytes.len() / 4).min(10),
        _ => bytes.len() / 4,
    };
    let at = 4 * random.below(words);
    put_word(random, bytes, at);
}

fn put_word(random: &mut Random, bytes: &mut [u8], at: usize) {
    let length = bytes.len() as u32;
    let near = length.wrapping_add(random.below(9) as u32).wrapping_sub(4);
    let word = match random.below(4) {
        0 => near,
        1 => random.word() as u32 % length.max(1),
        _ => *random.pick(WORDS),
    };
    if let Some(place) = bytes.get_mut(at..at + 4) {
        place.copy_from_slice(&word.to_le_bytes());
    }
}

/// A version, a length or a kind of the file's and its chunks' headers.
fn damage_glb_header(random: &mut Random, bytes: &mut [u8]) {
    let text = json_of(bytes).end;
    let places = [4, 8, 12, 16, text, text + 4];
    let place = places[random.below(places.len())];
    put_word(random, bytes, place);
}

/// Its text as other texts are damaged, with lengths that fit again.
fn damage_glb_text(random: &mut Random, bytes: &mut Vec<u8>) {
    let place = json_of(bytes);
    let mut text = bytes[place.clone()].to_vec();
    damage_text(random, &mut text);
    let length = text.len() as u32;
    bytes.splice(place, text);
    let whole = bytes.len() as u32;
    for (at, length) in [(8, whole), (12, length)] {
        if let Some(place) = bytes.get_mut(at..at + 4) {
            place.copy_from_slice(&length.to_le_bytes());
        }
    }
}

/// Where the text of a `.glb` stands; at its end where there is none.
fn json_of(bytes: &[u8]) -> Range<usize> {
    let length = bytes
        .get(12..16)
        .map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let start = 20.min(bytes.len());
    start..start.saturating_add(length as usize).min(bytes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_seed_gives_one_file_and_others_give_others() {
        let seeds = [b"(version: 1, scale: 0.5)".to_vec(), b"[(a: 3)]".to_vec()];
        let made = |seed| damaged(&mut Random::new(seed), &seeds);
        let files: Vec<_> = (0..100).map(made).collect();
        assert_eq!(files, (0..100).map(made).collect::<Vec<_>>());
        assert!(files.iter().filter(|file| seeds.contains(file)).count() < 20);
    }

    #[test]
    fn all_forms_of_files_are_damaged_also_when_little_is_left_of_them() {
        let glb = b"glTF\x02\0\0\0\x1c\0\0\0\x08\0\0\0JSON{\"a\": 1}";
        assert_eq!(json_of(glb), 20..28);
        let seeds = [
            glb.to_vec(),
            b"\xff\xfe123456".to_vec(),
            b"a 1".to_vec(),
            Vec::new(),
        ];
        let forms: Vec<Form> = seeds.iter().map(|seed| Form::of(seed)).collect();
        assert_eq!(forms, [Form::Glb, Form::Binary, Form::Text, Form::Text]);
        for seed in 0..500 {
            assert!(damaged(&mut Random::new(seed), &seeds).len() <= LONGEST);
        }
    }

    #[test]
    fn tokens_are_words_and_marks() {
        let text = b"(a: -1.5e3,b)";
        let found: Vec<&[u8]> = tokens(text).into_iter().map(|token| &text[token]).collect();
        let expected: [&[u8]; 7] = [b"(", b"a", b":", b"-1.5e3", b",", b"b", b")"];
        assert_eq!(found, expected);
    }
}
