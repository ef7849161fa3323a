//! Other programs on the falling strand: `MuJoCo` and pyPBD, driven by the Python scripts of `crates/bench/peers`.

use super::falls::{self, Truth};
use super::names::MANY;
use crate::BenchError;
use crate::python::Python;
use crate::results::Row;
use glam::DVec3;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Weight against stiffness of the strand that they are given, and its elements.
pub const GAMMA: f64 = 10.0;
const ELEMENTS: usize = 20;
/// Side by side, in the scene of many strands.
const STRANDS: usize = 72;
/// Steps of 1/24 s of one strand, where it must be quick too, and of many strands.
const STEPS: &[usize] = &[1, 2, 4, 8, 16, 64, 256];
const QUICK_STEPS: &[usize] = &[1, 2, 4, 8];
const MANY_STEPS: &[usize] = &[1, 4];

/// A program, as its script names it.
struct Peer {
    name: &'static str,
    modules: &'static str,
    script: &'static str,
}

const PEERS: [Peer; 2] = [
    Peer {
        name: "MuJoCo",
        modules: "numpy, mujoco",
        script: "mujoco_strands.py",
    },
    Peer {
        name: "pyPBD",
        modules: "numpy, pypbd",
        script: "pypbd_strands.py",
    },
];

/// Runs the programs.
#[derive(Clone, Debug)]
pub struct Peers(Python);

impl Peers {
    /// Those of the project in `root`, run by `python`.
    ///
    /// # Errors
    ///
    /// When there is no such Python, or it lacks one of the programs: how to install them.
    pub fn new(root: &Path, python: PathBuf) -> Result<Self, BenchError> {
        let programs = PEERS.map(|peer| [peer.name, peer.modules]);
        Python::new(root, python, &programs, "requirements.txt").map(Self)
    }

    /// Rows of one strand and of many, held against the truth of [`GAMMA`].
    ///
    /// # Errors
    ///
    /// When a script fails.
    pub fn rows(&self, quick: bool, truth: &Truth) -> Result<Vec<Row>, BenchError> {
        let steps = if quick { QUICK_STEPS } else { STEPS };
        let mut rows = Vec::new();
        for peer in &PEERS {
            let one = format!("drop-{GAMMA}");
            let many = format!("{one}{MANY}");
            rows.extend(self.scene(peer, &one, 1, steps, truth)?);
            rows.extend(self.scene(peer, &many, STRANDS, MANY_STEPS, truth)?);
        }
        Ok(rows)
    }

    fn scene(
        &self,
        peer: &Peer,
        scene: &str,
        strands: usize,
        steps: &[usize],
        truth: &Truth,
    ) -> Result<Vec<Row>, BenchError> {
        let script = self.0.script(peer.script);
        let numbers = [
            ("--elements", ELEMENTS.to_string()),
            ("--gamma", GAMMA.to_string()),
            ("--strands", strands.to_string()),
        ];
        let steps: Vec<String> = steps.iter().map(usize::to_string).collect();
        let mut arguments = vec![script.as_str()];
        arguments.extend(numbers.iter().flat_map(|(name, value)| [*name, value]));
        arguments.push("--steps");
        arguments.extend(steps.iter().map(String::as_str));
        let output = self.0.run(&arguments)?;
        let rows = output.lines().map(|line| row(scene, line, truth));
        let rows = rows.collect::<Result<Vec<_>, _>>();
        let rows = rows.map_err(|error| format!("{script}: {error}"))?;
        Ok(rows.into_iter().flatten().collect())
    }
}

/// The row of a script's line (`crates/bench/peers/falling.py` says what is in it), or none of a motion that went wrong:
/// its time says nothing.
fn row(scene: &str, line: &str, truth: &Truth) -> Result<Option<Row>, BenchError> {
    let invalid = || format!("a line that can't be read: {line}");
    let value: Value = serde_json::from_str(line).map_err(|_| invalid())?;
    let tips = value.get("tips").ok_or_else(invalid)?;
    if tips.is_null() {
        return Ok(None);
    }
    let tip = |tip: &Value| {
        let [x, y, z] = [0, 1, 2].map(|axis| tip[axis].as_f64());
        Some(DVec3::new(x?, y?, z?))
    };
    let tips = tips.as_array().ok_or_else(invalid)?;
    let tips: Option<Vec<DVec3>> = tips.iter().map(tip).collect();
    let tips = tips.filter(|tips| tips.len() + 1 == truth.path.len());
    let knob = value["steps"].as_u64().ok_or_else(invalid)?;
    Ok(Some(Row {
        scene: scene.to_owned(),
        method: value["method"].as_str().ok_or_else(invalid)?.to_owned(),
        knob: usize::try_from(knob).map_err(|_| invalid())?,
        seconds: value["seconds"].as_f64().ok_or_else(invalid)?,
        error: Some(falls::error(&tips.ok_or_else(invalid)?, &truth.path)),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// Two frames of a strand that stays level.
    fn truth() -> Truth {
        Truth {
            path: vec![DVec2::X; 3],
            origin: String::new(),
        }
    }

    #[test]
    fn a_line_of_a_script_is_a_row() {
        let line = r#"{"method": "mujoco-chain-discrete", "steps": 4, "seconds": 0.00045, "tips": [[1, 0, 0], [1, -0.1, 0.0]]}"#;
        let row = row("drop-10", line, &truth()).unwrap().unwrap();
        assert_eq!((row.scene.as_str(), row.knob), ("drop-10", 4));
        assert_eq!(row.method, "mujoco-chain-discrete");
        assert_eq!(row.seconds, 4.5e-4);
        assert!((row.error.unwrap() - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn what_went_wrong_is_no_row_and_what_cannot_be_read_an_error() {
        let lost = r#"{"method": "a", "steps": 1, "seconds": 0.1, "tips": null}"#;
        assert_eq!(row("drop-10", lost, &truth()), Ok(None));
        for line in [
            "",
            "a warning",
            "{}",
            r#"{"method": "a", "steps": 1, "seconds": 0.1, "tips": [[1, 0, 0]]}"#,
            r#"{"method": "a", "steps": 1, "seconds": 0.1, "tips": [[1, 0, 0], [1, 0]]}"#,
            r#"{"method": "a", "steps": -1, "seconds": 0.1, "tips": [[1, 0, 0], [1, 0, 0]]}"#,
        ] {
            assert!(row("drop-10", line, &truth()).is_err(), "{line}");
        }
    }

    #[test]
    fn without_the_programs_it_says_how_to_install_them() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let error = Peers::new(&root, "no-such-python".into());
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with("MuJoCo can't be run: no-such-python"));
        assert!(error.contains("pip install -r"), "{error}");
        assert!(root.join("crates/bench/peers/requirements.txt").exists());
        for peer in &PEERS {
            assert!(root.join("crates/bench/peers").join(peer.script).exists());
        }
    }
}
