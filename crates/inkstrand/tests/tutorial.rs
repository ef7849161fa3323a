//! The tutorial's crate is built as it stands there, outside of the workspace, and its mistakes are told
//! as it says.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const TUTORIAL: &str = "docs/an-effect-in-30-lines.md";

/// As the workspace does, so that what it has built of other crates is used; and nothing moves here.
const OPTIMISED: &str = "profile.dev.package.\"*\".opt-level=2";
const NOT_USED: &str = "profile.dev.package.hair-sim.opt-level=0";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap()
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

/// A crate outside of the workspace.
struct Crate(tempfile::TempDir);

impl Crate {
    /// Writes the tutorial's files; our crates are where they are.
    fn write(blocks: &[Block]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("src")).unwrap();
        // The versions that we test with, which are there without a network.
        fs::copy(root().join("Cargo.lock"), folder.path().join("Cargo.lock")).unwrap();
        let this = Self(folder);
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
        self.0.path().join(file)
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
            .args(["--offline", "--config", OPTIMISED, "--config", NOT_USED])
            .args(arguments)
            .env("CARGO_TARGET_DIR", target)
            .current_dir(self.0.path())
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
        let effect = "src/dip.wgsl";
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
    let markdown = fs::read_to_string(root().join(TUTORIAL)).unwrap();
    let blocks = blocks(&markdown);
    let dip_dye = Crate::write(&blocks);

    // The picture has the dye in it, and without the layer it has not.
    let draw = |name: &str, more: &[&str]| {
        let size = ["--size", "320x240", "--samples", "4", "-o", name];
        dip_dye.succeed(
            &[
                &["run", "--quiet", "--", "render", "look.ron"],
                &size[..],
                more,
            ]
            .concat(),
        );
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

    // It is a good effect.
    dip_dye.succeed(&["test", "--quiet"]);

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
    let message = dip_dye.fail(&["run", "--quiet", "--", "check", "look.ron"]);
    assert_says(&message, misspelt_parameter);
}

#[test]
fn the_effect_has_thirty_lines() {
    let markdown = fs::read_to_string(root().join(TUTORIAL)).unwrap();
    let lines = |file: &str| {
        let blocks = blocks(&markdown);
        let block = blocks
            .iter()
            .find(|block| block.file() == Some(file))
            .unwrap();
        let of_effect = block
            .text
            .lines()
            .take_while(|line| !line.starts_with("fn main"));
        of_effect.filter(|line| !line.is_empty()).count()
    };
    let all = lines("src/dip.wgsl") + lines("src/main.rs");
    assert!(all <= 30, "{all} lines");
}
