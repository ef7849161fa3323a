//! Changes of a preset's text in place: on texts of random layouts with comments everywhere, on the repository's own presets,
//! and on the cases that authors' habits make.

use effects::preset::edit::{self, EditError, Step, Step::Field, Step::Item};
use effects::preset::{Field as ReadField, Reader};
use effects::{Param, ParamKind, Value, Variation};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

/// A step that owns its name.
#[derive(Clone, Debug, PartialEq)]
enum Way {
    Name(String),
    Index(usize),
}

fn steps(way: &[Way]) -> Vec<Step<'_>> {
    way.iter()
        .map(|step| match step {
            Way::Name(name) => Field(name),
            Way::Index(index) => Item(*index),
        })
        .collect()
}

/// A value of a random text: where it is, what is written there, the comments that belong to it and are in it.
#[derive(Clone, Debug)]
struct Known {
    way: Vec<Way>,
    value: String,
    comments: Vec<String>,
    is_section: bool,
    /// The number of items of a list.
    items: Option<usize>,
}

/// Writes random texts.
struct Writer {
    state: u64,
    text: String,
    line_end: &'static str,
    unit: &'static str,
    count: usize,
    known: Vec<Known>,
    /// Whether the next value is a list that has items.
    list_next: bool,
}

impl Writer {
    fn new(seed: u64) -> Self {
        let mut writer = Self {
            state: seed,
            text: String::new(),
            line_end: "\n",
            unit: "    ",
            count: 0,
            known: Vec::new(),
            list_next: false,
        };
        writer.line_end = ["\n", "\n", "\r\n"][writer.below(3)];
        writer.unit = ["    ", "\t", "  "][writer.below(3)];
        writer
    }

    fn below(&mut self, most: usize) -> usize {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % most as u64) as usize
    }

    fn rarely(&mut self) -> bool {
        self.below(5) == 0
    }

    /// A comment with a number of its own, which brackets and quotes in it don't disturb.
    fn comment(&mut self, line: bool) -> String {
        self.count += 1;
        let count = self.count;
        let odd = ["", " (\"", " ]),", " /* */", " a: 1,"][self.below(5)];
        if line {
            format!("// <{count}>{odd}")
        } else {
            format!("/* <{count}>{odd} */")
        }
    }

    fn line(&mut self, depth: usize) {
        self.text += self.line_end;
        self.text += &self.unit.repeat(depth);
    }

    fn preset(mut self) -> (String, Vec<Known>) {
        if self.rarely() {
            let comment = self.comment(true);
            self.text += &comment;
            self.line(0);
        }
        self.group(&[], true, 1);
        if self.rarely() {
            self.line(0);
            let comment = self.comment(true);
            self.text += &comment;
        }
        (self.text, self.known)
    }

    /// A preset that has a list with items.
    fn preset_with_list(mut self) -> (String, Vec<Known>) {
        self.list_next = true;
        self.preset()
    }

    fn value(&mut self, way: &[Way], depth: usize) {
        if self.list_next {
            return self.group(way, false, depth);
        }
        if depth < 4 && self.below(3) == 0 {
            let is_section = self.below(2) == 0;
            return self.group(way, is_section, depth);
        }
        let leaves = [
            "1",
            "-0.5",
            "name",
            "\"text\"",
            "\"a // ( \\\" [ b\"",
            "hairline(1, 2)",
            "r#\"raw \" )\"#",
            "(1, 2)",
        ];
        let leaf = leaves[self.below(leaves.len())];
        self.text += leaf;
    }

    fn group(&mut self, way: &[Way], is_section: bool, depth: usize) {
        // On one line, each entry on its own, or broken somewhere.
        let layout = self.below(3);
        let mut count = self.below(4);
        if self.list_next {
            count += 1;
            self.list_next = is_section;
        }
        let last_has_comma = self.below(2) == 0;
        self.text += if is_section { "(" } else { "[" };
        let mut line_open = true;
        if layout != 0 && self.rarely() {
            let comment = self.comment(true);
            self.text += " ";
            self.text += &comment;
            line_open = false;
        }
        for i in 0..count {
            let starts_line = layout == 1 || !line_open || (layout == 2 && self.below(2) == 0);
            if starts_line {
                self.line(depth);
                if self.rarely() {
                    let line = self.below(2) == 0;
                    let comment = self.comment(line);
                    // Its line ends, and an empty one follows: it is nobody's.
                    self.text += &comment;
                    self.line(0);
                    self.line(depth);
                }
            } else if i > 0 {
                self.text += " ";
            }
            line_open = self.entry(
                way,
                is_section,
                i,
                [starts_line, i + 1 < count || last_has_comma, layout != 0],
                depth,
            );
        }
        if !line_open || (layout != 0 && (count == 0 || self.below(3) > 0)) {
            if self.rarely() {
                self.line(depth);
                let comment = self.comment(true);
                self.text += &comment;
            }
            self.line(depth - 1);
        }
        self.text += if is_section { ")" } else { "]" };
    }

    /// Writes an entry; whether its line is still open after it.
    fn entry(
        &mut self,
        way: &[Way],
        is_section: bool,
        i: usize,
        [starts_line, comma, may_end_line]: [bool; 3],
        depth: usize,
    ) -> bool {
        let first = self.count;
        if starts_line && self.rarely() {
            for _ in 0..1 + self.below(2) {
                let line = self.below(2) == 0;
                let comment = self.comment(line);
                self.text += &comment;
                self.line(depth);
            }
        }
        if self.rarely() {
            let comment = self.comment(false);
            self.text += &comment;
            self.text += " ";
        }
        let mut way = way.to_vec();
        if is_section {
            let name = format!("f{i}");
            self.text += &name;
            let colon = [":", ": ", " :\t"][self.below(3)];
            self.text += colon;
            way.push(Way::Name(name));
        } else {
            way.push(Way::Index(i));
        }
        let start = self.text.len();
        let at = self.known.len();
        self.value(&way, depth + 1);
        let value = self.text[start..].to_owned();
        if self.rarely() {
            let comment = self.comment(false);
            self.text += " ";
            self.text += &comment;
        }
        if comma {
            self.text += ",";
        }
        let mut line_open = true;
        if may_end_line && self.rarely() {
            let line = self.below(2) == 0;
            let comment = self.comment(line);
            self.text += " ";
            self.text += &comment;
            line_open = false;
        }
        let comments = (first + 1..=self.count).map(|count| format!("<{count}>"));
        let known = Known {
            comments: comments.collect(),
            is_section: !edit::fields(&value, &[]).is_empty() || is_empty(&value, "(", ")"),
            items: (value.starts_with('[')).then(|| edit::items(&value, &[]).len()),
            value,
            way,
        };
        self.known.insert(at, known);
        line_open
    }
}

fn is_empty(value: &str, open: &str, close: &str) -> bool {
    let inside = value.strip_prefix(open).and_then(|v| v.strip_suffix(close));
    inside.is_some() && edit::fields(value, &[]).is_empty() && edit::items(value, &[]).is_empty()
}

/// The marks of all comments, in the order of the text.
fn marks(text: &str) -> Vec<String> {
    let starts = text.match_indices('<');
    starts
        .map(|(i, _)| text[i..].split_inclusive('>').next().unwrap().to_owned())
        .collect()
}

fn sorted(mut marks: Vec<String>) -> Vec<String> {
    marks.sort();
    marks
}

/// What is there of these values but `left_out` and what is in it.
fn others<'a>(known: &'a [Known], left_out: &'a [Way]) -> impl Iterator<Item = &'a Known> {
    let apart =
        move |known: &&Known| !known.way.starts_with(left_out) && !left_out.starts_with(&known.way);
    known.iter().filter(apart)
}

/// Every section and list is read without a mistake.
fn reads(text: &str) -> Result<(), TestCaseError> {
    fn all<'a>(reader: &mut Reader<'a>, value: &'a str) {
        let is_section = !edit::fields(value, &[]).is_empty();
        if is_section {
            for field in reader.fields(value, "it") {
                all(reader, field.value);
            }
        } else if value.starts_with('[') {
            for item in reader.list(value, "it") {
                all(reader, item);
            }
        }
    }
    let mut reader = Reader::new("it", text);
    let root = edit::get(text, &[]);
    prop_assert!(root.is_some(), "{text}");
    // The root without the comments around it, as a part of the text.
    all(&mut reader, root.unwrap());
    if let Err(errors) = reader.report() {
        return Err(TestCaseError::fail(format!("{errors}\n{text}")));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn values_are_found(seed: u64) {
        let (text, known) = Writer::new(seed).preset();
        reads(&text)?;
        for one in &known {
            let way = steps(&one.way);
            prop_assert_eq!(edit::get(&text, &way), Some(&*one.value), "{:?} in {}", way, text);
            let (last, above) = one.way.split_last().unwrap();
            match last {
                Way::Name(name) => {
                    let fields = edit::fields(&text, &steps(above));
                    prop_assert!(fields.contains(&(name, &one.value)));
                }
                Way::Index(index) => {
                    prop_assert_eq!(edit::items(&text, &steps(above))[*index], &*one.value);
                }
            }
        }
    }

    #[test]
    fn a_set_value_is_there_and_nothing_else_is_changed(seed: u64, pick: prop::sample::Index) {
        let (text, known) = Writer::new(seed).preset();
        prop_assume!(!known.is_empty());
        let one = pick.get(&known);
        let way = steps(&one.way);
        let span = edit::span(&text, &way).unwrap();
        for value in ["7.25", "(a: 1, /* ( */ b: [\"]\"])", "\"// )\""] {
            let changed = edit::set(&text, &way, value).unwrap();
            prop_assert_eq!(&changed, &format!("{}{value}{}", &text[..span.start], &text[span.end..]));
            reads(&changed)?;
        }
    }

    #[test]
    fn a_field_is_added_and_removed_again(seed: u64, pick: prop::sample::Index, deep: bool) {
        let (text, known) = Writer::new(seed).preset();
        let mut sections: Vec<&[Way]> = vec![&[]];
        sections.extend(known.iter().filter(|k| k.is_section).map(|k| &k.way[..]));
        let above = pick.get(&sections);
        let mut way = above.to_vec();
        way.push(Way::Name("new".into()));
        let mut whole = way.clone();
        if deep {
            whole.push(Way::Name("inner".into()));
        }
        let added = edit::set(&text, &steps(&whole), "(1, 2)").unwrap();
        reads(&added)?;
        prop_assert_eq!(edit::get(&added, &steps(&whole)), Some("(1, 2)"));
        prop_assert_eq!(marks(&added), marks(&text), "{}\n=>\n{}", text, added);
        let is_on_one_line = !edit::get(&text, &steps(above)).unwrap().contains('\n');
        prop_assert!(!is_on_one_line || added.lines().count() == text.lines().count());
        for other in others(&known, &way) {
            prop_assert_eq!(edit::get(&added, &steps(&other.way)), Some(&*other.value));
        }

        let removed = edit::remove(&added, &steps(&way)).unwrap();
        reads(&removed)?;
        prop_assert_eq!(edit::get(&removed, &steps(&way)), None);
        prop_assert_eq!(marks(&removed), marks(&text), "{}\n=>\n{}\n=>\n{}", text, added, removed);
        for other in others(&known, &way) {
            prop_assert_eq!(edit::get(&removed, &steps(&other.way)), Some(&*other.value));
        }
        prop_assert!(text.contains('\r') || !removed.contains('\r'));
        prop_assert!(!text.contains('\r') || !removed.replace("\r\n", "").contains('\n'));
    }

    #[test]
    fn what_is_removed_goes_with_its_comments_alone(seed: u64, pick: prop::sample::Index) {
        let (text, known) = Writer::new(seed).preset();
        prop_assume!(!known.is_empty());
        let one = pick.get(&known);
        let removed = edit::remove(&text, &steps(&one.way)).unwrap();
        reads(&removed)?;
        let mut left = marks(&text);
        left.retain(|mark| !one.comments.contains(mark));
        prop_assert_eq!(marks(&removed), left, "{:?} of {}\n=>\n{}", &one.way, text, removed);
        let (last, above) = one.way.split_last().unwrap();
        match last {
            Way::Name(name) => {
                prop_assert_eq!(edit::get(&removed, &steps(&one.way)), None);
                let mut fields = edit::fields(&text, &steps(above));
                fields.retain(|(other, _)| other != name);
                prop_assert_eq!(edit::fields(&removed, &steps(above)), fields);
            }
            Way::Index(index) => {
                let mut items = edit::items(&text, &steps(above));
                items.remove(*index);
                prop_assert_eq!(edit::items(&removed, &steps(above)), items);
            }
        }
        for other in others(&known, above).filter(|_| !above.is_empty()) {
            prop_assert_eq!(edit::get(&removed, &steps(&other.way)), Some(&*other.value));
        }
    }

    #[test]
    fn items_are_inserted_and_removed_again(seed: u64, pick: prop::sample::Index, at in 0..5_usize) {
        let (text, known) = Writer::new(seed).preset_with_list();
        let lists: Vec<&Known> = known.iter().filter(|k| k.items.is_some()).collect();
        let list = pick.get(&lists);
        let way = steps(&list.way);
        let inserted = edit::insert(&text, &way, at, "(new: \"[\")").unwrap();
        reads(&inserted)?;
        let before = edit::items(&text, &way);
        let at = at.min(before.len());
        let mut items = before.clone();
        items.insert(at, "(new: \"[\")");
        prop_assert_eq!(edit::items(&inserted, &way), items);
        prop_assert_eq!(marks(&inserted), marks(&text), "{}\n=>\n{}", text, inserted);

        let item: Vec<Step> = way.iter().copied().chain([Item(at)]).collect();
        let removed = edit::remove(&inserted, &item).unwrap();
        prop_assert_eq!(edit::items(&removed, &way), before);
        prop_assert_eq!(marks(&removed), marks(&text), "{}\n=>\n{}\n=>\n{}", text, inserted, removed);
    }

    #[test]
    fn items_move_with_their_comments(seed: u64, pick: prop::sample::Index, picks: [prop::sample::Index; 2]) {
        let (text, known) = Writer::new(seed).preset_with_list();
        let lists: Vec<&Known> = known.iter().filter(|k| k.items > Some(0)).collect();
        let list = pick.get(&lists);
        let way = steps(&list.way);
        let mut items = edit::items(&text, &way);
        let [from, to] = picks.map(|pick| pick.index(items.len()));
        let moved = edit::move_item(&text, &way, from, to).unwrap();
        reads(&moved)?;
        prop_assert_eq!(sorted(marks(&moved)), sorted(marks(&text)), "{}\n=>\n{}", text, moved);
        let item = items.remove(from);
        items.insert(to, item);
        prop_assert_eq!(edit::items(&moved, &way), items, "{}\n=>\n{}", text, moved);
        // Its comments are its own there as well.
        let place: Vec<Way> = list.way.iter().cloned().chain([Way::Index(from)]).collect();
        let own = &known.iter().find(|k| k.way == place).unwrap().comments;
        let there: Vec<Step> = way.iter().copied().chain([Item(to)]).collect();
        let removed = edit::remove(&moved, &there).unwrap();
        let mut left = marks(&moved);
        left.retain(|mark| !own.contains(mark));
        prop_assert_eq!(marks(&removed), left, "{} from {} to {}\n=>\n{}", text, from, to, moved);
        // There and back is the same list.
        let back = edit::move_item(&moved, &way, to, from).unwrap();
        prop_assert_eq!(edit::items(&back, &way), edit::items(&text, &way));
    }

    #[test]
    fn damaged_texts_never_panic(seed: u64, cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<char>(), 0..6_usize), 1..4)) {
        let (mut text, known) = Writer::new(seed).preset();
        for (at, other, sort) in cuts {
            let places: Vec<usize> = text.char_indices().map(|(i, _)| i).collect();
            if places.is_empty() { break; }
            let at = *at.get(&places);
            match sort {
                0 => drop(text.remove(at)),
                1 => text.insert(at, other),
                2 => text.truncate(at),
                n => text.insert(at, [',', ':', '('][n - 3]),
            }
        }
        for one in known.iter().map(|k| &k.way[..]).chain([&[][..]]) {
            let way = steps(one);
            let _ = edit::get(&text, &way);
            let _ = edit::fields(&text, &way);
            let _ = edit::items(&text, &way);
            let field: Vec<Step> = way.iter().copied().chain([Field("new")]).collect();
            for changed in [
                edit::set(&text, &way, "1"),
                edit::set(&text, &field, "1"),
                edit::remove(&text, &way),
                edit::insert(&text, &way, 1, "1"),
                edit::move_item(&text, &way, 0, 1),
            ] {
                match changed {
                    // What came of it has brackets that match.
                    Ok(changed) => prop_assert!(edit::get(&changed, &[]).is_some(), "{} => {}", text, changed),
                    Err(error) => prop_assert!(!error.to_string().is_empty()),
                }
            }
        }
    }
}

/// Before and after a change.
type Case = (
    &'static str,
    fn(&str) -> Result<String, EditError>,
    &'static str,
);

#[test]
fn layouts() {
    let cases: &[Case] = &[
        // Added fields.
        ("()", |t| edit::set(t, &[Field("a")], "1"), "(a: 1)"),
        ("( )", |t| edit::set(t, &[Field("a")], "1"), "(a: 1)"),
        (
            "(\n)\n",
            |t| edit::set(t, &[Field("a")], "1"),
            "(\n    a: 1,\n)\n",
        ),
        (
            "(\n    // none yet\n)",
            |t| edit::set(t, &[Field("a")], "1"),
            "(\n    a: 1,\n    // none yet\n)",
        ),
        (
            "(a: 1)",
            |t| edit::set(t, &[Field("b")], " 2 "),
            "(a: 1, b: 2)",
        ),
        (
            "(a: 1,)",
            |t| edit::set(t, &[Field("b")], "2"),
            "(a: 1, b: 2,)",
        ),
        (
            "( a: 1 )",
            |t| edit::set(t, &[Field("b")], "2"),
            "( a: 1, b: 2 )",
        ),
        (
            "(\n\ta: 1 // one\n)",
            |t| edit::set(t, &[Field("b")], "2"),
            "(\n\ta: 1, // one\n\tb: 2\n)",
        ),
        (
            "(\r\n  a: 1, // one\r\n)\r\n",
            |t| edit::set(t, &[Field("b")], "2"),
            "(\r\n  a: 1, // one\r\n  b: 2,\r\n)\r\n",
        ),
        (
            "(a: 1, // one\n)",
            |t| edit::set(t, &[Field("b")], "2"),
            "(a: 1, // one\n    b: 2,\n)",
        ),
        (
            "(\n  a: 1,\n  // c: 3,\n)",
            |t| edit::set(t, &[Field("b")], "2"),
            "(\n  a: 1,\n  b: 2,\n  // c: 3,\n)",
        ),
        (
            "(\n  a: [],\n)",
            |t| edit::set(t, &[Field("p"), Field("q"), Field("r")], "2"),
            "(\n  a: [],\n  p: (q: (r: 2)),\n)",
        ),
        (
            "(a: 1, b:2)",
            |t| edit::set(t, &[Field("b")], "(x, y)"),
            "(a: 1, b:(x, y))",
        ),
        (
            "(a: (1, 2, 3))",
            |t| edit::set(t, &[Field("a"), Item(1)], "5"),
            "(a: (1, 5, 3))",
        ),
        // A comma that is missing elsewhere doesn't matter to a value.
        (
            "(a: 1 b: 2)",
            |t| edit::set(t, &[Field("b")], "3"),
            "(a: 1 b: 3)",
        ),
        // Removed ones.
        ("(a: 1)", |t| edit::remove(t, &[Field("a")]), "()"),
        ("( a: 1 )", |t| edit::remove(t, &[Field("a")]), "()"),
        (
            "(\n    a: 1,\n)",
            |t| edit::remove(t, &[Field("a")]),
            "(\n)",
        ),
        (
            "(a: 1, b: 2, c: 3)",
            |t| edit::remove(t, &[Field("a")]),
            "(b: 2, c: 3)",
        ),
        (
            "(a: 1, b: 2, c: 3)",
            |t| edit::remove(t, &[Field("b")]),
            "(a: 1, c: 3)",
        ),
        (
            "(a: 1, b: 2, c: 3)",
            |t| edit::remove(t, &[Field("c")]),
            "(a: 1, b: 2)",
        ),
        (
            "(a: 1, c: 3,)",
            |t| edit::remove(t, &[Field("c")]),
            "(a: 1,)",
        ),
        (
            "(\n  a: 1, // one\n  b: 2)",
            |t| edit::remove(t, &[Field("b")]),
            "(\n  a: 1 // one\n  )",
        ),
        (
            "(\n  a: 1,\n  b: 2)",
            |t| edit::remove(t, &[Field("b")]),
            "(\n  a: 1)",
        ),
        (
            "(\n    // all\n\n    // of b\n    /* too */\n    b: 2, // b\n    // of c\n    c: 3,\n)",
            |t| edit::remove(t, &[Field("b")]),
            "(\n    // all\n\n    // of c\n    c: 3,\n)",
        ),
        // Items.
        (
            "(l: [])",
            |t| edit::insert(t, &[Field("l")], 9, "(a: 1)"),
            "(l: [(a: 1)])",
        ),
        (
            "(\n\tl: [\n\t],\n)",
            |t| edit::insert(t, &[Field("l")], 0, "1"),
            "(\n\tl: [\n\t\t1,\n\t],\n)",
        ),
        (
            "(l: [1, 2])",
            |t| edit::insert(t, &[Field("l")], 0, "0"),
            "(l: [0, 1, 2])",
        ),
        (
            "(l: [1, 2])",
            |t| edit::insert(t, &[Field("l")], 1, "0"),
            "(l: [1, 0, 2])",
        ),
        (
            "(l: [1, 2])",
            |t| edit::insert(t, &[Field("l")], 2, "0"),
            "(l: [1, 2, 0])",
        ),
        (
            "(\n  l: [\n    1, // one\n    // two\n    2\n  ],\n)",
            |t| edit::insert(t, &[Field("l")], 1, "0"),
            "(\n  l: [\n    1, // one\n    0,\n    // two\n    2\n  ],\n)",
        ),
        (
            "(l: [1, 2, 3])",
            |t| edit::move_item(t, &[Field("l")], 2, 0),
            "(l: [3, 1, 2])",
        ),
        (
            "(\n  l: [\n    1, // one\n    // two\n    2\n  ],\n)",
            |t| edit::move_item(t, &[Field("l")], 0, 1),
            "(\n  l: [\n    // two\n    2,\n    1 // one\n  ],\n)",
        ),
        (
            "(l: [1, 2, // two\n  3])",
            |t| edit::move_item(t, &[Field("l")], 1, 0),
            "(l: [2, // two\n 1,\n  3])",
        ),
    ];
    for (before, change, after) in cases {
        assert_eq!(change(before).as_deref(), Ok(*after), "{before}");
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let text = "(\n  width: 2,\n  layers: [(a: 1), (a: 2)],\n)";
    let error = |result: Result<String, EditError>| result.unwrap_err().to_string();
    for (found, expected) in [
        (
            error(edit::set("(\n  a: [1,\n)", &[Field("a")], "1")),
            "2:6: this `[` is not closed before the `)` of line 3: is a `]` missing?",
        ),
        (
            error(edit::set("", &[Field("a")], "1")),
            "1:1: there is nothing in it",
        ),
        (
            error(edit::remove(text, &[Field("widht")])),
            "there is no `widht`, did you mean `width`?",
        ),
        (
            error(edit::remove(text, &[])),
            "there is no ``; it is the whole text",
        ),
        (
            error(edit::remove(text, &[Field("layers"), Item(2)])),
            "there is no `layers[2]`; there are 2 items",
        ),
        (
            error(edit::set(
                text,
                &[Field("layers"), Item(2), Field("a")],
                "1",
            )),
            "there is no `layers[2]`; there are 2 items",
        ),
        (
            error(edit::move_item(text, &[Field("layers")], 0, 2)),
            "there is no `layers[2]`; there are 2 items",
        ),
        (
            error(edit::insert(text, &[Field("zones")], 0, "1")),
            "there is no `zones`; there are: width, layers",
        ),
        (
            error(edit::set(text, &[Field("new"), Item(0)], "1")),
            "there is no `new[0]`; there are 0 items",
        ),
        (
            error(edit::set(text, &[Field("width"), Field("a")], "1")),
            "2:10: `width` is not a section (name: value, ...)",
        ),
        (
            error(edit::insert(text, &[Field("width")], 0, "1")),
            "2:10: `width` is not a list [..., ...]",
        ),
        (
            error(edit::set(text, &[Field("a b")], "1")),
            "`a b` is no name of a field",
        ),
        (
            error(edit::set("(a: 1 b: 2)", &[Field("c")], "1")),
            "1:7: a comma is missing before `b`",
        ),
        (
            error(edit::remove("(a: 1,, b: 2)", &[Field("b")])),
            "1:7: there is a comma too many",
        ),
        (
            error(edit::set("(a = 1, b: 2)", &[Field("c")], "1")),
            "1:4: there is a `=` too many",
        ),
    ] {
        assert_eq!(found, expected);
    }
    for value in [
        "",
        "1, 2",
        "a: 1",
        "(",
        ")",
        "1) (2",
        "\"",
        "1 // one",
        "/* a */ 1",
        "[(])",
        "a = 1",
    ] {
        let message = error(edit::set(text, &[Field("width")], value));
        assert!(message.ends_with("is not one value"), "{value}: {message}");
        assert!(
            edit::insert(text, &[Field("layers")], 0, value).is_err(),
            "{value}"
        );
    }
    assert!(edit::insert(text, &[Field("layers")], 0, "(a: 1) (b: 2)").is_err());
    assert_eq!(edit::get("(a: [1)", &[Field("a")]), None);
    assert_eq!(edit::get(text, &[]), Some(text));
    assert_eq!(edit::span(text, &[Field("width")]), Some(11..12));
    assert_eq!(
        edit::fields(text, &[Field("layers"), Item(1)]),
        [("a", "2")]
    );
    assert!(edit::items(text, &[]).is_empty() && edit::fields(text, &[Field("layers")]).is_empty());
}

/// The text of each preset, style and script of the repository.
fn repository() -> Vec<(String, String)> {
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let mut found = Vec::new();
    for folder in [
        presets.clone(),
        presets.join("styles"),
        presets.join("motions"),
    ] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                found.push((
                    path.display().to_string(),
                    fs::read_to_string(&path).unwrap(),
                ));
            }
        }
    }
    assert!(found.len() > 10);
    found
}

/// All values in the text.
fn ways(text: &str, way: &mut Vec<Way>, found: &mut Vec<Vec<Way>>) {
    let names: Vec<Way> = edit::fields(text, &steps(way))
        .into_iter()
        .map(|(name, _)| Way::Name(name.to_owned()))
        .collect();
    let items = (0..edit::items(text, &steps(way)).len()).map(Way::Index);
    for step in names.into_iter().chain(items) {
        way.push(step);
        found.push(way.clone());
        ways(text, way, found);
        way.pop();
    }
}

#[test]
fn presets_of_the_repository() {
    for (name, text) in repository() {
        let mut found = Vec::new();
        ways(&text, &mut Vec::new(), &mut found);
        assert!(found.len() > 3, "{name}");
        for way in found.iter().filter(|way| way.len() <= 3) {
            let path = steps(way);
            let value = edit::get(&text, &path).unwrap();
            assert_eq!(
                edit::set(&text, &path, value).unwrap(),
                text,
                "{name}: {path:?}"
            );
            let changed = edit::set(&text, &path, "\"other\"").unwrap();
            assert_eq!(changed.len() + value.len(), text.len() + "\"other\"".len());
            assert_eq!(
                edit::set(&changed, &path, value).unwrap(),
                text,
                "{name}: {path:?}"
            );
            if way.len() == 3 {
                continue;
            }
            reads(&edit::remove(&text, &path).unwrap()).unwrap();
            // What is added in one's own layout goes without a trace.
            let field: Vec<Step> = path.iter().copied().chain([Field("added")]).collect();
            if !edit::fields(&text, &path).is_empty() {
                let added = edit::set(&text, &field, "1").unwrap();
                assert_eq!(
                    added.lines().count(),
                    text.lines().count() + usize::from(value.contains('\n'))
                );
                assert_eq!(
                    edit::remove(&added, &field).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
            }
            let count = edit::items(&text, &path).len();
            for at in 0..count {
                let item: Vec<Step> = path.iter().copied().chain([Item(at)]).collect();
                let inserted = edit::insert(&text, &path, at, "(added: 1)").unwrap();
                assert_eq!(edit::get(&inserted, &item), Some("(added: 1)"));
                assert_eq!(
                    edit::remove(&inserted, &item).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
                let moved = edit::move_item(&text, &path, at, count - 1).unwrap();
                assert_eq!(
                    edit::move_item(&moved, &path, count - 1, at).unwrap(),
                    text,
                    "{name}: {path:?}"
                );
            }
        }
    }
}

/// The value that is read where `written` stands.
fn read(written: &str, kind: ParamKind) -> Option<Value> {
    let text = format!("(p: {written})");
    let mut reader = Reader::new("it", &text);
    let root = reader.text();
    let fields: Vec<ReadField> = reader.fields(root, "it");
    let param = Param {
        name: "p",
        doc: "",
        unit: "",
        kind,
    };
    let value = reader.value(fields.first()?, &param);
    reader.report().ok().and(value)
}

fn number(varies: bool) -> ParamKind {
    ParamKind::Number {
        min: f32::MIN,
        max: f32::MAX,
        default: 0.0,
        varies,
    }
}

fn any_number() -> impl Strategy<Value = f32> {
    let bits = any::<u32>().prop_map(f32::from_bits);
    prop_oneof![
        bits.prop_filter("finite", |n| n.is_finite()),
        -10.0..10.0_f32,
        (0..2000_i16).prop_map(|n| f32::from(n) / 100.0)
    ]
}

proptest! {
    #[test]
    fn written_values_are_read_as_they_were(
        n in any_number(), whole: i32, flag: bool, text in "\\PC{1,12}|[\\x00-\\x7f]{1,8}",
        triple in prop::array::uniform3(any_number()), size: [u32; 2],
        mut curve in prop::collection::vec((0.0..=1.0_f32, any_number()), 1..4), vary in 0.0..=1.0_f32,
        bytes: [u8; 3],
    ) {
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        let names: &[&str] = &["round", "flat"];
        let hex = bytes.map(|byte| format!("{byte:02X}")).concat();
        let color = effects::parse_hex(&hex);
        let (min, max) = (f32::MIN, f32::MAX);
        for (value, kind) in [
            (Value::Number(n), number(false)),
            (Value::Number(n), number(true)),
            (Value::Varying(Variation { curve: curve.clone(), vary }), number(true)),
            (Value::Varying(Variation { curve, vary: 0.0 }), number(true)),
            (Value::Varying(Variation { curve: vec![(0.0, n)], vary }), number(true)),
            (Value::Varying(Variation { curve: vec![(0.0, n)], vary: 0.0 }), number(true)),
            (Value::Integer(whole), ParamKind::Integer { min: i32::MIN, max: i32::MAX, default: 0 }),
            (Value::Flag(flag), ParamKind::Flag { default: false }),
            (Value::Choice(u32::from(flag)), ParamKind::Choice { names, default: 0 }),
            (Value::Color(color), ParamKind::Color { default: "000000" }),
            (Value::Color(color), ParamKind::OptionalColor { default: None }),
            (Value::Color(None), ParamKind::OptionalColor { default: None }),
            (Value::Text(Some(text)), ParamKind::Text),
            (Value::Triple(triple), ParamKind::Triple { min, max, default: [0.0; 3] }),
            (Value::Pair([triple[0], n]), ParamKind::Pair { min, max, default: [0.0; 2] }),
            (Value::Size(size), ParamKind::Size { min: 0, max: u32::MAX, default: [1; 2] }),
        ] {
            let written = edit::written(&value, &kind);
            prop_assert_eq!(read(&written, kind), Some(value), "{}", written);
            let is_number = matches!(kind, ParamKind::Number { .. }) && !written.starts_with('(');
            prop_assert!(!is_number || !written.contains(['e', 'E']), "{}", written);
        }
    }
}

#[test]
fn written_values_are_short() {
    let triple = ParamKind::Triple {
        min: -1.0,
        max: 1.0,
        default: [0.0; 3],
    };
    let color = ParamKind::Color { default: "000000" };
    for (value, kind, expected) in [
        (Value::Number(0.1), number(false), "0.1"),
        (Value::Number(1.0), number(false), "1"),
        (Value::Number(-0.0), number(false), "0"),
        (Value::Number(1e-7), number(false), "0.0000001"),
        (Value::Number(1e9), number(false), "1000000000"),
        (Value::Number(0.3), number(false), "0.3"),
        (Value::Triple([0.0, -0.5, 1.0]), triple, "(0, -0.5, 1)"),
        (Value::Triple([1.0, 2.0, 0.0]), color, "\"FFFF00\""),
        (
            Value::Varying(Variation {
                curve: vec![(0.0, 2.0)],
                vary: 0.2,
            }),
            number(true),
            "(value: 2, vary: 0.2)",
        ),
        (
            Value::Varying(Variation {
                curve: vec![(0.0, 1.0), (0.5, 2.0)],
                vary: 0.0,
            }),
            number(true),
            "(curve: [(0, 1), (0.5, 2)])",
        ),
        (
            Value::Text(Some("a \"b\" \\ c\n".into())),
            ParamKind::Text,
            r#""a \"b\" \\ c\n""#,
        ),
    ] {
        assert_eq!(edit::written(&value, &kind), expected);
    }
}
