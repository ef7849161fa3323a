//! The header of a PLY file: which elements come after it, and how they are written.

use super::PlyError;
use crate::read::shown;

/// How numbers are written.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Format {
    Text,
    Little,
    Big,
}

/// What kind of number.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// What each of an element has.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// How a list says its length.
    pub(super) list: Option<Kind>,
}

/// A kind of things, and how many there are.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

/// What comes before the numbers.
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    pub(super) texture: Option<String>,
    /// Bytes and lines up to its end.
    pub(super) length: usize,
    pub(super) lines: usize,
}

impl Header {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, PlyError> {
        let (mut format, mut elements, mut texture) = (None, Vec::<Element>::new(), None);
        let (mut at, mut lines) = (0, 0);
        while let Some(length) = bytes[at..].iter().position(|byte| *byte == b'\n') {
            let line = String::from_utf8_lossy(&bytes[at..at + length]);
            at += length + 1;
            lines += 1;
            let wrong = |what: String| PlyError::Line { line: lines, what };
            let words: Vec<&str> = line.split_whitespace().collect();
            if lines == 1 && words != ["ply"] {
                return Err(wrong("a PLY file begins with `ply`".to_owned()));
            }
            match words.as_slice() {
                ["format", kind, "1.0"] => {
                    format = Some(match *kind {
                        "ascii" => Format::Text,
                        "binary_little_endian" => Format::Little,
                        "binary_big_endian" => Format::Big,
                        other => {
                            return Err(wrong(format!(
                                "there is no format `{}`: ascii, binary_little_endian, binary_big_endian",
                                shown(other)
                            )));
                        }
                    });
                }
                ["comment", "TextureFile", ..] => {
                    let name = line
                        .trim()
                        .split_once("TextureFile")
                        .map(|(_, name)| name.trim().to_owned());
                    texture = texture.or(name);
                }
                ["comment" | "obj_info", ..] | ["ply"] | [] => {}
                ["element", name, count] => elements.push(Element {
                    name: (*name).to_owned(),
                    count: count.parse().map_err(|_| {
                        wrong(format!(
                            "a number of elements was expected, found `{}`",
                            shown(count)
                        ))
                    })?,
                    properties: Vec::new(),
                }),
                ["property", ..] => {
                    let element = elements
                        .last_mut()
                        .ok_or_else(|| wrong("a property of no element".to_owned()))?;
                    let property = Property::read(&words[1..]);
                    element.properties.push(property.ok_or_else(|| wrong(format!("a property is written `property TYPE NAME` or `property list TYPE TYPE NAME`, found `{}`", shown(line.trim()))))?);
                }
                ["end_header"] => {
                    let format =
                        format.ok_or_else(|| wrong("the header has no `format`".to_owned()))?;
                    return Ok(Self {
                        format,
                        elements,
                        texture,
                        length: at,
                        lines,
                    });
                }
                _ => {
                    return Err(wrong(format!(
                        "no line of a header: `{}`",
                        shown(line.trim())
                    )));
                }
            }
        }
        Err(PlyError::NoEnd)
    }
}

impl Property {
    fn read(words: &[&str]) -> Option<Self> {
        let (name, kind, list) = match words {
            ["list", count, kind, name] => (name, kind, Some(Kind::of(count)?)),
            [kind, name] => (name, kind, None),
            _ => return None,
        };
        Some(Self {
            name: (*name).to_owned(),
            kind: Kind::of(kind)?,
            list,
        })
    }
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number of these bytes, the least significant first.
    pub(super) fn number(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => f64::from(a as i8),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }

    /// What a colour of this kind is divided by.
    pub(super) fn most(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::I32 | Self::U32 | Self::F32 | Self::F64 => 1.0,
        }
    }
}
