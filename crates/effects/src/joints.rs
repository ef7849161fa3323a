//! What joints offer to effects, and the joints of all strands: one list per input, empty where nobody reads it.

/// Makes [`Input`] and [`Joints`] of the table in `crates/effects-build/src/inputs.rs`.
macro_rules! inputs {
    ($($(#[$doc:meta])* $input:ident $name:ident: $ty:ty,)*) => {
        /// Something that a joint offers to effects.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Input {
            $($(#[$doc])* $input,)*
        }

        impl Input {
            /// All inputs, in the order of the fields of WGSL's `struct Inputs`.
            pub const ALL: &[Self] = &[$(Self::$input),*];

            /// The name of the field in WGSL, and of the list in [`Joints`].
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$input => stringify!($name),)*
                }
            }
        }

        /// The joints of all strands, as effects see them. Every list that an active effect declares has one entry per joint;
        /// the others are empty, and that of `unit` where it is 1 everywhere.
        ///
        /// Of `seed` it has the strand's part, [`hash`](crate::wgsl::hash) of its id: the layer's own is mixed in as it is read ([`strand_seed`](crate::strand_seed)).
        #[derive(Clone, Debug, Default)]
        pub struct Joints {
            $($(#[$doc])* pub $name: Vec<$ty>,)*
        }

        impl Joints {
            /// Empties all lists, and keeps their memory.
            pub fn clear(&mut self) {
                $(self.$name.clear();)*
            }
        }
    };
}

for_each_input!(inputs);

set! {
    /// A set of inputs.
    pub struct InputSet of Input;
}

/// Joints of which strokes are worked out at once, by vector instructions.
pub const LANES: usize = 16;

/// The values of [`LANES`] joints from `first` on; where the list ends before, the last one's again. Translated code asks for those of each input that it
/// declares.
///
/// They are copied, as compilers load nothing ahead of a branch from where they know of no values.
#[must_use]
#[inline(always)]
pub fn block<T: Copy>(list: &[T], first: usize) -> [T; LANES] {
    let list = &list[first..];
    match list.first_chunk() {
        Some(block) => *block,
        None => padded(list),
    }
}

#[cold]
fn padded<T: Copy>(list: &[T]) -> [T; LANES] {
    std::array::from_fn(|lane| list[lane.min(list.len() - 1)])
}

/// The same of an input whose list may be empty: then they are `otherwise`.
#[must_use]
#[inline(always)]
pub fn block_or<T: Copy>(list: &[T], first: usize, otherwise: T) -> [T; LANES] {
    match list.is_empty() {
        true => [otherwise; LANES],
        false => block(list, first),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_go_on_with_the_last_joint() {
        let list: Vec<u32> = (0..20).collect();
        assert_eq!(block(&list, 3), std::array::from_fn(|lane| lane as u32 + 3));
        assert_eq!(block(&list, 18)[..4], [18, 19, 19, 19]);
        assert_eq!(block_or(&[], 18, 7), [7; LANES]);
        assert_eq!(block_or(&list[..1], 0, 7), [0; LANES]);
    }

    #[test]
    fn sets() {
        let set = InputSet::of(&[Input::Gray, Input::U]).union(InputSet::of(&[Input::Strand]));
        assert!(set.has(Input::Gray) && set.has(Input::U) && set.has(Input::Strand));
        assert!(!set.has(Input::Normal));
        let names: Vec<_> = set.iter().map(Input::name).collect();
        assert_eq!(names, ["u", "strand", "gray"]);
    }
}
