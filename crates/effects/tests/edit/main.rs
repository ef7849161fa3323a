//! Changes of a preset's text in place: on texts of random layouts with comments everywhere, on the repository's own presets,
//! and on the cases that authors' habits make.

mod layouts;
mod random;
mod repository;
mod writer;
mod written;

use effects::preset::Reader;
use effects::preset::edit::{self, Step, Step::Field, Step::Item};
use proptest::prelude::*;

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
