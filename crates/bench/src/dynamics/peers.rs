//! Other programs on the falling strand: scripts that drive `MuJoCo` and pyPBD, where they are installed.

use super::targets::MANY;
use crate::results::Row;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The script for many strands, which uses those of the folder.
const MANY_STRANDS: &str = include_str!("peers_many.py");
/// Side by side.
const STRANDS: usize = 72;
/// What the folder is.
const SCRIPTS: &str = "--peers=DIR or INKSTRAND_PEERS must name the folder of bench_mujoco.py and bench_pbd.py, scripts that \
    drive the other programs";
/// How to get what is missing.
pub const INSTALL: &str = "python3 -m venv venv && venv/bin/pip install mujoco==4.0.0 pypbd scipy numpy, \
    then INKSTRAND_PYTHON=venv/bin/python";

/// Where the scripts are and what runs them.
#[derive(Clone, Debug)]
pub struct Peers {
    /// With `bench_mujoco.py` and `bench_pbd.py`.
    pub folder: PathBuf,
    /// A Python.
    pub python: PathBuf,
}

/// A program, its module and its script's arguments.
struct Peer {
    name: &'static str,
    module: &'static str,
    script: &'static str,
    arguments: Vec<String>,
}

impl Peers {
    /// The scripts of `folder`, or of the one that `INKSTRAND_PEERS` names; and the Python that `INKSTRAND_PYTHON` names, by
    /// default `python3`.
    ///
    /// # Errors
    ///
    /// When neither names a folder.
    pub fn new(folder: Option<&Path>) -> Result<Self, String> {
        let variable = |name| std::env::var_os(name).map(PathBuf::from);
        let folder = folder.map(Path::to_owned);
        Ok(Self {
            folder: (folder.or_else(|| variable("INKSTRAND_PEERS")))
                .ok_or_else(|| format!("--peers: no folder is named; {SCRIPTS}"))?,
            python: variable("INKSTRAND_PYTHON").unwrap_or_else(|| "python3".into()),
        })
    }

    /// Rows of what can be run, and a line for each that can't; the scripts' own files go to `out`.
    ///
    /// # Errors
    ///
    /// When there are no scripts, no Python, or a script fails.
    pub fn rows(&self, out: &Path, quick: bool) -> Result<(Vec<Row>, Vec<String>), String> {
        if !self.folder.join("bench_mujoco.py").exists() {
            return Err(format!("no peers in {}; {SCRIPTS}", self.folder.display()));
        }
        let folder = self
            .folder
            .canonicalize()
            .map_err(|error| error.to_string())?;
        std::fs::create_dir_all(out).map_err(|error| error.to_string())?;
        let out = out.canonicalize().map_err(|error| error.to_string())?;
        let (mut rows, mut missing) = (Vec::new(), Vec::new());
        for peer in peers(quick) {
            if let Err(error) = self.python(&["-c", &format!("import {}", peer.module)]) {
                let reason = error.lines().last().unwrap_or_default().to_owned();
                missing.push(format!(
                    "{}: not run ({reason}); to install: {INSTALL}",
                    peer.name
                ));
                continue;
            }
            let file = out.join(format!("dynamics-{}.csv", peer.module));
            // The scripts append.
            if file.exists() {
                std::fs::remove_file(&file).map_err(|error| error.to_string())?;
            }
            let path = file.to_string_lossy().into_owned();
            let script = folder.join(peer.script).to_string_lossy().into_owned();
            let mut arguments = vec![script.as_str(), &path];
            arguments.extend(peer.arguments.iter().map(String::as_str));
            self.python(&arguments)?;
            let count = STRANDS.to_string();
            let scripts = folder.to_string_lossy().into_owned();
            let name = if peer.module == "mujoco" {
                "mujoco"
            } else {
                "pypbd"
            };
            self.python(&["-c", MANY_STRANDS, &scripts, &path, &count, "1,4", name])?;
            let text =
                std::fs::read_to_string(&file).map_err(|error| format!("{path}: {error}"))?;
            rows.extend(parse(&text)?);
        }
        Ok((rows, missing))
    }

    fn python(&self, arguments: &[&str]) -> Result<(), String> {
        let python = self.python.display();
        let output = Command::new(&self.python)
            .args(arguments)
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .output()
            .map_err(|error| format!("{python}: {error}"))?;
        if output.status.success() {
            return Ok(());
        }
        let text = String::from_utf8_lossy(&output.stderr);
        Err(format!("{python}: {}: {}", output.status, text.trim_end()))
    }
}

fn peers(quick: bool) -> [Peer; 2] {
    let owned = |arguments: &[&str]| arguments.iter().map(|a| (*a).to_owned()).collect();
    let (stable_steps, steps) = if quick {
        ("4", "1,2,4,8")
    } else {
        ("9", "1,2,4,8,16,64,256")
    };
    [
        Peer {
            name: "MuJoCo",
            module: "mujoco",
            script: "bench_mujoco.py",
            arguments: owned(&[
                "chain:discrete,flexN:discrete",
                "20",
                "10",
                "dynamic",
                stable_steps,
            ]),
        },
        Peer {
            name: "pyPBD",
            module: "pypbd",
            script: "bench_pbd.py",
            arguments: owned(&["20", "10", "dynamic", "direct:1", steps]),
        },
    ]
}

/// The scripts' rows: peer, model, integrator, mode, Gamma, elements, variables, step, steps a frame, error, seconds
/// for a second and strand, stretch. Rows of many strands take their errors from those of one.
fn parse(text: &str) -> Result<Vec<Row>, String> {
    let mut rows: Vec<Row> = Vec::new();
    for line in text.lines() {
        let broken = || format!("a row of a peer that can't be read: {line}");
        let parts: Vec<&str> = line.trim_end().split(',').collect();
        let &[
            peer,
            model,
            integrator,
            mode,
            gamma,
            _,
            _,
            _,
            knob,
            error,
            seconds,
            _,
        ] = &parts[..]
        else {
            return Err(broken());
        };
        let number = |text: &str| text.parse::<f64>().map_err(|_| broken());
        let name = peer.split('-').next().unwrap_or(peer);
        let method = match name {
            "mujoco" => format!("{name}-{model}-{integrator}"),
            _ => format!("{name}-{}", model.replace('_', "-")),
        };
        let knob: usize = knob.parse().map_err(|_| broken())?;
        let one = format!("drop-{}", number(gamma)?);
        let (scene, error) = if mode == "many" {
            let is_it = |row: &&Row| row.scene == one && row.method == method && row.knob == knob;
            // Of a step at which one strand wasn't stable, the time says nothing.
            let Some(row) = rows.iter().find(is_it) else {
                continue;
            };
            (format!("{one}{MANY}"), row.error)
        } else {
            (one, Some(number(error)?))
        };
        rows.push(Row {
            scene,
            method,
            knob,
            seconds: number(seconds)?,
            error,
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: &str = "\
        mujoco-4.0.0,chain,discrete,dynamic,10.0,20,60,0.0416667,1,2.4520e-01,4.5000e-04,0.00e+00\r\n\
        pypbd-2.2.2,direct_it1,PBD-BE,dynamic,10.0,20,120,0.0104167,4,1.5500e-01,3.6000e-03,1.00e-03\r\n\
        pypbd-2.2.2,direct_it1,PBD-BE,many,10.0,20,0,0.01,4,,0.003,0\r\n\
        pypbd-2.2.2,direct_it1,PBD-BE,many,10.0,20,0,0.04,1,,0.001,0\r\n";

    #[test]
    fn rows_of_the_scripts() {
        let rows = parse(LINES).unwrap();
        assert_eq!(rows.len(), 3);
        let first = &rows[0];
        assert_eq!((first.scene.as_str(), first.knob), ("drop-10", 1));
        assert_eq!(first.method, "mujoco-chain-discrete");
        assert_eq!((first.seconds, first.error), (4.5e-4, Some(0.2452)));
        assert_eq!(rows[1].method, "pypbd-direct-it1");
        let many = &rows[2];
        assert_eq!(
            (many.scene.as_str(), many.error),
            ("drop-10-x72", Some(0.155))
        );
        assert!(parse("mujoco,chain").is_err());
    }

    #[test]
    fn what_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let mut peers = Peers {
            folder: folder.path().to_owned(),
            python: "no-such-python".into(),
        };
        let error = peers.rows(folder.path(), true).unwrap_err();
        assert!(error.contains("INKSTRAND_PEERS"), "{error}");
        std::fs::write(folder.path().join("bench_mujoco.py"), "").unwrap();
        let (rows, missing) = peers.rows(folder.path(), true).unwrap();
        assert!(rows.is_empty());
        assert!(missing[0].starts_with("MuJoCo: not run"), "{missing:?}");
        assert!(missing[1].contains("pip install mujoco"), "{missing:?}");
        peers.folder = folder.path().join("none");
        assert!(peers.rows(folder.path(), true).is_err());
    }
}
