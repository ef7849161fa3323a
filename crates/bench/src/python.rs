//! Other programs that have Python modules, driven by the scripts of `crates/bench/peers`.

use crate::BenchError;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the scripts are and what runs them.
#[derive(Clone, Debug)]
pub struct Python {
    scripts: PathBuf,
    python: PathBuf,
}

impl Python {
    /// The Python of this name, for the scripts of the project in `root`.
    ///
    /// # Errors
    ///
    /// When there is none, or it lacks one of these programs (their names and their modules): how to install them, by the file of `requirements` beside the scripts.
    pub fn new(
        root: &Path,
        python: PathBuf,
        programs: &[[&str; 2]],
        requirements: &str,
    ) -> Result<Self, BenchError> {
        let scripts = root.join("crates/bench/peers");
        let this = Self { scripts, python };
        for [name, module] in programs {
            this.run(&["-c", &format!("import {module}")])
                .map_err(|error| {
                    // A traceback ends with its reason.
                    let error = error.to_string();
                    let reason = error.lines().last().unwrap_or_default();
                    format!(
                        "{name} can't be run: {reason}\nto install the other programs: python3 -m venv venv && \
                         venv/bin/pip install -r {}, then INKSTRAND_PYTHON=venv/bin/python",
                        this.scripts.join(requirements).display()
                    )
                })?;
        }
        Ok(this)
    }

    /// Where a script is.
    #[must_use]
    pub fn script(&self, name: &str) -> String {
        self.scripts.join(name).display().to_string()
    }

    /// What Python prints.
    ///
    /// # Errors
    ///
    /// When it can't be started or fails: what it says of it.
    pub fn run(&self, arguments: &[&str]) -> Result<String, BenchError> {
        let python = self.python.display();
        let output = Command::new(&self.python)
            .args(arguments)
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .output()
            .map_err(|error| format!("{python}: {error}"))?;
        if output.status.success() {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        let text = String::from_utf8_lossy(&output.stderr);
        Err(format!("{python}: {}: {}", output.status, text.trim_end()).into())
    }
}
