use super::*;
use proptest::prelude::*;

proptest! {
    #[test]
    fn sine_and_cosine_are_those_of_any_angle(x in -1e4..1e4_f64) {
        prop_assert!((sin(x) - x.sin()).abs() < 4e-16);
        prop_assert!((cos(x) - x.cos()).abs() < 4e-16);
    }

    #[test]
    fn sine_and_cosine_are_odd_even_and_on_the_circle(x in -1e4..1e4_f64) {
        prop_assert_eq!(sin(-x), -sin(x));
        prop_assert_eq!(cos(-x), cos(x));
        prop_assert!((sin(x) * sin(x) + cos(x) * cos(x) - 1.0).abs() < 1e-15);
    }
}
