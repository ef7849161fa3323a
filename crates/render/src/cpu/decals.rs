//! Decals of a tile ([`Decal`]): strokes that are drawn on what is seen without them. Once all else is there, each sample keeps the highest one
//! that fits it; no decal hides another's way, so that they come in any order and none pops.

use super::bin::{Lists, cells as cells_across};
use super::brush::StrokeBrush;
use super::context::TileContext;
use super::segment::{Kind, Reach, Segment, Segments, Stroke, strokes_in_order};
use super::shown::{NOTHING as SHOWS_NOTHING, Shown, TRIANGLE};
use super::stroke::{NEARER, Placed, across};
use super::tile::{
    Aligned, CELLS, CELLS_ACROSS, Cell, IdPlane, LANES, LaneMask, Lanes, Mask, NO_SAMPLES, NOTHING,
    OneByOne, Plane, ROWS, Stack, StoreMask, Target, WIDTH, add, any, bits, both, cells, columns,
    columns_of_cells, id_plane, is_empty, least, lesser, plane, select, without,
};
use super::{Frame, Worker};
use crate::drawing::{Decal, Drawing, LayerStrokes, Order, shown_reach};
use std::cmp::Reverse;

/// What a surface in the shadow of hair is told as how much it lies in shadow: whatever the light, and wherever it turns to shade.
const IN_SHADOW: f32 = 3.0;

/// A drawing's decals taken apart. Empty where there are none.
#[derive(Default)]
pub(super) struct DecalParts {
    strokes: Vec<Stroke>,
    segments: Segments,
    /// Whether one is drawn on surfaces, so that samples must know theirs.
    pub(super) on_surfaces: bool,
    /// Whether hair must tell which strand it is by more than its order.
    pub(super) asks_for_strands: bool,
    /// Whether hair must tell where it is an outline, on which no shadows fall.
    pub(super) asks_for_outlines: bool,
}

impl DecalParts {
    pub(super) fn is_empty(&self) -> bool {
        self.strokes.is_empty()
    }

    /// Takes those of a checked drawing in place of what was there.
    pub(super) fn collect(&mut self, drawing: &Drawing, tile_height: usize) {
        let decals = &drawing.decals;
        self.on_surfaces = decals.iter().any(|decal| decal.marks != 0);
        let is_on_strands = |decal: &Decal| decal.is_shadow && decal.on_hair;
        let on_strands = decals.iter().any(is_on_strands);
        self.asks_for_strands = on_strands && drawing.order == Order::Shifted;
        let is_outline = |layer: &LayerStrokes| layer.rank < 0;
        self.asks_for_outlines = on_strands && drawing.layers.iter().any(is_outline);
        self.strokes.clear();
        if !decals.is_empty() {
            self.strokes = strokes_in_order(drawing, Kind::Decals);
            let kind = Kind::Decals;
            (self.segments).collect(drawing, &self.strokes, kind, tile_height);
        }
    }
}

/// A thread's memory.
#[derive(Default)]
pub(super) struct Decals {
    of_tiles: Lists,
    /// A tile's segments after their strokes, the highest first, and strands.
    order: Vec<(Reverse<u32>, u32, u32)>,
    planes: Option<Planes>,
    /// Samples that have a decal's colour, and surfaces' samples that lie in a shadow.
    replaced: Option<Box<Mask>>,
    shaded: Option<Box<Mask>>,
}

/// What samples of a tile show, and the decals that fit them so far.
struct Planes {
    /// Marks of the surface that is seen; 0 where hair is.
    marks: IdPlane,
    /// Of each cell the farthest hair, and the farthest surface that has a mark, 1/m; infinite where there is none. Of cells that decals may reach.
    farthest: [Box<Aligned<[f32; CELLS]>>; 2],
    ratio: Plane,
    color: [Plane; 3],
    /// Where the decals that fit have brushes: the places beside their strokes.
    places: Option<PlacePlanes>,
}

/// Places beside strokes: the segments, the way from their first joints to the next, and the side with the ratio of the segment that says so.
struct PlacePlanes {
    segment: IdPlane,
    way: Plane,
    side: Plane,
    side_ratio: Plane,
}

/// The samples of a cell that a segment fits, those of them to which it is the nearest so far, those that earlier ones fit, and its ratios.
struct Nearer<'a> {
    fits: &'a LaneMask,
    wins: &'a LaneMask,
    taken: &'a LaneMask,
    ratio: &'a Lanes,
}

/// What the samples of a tile show that are no decals.
struct Seen {
    hair: Mask,
    surfaces: Mask,
    /// The farthest hair, and the farthest surface that has a mark, 1/m; infinite where there is none.
    farthest_hair: f32,
    farthest_surface: f32,
}

impl Decals {
    /// The samples of a cell that a decal colours, and those of surfaces in a shadow. As they were decided last.
    #[inline(always)]
    pub(super) fn lanes(&self, cell: Cell) -> [LaneMask; 2] {
        [&self.replaced, &self.shaded].map(|mask| match mask {
            Some(mask) => cell.lanes(mask),
            None => [0; LANES],
        })
    }
}

impl Worker {
    /// Finds the decals of each of the band's tiles.
    #[inline(always)]
    pub(super) fn sort_decals_into_tiles(&mut self, frame: &Frame, band: usize) {
        let segments = &frame.parts.decals.segments;
        let tiles = (frame.drawing.size[0] as usize).div_ceil(WIDTH);
        let of_band = segments.of_band(band).flat_map(|(first, some)| {
            let columns = |it: &Reach| cells_across(it.bounds.x(), WIDTH);
            some.iter().map(move |it| (first + it.segment, columns(it)))
        });
        self.decals.of_tiles.fill(tiles, of_band);
    }

    /// Finds which decals the samples of a tile show, once all else is drawn there.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn decide_decals(&mut self, frame: &Frame, scene: &TileContext, tile: usize) {
        let Self {
            decals,
            target,
            shown,
            ..
        } = self;
        (decals.replaced, decals.shaded) = (None, None);
        let parts = &frame.parts.decals;
        let of_tile = decals.of_tiles.bin(tile);
        if of_tile.is_empty() {
            return;
        }
        let list = parts.segments.list();
        let segment = |i: u32| &list[i as usize];
        decals.order.clear();
        let in_order = |&i: &u32| (Reverse(segment(i).stroke), segment(i).strand, i);
        decals.order.extend(of_tile.iter().map(in_order));
        decals.order.sort_unstable();
        let planes = decals.planes.get_or_insert_with(|| Planes {
            marks: id_plane(),
            farthest: [const { [f32::INFINITY; CELLS] }; 2].map(|cells| Box::new(Aligned(cells))),
            ratio: plane(),
            color: [plane(), plane(), plane()],
            places: None,
        });
        let mut reached = [0; ROWS];
        for &i in of_tile {
            let bounds = &segment(i).bounds;
            let columns = bounds.columns_in(scene.origin[0]);
            for row in bounds.rows_in(scene.origin[1], scene.stack) {
                reached[row] |= columns;
            }
        }
        let seen = planes.look(frame, target, shown, &reached);
        let scene = TileContext {
            strokes: &parts.strokes,
            segments: list,
            ..*scene
        };
        let (mut replaced, mut shaded) = (NO_SAMPLES, NO_SAMPLES);
        let mut closed = NO_SAMPLES;
        let (mut of_layer, mut open) = (usize::MAX, NO_SAMPLES);
        for stroke in (decals.order).chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (_, _, first_of_stroke) = stroke[0];
            let first = segment(first_of_stroke);
            let layer = parts.strokes[first.stroke as usize - 1].layer;
            let Some(decal) = frame.drawing.decal(layer) else {
                continue;
            };
            if layer != of_layer {
                of_layer = layer;
                open = without(&planes.targets(decal, &seen), &closed);
                if let Some(outlines) = target.outlines.as_deref().filter(|_| decal.is_shadow) {
                    open = without(&open, outlines);
                }
            }
            if is_empty(&open) {
                continue;
            }
            let offer = Offer {
                decal,
                drawing: frame.drawing,
                strand: frame.drawing.whole_strand(first.strand),
                list: frame.parts.segments.list(),
                reach_m: reaches_m(decal, scene.stack),
                target,
                shown,
                brush: frame.drawing.brushwork.of_layer(layer).map(|brushed| {
                    let of_stroke = &parts.strokes[first.stroke as usize - 1];
                    StrokeBrush::new(&scene, brushed, of_stroke, first_of_stroke)
                }),
            };
            let mut taken = NO_SAMPLES;
            for &(_, _, index) in stroke {
                let nearest = segment(index).inv_depth;
                if !decal.may_fit_any(&seen, nearest) {
                    continue;
                }
                let mut rows = [0; ROWS];
                for (row, rows) in rows.iter_mut().enumerate() {
                    *rows = columns(&open, row) & planes.may_fit(decal, row, nearest);
                }
                if let Some(placed) = Placed::new(&scene, index, &rows) {
                    offer.make(&placed, &open, planes, &mut taken);
                }
            }
            if let Some(brush) = &offer.brush {
                planes.thin(brush, &mut taken);
            }
            open = without(&open, &taken);
            add(&mut closed, &taken);
            if decal.is_shadow {
                add(&mut shaded, &both(&taken, &seen.surfaces));
                add(&mut replaced, &both(&taken, &seen.hair));
            } else {
                add(&mut replaced, &taken);
            }
        }
        decals.replaced = (!is_empty(&replaced)).then(|| Box::new(replaced));
        decals.shaded = (!is_empty(&shaded)).then(|| Box::new(shaded));
    }

    /// Gives samples the colours of the decals that were decided; painted surfaces in a shadow are left to what paints them.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn apply_decals(&mut self, frame: &Frame, origin: [usize; 2], stack: &Stack) {
        let Self {
            decals,
            target,
            shown,
            ..
        } = self;
        if let (Some(replaced), Some(planes)) = (&decals.replaced, &decals.planes) {
            for row in 0..ROWS {
                for cell in cells(row, columns(replaced, row)) {
                    let lanes = StoreMask::new(&cell.lanes(replaced));
                    for (plane, color) in target.color.iter_mut().zip(&planes.color) {
                        lanes.store(&color[cell.index], &mut plane[cell.index]);
                    }
                }
            }
        }
        if let (Some(shaded), Some(shown)) = (&decals.shaded, shown.planes()) {
            for row in 0..ROWS {
                for cell in cells(row, columns(shaded, row)) {
                    let what = &shown.what[cell.index];
                    shade(
                        frame,
                        origin,
                        stack,
                        cell,
                        what,
                        &cell.lanes(shaded),
                        target,
                    );
                }
            }
        }
    }
}

/// Gives samples of a cell that show surfaces the colours that these have in shadow.
#[inline(always)]
fn shade(
    frame: &Frame,
    origin: [usize; 2],
    stack: &Stack,
    cell: Cell,
    what: &[u32; LANES],
    lanes: &LaneMask,
    target: &mut Target,
) {
    let mut left = bits(lanes);
    while left != 0 {
        let shows = what[left.trailing_zeros() as usize];
        let mut own = *lanes;
        for k in 0..LANES {
            own[k] &= select(what[k] == shows, u32::MAX, 0);
        }
        left &= !bits(&own);
        let Some(surface) = frame.surface_of(shows).filter(|s| s.paint.is_none()) else {
            continue;
        };
        if surface.texture.is_none() {
            let own = StoreMask::new(&own);
            for (plane, shadow) in target.color.iter_mut().zip(surface.shadow) {
                own.store(&[shadow; LANES], &mut plane[cell.index]);
            }
            continue;
        }
        // What is lit is its texel times the colour in light.
        let triangle = &frame.parts.triangles[(shows & !TRIANGLE) as usize];
        let tones = triangle.corners(frame.drawing).map(|corner| corner.tone);
        let Some([tones]) = triangle.interpolated(frame.drawing, origin, [tones]) else {
            continue;
        };
        let tone = tones.slope.at_samples(stack).of(cell);
        for k in 0..LANES {
            own[k] &= select(tones.clamp(tone[k]) >= 0.0, u32::MAX, 0);
        }
        let own = StoreMask::new(&own);
        let both = surface.light.into_iter().zip(surface.shadow);
        for (plane, (light, shadow)) in target.color.iter_mut().zip(both) {
            let factor = if light > 0.0 { shadow / light } else { 1.0 };
            let mut color = plane[cell.index];
            for k in 0..LANES {
                color[k] *= factor;
            }
            own.store(&color, &mut plane[cell.index]);
        }
    }
}

impl Planes {
    /// Finds what the samples of a tile show, in the columns of each row of stacks that decals may reach.
    #[inline(always)]
    fn look(
        &mut self,
        frame: &Frame,
        target: &Target,
        shown: &Shown,
        reached: &[u32; ROWS],
    ) -> Seen {
        let mut seen = Seen {
            hair: NO_SAMPLES,
            surfaces: NO_SAMPLES,
            farthest_hair: f32::INFINITY,
            farthest_surface: f32::INFINITY,
        };
        let (mut far_hair, mut far_surface) = ([f32::INFINITY; LANES], [f32::INFINITY; LANES]);
        let shown = shown.planes().filter(|_| frame.parts.decals.on_surfaces);
        for row in 0..ROWS {
            for cell in cells(row, reached[row]) {
                let strand = &target.strand[cell.index];
                let (mut hair, mut surface) = ([0; LANES], [0; LANES]);
                for k in 0..LANES {
                    hair[k] = select(strand[k] > NOTHING, u32::MAX, 0);
                }
                let mut marks = [0; LANES];
                if let Some(shown) = shown {
                    let what = &shown.what[cell.index];
                    let mut left = hair;
                    for k in 0..LANES {
                        left[k] = select(what[k] != SHOWS_NOTHING, !hair[k], 0);
                    }
                    // Most samples of a cell are of one triangle.
                    while let Some(lane) = OneByOne::of_bits(bits(&left)).next() {
                        let own_marks = frame.surface_of(what[lane]).map_or(0, |s| s.marks);
                        for k in 0..LANES {
                            let own = select(what[k] == what[lane], left[k], 0);
                            marks[k] |= own & own_marks;
                            left[k] &= !own;
                        }
                    }
                    for k in 0..LANES {
                        surface[k] = select(marks[k] != 0, u32::MAX, 0);
                    }
                }
                self.marks[cell.index] = marks;
                let depth = &target.surface[cell.index];
                let (mut of_hair, mut of_surface) = ([0.0; LANES], [0.0; LANES]);
                for k in 0..LANES {
                    let hair = select(hair[k] != 0, strand[k], f32::INFINITY);
                    far_hair[k] = lesser(hair, far_hair[k]);
                    let surface = select(surface[k] != 0, depth[k], f32::INFINITY);
                    far_surface[k] = lesser(surface, far_surface[k]);
                    (of_hair[k], of_surface[k]) = (hair, surface);
                }
                self.farthest[0][cell.index] = least(&of_hair);
                self.farthest[1][cell.index] = least(&of_surface);
                cell.add_to(&mut seen.hair, &hair);
                cell.add_to(&mut seen.surfaces, &surface);
            }
        }
        seen.farthest_hair = least(&far_hair);
        seen.farthest_surface = least(&far_surface);
        seen
    }

    /// The columns of a row of stacks in whose cells a decal may fit anything, of a segment of which nothing is nearer than that (1/m).
    #[inline(always)]
    fn may_fit(&self, decal: &Decal, row: usize, nearest: f32) -> u32 {
        let mut may = [0; CELLS_ACROSS];
        let is_on = [decal.on_hair, decal.marks != 0];
        for ((farthest, is_on), least_m) in
            self.farthest.iter().zip(is_on).zip(decal.least_behind())
        {
            if !is_on {
                continue;
            }
            let mut own = [0.0; CELLS_ACROSS];
            own.copy_from_slice(&farthest[row * CELLS_ACROSS..][..CELLS_ACROSS]);
            for k in 0..CELLS_ACROSS {
                let fits = (own[k] < f32::INFINITY) & may_lie_behind(nearest, own[k], least_m);
                may[k] |= select(fits, u32::MAX, 0);
            }
        }
        columns_of_cells(&may)
    }

    /// Notes where beside a segment those samples of a cell lie that it fits and is nearer to than others before it, of which some fit those that
    /// are `taken`.
    #[inline(always)]
    fn put_places(&mut self, cell: Cell, placed: &Placed, nearer: Nearer) {
        let places = self.places.get_or_insert_with(|| PlacePlanes {
            segment: id_plane(),
            way: plane(),
            side: plane(),
            side_ratio: plane(),
        });
        let Nearer {
            fits,
            wins,
            taken,
            ratio,
        } = nearer;
        let (way, side) = placed.place(cell);
        let segments = &mut places.segment[cell.index];
        let side_ratio = &places.side_ratio[cell.index];
        let mut tells_side = *fits;
        for k in 0..LANES {
            segments[k] = select(wins[k] != 0, placed.index, segments[k]);
            let tells = (taken[k] == 0) | (ratio[k] < side_ratio[k] * NEARER);
            tells_side[k] &= select(tells, u32::MAX, 0);
        }
        StoreMask::new(wins).store(&way, &mut places.way[cell.index]);
        let tells_side = StoreMask::new(&tells_side);
        tells_side.store(&side, &mut places.side[cell.index]);
        tells_side.store(ratio, &mut places.side_ratio[cell.index]);
    }

    /// Takes from the samples that a stroke fits those that its brush leaves bare.
    #[inline(always)]
    fn thin(&self, brush: &StrokeBrush, taken: &mut Mask) {
        let Some(places) = &self.places else {
            return;
        };
        for row in 0..ROWS {
            for cell in cells(row, columns(taken, row)) {
                let at = cell.index;
                let across = across(&places.side[at], &self.ratio[at]);
                let (segment, way) = (&places.segment[at], &places.way[at]);
                let bare = brush.bare(&cell.lanes(taken), segment, way, &across);
                cell.take_from(taken, &bare);
            }
        }
    }

    /// The samples that show what a decal is drawn on.
    #[inline(always)]
    fn targets(&self, decal: &Decal, seen: &Seen) -> Mask {
        let mut targets = NO_SAMPLES;
        if decal.on_hair {
            targets = seen.hair;
        }
        if decal.marks != 0 {
            for row in 0..ROWS {
                for cell in cells(row, columns(&seen.surfaces, row)) {
                    let mut lanes = [0; LANES];
                    for k in 0..LANES {
                        let is_meant = self.marks[cell.index][k] & decal.marks != 0;
                        lanes[k] = select(is_meant, u32::MAX, 0);
                    }
                    cell.add_to(&mut targets, &lanes);
                }
            }
        }
        targets
    }
}

/// Whether what is seen there lies so far behind (m), or farther, of anything that is no nearer than that (both 1/m), with some room for rounding.
#[inline(always)]
fn may_lie_behind(nearest: f32, seen: f32, least_m: f32) -> bool {
    nearest * (1.0 + 1e-4) - seen >= least_m * (nearest * seen) * (1.0 - 1e-4 * least_m.signum())
}

impl Decal {
    /// How far hair and surfaces lie behind at least (m) which it fits; below 0 they lie before it.
    #[inline(always)]
    fn least_behind(&self) -> [f32; 2] {
        let before = -self.reach_m;
        [if self.is_shadow { self.reach_m } else { before }, before]
    }

    /// Whether it may fit anything that a tile shows, of a segment of which nothing is nearer than that (1/m).
    #[inline(always)]
    fn may_fit_any(&self, seen: &Seen, nearest: f32) -> bool {
        let [on_hair, on_surface] = self.least_behind();
        let may = |is_on: bool, farthest: f32, least_m| {
            is_on && farthest < f32::INFINITY && may_lie_behind(nearest, farthest, least_m)
        };
        may(self.on_hair, seen.farthest_hair, on_hair)
            || may(self.marks != 0, seen.farthest_surface, on_surface)
    }
}

/// A strand's stroke that is held against what samples show.
struct Offer<'a> {
    decal: &'a Decal,
    drawing: &'a Drawing,
    /// Its strand, whatever piece of it.
    strand: u32,
    /// The segments of hair.
    list: &'a [Segment],
    /// How far the decal reaches in each lane.
    reach_m: Lanes,
    /// What samples show.
    target: &'a Target,
    shown: &'a Shown,
    brush: Option<StrokeBrush<'a>>,
}

impl Offer<'_> {
    /// Gives those `open` samples that a segment fits its colours, where no segment of the stroke is nearer; they are `taken`.
    #[inline(always)]
    fn make(&self, placed: &Placed, open: &Mask, planes: &mut Planes, taken: &mut Mask) {
        let covered = both(&placed.covered, open);
        for row in 0..ROWS {
            for cell in cells(row, columns(&covered, row)) {
                let mut lanes = cell.lanes(&covered);
                let hair = &self.target.strand[cell.index];
                if self.decal.is_shadow && self.brush.is_none() {
                    // A surface in a shadow is no darker in two.
                    let before = cell.lanes(taken);
                    for k in 0..LANES {
                        let is_done = (before[k] != 0) & (hair[k] <= NOTHING);
                        lanes[k] &= select(is_done, 0, u32::MAX);
                    }
                }
                let lanes = self.may_fit(cell, &lanes, placed.shape.inv_depth.greatest());
                if !any(&lanes) {
                    continue;
                }
                let beside = placed.beside(cell);
                let fits = self.fits(cell, &lanes, &beside.inv_depth);
                if !any(&fits) {
                    continue;
                }
                let (mut wins, before) = (fits, cell.lanes(taken));
                let ratio = &planes.ratio[cell.index];
                for k in 0..LANES {
                    let is_nearer = (before[k] == 0) | (beside.ratio[k] < ratio[k]);
                    wins[k] &= select(is_nearer, u32::MAX, 0);
                }
                let stored = StoreMask::new(&wins);
                stored.store(&beside.ratio, &mut planes.ratio[cell.index]);
                if self.brush.is_some() {
                    let nearer = Nearer {
                        fits: &fits,
                        wins: &wins,
                        taken: &before,
                        ratio: &beside.ratio,
                    };
                    planes.put_places(cell, placed, nearer);
                }
                for (plane, color) in planes.color.iter_mut().zip(&beside.color) {
                    stored.store(color, &mut plane[cell.index]);
                }
                cell.add_to(taken, &fits);
            }
        }
    }

    /// Those of some samples of a cell that a segment may fit of which nothing is nearer than that (1/m).
    #[inline(always)]
    fn may_fit(&self, cell: Cell, samples: &LaneMask, nearest: f32) -> LaneMask {
        let (hair, surface) = (
            &self.target.strand[cell.index],
            &self.target.surface[cell.index],
        );
        let [on_hair, on_surface] = self.decal.least_behind();
        let mut may = *samples;
        for k in 0..LANES {
            let is_hair = hair[k] > NOTHING;
            let seen = select(is_hair, hair[k], surface[k]);
            let least = select(is_hair, on_hair, on_surface);
            may[k] &= select(may_lie_behind(nearest, seen, least), u32::MAX, 0);
        }
        may
    }

    /// Those of some samples of a cell, which show what it is drawn on, that are as near as it must be.
    #[inline(always)]
    fn fits(&self, cell: Cell, samples: &LaneMask, inv_depth: &Lanes) -> LaneMask {
        let (target, shown) = (self.target, self.shown);
        let (hair, surface) = (&target.strand[cell.index], &target.surface[cell.index]);
        let is_shadow = self.decal.is_shadow;
        let mut fits = *samples;
        for k in 0..LANES {
            let is_hair = hair[k] > NOTHING;
            let seen = select(is_hair, hair[k], surface[k]);
            // How far the seen lies behind, and the reach, both times the inverse depths.
            let behind = inv_depth[k] - seen;
            let reach = self.reach_m[k] * (inv_depth[k] * seen);
            let is_near = (behind <= reach) & (behind >= -reach);
            let is_in_shadow = select(is_hair, behind > reach, behind >= -reach);
            let is_right = select(is_shadow, is_in_shadow, is_near) & (inv_depth[k] > 0.0);
            fits[k] &= select(is_right, u32::MAX, 0);
        }
        if !is_shadow || !self.decal.on_hair || !any(&fits) {
            return fits;
        }
        let strands = match shown
            .planes()
            .filter(|_| self.drawing.order == Order::Shifted)
        {
            None => target.strands(cell.index),
            Some(shown) => shown.what[cell.index].map(|what| match what < TRIANGLE {
                true => self.list[what as usize].strand,
                false => u32::MAX,
            }),
        };
        for k in 0..LANES {
            let is_own = hair[k] > NOTHING && self.drawing.whole_strand(strands[k]) == self.strand;
            fits[k] &= select(is_own, 0, u32::MAX);
        }
        fits
    }
}

/// How far a decal reaches in the samples of each lane.
#[inline(always)]
fn reaches_m(decal: &Decal, stack: &Stack) -> Lanes {
    let together = stack.of_pixel;
    let mut reaches = [decal.reach_m; LANES];
    if !decal.is_shadow {
        for (k, reach) in reaches.iter_mut().enumerate() {
            *reach *= shown_reach((stack.first + k % together) as u32, together as u32);
        }
    }
    reaches
}

/// Marks samples of a cell as in the shadow of hair.
#[inline(always)]
pub(super) fn shade_occlusion(occlusion: &mut [f32], lanes: &LaneMask) {
    for (occlusion, lane) in occlusion.iter_mut().zip(lanes) {
        *occlusion = select(*lane != 0, IN_SHADOW, *occlusion);
    }
}
