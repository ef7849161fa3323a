//! TressFX version 4 (`.tfx`): strands that all have the same number of vertices.
//!
//! Layout (little-endian): a 160-byte header of f32 version, u32 strands, u32 vertices a strand, u32
//! offsets of the position, strand UV, vertex UV, thickness and colour blocks (0: absent), 32
//! reserved words; positions are four f32, of which the last is the inverse mass. Files hold guide
//! strands and followers in any order; all are kept.

use glam::Vec3;
use hair_sim::Strands;

/// The header's size in bytes.
const HEADER: u64 = 160;
/// The size of one position in bytes: x, y, z and inverse mass.
const POSITION: u64 = 16;

/// Why bytes are not a valid TressFX file. Offsets count bytes from the start of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TfxError {
    /// The file ends inside the header.
    #[error("byte 0: a header of {HEADER} bytes was expected, the file has {found} bytes")]
    Header {
        /// The file's length in bytes.
        found: u64,
    },
    /// Only version 4.0 is known.
    #[error("byte 0: version 4 was expected, found {found}")]
    Version {
        /// The version as the file gives it.
        found: f32,
    },
    /// A file without strands.
    #[error("byte 4: at least one strand was expected, found 0")]
    NoStrands,
    /// Strands have 4, 8, 16, 32 or 64 vertices.
    #[error("byte 8: 4, 8, 16, 32 or 64 vertices a strand were expected, found {found}")]
    Vertices {
        /// The number as the file gives it.
        found: u32,
    },
    /// A block begins inside the header.
    #[error(
        "byte {at}: the {block} block was expected at byte {HEADER} or after, found offset {found}"
    )]
    Offset {
        /// Where the offset stands.
        at: u64,
        /// The block's name.
        block: &'static str,
        /// The offset as the file gives it.
        found: u32,
    },
    /// A block reaches past the end of the file.
    #[error(
        "byte {at}: the {block} block of {strands} strands x {vertices} vertices was expected to \
         end at byte {end}, the file has {found} bytes"
    )]
    Truncated {
        /// Where the block's offset stands.
        at: u64,
        /// The block's name.
        block: &'static str,
        /// The number of strands as the file gives it.
        strands: u32,
        /// The vertices of a strand as the file gives them.
        vertices: u32,
        /// Where the block would end.
        end: u64,
        /// The file's length in bytes.
        found: u64,
    },
    /// A position that is not finite.
    #[error(
        "byte {at}: strand {strand}, vertex {vertex}: a finite position was expected, found {found}"
    )]
    NotFinite {
        /// Where the position stands.
        at: u64,
        /// The strand's index.
        strand: u32,
        /// The vertex's index from the root.
        vertex: u32,
        /// The position as the file gives it.
        found: Vec3,
    },
}

/// Reads the strands of a TressFX file, in the file's own axes and units. A strand's id is its index.
///
/// # Errors
///
/// When the header, the counts, the offsets or a position are not as the format says. Nothing is
/// allocated before the counts are checked against the length of `bytes`.
pub fn from_bytes(bytes: &[u8]) -> Result<Strands, TfxError> {
    let len = bytes.len() as u64;
    if len < HEADER {
        return Err(TfxError::Header { found: len });
    }
    let version = f32::from_bits(word(bytes, 0));
    if version != 4.0 {
        return Err(TfxError::Version { found: version });
    }
    let (strands, vertices) = (word(bytes, 4), word(bytes, 8));
    if strands == 0 {
        return Err(TfxError::NoStrands);
    }
    if !(4..=64).contains(&vertices) || !vertices.is_power_of_two() {
        return Err(TfxError::Vertices { found: vertices });
    }

    // 2^32 strands of 64 positions are 2^42 bytes: none of this overflows 64 bits.
    let points = u64::from(strands) * u64::from(vertices);
    let blocks = [
        ("position", 12, points * POSITION),
        ("strand UV", 16, u64::from(strands) * 8),
        ("vertex UV", 20, points * 8),
        ("thickness", 24, points * 4),
        ("colour", 28, points * 16),
    ];
    for (block, at, size) in blocks {
        let found = word(bytes, at);
        if found == 0 && block != "position" {
            continue;
        }
        let at = at as u64;
        if u64::from(found) < HEADER {
            return Err(TfxError::Offset { at, block, found });
        }
        let end = u64::from(found) + size;
        if end > len {
            let found = len;
            return Err(TfxError::Truncated {
                at,
                block,
                strands,
                vertices,
                end,
                found,
            });
        }
    }
    read_positions(bytes, word(bytes, 12) as usize, strands, vertices)
}

/// The block at `offset`, which is known to lie inside `bytes`.
fn read_positions(
    bytes: &[u8],
    offset: usize,
    strands: u32,
    vertices: u32,
) -> Result<Strands, TfxError> {
    let mut read = Strands::new();
    let mut points = Vec::with_capacity(vertices as usize);
    let mut at = offset;
    for strand in 0..strands {
        points.clear();
        for vertex in 0..vertices {
            let [x, y, z] = [at, at + 4, at + 8].map(|at| f32::from_bits(word(bytes, at)));
            let found = Vec3::new(x, y, z);
            if !found.is_finite() {
                let at = at as u64;
                return Err(TfxError::NotFinite {
                    at,
                    strand,
                    vertex,
                    found,
                });
            }
            points.push(found);
            at += POSITION as usize;
        }
        read.push(strand, &points, None)
            .expect("points are there and finite");
    }
    Ok(read)
}

/// The little-endian word at byte `at`.
fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A file of `strands` strands of `vertices` vertices, with strand UVs behind the positions.
    fn fixture(strands: u32, vertices: u32) -> Vec<u8> {
        let uv = 160 + strands * vertices * 16;
        let mut bytes = Vec::new();
        bytes.extend(4.0f32.to_le_bytes());
        for value in [strands, vertices, 160, uv, 0, 0, 0] {
            bytes.extend(value.to_le_bytes());
        }
        bytes.resize(160, 0);
        for strand in 0..strands {
            for vertex in 0..vertices {
                for value in [
                    strand as f32,
                    vertex as f32 * -0.5,
                    0.25,
                    vertex.min(1) as f32,
                ] {
                    bytes.extend(value.to_le_bytes());
                }
            }
        }
        bytes.resize(bytes.len() + strands as usize * 8, 0);
        bytes
    }

    fn with_word(at: usize, value: u32) -> Result<Strands, TfxError> {
        let mut bytes = fixture(3, 8);
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        from_bytes(&bytes)
    }

    #[test]
    fn a_whole_file_is_read() {
        let strands = from_bytes(&fixture(3, 8)).unwrap();
        assert_eq!(strands.len(), 3);
        assert_eq!(strands.strand(2)[3], Vec3::new(2.0, -1.5, 0.25));
        assert_eq!((0..3).map(|i| strands.id(i)).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn every_shorter_file_is_refused() {
        let bytes = fixture(3, 8);
        for len in 0..bytes.len() {
            let error = from_bytes(&bytes[..len]).unwrap_err();
            if len < 160 {
                assert_eq!(error, TfxError::Header { found: len as u64 });
            } else {
                assert!(
                    matches!(error, TfxError::Truncated { .. }),
                    "{len}: {error}"
                );
            }
        }
    }

    #[test]
    fn errors_say_what_was_expected_found_and_where() {
        let text = |at, value| with_word(at, value).unwrap_err().to_string();
        assert_eq!(
            text(0, 3.0f32.to_bits()),
            "byte 0: version 4 was expected, found 3"
        );
        assert_eq!(
            text(0, f32::NAN.to_bits()),
            "byte 0: version 4 was expected, found NaN"
        );
        assert_eq!(
            text(4, 0),
            "byte 4: at least one strand was expected, found 0"
        );
        for vertices in [0, 2, 5, 12, 65, 128, u32::MAX] {
            assert_eq!(
                with_word(8, vertices),
                Err(TfxError::Vertices { found: vertices })
            );
        }
        assert_eq!(
            text(4, u32::MAX),
            "byte 12: the position block of 4294967295 strands x 8 vertices was expected to end at \
             byte 549755813920, the file has 568 bytes"
        );
        assert!(text(12, 0).starts_with("byte 12: the position block was expected at byte 160"));
        assert!(text(16, 8).starts_with("byte 16: the strand UV block"));
        for at in [12, 16, 20, 24, 28] {
            assert!(matches!(
                with_word(at, u32::MAX),
                Err(TfxError::Truncated { .. })
            ));
        }
        assert_eq!(
            text(160 + 16 * 9 + 4, f32::NAN.to_bits()),
            "byte 304: strand 1, vertex 1: a finite position was expected, found [1, NaN, 0.25]"
        );
    }

    #[test]
    fn every_flipped_header_bit_is_read_or_refused() {
        let bytes = fixture(3, 8);
        for bit in 0..HEADER as usize * 8 {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            if let Ok(strands) = from_bytes(&flipped) {
                assert!(strands.points().len() * 16 <= bytes.len());
            }
        }
    }

    proptest! {
        #[test]
        fn random_bytes_never_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..600), signed: bool) {
            if signed && bytes.len() >= 4 {
                bytes[..4].copy_from_slice(&4.0f32.to_le_bytes());
            }
            let _ = from_bytes(&bytes);
        }

        #[test]
        fn random_headers_never_panic(words in prop::collection::vec((0usize..8, prop_oneof![0u32..2000, any::<u32>()]), 1..4)) {
            let mut bytes = fixture(5, 16);
            for (index, word) in words {
                bytes[index * 4..index * 4 + 4].copy_from_slice(&word.to_le_bytes());
            }
            let _ = from_bytes(&bytes);
        }
    }
}
