//! One joint to try effects on.

use effects::wgsl::{Stroke, hash, vec2, vec3};
use effects::{Joints, Parameters, Program, StrokeEffect, Values};
use std::marker::PhantomData;

/// A joint of a strand that hangs down before the eye, its normal towards the eye, under a light from
/// above whose cosine to the normal is `gray`; a clump of radius `clump`, of colour (0.2, 0.4, 0.8).
pub fn lit_joint(gray: f32, clump: f32) -> Joints {
    Joints {
        position: vec![vec3([0.0; 3])],
        forward: vec![vec3([0.0, -1.0, 0.0])],
        backward: vec![vec3([0.0, 1.0, 0.0])],
        u: vec![0.5],
        seed: vec![hash(3)],
        light_direction: vec![vec3([0.0, (1.0 - gray * gray).max(0.0).sqrt(), gray])],
        light_distance: vec![3.0],
        view_direction: vec![vec3([0.0, 0.0, 1.0])],
        across: vec![vec2([-1.0, 0.0])],
        normal: vec![vec3([0.0, 0.0, 1.0])],
        clump_radius: vec![clump],
        clump_color: vec![vec3([0.2, 0.4, 0.8])],
        clump_shift: vec![vec2([0.0; 2])],
        gray: vec![gray.max(0.0)],
        ..Joints::default()
    }
}

/// An effect's parameters from texts.
pub struct One<E>(PhantomData<E>);

impl<E: StrokeEffect> One<E> {
    pub fn params(set: &[(&str, &str)]) -> <E::Program as Parameters>::Params {
        let mut values = Values::defaults(E::Program::PARAMS);
        for (name, text) in set {
            values.set_text(E::ID, name, text).unwrap();
        }
        E::Program::params(&values)
    }
}

/// The stroke of the only joint.
pub fn stroke<E: StrokeEffect>(
    joints: &Joints,
    instance: u32,
    seed: u32,
    set: &[(&str, &str)],
) -> Stroke {
    E::Program::stroke(joints, 0, instance, seed, &One::<E>::params(set))
}
