//! The effect holds to what every effect must hold to.

use effect_engraving::Engraving;

#[test]
fn it_conforms() {
    effects_testkit::assert_conforms::<Engraving>();
}

#[test]
fn nothing_pops() {
    effects_testkit::assert_steady::<Engraving>(&[]);
}
