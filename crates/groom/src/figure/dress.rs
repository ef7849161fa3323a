//! What a figure wears: how much of the skin is covered, and what stands off it.

use super::body::{neck_axis, skin};
use super::planes::smooth;
use super::sewn::{Lie, Piece, Row, Run, band, slab};
use crate::solid::melt;
use glam::{Vec2, Vec3};

/// What a figure wears.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dress {
    /// Nothing.
    #[default]
    None,
    /// A band around the neck, and a top with straps.
    Choker,
    /// A collar that is rolled at the jaw.
    Turtleneck,
    /// A shirt with a folded collar and a tie.
    Collar,
    /// A jacket with a wide collar, open over a shirt.
    Jacket,
    /// A blouse with a sailor's collar and a bow.
    Sailor,
}

/// What a triangle is painted as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cloth {
    /// Skin.
    Skin,
    /// The dress.
    Dress,
    /// What is set off from it: a collar, a band, a bow.
    Accent,
    /// Hems and seams.
    Line,
}

/// A part of the surface that is painted: where a field is from one value to another, metres.
pub(crate) struct Layer {
    pub field: Field,
    pub from: f32,
    pub to: f32,
    pub cloth: Cloth,
}

/// About the distance to an edge on the body, metres, above 0 inside; x is 0 or above.
pub(crate) type Field = fn(Vec3) -> f32;

/// Width of hems, metres.
const HEM: f32 = 0.0012;

impl Dress {
    /// The signed distance to a dressed body, metres.
    pub(crate) fn distance(self, p: Vec3) -> f32 {
        let naked = skin(p, 1.0);
        if naked.abs() > 0.04 || p.y > 1.42 {
            return naked;
        }
        naked - self.thickness(p.with_x(p.x.abs()))
    }

    /// How far cloth stands off the skin, metres.
    fn thickness(self, p: Vec3) -> f32 {
        let cloth = |field: Field, thickness: f32| thickness * smooth(field(p) / 0.005);
        match self {
            Self::None => 0.0,
            Self::Choker => {
                let band = choker(p);
                0.0015 * smooth(band.min(CHOKER - band) / 0.002) + cloth(camisole, 0.001)
            }
            Self::Turtleneck => {
                let below = turtleneck(p);
                let roll = smooth(below / 0.008) * smooth((ROLL + 0.004 - below) / 0.008);
                cloth(turtleneck, 0.003) + 0.0045 * roll
            }
            Self::Collar => cloth(crew, 0.003),
            Self::Jacket => cloth(crew, 0.002) + 0.004 * smooth(outside_v(p) / 0.005),
            Self::Sailor => cloth(sailor, 0.003),
        }
    }

    /// What is painted on it, the lowest first.
    pub(crate) fn layers(self) -> Vec<Layer> {
        let layer = |field: Field, from: f32, to: f32, cloth| Layer {
            field,
            from,
            to,
            cloth,
        };
        let hemmed = |field: Field, cloth| {
            [
                layer(field, 0.0, f32::INFINITY, cloth),
                layer(field, 0.0, HEM, Cloth::Line),
            ]
        };
        let mut layers = Vec::new();
        match self {
            Self::None => {}
            Self::Choker => {
                layers.extend([
                    layer(strap, 0.0, STRAP, Cloth::Line),
                    layer(strap, HEM, STRAP - HEM, Cloth::Dress),
                ]);
                layers.extend(hemmed(camisole, Cloth::Dress));
                layers.extend([
                    layer(choker, 0.0, CHOKER, Cloth::Accent),
                    layer(choker, 0.0, HEM, Cloth::Line),
                    layer(choker, CHOKER - HEM, CHOKER, Cloth::Line),
                ]);
            }
            Self::Turtleneck => {
                layers.extend(hemmed(turtleneck, Cloth::Dress));
                layers.push(layer(turtleneck, ROLL, ROLL + HEM, Cloth::Line));
            }
            Self::Collar => layers.push(layer(crew, 0.0, f32::INFINITY, Cloth::Dress)),
            Self::Jacket => {
                layers.extend(hemmed(crew, Cloth::Accent));
                layers.extend(hemmed(outside_v, Cloth::Dress));
            }
            Self::Sailor => layers.extend(hemmed(sailor_below_collar, Cloth::Dress)),
        }
        layers
    }

    /// What is sewn on, of the half where x is 0 or above.
    pub(crate) fn pieces(self) -> Vec<Piece> {
        match self {
            Self::None | Self::Choker | Self::Turtleneck => Vec::new(),
            Self::Collar => vec![folded_collar()],
            Self::Jacket => vec![jacket_collar()],
            Self::Sailor => vec![sailor_collar()],
        }
    }

    /// What is sewn on across the middle.
    pub(crate) fn middle_pieces(self) -> Vec<Piece> {
        let on = |p: Vec3| self.distance(p);
        match self {
            Self::Collar => tie(on),
            Self::Sailor => bow(on),
            _ => Vec::new(),
        }
    }
}

/// Below a plane around the neck, which rises towards the back by `slope`.
fn below(p: Vec3, height: f32, slope: f32) -> f32 {
    (height - slope * (p.z + 0.03) - p.y) / (1.0 + slope * slope).sqrt()
}

/// How high the roll and the choker are, metres.
const ROLL: f32 = 0.026;
const CHOKER: f32 = 0.010;
/// How wide straps are, metres.
const STRAP: f32 = 0.010;

fn turtleneck(p: Vec3) -> f32 {
    below(p, 1.360, 0.30)
}

fn choker(p: Vec3) -> f32 {
    below(p, 1.350, 0.30)
}

fn crew(p: Vec3) -> f32 {
    below(p, 1.322, 0.60)
}

/// Below a line over the chest, between the arms.
fn camisole(p: Vec3) -> f32 {
    let top = 1.200 + 0.25 * (p.x - 0.02).clamp(0.0, 0.07) - p.y;
    let side = 0.108 + 0.10 * (1.20 - p.y) - p.x;
    melt(top, side, 0.012)
}

/// From the outer edge of a strap over the shoulder inwards.
fn strap(p: Vec3) -> f32 {
    if p.y > 1.36 {
        return 1.0; // the head, which is inside of straps as the neck is: a change of sign would be an edge
    }
    0.077 + 0.10 * (1.25 - p.y) - p.x
}

/// Outside of a V from the sides of the neck to the chest: in front alone.
fn outside_v(p: Vec3) -> f32 {
    let behind = (-0.030 - p.z).max(0.0);
    let edge = 0.010 + (p.y - 1.165).max(0.0) * 0.34;
    crew(p).min(0.94 * (p.x - edge) + 3.0 * behind)
}

fn sailor(p: Vec3) -> f32 {
    crew(p).min(outside_sailor_v(p, 1.222))
}

/// What is painted of it: its V ends below collar and bow, so that no strip of it shows beside them.
fn sailor_below_collar(p: Vec3) -> f32 {
    crew(p).min(outside_sailor_v(p, 1.212) - 0.007)
}

/// Outside of a V above a height.
fn outside_sailor_v(p: Vec3, bottom: f32) -> f32 {
    let behind = (-0.012 - p.z).max(0.0);
    let edge = (p.y - 1.222).max(0.0) * 0.50;
    0.87 * (p.x - edge) + 3.0 * behind + if p.y < bottom { 0.01 } else { 0.0 }
}

/// A point around the neck: `out` metres from its axis to the side, `ahead` to the front.
fn around(out: f32, y: f32, ahead: f32) -> Vec3 {
    Vec3::new(out, y, neck_axis(y) + ahead)
}

/// A collar from where it leaves the dress, 6 mm below its surface, over its fold to its edge, with a line along both and so many rows between them.
fn collar<const N: usize>(
    [base, fold, edge]: [[Vec3; N]; 3],
    between: usize,
    dress: Dress,
) -> Piece {
    let towards = |from: [Vec3; N], to: [Vec3; N]| -> Vec<Vec3> {
        let pairs = from.into_iter().zip(to);
        let aside = pairs.map(|(from, to)| from + (to - from).normalize_or_zero() * HEM);
        aside.collect()
    };
    let (below_fold, above_edge) = (towards(fold, edge), towards(edge, fold));
    let (cloth, line) = (Cloth::Dress, Cloth::Line);
    let row = |points: &[Vec3], lie, cloth, between| Row {
        points: points.to_vec(),
        lie,
        cloth,
        between,
    };
    let rows = [
        // Deep enough that lines of what lies close below a surface aren't seen through it.
        row(&base, Lie::At(-0.006), cloth, 0),
        row(&fold, Lie::Over(0.006), line, 0),
        row(&below_fold, Lie::Over(0.006), cloth, between),
        row(&above_edge, Lie::At(0.005), line, 0),
        row(&edge, Lie::At(0.005), cloth, 0),
    ];
    band(&rows, Run::Smooth, |p| dress.distance(p))
}

fn folded_collar() -> Piece {
    // From the back to the tips of the wings in front: where it leaves the neck, its fold, its edge.
    let base = [
        around(0.0, 1.332, -0.034),
        around(0.020, 1.331, -0.030),
        around(0.036, 1.322, -0.014),
        around(0.040, 1.313, 0.006),
        around(0.027, 1.293, 0.040),
        around(0.016, 1.282, 0.055),
    ];
    let fold = [
        around(0.0, 1.350, -0.042),
        around(0.022, 1.349, -0.037),
        around(0.041, 1.341, -0.019),
        around(0.046, 1.330, 0.006),
        around(0.030, 1.308, 0.040),
        around(0.004, 1.297, 0.055),
    ];
    let edge = [
        around(0.0, 1.318, -0.045),
        around(0.030, 1.321, -0.042),
        around(0.056, 1.331, -0.026),
        around(0.066, 1.322, 0.001),
        around(0.055, 1.281, 0.053),
        around(0.025, 1.256, 0.076),
    ];
    collar([base, fold, edge], 0, Dress::Collar)
}

/// Folded over a jacket, from the back to the lapels beside the V.
fn jacket_collar() -> Piece {
    let base = [
        around(0.0, 1.328, -0.038),
        around(0.028, 1.326, -0.030),
        around(0.042, 1.316, 0.000),
        around(0.040, 1.292, 0.026),
        around(0.022, 1.235, 0.062),
    ];
    let fold = [
        around(0.0, 1.356, -0.046),
        around(0.034, 1.353, -0.034),
        around(0.050, 1.340, 0.002),
        around(0.046, 1.312, 0.030),
        around(0.025, 1.238, 0.068),
    ];
    let edge = [
        around(0.0, 1.308, -0.060),
        around(0.050, 1.308, -0.046),
        around(0.076, 1.304, 0.000),
        around(0.080, 1.268, 0.044),
        around(0.034, 1.206, 0.070),
    ];
    // It stands up at the neck and lies on the shoulder: in one piece from the one to the other it would be pleated.
    collar([base, fold, edge], 5, Dress::Jacket)
}

/// The row of a sailor's collar from which its stripe goes to the next.
const STRIPE: usize = 7;

/// Over the shoulders, square on the back, its points at the bow.
fn sailor_collar() -> Piece {
    let inner = [
        (0.0, 1.338, -0.074),
        (0.028, 1.336, -0.066),
        (0.046, 1.330, -0.036),
        (0.042, 1.300, 0.004),
        (0.022, 1.262, 0.030),
        (0.004, 1.226, 0.042),
    ];
    let outer = [
        (0.0, 1.205, -0.104),
        (0.098, 1.212, -0.096),
        (0.118, 1.296, -0.046),
        (0.086, 1.270, 0.006),
        (0.050, 1.232, 0.034),
        (0.010, 1.205, 0.046),
    ];
    let row = |share: f32| -> Vec<Vec3> {
        let pairs = inner.iter().zip(&outer);
        let points = pairs.map(|(a, b)| Vec3::from(*a).lerp(Vec3::from(*b), share));
        points.collect()
    };
    // Down on the blouse to its edge, a stripe before it, and back under itself; so many rows that no shoulder comes through between two.
    let mut rows = vec![(0.0, Lie::At(-0.002)), (0.0, Lie::At(0.004))];
    let shares = [0.125, 0.25, 0.375, 0.5, 0.65, 0.80, 0.86, 1.0];
    rows.extend(shares.map(|share| (share, Lie::At(0.005))));
    rows.push((0.98, Lie::At(-0.002)));
    let rows = rows.into_iter().enumerate().map(|(i, (share, lie))| Row {
        points: row(share),
        lie,
        cloth: if i == STRIPE {
            Cloth::Dress
        } else {
            Cloth::Accent
        },
        between: 0,
    });
    let rows: Vec<Row> = rows.collect();
    band(&rows, Run::Cornered, |p| Dress::Sailor.distance(p))
}

fn tie(on: impl Fn(Vec3) -> f32) -> Vec<Piece> {
    let knot = [(-9.0, 0.0), (9.0, 0.0), (6.0, -20.0), (-6.0, -20.0)];
    let blade = [
        (-6.0, -19.0),
        (6.0, -19.0),
        (14.0, -120.0),
        (17.0, -224.0),
        (0.0, -244.0),
        (-17.0, -224.0),
        (-14.0, -120.0),
    ];
    let at = Vec2::new(0.0, 1.292);
    vec![
        // Under the collar's wings.
        slab(at, &blade, 0.0025, Cloth::Accent, &on),
        slab(at, &knot, 0.0045, Cloth::Accent, &on),
    ]
}

fn bow(on: impl Fn(Vec3) -> f32) -> Vec<Piece> {
    let at = Vec2::new(0.0, 1.216);
    let knot = [(-8.0, 9.0), (8.0, 9.0), (9.0, -9.0), (-9.0, -9.0)];
    let mut pieces = Vec::new();
    for side in [1.0, -1.0] {
        let loop_ = [
            (4.0, 6.0),
            (26.0, 18.0),
            (43.0, 17.0),
            (47.0, 2.0),
            (42.0, -13.0),
            (26.0, -12.0),
            (4.0, -5.0),
        ];
        let tail = [
            (2.0, -4.0),
            (9.0, -5.0),
            (22.0, -34.0),
            (33.0, -62.0),
            (20.0, -60.0),
            (13.0, -66.0),
            (6.0, -34.0),
        ];
        let turned = |points: &[(f32, f32)]| -> Vec<(f32, f32)> {
            points.iter().map(|(x, y)| (x * side, *y)).collect()
        };
        pieces.push(slab(at, &turned(&tail), 0.007, Cloth::Accent, &on));
        pieces.push(slab(at, &turned(&loop_), 0.014, Cloth::Accent, &on));
    }
    pieces.push(slab(at, &knot, 0.018, Cloth::Accent, &on));
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    const ALL: [Dress; 6] = [
        Dress::None,
        Dress::Choker,
        Dress::Turtleneck,
        Dress::Collar,
        Dress::Jacket,
        Dress::Sailor,
    ];

    #[test]
    fn skin_never_pokes_through_cloth() {
        for i in 0..20_000 {
            let at = |step: usize, low: f32, high: f32| {
                low + (high - low) * (i * step % 9973) as f32 / 9973.0
            };
            let p = Vec3::new(at(7, -0.2, 0.2), at(313, 0.8, 1.65), at(1013, -0.15, 0.13));
            for dress in ALL {
                let (cloth, skin) = (dress.distance(p), skin(p, 1.0));
                assert!(
                    cloth <= skin && cloth > skin - 0.012,
                    "{dress:?} at {p}: {cloth} {skin}"
                );
                // Nothing is worn on the head.
                assert!(p.y < 1.41 || cloth == skin, "{dress:?} at {p}");
            }
        }
    }

    #[test]
    fn no_shoulder_comes_through_a_sailors_collar() {
        let dress = Dress::Sailor;
        for piece in dress.pieces() {
            for triangle in &piece.triangles {
                let corners = triangle.map(|i| piece.positions[i as usize]);
                // Those on its underside lie in the cloth below.
                if corners.iter().any(|p| dress.distance(*p) < 0.003) {
                    continue;
                }
                let [a, b, c] = corners;
                for p in [
                    (a + b + c) / 3.0,
                    (a + b) / 2.0,
                    (b + c) / 2.0,
                    (c + a) / 2.0,
                ] {
                    let gap = dress.distance(p);
                    assert!(gap > 0.0, "at {p}: {gap}");
                }
            }
        }
    }

    #[test]
    fn pieces_lie_on_the_dress() {
        for dress in ALL {
            let pieces = dress.pieces().into_iter().chain(dress.middle_pieces());
            for piece in pieces {
                let gaps = piece.positions.iter().map(|p| dress.distance(*p));
                let gaps: Vec<f32> = gaps.collect();
                assert!(
                    gaps.iter().all(|gap| (-0.008..0.03).contains(gap)),
                    "{dress:?}: {gaps:?}"
                );
                let outside = gaps.iter().filter(|gap| **gap > 0.002).count();
                assert!(
                    2 * outside >= gaps.len(),
                    "{dress:?}: {outside} of {}",
                    gaps.len()
                );
            }
        }
    }

    #[test]
    fn collars_have_no_kinks() {
        for (dress, rows) in [(Dress::Collar, 5), (Dress::Jacket, 10)] {
            for piece in dress.pieces() {
                // Each that runs around the neck outside of the cloth.
                for row in 0..rows {
                    let points = piece.positions.iter().skip(row).step_by(rows).copied();
                    let points: Vec<Vec3> = points.collect();
                    if points.iter().any(|p| dress.distance(*p) < 0.0) {
                        continue;
                    }
                    let ways = points.windows(2).map(|p| p[1] - p[0]);
                    let ways: Vec<Vec3> = ways.collect();
                    let turns = ways.windows(2).map(|way| way[0].angle_between(way[1]));
                    let most = turns.fold(0.0, f32::max).to_degrees();
                    assert!(most < 42.0, "{dress:?}, row {row}: {most} degrees");
                }
            }
        }
    }

    #[test]
    fn a_jackets_collar_is_not_pleated() {
        let rows = 10;
        let piece = jacket_collar();
        // From below the fold to above the edge, but for what closes the end.
        let last = piece.positions.len() - rows;
        let falls = |i: &u32| (2..rows - 2).contains(&(*i as usize % rows)) && (*i as usize) < last;
        let mut normals = HashMap::new();
        let triangles = piece.triangles.iter();
        for triangle in triangles.filter(|triangle| triangle.iter().all(falls)) {
            let [a, b, c] = triangle.map(|i| piece.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                normals.insert((triangle[from], triangle[to]), normal);
            }
        }
        let turns = normals.iter().filter_map(|((from, to), normal)| {
            let beside = normals.get(&(*to, *from))?;
            Some(normal.angle_between(*beside).to_degrees())
        });
        let most = turns.fold(0.0, f32::max);
        // From 40 degrees on lines of creases are drawn, unless a preset says otherwise.
        assert!((5.0..40.0).contains(&most), "{most} degrees");
    }
}
