//! What a sample that a layer shows offers to effects that paint; lists of samples, one list per input, empty where nobody reads it; and
//! blocks of them, which vector instructions paint.

use crate::wgsl::Vec3;
use std::ops::Range;

/// Samples of a [`SampleBlock`].
pub const BLOCK: usize = 64;

/// A vector of each sample of a block: a number of each, direction by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// To the right, or red.
    pub x: [f32; BLOCK],
    /// Up, or green.
    pub y: [f32; BLOCK],
    /// To the front, or blue.
    pub z: [f32; BLOCK],
}

impl Vectors {
    /// All 0.
    pub const NOTHING: Self = Self {
        x: [0.0; BLOCK],
        y: [0.0; BLOCK],
        z: [0.0; BLOCK],
    };

    /// That of sample `index`.
    #[must_use]
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    pub fn at(&self, index: usize) -> Vec3<f32> {
        Vec3 {
            x: self.x[index],
            y: self.y[index],
            z: self.z[index],
        }
    }

    /// Sets that of sample `index`.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: Vec3<f32>) {
        self.x[index] = vector.x;
        self.y[index] = vector.y;
        self.z[index] = vector.z;
    }
}

/// What an input is of one sample, and of a block of them.
pub trait Number: Copy {
    /// That of each sample of a block.
    type Block;
    /// All 0.
    const NOTHING: Self::Block;
    /// Sets that of sample `index`.
    fn put(self, block: &mut Self::Block, index: usize);
}

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Number for $number {
            type Block = [$number; BLOCK];
            const NOTHING: Self::Block = [0 as $number; BLOCK];
            fn put(self, block: &mut Self::Block, index: usize) {
                block[index] = self;
            }
        }
    )*};
}

numbers!(f32, u32);

impl Number for Vec3<f32> {
    type Block = Vectors;
    const NOTHING: Vectors = Vectors::NOTHING;
    fn put(self, block: &mut Vectors, index: usize) {
        block.set(index, self);
    }
}

/// Makes [`SampleInput`], [`Samples`] and [`SampleBlock`] of the table in `crates/effects-build/src/inputs.rs`.
macro_rules! inputs {
    ($($(#[$doc:meta])* $input:ident $name:ident: $ty:ty,)*) => {
        /// Something that a sample offers to an effect that paints.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum SampleInput {
            $($(#[$doc])* $input,)*
        }

        impl SampleInput {
            /// All of them, in the order of the fields of WGSL's `struct Sample`.
            pub const ALL: &[Self] = &[$(Self::$input),*];

            /// The name of the field in WGSL, and of the list in [`Samples`].
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$input => stringify!($name),)*
                }
            }
        }

        /// Samples that one layer shows, as its effect paints them. Every list that it declares has one entry per sample; the
        /// others are empty.
        ///
        /// Of `seed` it has the strand's part, as [`Joints`](crate::Joints) has.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Samples {
            $($(#[$doc])* pub $name: Vec<$ty>,)*
        }

        impl Samples {
            /// Empties all lists, and keeps their memory.
            pub fn clear(&mut self) {
                $(self.$name.clear();)*
            }

            /// The length of a list.
            #[must_use]
            pub fn count(&self, input: SampleInput) -> usize {
                match input {
                    $(SampleInput::$input => self.$name.len(),)*
                }
            }

            /// Some of them, at most [`BLOCK`], as a block. What has no list is 0.
            #[must_use]
            pub fn block(&self, range: Range<usize>) -> SampleBlock {
                let mut block = SampleBlock::NOTHING;
                $(if !self.$name.is_empty() {
                    for (index, value) in self.$name[range.clone()].iter().enumerate() {
                        value.put(&mut block.$name, index);
                    }
                })*
                block
            }
        }

        /// [`BLOCK`] samples that one layer shows. What an effect doesn't declare, or doesn't read, is anything.
        #[derive(Clone, Debug, PartialEq)]
        pub struct SampleBlock {
            $($(#[$doc])* pub $name: <$ty as Number>::Block,)*
        }

        impl SampleBlock {
            /// All 0.
            pub const NOTHING: Self = Self {
                $($name: <$ty as Number>::NOTHING,)*
            };
        }
    };
}

for_each_sample_input!(inputs);

set! {
    /// A set of what samples offer.
    pub struct SampleSet of SampleInput;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets() {
        let set = SampleSet::of(&[SampleInput::W]).union(SampleSet::of(&[SampleInput::Color]));
        assert!(set.has(SampleInput::W) && !set.has(SampleInput::V) && !set.is_empty());
        assert_eq!(
            set.iter().map(SampleInput::name).collect::<Vec<_>>(),
            ["color", "w"]
        );
        assert_eq!(
            set.without(SampleSet::of(&[SampleInput::W])),
            SampleSet::of(&[SampleInput::Color])
        );
        assert!(SampleSet::default().is_empty());
    }
}
