//! Installs what the tests need and the machine lacks: cargo's own tools, the web's target, a Vulkan driver
//! that needs no GPU, for the tests of the GPU backend, valgrind, which counts instructions, and Xvfb, a screen
//! that nobody sees, for the viewer's window.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::Outcome;
use crate::program::{cargo, line_of, succeed};
use crate::wasm;

/// Something that Debian has.
struct Needed {
    name: &'static str,
    is_there: fn() -> bool,
    packages: &'static [&'static str],
    /// What to do on other systems.
    elsewhere: &'static str,
}

const NEEDED: [Needed; 3] = [
    Needed {
        name: "Vulkan driver",
        is_there: has_vulkan_driver,
        // Mesa's software driver, and the loader that finds it.
        packages: &["mesa-vulkan-drivers", "libvulkan1"],
        elsewhere: "Only tests of the GPU backend need one. Install your system's Vulkan loader and a driver; \
                    Mesa's software driver (lavapipe) needs no GPU",
    },
    Needed {
        name: "valgrind",
        is_there: has_valgrind,
        packages: &["valgrind"],
        elsewhere: "Only `cargo xtask bench count` needs it. Install your system's",
    },
    Needed {
        name: "Xvfb",
        is_there: || succeeds(Command::new("Xvfb").arg("-help")),
        packages: &["xvfb"],
        elsewhere: "Only the viewer's test of a real window needs it, on Linux. Install your system's",
    },
];

/// Installs, or says what to install by hand.
///
/// # Errors
/// An installer fails.
pub fn run() -> Outcome {
    for tool in ["fmt", "clippy"] {
        if succeeds(&mut cargo(&[tool, "--version"])) {
            println!("cargo {tool}: found");
        } else {
            let component = if tool == "fmt" { "rustfmt" } else { tool };
            let mut rustup = Command::new("rustup");
            rustup.args(["component", "add", component]);
            println!("cargo {tool}: missing; runs {}", line_of(&rustup));
            succeed(rustup)?;
        }
    }

    if wasm::is_installed() {
        println!("{}: found", wasm::TARGET);
    } else {
        let mut rustup = Command::new("rustup");
        rustup.args(["target", "add", wasm::TARGET]);
        println!("{}: missing; runs {}", wasm::TARGET, line_of(&rustup));
        succeed(rustup)?;
    }

    for needed in &NEEDED {
        needed.install()?;
    }
    Ok(())
}

impl Needed {
    fn install(&self) -> Outcome {
        let name = self.name;
        if (self.is_there)() {
            println!("{name}: found");
            return Ok(());
        }
        match Installer::of_this_machine() {
            Some(installer) => {
                for command in installer.commands(self.packages) {
                    println!("{name}: missing; runs {}", line_of(&command));
                    succeed(command)?;
                }
            }
            None => println!(
                "{name}: missing, and this is no Debian with root or sudo. {}. On Debian: apt-get install {}",
                self.elsewhere,
                self.packages.join(" ")
            ),
        }
        Ok(())
    }
}

/// Whether there is a valgrind to run.
pub fn has_valgrind() -> bool {
    succeeds(Command::new("valgrind").arg("--version"))
}

/// Whether the Vulkan loader would find a driver, of a graphics card or in software.
pub fn has_vulkan_driver() -> bool {
    vulkan_driver_in(&driver_folders(|name| env::var_os(name)))
}

/// How to run apt-get here.
#[derive(Debug, PartialEq)]
enum Installer {
    AsRoot,
    WithSudo,
}

impl Installer {
    fn of_this_machine() -> Option<Self> {
        let user = Command::new("id").arg("-u").output();
        let root = user.is_ok_and(|output| output.stdout.trim_ascii() == b"0");
        Self::choose(
            succeeds(Command::new("apt-get").arg("--version")),
            root,
            // -n: never asks for a password.
            || succeeds(Command::new("sudo").args(["-n", "true"])),
        )
    }

    fn choose(apt_get: bool, root: bool, sudo: impl FnOnce() -> bool) -> Option<Self> {
        match (apt_get, root) {
            (false, _) => None,
            (true, true) => Some(Self::AsRoot),
            (true, false) => sudo().then_some(Self::WithSudo),
        }
    }

    /// The commands that install packages. None of them asks anything.
    fn commands(&self, packages: &[&str]) -> [Command; 2] {
        let update = ["update", "--quiet"].as_slice();
        let install = ["install", "--yes", "--quiet", "--no-install-recommends"];
        let install = [&install, packages].concat();
        [update, &install].map(|args| {
            // `env` sets the variable on sudo's other side, too.
            let words: &[&str] = match self {
                Self::AsRoot => &["env"],
                Self::WithSudo => &["sudo", "-n", "env"],
            };
            let mut command = Command::new(words[0]);
            command
                .args(&words[1..])
                .args(["DEBIAN_FRONTEND=noninteractive", "apt-get"])
                .args(args)
                .stdin(Stdio::null());
            command
        })
    }
}

/// Where the Vulkan loader looks for drivers' manifests (its document "LoaderDriverInterface",
/// "Driver Discovery on Linux"): files named in the environment, else folders.
fn driver_folders(variable: impl Fn(&str) -> Option<std::ffi::OsString>) -> Vec<PathBuf> {
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(files) = variable(name).filter(|files| !files.is_empty()) {
            return env::split_paths(&files).collect();
        }
    }
    let list = |name: &str, default: &str| -> Vec<PathBuf> {
        let paths = variable(name).unwrap_or_else(|| default.into());
        env::split_paths(&paths).collect()
    };
    let mut folders = list("XDG_CONFIG_DIRS", "/etc/xdg");
    folders.extend(["/etc", "/usr/local/etc", "/usr/local/share", "/usr/share"].map(PathBuf::from));
    folders.extend(list("XDG_DATA_DIRS", ""));
    if let Some(home) = variable("HOME") {
        folders.push(Path::new(&home).join(".local/share"));
    }
    folders
        .iter()
        .map(|folder| folder.join("vulkan/icd.d"))
        .collect()
}

/// True if one of `paths` is a driver's manifest, or a folder that holds one.
fn vulkan_driver_in(paths: &[PathBuf]) -> bool {
    let is_manifest = |path: &Path| path.extension() == Some(OsStr::new("json")) && path.is_file();
    paths.iter().any(|path| {
        let mut entries = fs::read_dir(path).into_iter().flatten().flatten();
        is_manifest(path) || entries.any(|entry| is_manifest(&entry.path()))
    })
}

fn succeeds(command: &mut Command) -> bool {
    let quiet = command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apt_get_runs_only_as_root_or_with_sudo() {
        let choose = |apt_get, root, sudo| Installer::choose(apt_get, root, || sudo);
        assert_eq!(choose(true, true, false), Some(Installer::AsRoot));
        assert_eq!(choose(true, false, true), Some(Installer::WithSudo));
        assert_eq!(choose(true, false, false), None);
        assert_eq!(choose(false, true, true), None);
    }

    #[test]
    fn the_commands_ask_nothing() {
        for installer in [Installer::AsRoot, Installer::WithSudo] {
            let lines = installer
                .commands(&["a", "b"])
                .map(|command| line_of(&command));
            for line in &lines {
                assert!(line.contains("env DEBIAN_FRONTEND=noninteractive apt-get "));
                let sudo = installer == Installer::WithSudo;
                assert_eq!(line.starts_with("sudo -n "), sudo, "{line}");
            }
            assert!(lines[1].contains("--yes"));
            assert!(lines[1].ends_with(" a b"));
        }
    }

    #[test]
    fn drivers_are_found_where_the_loader_finds_them() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("vulkan/icd.d");
        let manifest = folder.join("lvp_icd.json");
        let found = |name: &str, value: &Path| {
            let asked = |other: &str| (other == name).then(|| value.as_os_str().to_owned());
            let mut paths = driver_folders(asked);
            paths.retain(|path| path.starts_with(root.path())); // not this machine's own
            vulkan_driver_in(&paths)
        };
        fs::create_dir_all(&folder).unwrap();
        assert!(!found("XDG_DATA_DIRS", root.path()), "an empty folder");
        fs::write(folder.join("readme.txt"), "").unwrap();
        assert!(!found("XDG_DATA_DIRS", root.path()), "not a manifest");

        fs::write(&manifest, "{}").unwrap();
        assert!(found("XDG_DATA_DIRS", root.path()));
        assert!(found("XDG_CONFIG_DIRS", root.path()));
        assert!(found("VK_DRIVER_FILES", &manifest));
        assert!(found("VK_ICD_FILENAMES", &folder));
        assert!(!found("VK_ICD_FILENAMES", &root.path().join("gone.json")));
    }
}
