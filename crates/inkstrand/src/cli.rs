//! The command line: what there is, and what it says about itself.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  inkstrand render presets/twin-tails.ron
      writes twin-tails.png in this folder
  inkstrand render presets/outlined.ron --hair groom.tfx --head head.obj --guides 150 -o out.png
      another groom on another head, with 150 of its strands
  inkstrand render look.ron --camera 30,10 --set hair.silhouette.width=3
      from the viewer's right and a little above, with thicker lines
  inkstrand check presets/*.ron
      names every mistake in these presets
  inkstrand effects hair.silhouette
      lists an effect's parameters with units, ranges and defaults";

/// Draws animated hair as comics and cartoons do.
#[derive(Parser)]
#[command(name = "inkstrand", version, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Draw a preset: one picture, or a sequence
    Render(Box<RenderOptions>),
    /// Name every mistake in presets
    Check {
        /// Presets to check
        #[arg(required = true)]
        presets: Vec<PathBuf>,
    },
    /// List the effects, or one effect's parameters
    Effects {
        /// An effect's id, such as hair.base
        id: Option<String>,
    },
    /// Write a commented preset to start from (not built yet)
    New {
        /// The preset to write
        file: PathBuf,
    },
    /// Bake the strands of a sequence (not built yet)
    Simulate {
        /// The preset
        preset: PathBuf,
        /// The bake to write
        #[arg(short, long)]
        output: PathBuf,
        /// Frames A-B
        #[arg(long, value_name = "A-B")]
        frames: Option<String>,
    },
    /// Convert between hair formats (not built yet)
    Convert {
        /// File to read
        input: PathBuf,
        /// File to write
        output: PathBuf,
    },
}

#[derive(Args)]
pub(crate) struct RenderOptions {
    /// The preset, a .ron file
    pub preset: PathBuf,

    /// Picture to write; `#` marks become the frame's number [default: the preset's name, here]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,

    /// Hair in place of the preset's: .tfx or .strands.ron
    #[arg(long, value_name = "FILE")]
    pub hair: Option<PathBuf>,

    /// Head in place of the preset's: .obj
    #[arg(long, value_name = "FILE")]
    pub head: Option<PathBuf>,

    /// Strands to keep, spread evenly over the scalp, the same ones every time; 0 keeps all
    #[arg(long, value_name = "N")]
    pub guides: Option<u32>,

    /// Frames to draw, at the preset's frame rate
    #[arg(long, value_name = "A-B", conflicts_with = "time", value_parser = parse_frames)]
    pub frames: Option<(u32, u32)>,

    /// Moment to draw
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_finite)]
    pub time: Option<f32>,

    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<(u32, u32)>,

    /// Samples a pixel, 1 to 256
    #[arg(long, value_name = "N")]
    pub samples: Option<u32>,

    /// What draws: auto takes a real GPU where there is one, else the CPU
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,

    /// Where the eye stands, in degrees: 0,0 looks at the face; distance in head heights
    #[arg(long, value_name = "YAW,PITCH[,DISTANCE]", allow_hyphen_values = true, value_parser = parse_numbers)]
    pub camera: Option<Numbers>,

    /// Where the light comes from, in degrees: 0,0 shines at the face
    #[arg(long, value_name = "YAW,PITCH", allow_hyphen_values = true, value_parser = parse_numbers)]
    pub light: Option<Numbers>,

    /// Colour behind everything, or none for a transparent picture
    #[arg(long, value_name = "none|RRGGBB")]
    pub background: Option<String>,

    /// Set a parameter of a layer or section, such as hair.silhouette.width=3 or clump.size=1.2
    #[arg(long, value_name = "LAYER.PARAM=VALUE")]
    pub set: Vec<String>,

    /// Draw only this layer (repeatable)
    #[arg(long, value_name = "LAYER")]
    pub only: Vec<String>,

    /// Threads to draw with [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,

    /// Write a line of JSON a frame: times, counts, bytes
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    Auto,
    Cpu,
    Gpu,
}

/// Numbers with commas between them.
#[derive(Clone)]
pub(crate) struct Numbers(pub Vec<f32>);

fn parse_finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a number".to_owned()),
    }
}

fn parse_numbers(text: &str) -> Result<Numbers, String> {
    let numbers = text
        .split(',')
        .map(|part| parse_finite(part.trim()).map_err(|_| format!("`{part}` is not a number")));
    Ok(Numbers(numbers.collect::<Result<_, _>>()?))
}

fn parse_frames(text: &str) -> Result<(u32, u32), String> {
    let wrong = || "frames are A-B, such as 0-23".to_owned();
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let first: u32 = first.parse().map_err(|_| wrong())?;
    let last: u32 = last.parse().map_err(|_| wrong())?;
    if first > last {
        return Err(format!("frame {first} comes after frame {last}"));
    }
    Ok((first, last))
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    text.split_once(['x', 'X'])
        .and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)))
        .ok_or_else(|| "a size is WxH, such as 960x720".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory as _;
        Arguments::command().debug_assert();
    }

    #[test]
    fn frames_and_sizes() {
        assert_eq!(parse_frames("100-110"), Ok((100, 110)));
        assert_eq!(parse_frames("7"), Ok((7, 7)));
        assert!(parse_frames("3-1").is_err() && parse_frames("a-b").is_err());
        assert_eq!(parse_size("960x720"), Ok((960, 720)));
        assert!(parse_size("960").is_err() && parse_size("-1x4").is_err());
        assert!(parse_numbers("30,NaN").is_err() && parse_numbers("30,").is_err());
    }
}
