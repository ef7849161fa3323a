//! What an effect's author reads when the source is wrong: the author's own file, line and column.

fn error(source: &str) -> String {
    match effects_build::translate_effect(source, "src/mine.wgsl") {
        Ok(_) => panic!("this should be refused:\n{source}"),
        Err(error) => error.to_string(),
    }
}

/// An effect whose radius is this expression.
fn with_radius(expression: &str) -> String {
    format!(
        "//! inputs: u\nfn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {{\n    \
         return Stroke(vec2<f32>(0.0), {expression}, 0.0, vec3<f32>(1.0));\n}}\n\
         struct Params {{\n    /// A width.\n    /// @range 0..1 @default 0.5\n    width: f32,\n}}\n"
    )
}

#[track_caller]
fn assert_error(source: &str, parts: &[&str]) {
    let message = error(source);
    for part in parts {
        assert!(message.contains(part), "`{part}` is missing in:\n{message}");
    }
}

#[test]
fn a_right_effect_is_translated() {
    let rust = effects_build::translate_effect(&with_radius("joint.u * params.width"), "a.wgsl");
    let rust = rust.unwrap();
    assert!(
        rust.contains("impl ::effects::Program for Program"),
        "{rust}"
    );
    assert!(rust.contains("u: joints.u[index]"), "{rust}");
    assert!(
        !rust.contains("pub struct Stroke"),
        "the prelude's items are shared:\n{rust}"
    );
}

#[test]
fn undeclared_inputs_are_not_there() {
    assert_error(
        &with_radius("joint.gray"),
        &["invalid field accessor `gray`", "src/mine.wgsl:3:"],
    );
}

#[test]
fn unknown_inputs_are_named_with_what_there_is() {
    let source = with_radius("joint.u").replace("inputs: u", "inputs: u, normals");
    assert_error(
        &source,
        &[
            "src/mine.wgsl:1:16",
            "no input `normals`",
            "normal, clump_radius",
        ],
    );
    let source = with_radius("1.0").replace("//! inputs: u", "// nothing");
    assert_error(&source, &["src/mine.wgsl:1:1", "//! inputs:"]);
}

#[test]
fn parameters_of_all_kinds_need_their_keys() {
    let with = |declaration: &str| {
        with_radius("1.0").replace("@range 0..1 @default 0.5\n    width: f32", declaration)
    };
    for (declaration, message) in [
        (
            "@range 0..3 @default 1\n    width: i32",
            "begins below 0; use a u32",
        ),
        (
            "@default yes\n    width: bool",
            "@default yes: it is true or false",
        ),
        (
            "@range 0..1 @default 0.5\n    width: vec2<f32>",
            "2 numbers are needed",
        ),
        (
            "@range 0..1 @default 0 0 2\n    width: vec3<f32>",
            "@default 2: not a number in its range",
        ),
        (
            "@default 1\n    width: mat2x2<f32>",
            "a parameter is an f32, a u32, an i32, a bool",
        ),
    ] {
        assert_error(
            &with(declaration),
            &["src/mine.wgsl:8:5: Params.width: ", message],
        );
    }
}

/// naga names no place for these, or one in text that the author never wrote.
#[test]
fn mistakes_are_told_in_the_authors_text() {
    let both = with_radius("select(1.0, 0.0, instance || joint.u > 0.5)");
    assert_error(&both, &["src/mine.wgsl:3:61: ", "LogicalOr(u32"]);
    let twice = both.replace(
        "select",
        "select(1.0, 0.0, joint.u > 2.0 ||\n joint.u < 0.0) + select",
    );
    let twice = twice.replace("instance ||", "\ninstance ||");
    assert_error(&twice, &["src/mine.wgsl:3:", "a `||` of the lines 3, 5"]);
    // A brace that is never closed: in a text whose last line is 8.
    let open = with_radius("1.0").replace(";\n}\nstruct", ";\nstruct");
    assert_error(&open, &["src/mine.wgsl:2:", "`{` is never closed"]);
    let open = with_radius("1.0").replace("width: f32,\n}", "width: f32,");
    assert_error(&open, &["src/mine.wgsl:5:15: this `{` is never closed"]);
    let ends_oddly = with_radius("1.0") + "const X = 1 // gr\u{f6}\u{df}\u{e9}";
    assert!(
        error(&ends_oddly).starts_with("src/mine.wgsl:"),
        "{}",
        error(&ends_oddly)
    );
    for spoilt in [&both, &twice, &open] {
        assert!(!error(spoilt).contains("mine.wgsl:1:1"));
    }
}

#[test]
fn wgsl_errors_are_nagas() {
    assert_error(&with_radius("1.0 +"), &["src/mine.wgsl:3:"]);
    assert_error(&with_radius("joint.u + 1u"), &["src/mine.wgsl:3:"]);
}

#[test]
fn builtins_that_differ_between_processors_are_refused_with_what_to_use() {
    assert_error(
        &with_radius("sin(joint.u)"),
        &["src/mine.wgsl:3:", "`sin`", "sin_pi"],
    );
    assert_error(
        &with_radius("fract(joint.u)"),
        &["src/mine.wgsl:3:", "x - floor(x)"],
    );
    assert_error(
        &with_radius("pow(joint.u, 2.0)"),
        &["src/mine.wgsl:3:", "`pow`"],
    );
    assert_error(
        &with_radius("bitcast<f32>(instance)"),
        &["src/mine.wgsl:3:", "bitcast", "bits_of(x)"],
    );
    assert_error(
        &with_radius("f32(1u << instance)"),
        &["src/mine.wgsl:3:", "constant number"],
    );
    assert_error(
        &with_radius("f32((vec2<u32>(1u) << vec2<u32>(instance)).x)"),
        &["src/mine.wgsl:3:", "constant number"],
    );
    assert_error(
        &with_radius("vec3<f32>(joint.u).zz.x"),
        &["src/mine.wgsl:3:", "swizzle"],
    );
    assert_error(
        &with_radius("select(vec3<f32>(0.0), vec3<f32>(1.0), joint.u > 0.5).x"),
        &["src/mine.wgsl:3:", "vec3<bool>(condition)"],
    );
}

#[test]
fn the_function_must_be_there_and_right() {
    let source = with_radius("1.0").replace("fn stroke", "fn strokes");
    assert_error(
        &source,
        &["fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke"],
    );
    let source = with_radius("1.0").replace("instance: u32, ", "");
    assert_error(&source, &["src/mine.wgsl:2:", "must be `fn stroke("]);
}

#[test]
fn parameters_need_words_range_and_default() {
    let params = |text: &str| {
        let source = with_radius("1.0");
        let start = source.find("    /// A width.").unwrap();
        format!("{}{text}\n}}\n", &source[..start])
    };
    let wrong: [(&str, &str); 11] = [
        ("width: f32,", "must say what it does"),
        ("/// W.\n/// @range 0..1\nwidth: f32,", "@default VALUE"),
        ("/// W.\n/// @default 1\nwidth: f32,", "@range MIN..MAX"),
        (
            "/// W.\n/// @range 0..inf @default 1\nwidth: f32,",
            "both finite",
        ),
        (
            "/// W.\n/// @range 0..1e39 @default 1\nwidth: f32,",
            "both finite",
        ),
        (
            "/// W.\n/// @range 0..1 @default 2\nwidth: f32,",
            "not a number in its range",
        ),
        (
            "/// W.\n/// @range 1..0 @default 1\nwidth: f32,",
            "a range is `MIN..MAX`",
        ),
        (
            "/// W.\n/// @rnge 0..1 @default 1\nwidth: f32,",
            "there is no `@rnge`",
        ),
        (
            "/// W.\n/// @range 0..1 @default 1\nwidth1: f32,",
            "can't end in a digit",
        ),
        (
            "/// W.\n/// @default \"12345\"\ntint: vec3<f32>,",
            "\"RRGGBB\"",
        ),
        (
            "/// W.\n/// @choices a b @default c\nkind: u32,",
            "one of @choices",
        ),
    ];
    for (text, message) in wrong {
        assert_error(&params(text), &["src/mine.wgsl:", message]);
    }
    // At the parameter's own line.
    assert_error(
        &params("    /// W.\n    /// @range 0..1\n    width: f32,"),
        &["src/mine.wgsl:8:5: Params.width: its comment needs"],
    );
    assert_error(
        &params("/// W.\n/// @default 1\nw: vec2<u32>,"),
        &["an f32, a u32, an i32, a bool, a vec2<f32>"],
    );
}

#[test]
fn nothing_outside_functions() {
    let source = format!("{}var<private> state: f32;\n", with_radius("1.0"));
    assert_error(&source, &["src/mine.wgsl:", "no variables outside"]);
}

/// An effect that paints with these lines.
fn painting(sample: &str, functions: &str) -> String {
    format!("{}{functions}", with_radius("joint.u")).replacen('\n', &format!("\n{sample}\n"), 1)
}

#[test]
fn effects_that_paint_are_translated() {
    let source = painting(
        "//! sample: u, w",
        "fn paint(at: Sample, params: Params) -> vec3<f32> { return vec3<f32>(at.w * params.width, at.u, 0.0); }\n",
    );
    let rust = effects_build::translate_effect(&source, "a.wgsl").unwrap();
    assert!(
        rust.contains("SampleInput::U") && rust.contains("samples.w[index]"),
        "{rust}"
    );
    assert!(!rust.contains("fn place"), "{rust}");
}

#[test]
fn mistakes_of_painting_are_told() {
    let paint = "fn paint(at: Sample, params: Params) -> vec3<f32> { return vec3<f32>(at.u); }\n";
    let place = "fn place(at: Sample, params: Params) -> Lookup { return Lookup(0u, vec2<f32>(at.u), 0.0); }\n";
    let sample = "//! sample: u";
    assert_error(
        &painting(sample, ""),
        &["needs the function `fn paint(at: Sample, params: Params) -> vec3<f32>`"],
    );
    assert_error(
        &painting(sample, place),
        &[
            "needs the function `fn paint(at: Sample, texel: vec4<f32>, params: Params) -> vec3<f32>`",
        ],
    );
    assert_error(
        &painting(sample, &format!("{place}{paint}")),
        &[
            "src/mine.wgsl:",
            "must be `fn paint(at: Sample, texel: vec4<f32>,",
        ],
    );
    assert_error(
        &painting(sample, &paint.replace("vec3<f32>", "f32")),
        &["must be `fn paint("],
    );
    assert_error(&painting("", paint), &["`Sample`", "src/mine.wgsl:"]);
    assert_error(
        &painting("//! sample: u, gray", paint),
        &[
            "src/mine.wgsl:2:16",
            "no sample input `gray`",
            "color, position",
        ],
    );
}

#[test]
fn mistakes_of_textures_are_told() {
    let with = |tags: &str| {
        with_radius("joint.u").replace(
            "    width: f32,",
            &format!("    width: f32,\n    /// A tone.\n    /// {tags}\n    tone: u32,"),
        )
    };
    assert!(
        effects_build::translate_effect(&with("@texture repeat @default none"), "a.wgsl").is_ok()
    );
    assert_error(
        &with("@texture"),
        &["Params.tone: its comment needs `@default VALUE`"],
    );
    assert_error(
        &with("@texture wrap @default none"),
        &["@texture wrap: it is clamp or repeat"],
    );
}
