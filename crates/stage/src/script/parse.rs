//! Scripts of motion as text.

use super::{HeadPose, Key, KeyShape, MotionScript, Move, MoveKind, Wind, WindKind};
use crate::bodies::{BODIES, BodyKeySection, NamedBody, NamedKey};
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
        /// Whether hair is, at the end of the `period`, where and as fast as it was at its start: a loop without a seam. It is simulated
        /// until it repeats itself, and what is left is blended over the loop.
        closes as "loop": bool = flag(false),
        /// Whether the head keeps winds of a direction from the hair behind it.
        wake: bool = flag(false),
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
        /// Turns of the head, on shoulders that stay, towards the character's left, up, and towards the left shoulder.
        turn: [f32; 3] = triple([0.0; 3], -3600.0..=3600.0).unit("degrees"),
        /// Where the figure is moved to, shoulders and all: left, up, forwards.
        shift: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
    }
}

section! {
    /// A move of the head.
    struct MoveFields {
        /// turn (to the left), lift (look up), lean (to the left shoulder) and spin (the whole figure, to its left)
        /// happen once and stay; shake, nod and walk swing.
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
        /// direction: the same everywhere; point: away from a place, as from a fan; vortex: around an axis; turbulence:
        /// every way, another one at each place and time.
        kind: WindKind = WindKind::Direction.or_another(),
        /// When it begins.
        start: f32 = number(0.0, 0.0..=FOREVER).unit("s"),
        /// How long it blows.
        length: f32 = number(FOREVER, 0.001..=FOREVER).unit("s"),
        /// Its speed: 1 a breath, 5 a breeze, 20 a gale. Of a point and a vortex that at their `radius`, of turbulence the root mean square.
        speed: f32 = number(4.0, 0.0..=200.0).unit("m/s"),
        /// Speed of the gusts on top, of a direction.
        gusts: f32 = number(1.5, 0.0..=200.0).unit("m/s"),
        /// Where it comes from: 0 the front, 90 the viewer's right. A vortex turns about that axis, with the clock as seen along it
        /// from there; turbulence is carried along from there.
        yaw: f32 = number(90.0, -360.0..=360.0).unit("degrees"),
        /// Positive comes from above.
        pitch: f32 = number(0.0, -90.0..=90.0).unit("degrees"),
        /// Middle of a point or a vortex, from the head's at rest: left, up, forwards.
        place: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
        /// How far from its middle a point or a vortex is fastest.
        radius: f32 = number(1.0, 0.05..=1000.0).unit("head heights"),
        /// Largest eddies of turbulence; the smallest are a quarter of that.
        size: f32 = number(2.0, 0.05..=1000.0).unit("head heights"),
        /// How fast turbulence is carried along.
        drift: f32 = number(2.0, 0.0..=200.0).unit("m/s"),
        /// Another seed, other turbulence.
        seed: u32 = whole(0, 0..=i32::MAX as u32),
    }
}

/// What not every kind of wind has, and which have it.
const OF_KINDS: [(&str, &[WindKind]); 7] = [
    ("gusts", &[WindKind::Direction]),
    (
        "yaw",
        &[WindKind::Direction, WindKind::Vortex, WindKind::Turbulence],
    ),
    (
        "pitch",
        &[WindKind::Direction, WindKind::Vortex, WindKind::Turbulence],
    ),
    ("place", &[WindKind::Point, WindKind::Vortex]),
    ("radius", &[WindKind::Point, WindKind::Vortex]),
    ("size", &[WindKind::Turbulence]),
    ("drift", &[WindKind::Turbulence]),
];

/// The parts of a motion script.
pub const MOTION_PARTS: &[FilePart] = &[
    FilePart {
        name: "script",
        doc: "How head, wind and hair move, a file of its own: NAME.motion.ron.",
        example: "(version: 1, moves: [...], keys: [...], winds: [...], shapes: [...], bodies: [...], body_keys: [...])",
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
    BODIES,
    FilePart {
        name: "body_keys",
        doc: "Keyframes of bodies, those of this script and of the preset's, each joined by a spline.",
        example: "body_keys: [(body: \"ball\", time: 0), (body: \"ball\", time: 1, at: (0, 0, -2)), ...]",
        table: BodyKeySection::TABLE,
        places: &[],
    },
];

/// What of a script is a list.
const LISTS: [&str; 6] = ["keys", "moves", "winds", "shapes", "bodies", "body_keys"];

/// Reads the script `text`, which messages call `file`.
///
/// # Errors
///
/// All mistakes of the file, each with its line and column.
pub(crate) fn parse(file: &str, text: &str) -> Result<MotionScript, PresetErrors> {
    let mut reader = Reader::of("motion script", file, text);
    let fields = reader.fields(text, "the motion");
    reader.report()?;
    let (lists, plain): (Vec<Field>, Vec<Field>) = fields
        .into_iter()
        .partition(|field| LISTS.contains(&field.name));
    if plain.iter().all(|field| field.name != "version") {
        reader.error(
            text,
            format!("the motion needs `version: {VERSION}`, the version of its format"),
        );
    }
    let top: ScriptFields = reader.section_beside(&plain, "the motion", &LISTS);
    let mut script = MotionScript {
        period: Some(f64::from(top.period)).filter(|period| *period > 0.0),
        hold: top.hold.map(f64::from),
        has_wake: top.wake,
        closes: top.closes,
        ..MotionScript::default()
    };
    for list in lists {
        if list.name == "bodies" {
            script.named_bodies = NamedBody::read_list(&mut reader, list.value);
            continue;
        }
        for item in reader.list(list.value, list.name) {
            match list.name {
                "body_keys" => script.body_keys.push(NamedKey::read(&mut reader, item)),
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
                _ => script.winds.push(wind(&mut reader, item)),
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
    if top.closes {
        let field = plain.iter().find(|field| field.name == "loop");
        let place = field.map_or("", |field| field.name);
        script.loop_place = Some(reader.place(place));
        check_loop(&mut reader, place, &script);
    }
    reader.report()?;
    Ok(script)
}

/// Reports what keeps a script from going round.
fn check_loop<'a>(reader: &mut Reader<'a>, place: &'a str, script: &MotionScript) {
    let Some(period) = script.period else {
        reader.error(
            place,
            "loop: how long is it? The script needs a `period` in seconds, such as period: 2",
        );
        return;
    };
    let beyond = |(start, length): (f64, f64)| start > 0.0 && start + length > period;
    let winds = script.winds.iter().map(|wind| (wind.start, wind.length));
    if let Some(number) = winds.map(beyond).position(|is| is) {
        reader.error(
            place,
            format!(
                "loop: wind {} begins within the period of {period} s and blows beyond it; let it begin at 0, or end in time",
                number + 1
            ),
        );
    }
    let [begin, end] = [script.head_before(0.0), script.head_before(period)];
    if !is_alike(begin, end) {
        reader.error(
            place,
            format!(
                "loop: the head ends elsewhere than it begins: turned by {}, moved by {} where it was {} and {}; {COMES_ROUND}",
                shown(end.turn),
                shown(end.shift),
                shown(begin.turn),
                shown(begin.shift)
            ),
        );
        return;
    }
    let [begins, ends] = [[0.0, MOMENT], [period - MOMENT, period]].map(|moment| {
        let [from, to] = moment.map(|time| script.head_before(time));
        [to.turn - from.turn, to.shift - from.shift].map(|way| way / MOMENT)
    });
    let is_as_fast = |part: usize, least: f64| {
        let [begin, end] = [begins[part], ends[part]];
        begin.distance(end) <= least + 0.01 * begin.length().max(end.length())
    };
    if !is_as_fast(0, 1.0) || !is_as_fast(1, 0.01) {
        reader.error(
            place,
            format!(
                "loop: the head ends in another motion than it begins in: by {} degrees and {} head heights a second where it \
                 was {} and {}; {COMES_ROUND}",
                shown(ends[0]),
                shown(ends[1]),
                shown(begins[0]),
                shown(begins[1])
            ),
        );
    }
}

/// Seconds over which speeds are measured.
const MOMENT: f64 = 1e-5;

/// What a loop asks of its moves.
const COMES_ROUND: &str = "what turns and stays needs another that turns it back, and a swing goes from 0 to the end, a whole number of \
                           swings in the period (a walk of two steps)";

/// Whether two poses look the same: within a hundredth of a degree, and of a hundredth of a head height.
fn is_alike(one: HeadPose, other: HeadPose) -> bool {
    let spin = (one.spin - other.spin).rem_euclid(360.0);
    one.turn.abs_diff_eq(other.turn, 0.01)
        && one.shift.abs_diff_eq(other.shift, 1e-4)
        && spin.min(360.0 - spin) < 0.01
}

fn shown(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(|x| (x * 100.0).round() / 100.0 + 0.0);
    format!("({x}, {y}, {z})")
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

fn wind<'a>(reader: &mut Reader<'a>, item: &'a str) -> Wind {
    let given = reader.fields(item, "a wind");
    let fields: WindFields = reader.section_of(&given, "a wind");
    for field in &given {
        let of = OF_KINDS.iter().find(|(name, _)| *name == field.name);
        if let Some((name, kinds)) = of.filter(|(_, kinds)| !kinds.contains(&fields.kind)) {
            let kinds: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
            reader.error(
                field.name,
                format!(
                    "{name}: a wind of kind {} has none, only {}",
                    fields.kind.name(),
                    kinds.join(" and ")
                ),
            );
        }
    }
    // The angles are within their ranges, so there is a direction.
    let from = direction_from_angles(fields.yaw, fields.pitch).map_or(DVec3::X, Vec3::as_dvec3);
    Wind {
        start: f64::from(fields.start),
        length: f64::from(fields.length),
        direction: -from,
        speed: f64::from(fields.speed),
        gusts: f64::from(fields.gusts),
        kind: fields.kind,
        place: Vec3::from(fields.place).as_dvec3(),
        radius: f64::from(fields.radius),
        size: f64::from(fields.size),
        drift: f64::from(fields.drift),
        seed: fields.seed,
    }
}
