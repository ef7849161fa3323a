//! A joint with all that joints offer, and lists of them as an effect gets them.

use effects::wgsl::{Vec2, Vec3, hash};
use effects::{Input, InputSet, Joints};

/// An input's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum InputValue {
    Number(f32),
    Whole(u32),
    Pair(Vec2<f32>),
    Triple(Vec3<f32>),
}

impl From<f32> for InputValue {
    fn from(value: f32) -> Self {
        Self::Number(value)
    }
}

impl From<u32> for InputValue {
    fn from(value: u32) -> Self {
        Self::Whole(value)
    }
}

impl From<Vec2<f32>> for InputValue {
    fn from(value: Vec2<f32>) -> Self {
        Self::Pair(value)
    }
}

impl From<Vec3<f32>> for InputValue {
    fn from(value: Vec3<f32>) -> Self {
        Self::Triple(value)
    }
}

/// Makes [`Joint`] of the table of inputs. An input without a value in `hair.rs` doesn't compile: every one must be tried.
macro_rules! inputs {
    ($($(#[$doc:meta])* $input:ident $name:ident: $ty:ty,)*) => {
        /// One joint. Names, types and units are those of [`Joints`].
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct Joint {
            $(pub $name: $ty,)*
        }

        impl Joint {
            /// The input's value in WGSL. `seed` is the layer's.
            pub fn get(&self, input: Input, seed: u32) -> InputValue {
                if input == Input::Seed {
                    return hash(seed ^ self.seed).into();
                }
                match input {
                    $(Input::$input => self.$name.into(),)*
                }
            }

            /// Sets the input to a value of its type.
            pub fn set(&mut self, input: Input, value: InputValue) {
                match input {
                    $(Input::$input => value.store(&mut self.$name),)*
                }
            }
        }

        /// These joints for an effect that reads `read`: lists that it does not declare are empty.
        pub(crate) fn list(joints: &[Joint], read: InputSet) -> Joints {
            Joints {
                $($name: column(joints, read.has(Input::$input), |joint| joint.$name),)*
            }
        }
    };
}

effects::for_each_input!(inputs);

fn column<T>(joints: &[Joint], wanted: bool, value: impl Fn(&Joint) -> T) -> Vec<T> {
    if !wanted {
        return Vec::new();
    }
    joints.iter().map(value).collect()
}

impl InputValue {
    /// Puts the value where one of its type belongs.
    fn store<T: FromInput>(self, place: &mut T) {
        if let Some(value) = T::from_input(self) {
            *place = value;
        }
    }
}

trait FromInput: Sized {
    fn from_input(value: InputValue) -> Option<Self>;
}

impl FromInput for f32 {
    fn from_input(value: InputValue) -> Option<Self> {
        match value {
            InputValue::Number(value) => Some(value),
            _ => None,
        }
    }
}

impl FromInput for u32 {
    fn from_input(value: InputValue) -> Option<Self> {
        match value {
            InputValue::Whole(value) => Some(value),
            _ => None,
        }
    }
}

impl FromInput for Vec2<f32> {
    fn from_input(value: InputValue) -> Option<Self> {
        match value {
            InputValue::Pair(value) => Some(value),
            _ => None,
        }
    }
}

impl FromInput for Vec3<f32> {
    fn from_input(value: InputValue) -> Option<Self> {
        match value {
            InputValue::Triple(value) => Some(value),
            _ => None,
        }
    }
}
