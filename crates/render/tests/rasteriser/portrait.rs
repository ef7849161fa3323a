//! Drawings like those of the program: a head, hair around it, all kinds of layers.

use glam::{DVec3, Vec2};
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Run, Stretches, Surface, SurfaceVertex};
use std::f64::consts::TAU;

const STRANDS: u32 = 80;
const JOINTS: usize = 60;
/// Of the head, in metres.
const HEAD_RADIUS: f64 = 0.11;
/// From the eye to the head's centre, in metres.
const DISTANCE: f64 = 0.8;
/// Of the hair at its widest, in metres.
const CLUMP_RADIUS: f64 = 0.006;

/// A number from 0 to 1 that looks random.
fn hash(a: u32, b: u32) -> f64 {
    let mut bits = a.wrapping_mul(0x9e37_79b9) ^ b.wrapping_mul(0x85eb_ca6b) ^ 0x2545_f491;
    for _ in 0..3 {
        bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    }
    f64::from(bits ^ (bits >> 16)) / 4_294_967_296.0
}

/// How a point in space (metres, y up, z to the eye, the head at 0) lands on the screen.
struct Projection {
    middle: [f64; 2],
    /// Pixels times metres.
    scale: f64,
}

impl Projection {
    fn position(&self, point: DVec3) -> Vec2 {
        let scale = self.scale / (DISTANCE - point.z);
        let [x, y] = self.middle;
        Vec2::new((x + scale * point.x) as f32, (y - scale * point.y) as f32)
    }

    /// A sphere moved by `offset` pixels and `behind` metres. Nearer than 1 cm counts as 1 cm.
    fn disc(&self, point: DVec3, radius: f64, offset: f32, behind: f64) -> Disc {
        let inv_depth = |depth: f64| (1.0 / depth.max(0.01)) as f32;
        let depth = DISTANCE - point.z + behind;
        Disc {
            center: self.position(point) + Vec2::new(offset, 0.3 * offset),
            radius: (self.scale * radius / (DISTANCE - point.z).max(0.01)) as f32,
            inv_depth: inv_depth(depth),
            inv_depth_biased: inv_depth(depth - CLUMP_RADIUS),
        }
    }
}

/// 80 strands of 60 joints on a head, with an outline, a base, four feathers of shade and two of
/// light. Some strands blow towards the eye; strands 10, 30, 50 and 70 have two runs.
pub fn portrait(size: [u32; 2], order: Order) -> Drawing {
    let [width, height] = size.map(f64::from);
    let projection = Projection {
        middle: [0.5 * width, 0.4 * height],
        scale: 1.4 * height,
    };
    let mut runs = Vec::new();
    let mut spheres = Vec::new();
    for strand in 0..STRANDS {
        let start = spheres.len();
        spheres.extend((0..JOINTS).map(|joint| sphere(strand, joint)));
        let end = spheres.len();
        let cut = if strand % 20 == 10 { start + 23 } else { start };
        let pieces = [start..cut, cut..end];
        let pieces = pieces.into_iter().filter(|joints| !joints.is_empty());
        runs.extend(pieces.map(|joints| Run { strand, joints }));
    }

    let layer = |name: &str,
                 rank,
                 instances,
                 disc: &dyn Fn(usize, usize) -> Disc,
                 color: &dyn Fn(usize) -> [f32; 3]| {
        let joints = 0..spheres.len();
        let all =
            (0..instances).flat_map(|instance| joints.clone().map(move |joint| (instance, joint)));
        LayerStrokes {
            name: name.to_owned(),
            joints: joints.clone(),
            rank,
            instances,
            stretches: Stretches::Everywhere,
            discs: all
                .clone()
                .map(|(instance, joint)| disc(instance, joint))
                .collect(),
            colors: all.map(|(_, joint)| color(joint)).collect(),
        }
    };
    let swept = |joint: usize, share: f64, offset: f32, behind: f64| {
        let (point, radius) = spheres[joint];
        projection.disc(point, share * radius, offset, behind)
    };
    let along = |joint: usize| (joint % JOINTS) as f32 / JOINTS as f32;
    let feather = |joint: usize, phase: f32, wide: f32| {
        let wave = (12.0 * along(joint) + phase).sin();
        f64::from((wave - 0.2).max(0.0) * wide)
    };
    Drawing {
        size,
        clump: (0..spheres.len())
            .map(|joint| swept(joint, 1.0, 0.0, 0.0))
            .collect(),
        layers: vec![
            layer(
                "outline",
                -1,
                1,
                &|_, joint| swept(joint, 1.25, 0.0, 0.012),
                &|_| [0.01, 0.0, 0.02],
            ),
            layer(
                "base",
                0,
                1,
                &|_, joint| swept(joint, 1.0, 0.0, 0.0),
                &|joint| [0.1 + 0.3 * along(joint), 0.5, 0.5 - 0.2 * along(joint)],
            ),
            layer(
                "shade",
                1,
                4,
                &|instance, joint| {
                    swept(
                        joint,
                        feather(joint, 0.0, 0.4),
                        1.2 * instance as f32 - 1.8,
                        -0.002,
                    )
                },
                &|joint| [0.02, 0.2, 0.3 * along(joint)],
            ),
            layer(
                "light",
                2,
                2,
                &|instance, joint| {
                    swept(
                        joint,
                        feather(joint, 2.5, 0.3),
                        2.0 * instance as f32,
                        -0.004,
                    )
                },
                &|_| [1.0; 3],
            ),
        ],
        runs,
        surfaces: vec![head(&projection)],
        background: Some([0.8, 0.8, 0.75]),
        order,
        sides: Vec::new(),
        side_stretches: Stretches::Everywhere,
        edge_depth_m: 0.02,
        brush: Brush::Circle,
        ..Drawing::default()
    }
}

/// Centre and radius of a strand's clump at a joint: from the scalp outwards, then down, or to the
/// eye for every eighth.
fn sphere(strand: u32, joint: usize) -> (DVec3, f64) {
    let u = joint as f64 / (JOINTS - 1) as f64;
    let angle = TAU * (f64::from(strand) * 0.381_966 + 0.02 * hash(strand, 0));
    let tilt = 1.3 * hash(strand, 1).sqrt();
    let root = DVec3::new(
        tilt.sin() * angle.cos(),
        tilt.cos(),
        tilt.sin() * angle.sin(),
    );
    let length = 0.12 + 0.15 * hash(strand, 2);
    let reach = 0.05 * (1.0 - (-6.0 * u).exp());
    let pull = if strand % 8 == 3 {
        DVec3::new(0.1, -0.2, 2.0)
    } else {
        DVec3::NEG_Y
    };
    let wave = 0.01 * (9.0 * u + TAU * hash(strand, 3)).sin() * u;
    let point = root * (HEAD_RADIUS + reach) + pull * length * u * u + DVec3::new(wave, 0.0, wave);
    let width = (TAU * 0.5 * (0.25 + 0.75 * u)).sin().max(0.0);
    (point, CLUMP_RADIUS * width)
}

/// A sphere of triangles, lit from the upper left.
fn head(projection: &Projection) -> Surface {
    const RINGS: u32 = 24;
    const SECTORS: u32 = 32;
    let mut surface = Surface {
        margin_m: 0.0,
        light: [0.9, 0.7, 0.6],
        shadow: [0.5, 0.3, 0.3],
        ..Surface::default()
    };
    for ring in 0..=RINGS {
        for sector in 0..=SECTORS {
            let polar = 0.5 * TAU * f64::from(ring) / f64::from(RINGS);
            let angle = TAU * f64::from(sector) / f64::from(SECTORS);
            let normal = DVec3::new(
                polar.sin() * angle.cos(),
                polar.cos(),
                polar.sin() * angle.sin(),
            );
            let point = HEAD_RADIUS * normal;
            let inv_depth = 1.0 / (DISTANCE - point.z);
            surface.vertices.push(SurfaceVertex {
                position: projection.position(point),
                inv_depth: inv_depth as f32,
                tone: ((normal.dot(DVec3::new(-0.5, 0.7, 0.5)) - 0.1) * inv_depth) as f32,
            });
            if ring < RINGS && sector < SECTORS {
                let corner = ring * (SECTORS + 1) + sector;
                let below = corner + SECTORS + 1;
                surface.triangles.push([corner, below, corner + 1]);
                surface.triangles.push([corner + 1, below, below + 1]);
            }
        }
    }
    surface
}

/// The strokes of a drawing on nothing, for their mask.
pub fn strokes_alone(drawing: &Drawing) -> Drawing {
    Drawing {
        surfaces: Vec::new(),
        background: None,
        ..drawing.clone()
    }
}
