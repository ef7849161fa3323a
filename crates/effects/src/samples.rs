//! What a sample that a layer shows offers to effects that paint, and lists of samples: one list per input, empty where nobody reads
//! it.

/// Makes [`SampleInput`] and [`Samples`] of the table in `crates/effects-build/src/inputs.rs`.
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
        }
    };
}

for_each_sample_input!(inputs);

/// A set of what samples offer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleSet(u32);

const _: () = assert!(SampleInput::ALL.len() <= u32::BITS as usize);

impl SampleSet {
    /// These.
    #[must_use]
    pub const fn of(inputs: &[SampleInput]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < inputs.len() {
            bits |= 1 << inputs[i] as u32;
            i += 1;
        }
        Self(bits)
    }

    /// What is in either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is in this set and not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether the input is in the set.
    #[must_use]
    pub const fn has(self, input: SampleInput) -> bool {
        self.0 >> input as u32 & 1 == 1
    }

    /// Whether nothing is.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Its inputs, in the order of [`SampleInput::ALL`].
    pub fn iter(self) -> impl Iterator<Item = SampleInput> {
        let all = SampleInput::ALL.iter().copied();
        all.filter(move |input| self.has(*input))
    }
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
