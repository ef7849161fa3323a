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
