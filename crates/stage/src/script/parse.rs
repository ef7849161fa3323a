//! Scripts of motion as text.

use super::{Key, KeyShape, MotionScript, Move, MoveKind, Wind};
use crate::part::FilePart;
use effects::preset::{Field, PresetErrors, Reader};
use effects::section;
use glam::{DVec3, Vec3};
use stroke_path::direction_from_angles;

/// The newest version of scripts that this build reads.
const VERSION: u32 = 1;
/// Longer than any sequence: a move or wind without an end.
const FOREVER: f32 = 1e6;

section! {
    /// What a script says beside its lists.
    struct ScriptFields {
        /// Version of the script's format.
        version: u32 = whole(VERSION, 1..=VERSION),
        /// Time after which the script starts again; 0 never does.
        period: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// Pull of the hair to its `shapes` at the root, half way and at the tip, as a quadratic
        /// between: acceleration per metre, damped critically. (0, 0, 0) leaves it to dynamics; from
        /// about (10000, 10000, 10000) on it is where the shapes have it.
        hold: [f32; 3] = triple([400.0, 200.0, 100.0], 0.0..=1e7).unit("1/s^2"),
    }
}

section! {
    /// A key shape.
    struct ShapeFields {
        /// When hair has the shape.
        time: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// The shape, relative to the script: .style.ron, .strands.ron or .tfx, of the same strands and as
        /// many points as the hair. Without it the hair's own.
        hair: Option<String> = text(),
        /// The moment in a file with motion, such as a bake.
        at: Option<f32> = number(0.0, 0.0..=FOREVER).unit("s").optional(),
    }
}

section! {
    /// A keyframe of the head.
    struct KeyFields {
        /// When the head is there.
        time: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// Turns towards the character's left, up, and towards the left shoulder.
        turn: [f32; 3] = triple([0.0; 3], -3600.0..=3600.0).unit("degrees"),
        /// Where the head is moved to: left, up, forwards.
        shift: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
    }
}

section! {
    /// A move of the head.
    struct MoveFields {
        /// turn (to the left), lift (look up) and lean (to the left shoulder) happen once and stay;
        /// shake, nod and walk swing.
        kind as "move": MoveKind = MoveKind::Turn.or_another(),
        /// When it begins.
        start: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// How long it takes.
        length: f32 = number(1.0, 0.001..=FOREVER).unit("s"),
        /// How far it turns.
        angle: f32 = number(15.0, -3600.0..=3600.0).unit("degrees"),
        /// Swings or steps a second.
        rate: f32 = number(1.5, 0.01..=100.0).unit("1/s"),
        /// How high a step of a walk lifts the head.
        step: f32 = number(0.06, 0.0..=10.0).unit("head heights"),
    }
}

section! {
    /// A wind.
    struct WindFields {
        /// When it begins.
        start: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// How long it blows.
        length: f32 = number(FOREVER, 0.001..=FOREVER).unit("s"),
        /// Its steady speed: 1 a breath, 5 a breeze, 20 a gale.
        speed: f32 = number(4.0, 0.0..=200.0).unit("m/s"),
        /// Speed of the gusts on top.
        gusts: f32 = number(1.5, 0.0..=200.0).unit("m/s"),
        /// Where it comes from: 0 the front, 90 the viewer's right.
        yaw: f32 = number(90.0, -360.0..=360.0).unit("degrees"),
        /// Positive comes from above.
        pitch: f32 = number(0.0, -90.0..=90.0).unit("degrees"),
    }
}

/// The parts of a motion script.
pub const MOTION_PARTS: &[FilePart] = &[
    FilePart {
        name: "script",
        doc: "How head, wind and hair move, a file of its own: NAME.motion.ron.",
        example: "(version: 1, moves: [...], keys: [...], winds: [...], shapes: [...])",
        table: ScriptFields::TABLE,
        places: &[],
    },
    FilePart {
        name: "moves",
        doc: "Moves of the head; they add up, also with `keys`.",
        example: "moves: [(move: turn, start: 0.5, length: 0.4, angle: 60), ...]",
        table: MoveFields::TABLE,
        places: &[],
    },
    FilePart {
        name: "keys",
        doc: "Keyframes of the head, joined by a spline.",
        example: "keys: [(time: 0), (time: 1, turn: (40, 0, 0)), ...]",
        table: KeyFields::TABLE,
        places: &[],
    },
    FilePart {
        name: "winds",
        doc: "Winds; their speeds add up.",
        example: "winds: [(speed: 5, yaw: 60), ...]",
        table: WindFields::TABLE,
        places: &[],
    },
    FilePart {
        name: "shapes",
        doc: "Key shapes of the hair, joined by a spline; `hold` of the script pulls hair to them.",
        example: "shapes: [(time: 0), (time: 0.6, hair: \"../styles/blown.style.ron\"), ...]",
        table: ShapeFields::TABLE,
        places: &[],
    },
];

/// Reads the script `text`, which messages call `file`.
///
/// # Errors
///
/// All mistakes of the file, each with its line and column.
pub(crate) fn parse(file: &str, text: &str) -> Result<MotionScript, PresetErrors> {
    let mut reader = Reader::new(file, text);
    let fields = reader.fields(text, "the motion");
    reader.report()?;
    let (lists, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| ["keys", "moves", "winds", "shapes"].contains(&field.name));
    if plain.iter().all(|field| field.name != "version") {
        reader.error(
            text,
            format!("the motion needs `version: {VERSION}`, the version of its format"),
        );
    }
    let top: ScriptFields = reader.section_of(&plain, "the motion");
    let mut script = MotionScript {
        period: Some(f64::from(top.period)).filter(|period| *period > 0.0),
        hold: top.hold.map(f64::from),
        ..MotionScript::default()
    };
    for list in lists {
        for item in reader.list(list.value, list.name) {
            match list.name {
                "keys" => {
                    let key = key(&reader.section(item, "a key"));
                    if script.keys.last().is_some_and(|last| last.time >= key.time) {
                        reader.error(item, "keys: times must ascend");
                    }
                    script.keys.push(key);
                }
                "shapes" => {
                    let shape = shape(&mut reader, item);
                    if (script.shapes.last()).is_some_and(|last| last.time >= shape.time) {
                        reader.error(item, "shapes: times must ascend");
                    }
                    script.shapes.push(shape);
                }
                "moves" => script.moves.push(moved(&reader.section(item, "a move"))),
                _ => script.winds.push(wind(&reader.section(item, "a wind"))),
            }
        }
    }
    let hold = plain.iter().find(|field| field.name == "hold");
    if let Some(hold) = hold.filter(|_| script.shapes.is_empty()) {
        reader.error(
            hold.name,
            "hold: the script has no `shapes` to pull hair to",
        );
    }
    reader.report()?;
    Ok(script)
}

fn shape<'a>(reader: &mut Reader<'a>, item: &'a str) -> KeyShape {
    let fields = reader.fields(item, "a shape");
    let shape: ShapeFields = reader.section_of(&fields, "a shape");
    let field = |name: &str| fields.iter().find(|field| field.name == name);
    if let (Some(at), None) = (field("at"), field("hair")) {
        reader.error(
            at.name,
            "at: there is no `hair` that it could be a moment of",
        );
    }
    KeyShape {
        time: f64::from(shape.time),
        file: shape.hair,
        at: shape.at,
        place: reader.place(field("hair").map_or(item, |hair| hair.value)),
    }
}

fn key(fields: &KeyFields) -> Key {
    Key {
        time: f64::from(fields.time),
        turn: Vec3::from(fields.turn).as_dvec3(),
        shift: Vec3::from(fields.shift).as_dvec3(),
    }
}

fn moved(fields: &MoveFields) -> Move {
    Move {
        kind: fields.kind,
        start: f64::from(fields.start),
        length: f64::from(fields.length),
        angle: f64::from(fields.angle),
        rate: f64::from(fields.rate),
        step: f64::from(fields.step),
    }
}

fn wind(fields: &WindFields) -> Wind {
    // The angles are within their ranges, so there is a direction.
    let from = direction_from_angles(fields.yaw, fields.pitch).map_or(DVec3::X, Vec3::as_dvec3);
    Wind {
        start: f64::from(fields.start),
        length: f64::from(fields.length),
        direction: -from,
        speed: f64::from(fields.speed),
        gusts: f64::from(fields.gusts),
    }
}
