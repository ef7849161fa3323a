//! Strokes come out of blocks of joints as they come out one by one, bit for bit: at the ends of blocks and of lists too, and with parameters that vary.

use effects::wgsl::{Stroke, Vec2, Vec3, random_signed, vec2, vec3};
use effects::{
    Joints, LANES, ParamKind, Parameters, Program, Registry, Section as _, StrokeEffect, Strokes,
    Value, Values, Variation, Varied,
};

const JOINTS: usize = 2 * LANES + 5;
const SEED: u32 = 9;

/// Numbers from -1 to 1, of which no list has the same as another.
fn numbers(list: u32) -> impl Iterator<Item = f32> {
    (0..JOINTS as u32).map(move |joint| random_signed(list, joint))
}

fn pairs(list: u32) -> Vec<Vec2<f32>> {
    let pairs = numbers(list).zip(numbers(list + 1));
    pairs.map(|(x, y)| vec2([x, y])).collect()
}

fn directions(list: u32) -> Vec<Vec3<f32>> {
    let all = numbers(list).zip(numbers(list + 1)).zip(numbers(list + 2));
    let direction = |((x, y), z)| {
        let direction = vec3([x, y, z]);
        direction / direction.length()
    };
    all.map(direction).collect()
}

/// Joints of a strand or two, in any light.
fn joints() -> Joints {
    let colors = directions(10).into_iter().map(|color| color.abs());
    Joints {
        forward: directions(20),
        u: (0..JOINTS).map(|i| (i % 30) as f32 / 29.0).collect(),
        arc_length: (0..JOINTS).map(|i| 0.01 * (i % 30) as f32).collect(),
        seed: (0..JOINTS).map(|i| 77 + i as u32 / 30).collect(),
        head_height: vec![0.24; JOINTS],
        light_direction: directions(30),
        light_distance: numbers(40).map(|number| 2.0 + number).collect(),
        light_on_screen: directions(50),
        view_direction: directions(60),
        across: pairs(70),
        rest_position: directions(80),
        rest_forward: directions(120),
        normal: directions(90),
        clump_radius: numbers(100).map(|number| 10.0 * number.max(0.0)).collect(),
        clump_color: colors.collect(),
        clump_shift: pairs(110),
        ..Joints::default()
    }
}

fn bits(stroke: &Stroke) -> [u32; 7] {
    let [red, green, blue] = stroke.color.to_array();
    let (x, y) = (stroke.offset.x, stroke.offset.y);
    [x, y, stroke.radius, stroke.depth_offset, red, green, blue].map(f32::to_bits)
}

/// Default values, but for one choice, and whatever may vary does.
fn cases<E: StrokeEffect>() -> Vec<Values> {
    let table = E::Program::PARAMS;
    let mut cases = vec![Values::defaults(table)];
    for (index, param) in table.iter().enumerate() {
        let ParamKind::Choice { names, .. } = param.kind else {
            continue;
        };
        for choice in 0..names.len() as u32 {
            let mut values = Values::defaults(table);
            values.set(index, Value::Choice(choice));
            cases.push(values);
        }
    }
    let mut varied = cases.clone();
    for values in &mut varied {
        for (index, param) in table.iter().enumerate() {
            let ParamKind::Number {
                min,
                max,
                default,
                varies: true,
            } = param.kind
            else {
                continue;
            };
            let curve = vec![(0.1, min), (0.3, default), (1.0, 0.5 * (default + max))];
            values.set(index, Value::Varying(Variation { curve, vary: 0.3 }));
        }
    }
    cases.extend(varied);
    cases
}

fn check<E: StrokeEffect>() {
    let mut registry = Registry::new();
    registry.register::<E>().unwrap();
    let joints = joints();
    let ends = [0, 1, 7, LANES, LANES + 1, 2 * LANES, JOINTS - 1, JOINTS];
    let ranges = ends.iter().flat_map(|start| ends.map(|end| *start..end));
    for values in cases::<E>() {
        let program = registry.get(E::ID).unwrap().program(&values);
        let varied = Varied::<E::Program>::new(&values);
        for instance in 0..program.instances().min(3) {
            let mut single = Vec::new();
            varied.for_each(&joints, 0..JOINTS, SEED, |i, params| {
                single.push(E::Program::stroke(&joints, i, instance, SEED, params));
            });
            assert!(
                single
                    .iter()
                    .any(|stroke| stroke.color != single[0].color
                        || stroke.offset != single[0].offset)
            );
            for range in ranges.clone().filter(|range| range.start <= range.end) {
                let (mut strokes, mut radii) = (Strokes::default(), vec![3.0]);
                program.evaluate(&joints, range.clone(), instance, SEED, &mut strokes);
                program.radii(&joints, range.clone(), instance, SEED, &mut radii);
                assert_eq!(strokes.len(), range.len());
                assert_eq!(radii.len(), 1 + range.len());
                for ((stroke, radius), i) in strokes.iter().zip(&radii[1..]).zip(range) {
                    assert_eq!(bits(&stroke), bits(&single[i]), "{}, joint {i}", E::ID);
                    assert_eq!(radius.to_bits(), single[i].radius.to_bits());
                }
            }
        }
    }
}

macro_rules! check {
    ($($name:ident $effect:ident;)*) => {$(
        #[test]
        fn $name() {
            check::<effects_builtin::$effect>();
        }
    )*};
}

check! {
    band Band;
    base Base;
    cast Cast;
    cel Cel;
    fine Fine;
    highlight Highlight;
    ink Ink;
    silhouette Silhouette;
}
