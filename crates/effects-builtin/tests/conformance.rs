//! Each effect holds to what every effect must hold to.

use effects_builtin::{Band, Base, Cast, Cel, Fine, Highlight, Ink, Silhouette};
use effects_testkit::{assert_conforms, assert_steady};

#[test]
fn band() {
    assert_conforms::<Band>();
    for along in ["height", "length"] {
        assert_steady::<Band>(&[("along", along), ("strand_share", "1"), ("rim", "4")]);
    }
}

#[test]
fn base() {
    assert_conforms::<Base>();
    assert_steady::<Base>(&[]);
}

#[test]
fn cast() {
    assert_conforms::<Cast>();
    assert_steady::<Cast>(&[]);
    assert_steady::<Cast>(&[("feathers", "5"), ("raggedness", "0.6")]);
}

#[test]
fn silhouette() {
    assert_conforms::<Silhouette>();
    assert_steady::<Silhouette>(&[]);
}

#[test]
fn cel() {
    assert_conforms::<Cel>();
    assert_steady::<Cel>(&[]);
    assert_steady::<Cel>(&[("region", "lighter"), ("full", "0.8"), ("threshold", "0.5")]);
}

#[test]
fn highlight() {
    assert_conforms::<Highlight>();
    for kind in ["specular", "distance", "ring"] {
        assert_steady::<Highlight>(&[("kind", kind)]);
    }
}

#[test]
fn ink() {
    assert_conforms::<Ink>();
    assert_steady::<Ink>(&[]);
    assert_steady::<Ink>(&[("gaps", "0.5"), ("shadow_color", "8090A0")]);
}

#[test]
fn fine() {
    assert_conforms::<Fine>();
    assert_steady::<Fine>(&[]);
}
