//! A joint with all that joints offer, and lists of them as an effect gets them.

use effects::wgsl::{Vec2, Vec3};
use effects::{InputSet, Joints};

/// An input's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Input {
    Number(f32),
    Whole(u32),
    Pair(Vec2<f32>),
    Triple(Vec3<f32>),
}

impl From<f32> for Input {
    fn from(value: f32) -> Self {
        Self::Number(value)
    }
}

impl From<u32> for Input {
    fn from(value: u32) -> Self {
        Self::Whole(value)
    }
}

impl From<Vec2<f32>> for Input {
    fn from(value: Vec2<f32>) -> Self {
        Self::Pair(value)
    }
}

impl From<Vec3<f32>> for Input {
    fn from(value: Vec3<f32>) -> Self {
        Self::Triple(value)
    }
}

/// Makes [`Joint`] of the lists of [`Joints`]. A list that is missing here doesn't compile: every input
/// must be tried.
macro_rules! inputs {
    ($($name:ident: $ty:ty,)*) => {
        /// One joint. Names, types and units are those of [`Joints`]; `unit` stands for its `pixel`.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct Joint {
            $(pub $name: $ty,)*
            pub strand: u32,
            pub unit: f32,
        }

        /// The inputs that a motion may change: not the strand's id, of which the seed is made.
        pub(crate) const CHANGING: &[&str] = &[$(stringify!($name),)* "unit"];

        impl Joint {
            /// The input of this name, as WGSL has it. `seed` is the layer's.
            pub fn input(&self, name: &str, seed: u32) -> Option<Input> {
                match name {
                    $(stringify!($name) => Some(self.$name.into()),)*
                    "strand" => Some(self.strand.into()),
                    "seed" => Some(effects::strand_seed(seed, self.strand).into()),
                    "unit" => Some(self.unit.into()),
                    _ => None,
                }
            }

            /// Sets the input of this name to a value of its type.
            pub fn set(&mut self, name: &str, value: Input) {
                match name {
                    $(stringify!($name) => value.store(&mut self.$name),)*
                    "unit" => value.store(&mut self.unit),
                    _ => {}
                }
            }
        }

        /// These joints for an effect that reads `read`: lists that it does not declare are empty.
        pub(crate) fn list(joints: &[Joint], read: InputSet) -> Joints {
            let by_strand = read.has("strand") || read.has("seed");
            Joints {
                $($name: column(joints, read.has(stringify!($name)), |joint| joint.$name),)*
                strand: column(joints, by_strand, |joint| joint.strand),
                pixel: column(joints, read.has("unit"), |joint| joint.unit),
                // The clump's own.
                strand_mean: Vec::new(),
                head_center: Vec::new(),
                head_height: Vec::new(),
                strand_size: Vec::new(),
            }
        }

        /// Every input that effects may declare.
        pub(crate) fn all_inputs() -> InputSet {
            InputSet::of(&[$(stringify!($name),)* "strand", "seed", "unit"])
        }
    };
}

inputs! {
    position: Vec3<f32>,
    forward: Vec3<f32>,
    backward: Vec3<f32>,
    u: f32,
    arc_length: f32,
    light_direction: Vec3<f32>,
    light_distance: f32,
    view_direction: Vec3<f32>,
    across: Vec2<f32>,
    normal: Vec3<f32>,
    material_normal: Vec3<f32>,
    clump_radius: f32,
    clump_color: Vec3<f32>,
    clump_shift: Vec2<f32>,
    gray: f32,
}

fn column<T>(joints: &[Joint], wanted: bool, value: impl Fn(&Joint) -> T) -> Vec<T> {
    if !wanted {
        return Vec::new();
    }
    joints.iter().map(value).collect()
}

impl Input {
    /// Puts the value where one of its type belongs.
    fn store<T: FromInput>(self, place: &mut T) {
        if let Some(value) = T::from_input(self) {
            *place = value;
        }
    }
}

trait FromInput: Sized {
    fn from_input(input: Input) -> Option<Self>;
}

impl FromInput for f32 {
    fn from_input(input: Input) -> Option<Self> {
        match input {
            Input::Number(value) => Some(value),
            _ => None,
        }
    }
}

impl FromInput for Vec2<f32> {
    fn from_input(input: Input) -> Option<Self> {
        match input {
            Input::Pair(value) => Some(value),
            _ => None,
        }
    }
}

impl FromInput for Vec3<f32> {
    fn from_input(input: Input) -> Option<Self> {
        match input {
            Input::Triple(value) => Some(value),
            _ => None,
        }
    }
}
