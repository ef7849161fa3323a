//! The cases that authors' habits make, and what is refused.

use effects::preset::edit::{self, EditError, Step::Field, Step::Item};

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
