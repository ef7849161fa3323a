//! Puts a snippet of RON into a file's text, as a reader of the page would.

use effects::preset::{Field, Reader};

/// The text with the snippet in place of what has the same name: fields of the file, or items of its lists, which are
/// known by their first field. What is not there yet is added at the end.
///
/// # Panics
/// Where text or snippet can't be read.
pub fn put(text: &str, snippet: &str) -> String {
    if snippet.trim_start().starts_with('(') {
        let list = format!("[{snippet}]");
        let mut reader = Reader::new("the snippet", &list);
        let items = reader.list(&list, "the snippet");
        reader.report().unwrap();
        items
            .iter()
            .fold(text.to_owned(), |text, item| put_item(&text, item))
    } else {
        let section = format!("({snippet})");
        let fields = fields("the snippet", &section);
        fields.iter().fold(text.to_owned(), |text, field| {
            put_field(&text, field.name, whole(&section, field))
        })
    }
}

/// The fields of a section with nothing after it.
fn fields<'a>(name: &str, section: &'a str) -> Vec<Field<'a>> {
    let mut reader = Reader::new(name, section);
    let fields = reader.fields(reader.text().trim_end(), name);
    reader.report().unwrap();
    fields
}

/// Where a slice of `text` stands in it.
fn offset(text: &str, slice: &str) -> usize {
    slice.as_ptr() as usize - text.as_ptr() as usize
}

/// A field with its name.
fn whole<'a>(text: &'a str, field: &Field<'a>) -> &'a str {
    &text[offset(text, field.name)..offset(text, field.value) + field.value.len()]
}

fn replaced(text: &str, old: &str, new: &str) -> String {
    let start = offset(text, old);
    format!("{}{new}{}", &text[..start], &text[start + old.len()..])
}

/// The text with more after `last`, a slice of it.
fn added(text: &str, last: &str, indent: &str, new: &str) -> String {
    let end = offset(text, last) + last.len();
    format!("{},\n{indent}{new}{}", &text[..end], &text[end..])
}

fn put_field(text: &str, name: &str, new: &str) -> String {
    let fields = fields("the file", text);
    match fields.iter().find(|field| field.name == name) {
        Some(field) => replaced(text, whole(text, field), new),
        None => added(text, whole(text, fields.last().unwrap()), "    ", new),
    }
}

/// A layer is known by its name or its effect, a zone by its name.
fn put_item(text: &str, item: &str) -> String {
    let own = fields("the snippet", item);
    let list = match own[0].name {
        "effect" => "layers",
        "name" => "zones",
        other => panic!("no list has items that begin with `{other}`"),
    };
    let mut reader = Reader::new("the file", text);
    let all = fields("the file", text);
    let list = all.iter().find(|field| field.name == list).unwrap();
    let items = reader.list(list.value, list.name);
    reader.report().unwrap();
    let is_same = |old: &&&str| {
        let old = fields("the file", old);
        let of = |fields: &[Field], name: &str| {
            let field = fields.iter().find(|field| field.name == name);
            field.map(|field| field.value.to_owned())
        };
        ["effect", "name"]
            .iter()
            .all(|name| of(&old, name) == of(&own, name))
    };
    match items.iter().find(is_same) {
        Some(old) => replaced(text, old, item),
        None => added(text, items.last().unwrap(), "        ", item),
    }
}

#[test]
fn fields_are_replaced_or_added() {
    let text = "// Mine: (a: 0).\n(\n    a: (b: 1), // one\n    c: [2],\n)\n";
    let expected = "// Mine: (a: 0).\n(\n    a: (b: 3), // one\n    c: [2],\n    d: 4,\n)\n";
    assert_eq!(put(text, "a: (b: 3),\nd: 4,\n"), expected);
}

#[test]
fn items_are_known_by_their_names() {
    let text = "(layers: [(effect: \"a\"), (effect: \"a\", name: \"b\"), (effect: \"c\")])";
    let snippet = "(effect: \"a\", name: \"b\", rank: 2),\n(effect: \"d\"),\n";
    let expected = "(layers: [(effect: \"a\"), (effect: \"a\", name: \"b\", rank: 2), (effect: \"c\"),\n        (effect: \"d\")])";
    assert_eq!(put(text, snippet), expected);
}
