//! What a character's meshes cost: 30,000 triangles with a texture, made here, beside the same hair without a head, and Godette where there
//! is real data. `cargo xtask bench count --release` counts the same scenes.

use crate::BenchError;
use crate::frame::registry;
use crate::results::Row;
use crate::targets::{Found, Limit, Target};
use crate::timing::{Effort, shortest};
use render::Drawing;
use render::cpu::{Evaluator, Rasterizer};
use stage::{Files, Preset, Stage};
use std::f32::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Samples a pixel.
const SAMPLES: u32 = 4;
/// Milliseconds that a frame may take longer for such a character.
const LIMIT_MS: f64 = 3.0;
/// Rings and sectors of each of the two meshes, head and dress: 15,000 triangles each.
const RINGS: usize = 75;
const SECTORS: usize = 100;
/// The character's file.
const FILE: &str = "character.obj";
/// Sides of the texture.
const TEXELS: usize = 1024;

/// What a character adds to a frame, as rows and targets. The character is written to `folder`.
///
/// # Errors
///
/// When its files can't be written, or nothing can be drawn.
pub(crate) fn measure(
    root: &Path,
    folder: &Path,
    effort: Effort,
) -> Result<(Vec<Row>, Vec<Target>), BenchError> {
    let folder = folder.join("character");
    write(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut characters = vec![("30,000 triangles", FILE.to_owned(), true)];
    let data = std::env::var_os("INKSTRAND_DATA").map(PathBuf::from);
    let godette = data.map(|data| data.join("vrm/Godette_vrm_v4.vrm"));
    if let Some(path) = godette.filter(|path| path.is_file()) {
        characters.push(("Godette", path.display().to_string(), false));
    }
    let (mut rows, mut targets) = (Vec::new(), Vec::new());
    for (name, file, is_held) in characters {
        let head = of_file(&file);
        let mut both = [
            stage(root, &folder, &head, "")?,
            stage(root, &folder, NO_HEAD, "")?,
            stage(
                root,
                &folder,
                &head,
                "(effect: \"mesh.toon\", on: \"*\", params: (rim: \"FFFFFF\")),",
            )?,
        ]
        .map(Frames::new);
        let mut runs = both.each_mut().map(|frames| || frames.draw());
        let [with, without, painted] = shortest(&mut runs, effort, || {})?[..] else {
            continue;
        };
        let row = |method: &str, seconds| Row {
            scene: name.to_owned(),
            method: method.to_owned(),
            knob: SAMPLES as usize,
            seconds,
            error: None,
        };
        rows.extend([
            row("character", with - without),
            row("character painted", painted - without),
        ]);
        if is_held {
            targets.push(Target {
                text: format!("{name}: milliseconds of a frame for the character"),
                found: Some(Found::Is(1e3 * (with - without))),
                limit: Limit::AtMost(LIMIT_MS),
            });
        }
    }
    Ok((rows, targets))
}

/// A scene, and what draws its frames.
struct Frames {
    stage: Stage,
    evaluator: Evaluator,
    drawing: Drawing,
    rasterizer: Option<Rasterizer>,
    yaw: f32,
}

impl Frames {
    fn new(stage: Stage) -> Self {
        Self {
            stage,
            evaluator: Evaluator::of_samples(SAMPLES),
            drawing: Drawing::default(),
            rasterizer: None,
            yaw: 0.0,
        }
    }

    /// The next frame, seen from a little further round.
    fn draw(&mut self) -> Result<(), BenchError> {
        self.yaw += 0.5;
        self.stage.scene.camera.yaw = self.yaw % 360.0;
        let frame = self.stage.frame().map_err(|error| error.to_string())?;
        let evaluated = self.evaluator.evaluate(&frame, &mut self.drawing);
        evaluated.map_err(|error| error.to_string())?;
        let rasterizer = match self.rasterizer.take() {
            Some(rasterizer) => rasterizer,
            None => Rasterizer::new(SAMPLES, None).map_err(|error| error.to_string())?,
        };
        let drawn = self.rasterizer.insert(rasterizer).draw(&self.drawing);
        drawn.map_err(|error| error.to_string())?;
        Ok(())
    }
}

/// A head that is a mesh of a file beside the preset.
fn of_file(file: &str) -> String {
    format!("file: {file:?}, colors: file, up: y, scale: 1")
}

/// No head, with the same hair.
const NO_HEAD: &str = "shape: none";

/// A preset of a few strands on a head.
fn preset(root: &Path, head: &str, layers: &str) -> String {
    let hair = root.join("tests/golden/extremes.strands.ron");
    format!(
        "(version: 1, hair: (file: {:?}), head: ({head}), scene: (size: (960, 720), background: \"E0E8F0\"), \
         camera: (distance: 4.5, target: (0, -0.6, 0)), layers: [{layers} (effect: \"hair.base\")])",
        hair.display().to_string()
    )
}

/// Those strands on a character of the folder.
fn stage(root: &Path, folder: &Path, head: &str, layers: &str) -> Result<Stage, BenchError> {
    let text = preset(root, head, layers);
    let registry = registry()?;
    let preset = Preset::parse("character.ron", &text, &registry);
    let preset = preset.map_err(|errors| errors.to_string())?;
    let files = Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).map_err(|error| error.to_string().into())
}

/// Writes the character of 30,000 triangles, and presets for `inkstrand render`: `character.ron`, and `no-character.ron` without it.
///
/// # Errors
///
/// When the folder can't be made, or a file can't be written.
pub fn write_presets(root: &Path, folder: &Path) -> std::io::Result<()> {
    write(folder)?;
    let root = root.canonicalize()?;
    for (name, head) in [
        ("character.ron", &of_file(FILE)[..]),
        ("no-character.ron", NO_HEAD),
    ] {
        fs::write(folder.join(name), preset(&root, head, ""))?;
    }
    Ok(())
}

/// Writes the character: a head that is nearly a ball and a dress with folds, with a picture of many colours on both.
fn write(folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let material = |name: &str| format!("newmtl {name}\nKd 1 1 1\nmap_Kd cloth.png\n");
    fs::write(
        folder.join("character.mtl"),
        material("Skin") + &material("Dress"),
    )?;
    let mut obj = "mtllib character.mtl\n".to_owned();
    let head = |along: f32, around: f32| {
        let (polar, angle) = (PI * along, TAU * around);
        let radius = 0.105 * polar.sin();
        [
            radius * angle.sin(),
            0.12 * polar.cos(),
            radius * angle.cos(),
        ]
    };
    let dress = |along: f32, around: f32| {
        let folds = 1.0 + 0.08 * along * (12.0 * TAU * around).sin();
        let radius = (0.06 + 0.3 * along) * folds;
        let angle = TAU * around;
        [
            radius * angle.sin(),
            -0.13 - 1.1 * along,
            radius * angle.cos(),
        ]
    };
    let mut first = 1;
    mesh(&mut obj, "Skin", &mut first, head);
    mesh(&mut obj, "Dress", &mut first, dress);
    fs::write(folder.join(FILE), obj)?;
    let texel = |i: usize| {
        let (x, y) = (i % TEXELS, i / TEXELS);
        [x * 255 / TEXELS, y * 255 / TEXELS, (x ^ y) / 8 % 2 * 200].map(|channel| channel as u8)
    };
    let texels: Vec<[u8; 3]> = (0..TEXELS * TEXELS).map(texel).collect();
    let file = fs::File::create(folder.join("cloth.png"))?;
    let mut encoder = png::Encoder::new(file, TEXELS as u32, TEXELS as u32);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    Ok(writer.write_image_data(texels.as_flattened())?)
}

/// Adds a mesh of rings of sectors; places in the picture run with them.
fn mesh(obj: &mut String, name: &str, first: &mut usize, place: impl Fn(f32, f32) -> [f32; 3]) {
    let _ = writeln!(obj, "o {name}\nusemtl {name}");
    for ring in 0..=RINGS {
        for sector in 0..=SECTORS {
            let along = ring as f32 / RINGS as f32;
            let around = sector as f32 / SECTORS as f32;
            let [x, y, z] = place(along, around);
            let _ = writeln!(obj, "v {x} {y} {z}\nvt {around} {along}");
        }
    }
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let a = *first + ring * (SECTORS + 1) + sector;
            let [b, c, d] = [a + 1, a + SECTORS + 1, a + SECTORS + 2];
            let _ = writeln!(obj, "f {a}/{a} {c}/{c} {d}/{d}\nf {a}/{a} {d}/{d} {b}/{b}");
        }
    }
    *first += (RINGS + 1) * (SECTORS + 1);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_character_of_30_000_triangles_is_drawn() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path()).unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut stage = stage(&root, folder.path(), &of_file(FILE), "").unwrap();
        let frame = stage.frame().unwrap();
        let drawn = |surface: &&render::Surface| surface.texture.is_some();
        let textured = frame.surfaces.iter().filter(drawn);
        let triangles: usize = textured.map(|surface| surface.triangles.len()).sum();
        assert!(triangles > 29_000, "{triangles}");
        let effort = Effort {
            rounds: 1,
            each: Duration::from_millis(1),
        };
        let (rows, targets) = measure(&root, folder.path(), effort).unwrap();
        assert!(rows.len() >= 2 && rows.len() % 2 == 0, "{rows:?}");
        assert_eq!(targets.len(), 1);
        write_presets(&root, folder.path()).unwrap();
        for name in ["character.ron", "no-character.ron"] {
            let path = folder.path().join(name);
            let text = fs::read_to_string(&path).unwrap();
            Preset::parse(name, &text, &registry().unwrap()).unwrap();
        }
    }
}
