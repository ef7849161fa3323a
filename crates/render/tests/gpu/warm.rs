//! What is made, and what stays: pipelines and buffers for the layers that are on, none from frame to frame.

use crate::scene::{Scene, noop};
use render::Order;
use render::gpu::Offscreen;

fn on_noop() -> Offscreen {
    Offscreen::on(noop(wgpu::Limits::default())).unwrap()
}

#[test]
fn all_shaders_are_valid_in_every_order_and_brush() {
    let mut card = on_noop();
    for seed in 0..8 {
        let scene = Scene::random(seed);
        card.draw(&scene.frame(), 4).unwrap();
    }
}

#[test]
fn once_warm_nothing_is_made() {
    let mut card = on_noop();
    let scene = Scene::random(3);
    card.draw(&scene.frame(), 4).unwrap();
    assert!(card.stats().made > 10);
    let (pipelines, bytes) = (card.stats().pipelines, card.stats().bytes);
    for _ in 0..3 {
        card.draw(&scene.frame(), 4).unwrap();
        let stats = card.stats();
        assert_eq!(
            (stats.made, stats.pipelines, stats.bytes),
            (0, pipelines, bytes)
        );
    }
}

#[test]
fn objects_of_one_look_share_their_pipelines() {
    let mut card = on_noop();
    card.draw(&Scene::random(3).frame(), 4).unwrap();
    let alone = card.stats();
    let pair = Scene::random_pair(3);
    card.draw(&pair.frame(), 4).unwrap();
    // Parameters of a clump and eight layers.
    let together = card.stats();
    assert_eq!(together.pipelines, alone.pipelines);
    assert_eq!(together.buffers, alone.buffers + 9);
    card.draw(&pair.frame(), 4).unwrap();
    assert_eq!(card.stats().made, 0);
    card.draw(&Scene::random(3).frame(), 4).unwrap();
    assert_eq!(card.stats().buffers, alone.buffers);
}

/// Hair that moves by a little takes no more memory than buffers keep in reserve.
#[test]
fn once_warm_nothing_is_made_for_hair_that_moves() {
    let mut card = on_noop();
    let mut scene = Scene::random(3);
    card.draw(&scene.frame(), 4).unwrap();
    for step in 1..6 {
        scene.turn_by(4.0);
        card.draw(&scene.frame(), 4).unwrap();
        assert_eq!(card.stats().made, 0, "step {step}");
    }
}

#[test]
fn a_layer_that_is_off_has_no_pipeline_and_no_buffer() {
    let mut card = on_noop();
    let whole = Scene::random(3);
    card.draw(&whole.frame(), 4).unwrap();
    let before = card.stats();
    let mut some = Scene::random(3);
    // The highlight and cel shadows are smoothed by four pipelines, in a buffer of their own.
    some.layers.drain(2..4);
    some.layer_joints.drain(2..4);
    card.draw(&some.frame(), 4).unwrap();
    let after = card.stats();
    assert_eq!(after.pipelines, before.pipelines - 2 - 4);
    assert_eq!(after.buffers, before.buffers - 2 - 1);
    // And on again.
    card.draw(&whole.frame(), 4).unwrap();
    assert_eq!(card.stats().pipelines, before.pipelines);
}

#[test]
fn an_order_has_one_pipeline_at_a_time() {
    let mut card = on_noop();
    let mut scene = Scene::random(3);
    let counts = Order::ALL.map(|order| {
        scene.order = order;
        card.draw(&scene.frame(), 4).unwrap();
        card.stats().pipelines
    });
    assert_eq!(counts, [counts[0]; Order::ALL.len()]);
}
