//! Which format a file is of: by its name's ending, else by its first bytes.

use std::path::Path;

/// The hair formats that this build reads, for messages.
pub(crate) const HAIR_FORMATS: &str = "TressFX (.tfx) and own strands (.strands.ron)";

/// A hair format that is read.
pub(crate) enum HairFormat {
    Tfx,
    StrandsRon,
}

impl HairFormat {
    /// The format of a hair file, or `None` where it is not read.
    pub(crate) fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        match ending(path).as_str() {
            "tfx" => Some(Self::Tfx),
            "ron" => Some(Self::StrandsRon),
            _ => bytes
                .starts_with(&4.0f32.to_le_bytes())
                .then_some(Self::Tfx),
        }
    }
}

/// Endings of hair's formats that other programs write. Those of meshes are not among them.
const OTHERS: [&str; 7] = ["abc", "data", "hair", "usd", "usda", "usdc", "usdz"];

/// Whether a file is hair by its name's ending, of a format that is read or of another one: hair styles are not.
#[must_use]
pub fn is_hair_file(path: &Path) -> bool {
    let ending = ending(path);
    ending == "tfx"
        || OTHERS.contains(&ending.as_str())
        || path.to_string_lossy().ends_with(".strands.ron")
}

/// What a file that is not read seems to be, by its first bytes, else by its name's ending.
pub(crate) fn guess(path: &Path, bytes: &[u8]) -> String {
    let magic: [(&[u8], &str); 8] = [
        (b"PXR-USDC", "USD"),
        (b"#usda", "USD"),
        (b"Ogawa", "Alembic"),
        (b"\x89HDF", "Alembic (HDF5)"),
        (b"glTF", "glTF"),
        (b"HAIR", "Cem Yuksel's .hair"),
        (b"ply\n", "PLY"),
        (b"ply\r", "PLY"),
    ];
    if let Some((_, name)) = magic.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return (*name).to_string();
    }
    let ending = ending(path);
    let name = match ending.as_str() {
        "usd" | "usda" | "usdc" | "usdz" => "USD",
        "abc" => "Alembic",
        "gltf" | "glb" => "glTF",
        "vrm" => "VRM",
        "hair" => "Cem Yuksel's .hair",
        "data" => "USC-HairSalon's .data",
        "ply" => "PLY",
        "obj" => "Wavefront OBJ",
        "tfx" => "TressFX",
        "" => "a file without an ending",
        other => return format!("\".{other}\""),
    };
    name.to_string()
}

fn ending(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hair_is_told_by_its_name_whoever_reads_it() {
        for name in [
            "a.tfx",
            "a.TFX",
            "a.b.strands.ron",
            "a.abc",
            "a.usda",
            "a.hair",
        ] {
            assert!(is_hair_file(Path::new(name)), "{name}");
        }
        for name in [
            "a.ron",
            "a.style.ron",
            "a.motion.ron",
            "strands.ron",
            "a.obj",
            "a.glb",
            "a.png",
            "abc",
            "",
        ] {
            assert!(!is_hair_file(Path::new(name)), "{name}");
        }
    }

    /// A file that is known to be hair is called by its format's name, not by its ending.
    #[test]
    fn formats_of_others_have_names() {
        for other in OTHERS {
            let name = guess(&Path::new("a").with_extension(other), b"");
            assert!(!name.starts_with('"'), "{name}");
        }
    }
}
