//! The tutorial's crate is built as it stands there, outside of the workspace, and its mistakes are told
//! as it says; crates made by earlier tutorials still compile.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, MutexGuard, PoisonError};

const TUTORIAL: &str = "docs/an-effect-in-30-lines.md";
const PAINTING: &str = "docs/a-tone-for-each-sample.md";
const REFERENCE: &str = "docs/effects.md";
const FIRST_CRATE: &str = "crates/inkstrand/tests/tutorial/first-crate.md";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap()
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap()
}

/// The workspace's settings for its dependencies, for a cargo outside of it: so what the workspace has built of other
/// crates is used. Ours draw a few small pictures here, and are built anew: that takes longest where they are optimised.
fn config() -> String {
    let manifest = read("Cargo.toml");
    let profile = manifest.split("[profile.dev.package]").nth(1).unwrap();
    let settings = profile.lines().take_while(|line| !line.starts_with('['));
    let is_ours = |line: &str| {
        let name = line.split(['.', ' ']).next().unwrap();
        root().join("crates").join(name).is_dir()
    };
    let others: String = settings
        .filter(|line| !is_ours(line))
        .map(|line| format!("{line}\n"))
        .collect();
    format!("[profile.dev]\nopt-level = 0\n[profile.dev.package]\n{others}")
}

/// A block of code, and the words before it.
struct Block {
    heading: String,
    language: String,
    text: String,
}

impl Block {
    /// The file that the block is, or is to be added to: **`path`** stands before it.
    fn file(&self) -> Option<&str> {
        self.heading.strip_prefix("**`")?.split('`').next()
    }

    fn is_added(&self) -> bool {
        self.heading.ends_with("at its end")
    }
}

fn blocks(markdown: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut before = "";
    let mut lines = markdown.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let code = lines.by_ref().take_while(|line| *line != "```");
            blocks.push(Block {
                heading: before.to_owned(),
                language: language.to_owned(),
                text: code.map(|line| format!("{line}\n")).collect(),
            });
        } else if !line.is_empty() {
            before = line;
        }
    }
    blocks
}

/// Runs the crate's program.
const PROGRAM: [&str; 5] = ["run", "--quiet", "--features", "program", "--"];

/// A crate outside of the workspace.
struct Crate {
    folder: tempfile::TempDir,
    /// Crates of one name share what cargo builds, and so are built one after the other.
    _turn: MutexGuard<'static, ()>,
}

static TURN: Mutex<()> = Mutex::new(());

impl Crate {
    /// Writes the tutorial's files; our crates are where they are.
    fn write(blocks: &[Block]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("src")).unwrap();
        fs::create_dir(folder.path().join(".cargo")).unwrap();
        fs::write(folder.path().join(".cargo/config.toml"), config()).unwrap();
        // The versions that we test with, which are there without a network.
        fs::copy(root().join("Cargo.lock"), folder.path().join("Cargo.lock")).unwrap();
        let this = Self {
            folder,
            _turn: TURN.lock().unwrap_or_else(PoisonError::into_inner),
        };
        let ours = format!("{}/", root().display());
        for block in blocks {
            let Some(file) = block.file() else { continue };
            let text = block.text.replace("../inkstrand/", &ours);
            if block.is_added() {
                this.change(file, |old| format!("{old}\n{text}"));
            } else {
                fs::write(this.path(file), text).unwrap();
            }
        }
        this
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    fn change(&self, file: &str, change: impl Fn(&str) -> String) {
        let old = fs::read_to_string(self.path(file)).unwrap();
        let new = change(&old);
        assert_ne!(new, old, "{file}");
        fs::write(self.path(file), new).unwrap();
    }

    /// Runs cargo. What it builds stays, for the next time.
    fn cargo(&self, arguments: &[&str]) -> Output {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
        Command::new(env!("CARGO"))
            .arg("--offline")
            .args(arguments)
            .env("CARGO_TARGET_DIR", target)
            .current_dir(self.folder.path())
            .output()
            .unwrap()
    }

    /// Runs cargo to a good end.
    #[track_caller]
    fn succeed(&self, arguments: &[&str]) {
        let output = self.cargo(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    }

    /// What cargo says of a mistake.
    #[track_caller]
    fn fail(&self, arguments: &[&str]) -> String {
        let output = self.cargo(arguments);
        assert!(
            !output.status.success(),
            "{arguments:?} succeeds: {}",
            text(&output)
        );
        text(&output)
    }

    /// What cargo says of an effect in which `good` was mistaken for `bad`.
    fn fail_with(&self, good: &str, bad: &str) -> String {
        self.fail_with_in("src/dip.wgsl", good, bad)
    }

    /// What cargo says where `good` was mistaken for `bad` in this file.
    fn fail_with_in(&self, effect: &str, good: &str, bad: &str) -> String {
        let right = fs::read_to_string(self.path(effect)).unwrap();
        self.change(effect, |text| text.replacen(good, bad, 1));
        let message = self.fail(&["build"]);
        fs::write(self.path(effect), right).unwrap();
        message
    }
}

fn text(output: &Output) -> String {
    let parts = [&output.stdout, &output.stderr];
    parts.map(|part| String::from_utf8_lossy(part)).concat()
}

/// How many pixels of a picture have this colour.
fn count(picture: &Path, color: [u8; 3]) -> usize {
    let file = std::io::BufReader::new(fs::File::open(picture).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let pixels = bytes[..info.buffer_size()].chunks(info.color_type.samples());
    pixels.filter(|pixel| pixel[..3] == color).count()
}

#[track_caller]
fn assert_says(message: &str, part: &str) {
    assert!(message.contains(part), "`{part}` is missing in:\n{message}");
}

#[test]
fn the_tutorial_is_right() {
    let blocks = blocks(&read(TUTORIAL));
    let dip_dye = Crate::write(&blocks);

    // It is a good effect, and to know that nothing is built that draws.
    let built = text(&dip_dye.cargo(&["tree", "--prefix=none", "--format={p}"]));
    assert_says(&built, "effects-testkit v");
    for unused in ["inkstrand v", "render v", "hair-sim v", "wgpu v", "gltf v"] {
        assert!(!built.contains(unused), "{built}");
    }
    dip_dye.succeed(&["test", "--quiet"]);

    // The picture has the dye in it, and without the layer it has not.
    let draw = |name: &str, more: &[&str]| {
        let size = ["--size", "320x240", "--samples", "4", "-o", name];
        dip_dye.succeed(&[&PROGRAM[..], &["render", "look.ron"], &size, more].concat());
        count(&dip_dye.path(name), [0x3F, 0xC1, 0xC0])
    };
    let dyed = draw("dyed.png", &[]);
    assert!(dyed > 1200, "{dyed} pixels of 76800 are dyed");
    assert_eq!(
        draw(
            "plain.png",
            &[
                "--set",
                "tutorial.dip.start=1",
                "--set",
                "tutorial.dip.raggedness=0"
            ]
        ),
        0
    );

    // What the program was built without is refused.
    let refused = |arguments: &[&str], why: &str| {
        let line = [&PROGRAM[..], &["render", "look.ron"], arguments].concat();
        assert_says(&dip_dye.fail(&line), why);
    };
    refused(
        &["--backend", "gpu", "-o", "gpu.png"],
        "this program was built without graphics cards",
    );
    assert!(!dip_dye.path("gpu.png").exists());
    fs::write(dip_dye.path("walker.glb"), "").unwrap();
    let look = fs::read_to_string(dip_dye.path("look.ron")).unwrap();
    dip_dye.change("look.ron", |text| {
        text.replace("layers:", "motion: (gltf: \"walker.glb\"), layers:")
    });
    refused(
        &["-o", "gltf.png"],
        "walker.glb: this program was built without glTF",
    );
    assert!(!dip_dye.path("gltf.png").exists());
    fs::write(dip_dye.path("look.ron"), look).unwrap();

    // Mistakes in the effect are told where the author made them, as the tutorial shows.
    let told: Vec<&str> = blocks
        .iter()
        .filter(|block| block.language == "text")
        .map(|block| block.text.trim_end())
        .collect();
    let [misspelt_input, misspelt_parameter] = told[..] else {
        panic!("{told:?}")
    };
    assert_says(
        &dip_dye.fail_with("joint.clump_radius", "joint.clump_radus"),
        misspelt_input,
    );
    let unknown = dip_dye.fail_with("across, clump_radius", "acros, clump_radius");
    assert_says(
        &unknown,
        "src/dip.wgsl:1:16: there is no input `acros`; there are: position,",
    );
    let undeclared = dip_dye.fail_with("u, across, clump", "u, clump");
    assert_says(
        &undeclared,
        "src/dip.wgsl:20:54: error: invalid field accessor `across`",
    );
    let broken = dip_dye.fail_with("let share = ", "let share  ");
    assert_says(&broken, "src/dip.wgsl:18:16: error: expected");
    let wrong_type = dip_dye.fail_with("begin + 0.1, joint.u", "begin + 0.1, joint.seed");
    assert_says(&wrong_type, "src/dip.wgsl:18:");
    let select = dip_dye.fail_with(
        "0.0, params.color)",
        "0.0, select(params.color, vec3<f32>(0.0), joint.u > 0.5))",
    );
    assert_says(&select, "src/dip.wgsl:20:");
    assert_says(&select, "vec3<bool>(condition)");
    let no_default = dip_dye.fail_with(" @default 0.55", "");
    assert_says(
        &no_default,
        "src/dip.wgsl:6:5: Params.start: its comment needs `@default VALUE`",
    );

    // And those in the preset in the preset.
    dip_dye.change("look.ron", |text| text.replace("start:", "strat:"));
    let message = dip_dye.fail(&[&PROGRAM[..], &["check", "look.ron"]].concat());
    assert_says(&message, misspelt_parameter);
}

#[test]
fn the_tutorial_of_painting_is_right() {
    let own = blocks(&read(PAINTING));
    let all: Vec<Block> = blocks(&read(TUTORIAL)).into_iter().chain(own).collect();
    let made = Crate::write(&all);
    made.succeed(&["test", "--quiet"]);

    let ink = |name: &str, lines: &str| {
        let set = format!("tutorial.cut.lines={lines}");
        let size = [
            "--size",
            "320x240",
            "--samples",
            "1",
            "--only",
            "tutorial.cut",
        ];
        let output = ["--set", &set, "-o", name];
        made.succeed(&[&PROGRAM[..], &["render", "cut.ron"], &size, &output].concat());
        count(&made.path(name), [0x17, 0x14, 0x2A])
    };
    let inked = ink("fine.png", "60");
    assert!(inked > 2000, "{inked} pixels of 76800 are ink");
    // As many lines of any width are as dark.
    let few = ink("few.png", "20");
    assert!(few.abs_diff(inked) * 4 < inked, "{few} {inked}");

    let told: Vec<String> = blocks(&read(PAINTING))
        .into_iter()
        .filter(|block| block.language == "text")
        .map(|block| block.text.trim_end().to_owned())
        .collect();
    let undeclared = made.fail_with_in("src/cut.wgsl", "at.tube", "at.tub");
    assert_eq!(told.len(), 1);
    assert_says(&undeclared, &told[0]);
    let unknown = made.fail_with_in("src/cut.wgsl", "color, tube", "color, tub");
    assert_says(&unknown, "src/cut.wgsl:2:");
}

/// The reference's effect in the tutorial's crate, as it stands there.
#[test]
fn the_effect_of_paths_of_its_own_is_right() {
    let own = blocks(&read(REFERENCE));
    let all: Vec<Block> = blocks(&read(TUTORIAL)).into_iter().chain(own).collect();
    let made = Crate::write(&all);
    let conforms =
        "#[test]\nfn it_conforms() {\n    effects_testkit::assert_conforms::<Stray>();\n}\n";
    made.change("src/stray.rs", |text| format!("{text}\n{conforms}"));
    made.succeed(&["test", "--quiet", "stray"]);
}

#[test]
fn the_painting_effect_has_twenty_lines() {
    let blocks = blocks(&read(PAINTING));
    let mut effects = blocks
        .iter()
        .filter(|block| block.file() == Some("src/cut.wgsl"));
    let lines = effects
        .next()
        .unwrap()
        .text
        .lines()
        .filter(|line| !line.is_empty())
        .count();
    assert!(lines <= 20, "{lines} lines");
}

#[test]
fn a_crate_of_the_first_tutorial_compiles_unchanged() {
    let dip_dye = Crate::write(&blocks(&read(FIRST_CRATE)));
    dip_dye.succeed(&["check", "--quiet", "--bins"]);
}

#[test]
fn the_effect_has_thirty_lines() {
    let blocks = blocks(&read(TUTORIAL));
    let lines = |file: &str| {
        let block = blocks
            .iter()
            .find(|block| block.file() == Some(file))
            .unwrap();
        block.text.lines().filter(|line| !line.is_empty()).count()
    };
    let all = lines("src/dip.wgsl") + lines("src/lib.rs");
    assert!(all <= 30, "{all} lines");
}
