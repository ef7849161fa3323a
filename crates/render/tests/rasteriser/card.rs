//! A graphics card's picture, whose single precision sees a segment from its tile, and far discs from farther away.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

use crate::agreement::wrong;
use crate::drawings::drawing;
use glam::Vec2;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Run, Stretches};
use std::cell::RefCell;
use std::ops::Range;

/// A graphics card; none where there is no driver and nobody insists on one.
fn card() -> Option<Offscreen> {
    match Offscreen::open(AdapterKind::Any) {
        Ok(card) => Some(card),
        Err(GpuError::NoAdapter { .. }) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
            eprintln!("SKIPPED: no driver for a graphics card; `cargo xtask setup` installs one");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// What the shader that draws tiles is made for: a card keeps one, and to make it takes longer than a small picture.
fn shader_of(drawing: &Drawing) -> (Order, bool, bool) {
    let mut surfaces = drawing.surfaces.iter();
    let has_pictures = surfaces.any(|surface| surface.texture.is_some());
    (drawing.order, has_pictures, drawing.decals.is_empty())
}

#[test]
fn small_drawings_agree_on_a_graphics_card() {
    if card().is_none() {
        return;
    }
    let cards: RefCell<Vec<_>> = RefCell::default();
    let config = ProptestConfig {
        cases: 150,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let samples = prop_oneof![Just(1u32), Just(4)];
    let found = TestRunner::new(config).run(&(drawing(), samples), |(drawing, samples)| {
        let mut cards = cards.borrow_mut();
        let shader = shader_of(&drawing);
        let place = cards.iter().position(|(made_for, _)| *made_for == shader);
        let place = place.unwrap_or_else(|| {
            cards.push((shader, card().unwrap()));
            cards.len() - 1
        });
        let picture = cards[place].1.draw_strokes(&drawing, samples).unwrap();
        let (number, first) = wrong(&picture, &drawing, samples);
        prop_assert!(number <= 3, "{number} pixels differ, {first:?} first");
        Ok(())
    });
    if let Err(error) = found {
        panic!("{error}");
    }
}

/// A strand that the near plane cuts in two, one layer on both runs, one on the second alone, each stroke by its own depth:
/// the first layer's stroke is one stroke, whatever else lies on its runs. Found at random.
#[test]
fn a_stroke_goes_on_where_other_layers_begin() {
    let Some(mut card) = card() else {
        return;
    };
    let disc = |x, y, radius, inv_depth| Disc {
        center: Vec2::new(x, y),
        radius,
        inv_depth,
        inv_depth_biased: inv_depth,
    };
    let clump = [
        disc(1.473_346_7, 41.223_83, 0.153_949_6, 1.0),
        disc(19.665_989, 14352.497, 4.360_175_6, 2.116_861_6),
        disc(11.053_283, 11595.793, 5.975_903, 1.525_892_4),
        disc(43.957_134, 13.738_045, 1.765_381_9, 1.495_359_5),
        disc(10.922_84, 24.540_424, 0.0, 1.853_910_6),
        disc(9.022_493, 22.688_49, 7.270_83, 2.0),
    ];
    let on_both = [
        disc(24.938_07, 30.419_565, 9.090_099, 1.0),
        disc(39.086_216, 21.539_175, 78.907_78, 2.0),
        disc(29.079_81, 219.988_33, 0.716_565_3, 1.260_620_4),
        disc(23.716_524, 13.569_965, 2.666_017, 2.492_462_6),
        disc(-17_393.922, 21.597_82, 6.229_080_7, 2.0),
        disc(24.246_582, -79.561_16, 0.355_291_8, 2.0),
    ];
    let colors: Vec<[f32; 3]> = (0..6u8)
        .map(|joint| [f32::from(joint) / 5.0, f32::from(joint % 2), 0.5])
        .collect();
    let layer = |joints: Range<usize>, rank, discs: &[Disc]| LayerStrokes {
        name: String::new(),
        rank,
        instances: 1,
        stretches: Stretches::Everywhere,
        discs: discs[joints.clone()].to_vec(),
        colors: colors[joints.clone()].to_vec(),
        joints,
    };
    let run = |joints| Run { strand: 0, joints };
    for brush in [Brush::Circle, Brush::Semicircle] {
        let drawing = Drawing {
            size: [34, 38],
            runs: vec![run(0..3), run(3..6)],
            clump: clump.to_vec(),
            layers: vec![layer(0..6, 2, &on_both), layer(3..6, 0, &clump)],
            order: Order::Shifted,
            brush,
            ..Drawing::default()
        };
        let picture = card.draw_strokes(&drawing, 4).unwrap();
        let (number, first) = wrong(&picture, &drawing, 4);
        assert!(number <= 3, "{number} pixels differ, {first:?} first");
    }
}
