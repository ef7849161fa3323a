//! `inkstrand simulate`: a sequence's strands, simulated once.

use super::progress::Bar;
use super::scene::{Source, say_returns};
use crate::Failure;
use crate::cli::SimulateOptions;
use crate::paths::{file_name, is_same};
use crate::say::say;
use effects::Registry;
use hair_io::{MOST_OF_DATA, WholeFile};
use stage::{Bake, Files, Preset};
use std::io::Write as _;
use std::path::Path;

/// About how many bytes a point of a frame takes in a bake.
const BYTES_OF_POINT: u64 = 37;

pub(crate) fn simulate(options: &SimulateOptions, registry: &Registry) -> Result<(), Failure> {
    let source = Source::read(&options.preset)?;
    let mut preset = source.parse(registry)?;
    options.scene.apply(&mut preset).map_err(Failure::Usage)?;
    // A new one is made in its place.
    preset.sections.hair.bake = None;
    // Poses are held when they are drawn.
    preset.sections.motion.on = 1;
    let files = options.scene.files(&options.preset, &preset)?;
    check_output(&options.output, &options.preset, &preset, &files)?;
    // From now on its folder takes it.
    let mut file = WholeFile::create(&options.output)?;
    let mut stage = source.open(&preset, &files, options.quiet)?;

    let fps = preset.sections.scene.fps;
    let (first, last) = options.frames;
    let time_of = |frame: u32| frame as f32 / fps;
    let frames = u64::from(last - first) + 1;
    let mut bake = Bake::new(&preset, &files, &stage.scene)?;
    if stage.strand_count() == 0 {
        let preset = options.preset.display();
        return Err(Failure::Failed(format!(
            "{preset}: it has no hair to simulate"
        )));
    }
    check_size(stage.point_count() as u64, frames).map_err(Failure::Failed)?;
    let mut bar = Bar::from_first_frame(
        options.quiet,
        &mut stage,
        &preset,
        time_of(first),
        frames,
        None,
    )?;
    for frame in first..=last {
        let time = time_of(frame);
        stage.advance_to(time)?;
        stage.record(time, &mut bake);
        bar.inc()?;
    }
    bar.finish();
    let text = stage.bake_text(bake)?;
    check_length(text.len() as u64).map_err(Failure::Failed)?;
    file.write_all(text.as_bytes())?;
    file.finish()?;
    if !options.quiet {
        say_returns(&stage);
        say(format_args!("wrote {}", options.output.display()));
    }
    Ok(())
}

/// Refuses, before the work, so many frames of hair of so many points that `render` would not read their bake.
fn check_size(points: u64, frames: u64) -> Result<(), String> {
    let frame = points * BYTES_OF_POINT;
    let fit = MOST_OF_DATA / frame.max(1);
    check_length(frames.saturating_mul(frame))
        .map_err(|message| format!("{message}; about {fit} frames of this hair fit"))
}

/// Refuses a bake of more bytes than `render` reads.
fn check_length(bytes: u64) -> Result<(), String> {
    if bytes <= MOST_OF_DATA {
        return Ok(());
    }
    let [found, most] = [bytes, MOST_OF_DATA].map(|bytes| bytes as f64 / f64::from(1 << 30));
    Err(format!(
        "this bake would have {found:.1} GiB, and `render` reads up to {most} GiB of one: make several, each of a part of --frames"
    ))
}

/// Refuses a name that `render` would not take for strands, a file that is read, and one that is no bake: it may be
/// somebody's work.
fn check_output(
    output: &Path,
    preset_file: &Path,
    preset: &Preset,
    files: &Files,
) -> Result<(), Failure> {
    let shown = output.display();
    if !file_name(output).ends_with(".strands.ron") {
        let message = format!("-o {shown}: a bake's name must end in .strands.ron");
        return Err(Failure::Usage(message));
    }
    let mut read = preset.all_files(files);
    read.push(preset_file.to_owned());
    if read.iter().any(|path| is_same(path, output)) {
        let message = format!("-o {shown}: it is read, and cannot be written");
        return Err(Failure::Usage(message));
    }
    if output.is_file() && !stage::is_bake(output) {
        return Err(Failure::Failed(format!(
            "{shown} is there already and does not say that `inkstrand simulate` made it: remove it, or take another name"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bake_is_as_large_as_what_is_read_of_one() {
        assert!(check_length(MOST_OF_DATA).is_ok() && check_length(MOST_OF_DATA + 1).is_err());
        let fit = MOST_OF_DATA / (1000 * BYTES_OF_POINT);
        assert!(check_size(1000, fit).is_ok());
        let message = check_size(1000, fit + 1).unwrap_err();
        assert!(
            message.contains(&format!("about {fit} frames")),
            "{message}"
        );
        assert!(check_size(u64::from(u32::MAX), 1_000_000).is_err());
    }
}
