//! Levels: row 7.

use super::shown::pixel;
use super::shown::{Shown, draw, preset, stage};
use glam::{Vec2, Vec3};
use stage::Stage;
use std::collections::BTreeMap;
use std::f32::consts::{PI, TAU};

/// Where strands lie in a picture: their clumps as swept discs.
struct Swept {
    /// Of each strand its links: places in pixels and radii at both ends.
    links: BTreeMap<u32, Vec<[(Vec2, f32); 2]>>,
}

impl Swept {
    fn new(shown: &Shown) -> Self {
        let drawing = &shown.drawing;
        let mut links: BTreeMap<u32, Vec<_>> = BTreeMap::new();
        for (run, info) in drawing.runs.iter().zip(&drawing.features.runs) {
            let discs = drawing.clump[run.joints.clone()].windows(2);
            let ends = discs.map(|pair| [0, 1].map(|i| (pair[i].center, pair[i].radius)));
            links.entry(info.strand).or_default().extend(ends);
        }
        Self { links }
    }

    /// Whether a strand covers a place, by more than half a pixel.
    fn covers(&self, strand: u32, place: Vec2) -> bool {
        let covers = |[(a, from), (b, to)]: &[(Vec2, f32); 2]| {
            let along = *b - *a;
            let way = ((place - *a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
            place.distance(*a + way * along) < from + way * (to - from) - 0.5
        };
        self.links
            .get(&strand)
            .is_some_and(|links| links.iter().any(covers))
    }
}

/// The root of each strand from the head's middle, metres, of all that are seen from somewhere; and its level.
type Roots = BTreeMap<u32, (Vec3, u32)>;

/// Each strand with the one whose root is the nearest to the right of its own.
fn neighbours(roots: &Roots) -> Vec<[u32; 2]> {
    let angle = |root: Vec3| root.x.atan2(root.z);
    let right_of = |(id, (root, _)): (&u32, &(Vec3, u32))| {
        let is_right = |other: Vec3| {
            let turn = (angle(other) - angle(*root)).rem_euclid(TAU);
            turn > 0.0 && turn < PI
        };
        let others = roots.iter().filter(|(_, (other, _))| is_right(*other));
        let distance = |other: Vec3| other.distance_squared(*root);
        let nearest = others.min_by(|(_, a), (_, b)| distance(a.0).total_cmp(&distance(b.0)));
        nearest.map(|(other, _)| [*id, *other])
    };
    roots.iter().filter_map(right_of).collect()
}

/// The look in a small picture.
fn look(seed: &str) -> Stage {
    let settings = [("scene.size", "(267, 240)"), ("seed", seed)];
    stage(&preset("shin-levels.ron"), &settings)
}

/// All sides, degrees.
fn sides() -> impl Iterator<Item = f32> {
    (0..36).map(|side| 10.0 * side as f32)
}

/// The roots of all strands of a look: of those that are seen from some side.
fn all_roots(stage: &mut Stage) -> Roots {
    let mut roots = Roots::new();
    for yaw in sides() {
        stage.scene.camera.yaw = yaw;
        let frame = stage.frame().unwrap();
        let center = frame.objects[0].head.center;
        for run in &frame.paths.runs {
            let info = &frame.strands[run.strand];
            let root = frame.paths.position[run.joints.start] - center;
            if frame.paths.u[run.joints.start] == 0.0 {
                roots.insert(info.id, (root, info.level));
            }
        }
    }
    roots
}

/// Row 7: of neighbours in different levels that lie over one another the one of the higher level is seen, from 36 sides.
#[test]
fn neighbours_lie_as_their_levels_do() {
    let mut stage = look("2");
    let roots = all_roots(&mut stage);
    let pairs = neighbours(&roots);
    let (mut overlapping, mut in_order) = (0, 0);
    for yaw in sides() {
        stage.scene.camera.yaw = yaw;
        let shown = draw(&mut stage);
        let swept = Swept::new(&shown);
        let width = shown.drawing.size[0] as usize;
        let mut of_strands: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for i in shown.hair() {
            of_strands
                .entry(shown.samples[i].strand)
                .or_default()
                .push(i);
        }
        for pair in &pairs {
            let [left, right] = pair.map(|id| roots[&id].1);
            if left == right {
                continue;
            }
            let [high, low] = if left > right {
                *pair
            } else {
                [pair[1], pair[0]]
            };
            // Pixels that show one of both where the other lies, too.
            let [right, wrong] = [[high, low], [low, high]].map(|[seen, hidden]| {
                let pixels = of_strands.get(&seen).into_iter().flatten();
                pixels
                    .filter(|i| swept.covers(hidden, pixel(width, **i)))
                    .count()
            });
            if right + wrong >= 4 {
                overlapping += 1;
                in_order += usize::from(right > wrong);
            }
        }
    }
    let share = f64::from(in_order as u32) / f64::from(overlapping);
    println!(
        "row 7: {in_order} of {overlapping} overlapping neighbours in order, {:.1} %",
        100.0 * share
    );
    assert!(overlapping > 500 && share >= 0.95, "{share}");
}

/// Row 7: with `apart` no strand is in the level of one beside it.
#[test]
fn neighbours_are_apart() {
    for seed in ["1", "2", "3"] {
        let roots = all_roots(&mut look(seed));
        let equal = neighbours(&roots)
            .into_iter()
            .filter(|[left, right]| roots[left].1 == roots[right].1);
        assert_eq!(equal.count(), 0, "seed {seed}");
        for level in 0..3 {
            let count = roots.values().filter(|(_, of)| *of == level).count();
            assert!(
                count > roots.len() / 6,
                "seed {seed}: {count} in level {level}"
            );
        }
    }
}
