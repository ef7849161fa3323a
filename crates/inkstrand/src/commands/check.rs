//! `inkstrand check`: every mistake of every preset.

use super::{mistakes, read_preset};
use crate::Failure;
use effects::Registry;
use stage::Preset;
use std::path::PathBuf;

pub(crate) fn check(presets: &[PathBuf], registry: &Registry) -> Result<(), Failure> {
    let mut found = Vec::new();
    for path in presets {
        match read_preset(path) {
            Ok(text) => {
                if let Err(errors) = Preset::parse(&path.display().to_string(), &text, registry) {
                    found.extend(mistakes(&errors));
                }
            }
            Err(message) => found.push(message),
        }
    }
    if found.is_empty() {
        Ok(())
    } else {
        Err(Failure::Mistakes(found))
    }
}
