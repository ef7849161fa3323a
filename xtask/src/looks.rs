//! Renders every preset that is shipped, small, to see that each still makes a picture.

use std::fs;
use std::path::{Path, PathBuf};

use crate::Outcome;
use crate::picture::Picture;
use crate::program::{self, Inkstrand, sum_up};

const WIDTH: u32 = 160;
const HEIGHT: u32 = 120;

/// Renders each of `presets/*.ron`.
///
/// # Errors
/// There is no preset, the program doesn't build, or a preset makes no picture: all of them,
/// with the program's own message.
pub fn render_all() -> Outcome {
    let presets = presets(&program::root().join("presets"))?;
    let program = Inkstrand::build()?;
    let folder = tempfile::tempdir()?;
    let mut failures = Vec::new();
    for preset in &presets {
        let name = preset.file_stem().unwrap_or_default().to_string_lossy();
        let picture = folder.path().join(format!("{name}.png"));
        let args = [
            format!("presets/{name}.ron"),
            format!("--size={WIDTH}x{HEIGHT}"),
            "--samples=1".to_owned(),
        ];
        let drawn = program.render(&args, &picture);
        match drawn.and_then(|()| look_at(&picture)) {
            Ok(()) => println!("  ok      {name}"),
            Err(error) => {
                println!("  FAILED  {name}: {error}");
                failures.push(name.into_owned());
            }
        }
    }
    sum_up(presets.len(), &failures)
}

/// The presets in `folder`, by name.
///
/// # Errors
/// The folder can't be read, or has none.
pub fn presets(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).map_err(|error| format!("presets: {error}"))?;
    let mut presets = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            presets.push(path);
        }
    }
    if presets.is_empty() {
        return Err("there is no presets/*.ron".into());
    }
    presets.sort();
    Ok(presets)
}

/// What any picture of a preset must be: of the size asked for, and not empty.
fn look_at(path: &Path) -> Outcome {
    let picture = Picture::load(path)?;
    if (picture.width, picture.height) != (WIDTH, HEIGHT) {
        return Err(format!("the picture is {}x{}", picture.width, picture.height).into());
    }
    if picture.is_blank() {
        return Err("the picture is blank".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::tests::made;

    #[test]
    fn presets_are_found_in_order() {
        let folder = tempfile::tempdir().unwrap();
        assert!(presets(folder.path()).is_err());
        for name in ["b.ron", "notes.md", "a.ron"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let found = presets(folder.path()).unwrap();
        let expected = ["a.ron", "b.ron"].map(|name| folder.path().join(name));
        assert_eq!(found, expected);
    }

    #[test]
    fn blank_and_badly_sized_pictures_fail() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let small = made();
        small.save(&path).unwrap();
        let error = look_at(&path).unwrap_err().to_string();
        assert_eq!(error, "the picture is 8x6");

        let mut picture = Picture {
            width: WIDTH,
            height: HEIGHT,
            pixels: vec![[0; 4]; (WIDTH * HEIGHT) as usize],
        };
        picture.save(&path).unwrap();
        let error = look_at(&path).unwrap_err().to_string();
        assert_eq!(error, "the picture is blank");

        picture.pixels[77] = [u16::MAX; 4];
        picture.save(&path).unwrap();
        look_at(&path).unwrap();
    }
}
