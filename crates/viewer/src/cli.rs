//! The command line.

use crate::engine::Backend;
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  viewer presets/twin-tails.ron
      shows and edits this look
  viewer
      begins with the presets of this folder, or a new look

What is changed in the window is changed in the preset's text; Ctrl+S writes it. F1 lists all keys.";

/// Styles a head of hair live.
#[derive(Parser)]
#[command(name = "viewer", version, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The preset, a .ron file
    pub preset: Option<PathBuf>,

    /// What draws the hair
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendChoice,
}

/// What draws.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum BackendChoice {
    /// A graphics card where there is one, else the CPU
    Auto,
    /// The CPU
    Cpu,
    /// A graphics card, or a driver that draws in software
    Gpu,
}

impl From<BackendChoice> for Backend {
    fn from(choice: BackendChoice) -> Self {
        match choice {
            BackendChoice::Auto => Self::Auto,
            BackendChoice::Cpu => Self::Cpu,
            BackendChoice::Gpu => Self::Gpu,
        }
    }
}
