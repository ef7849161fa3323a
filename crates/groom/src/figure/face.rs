//! A figure's drawn face.

use crate::face::{
    FRONT, FacePart, Ink, Patch, Sheet, collarbone, ear_lines, keep_inside, line, mark, mirrored,
    neck,
};
use crate::ribbon::{Flat, curve, ellipse, fill, stroke};
use crate::shape::{EAR, EAR_BACK, EAR_UP, EYE_HEIGHT};
use glam::{Vec2, Vec3};

/// The cut of the eyes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Eyes {
    /// Large and open.
    #[default]
    Round,
    /// Long, a little pointed.
    Almond,
    /// Narrow, the outer corners raised.
    Sharp,
    /// Under heavy lids, the outer corners low.
    Sleepy,
}

/// What a face says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Expression {
    /// At rest.
    #[default]
    Neutral,
    /// A smile with open eyes.
    Smile,
    /// An open mouth under eyes closed upwards.
    Laugh,
    /// Eyes closed at rest.
    Closed,
}

/// Blush on the cheeks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blush {
    /// None.
    #[default]
    None,
    /// A flat shape under each eye.
    Flat,
    /// Slanted strokes.
    Hatch,
}

/// A drawn face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// The cut of the eyes.
    pub eyes: Eyes,
    /// Size of the eyes, 0.7 to 1.2; 1 is theirs.
    pub eye_size: f32,
    /// Lights in each eye, 0 to 3.
    pub highlights: u32,
    /// What it says.
    pub expression: Expression,
    /// Width of the brows, 0 to 3; 1 is theirs.
    pub brow: f32,
    /// Blush on the cheeks.
    pub blush: Blush,
}

impl Default for Face {
    fn default() -> Self {
        Self {
            eyes: Eyes::default(),
            eye_size: 1.0,
            highlights: 2,
            expression: Expression::default(),
            brow: 1.0,
            blush: Blush::default(),
        }
    }
}

/// Middle of the eyes.
const EYE: Vec2 = Vec2::new(0.0358, EYE_HEIGHT - 0.0025);

/// An eye's lines, in millimetres around its middle, its outer corner at positive x.
struct Cut {
    /// The upper lid from the inner corner, over its height, to the outer corner.
    upper: [[f32; 2]; 5],
    /// The lower lid, between the corners.
    lower: [[f32; 2]; 3],
    /// Middle and half axes of the iris.
    iris: [f32; 4],
    /// Width of the lashes at the upper lid's points.
    lashes: [f32; 5],
    /// The point in which the lashes end, past the outer corner.
    flick: [f32; 2],
    /// The brow: points, and widths there.
    brow: [([f32; 2], f32); 4],
}

impl Eyes {
    fn cut(self) -> Cut {
        match self {
            Self::Round => Cut {
                upper: [
                    [-18.5, -5.0],
                    [-13.5, 9.0],
                    [-1.0, 16.0],
                    [13.0, 12.5],
                    [19.5, 1.5],
                ],
                lower: [[15.5, -11.5], [2.0, -17.0], [-12.0, -14.5]],
                iris: [0.2, -0.8, 13.4, 17.0],
                lashes: [0.5, 2.7, 4.7, 6.2, 5.4],
                flick: [25.0, 2.8],
                brow: [
                    ([-21.0, 28.0], 1.6),
                    ([-9.0, 32.5], 2.9),
                    ([6.0, 32.0], 2.1),
                    ([21.0, 25.0], 0.1),
                ],
            },
            Self::Almond => Cut {
                upper: [
                    [-20.0, -6.5],
                    [-12.5, 5.5],
                    [-1.0, 12.0],
                    [12.5, 10.5],
                    [21.0, 3.0],
                ],
                lower: [[15.5, -8.5], [2.0, -13.5], [-12.0, -12.0]],
                iris: [0.5, -0.8, 11.4, 14.6],
                lashes: [0.4, 2.3, 4.2, 5.7, 4.8],
                flick: [27.0, 6.2],
                brow: [
                    ([-21.0, 24.0], 1.4),
                    ([-8.0, 28.5], 2.9),
                    ([8.0, 29.5], 2.1),
                    ([23.0, 24.5], 0.1),
                ],
            },
            Self::Sharp => Cut {
                upper: [
                    [-20.5, -8.0],
                    [-12.0, 2.5],
                    [-1.0, 8.5],
                    [12.0, 10.0],
                    [21.5, 6.5],
                ],
                lower: [[16.5, -4.5], [3.0, -10.5], [-11.0, -11.2]],
                iris: [1.2, -0.4, 9.6, 12.2],
                lashes: [0.5, 2.7, 4.3, 5.4, 4.4],
                flick: [28.0, 11.0],
                brow: [
                    ([-21.5, 15.0], 2.0),
                    ([-8.0, 20.5], 3.4),
                    ([8.0, 25.5], 2.6),
                    ([25.0, 25.0], 0.1),
                ],
            },
            Self::Sleepy => Cut {
                upper: [
                    [-19.0, -4.5],
                    [-12.5, 4.0],
                    [-1.0, 7.6],
                    [12.0, 4.6],
                    [20.0, -4.0],
                ],
                lower: [[15.0, -12.8], [2.0, -17.0], [-12.0, -14.0]],
                iris: [0.2, -3.0, 12.0, 15.0],
                lashes: [0.5, 2.7, 4.4, 5.6, 4.6],
                flick: [25.0, -4.6],
                brow: [
                    ([-20.0, 29.0], 1.2),
                    ([-8.0, 31.5], 2.4),
                    ([7.0, 29.5], 1.8),
                    ([21.0, 22.0], 0.1),
                ],
            },
        }
    }
}

/// Where an eye's shapes go: its size, and whether it will be mirrored.
struct Eye<'a> {
    patches: &'a mut dyn FnMut(Ink, Flat, f32),
    size: f32,
    side: f32,
}

impl Eye<'_> {
    /// A point, from millimetres around the eye's middle.
    fn at(&self, [x, y]: [f32; 2]) -> Vec2 {
        EYE + Vec2::new(x, y) * (1e-3 * self.size)
    }

    fn add(&mut self, ink: Ink, flat: Flat, layer: f32) {
        (self.patches)(ink, mirrored(flat, self.side), layer);
    }

    /// A stroke through points in millimetres, with its width at each.
    fn stroke(&mut self, points: &[([f32; 2], f32)], layer: f32) {
        let points: Vec<(Vec2, f32)> = points
            .iter()
            .map(|(p, width)| (self.at(*p), width * 1e-3 * self.size))
            .collect();
        self.add(Ink::Line, stroke(&points), layer);
    }

    fn open(&mut self, cut: &Cut, smile: f32, highlights: u32) {
        let raised = |[x, y]: [f32; 2]| [x, y + smile];
        let upper = curve(&cut.upper.map(|p| self.at(p)));
        let [outer, lowest, inner] = cut.lower.map(raised);
        let lower = curve(&[cut.upper[4], outer, lowest, inner, cut.upper[0]].map(|p| self.at(p)));
        let outline: Vec<Vec2> = upper
            .iter()
            .chain(&lower[1..lower.len() - 1])
            .copied()
            .collect();
        let middle = self.at([0.0, 0.5 * (cut.upper[2][1] + lowest[1])]);
        self.add(Ink::White, fill(middle, &outline), 0.0);
        let inside = |points: Vec<Vec2>| -> Vec<Vec2> {
            let kept = points.into_iter();
            kept.map(|p| keep_inside(p, middle, &outline)).collect()
        };
        // The lids shade the white.
        let lowered = inside(
            upper
                .iter()
                .map(|p| *p - Vec2::Y * 4.2e-3 * self.size)
                .collect(),
        );
        let band: Vec<Vec2> = upper.iter().chain(lowered.iter().rev()).copied().collect();
        self.add(Ink::WhiteShadow, strip(&band), 0.4);

        let [x, y, half_x, half_y] = cut.iris;
        let center = self.at([x, y]);
        let half_axes = Vec2::new(half_x, half_y) * (1e-3 * self.size);
        let scaled = |share: f32| inside(ellipse(center, half_axes * share));
        let from = center.lerp(middle, 0.5);
        self.add(Ink::IrisShadow, fill(from, &scaled(1.0)), 1.0);
        self.add(Ink::Iris, fill(from, &scaled(0.90)), 1.7);
        // Light falls through to the lower part, in a crescent; the lid's shadow ends in an arc.
        let across = |p: &Vec2| (p.x - center.x) / half_axes.x;
        let crescent = |p: &Vec2| {
            let top = center.y - half_axes.y * (0.56 - 0.30 * across(p) * across(p));
            p.with_y(p.y.min(top))
        };
        let light: Vec<Vec2> = scaled(0.80).iter().map(crescent).collect();
        let low = center - Vec2::Y * half_axes.y * 0.62;
        self.add(Ink::IrisLight, fill(low, &light), 2.4);
        let shaded = |p: &Vec2| {
            let bottom = center.y + half_axes.y * (0.30 - 0.30 * across(p) * across(p));
            p.with_y(p.y.max(bottom))
        };
        let shadow: Vec<Vec2> = scaled(0.92).iter().map(shaded).collect();
        let high = center + Vec2::Y * half_axes.y * 0.45;
        self.add(
            Ink::IrisShadow,
            fill(keep_inside(high, middle, &outline), &shadow),
            2.4,
        );
        let pupil = inside(ellipse(center, half_axes * Vec2::new(0.44, 0.50)));
        self.add(Ink::IrisShadow, fill(from, &pupil), 2.5);
        // Lights are where the light is, in both eyes on the same side.
        let lights = [
            ([0.40, 0.40], [0.25, 0.27]),
            ([-0.36, -0.46], [0.13, 0.14]),
            ([-0.42, 0.20], [0.09, 0.09]),
        ];
        for (place, axes) in lights.iter().take(highlights as usize) {
            let place = Vec2::from(*place) * Vec2::new(self.side, 1.0);
            let spot = keep_inside(center + place * half_axes, middle, &outline);
            let axes = Vec2::from(*axes) * half_axes;
            let round = inside(ellipse(spot, axes));
            self.add(Ink::White, fill(spot, &round), 3.4);
        }
        self.lids(cut, smile);
    }

    /// Lashes, a wedge that grows to the outer corner and ends past it, with points over it; a thin
    /// lower lid; the lid's fold.
    fn lids(&mut self, cut: &Cut, smile: f32) {
        self.lashes(&cut.upper, &cut.lashes, cut.flick, 1.0);
        let [x, y] = cut.upper[4];
        let [outer, lowest, _] = cut.lower.map(|[x, y]| [x, y + smile]);
        self.stroke(
            &[
                ([x + 0.2, y - 1.0], 2.2),
                ([outer[0] + 0.3, outer[1] - 0.2], 1.4),
                ([lowest[0] + 2.0, lowest[1] - 0.2], 0.2),
            ],
            4.4,
        );
        let fold = [
            ([cut.upper[1][0] + 1.0, cut.upper[1][1] + 7.5], 0.1),
            ([cut.upper[2][0] + 1.5, cut.upper[2][1] + 8.6], 1.1),
            ([cut.upper[3][0] + 3.5, cut.upper[3][1] + 7.2], 0.1),
        ];
        self.stroke(&fold, 1.0);
    }

    /// A wedge on a lid, from its inner end to the flick, with two more points over it.
    fn lashes(&mut self, lid: &[[f32; 2]; 5], widths: &[f32; 5], flick: [f32; 2], up: f32) {
        // The stroke's lower edge lies on the lid.
        let mut wedge: Vec<([f32; 2], f32)> = lid
            .iter()
            .zip(widths)
            .map(|([x, y], width)| ([*x + 0.06 * x, y + 0.36 * up * width], *width))
            .collect();
        wedge[0].1 = 0.2;
        wedge.push((flick, 0.1));
        self.stroke(&wedge, 4.4);
        let [corner, before] = [lid[4], lid[3]];
        let toward = Vec2::from(flick) - Vec2::from(corner);
        for (start, width, reach, rise) in [(0.25, 2.6, 0.95, 4.6), (0.75, 2.2, 0.72, 7.6)] {
            let from = Vec2::from(corner).lerp(Vec2::from(before), start) + Vec2::Y * up * 1.6;
            let tip = from + toward * reach + Vec2::new(1.6, rise * up * 0.75);
            let bend = from.lerp(tip, 0.5) - Vec2::Y * up * 0.8;
            self.stroke(
                &[
                    (from.into(), width),
                    (bend.into(), width * 0.6),
                    (tip.into(), 0.1),
                ],
                4.4,
            );
        }
    }

    /// A closed eye: one heavy line, its middle low, or high where it laughs.
    fn closed(&mut self, cut: &Cut, laughs: bool) {
        let low = 0.5 * cut.lower[1][1] - 2.0;
        let bow = if laughs { 8.5 } else { -6.0 };
        let lid = [-19.0_f32, -11.0, 0.0, 11.0, 19.5].map(|x| {
            let t = x / 19.5;
            [x, low + bow * (0.5 - t * t) + 0.8 * t]
        });
        let flick = if laughs {
            [23.5, lid[4][1] - 3.4]
        } else {
            [25.0, lid[4][1] + 1.5]
        };
        let up = if laughs { 1.0 } else { -1.0 };
        self.lashes(&lid, &[0.6, 2.0, 3.0, 3.6, 3.0], flick, up);
        if !laughs {
            let fold = [
                ([-11.0, low + 9.0], 0.1),
                ([1.0, low + 10.5], 0.9),
                ([13.0, low + 10.0], 0.1),
            ];
            self.stroke(&fold, 1.0);
        }
    }
}

/// The inside of an outline whose first half runs beside its second half, back.
fn strip(outline: &[Vec2]) -> Flat {
    let half = outline.len() / 2;
    let mut flat = Flat {
        points: outline.to_vec(),
        triangles: Vec::new(),
    };
    for i in 0..half - 1 {
        let (a, b) = (i as u32, i as u32 + 1);
        let (c, d) = (
            (outline.len() - 1 - i) as u32,
            (outline.len() - 2 - i) as u32,
        );
        flat.triangles.extend([[a, b, c], [b, d, c]]);
    }
    flat
}

/// All patches of a face on a skin, lowest first; collarbones too where the body `is_bare`.
pub(crate) fn patches(face: &Face, skin: &impl Fn(Vec3) -> f32, is_bare: bool) -> Vec<Patch> {
    let mut patches = Vec::new();
    for side in [1.0, -1.0] {
        patches.push(nose_side(skin, side));
        let lay = |ink, flat: Flat, layer| FRONT.lay_on(skin, ink, &flat, layer);
        let first = patches.len();
        eye(
            face,
            &mut |ink, flat, layer| patches.push(lay(ink, flat, layer)),
            side,
        );
        mark(&mut patches, first, FacePart::Eyes);
        patches.extend(brow(face).map(|flat| Patch {
            part: FacePart::Brows,
            ..lay(Ink::Line, mirrored(flat, side), 1.0)
        }));
        patches.extend(blush(face.blush).into_iter().map(|flat| Patch {
            part: FacePart::Blush,
            ..lay(Ink::Blush, mirrored(flat, side), 0.0)
        }));
        if is_bare {
            let lines = [collarbone(), neck()].map(|line| mirrored(line, side));
            patches.extend(lines.map(|line| lay(Ink::Line, line, 1.0)));
        }
        // The right ear is drawn in a mirror, so that its sheet too faces outwards.
        let ear = Sheet {
            origin: EAR * Vec3::new(side, 1.0, 1.0),
            right: EAR_BACK * Vec3::new(1.0, side, side),
            up: EAR_UP * Vec3::new(side, 1.0, 1.0),
        };
        for line in ear_lines() {
            patches.push(ear.lay_on(skin, Ink::Line, &mirrored(line, side), 1.0));
        }
    }
    patches.push(under_lip(skin));
    let first = patches.len();
    for (ink, flat, layer) in mouth(face.expression) {
        patches.push(FRONT.lay_on(skin, ink, &flat, layer));
    }
    mark(&mut patches, first, FacePart::Mouth);
    patches.push(FRONT.lay_on(skin, Ink::Line, &nose(), 1.0));
    patches
}

fn eye(face: &Face, patches: &mut dyn FnMut(Ink, Flat, f32), side: f32) {
    let cut = face.eyes.cut();
    let mut eye = Eye {
        patches,
        size: face.eye_size,
        side,
    };
    match face.expression {
        Expression::Neutral => eye.open(&cut, 0.0, face.highlights),
        Expression::Smile => eye.open(&cut, 2.6, face.highlights),
        Expression::Laugh => eye.closed(&cut, true),
        Expression::Closed => eye.closed(&cut, false),
    }
}

/// One brow, drawn for the viewer's right, if there are any.
fn brow(face: &Face) -> Option<Flat> {
    let raised = match face.expression {
        Expression::Neutral | Expression::Closed => 0.0,
        Expression::Smile => 1.5,
        Expression::Laugh => 3.0,
    };
    let brow = face.eyes.cut().brow.map(|([x, y], width)| {
        let at = EYE + Vec2::new(x, y + raised) * 1e-3;
        (at, width * face.brow * 1e-3)
    });
    (face.brow > 0.0).then(|| stroke(&brow))
}

fn blush(blush: Blush) -> Vec<Flat> {
    let middle = Vec2::new(0.0455, EYE_HEIGHT - 0.0315);
    match blush {
        Blush::None => Vec::new(),
        Blush::Flat => {
            let outline = ellipse(middle, Vec2::new(0.0125, 0.0052));
            vec![fill(middle, &outline)]
        }
        Blush::Hatch => [-8.0, -2.7, 2.7, 8.0]
            .map(|x: f32| {
                let tall = 4.6 - 0.02 * x * x;
                let slant = Vec2::new(1.9, tall) * 1e-3;
                let foot = middle + Vec2::X * x * 1e-3;
                stroke(&[
                    (foot - slant, 0.2e-3),
                    (foot, 1.3e-3),
                    (foot + slant, 0.2e-3),
                ])
            })
            .into(),
    }
}

/// The side of the nose that is away from the light.
fn nose_side(skin: &impl Fn(Vec3) -> f32, side: f32) -> Patch {
    let outline = [
        [2.6, -15.0],
        [1.6, -27.0],
        [0.6, -37.5],
        [3.2, -43.2],
        [9.2, -44.6],
        [8.2, -39.5],
        [6.4, -31.0],
    ]
    .map(|[x, y]: [f32; 2]| Vec2::new(x * side, EYE_HEIGHT * 1e3 + y) * 1e-3);
    let flat = fill(
        Vec2::new(4.6 * side, EYE_HEIGHT * 1e3 - 36.0) * 1e-3,
        &outline,
    );
    Patch {
        away_from: Some(Vec3::new(0.80 * side, -0.10, 0.5916)),
        ..FRONT.lay_on(skin, Ink::SkinShadow, &flat, 1.0)
    }
}

/// Under the lower lip, where light comes from above.
fn under_lip(skin: &impl Fn(Vec3) -> f32) -> Patch {
    let outline = curve(
        &[
            [-7.0, -80.0],
            [0.0, -79.0],
            [7.0, -80.0],
            [0.0, -83.4],
            [-7.0, -80.0],
        ]
        .map(|[x, y]: [f32; 2]| Vec2::new(x, EYE_HEIGHT * 1e3 + y) * 1e-3),
    );
    let flat = fill(
        Vec2::new(0.0, EYE_HEIGHT - 0.0808),
        &outline[..outline.len() - 1],
    );
    Patch {
        away_from: Some(Vec3::new(0.0, -0.6, 0.8)),
        ..FRONT.lay_on(skin, Ink::SkinShadow, &flat, 1.0)
    }
}

/// A small mark under the tip.
fn nose() -> Flat {
    line(
        1.4505,
        &[([2.2, -0.6], 0.2), ([-0.6, -2.2], 1.3), ([-3.0, -1.2], 0.2)],
    )
}

fn mouth(expression: Expression) -> Vec<(Ink, Flat, f32)> {
    let lips = |points: &[([f32; 2], f32)]| (Ink::Line, line(1.4235, points), 4.4);
    let lower_lip = (
        Ink::Line,
        line(
            1.412,
            &[([-3.8, 0.5], 0.1), ([0.0, -0.3], 0.9), ([3.8, 0.5], 0.1)],
        ),
        1.4,
    );
    match expression {
        Expression::Neutral | Expression::Closed => vec![
            lips(&[
                ([-12.5, 1.6], 0.2),
                ([-10.5, 0.7], 1.5),
                ([-5.0, -0.5], 0.9),
                ([0.0, 0.0], 1.0),
                ([5.0, -0.5], 0.9),
                ([10.5, 0.7], 1.5),
                ([12.5, 1.6], 0.2),
            ]),
            lower_lip,
        ],
        Expression::Smile => vec![
            lips(&[
                ([-16.5, 5.0], 0.2),
                ([-14.0, 3.0], 1.7),
                ([-7.0, -0.8], 1.0),
                ([0.0, -1.6], 1.1),
                ([7.0, -0.8], 1.0),
                ([14.0, 3.0], 1.7),
                ([16.5, 5.0], 0.2),
            ]),
            lower_lip,
        ],
        Expression::Laugh => {
            let at = |[x, y]: [f32; 2]| Vec2::new(x * 1e-3, 1.4235 + y * 1e-3);
            let top = curve(
                &[
                    [-14.0, 4.0],
                    [-7.0, 2.6],
                    [0.0, 2.8],
                    [7.0, 2.6],
                    [14.0, 4.0],
                ]
                .map(at),
            );
            let bottom = curve(
                &[
                    [14.0, 4.0],
                    [10.5, -5.0],
                    [0.0, -10.5],
                    [-10.5, -5.0],
                    [-14.0, 4.0],
                ]
                .map(at),
            );
            let inside: Vec<Vec2> = top
                .iter()
                .chain(&bottom[1..bottom.len() - 1])
                .copied()
                .collect();
            vec![
                (Ink::Mouth, fill(at([0.0, -2.0]), &inside), 3.4),
                lips(&[
                    ([-15.6, 5.0], 0.3),
                    ([-13.0, 3.7], 1.6),
                    ([0.0, 2.8], 1.1),
                    ([13.0, 3.7], 1.6),
                    ([15.6, 5.0], 0.3),
                ]),
                lips(&[
                    ([13.6, 3.4], 0.3),
                    ([10.5, -5.2], 0.9),
                    ([0.0, -10.8], 1.3),
                    ([-10.5, -5.2], 0.9),
                    ([-13.6, 3.4], 0.3),
                ]),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::body;
    use super::*;

    const EYES: [Eyes; 4] = [Eyes::Round, Eyes::Almond, Eyes::Sharp, Eyes::Sleepy];
    const EXPRESSIONS: [Expression; 4] = [
        Expression::Neutral,
        Expression::Smile,
        Expression::Laugh,
        Expression::Closed,
    ];

    /// Every face there is.
    fn faces() -> impl Iterator<Item = Face> {
        EYES.into_iter().flat_map(|eyes| {
            EXPRESSIONS.into_iter().flat_map(move |expression| {
                [(0.7, Blush::None), (1.2, Blush::Flat), (1.0, Blush::Hatch)].map(
                    |(eye_size, blush)| Face {
                        eyes,
                        eye_size,
                        highlights: 3,
                        expression,
                        brow: 1.0,
                        blush,
                    },
                )
            })
        })
    }

    fn skin(p: Vec3) -> f32 {
        body::skin(p, 1.0)
    }

    #[test]
    fn every_patch_lies_on_the_skin() {
        for face in faces() {
            for patch in patches(&face, &skin, true) {
                for p in &patch.positions {
                    let gap = skin(*p);
                    assert!(
                        (0.0..0.0012).contains(&gap),
                        "{face:?}, {:?} at {p}: {gap}",
                        patch.ink
                    );
                }
            }
        }
    }

    #[test]
    fn closed_eyes_show_no_white_and_open_ones_do() {
        for face in faces() {
            let patches = patches(&face, &skin, false);
            let has = |ink| patches.iter().any(|patch| patch.ink == ink);
            let is_open = matches!(face.expression, Expression::Neutral | Expression::Smile);
            assert_eq!(has(Ink::White), is_open, "{face:?}");
            assert_eq!(has(Ink::Iris), is_open, "{face:?}");
            assert_eq!(has(Ink::Mouth), face.expression == Expression::Laugh);
            assert_eq!(has(Ink::Blush), face.blush != Blush::None);
        }
    }

    #[test]
    fn irises_stay_within_their_eyes() {
        for face in faces().filter(|face| face.expression == Expression::Neutral) {
            let patches = patches(&face, &skin, false);
            let reach = |ink| {
                let own = patches.iter().filter(|patch| patch.ink == ink);
                let points = own.flat_map(|patch| &patch.positions).filter(|p| p.x > 0.0);
                points.fold((Vec3::MAX, Vec3::MIN), |(low, high), p| {
                    (low.min(*p), high.max(*p))
                })
            };
            let (white_low, white_high) = reach(Ink::White);
            for ink in [Ink::Iris, Ink::IrisShadow, Ink::IrisLight, Ink::WhiteShadow] {
                let (low, high) = reach(ink);
                let slack = Vec3::new(1e-4, 1e-4, 1.0);
                assert!(
                    low.cmpge(white_low - slack).all() && high.cmple(white_high + slack).all(),
                    "{face:?} {ink:?}"
                );
            }
        }
    }
}
