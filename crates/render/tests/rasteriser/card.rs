//! A graphics card's picture, whose single precision sees a segment from its tile, and far discs from farther away.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

use crate::agreement::wrong;
use crate::drawings::drawing;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use render::gpu::{AdapterKind, GpuError, Offscreen};
use std::cell::RefCell;

#[test]
fn small_drawings_agree_on_a_graphics_card() {
    let card = match Offscreen::open(AdapterKind::Any) {
        Ok(card) => RefCell::new(card),
        Err(GpuError::NoAdapter { .. }) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
            eprintln!("SKIPPED: no driver for a graphics card; `cargo xtask setup` installs one");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    let config = ProptestConfig {
        cases: 150,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let samples = prop_oneof![Just(1u32), Just(4)];
    let found = TestRunner::new(config).run(&(drawing(), samples), |(drawing, samples)| {
        let picture = card.borrow_mut().draw_strokes(&drawing, samples).unwrap();
        let (number, first) = wrong(&picture, &drawing, samples);
        prop_assert!(number <= 3, "{number} pixels differ, {first:?} first");
        Ok(())
    });
    if let Err(error) = found {
        panic!("{error}");
    }
}
