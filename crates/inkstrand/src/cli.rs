//! The command line: what there is, and what it says about itself.

use crate::pass::Pass;
use clap::{Args, Parser, Subcommand, ValueEnum};
use render::MAX_SIZE;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  inkstrand render presets/twin-tails.ron
      writes twin-tails.png in this folder
  inkstrand render presets/outlined.ron --hair groom.tfx --head head.obj --guides 150 -o out.png
      another groom on another head, with 150 of its strands
  inkstrand render look.ron --camera 30,10 --set hair.silhouette.width=3
      from the viewer's right and a little above, with thicker lines
  inkstrand check presets
      names every mistake in the presets, styles and scripts of this folder
  inkstrand effects hair.silhouette
      lists an effect's parameters with units, ranges and defaults
  inkstrand new look.ron
      writes a preset to start from, with a hair style

Exit status: 0 done, 1 failed, 2 wrong usage, 130 interrupted (nothing half written is left),
101 a mistake of inkstrand's own, which it asks you to report";

const RENDER_EXAMPLES: &str = "\
Options take the place of what the preset says. What neither says has its default, which
`inkstrand effects SECTION` tells.

Units: degrees for angles, head heights (from chin to top) for distances, 1/300 of a head height
for widths of strokes. Frame N shows the hair at N / fps seconds.

Examples:
  inkstrand render presets/twin-tails.ron
      writes twin-tails.png in this folder
  inkstrand render look.ron --camera 35,10,6 --light -40,30
      seen from the viewer's right and a little above, six head heights away; lit from the left
  inkstrand render look.ron --frames 0-47 -o shot_####.png
      two seconds at 24 frames a second: shot_0000.png to shot_0047.png
  inkstrand render look.ron --frames 0-47 -o shot.apng
      the same in one file that moves
  inkstrand render look.ron --size 480x360 --samples 4 -o quick.png
      a quick look
  inkstrand render look.ron --background none --only hair.base
      the flat colour alone, on nothing
  inkstrand render look.ron --pass strand -o strands.png
      a colour for each strand, for a selection in a paint program; --pass depth, normal, u, ..
      are others, also of sequences
  inkstrand render look.ron --set hair.silhouette.width=3 --set clump.color=C9804B
      thicker lines, other hair
  inkstrand render look.ron --hair groom.tfx --head head.obj --guides 150
      this look on another groom, of which 150 strands are drawn";

const SIMULATE_EXAMPLES: &str = "\
A bake says what moved its hair: hair, head, script, `dynamics`, frame rate and seed. `render` refuses
it where one of them has changed since, and says which; layers, camera and light are free.

Examples:
  inkstrand simulate look.ron --motion walk.motion.ron --frames 0-95 -o walk.strands.ron
  inkstrand render look.ron --motion walk.motion.ron --bake walk.strands.ron --frames 0-95
      the pictures of `render` without --bake (nearly, with `clump: (normal: material)`), and no time
      spent on simulation";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  inkstrand completions bash > ~/.local/share/bash-completion/completions/inkstrand
  inkstrand completions zsh > \"${fpath[1]}/_inkstrand\"
  inkstrand completions fish > ~/.config/fish/completions/inkstrand.fish
New shells complete commands, options and file names.";

const EFFECTS_JSON: &str = "\
--json writes an object {version, sections, effects, style, motion}, style and motion being lists of
the parts of these files; with NAME, that section, effect or part alone:
  section    {id, meaning, parameters}; \"preset\" is what stands beside the sections, \"layers\" what
             each layer may say beside its effect's own parameters (in its `params`)
  effect     {id, meaning, paints_meshes, draws_lines, rank, depth_offset, parameters}
  part       {id, meaning, parameters}
  parameter  {name, meaning, type, default, unit?, min?, max?, varies?, choices?, repeats?}: varies is
             whether it may vary, repeats whether a picture goes on from its other edge
Types and their defaults in JSON, and how a preset, style or script writes them:
  number, integer   0.5                     0.5
  true or false     true                    true
  choice            \"linear\"                linear
  color             \"3FC1C0\"                \"3FC1C0\"
  color or none     \"none\"                  none, or \"3FC1C0\"
  texture           \"(steps: [..])\"         (steps: [..]), \"tones.png\", or none
  text              null                    \"hair.tfx\"
  two numbers       [0, 0]                  (0, 0)
  three numbers     [0, 0, 0]               (0, 0, 0)
  size              [960, 720]              (960, 720)
  places            null                    [(-40, 50), (40, 50)]
A default of null means that there is none, or for a layer that it is the effect's own, and for a
brush the tool's own.";

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
    #[command(after_help = RENDER_EXAMPLES)]
    Render(Box<RenderOptions>),
    /// Name every mistake in presets and in the files that they name
    Check {
        /// Presets, .motion.ron, .style.ron, .strands.ron or .tfx files, meshes (.obj, .ply, .gltf, .glb, .vrm), or folders, whose .ron files are checked
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// List effects and sections, or the parameters of one
    #[command(after_help = EFFECTS_JSON)]
    Effects {
        /// An effect's id such as hair.base, or a section such as clump, camera or layers
        name: Option<String>,
        /// Write the same as JSON, for programs
        #[arg(long)]
        json: bool,
    },
    /// Write a commented preset to start from, and NAME.style.ron, its hair style, beside it
    New {
        /// The preset to write; neither file may be there already
        #[arg(value_name = "NAME.ron")]
        file: PathBuf,
    },
    /// Simulate a sequence's strands once, for `render --bake`
    #[command(after_help = SIMULATE_EXAMPLES)]
    Simulate(Box<SimulateOptions>),
    /// Write what makes a shell complete the command line
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

#[derive(Args)]
pub(crate) struct RenderOptions {
    /// The preset, a .ron file
    pub preset: PathBuf,

    /// Picture to write, .png; `#` marks become the frame's number, of --time that of the nearest frame; .apng is one file of all frames, which moves [default: the preset's name, in the current folder]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub scene: SceneOptions,

    /// Motion of this hair that `inkstrand simulate` has written
    #[arg(long, value_name = "FILE")]
    pub bake: Option<PathBuf>,

    /// Frames to draw, first and last, at the preset's frame rate (fps)
    #[arg(long, value_name = "A-B", conflicts_with = "time", allow_hyphen_values = true, value_parser = parse_frames)]
    pub frames: Option<(u32, u32)>,

    /// Moment to draw, in seconds [default: 0]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = parse_time)]
    pub time: Option<f32>,

    /// Width and height in pixels, 1 to 16384 [default: the preset's]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = parse_size)]
    pub size: Option<(u32, u32)>,

    /// Samples a pixel, 1 to 256 [default: the preset's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub samples: Option<u32>,

    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,

    /// Write what samples show in place of the picture, for compositing
    #[arg(long, value_enum, value_name = "PASS")]
    pub pass: Option<Pass>,

    /// Where the eye stands: 0,0 looks at the face; positive degrees move it right and up; distance in head heights [default: the preset's]
    #[arg(long, value_name = "YAW,PITCH[,DISTANCE]", allow_hyphen_values = true, value_parser = parse_numbers)]
    pub camera: Option<Numbers>,

    /// Where the light comes from, in degrees: 0,0 shines at the face; positive is from the right and above [default: the preset's]
    #[arg(long, value_name = "YAW,PITCH", allow_hyphen_values = true, value_parser = parse_numbers)]
    pub light: Option<Numbers>,

    /// sRGB colour behind everything, or none for a transparent picture [default: the preset's]
    #[arg(long, value_name = "none|RRGGBB", value_parser = parse_background)]
    pub background: Option<Background>,

    /// Draw only this layer (repeatable)
    #[arg(long, value_name = "LAYER")]
    pub only: Vec<String>,

    /// Threads to draw with [default: one a core]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,

    /// Write a line of JSON a frame: milliseconds, counts, bytes. The file grows as frames are done; - is the standard output
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Args)]
pub(crate) struct SimulateOptions {
    /// The preset, a .ron file
    pub preset: PathBuf,

    /// Bake to write, .strands.ron; of files that are there it takes the place of a bake alone
    #[arg(short, long, value_name = "PATH")]
    pub output: PathBuf,

    #[command(flatten)]
    pub scene: SceneOptions,

    /// Frames to bake, first and last, at the preset's frame rate (fps)
    #[arg(long, value_name = "A-B", default_value = "0-47", allow_hyphen_values = true, value_parser = parse_frames)]
    pub frames: (u32, u32),

    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

/// What is in a scene, in place of the preset's.
#[derive(Args)]
pub(crate) struct SceneOptions {
    /// Hair in place of the preset's: .tfx, .strands.ron or .style.ron
    #[arg(long, value_name = "FILE")]
    pub hair: Option<PathBuf>,

    /// Head in place of the preset's: .obj, .ply, .gltf, .glb or .vrm
    #[arg(long, value_name = "FILE")]
    pub head: Option<PathBuf>,

    /// A character in place of the preset's head, in the colours and with the pictures of its file: .vrm, .glb, .gltf, .obj or .ply. Hair that it has as a mesh becomes strands, but for --hair. `docs/characters.md` shows more
    #[arg(long, value_name = "FILE", conflicts_with = "head")]
    pub character: Option<PathBuf>,

    /// How the head moves and the wind blows, in place of the preset's: .motion.ron
    #[arg(long, value_name = "FILE")]
    pub motion: Option<PathBuf>,

    /// Strands to keep, those that stand best for all, the same ones every time; 0 keeps all [default: the preset's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub guides: Option<u32>,

    /// Set a parameter of a layer (by its name) or section, or the seed, such as hair.silhouette.width=3, clump.size=1.2 or seed=7 (repeatable). Names of files are relative to the preset, as in it
    #[arg(long, value_name = "LAYER.PARAM=VALUE")]
    pub set: Vec<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// A real GPU where there is one, else the CPU
    Auto,
    /// The CPU: exact, any number of samples
    Cpu,
    /// A GPU, or a driver that draws in software where there is none; else fail
    Gpu,
}

/// Numbers with commas between them.
#[derive(Clone)]
pub(crate) struct Numbers(pub Vec<f32>);

/// A colour in linear light, or none.
#[derive(Clone, Copy)]
pub(crate) struct Background(pub Option<[f32; 3]>);

fn parse_background(text: &str) -> Result<Background, String> {
    match text {
        "none" => Ok(Background(None)),
        hex => match effects::parse_hex(hex) {
            Some(color) => Ok(Background(Some(color))),
            None => Err("a colour is six hexadecimal digits RRGGBB, or none".to_owned()),
        },
    }
}

fn parse_finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a number".to_owned()),
    }
}

/// The last moment, in seconds: more than a day.
const LAST_TIME: f32 = 100_000.0;

fn parse_time(text: &str) -> Result<f32, String> {
    match parse_finite(text)? {
        time if (0.0..=LAST_TIME).contains(&time) => Ok(time),
        _ => Err(format!("a time is from 0 to {LAST_TIME} seconds")),
    }
}

fn parse_numbers(text: &str) -> Result<Numbers, String> {
    let numbers = text
        .split(',')
        .map(|part| parse_finite(part.trim()).map_err(|_| format!("`{part}` is not a number")));
    Ok(Numbers(numbers.collect::<Result<_, _>>()?))
}

/// The last frame: eleven hours at 24 a second.
const LAST_FRAME: u32 = 999_999;

fn parse_frames(text: &str) -> Result<(u32, u32), String> {
    let wrong = || "frames are A-B, such as 0-23".to_owned();
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let first: u32 = first.parse().map_err(|_| wrong())?;
    let last: u32 = last.parse().map_err(|_| wrong())?;
    if first > last {
        return Err(format!("frame {first} comes after frame {last}"));
    }
    if last > LAST_FRAME {
        return Err(format!("frames go up to {LAST_FRAME}"));
    }
    Ok((first, last))
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let (width, height) = text
        .split_once(['x', 'X'])
        .and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)))
        .ok_or_else(|| "a size is WxH, such as 960x720".to_owned())?;
    if [width, height]
        .iter()
        .any(|side| !(1..=MAX_SIZE).contains(side))
    {
        return Err(format!("sides are 1 to {MAX_SIZE} pixels long"));
    }
    Ok((width, height))
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
        assert!(parse_frames("0-1000000").is_err() && parse_frames("-3-1").is_err());
        assert_eq!(parse_time("0"), Ok(0.0));
        assert!(parse_time("-1").is_err() && parse_time("1e6").is_err());
        assert_eq!(parse_size("960x720"), Ok((960, 720)));
        assert!(parse_size("960").is_err() && parse_size("-1x4").is_err());
        assert!(parse_size("0x720").is_err() && parse_size("960x16385").is_err());
        assert!(parse_numbers("30,NaN").is_err() && parse_numbers("30,").is_err());
    }
}
