//! An effect gets what it declares; the lists of all else are empty.

use crate::joint::{Joint, list};
use crate::{hair, values};
use effects::{AnyEffect, Input, InputSet, LayerProgram, Strokes};
use std::panic::{AssertUnwindSafe, catch_unwind};

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&values::defaults(effect).values);
    let joints = hair::joints();
    let works = |read: InputSet| {
        let run = AssertUnwindSafe(|| evaluate(&*program, &joints, read));
        catch_unwind(run).is_ok()
    };
    if !works(program.inputs()) && works(InputSet::of(Input::ALL)) {
        let declared: Vec<_> = effect.inputs().iter().map(|input| input.name()).collect();
        return Err(format!(
            "it reads an input that it doesn't declare; it declares {}",
            declared.join(", ")
        ));
    }
    Ok(())
}

fn evaluate(program: &dyn LayerProgram, joints: &[Joint], read: InputSet) {
    let mut strokes = Strokes::default();
    program.evaluate(&list(joints, read), 0..joints.len(), 0, 1, &mut strokes);
}
