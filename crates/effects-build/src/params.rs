//! The parameters of a source, from `struct Params` and its comments:
//!
//! ```wgsl
//! /// What it does, in words.
//! /// @unit 1/300 head height @range 0..100 @default 2.2
//! width: f32,
//! ```
//!
//! A `vec3<f32>` is a colour (`@default "RRGGBB"`), a `vec4<f32>` a colour or none (`@default none`),
//! whose last component is 1 where there is one. A `vec2<f32>`, and a `vec3<f32>` with a range, are numbers
//! (`@range -1..1 @default 0 1`). A `bool` is `true` or `false`. A `u32` is a whole number or, with `@choices a b c`,
//! one of these names; with `@texture` it is a picture or a gradient (`@default none` or a gradient as presets have it), which clamps at its
//! edges or, with `@texture repeat`, goes on from the other one; an `i32` is one whose range begins below 0. An `f32` may vary along a strand and from strand to strand, but for those marked
//! `@constant`, which the effect's Rust reads.

use crate::check::named_type;
use crate::compose::Source;
use crate::error::BuildError;
use naga::{Module, Scalar, Span, TypeInner, VectorSize};

/// One parameter.
pub(crate) struct Param {
    pub name: String,
    pub doc: String,
    pub unit: String,
    pub kind: Kind,
}

/// What values a parameter takes.
pub(crate) enum Kind {
    Number {
        min: f32,
        max: f32,
        default: f32,
        varies: bool,
    },
    Integer {
        min: i32,
        max: i32,
        default: i32,
    },
    /// An `i32`, whose range begins below 0.
    Signed {
        min: i32,
        max: i32,
        default: i32,
    },
    Flag {
        default: bool,
    },
    Pair {
        min: f32,
        max: f32,
        default: [f32; 2],
    },
    Triple {
        min: f32,
        max: f32,
        default: [f32; 3],
    },
    Choice {
        names: Vec<String>,
        default: u32,
    },
    Color {
        default: String,
    },
    OptionalColor {
        default: Option<String>,
    },
    /// A `u32` with `@texture`.
    Texture {
        /// As presets have it.
        default: String,
        repeats: bool,
    },
}

/// The `@key value` parts of a comment, and the words before them.
struct Annotations {
    words: String,
    keys: Vec<(String, String)>,
}

impl Annotations {
    fn read(comments: &[String]) -> Self {
        let text = comments
            .iter()
            .map(|line| line.trim().trim_start_matches('/').trim())
            .collect::<Vec<_>>()
            .join(" ");
        let mut parts = text.split('@');
        let words = parts.next().unwrap_or_default().trim().to_owned();
        let keys = parts
            .map(|part| {
                let (key, value) = part.trim().split_once(' ').unwrap_or((part.trim(), ""));
                (key.to_owned(), value.trim().to_owned())
            })
            .collect();
        Self { words, keys }
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.keys
            .iter()
            .find(|(k, _)| k == key)
            .map(|(_, value)| value.as_str())
    }
}

/// Reads the parameters of a validated source; a source without `struct Params` has none.
pub(crate) fn read(module: &Module, source: &Source) -> Result<Vec<Param>, BuildError> {
    let Some(handle) = named_type(module, "Params") else {
        return Ok(Vec::new());
    };
    let TypeInner::Struct { members, .. } = &module.types[handle].inner else {
        return Ok(Vec::new());
    };
    let span = module.types.get_span(handle);
    let none = Vec::new();
    members
        .iter()
        .enumerate()
        .map(|(index, member)| {
            let name = member.name.clone().unwrap_or_default();
            let comments = module
                .doc_comments
                .as_ref()
                .and_then(|docs| docs.struct_members.get(&(handle, index)))
                .unwrap_or(&none);
            read_one(
                &name,
                &module.types[member.ty].inner,
                &Annotations::read(comments),
            )
            .map(|param| match param.kind {
                // A mesh has no place along a strand.
                Kind::Number {
                    min, max, default, ..
                } if source.is_for_meshes => Param {
                    kind: Kind::Number {
                        min,
                        max,
                        default,
                        varies: false,
                    },
                    ..param
                },
                _ => param,
            })
            .map_err(|message| {
                let place = member_span(source, span, &name);
                source.error(place, format!("Params.{name}: {message}"))
            })
        })
        .collect()
}

/// Where a member's name stands in its struct, of which naga tells the whole's place alone.
fn member_span(source: &Source, structure: Span, name: &str) -> Span {
    let Some(range) = structure.to_range() else {
        return structure;
    };
    let mut start = range.start;
    for line in source.text[range].split_inclusive('\n') {
        let code = line.trim_start();
        let after = code.strip_prefix(name).map(str::trim_start);
        if after.is_some_and(|rest| rest.starts_with(':')) {
            let place = (start + line.len() - code.len()) as u32;
            return Span::new(place, place + name.len() as u32);
        }
        start += line.len();
    }
    structure
}

/// What a comment may say after an `@`.
const KEYS: &[&str] = &["unit", "range", "default", "choices", "constant", "texture"];

fn read_one(name: &str, ty: &TypeInner, notes: &Annotations) -> Result<Param, String> {
    if name.ends_with(|c: char| c.is_ascii_digit()) {
        return Err("a parameter's name can't end in a digit".to_owned());
    }
    if notes.words.is_empty() {
        return Err("a `///` comment must say what it does".to_owned());
    }
    if let Some((key, _)) = notes.keys.iter().find(|(k, _)| !KEYS.contains(&k.as_str())) {
        return Err(format!(
            "there is no `@{key}`; there are @{}",
            KEYS.join(", @")
        ));
    }
    let default = notes
        .get("default")
        .ok_or("its comment needs `@default VALUE`")?;
    let kind = match *ty {
        TypeInner::Scalar(Scalar::F32) => {
            let (min, max) = range(notes)?;
            let default = within(default, min, max)?;
            Kind::Number {
                min,
                max,
                default,
                varies: notes.get("constant").is_none(),
            }
        }
        TypeInner::Scalar(Scalar::U32) if notes.get("texture").is_some() => Kind::Texture {
            default: default.to_owned(),
            repeats: match notes.get("texture") {
                Some("repeat") => true,
                Some("" | "clamp") => false,
                other => {
                    let other = other.unwrap_or_default();
                    return Err(format!("@texture {other}: it is clamp or repeat"));
                }
            },
        },
        TypeInner::Scalar(Scalar::U32) => match notes.get("choices") {
            Some(choices) => {
                let names: Vec<String> = choices.split_whitespace().map(str::to_owned).collect();
                let index = names.iter().position(|n| n == default);
                let index = index.ok_or("@default must be one of @choices")?;
                Kind::Choice {
                    names,
                    default: index as u32,
                }
            }
            None => {
                let (min, max) = range(notes)?;
                if min < 0 {
                    return Err("a u32 is 0 or more".to_owned());
                }
                let default = within(default, min, max)?;
                Kind::Integer { min, max, default }
            }
        },
        TypeInner::Scalar(Scalar::I32) => {
            let (min, max) = range(notes)?;
            if min >= 0 {
                return Err("an i32's range begins below 0; use a u32".to_owned());
            }
            let default = within(default, min, max)?;
            Kind::Signed { min, max, default }
        }
        TypeInner::Scalar(Scalar::BOOL) => Kind::Flag {
            default: default
                .parse()
                .map_err(|_| format!("@default {default}: it is true or false"))?,
        },
        TypeInner::Vector {
            size: VectorSize::Bi,
            scalar: Scalar::F32,
        } => {
            let (min, max) = range(notes)?;
            let default = numbers(default, min, max)?;
            Kind::Pair { min, max, default }
        }
        TypeInner::Vector {
            size: VectorSize::Tri,
            scalar: Scalar::F32,
        } if notes.get("range").is_some() => {
            let (min, max) = range(notes)?;
            let default = numbers(default, min, max)?;
            Kind::Triple { min, max, default }
        }
        TypeInner::Vector {
            size: VectorSize::Tri,
            scalar: Scalar::F32,
        } => Kind::Color {
            default: color(default)?,
        },
        TypeInner::Vector {
            size: VectorSize::Quad,
            scalar: Scalar::F32,
        } => Kind::OptionalColor {
            default: match default {
                "none" => None,
                _ => Some(color(default)?),
            },
        },
        _ => {
            return Err(
                "a parameter is an f32, a u32, an i32, a bool, a vec2<f32>, a vec3<f32> (a colour, or with \
                 @range three numbers) or a vec4<f32> (a colour or none)"
                    .to_owned(),
            );
        }
    };
    let unit = notes.get("unit").unwrap_or_default().to_owned();
    Ok(Param {
        name: name.to_owned(),
        doc: notes.words.clone(),
        unit,
        kind,
    })
}

fn color(text: &str) -> Result<String, String> {
    let hex = text.trim_matches('"');
    if hex.len() != 6 || !hex.chars().all(|c| c.is_ascii_hexdigit()) {
        return Err(format!("@default {text}: a colour is \"RRGGBB\""));
    }
    Ok(hex.to_owned())
}

fn range<T: std::str::FromStr + PartialOrd + Copy + Into<f64>>(
    notes: &Annotations,
) -> Result<(T, T), String> {
    let text = notes
        .get("range")
        .ok_or("its comment needs `@range MIN..MAX`")?;
    let bounds = text.split_once("..").and_then(|(min, max)| {
        Some((min.trim().parse::<T>().ok()?, max.trim().parse::<T>().ok()?))
    });
    match bounds {
        Some((min, max)) if min <= max && [min, max].iter().all(|&end| end.into().is_finite()) => {
            Ok((min, max))
        }
        _ => Err(format!("@range {text}: a range is `MIN..MAX`, both finite")),
    }
}

/// As many numbers in a range, with blanks between them.
fn numbers<const N: usize>(text: &str, min: f32, max: f32) -> Result<[f32; N], String> {
    let numbers = text.split_whitespace();
    let numbers = numbers.map(|number| within(number, min, max));
    let numbers: Vec<f32> = numbers.collect::<Result<_, _>>()?;
    numbers
        .try_into()
        .map_err(|_| format!("@default {text}: {N} numbers are needed, with blanks between them"))
}

fn within<T: std::str::FromStr + PartialOrd>(text: &str, min: T, max: T) -> Result<T, String> {
    match text.parse::<T>() {
        Ok(value) if value >= min && value <= max => Ok(value),
        _ => Err(format!("@default {text}: not a number in its range")),
    }
}
