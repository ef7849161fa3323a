//! Strands in a lock.

use super::Lock;
use super::section::Section;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// A strand's half width is this factor times half of how far strands beside each other are apart, so that they overlap.
const OVERLAP: f64 = 1.2;
/// A lock so much wider than a strand may be is still one.
const STILL_ONE: f64 = 1.3;
/// The most strands of a lock: where more are asked for they are wider.
const MOST: f64 = 64.0;

/// A strand that lies in a lock.
#[derive(Clone, Debug, PartialEq)]
pub struct LockStrand {
    /// From root to tip, in metres: two or more, finite.
    pub points: Vec<Vec3>,
    /// Half of its width at each point, in metres.
    pub half_widths: Vec<f32>,
}

impl Lock {
    /// Its middle, from root to tip, in metres.
    pub fn middle(&self) -> impl Iterator<Item = Vec3> {
        self.sections.iter().map(|section| section.middle.as_vec3())
    }

    /// Half of its width at each point of its middle, in metres.
    pub fn half_widths(&self) -> impl Iterator<Item = f32> {
        self.sections
            .iter()
            .map(|section| section.half_width as f32)
    }

    /// The strands that fill it, none of which has a half width of much more than `widest_m` metres.
    #[must_use]
    pub fn strands(&self, widest_m: f32) -> Vec<LockStrand> {
        let widest = f64::from(widest_m);
        let most = |of: fn(&Section) -> f64| self.sections.iter().map(of).fold(0.0, f64::max);
        let half_width = most(|section| section.half_width);
        let half_thickness = most(|section| section.half_thickness);
        if half_width <= STILL_ONE * widest {
            // A narrow one needs no root that is hidden: it begins at the rim.
            let shown = &self.sections[usize::from(!self.is_whole)..];
            return vec![strand_of(
                shown.iter().map(|own| (own.middle, own.half_width)),
            )];
        }
        if half_thickness <= widest {
            let count = (half_width / widest).ceil().min(MOST) as usize;
            return (0..count).map(|which| self.beside(which, count)).collect();
        }
        // Those of a ring touch where the lock is thickest.
        let around = PI * (half_width + half_thickness - 2.0 * widest);
        let wanted = (OVERLAP * around / (2.0 * widest)).ceil();
        let count = wanted.clamp(3.0, MOST) as usize;
        let widest = if wanted > MOST {
            // The same equation, solved for the width.
            0.5 * OVERLAP * PI * (half_width + half_thickness) / (MOST + OVERLAP * PI)
        } else {
            widest
        };
        (0..count)
            .map(|which| self.around(which, count, widest))
            .collect()
    }

    /// One of some side by side, on the middle of the outline there.
    fn beside(&self, which: usize, count: usize) -> LockStrand {
        let share = (2 * which + 1) as f64 / count as f64 - 1.0;
        self.strand(|section| {
            let own = section.half_width / count as f64;
            let x = share * section.half_width;
            let near = section
                .outline
                .iter()
                .filter(|[at, ..]| (at - x).abs() <= own);
            let (mut sum, mut weights) = (0.0, 0.0);
            for [_, y, weight] in near {
                sum += y * weight;
                weights += weight;
            }
            let y = if weights > 0.0 { sum / weights } else { 0.0 };
            (
                section.middle + section.across * x + section.out * y,
                OVERLAP * own,
            )
        })
    }

    /// One of a ring under the surface, which its discs touch from inside.
    fn around(&self, which: usize, count: usize, widest: f64) -> LockStrand {
        let (sin, cos) = portable_math::sin_cos_degrees(360.0 * which as f64 / count as f64);
        let half = |section: &Section| 0.5 * (section.half_width + section.half_thickness);
        let last = self.sections.len() - 1;
        let placed = self.sections.iter().enumerate().map(|(index, section)| {
            let before = &self.sections[index.saturating_sub(1)];
            let after = &self.sections[(index + 1).min(last)];
            // How steeply the surface stands on the line: its slope, and the parts of its normal across and along.
            let run = (after.along - before.along).max(f64::MIN_POSITIVE);
            let slope = (half(after) - half(before)) / run;
            let straight = 1.0 / (1.0 + slope * slope).sqrt();
            let own = widest.min(section.half_thickness);
            let x = cos * (section.half_width - own * straight).max(0.0);
            let y = sin * (section.half_thickness - own * straight).max(0.0);
            let way = section.across.cross(section.out);
            let inwards = way * (own * slope * straight);
            (
                section.middle + section.across * x + section.out * y + inwards,
                own,
            )
        });
        strand_of(placed)
    }

    fn strand(&self, place: impl Fn(&Section) -> (DVec3, f64)) -> LockStrand {
        strand_of(self.sections.iter().map(place))
    }
}

/// A strand of these places and half widths.
fn strand_of(placed: impl Iterator<Item = (DVec3, f64)>) -> LockStrand {
    let (points, half_widths) = placed.map(|(at, half)| (at.as_vec3(), half as f32)).unzip();
    LockStrand {
        points,
        half_widths,
    }
}
