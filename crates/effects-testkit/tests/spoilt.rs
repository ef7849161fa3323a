//! A good effect passes; spoilt in one way, it fails the check that is there for that.

use effects::wgsl::{Stroke, random, vec2};
use effects::{
    Hair, Input, Joints, MadePaths, Param, ParamKind, Parameters as _, StrandJoints, StrokeEffect,
    Values,
};
use effects_testkit::{Failures, conforms, steady};
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

effects::effect!("good");

/// A way to spoil the effect of `good.wgsl`. What is not overridden is as it should be.
trait Spoil: Send + Sync + 'static {
    const ID: &'static str = "test.good";
    const DOC: &'static str = "strokes where the hair is dark";
    const RANK: i32 = 100;
    const DEPTH_OFFSET: f32 = 0.0;
    const PARAMS: &'static [Param] = Program::PARAMS;
    const OWN_PATHS: bool = false;
    const IS_CLUMP: bool = false;
    const CASTS: bool = false;
    const WGSL: &'static str = Program::WGSL;
    fn stroke(good: Stroke, _joints: &Joints, _index: usize, _params: &Params) -> Stroke {
        good
    }
    fn instances(params: &Params) -> u32 {
        params.feathers
    }
    fn shortest() -> f32 {
        0.0
    }
    fn shadow_colors() -> &'static [&'static str] {
        &[]
    }
    fn extent(strand: &StrandJoints) -> Range<usize> {
        strand.range.clone()
    }
    fn make_paths(_hair: &Hair, _paths: &mut MadePaths) {}
}

struct Spoilt<S>(PhantomData<fn() -> S>);

impl<S: Spoil> effects::Parameters for Spoilt<S> {
    type Params = Params;
    const PARAMS: &'static [Param] = S::PARAMS;
    const INPUTS: &'static [Input] = Program::INPUTS;
    const WGSL: &'static str = S::WGSL;
    fn params(values: &Values) -> Params {
        Program::params(values)
    }
    fn set_number(params: &mut Params, index: usize, value: f32) {
        Program::set_number(params, index, value);
    }
}

impl<S: Spoil> effects::Program for Spoilt<S> {
    fn stroke(joints: &Joints, index: usize, instance: u32, seed: u32, params: &Params) -> Stroke {
        let good = <Program as effects::Program>::stroke(joints, index, instance, seed, params);
        S::stroke(good, joints, index, params)
    }
}

impl<S: Spoil> StrokeEffect for Spoilt<S> {
    type Program = Self;
    const ID: &'static str = S::ID;
    const DOC: &'static str = S::DOC;
    const RANK: i32 = S::RANK;
    const DEPTH_OFFSET: f32 = S::DEPTH_OFFSET;
    const OWN_PATHS: bool = S::OWN_PATHS;
    const IS_CLUMP: bool = S::IS_CLUMP;
    const CASTS: bool = S::CASTS;
    fn instances(params: &Params) -> u32 {
        S::instances(params)
    }
    fn shortest(_: &Params) -> f32 {
        S::shortest()
    }
    fn shadow_colors(_: &Params) -> &'static [&'static str] {
        S::shadow_colors()
    }
    fn extent(_: &Params, strand: &StrandJoints) -> Range<usize> {
        S::extent(strand)
    }
    fn make_paths(_: &Params, hair: &Hair, _: u32, paths: &mut MadePaths) {
        S::make_paths(hair, paths);
    }
}

struct Not;
impl Spoil for Not {}

#[test]
fn a_good_effect_passes() {
    effects_testkit::assert_conforms::<Spoilt<Not>>();
    effects_testkit::assert_steady::<Spoilt<Not>>(&[]);
    effects_testkit::assert_steady::<Spoilt<Not>>(&[("part", "tip"), ("taper", "0.1")]);
}

/// Expects that the effect fails a check whose name holds `check`, with a message that holds `message`.
#[track_caller]
fn assert_fails<S: Spoil>(check: &str, message: &str) {
    assert_among(conforms::<Spoilt<S>>(), check, message);
}

#[track_caller]
fn assert_among(result: Result<(), Failures>, check: &str, message: &str) {
    let failures = result.expect_err("it passes");
    let found = failures
        .failures
        .iter()
        .any(|failure| failure.check.contains(check) && failure.message.contains(message));
    assert!(found, "no `{check}` with `{message}` in:\n{failures}");
}

/// `spoil!(Name { items of Spoil })`
macro_rules! spoil {
    ($name:ident { $($item:item)* }) => {
        struct $name;
        impl Spoil for $name { $($item)* }
    };
}

#[test]
fn ids_are_vendor_and_name() {
    spoil!(Shouting { const ID: &'static str = "GOOD"; });
    assert_fails::<Shouting>("id", "`GOOD` is not `vendor.name`");
}

#[test]
fn it_must_say_what_it_is() {
    spoil!(Silent { const DOC: &'static str = " "; });
    assert_fails::<Silent>("says what it is", "DOC is empty");
    spoil!(Talkative { const DOC: &'static str = "two\nlines"; });
    assert_fails::<Talkative>("says what it is", "several lines");
}

#[test]
fn rank_and_depth_offset_are_a_layers() {
    spoil!(High { const RANK: i32 = 20_000; });
    assert_fails::<High>("rank", "rank is 20000");
    spoil!(Nowhere { const DEPTH_OFFSET: f32 = f32::NAN; });
    assert_fails::<Nowhere>("depth offset", "depth_offset is NaN");
}

#[test]
fn strokes_stay_near_their_strands() {
    spoil!(Far {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            Stroke { offset: good.offset + vec2([900.0, 0.0]), ..good }
        }
    });
    assert_fails::<Far>("stay near", "from its clump's middle");
}

/// The good parameters and one more.
const fn with(more: Param) -> [Param; 8] {
    let mut params = [more; 8];
    let mut i = 0;
    while i < 7 {
        params[i] = Program::PARAMS[i];
        i += 1;
    }
    params
}

const fn number(name: &'static str, doc: &'static str, [min, max, default]: [f32; 3]) -> Param {
    let kind = ParamKind::Number {
        min,
        max,
        default,
        varies: true,
    };
    Param {
        name,
        doc,
        unit: "",
        kind,
    }
}

#[test]
fn parameters_are_documented_and_their_defaults_allowed() {
    const CHECK: &str = "parameters are documented";
    spoil!(Layers { const PARAMS: &'static [Param] = &with(number("rank", "Its rank.", [0.0, 1.0, 0.0])); });
    assert_fails::<Layers>(CHECK, "rank: every layer has");
    spoil!(Twice { const PARAMS: &'static [Param] = &with(number("width", "Again.", [0.0, 1.0, 0.0])); });
    assert_fails::<Twice>(CHECK, "width: two parameters");
    spoil!(Secret { const PARAMS: &'static [Param] = &with(number("more", "", [0.0, 1.0, 0.0])); });
    assert_fails::<Secret>(CHECK, "more: nothing says");
    spoil!(Beyond { const PARAMS: &'static [Param] = &with(number("more", "More.", [0.0, 1.0, 2.0])); });
    assert_fails::<Beyond>(CHECK, "more: its default 2 is not from 0 to 1");
    spoil!(Backwards { const PARAMS: &'static [Param] = &with(number("more", "More.", [1.0, 0.0, 0.0])); });
    assert_fails::<Backwards>(CHECK, "more: 1 to 0 is no range");
    spoil!(Loud { const PARAMS: &'static [Param] = &with(number("More", "More.", [0.0, 1.0, 0.0])); });
    assert_fails::<Loud>(CHECK, "More: a name is lower case");
    const PINK: Param = Param {
        name: "pink",
        doc: "A colour.",
        unit: "",
        kind: ParamKind::Color { default: "pink" },
    };
    spoil!(Pink { const PARAMS: &'static [Param] = &with(PINK); });
    assert_fails::<Pink>(CHECK, "pink: its default \"pink\" is no colour");
}

#[test]
fn undeclared_inputs_are_not_there() {
    spoil!(Curious {
        fn stroke(good: Stroke, joints: &Joints, index: usize, _: &Params) -> Stroke {
            Stroke { depth_offset: joints.arc_length[index], ..good }
        }
    });
    assert_fails::<Curious>(
        "reads what it declares",
        "doesn't declare; it declares u, seed, across",
    );
}

#[test]
fn strokes_are_finite_on_any_joint() {
    spoil!(Divides {
        fn stroke(good: Stroke, joints: &Joints, index: usize, _: &Params) -> Stroke {
            let radius = good.radius / joints.clump_radius[index] * joints.clump_radius[index];
            Stroke { radius, ..good }
        }
    });
    assert_fails::<Divides>(
        "whatever the joint",
        "a clump of no size: stroke 0's radius is NaN",
    );
    spoil!(Shrinks {
        fn stroke(good: Stroke, joints: &Joints, index: usize, _: &Params) -> Stroke {
            Stroke { radius: good.radius - joints.u[index].floor(), ..good }
        }
    });
    assert_fails::<Shrinks>("whatever the joint", "a tip: stroke 0's radius is -");
    spoil!(Black {
        fn stroke(mut good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            good.color.y -= 1.0;
            good
        }
    });
    assert_fails::<Black>("whatever the joint", "green is -");
}

#[test]
fn strokes_are_finite_with_any_parameters() {
    spoil!(Wide {
        fn stroke(good: Stroke, _: &Joints, _: usize, params: &Params) -> Stroke {
            Stroke { depth_offset: 1.0 / (100.0 - params.width), ..good }
        }
    });
    assert_fails::<Wide>(
        "whatever the parameters",
        "with width = 100, on an ordinary joint",
    );
    spoil!(Many { fn instances(_: &Params) -> u32 { 5000 } });
    assert_fails::<Many>("whatever the joint", "5000 strokes side by side");
    spoil!(Short { fn shortest() -> f32 { -1.0 } });
    assert_fails::<Short>("whatever the joint", "`shortest` is -1");
}

#[test]
fn it_draws_something_and_where_it_draws_nothing_the_radius_is_zero() {
    spoil!(Nothing {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            Stroke { radius: 0.0, ..good }
        }
    });
    assert_fails::<Nothing>("draws something", "draws nothing on a head of hair");
    spoil!(Dusty {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            Stroke { radius: good.radius.max(1e-5), ..good }
        }
    });
    assert_fails::<Dusty>("where it draws nothing", "is thinner than 0.001 units");
    spoil!(Blunt {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            Stroke { radius: good.radius + 1.0, ..good }
        }
    });
    assert_fails::<Blunt>("where it draws nothing", "tips are to be points");
}

#[test]
fn strokes_lie_in_their_extent() {
    spoil!(Cut {
        fn extent(strand: &StrandJoints) -> Range<usize> {
            let middle = (strand.range.start + strand.range.end) / 2;
            middle..middle
        }
    });
    assert_fails::<Cut>("lie where it says", "must hold every joint with a size");
}

#[test]
fn it_is_the_clump_where_it_says_so() {
    spoil!(Feathers { const IS_CLUMP: bool = true; });
    assert_fails::<Feathers>("it is the clump", "another than the clump's disc");
    spoil!(Below {
        const IS_CLUMP: bool = true;
        const RANK: i32 = -1;
    });
    assert_fails::<Below>("it is the clump", "has the rank -1");
}

#[test]
fn a_shadow_falls_on_something() {
    spoil!(Nowhere { const CASTS: bool = true; });
    assert_fails::<Nowhere>("its rank and depth offset are a layer's", "it has no CLIP");
}

#[test]
fn shadows_have_their_colors_by_parameters() {
    spoil!(Tinted {
        fn shadow_colors() -> &'static [&'static str] {
            &["tint"]
        }
    });
    assert_fails::<Tinted>(
        "its rank and depth offset are a layer's",
        "shadow_colors names `tint`",
    );
}

#[test]
fn the_same_joint_has_the_same_stroke() {
    spoil!(Counts {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            static CALLS: AtomicU32 = AtomicU32::new(0);
            let call = CALLS.fetch_add(1, Ordering::Relaxed) as f32;
            Stroke { depth_offset: 1e-6 * call, ..good }
        }
    });
    assert_fails::<Counts>("bit for bit", "evaluated again: joint 0");
    spoil!(Places {
        fn stroke(good: Stroke, _: &Joints, index: usize, _: &Params) -> Stroke {
            Stroke { depth_offset: 1e-6 * index as f32, ..good }
        }
    });
    assert_fails::<Places>("bit for bit", "at another place in the list: joint 0");
    spoil!(Threads {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            thread_local!(static CALLS: std::cell::Cell<f32> = const { std::cell::Cell::new(-1.0) });
            // The main thread's answer is one, each other thread has its own.
            let main = std::thread::current().name().is_some();
            let shift = CALLS.with(|calls| if main { 0.0 } else { calls.get() });
            Stroke { offset: vec2([shift, 0.0]), ..good }
        }
    });
    assert_fails::<Threads>("bit for bit", "evaluated on threads: joint 0");
}

#[test]
fn rust_is_its_wgsl() {
    spoil!(Tuned {
        fn stroke(good: Stroke, _: &Joints, _: usize, _: &Params) -> Stroke {
            Stroke { radius: good.radius * 1.001, ..good }
        }
    });
    assert_fails::<Tuned>("its Rust is its WGSL", "is the Rust made by effects_build?");
}

#[test]
fn a_panic_is_a_failure() {
    spoil!(Panics {
        fn stroke(good: Stroke, joints: &Joints, index: usize, _: &Params) -> Stroke {
            assert!(joints.u[index] < 1.0, "no tips please");
            good
        }
    });
    assert_fails::<Panics>("whatever the joint", "it panics: no tips please");
}

#[test]
fn paths_are_finite_and_the_same_ones_in_every_frame() {
    const CHECK: &str = "its paths";
    spoil!(None_ { const OWN_PATHS: bool = true; });
    assert_fails::<None_>(CHECK, "makes no paths");
    spoil!(Infinite {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (i, strand) in hair.strands.iter().enumerate() {
                paths.push(i, 0, strand.particles.iter().map(|p| p.normalize()));
            }
        }
    });
    assert_fails::<Infinite>(CHECK, "of strands of no length: path 0 goes through [NaN");
    spoil!(Wanders {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (i, strand) in hair.strands.iter().enumerate() {
                if strand.particles[0].x > 0.0 {
                    paths.push(i, 0, strand.particles.iter().copied());
                }
            }
        }
    });
    assert_fails::<Wanders>(CHECK, "where the hair moves there are other paths");
    // What it keeps is where the hair was in the first frame.
    spoil!(Keeps {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            let tips = || hair.strands.iter().map(|own| own.point(1.0)).collect();
            let kept: std::sync::Arc<Vec<glam::Vec3>> = paths.once(tips);
            for (strand, own) in hair.strands.iter().enumerate() {
                paths.push(strand, 0, [own.point(0.0), kept[strand]]);
            }
        }
    });
    assert_fails::<Keeps>(CHECK, "in the second frame the paths are others");
    spoil!(Stranger {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            paths.push(hair.strands.len(), 0, [glam::Vec3::ZERO]);
        }
    });
    assert_fails::<Stranger>(CHECK, "which is not there");
}

#[test]
fn paths_that_jump_are_found() {
    // Chosen anew wherever the hair is.
    spoil!(Jumping {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (strand, hair) in hair.strands.iter().enumerate() {
                let tip = hair.point(1.0);
                let aside = 0.1 * random(tip.x.to_bits(), 0);
                paths.push(strand, 0, [hair.point(0.0), tip + glam::Vec3::X * aside]);
            }
        }
    });
    assert_fails::<Jumping>("none jumps", "path 0 of strand");
    // As far out as the head has come, though the hair came along.
    spoil!(Left {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (strand, own) in hair.strands.iter().enumerate() {
                let out = own.point_at_rest(0.0) - hair.head_center;
                paths.push(strand, 0, [own.point(0.0), own.point(1.0) + 0.1 * out]);
            }
        }
    });
    assert_fails::<Left>("none jumps", "elsewhere on a head that has moved");
    // Steps of 2 cm.
    spoil!(Stepping {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (strand, hair) in hair.strands.iter().enumerate() {
                let points = [0.0, 1.0].map(|u| (hair.point(u) / 0.02).floor() * 0.02);
                paths.push(strand, 0, points);
            }
        }
    });
    assert_fails::<Stepping>("none jumps", "jumps by");
    // Far beyond the tip, where hair moves fast.
    spoil!(Fast {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (strand, hair) in hair.strands.iter().enumerate() {
                paths.push(strand, 0, [0.0, 1.0, 20.0].map(|u| hair.point(u)));
            }
        }
    });
    effects_testkit::assert_conforms::<Spoilt<Fast>>();
    spoil!(Crowd {
        const OWN_PATHS: bool = true;
        fn make_paths(hair: &Hair, paths: &mut MadePaths) {
            for (strand, hair) in hair.strands.iter().enumerate() {
                (0..9).for_each(|number| paths.push(strand, number, [hair.point(0.0)]));
            }
        }
    });
    assert_fails::<Crowd>("its paths", "a strand has at most 8 paths");
}

#[test]
fn rust_reads_what_does_not_vary() {
    spoil!(Wide { fn instances(params: &Params) -> u32 { 1 + params.width as u32 % 3 } });
    assert_fails::<Wide>(
        "doesn't vary",
        "`width` may vary along the strand, and `instances`",
    );
}

#[test]
fn what_is_declared_is_read() {
    spoil!(Wasteful {
        const WGSL: &'static str = "struct Inputs { u: f32, gray: f32, across: vec2<f32>, }
            fn ahead(joint: Inputs) -> f32 { return joint.gray; }
            fn stroke(joint: Inputs) -> f32 { return ahead(joint) + joint.across.x; }";
    });
    assert_fails::<Wasteful>(
        "declares what it reads, and no more",
        "`u` is declared and never read",
    );
}

#[test]
fn ends_that_meet_are_tried() {
    spoil!(Meeting {
        fn stroke(mut good: Stroke, _: &Joints, _: usize, params: &Params) -> Stroke {
            // 0 / 0 where both are at the same place of their ranges, within them.
            let (from, to) = (params.threshold, params.taper);
            if from > 0.1 && from < 0.9 {
                good.radius *= ((from - to) / (from - to)).abs();
            }
            good
        }
    });
    assert_fails::<Meeting>("whatever the parameters", "of its range");
}

#[test]
fn strokes_that_jump_are_found() {
    let hard = steady::<Spoilt<Not>>(&[("taper", "0")]);
    assert_among(hard, "small changes", "jumps where `gray` goes from 0.");
    spoil!(Blinks {
        fn stroke(mut good: Stroke, joints: &Joints, index: usize, _: &Params) -> Stroke {
            if joints.across[index].x > 0.25 {
                good.color.x = 0.0;
            }
            good
        }
    });
    let blinks = steady::<Spoilt<Blinks>>(&[]);
    assert_among(
        blinks,
        "small changes",
        "jumps where `across` goes from [0.2",
    );
}

#[test]
fn failures_are_told_together() {
    spoil!(Bad {
        const DOC: &'static str = "";
        const RANK: i32 = -20_000;
    });
    let text = conforms::<Spoilt<Bad>>().unwrap_err().to_string();
    assert_eq!(
        text,
        "effect `test.good` fails 2 checks\n\
         - it says what it is:\n  DOC is empty: say in one line what it draws\n\
         - its rank and depth offset are a layer's:\n  its rank is -20000, not from -10000 to 10000"
    );
}
