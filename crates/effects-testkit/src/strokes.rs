//! Strokes are finite, of no negative radius, there and not there where they should be.

use crate::hair;
use crate::joint::{Joint, list};
use crate::values::{Case, defaults, extremes, some_instances};
use effects::wgsl::{Stroke, clump_disc, vec2};
use effects::{AnyEffect, CLUMP_DISCS, Input, LayerProgram, Reach, Strokes};

/// Strokes side by side, at most: no clump is so wide that more would be seen.
const MOST_INSTANCES: u32 = 1024;

/// A radius that nobody sees, in 1/300 of the head's height.
const DUST: f32 = 1e-3;

/// Share of a stroke's joints that may be dust: where it tapers, some are.
const MOST_DUST: f32 = 0.05;

/// The strokes of `instance` at these joints. The layer's seed is 1.
pub(crate) fn evaluate(program: &dyn LayerProgram, joints: &[Joint], instance: u32) -> Vec<Stroke> {
    let joints_as_lists = list(joints, program.inputs());
    let mut strokes = Strokes::default();
    program.evaluate(&joints_as_lists, 0..joints.len(), instance, 1, &mut strokes);
    strokes.iter().collect()
}

pub(crate) fn on_any_joint(effect: &dyn AnyEffect) -> Result<(), String> {
    look_at(effect, &defaults(effect), &hair::hostile_joints())
}

pub(crate) fn with_any_parameters(effect: &dyn AnyEffect) -> Result<(), String> {
    let mut joints = hair::hostile_joints();
    let ordinary = hair::joints();
    joints.extend(
        ordinary
            .iter()
            .step_by(7)
            .map(|joint| ("an ordinary joint", *joint)),
    );
    for case in extremes(effect) {
        look_at(effect, &case, &joints)?;
    }
    Ok(())
}

/// Farther strokes would vanish where their strands leave the picture.
pub(crate) fn near(effect: &dyn AnyEffect) -> Result<(), String> {
    let joints = hair::joints();
    for case in extremes(effect) {
        let program = effect.program(&case.values);
        let (own, farthest) = (program.reach(), Reach::FARTHEST);
        let has_unit = program.inputs().has(Input::Unit);
        if !(own.clumps <= farthest.clumps && own.units <= farthest.units) {
            return Err(format!(
                "{}: its reach is {own:?}, and no stroke may exceed {farthest:?}",
                case.name
            ));
        }
        for instance in some_instances(program.instances()) {
            let strokes = evaluate(&*program, &joints, instance);
            for (stroke, joint) in strokes.iter().zip(&joints) {
                let reach = stroke.offset.length().0 + stroke.radius;
                let most = own.clumps * joint.clump_radius
                    + own.units * if has_unit { joint.unit } else { 1.0 };
                if stroke.radius > 0.0 && reach > 1.0001 * most {
                    return Err(format!(
                        "{}: stroke {instance} reaches {reach} from its clump's middle, and by its `reach` {most} is the most",
                        case.name
                    ));
                }
                let Some(beyond) = program.beyond() else {
                    continue;
                };
                let clump = (0..CLUMP_DISCS).map(|disc| {
                    let [x, y, size] =
                        clump_disc(disc, joint.clump_radius, joint.clump_shift).to_array();
                    (joint.clump_shift + vec2([x, y])).length().0 + size
                });
                let reach = (joint.clump_shift + stroke.offset).length().0 + stroke.radius;
                let unit = if has_unit { joint.unit } else { 1.0 };
                let most = clump.fold(0.0, f32::max)
                    + (beyond.clumps * joint.clump_radius).min(beyond.units * unit);
                if stroke.radius > 0.0 && reach > 1.0001 * most {
                    return Err(format!(
                        "{}: stroke {instance} reaches {reach} from its strand, and by its `beyond` {most} is the most",
                        case.name
                    ));
                }
            }
        }
    }
    Ok(())
}

/// What is hidden by what an effect only claims to draw would be missing.
pub(crate) fn clump(effect: &dyn AnyEffect) -> Result<(), String> {
    let hostile = hair::hostile_joints();
    let hostile = hostile.into_iter().map(|(_, joint)| joint);
    let joints: Vec<Joint> = hair::joints().into_iter().chain(hostile).collect();
    let mut cases = extremes(effect);
    cases.push(defaults(effect));
    for case in cases {
        let program = effect.program(&case.values);
        let count = program.instances();
        if program.is_clump() && (effect.rank() < 0 || count < CLUMP_DISCS) {
            return Err(format!(
                "{}: it `IS_CLUMP`, and has the rank {} and {count} strokes: at least 0 and {CLUMP_DISCS} are needed",
                case.name,
                effect.rank()
            ));
        }
        for instance in some_instances(count) {
            let strokes = evaluate(&*program, &joints, instance);
            for (stroke, joint) in strokes.iter().zip(&joints) {
                let disc = clump_disc(instance, joint.clump_radius, joint.clump_shift);
                let is_disc = [stroke.offset.x, stroke.offset.y, stroke.radius] == disc.to_array();
                if program.is_clump() && instance < CLUMP_DISCS && !is_disc {
                    return Err(format!(
                        "{}: it `IS_CLUMP`, and stroke {instance} is another than the clump's disc: {stroke:?}",
                        case.name
                    ));
                }
                if !program.may_be_nearer() && stroke.depth_offset < 0.0 {
                    return Err(format!(
                        "{}: stroke {instance} has the depth offset {}, which its WGSL doesn't tell",
                        case.name, stroke.depth_offset
                    ));
                }
            }
        }
    }
    Ok(())
}

/// What is wrong with the strokes of these joints.
fn look_at(
    effect: &dyn AnyEffect,
    case: &Case,
    joints: &[(&'static str, Joint)],
) -> Result<(), String> {
    let program = effect.program(&case.values);
    let (count, shortest) = (program.instances(), program.shortest());
    if count > MOST_INSTANCES {
        return Err(format!(
            "{}: it has {count} strokes side by side, more than {MOST_INSTANCES}",
            case.name
        ));
    }
    if !(shortest >= 0.0 && shortest.is_finite()) {
        return Err(format!("{}: its `shortest` is {shortest}", case.name));
    }
    let only_joints: Vec<Joint> = joints.iter().map(|(_, joint)| *joint).collect();
    for instance in some_instances(count) {
        let strokes = evaluate(&*program, &only_joints, instance);
        if strokes.len() != joints.len() {
            return Err(format!(
                "{} joints give {} strokes",
                joints.len(),
                strokes.len()
            ));
        }
        for (stroke, (name, _)) in strokes.iter().zip(joints) {
            if let Some(fault) = fault(stroke) {
                return Err(format!(
                    "{}, on {name}: stroke {instance}'s {fault}",
                    case.name
                ));
            }
        }
        // A path of one joint, which has neither a joint before nor one after.
        for joint in &only_joints {
            if evaluate(&*program, std::slice::from_ref(joint), instance).len() != 1 {
                return Err(format!("{}: a single joint gives no stroke", case.name));
            }
        }
    }
    Ok(())
}

/// What is not as it should be in a stroke.
fn fault(stroke: &Stroke) -> Option<String> {
    let [red, green, blue] = stroke.color.to_array();
    let numbers = [
        ("radius", stroke.radius),
        ("offset.x", stroke.offset.x),
        ("offset.y", stroke.offset.y),
        ("depth_offset", stroke.depth_offset),
        ("red", red),
        ("green", green),
        ("blue", blue),
    ];
    let infinite = numbers.iter().find(|(_, value)| !value.is_finite());
    if let Some((name, value)) = infinite {
        return Some(format!("{name} is {value}"));
    }
    let negative =
        |(name, value): &&(&str, f32)| *value < 0.0 && (*name == "radius" || is_color(name));
    let (name, value) = numbers.iter().find(negative)?;
    Some(format!("{name} is {value}: `max(.., 0.0)` is needed"))
}

fn is_color(name: &str) -> bool {
    ["red", "green", "blue"].contains(&name)
}

pub(crate) fn something(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&defaults(effect).values);
    let joints = hair::joints();
    let draws = |instance| {
        let strokes = evaluate(&*program, &joints, instance);
        strokes.iter().any(|stroke| stroke.radius > 0.0)
    };
    if (0..program.instances()).any(draws) {
        return Ok(());
    }
    Err("at its defaults it draws nothing on a head of hair that is lit from the front".to_owned())
}

pub(crate) fn nothing(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&defaults(effect).values);
    let joints = hair::joints();
    for instance in 0..program.instances() {
        let strokes = evaluate(&*program, &joints, instance);
        let dust = |stroke: &&Stroke| stroke.radius > 0.0 && stroke.radius < DUST;
        let share = strokes.iter().filter(dust).count() as f32 / strokes.len() as f32;
        if share > MOST_DUST {
            return Err(format!(
                "at {:.0} % of the joints stroke {instance} is thinner than {DUST} units, and drawn \
                 though nobody sees it: return a radius of 0 there",
                100.0 * share
            ));
        }
        if !effect.inputs().contains(&Input::ClumpRadius) {
            continue;
        }
        let bare = joints.iter().map(|joint| Joint {
            clump_radius: 0.0,
            ..*joint
        });
        let strokes = evaluate(&*program, &bare.collect::<Vec<_>>(), instance);
        if let Some(stroke) = strokes.iter().find(|stroke| stroke.radius > 0.0) {
            return Err(format!(
                "where the clump has no size, as at tips, stroke {instance} has the radius {}: \
                 tips are to be points",
                stroke.radius
            ));
        }
    }
    Ok(())
}

/// Seeds of the layer for which strokes are looked for: which strands have one, and how far it reaches, differs from seed to seed.
const SEEDS: u32 = 8;

pub(crate) fn in_extent(effect: &dyn AnyEffect) -> Result<(), String> {
    let ordinary = hair::joints();
    let strands = ordinary.chunk_by(|a, b| a.strand == b.strand);
    let hostile = hair::hostile_joints();
    let alone = hostile.iter().map(|(name, joint)| (*name, vec![*joint]));
    let strands = strands.map(|joints| ("an ordinary strand", joints.to_vec()));
    let strands: Vec<(&str, Vec<Joint>)> = strands.chain(alone).collect();
    let mut cases = extremes(effect);
    cases.push(defaults(effect));
    for case in cases {
        let program = effect.program(&case.values);
        for (name, joints) in &strands {
            let lists = list(joints, program.inputs());
            for instance in some_instances(program.instances()) {
                for seed in 0..SEEDS {
                    let extent = program.extent(&lists, 0..joints.len(), instance, seed);
                    let mut radii = Vec::new();
                    program.radii(&lists, 0..joints.len(), instance, seed, &mut radii);
                    let has_size = |joint: &usize| radii[*joint] > 0.0 && !extent.contains(joint);
                    if let Some(joint) = (0..joints.len()).find(has_size) {
                        return Err(format!(
                            "{}, on {name}: its `extent` has the joints {} to {} of stroke {instance}, and at joint {joint} \
                             the stroke has the radius {}: `extent` must hold every joint with a size",
                            case.name, extent.start, extent.end, radii[joint]
                        ));
                    }
                }
            }
        }
    }
    Ok(())
}
