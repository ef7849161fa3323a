//! How far strokes reach around their clumps, and what lies before them: on which sides of the picture they may lie, and whether behind a head.

use super::super::cover::Swath;
use super::super::tile::lesser;
use super::shadow::Shadow;
use super::{View, is_within};
use crate::drawing::Brush;
use crate::frame::{CLUMP_REACH, Frame, Object, reach_of};
use effects::{Joints, Layer, Reach};
use std::ops::Range;

/// A pixel more than the picture makes up for rounding.
const MARGIN_PX: f32 = 1.0;
/// The same against what hair covers, which is thinner there than it is.
pub(super) const COVER_MARGIN_PX: f32 = 0.125;

/// Sides on which a disc lies wholly: beyond an edge of the picture, or behind a head. What is between two discs of one side, as all
/// discs of a segment are, is there too, since each is convex.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const ABOVE: u8 = 4;
const BELOW: u8 = 8;
pub(super) const HIDDEN: u8 = 16;
/// Not a side: it lies beyond the middle of the head's ball, and so is seen nowhere before it.
pub(super) const DEEP: u8 = 32;

/// What strokes on some joints take of the screen around their clumps, and what hides them.
pub(super) struct Room {
    /// The joints of an object's hair, or of paths that an effect made, up to the next room's.
    pub(super) joints: Range<usize>,
    reach: RoomAround,
    /// The same of strokes that show within their clump alone, and aren't it.
    within: RoomAround,
    /// How far strokes of which no more is known reach beyond their clump.
    beyond: Vec<Beyond>,
    unit_m: f32,
    /// How much nearer than their clumps strokes may lie among strands, metres.
    nearer_m: f32,
    /// How much nearer than they are decals may be drawn, metres.
    decals_m: f32,
    shadow: Option<Shadow>,
}

/// How far strokes reach from their clumps' middles.
#[derive(Clone, Copy)]
struct RoomAround {
    /// In radii of the clump, and in 1/300 of the head's height.
    clumps: f32,
    units: f32,
    pixels_px: f32,
}

const NOTHING_AROUND: RoomAround = RoomAround {
    clumps: 0.0,
    units: 0.0,
    pixels_px: 0.0,
};

impl RoomAround {
    fn add(&mut self, frame: &Frame, layer: &Layer) {
        let reach = reach_of(layer, frame.brush);
        self.clumps = self.clumps.max(reach.clumps);
        if layer.is_in_pixels() {
            let pixels_px = reach.units * frame.camera.size_px()[1] as f32 / 720.0;
            self.pixels_px = self.pixels_px.max(pixels_px);
        } else {
            self.units = self.units.max(reach.units);
        }
    }
}

/// The lesser of both: a part of the clump's radius, and a width in 1/300 of the head's height and in pixels.
struct Beyond {
    clumps: f32,
    units: f32,
    pixels_px: f32,
}

impl Beyond {
    /// That of a layer's strokes, where it says it.
    fn of(frame: &Frame, layer: &Layer) -> Option<Self> {
        let Reach { clumps, units } = layer.program.beyond()?;
        // Tips of half discs are moved on by what they are wider.
        let times = match frame.brush {
            Brush::Circle => 1.0,
            Brush::Semicircle => 2.0,
        };
        let (units, pixels) = match layer.is_in_pixels() {
            true => (0.0, units),
            false => (units, 0.0),
        };
        Some(Self {
            clumps: times * clumps,
            units: times * units,
            pixels_px: times * pixels * frame.camera.size_px()[1] as f32 / 720.0,
        })
    }

    /// Pixels, of a clump of this radius where a unit is so large.
    fn px(&self, radius: f32, unit_px: f32) -> f32 {
        let width_px = self.units * unit_px + self.pixels_px;
        lesser(self.clumps * radius * unit_px, width_px)
    }
}

impl Room {
    /// Those of an object, by rising joints.
    pub(super) fn all_of(frame: &Frame, object: &Object) -> Vec<Self> {
        let layers = || object.layers.iter().zip(object.layer_joints);
        let mut made: Vec<&Range<usize>> = layers()
            .filter(|(layer, _)| layer.program.has_own_paths())
            .map(|(_, joints)| joints)
            .collect();
        made.sort_by_key(|joints| joints.start);
        let mut ends: Vec<usize> = made.iter().flat_map(|own| [own.start, own.end]).collect();
        ends.push(object.joints.end);
        let mut start = object.joints.start;
        let mut rooms = Vec::with_capacity(ends.len());
        for end in ends {
            let joints = start..end.max(start);
            start = joints.end;
            if joints.is_empty() {
                continue;
            }
            let own =
                layers().filter(|(_, drawn)| drawn.start < joints.end && joints.start < drawn.end);
            let own = own.map(|(layer, _)| layer);
            rooms.push(Self::of(frame, object, joints.clone(), own));
        }
        rooms
    }

    fn of<'a>(
        frame: &Frame,
        object: &Object,
        joints: Range<usize>,
        layers: impl Iterator<Item = &'a Layer>,
    ) -> Self {
        let clump = RoomAround {
            clumps: CLUMP_REACH.clumps,
            units: CLUMP_REACH.units,
            pixels_px: 0.0,
        };
        let (mut reach, mut within, mut beyond) = (NOTHING_AROUND, clump, Vec::new());
        let (mut nearer, mut decals) = (0.0_f32, 0.0_f32);
        for layer in layers {
            if layer.is_decal() {
                // Of their own depth, which may be moved as far as their place is.
                let moved = layer.program.reach().units / 300.0 + (-layer.depth_offset).max(0.0);
                decals = decals.max(layer.reach + moved);
            }
            if is_within(frame.order, layer) {
                within.add(frame, layer);
                continue;
            }
            nearer = nearer.max(match layer.program.may_be_nearer() {
                true => f32::INFINITY,
                false => -layer.depth_offset,
            });
            match Beyond::of(frame, layer).filter(|_| !layer.is_decal()) {
                Some(own) => beyond.push(own),
                None => reach.add(frame, layer),
            }
        }
        Self {
            joints,
            reach,
            within,
            beyond,
            unit_m: object.head.unit_m(),
            nearer_m: nearer * object.head.height_m,
            decals_m: decals * object.head.height_m,
            shadow: object.solid.and_then(|ball| Shadow::new(frame, ball)),
        }
    }

    pub(super) fn reach_px(&self, View { frame, joints, .. }: &View, i: usize) -> ReachPx {
        let unit_px = self.unit_m * frame.paths.px_per_metre[i];
        let (radius, shift) = (joints.clump_radius[i], joints.clump_shift[i].length().0);
        let reach = |around: &RoomAround| {
            (shift + around.clumps * radius + around.units) * unit_px + around.pixels_px
        };
        // Where a clump is hardly flat it is one disc, of its radius and as far off as it is shifted.
        let clumps = match shift < 0.19 * radius {
            true => 1.0,
            false => CLUMP_REACH.clumps,
        };
        let clump_px = (shift + clumps * radius) * unit_px;
        let beyond = self.beyond.iter().map(|beyond| beyond.px(radius, unit_px));
        ReachPx {
            all: reach(&self.reach).max(clump_px + beyond.fold(0.0, f32::max)),
            within: reach(&self.within),
            clump: clump_px,
        }
    }

    /// The sides on which all discs of joint `i` lie, which reach so far. Behind a head that is asked of those alone that show beyond their clump: by how much others may be wider, far more would count as seen.
    pub(super) fn sides(&self, frame: &Frame, joints: &Joints, i: usize, reach: &ReachPx) -> u8 {
        let paths = frame.paths;
        let shown_px = reach.all + MARGIN_PX;
        let reach_px = reach.farthest() + MARGIN_PX;
        let (center, size) = (
            paths.center[i],
            frame.camera.size_px().map(|side| side as f32),
        );
        let side = |is_there: bool, side: u8| if is_there { side } else { 0 };
        let nearest_m = paths.depth[i] - joints.clump_radius[i] * self.unit_m - self.decals_m;
        let is_hidden = |shadow: &Shadow| shadow.holds(center, shown_px, nearest_m);
        let is_deep = |shadow: &Shadow| shadow.is_deep(center, shown_px, nearest_m);
        side(center.x < -reach_px, LEFT)
            | side(center.x > size[0] + reach_px, RIGHT)
            | side(center.y < -reach_px, ABOVE)
            | side(center.y > size[1] + reach_px, BELOW)
            | side(self.shadow.as_ref().is_some_and(is_hidden), HIDDEN)
            | side(self.shadow.as_ref().is_some_and(is_deep), DEEP)
    }

    /// What all strokes between two joints may reach that reach so far, px.
    pub(super) fn swath(&self, view: &View, ends: [usize; 2], reach_px: [f32; 2]) -> Swath {
        let centers = ends.map(|i| view.frame.paths.center[i]);
        let reach_px = reach_px[0].max(reach_px[1]) + COVER_MARGIN_PX;
        Swath::new(centers, reach_px, self.nearness(view, ends))
    }

    /// No disc at two neighbouring joints is nearer, 1/m, and none between them than what runs linearly.
    fn nearness(&self, View { frame, clumps, .. }: &View, ends: [usize; 2]) -> [f32; 2] {
        let nearness = ends.map(|i| clumps[i].inv_depth.max(clumps[i].inv_depth_biased));
        if self.nearer_m <= 0.0 {
            return nearness;
        }
        let nearest_m = nearness.map(|nearness| 1.0 / nearness - self.nearer_m);
        let near_m = frame.camera.near_m();
        // It bulges towards the linear one, but for what is cut off.
        match nearest_m.iter().all(|depth_m| *depth_m >= near_m) {
            true => nearest_m.map(|depth_m| 1.0 / depth_m),
            false => [1.0 / nearest_m[0].min(nearest_m[1]).max(near_m); 2],
        }
    }
}

/// How far discs of a joint reach from its place on the screen, pixels.
pub(super) struct ReachPx {
    pub(super) all: f32,
    /// Those of strokes that show within their clump alone.
    pub(super) within: f32,
    /// The clump's.
    pub(super) clump: f32,
}

impl ReachPx {
    /// How far any reach.
    pub(super) fn farthest(&self) -> f32 {
        self.all.max(self.within)
    }
}
