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
