//! What an effect paints is a colour, the same for the same sample, of what it declares alone.

use crate::sample::{Sample, hostile_samples, list, samples};
use crate::values::{Case, defaults, extremes};
use effects::wgsl::Vec3;
use effects::{AnyEffect, LayerProgram, ParamKind, SampleInput, SampleSet};

/// The colours of these samples; none where the effect doesn't paint. The layer's seed is 1.
pub(crate) fn paint(program: &dyn LayerProgram, samples: &[Sample]) -> Vec<Vec3<f32>> {
    let Some(read) = program.paints() else {
        return Vec::new();
    };
    let mut colors = Vec::new();
    program.paint(&list(samples, read), 0..samples.len(), 1, &mut colors);
    colors
}

pub(crate) fn reads_what_it_declares(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&defaults(effect).values);
    let Some(declared) = program.paints() else {
        let is_texture = |kind: &ParamKind| matches!(kind, ParamKind::Texture { .. });
        return match effect.params().iter().find(|param| is_texture(&param.kind)) {
            Some(param) => Err(format!(
                "`{}` is a texture, which `place` looks up and `paint` reads: the effect has neither",
                param.name
            )),
            None => Ok(()),
        };
    };
    let samples = samples();
    let painted = |program: &dyn LayerProgram, read: SampleSet| {
        let mut colors = Vec::new();
        program.paint(&list(&samples, read), 0..samples.len(), 1, &mut colors);
        colors
            .iter()
            .map(|color| color.to_array().map(f32::to_bits))
            .collect::<Vec<_>>()
    };
    let names = |set: SampleSet| set.iter().map(SampleInput::name).collect::<Vec<_>>();
    // What isn't there is 0, which no sample is everywhere.
    if painted(&*program, declared) != painted(&*program, SampleSet::of(SampleInput::ALL)) {
        return Err(format!(
            "it reads what of a sample it doesn't declare; it declares {}",
            names(declared).join(", ")
        ));
    }
    for case in extremes(effect) {
        let program = effect.program(&case.values);
        let declared = program.paints().unwrap_or_default();
        if painted(&*program, program.reads()) != painted(&*program, declared) {
            return Err(format!(
                "{}: it reads more of a sample than `reads` says: {}",
                case.name,
                names(program.reads()).join(", ")
            ));
        }
    }
    Ok(())
}

pub(crate) fn is_a_color(effect: &dyn AnyEffect) -> Result<(), String> {
    let mut tried = hostile_samples();
    tried.extend(
        samples()
            .iter()
            .step_by(9)
            .map(|s| ("an ordinary sample", *s)),
    );
    for case in extremes(effect) {
        let program = effect.program(&case.values);
        look_at(&*program, &case, &tried)?;
    }
    Ok(())
}

fn look_at(
    program: &dyn LayerProgram,
    case: &Case,
    tried: &[(&'static str, Sample)],
) -> Result<(), String> {
    let samples: Vec<Sample> = tried.iter().map(|(_, sample)| *sample).collect();
    let colors = paint(program, &samples);
    if program.paints().is_some() && colors.len() != samples.len() {
        return Err(format!(
            "{} samples give {} colours",
            samples.len(),
            colors.len()
        ));
    }
    for (color, (what, _)) in colors.iter().zip(tried) {
        let channels = ["red", "green", "blue"].into_iter().zip(color.to_array());
        let mut wrong = channels.filter(|(_, light)| !(light.is_finite() && *light >= 0.0));
        if let Some((channel, light)) = wrong.next() {
            return Err(format!(
                "{}, on {what}: `paint` gives {channel} {light}",
                case.name
            ));
        }
    }
    Ok(())
}

pub(crate) fn is_the_same(effect: &dyn AnyEffect) -> Result<(), String> {
    let program = effect.program(&defaults(effect).values);
    let samples = samples();
    let whole = paint(&*program, &samples);
    let reversed: Vec<Sample> = samples.iter().rev().copied().collect();
    let mut again = paint(&*program, &reversed);
    again.reverse();
    let alone = samples
        .iter()
        .flat_map(|sample| paint(&*program, &[*sample]));
    let bits = |color: &Vec3<f32>| color.to_array().map(f32::to_bits);
    for (how, colors) in [
        ("at another place in the list", again),
        ("painted alone", alone.collect()),
    ] {
        if !whole.iter().map(bits).eq(colors.iter().map(bits)) {
            return Err(format!("{how} a sample has another colour"));
        }
    }
    Ok(())
}
