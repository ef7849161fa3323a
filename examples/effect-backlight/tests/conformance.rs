//! The effect holds to what every effect must hold to.

use effect_backlight::Backlight;

#[test]
fn it_conforms() {
    effects_testkit::assert_conforms::<Backlight>();
}

#[test]
fn nothing_pops() {
    effects_testkit::assert_steady::<Backlight>(&[]);
}
