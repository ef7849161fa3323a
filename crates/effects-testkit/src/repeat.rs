//! Same input, same bits: whatever else is in the list, however it is cut, on any thread.

use crate::hair;
use crate::joint::{Joint, list};
use crate::strokes::evaluate;
use crate::values::{defaults, some_instances};
use effects::wgsl::Stroke;
use effects::{AnyEffect, LayerProgram, Strokes};

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&defaults(effect).values);
    let joints = hair::joints();
    for instance in some_instances(program.instances()) {
        let whole = evaluate(&*program, &joints, instance);
        let same = |other: &[Stroke], how: &str| match first_difference(&whole, other) {
            None => Ok(()),
            Some(i) => Err(format!("{how}: joint {i} has another stroke {instance}")),
        };
        same(&evaluate(&*program, &joints, instance), "evaluated again")?;
        same(
            &in_chunks(&*program, &joints, instance),
            "evaluated in pieces",
        )?;
        same(
            &on_threads(&*program, &joints, instance),
            "evaluated on threads",
        )?;

        let reversed: Vec<Joint> = joints.iter().rev().copied().collect();
        let mut strokes = evaluate(&*program, &reversed, instance);
        strokes.reverse();
        same(&strokes, "at another place in the list")?;
    }
    Ok(())
}

fn first_difference(a: &[Stroke], b: &[Stroke]) -> Option<usize> {
    if a.len() != b.len() {
        return Some(a.len().min(b.len()));
    }
    a.iter().zip(b).position(|(a, b)| bits(a) != bits(b))
}

fn bits(stroke: &Stroke) -> [u32; 7] {
    let [red, green, blue] = stroke.color.to_array();
    let (x, y) = (stroke.offset.x, stroke.offset.y);
    [x, y, stroke.radius, stroke.depth_offset, red, green, blue].map(f32::to_bits)
}

/// Piece by piece of one list, the last piece first.
fn in_chunks(program: &dyn LayerProgram, joints: &[Joint], instance: u32) -> Vec<Stroke> {
    let lists = list(joints, program.inputs());
    let mut pieces = Vec::new();
    for start in (0..joints.len()).step_by(5).rev() {
        let mut strokes = Strokes::default();
        let range = start..(start + 5).min(joints.len());
        program.evaluate(&lists, range, instance, 1, &mut strokes);
        pieces.push(strokes.iter().collect::<Vec<_>>());
    }
    pieces.into_iter().rev().flatten().collect()
}

/// The list on several threads at once, each a part of it.
fn on_threads(program: &dyn LayerProgram, joints: &[Joint], instance: u32) -> Vec<Stroke> {
    let lists = &list(joints, program.inputs());
    let part = joints.len().div_ceil(4);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4)
            .map(|number| {
                let range =
                    (number * part).min(joints.len())..((number + 1) * part).min(joints.len());
                scope.spawn(move || {
                    let mut strokes = Strokes::default();
                    program.evaluate(lists, range, instance, 1, &mut strokes);
                    strokes.iter().collect::<Vec<_>>()
                })
            })
            .collect();
        let done = threads.into_iter().map(|thread| thread.join());
        done.flat_map(|strokes| strokes.expect("an effect that panics fails other checks"))
            .collect()
    })
}
