//! Scripts of motion as text.

use super::{Key, KeyShape, MotionScript, Move, MoveKind, Wind};
use crate::part::FilePart;
use crate::table::{choice, number, param};
use effects::preset::{Field, PresetErrors, Reader};
use effects::{Param, ParamKind, Values};
use glam::{DVec3, Vec3};
use stroke_path::direction_from_angles;

/// The newest version of scripts that this build reads.
const VERSION: i32 = 1;
/// Longer than any sequence: a move or wind without an end.
const FOREVER: f32 = 1e6;

const MOTION: &[Param] = &[
    param(
        "version",
        "Version of the script's format.",
        ParamKind::Integer {
            min: 1,
            max: VERSION,
            default: VERSION,
        },
    ),
    number(
        "period",
        "Time after which the script starts again; 0 never does.",
        "s",
        0.0..=FOREVER,
        0.0,
    ),
    Param {
        name: "hold",
        doc: "Pull of the hair to its `shapes` at the root, half way and at the tip, as a quadratic \
              between: acceleration per metre, damped critically. (0, 0, 0) leaves it to dynamics; from \
              about (10000, 10000, 10000) on it is where the shapes have it.",
        unit: "1/s^2",
        kind: ParamKind::Triple {
            min: 0.0,
            max: 1e7,
            default: HOLD,
        },
    },
];

const HOLD: [f32; 3] = [400.0, 200.0, 100.0];

const SHAPE: &[Param] = &[
    number("time", "When hair has the shape.", "s", 0.0..=FOREVER, 0.0),
    param(
        "hair",
        "The shape, relative to the script: .style.ron, .strands.ron or .tfx, of the same strands and as \
         many points as the hair. Without it the hair's own.",
        ParamKind::Text,
    ),
    number(
        "at",
        "The moment in a file with motion, such as a bake.",
        "s",
        0.0..=FOREVER,
        0.0,
    ),
];

const KEY: &[Param] = &[
    number("time", "When the head is there.", "s", 0.0..=FOREVER, 0.0),
    Param {
        name: "turn",
        doc: "Turns towards the character's left, up, and towards the left shoulder.",
        unit: "degrees",
        kind: ParamKind::Triple {
            min: -3600.0,
            max: 3600.0,
            default: [0.0; 3],
        },
    },
    Param {
        name: "shift",
        doc: "Where the head is moved to: left, up, forwards.",
        unit: "head heights",
        kind: ParamKind::Triple {
            min: -1000.0,
            max: 1000.0,
            default: [0.0; 3],
        },
    },
];

const MOVE: &[Param] = &[
    choice(
        "move",
        "turn (to the left), lift (look up) and lean (to the left shoulder) happen once and stay; \
         shake, nod and walk swing.",
        &["turn", "lift", "lean", "shake", "nod", "walk"],
        0,
    ),
    number("start", "When it begins.", "s", 0.0..=FOREVER, 0.0),
    number("length", "How long it takes.", "s", 0.001..=FOREVER, 1.0),
    number(
        "angle",
        "How far it turns.",
        "degrees",
        -3600.0..=3600.0,
        15.0,
    ),
    number(
        "rate",
        "Swings or steps a second.",
        "1/s",
        0.01..=100.0,
        1.5,
    ),
    number(
        "step",
        "How high a step of a walk lifts the head.",
        "head heights",
        0.0..=10.0,
        0.06,
    ),
];

const WIND: &[Param] = &[
    number("start", "When it begins.", "s", 0.0..=FOREVER, 0.0),
    number(
        "length",
        "How long it blows.",
        "s",
        0.001..=FOREVER,
        FOREVER,
    ),
    number(
        "speed",
        "Its steady speed: 1 a breath, 5 a breeze, 20 a gale.",
        "m/s",
        0.0..=200.0,
        4.0,
    ),
    number(
        "gusts",
        "Speed of the gusts on top.",
        "m/s",
        0.0..=200.0,
        1.5,
    ),
    number(
        "yaw",
        "Where it comes from: 0 the front, 90 the viewer's right.",
        "degrees",
        -360.0..=360.0,
        90.0,
    ),
    number(
        "pitch",
        "Positive comes from above.",
        "degrees",
        -90.0..=90.0,
        0.0,
    ),
];

/// The parts of a motion script.
pub const MOTION_PARTS: &[FilePart] = &[
    FilePart {
        name: "script",
        doc: "How head, wind and hair move, a file of its own: NAME.motion.ron.",
        example: "(version: 1, moves: [...], keys: [...], winds: [...], shapes: [...])",
        table: MOTION,
        places: &[],
    },
    FilePart {
        name: "moves",
        doc: "Moves of the head; they add up, also with `keys`.",
        example: "moves: [(move: turn, start: 0.5, length: 0.4, angle: 60), ...]",
        table: MOVE,
        places: &[],
    },
    FilePart {
        name: "keys",
        doc: "Keyframes of the head, joined by a spline.",
        example: "keys: [(time: 0), (time: 1, turn: (40, 0, 0)), ...]",
        table: KEY,
        places: &[],
    },
    FilePart {
        name: "winds",
        doc: "Winds; their speeds add up.",
        example: "winds: [(speed: 5, yaw: 60), ...]",
        table: WIND,
        places: &[],
    },
    FilePart {
        name: "shapes",
        doc: "Key shapes of the hair, joined by a spline; `hold` of the script pulls hair to them.",
        example: "shapes: [(time: 0), (time: 0.6, hair: \"../styles/blown.style.ron\"), ...]",
        table: SHAPE,
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
    let top = reader.values(&plain, MOTION, "the motion");
    let mut script = MotionScript {
        period: Some(f64::from(top.number("period"))).filter(|period| *period > 0.0),
        hold: top.triple("hold").map(f64::from),
        ..MotionScript::default()
    };
    for list in lists {
        for item in reader.list(list.value, list.name) {
            match list.name {
                "keys" => {
                    let key = key(&reader.section(item, KEY, "a key"));
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
                "moves" => script
                    .moves
                    .push(moved(&reader.section(item, MOVE, "a move"))),
                _ => script
                    .winds
                    .push(wind(&reader.section(item, WIND, "a wind"))),
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
    let values = reader.values(&fields, SHAPE, "a shape");
    let field = |name: &str| fields.iter().find(|field| field.name == name);
    if let (Some(at), None) = (field("at"), field("hair")) {
        reader.error(
            at.name,
            "at: there is no `hair` that it could be a moment of",
        );
    }
    KeyShape {
        time: f64::from(values.number("time")),
        file: values.text("hair").map(str::to_owned),
        at: values.is_given("at").then(|| values.number("at")),
        place: reader.place(field("hair").map_or(item, |hair| hair.value)),
    }
}

fn key(values: &Values) -> Key {
    let triple = |name| Vec3::from(values.triple(name)).as_dvec3();
    Key {
        time: f64::from(values.number("time")),
        turn: triple("turn"),
        shift: triple("shift"),
    }
}

fn moved(values: &Values) -> Move {
    let kinds = [
        MoveKind::Turn,
        MoveKind::Lift,
        MoveKind::Lean,
        MoveKind::Shake,
        MoveKind::Nod,
        MoveKind::Walk,
    ];
    let number = |name| f64::from(values.number(name));
    Move {
        kind: kinds[values.choice("move") as usize],
        start: number("start"),
        length: number("length"),
        angle: number("angle"),
        rate: number("rate"),
        step: number("step"),
    }
}

fn wind(values: &Values) -> Wind {
    let number = |name| f64::from(values.number(name));
    // The angles are within their ranges, so there is a direction.
    let from = direction_from_angles(values.number("yaw"), values.number("pitch"))
        .map_or(DVec3::X, Vec3::as_dvec3);
    Wind {
        start: number("start"),
        length: number("length"),
        direction: -from,
        speed: number("speed"),
        gusts: number("gusts"),
    }
}
