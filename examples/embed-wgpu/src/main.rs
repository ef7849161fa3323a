//! The command line: a window, or with `--picture` one frame as a file.
#![allow(clippy::print_stderr)] // where a program tells its user what went wrong

mod window;

use clap::Parser;
use embed_wgpu::view::{DepthRange, Orbit};
use embed_wgpu::{Demo, Outcome, PassSettings, Shown, device, picture};
use std::path::PathBuf;
use std::process::ExitCode;

/// inkstrand's hair inside a wgpu program. Dragging turns the view, Space stops and starts time, Escape ends.
#[derive(Clone, Debug, Parser)]
struct Options {
    /// The hair's look.
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets/twin-tails.ron"))]
    preset: PathBuf,
    /// How head and wind move, but for objects, which move as their own presets say.
    #[arg(long, value_name = "FILE", default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/breeze.motion.ron"))]
    motion: PathBuf,
    /// Writes one frame as PNG, without a window.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Width and height of the picture, or of the window at first, in pixels.
    #[arg(long, value_name = "WxH", default_value = "960x720", value_parser = size)]
    size: [u32; 2],
    /// The picture's time, in seconds.
    #[arg(long, value_name = "S", default_value = "0", value_parser = time)]
    time: f32,
    /// Samples a pixel in the render pass.
    #[arg(long, value_name = "N", default_value = "4", value_parser = ["1", "4"])]
    samples: String,
    /// Stores depths with 1 in front and 0 infinitely far.
    #[arg(long)]
    reversed_depth: bool,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x');
    let sides = sides.and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let sides = sides.filter(|sides| sides.iter().all(|side| (1..=16_384).contains(side)));
    sides.ok_or_else(|| "WIDTHxHEIGHT, each 1 to 16384, such as 960x720".to_owned())
}

fn time(text: &str) -> Result<f32, String> {
    let time = text.parse().ok();
    let time = time.filter(|time| (0.0..=3600.0).contains(time));
    time.ok_or_else(|| "seconds from 0 to 3600".to_owned())
}

impl Options {
    fn pass(&self, color: wgpu::TextureFormat) -> PassSettings {
        PassSettings {
            color,
            samples: if self.samples == "1" { 1 } else { 4 },
            depth: if self.reversed_depth {
                DepthRange::Reversed
            } else {
                DepthRange::Forward
            },
        }
    }

    fn demo(&self, gpu: render::gpu::Gpu, color: wgpu::TextureFormat) -> Outcome<Demo> {
        Demo::open(
            gpu,
            self.pass(color),
            &self.preset,
            Some(self.motion.clone()),
        )
    }
}

fn main() -> ExitCode {
    let options = Options::parse();
    let done = match &options.picture {
        Some(file) => draw_picture(&options, file),
        None => window::run(options),
    };
    if let Err(error) = done {
        eprintln!("{error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

fn draw_picture(options: &Options, file: &std::path::Path) -> Outcome {
    let without_window = wgpu::InstanceDescriptor::new_without_display_handle();
    let (_, gpu) = device::open(&wgpu::Instance::new(without_window), None)?;
    let mut demo = options.demo(gpu, picture::FORMAT)?;
    let orbit = Orbit::START.after(options.time);
    picture::draw(&mut demo, options.size, options.time, orbit, Shown::ALL)?.write(file)
}
