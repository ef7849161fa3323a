//! Material libraries of Wavefront OBJ files.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use crate::beside::file_in;
use crate::model::{Alpha, Image, ImageSource, Material, Texture, Wrap};
use crate::read::{MOST_OF_TEXT, read_bytes, shown};

/// The most sentences of what can't be had: a file can name any number of files.
const MOST_NOTES: usize = 20;

/// All materials that a file's libraries have. What is wrong with them is told in notes: a mesh is a mesh without its colours.
#[derive(Default)]
pub(crate) struct Library {
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    pub notes: Vec<String>,
    /// Its own files, whether they are there or not.
    pub files: Vec<PathBuf>,
    names: HashMap<String, usize>,
    pictures: HashMap<String, Option<usize>>,
    missing: HashSet<String>,
}

impl Library {
    /// Reads the libraries of these names in `folder` or below; of materials of one name the first counts.
    pub fn read(folder: &Path, names: &[String]) -> Self {
        let mut library = Self::default();
        let mut read = HashSet::new();
        for name in names {
            // Some programs have one name to a line, which may have spaces; others several names.
            let parts: Vec<&str> = match is_there(folder, name) {
                true => vec![name],
                false => name.split_whitespace().collect(),
            };
            for name in parts {
                if read.insert(name.to_owned()) {
                    library.read_file(folder, name);
                }
            }
        }
        library
    }

    /// The index of the material of this name; a note where there is none.
    pub fn index_of(&mut self, name: &str) -> Option<usize> {
        let found = self.names.get(name).copied();
        // Where there are no libraries at all, nobody misses them.
        if found.is_none() && !self.materials.is_empty() && self.missing.insert(name.to_owned()) {
            self.note(format!("there is no material `{}`", shown(name)));
        }
        found
    }

    fn note(&mut self, text: String) {
        if self.notes.len() < MOST_NOTES {
            self.notes.push(text);
        }
    }

    fn read_file(&mut self, folder: &Path, name: &str) {
        let Some(path) = file_in(folder, &slashes(name)) else {
            let name = shown(name);
            return self.note(format!(
                "the materials of `{name}` are not in the file's folder"
            ));
        };
        self.files.push(path.clone());
        let bytes = match read_bytes(&path, MOST_OF_TEXT) {
            Ok(bytes) => bytes,
            Err(error) => return self.note(format!("no materials: {error}")),
        };
        // Pictures that the library names are beside it.
        let folder = path.parent().unwrap_or(folder).to_owned();
        let mut alpha_map = false;
        let mut current = None;
        for (line, number) in String::from_utf8_lossy(&bytes).lines().zip(1..) {
            let (key, rest) = word(line.trim());
            if key == "newmtl" {
                self.materials.push(Material {
                    name: rest.to_owned(),
                    ..Material::default()
                });
                let index = self.materials.len() - 1;
                self.names.entry(rest.to_owned()).or_insert(index);
                current = Some(index);
                continue;
            }
            let Some(index) = current else { continue };
            let material = &mut self.materials[index];
            match (key, shares(rest.trim_start_matches("-halo")).as_deref()) {
                ("Kd", Some(&[red, green, blue])) => {
                    material.base_color[..3].copy_from_slice(&[red, green, blue]);
                }
                ("Kd", Some(&[gray])) => material.base_color[..3].fill(gray),
                ("d", Some(&[alpha])) => material.set_alpha(alpha),
                ("Tr", Some(&[clear])) => material.set_alpha(1.0 - clear),
                // Spectra and other coordinates too, which nothing here reads.
                ("Kd" | "d" | "Tr", _) => self.note(format!(
                    "{}:{number}: `{}` is left out: {} can be read",
                    shown(name),
                    shown(line.trim()),
                    match key {
                        "Kd" => "one or three numbers from 0 to 1",
                        _ => "a number from 0 to 1",
                    }
                )),
                ("map_Kd", _) => self.materials[index].texture = self.texture(&folder, rest),
                ("map_d", _) => alpha_map = true,
                _ => {}
            }
        }
        for material in &mut self.materials {
            // The alpha of the colour's own picture, which Blender writes as `map_d` of the same file.
            if alpha_map && material.texture.is_some() && material.alpha == Alpha::Opaque {
                material.alpha = Alpha::Cutout(0.5);
            }
        }
    }

    /// The texture that a line gives: options, and a file's name.
    fn texture(&mut self, folder: &Path, line: &str) -> Option<Texture> {
        let (name, is_clamped) = file_name(line);
        let wrap = if is_clamped {
            Wrap::Clamp
        } else {
            Wrap::Repeat
        };
        let known = self.pictures.get(name).copied();
        let image = known.unwrap_or_else(|| {
            let found = self.picture(folder, name);
            self.pictures.insert(name.to_owned(), found);
            found
        });
        image.map(|image| Texture {
            image,
            wrap: [wrap; 2],
        })
    }

    fn picture(&mut self, folder: &Path, name: &str) -> Option<usize> {
        let path = file_in(folder, &slashes(name));
        let Some(path) = path.filter(|path| path.is_file()) else {
            let name = shown(name);
            self.note(format!("the texture `{name}` is not in the file's folder, or below: put it there, and name it without its folder"));
            return None;
        };
        self.images.push(Image {
            name: name.to_owned(),
            source: ImageSource::File(path),
        });
        Some(self.images.len() - 1)
    }
}

impl Material {
    fn set_alpha(&mut self, alpha: f32) {
        self.base_color[3] = alpha;
        self.alpha = if alpha < 1.0 {
            Alpha::Blend
        } else {
            Alpha::Opaque
        };
    }
}

fn is_there(folder: &Path, name: &str) -> bool {
    file_in(folder, &slashes(name)).is_some_and(|path| path.is_file())
}

/// Programs on Windows separate folders their way.
fn slashes(name: &str) -> String {
    name.replace('\\', "/")
}

/// All numbers of a line, from 0 to 1; `None` where a word is no finite number.
fn shares(line: &str) -> Option<Vec<f32>> {
    let words = line.split_whitespace().map(|word| {
        let number: f32 = word.parse().ok()?;
        number.is_finite().then(|| number.clamp(0.0, 1.0))
    });
    words.collect()
}

/// The name after a texture's options, and whether it is clamped.
fn file_name(line: &str) -> (&str, bool) {
    let mut rest = line;
    let mut is_clamped = false;
    while rest.starts_with('-') {
        let (option, after) = word(rest);
        let most = match option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        rest = after;
        for _ in 0..most {
            let (value, after) = word(rest);
            // Of three numbers the last ones may be left out.
            if most == 3 && value.parse::<f32>().is_err() {
                break;
            }
            is_clamped |= option == "-clamp" && value == "on";
            rest = after;
        }
    }
    (rest, is_clamped)
}

/// The first word of a line, and what follows.
fn word(line: &str) -> (&str, &str) {
    let (first, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    (first, rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_come_before_the_name() {
        assert_eq!(file_name("wood grain.png"), ("wood grain.png", false));
        assert_eq!(
            file_name("-clamp on -s 1 2 -mm 0 1 a b.png"),
            ("a b.png", true)
        );
        assert_eq!(file_name("-o 1 2 3 -bm 0.5 a.png"), ("a.png", false));
        for line in ["-", "-s", "-clamp", "-mm 1"] {
            assert_eq!(file_name(line), ("", false), "{line}");
        }
    }
}
