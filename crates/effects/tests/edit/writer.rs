//! Texts of random layouts, and what is where in them.

use crate::Way;
use effects::preset::edit;

/// A value of a random text: where it is, what is written there, the comments that belong to it and are in it.
#[derive(Clone, Debug)]
pub struct Known {
    pub way: Vec<Way>,
    pub value: String,
    pub comments: Vec<String>,
    pub is_section: bool,
    /// The number of items of a list.
    pub items: Option<usize>,
}

/// Writes random texts.
pub struct Writer {
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
    pub fn new(seed: u64) -> Self {
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

    pub fn preset(mut self) -> (String, Vec<Known>) {
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
    pub fn preset_with_list(mut self) -> (String, Vec<Known>) {
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
