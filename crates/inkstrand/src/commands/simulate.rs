//! `inkstrand simulate`: a sequence's strands, simulated once.

use super::read_preset;
use super::render::progress_bar;
use super::scene::{open, parse};
use crate::Failure;
use crate::cli::SimulateOptions;
use crate::whole_file::write_whole;
use effects::Registry;
use stage::Bake;

pub(crate) fn simulate(options: &SimulateOptions, registry: &Registry) -> Result<(), Failure> {
    let text = read_preset(&options.preset).map_err(Failure::Failed)?;
    let mut preset = parse(&options.preset, &text, registry)?;
    options.scene.apply(&mut preset).map_err(Failure::Usage)?;
    let files = options.scene.files(&options.preset);
    let mut stage = open(&preset, &files, options.quiet)?;

    let fps = preset.sections.scene.fps;
    let (first, last) = options.frames;
    let bar = progress_bar(options.quiet, u64::from(last - first) + 1);
    let mut bake = Bake::default();
    for frame in first..=last {
        let time = frame as f32 / fps;
        stage.advance_to(time)?;
        stage.record(time, &mut bake);
        bar.inc(1);
    }
    bar.finish_and_clear();
    write_whole(&options.output, stage.bake_text(bake)?.as_bytes())?;
    if !options.quiet {
        eprintln!("wrote {}", options.output.display());
    }
    Ok(())
}
