//! Parameters: what there is, what it means, what values it takes. One table serves the parser, the
//! error messages, `inkstrand effects` and the documentation.

use crate::color::parse_hex;
use crate::texture::{Image, Ramp, Texture};
use crate::variation::Variation;
use std::sync::Arc;

/// One parameter of an effect or of a section of a preset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Param {
    /// Its name in the preset.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Its unit, empty where it has none.
    pub unit: &'static str,
    /// The values it takes.
    pub kind: ParamKind,
}

/// The values that a parameter takes, and its default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// A finite number in a range.
    Number {
        /// Least value.
        min: f32,
        /// Largest value.
        max: f32,
        /// Value where the preset says nothing.
        default: f32,
        /// Whether it may vary along a strand and from strand to strand.
        varies: bool,
    },
    /// A whole number in a range; of an effect an `i32` where the range begins below 0, else a `u32`.
    Integer {
        /// Least value.
        min: i32,
        /// Largest value.
        max: i32,
        /// Value where the preset says nothing.
        default: i32,
    },
    /// `true` or `false`.
    Flag {
        /// Value where the preset says nothing.
        default: bool,
    },
    /// One of several names.
    Choice {
        /// The names.
        names: &'static [&'static str],
        /// Index of the default.
        default: usize,
    },
    /// An sRGB colour, `"RRGGBB"`.
    Color {
        /// Value where the preset says nothing.
        default: &'static str,
    },
    /// An sRGB colour, or `none`.
    OptionalColor {
        /// Value where the preset says nothing.
        default: Option<&'static str>,
    },
    /// A picture or a gradient, or `none`.
    Texture {
        /// Value where the preset says nothing, as a preset has it.
        default: &'static str,
        /// Whether a picture goes on from its other edge beyond one, in place of going on as it is there.
        repeats: bool,
    },
    /// A text, such as a file's name; `None` where the preset says nothing.
    Text,
    /// Three numbers `(x, y, z)`, each in the range.
    Triple {
        /// Least value.
        min: f32,
        /// Largest value.
        max: f32,
        /// Value where the preset says nothing.
        default: [f32; 3],
    },
    /// Two numbers `(x, y)`, each in the range.
    Pair {
        /// Least value.
        min: f32,
        /// Largest value.
        max: f32,
        /// Value where the preset says nothing.
        default: [f32; 2],
    },
    /// Width and height `(w, h)`, whole numbers in the range.
    Size {
        /// Least value.
        min: u32,
        /// Largest value.
        max: u32,
        /// Value where the preset says nothing.
        default: [u32; 2],
    },
}

/// A parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// For [`ParamKind::Number`].
    Number(f32),
    /// For a number that varies.
    Varying(Variation),
    /// For [`ParamKind::Integer`].
    Integer(i32),
    /// For [`ParamKind::Flag`].
    Flag(bool),
    /// For [`ParamKind::Choice`]: the name's index.
    Choice(u32),
    /// For both kinds of colour: linear light.
    Color(Option<[f32; 3]>),
    /// For [`ParamKind::Texture`].
    Texture(Texture),
    /// For [`ParamKind::Text`].
    Text(Option<String>),
    /// For [`ParamKind::Triple`].
    Triple([f32; 3]),
    /// For [`ParamKind::Pair`].
    Pair([f32; 2]),
    /// For [`ParamKind::Size`].
    Size([u32; 2]),
}

impl ParamKind {
    /// The value where the preset says nothing.
    #[must_use]
    pub fn default_value(&self) -> Value {
        match *self {
            Self::Number { default, .. } => Value::Number(default),
            Self::Integer { default, .. } => Value::Integer(default),
            Self::Flag { default } => Value::Flag(default),
            Self::Choice { default, .. } => Value::Choice(default as u32),
            Self::Color { default } => Value::Color(parse_hex(default)),
            Self::OptionalColor { default } => Value::Color(default.and_then(parse_hex)),
            Self::Texture { default, .. } => Value::Texture(default_texture(default)),
            Self::Text => Value::Text(None),
            Self::Triple { default, .. } => Value::Triple(default),
            Self::Pair { default, .. } => Value::Pair(default),
            Self::Size { default, .. } => Value::Size(default),
        }
    }

    /// Whether a value is one of those that the parameter takes. Colours may be brighter than white.
    #[must_use]
    pub fn takes(&self, value: &Value) -> bool {
        let is_light =
            |color: &[f32; 3]| color.iter().all(|light| (0.0..=f32::MAX).contains(light));
        match (self, value) {
            (Self::Number { min, max, .. }, Value::Number(number)) => {
                (*min..=*max).contains(number)
            }
            (Self::Number { varies, .. }, Value::Varying(_)) => *varies,
            (Self::Integer { min, max, .. }, Value::Integer(number)) => {
                (*min..=*max).contains(number)
            }
            (Self::Flag { .. }, Value::Flag(_))
            | (Self::Text, Value::Text(_))
            | (Self::Texture { .. }, Value::Texture(_)) => true,
            (Self::Choice { names, .. }, Value::Choice(index)) => (*index as usize) < names.len(),
            (Self::Color { .. } | Self::OptionalColor { .. }, Value::Color(Some(color)))
            | (Self::Color { .. }, Value::Triple(color)) => is_light(color),
            (Self::OptionalColor { .. }, Value::Color(None)) => true,
            (Self::Triple { min, max, .. }, Value::Triple(triple)) => {
                triple.iter().all(|number| (*min..=*max).contains(number))
            }
            (Self::Pair { min, max, .. }, Value::Pair(pair)) => {
                pair.iter().all(|number| (*min..=*max).contains(number))
            }
            (Self::Size { min, max, .. }, Value::Size(size)) => {
                size.iter().all(|number| (*min..=*max).contains(number))
            }
            _ => false,
        }
    }

    /// What may be written, in words: `a number from 0 to 100`.
    #[must_use]
    pub fn expected(&self) -> String {
        match self {
            Self::Number { min, max, .. } => format!("a number from {min} to {max}"),
            Self::Integer { min, max, .. } if min == max => min.to_string(),
            Self::Integer { min, max, .. } => format!("a whole number from {min} to {max}"),
            Self::Flag { .. } => "true or false".to_owned(),
            Self::Choice { names, .. } => format!("one of {}", names.join(", ")),
            Self::Color { .. } => "a colour such as \"3FC1C0\"".to_owned(),
            Self::OptionalColor { .. } => "a colour such as \"3FC1C0\", or none".to_owned(),
            Self::Texture { .. } => {
                "a PNG file such as \"tone.png\", a gradient such as [(0, \"2A8F9D\"), (1, \"3FC1C0\")], or none".to_owned()
            }
            Self::Text => "a text in double quotes".to_owned(),
            Self::Triple { min, max, .. } => {
                format!("three numbers (x, y, z), each from {min} to {max}")
            }
            Self::Pair { min, max, .. } => {
                format!("two numbers (x, y), each from {min} to {max}")
            }
            Self::Size { min, max, .. } => {
                format!("width and height (w, h), whole numbers from {min} to {max}")
            }
        }
    }
}

/// The texture of a table's default, which `effects-testkit` holds to be one.
fn default_texture(text: &str) -> Texture {
    Ramp::parse(text).map_or(Texture::None, |ramp| Texture::Ramp(Arc::new(ramp)))
}

/// The values of an effect's parameters: every parameter of its table has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    pub(crate) table: &'static [Param],
    pub(crate) values: Vec<Value>,
}

impl Values {
    /// The defaults of `table`.
    #[must_use]
    pub fn defaults(table: &'static [Param]) -> Self {
        let values = table.iter().map(|p| p.kind.default_value()).collect();
        Self { table, values }
    }

    /// The value of any kind.
    ///
    /// # Panics
    ///
    /// Like all of these, when the table has no such parameter (of that kind): a mistake in the
    /// program, not in a preset.
    #[must_use]
    pub fn value(&self, name: &str) -> &Value {
        let index = self.table.iter().position(|p| p.name == name);
        &self.values[index.unwrap_or_else(|| panic!("no parameter `{name}` in this table"))]
    }

    /// A number's value; of one that varies that at the root.
    #[must_use]
    pub fn number(&self, name: &str) -> f32 {
        match self.value(name) {
            Value::Number(value) => *value,
            Value::Varying(variation) => variation.at(0.0),
            other => panic!("`{name}` is {other:?}, not a number"),
        }
    }

    /// A whole number's value.
    #[must_use]
    pub fn integer(&self, name: &str) -> i32 {
        match self.value(name) {
            Value::Integer(value) => *value,
            other => panic!("`{name}` is {other:?}, not a whole number"),
        }
    }

    /// Whether a flag is set.
    #[must_use]
    pub fn flag(&self, name: &str) -> bool {
        match self.value(name) {
            Value::Flag(value) => *value,
            other => panic!("`{name}` is {other:?}, not a flag"),
        }
    }

    /// A texture.
    #[must_use]
    pub fn texture(&self, name: &str) -> &Texture {
        match self.value(name) {
            Value::Texture(value) => value,
            other => panic!("`{name}` is {other:?}, not a texture"),
        }
    }

    /// Has an optional colour be none.
    pub fn take_color(&mut self, name: &str) {
        let index = self.table.iter().position(|p| p.name == name);
        match index.map(|index| &mut self.values[index]) {
            Some(Value::Color(color)) => *color = None,
            other => panic!("`{name}` is {other:?}, not a colour"),
        }
    }

    /// Puts the picture of each file in place of its name.
    ///
    /// # Errors
    ///
    /// The first that `read` has; what is behind it is left as it was.
    pub fn read_textures<E>(
        &mut self,
        mut read: impl FnMut(&str) -> Result<Arc<Image>, E>,
    ) -> Result<(), E> {
        for value in &mut self.values {
            if let Value::Texture(texture) = value
                && let Texture::File(file) = texture
            {
                let image = read(file)?;
                let file = std::mem::take(file);
                *texture = Texture::Image { file, image };
            }
        }
        Ok(())
    }

    /// Two numbers.
    #[must_use]
    pub fn pair(&self, name: &str) -> [f32; 2] {
        match self.value(name) {
            Value::Pair(value) => *value,
            other => panic!("`{name}` is {other:?}, not two numbers"),
        }
    }

    /// Three numbers.
    #[must_use]
    pub fn triple(&self, name: &str) -> [f32; 3] {
        match self.value(name) {
            Value::Triple(value) => *value,
            other => panic!("`{name}` is {other:?}, not three numbers"),
        }
    }

    /// A choice's index.
    #[must_use]
    pub fn choice(&self, name: &str) -> u32 {
        match self.value(name) {
            Value::Choice(value) => *value,
            other => panic!("`{name}` is {other:?}, not a choice"),
        }
    }

    /// A colour, linear light.
    #[must_use]
    pub fn color(&self, name: &str) -> [f32; 3] {
        match self.value(name) {
            Value::Color(Some(value)) => *value,
            other => panic!("`{name}` is {other:?}, not a colour"),
        }
    }

    /// A colour or none.
    #[must_use]
    pub fn optional_color(&self, name: &str) -> Option<[f32; 3]> {
        match self.value(name) {
            Value::Color(value) => *value,
            other => panic!("`{name}` is {other:?}, not a colour"),
        }
    }
}
