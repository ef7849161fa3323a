//! Typed sections: one table gives a struct, its schema, what sets it and its help.
//!
//! ```
//! effects::choices! {
//!     /// What the light turns with.
//!     pub enum FixedTo {
//!         /// The world.
//!         World = "world",
//!         /// The camera.
//!         Camera = "camera",
//!     }
//! }
//!
//! effects::section! {
//!     /// Where the light comes from.
//!     pub struct Light {
//!         /// What the light turns with.
//!         fixed_to: FixedTo = FixedTo::World.or_another(),
//!         /// 0 shines at the face; positive comes from the viewer's right.
//!         yaw: f32 = number(35.0, -360.0..=360.0).unit("degrees"),
//!     }
//! }
//!
//! use effects::preset::Reader;
//! let text = "(fixed_to: camera)";
//! let mut reader = Reader::new("light.ron", text);
//! let light: Light = reader.section(text, "light");
//! assert_eq!(light, Light { fixed_to: FixedTo::Camera, yaw: 35.0 });
//! assert_eq!(Light::TABLE[1].doc, "0 shines at the face; positive comes from the viewer's right.");
//! ```

use crate::param::{Param, ParamKind, Value, Values};
use crate::variation::Variation;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

/// A section of a preset, or a part of a file beside it. [`section!`](crate::section!) makes them.
pub trait Section {
    /// What parameters there are.
    fn table(&self) -> &'static [Param];
    /// Sets number `index` of the table.
    ///
    /// # Panics
    ///
    /// When the table has no such number, or the value is of another kind than its parameter's.
    fn set(&mut self, index: usize, value: Value);
    /// The value of number `index` of the table; none where it is left to what reads the section.
    ///
    /// # Panics
    ///
    /// When the table has no such number.
    fn get(&self, index: usize) -> Option<Value>;

    /// Holds all values against the table, for sections that a program filled in.
    ///
    /// # Errors
    ///
    /// The first parameter whose value is not one of those it takes.
    fn check(&self) -> Result<(), OutOfRange> {
        let table = self.table();
        let wrong = (0..table.len()).find(|&index| {
            self.get(index)
                .is_some_and(|value| !table[index].kind.takes(&value))
        });
        wrong.map_or(Ok(()), |index| {
            Err(OutOfRange {
                param: table[index].name,
                expected: table[index].kind.expected(),
            })
        })
    }
}

impl Section for Values {
    fn table(&self) -> &'static [Param] {
        self.table
    }

    fn set(&mut self, index: usize, value: Value) {
        self.values[index] = value;
    }

    fn get(&self, index: usize) -> Option<Value> {
        Some(self.values[index].clone())
    }
}

/// A value that its parameter doesn't take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{param}: expected {expected}")]
#[non_exhaustive]
pub struct OutOfRange {
    /// The parameter.
    pub param: &'static str,
    /// What it takes, in words.
    pub expected: String,
}

/// The type of a section's field.
pub trait ParamType: Sized {
    /// From a value of its kind.
    ///
    /// # Panics
    ///
    /// When the value is of another kind.
    fn from_value(value: Value) -> Self;
    /// As a value of its kind; none of an option that is not given.
    fn to_value(&self) -> Option<Value>;
    /// Where the section says nothing: the kind's default, or none for what is an option.
    fn unset(kind: &ParamKind) -> Self {
        Self::from_value(kind.default_value())
    }
}

/// A parameter's description, of type `T`, that becomes a row of the table.
#[derive(Clone, Copy)]
pub struct Spec<T> {
    /// The values it takes.
    pub kind: ParamKind,
    /// Its unit, empty where it has none.
    pub unit: &'static str,
    field: PhantomData<T>,
}

impl<T> Spec<T> {
    /// A parameter of that kind, without a unit.
    #[must_use]
    pub const fn new(kind: ParamKind) -> Self {
        Self {
            kind,
            unit: "",
            field: PhantomData,
        }
    }

    /// The same in this unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self {
            kind: self.kind,
            unit,
            field: PhantomData,
        }
    }
}

impl<T: Copy> Spec<T> {
    /// The same, but what reads the section can tell whether it was given: the default is what a reader takes for none.
    #[must_use]
    pub const fn optional(self) -> Spec<Option<T>> {
        Spec {
            kind: self.kind,
            unit: self.unit,
            field: PhantomData,
        }
    }
}

/// A finite number.
#[must_use]
pub const fn number(default: f32, range: RangeInclusive<f32>) -> Spec<f32> {
    Spec::new(ParamKind::Number {
        min: *range.start(),
        max: *range.end(),
        default,
        varies: false,
    })
}

/// A number that may vary along a strand and from strand to strand.
#[must_use]
pub const fn varying(default: f32, range: RangeInclusive<f32>) -> Spec<Variation> {
    Spec::new(ParamKind::Number {
        min: *range.start(),
        max: *range.end(),
        default,
        varies: true,
    })
}

/// A whole number, 0 or more.
#[must_use]
pub const fn whole(default: u32, range: RangeInclusive<u32>) -> Spec<u32> {
    // Tables are made when the program is built, and a limit beyond `i32` stops that.
    assert!(*range.end() <= i32::MAX as u32);
    Spec::new(ParamKind::Integer {
        min: *range.start() as i32,
        max: *range.end() as i32,
        default: default as i32,
    })
}

/// A whole number, of either sign.
#[must_use]
pub const fn integer(default: i32, range: RangeInclusive<i32>) -> Spec<i32> {
    Spec::new(ParamKind::Integer {
        min: *range.start(),
        max: *range.end(),
        default,
    })
}

/// `true` or `false`.
#[must_use]
pub const fn flag(default: bool) -> Spec<bool> {
    Spec::new(ParamKind::Flag { default })
}

/// An sRGB colour "RRGGBB"; the field is linear light.
#[must_use]
pub const fn color(default: &'static str) -> Spec<[f32; 3]> {
    Spec::new(ParamKind::Color { default })
}

/// An sRGB colour "RRGGBB", or `none`; the field is linear light.
#[must_use]
pub const fn optional_color(default: Option<&'static str>) -> Spec<Option<[f32; 3]>> {
    Spec::new(ParamKind::OptionalColor { default })
}

/// A text, such as a file's name.
#[must_use]
pub const fn text() -> Spec<Option<String>> {
    Spec::new(ParamKind::Text)
}

/// Three numbers `(x, y, z)`, each in the range.
#[must_use]
pub const fn triple(default: [f32; 3], range: RangeInclusive<f32>) -> Spec<[f32; 3]> {
    Spec::new(ParamKind::Triple {
        min: *range.start(),
        max: *range.end(),
        default,
    })
}

/// Width and height `(w, h)`, each in the range.
#[must_use]
pub const fn size(default: [u32; 2], range: RangeInclusive<u32>) -> Spec<[u32; 2]> {
    Spec::new(ParamKind::Size {
        min: *range.start(),
        max: *range.end(),
        default,
    })
}

/// Implements [`ParamType`] for a type whose values are always given.
macro_rules! param_type {
    ($type:ty: $from:pat => $own:expr, $value:ident => $to:expr) => {
        impl ParamType for $type {
            fn from_value(value: Value) -> Self {
                match value {
                    $from => $own,
                    other => wrong_kind(&other),
                }
            }

            fn to_value(&self) -> Option<Value> {
                let $value = self;
                Some($to)
            }
        }
    };
}

param_type!(f32: Value::Number(number) => number, own => Value::Number(*own));
param_type!(i32: Value::Integer(number) => number, own => Value::Integer(*own));
param_type!(bool: Value::Flag(flag) => flag, own => Value::Flag(*own));
param_type!([u32; 2]: Value::Size(size) => size, own => Value::Size(*own));
param_type!(Option<[f32; 3]>: Value::Color(color) => color, own => Value::Color(*own));
param_type!(Option<String>: Value::Text(text) => text, own => Value::Text(own.clone()));
// More than an `i32` holds is outside of any range.
param_type!(u32: Value::Integer(number) => number.unsigned_abs(),
    own => Value::Integer(i32::try_from(*own).unwrap_or(i32::MIN)));

impl ParamType for Variation {
    fn from_value(value: Value) -> Self {
        match value {
            Value::Number(number) => Self::constant(number),
            Value::Varying(variation) => variation,
            other => wrong_kind(&other),
        }
    }

    fn to_value(&self) -> Option<Value> {
        Some(match self.as_constant() {
            Some(number) => Value::Number(number),
            None => Value::Varying(self.clone()),
        })
    }
}

impl ParamType for [f32; 3] {
    fn from_value(value: Value) -> Self {
        match value {
            Value::Triple(triple) => triple,
            Value::Color(Some(color)) => color,
            other => wrong_kind(&other),
        }
    }

    fn to_value(&self) -> Option<Value> {
        Some(Value::Triple(*self))
    }
}

/// Implements [`ParamType`] for the option of a number.
macro_rules! option_type {
    ($($type:ty),*) => {$(
        impl ParamType for Option<$type> {
            fn from_value(value: Value) -> Self {
                Some(<$type>::from_value(value))
            }

            fn to_value(&self) -> Option<Value> {
                self.as_ref().and_then(<$type>::to_value)
            }

            fn unset(_: &ParamKind) -> Self {
                None
            }
        }
    )*};
}

option_type!(f32, i32, u32);

/// A value of a kind that its parameter doesn't have: a mistake in the program, not in a preset.
pub(crate) fn wrong_kind(value: &Value) -> ! {
    panic!("{value:?} is of another kind than its parameter")
}

/// Makes an enum of the names that a preset may choose from, usable as the type of a [`section!`](crate::section!)'s field:
/// `kind: Kind = Kind::First.or_another()`.
#[macro_export]
macro_rules! choices {
    (
        $(#[$attribute:meta])*
        $visible:vis enum $Name:ident {
            $($(#[$about:meta])* $Variant:ident = $name:literal),+ $(,)?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visible enum $Name {
            $($(#[$about])* $Variant),+
        }

        impl $Name {
            const ALL: &'static [Self] = &[$(Self::$Variant),+];
            const NAMES: &'static [&'static str] = &[$($name),+];

            /// The name in presets.
            #[must_use]
            #[allow(dead_code, reason = "not every choice is shown")]
            $visible const fn name(self) -> &'static str {
                Self::NAMES[self as usize]
            }

            /// A parameter that is this one where nothing else is chosen.
            #[must_use]
            $visible const fn or_another(self) -> $crate::section::Spec<Self> {
                $crate::section::Spec::new($crate::ParamKind::Choice {
                    names: Self::NAMES,
                    default: self as usize,
                })
            }
        }

        impl $crate::section::ParamType for $Name {
            fn from_value(value: $crate::Value) -> Self {
                match value {
                    $crate::Value::Choice(index) => Self::ALL[index as usize],
                    other => panic!("{other:?} is no choice"),
                }
            }

            fn to_value(&self) -> Option<$crate::Value> {
                Some($crate::Value::Choice(*self as u32))
            }
        }
    };
}

/// Makes a [`Section`]: a struct with public fields, `Default`, what it is about (`DOC`), and the table (`TABLE`) that parser, help
/// and errors read. A field is `name: type = description`, with a comment that is its help; `name as "other"` is called `other` in presets.
///
/// The descriptions are the functions of the module [`section`](mod@crate::section).
#[macro_export]
macro_rules! section {
    (
        $(#[doc = $about:literal])+
        $visible:vis struct $Name:ident {
            $($(#[doc = $doc:literal])+ $field:ident $(as $called:literal)?: $type:ty = $spec:expr),+ $(,)?
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        $visible struct $Name {
            $($(#[doc = $doc])+ pub $field: $type),+
        }

        impl $Name {
            /// What it is about.
            #[allow(dead_code, reason = "parts of files beside presets have more to say")]
            pub const DOC: &'static str = concat!($($about),+).trim_ascii();

            /// What parameters there are.
            pub const TABLE: &'static [$crate::Param] = &[$({
                #[allow(unused_imports, reason = "no section has every kind")]
                use $crate::section::*;
                const SPEC: Spec<$type> = $spec;
                $crate::Param {
                    name: $crate::section!(@name $field $($called)?),
                    doc: concat!($($doc),+).trim_ascii(),
                    unit: SPEC.unit,
                    kind: SPEC.kind,
                }
            }),+];
        }

        impl Default for $Name {
            fn default() -> Self {
                let mut rows = Self::TABLE.iter();
                let mut next = || &rows.next().expect("a row for each field").kind;
                Self {
                    $($field: <$type as $crate::section::ParamType>::unset(next())),+
                }
            }
        }

        impl $crate::section::Section for $Name {
            fn table(&self) -> &'static [$crate::Param] {
                Self::TABLE
            }

            fn set(&mut self, index: usize, value: $crate::Value) {
                let mut fields = 0..;
                $(if fields.next() == Some(index) {
                    self.$field = <$type as $crate::section::ParamType>::from_value(value);
                    return;
                })+
                panic!("no parameter {index}");
            }

            fn get(&self, index: usize) -> Option<$crate::Value> {
                let mut fields = 0..;
                $(if fields.next() == Some(index) {
                    return $crate::section::ParamType::to_value(&self.$field);
                })+
                panic!("no parameter {index}");
            }
        }
    };
    (@name $field:ident) => {
        stringify!($field)
    };
    (@name $field:ident $called:literal) => {
        $called
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::Reader;

    choices! {
        enum Kind {
            Thin = "thin",
            Thick = "thick",
        }
    }

    section! {
        /// A line.
        struct Line {
            /// How thick,
            /// in words.
            kind as "type": Kind = Kind::Thick.or_another(),
            /// Width.
            width: f32 = number(1.5, 0.0..=10.0).unit("px"),
            /// Number.
            count: u32 = whole(3, 1..=9),
            /// Rank.
            rank: Option<i32> = integer(0, -5..=5).optional(),
            /// On both sides.
            mirror: bool = flag(false),
            /// Ink.
            ink: [f32; 3] = color("FFFFFF"),
            /// Paper.
            paper: Option<[f32; 3]> = optional_color(Some("000000")),
            /// A file.
            file: Option<String> = text(),
            /// Where.
            at: [f32; 3] = triple([1.0, 2.0, 3.0], -9.0..=9.0),
            /// Of the picture.
            size: [u32; 2] = size([4, 3], 1..=99),
        }
    }

    fn read(text: &str) -> Result<Line, String> {
        let mut reader = Reader::new("line.ron", text);
        let line = reader.section(text, "a line");
        reader.report().map_err(|errors| errors.to_string())?;
        Ok(line)
    }

    #[test]
    fn defaults_are_the_tables() {
        let line = read("()").unwrap();
        assert_eq!(line, Line::default());
        assert_eq!(line.kind, Kind::Thick);
        assert_eq!((line.width, line.count, line.rank), (1.5, 3, None));
        assert_eq!((line.ink, line.paper), ([1.0; 3], Some([0.0; 3])));
        assert_eq!((line.at, line.size), ([1.0, 2.0, 3.0], [4, 3]));
        assert_eq!(Line::TABLE[0].name, "type");
        assert_eq!(Line::TABLE[0].doc, "How thick, in words.");
        assert_eq!(Line::TABLE[1].unit, "px");
    }

    #[test]
    fn every_field_is_read() {
        let text = "(type: thin, width: 2, count: 4, rank: -1, mirror: true, ink: \"000000\", paper: none, \
             file: \"a.obj\", at: (0, 0, 1), size: (8, 6))";
        let expected = Line {
            kind: Kind::Thin,
            width: 2.0,
            count: 4,
            rank: Some(-1),
            mirror: true,
            ink: [0.0; 3],
            paper: None,
            file: Some("a.obj".to_owned()),
            at: [0.0, 0.0, 1.0],
            size: [8, 6],
        };
        assert_eq!(read(text), Ok(expected.clone()));
        assert_eq!(expected.check(), Ok(()));
        assert_eq!(expected.kind.name(), "thin");
    }

    #[test]
    fn what_a_program_sets_is_held_against_the_table() {
        let wrong = [
            Line {
                width: f32::NAN,
                ..Line::default()
            },
            Line {
                count: u32::MAX,
                ..Line::default()
            },
            Line {
                ink: [f32::INFINITY, 0.0, 0.0],
                ..Line::default()
            },
            Line {
                size: [0, 3],
                ..Line::default()
            },
        ];
        let params = wrong.map(|line| line.check().unwrap_err().param);
        assert_eq!(params, ["width", "count", "ink", "size"]);
        let error = Line {
            width: 11.0,
            ..Line::default()
        };
        let error = error.check().unwrap_err().to_string();
        assert_eq!(error, "width: expected a number from 0 to 10");
    }
}
