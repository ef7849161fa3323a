//! `inkstrand check`: every mistake of every preset.

use super::read_preset;
use crate::Failure;
use effects::Registry;
use stage::Preset;
use std::path::PathBuf;

pub(crate) fn check(presets: &[PathBuf], registry: &Registry) -> Result<(), Failure> {
    let mut messages = Vec::new();
    for path in presets {
        match read_preset(path) {
            Ok(text) => {
                if let Err(errors) = Preset::parse(&path.display().to_string(), &text, registry) {
                    messages.extend(errors.0.iter().map(ToString::to_string));
                }
            }
            Err(Failure::Failed(message) | Failure::Usage(message)) => messages.push(message),
        }
    }
    if messages.is_empty() {
        return Ok(());
    }
    for message in &messages {
        eprintln!("{message}\n");
    }
    let mistakes = if messages.len() == 1 {
        "mistake"
    } else {
        "mistakes"
    };
    Err(Failure::Failed(format!("{} {mistakes}", messages.len())))
}
