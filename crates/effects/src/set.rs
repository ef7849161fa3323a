//! Sets of an enum's values, a bit each.

/// Makes a set of an enum that has all its values as `ALL`, in their order: at most 64.
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// pub enum Tone {
///     Dark,
///     Lit,
/// }
///
/// impl Tone {
///     pub const ALL: &[Self] = &[Self::Dark, Self::Lit];
/// }
///
/// effects::set! {
///     /// Some tones.
///     pub struct Tones of Tone;
/// }
///
/// let tones = Tones::of(&[Tone::Lit]);
/// assert!(tones.has(Tone::Lit) && !tones.has(Tone::Dark));
/// assert_eq!(tones.union(Tones::of(&[Tone::Dark])).iter().count(), 2);
/// assert!(tones.without(tones).is_empty());
/// ```
#[macro_export]
macro_rules! set {
    ($(#[$doc:meta])* pub struct $set:ident of $value:ident;) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $set(u64);

        const _: () = assert!($value::ALL.len() <= u64::BITS as usize);

        impl $set {
            /// None.
            pub const NONE: Self = Self(0);

            /// These.
            #[must_use]
            pub const fn of(values: &[$value]) -> Self {
                let mut bits = 0;
                let mut i = 0;
                while i < values.len() {
                    bits |= 1 << values[i] as u64;
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

            /// Whether the value is in the set.
            #[must_use]
            pub const fn has(self, value: $value) -> bool {
                self.0 >> value as u64 & 1 == 1
            }

            /// Whether nothing is.
            #[must_use]
            pub const fn is_empty(self) -> bool {
                self.0 == 0
            }

            /// Its values, in the order of `ALL`.
            pub fn iter(self) -> impl Iterator<Item = $value> + Clone {
                let all = $value::ALL.iter().copied();
                all.filter(move |value| self.has(*value))
            }
        }
    };
}
