//! Samples of a tile that layers for meshes paint: those that show a surface, and those whose hair such a surface is seen through.

use super::decals;
use super::shown::{NOTHING, Shown, TRIANGLE};
use super::surface::Interpolated;
use super::tile::{
    Cell, IdPlane, LANES, LaneMask, Lanes, Plane, Stack, StoreMask, Target, any, bits, id_plane,
    plane, select,
};
use super::{Frame, Worker};
use crate::frame::{FAR_LIGHT, Light};
use crate::mesh_paint::{PaintedMeshes, Seen};
use effects::wgsl::vec3;
use effects::{BLOCK, SampleBlock, SampleInput, Vectors};
use glam::{Vec2, Vec3};

/// Cells of a block.
const SLOTS: usize = BLOCK / LANES;
/// Triangles of a tile that are kept, each in the place that the end of its number says: a tile has many samples of each, row by row.
const KNOWN: usize = 128;

/// A thread's memory: what lies under hair and is seen through it, and for each layer a block of samples of either kind.
#[derive(Default)]
pub(super) struct MeshPainter {
    under: Option<Under>,
    known: Vec<Corners>,
    blocks: Vec<[Block; 2]>,
}

/// Samples that show a surface which is seen through hair, before there is hair.
struct Under {
    /// [`NOTHING`], or a triangle's number with [`TRIANGLE`].
    what: IdPlane,
    color: [Plane; 3],
}

/// Samples that show one layer.
struct Block {
    /// The cells that they are of, and which samples of these.
    cells: Vec<(usize, LaneMask)>,
    /// The surface whose colours all samples of the last one are told, [`NOTHING`] where none are yet.
    colored_as: u32,
    /// Places in pixels, and inverse depths (1/m).
    x: [Lanes; SLOTS],
    y: [Lanes; SLOTS],
    inv_depth: [Lanes; SLOTS],
    /// Of any length.
    normal: [[Lanes; SLOTS]; 3],
    samples: Box<SampleBlock>,
}

/// A triangle as its samples are told of it.
#[derive(Clone)]
struct Corners {
    /// As [`Shown`](super::shown::Shown) has it.
    what: u32,
    /// Its number among the drawing's.
    surface: u32,
    layer: usize,
    light: [f32; 3],
    shadow: [f32; 3],
    /// Numbers times inverse depth, which run linearly on the screen: the normal's, and the occlusion, if there is any.
    normal: [Interpolated; 3],
    occlusion: Option<Interpolated>,
}

impl Corners {
    const NOTHING: Self = Self {
        what: NOTHING,
        surface: NOTHING,
        layer: 0,
        light: [0.0; 3],
        shadow: [0.0; 3],
        normal: [Interpolated::ZERO; 3],
        occlusion: None,
    };
}

impl MeshPainter {
    /// Keeps what is seen through hair, once all surfaces are drawn.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn keep_under(&mut self, frame: &Frame, shown: &Shown, target: &Target) {
        let Some(shown) = shown.planes() else {
            return;
        };
        let under = self.under.get_or_insert_with(|| Under {
            what: id_plane(),
            color: [plane(), plane(), plane()],
        });
        let mut last = (NOTHING, false);
        for (cell, shows) in shown.what.iter().enumerate() {
            let mut kept = [NOTHING; LANES];
            for k in 0..LANES {
                if shows[k] != last.0 {
                    last = (shows[k], frame.is_seen_through_hair(shows[k]));
                }
                kept[k] = select(last.1, shows[k], NOTHING);
            }
            under.what[cell] = kept;
            for (under, plane) in under.color.iter_mut().zip(&target.color) {
                under[cell] = plane[cell];
            }
        }
    }
}

impl Worker {
    /// Gives the samples of painted surfaces the colours that their programs say: of those under hair as much as is seen through it.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn paint_meshes(&mut self, frame: &Frame, origin: [usize; 2], stack: &Stack) {
        let painting = &frame.drawing.mesh_painting;
        let (Some(shown), Some(seen)) = (self.shown.planes(), &painting.seen) else {
            return;
        };
        let decals = (!frame.parts.decals.is_empty()).then_some(&self.decals);
        let MeshPainter {
            under,
            known,
            blocks,
        } = &mut self.meshes;
        let under = under.as_ref().filter(|_| painting.sees_through());
        let target = &mut self.target;
        blocks.resize_with(painting.layers.len(), || [Block::new(), Block::new()]);
        for block in blocks.as_flattened_mut() {
            block.cells.clear(); // empty, but where a program panicked
        }
        let place = Place {
            frame,
            seen,
            origin,
            stack,
        };
        known.resize(KNOWN, Corners::NOTHING);
        for corners in &mut known[..] {
            corners.what = NOTHING;
        }
        let mut gathered = Gathered {
            place: &place,
            known,
            blocks,
        };
        for (cell, shows) in shown.what.iter().enumerate() {
            let mut is_mesh = lanes_where(shows, |what| (what >= TRIANGLE) & (what != NOTHING));
            if any(&is_mesh) {
                let mut shaded = None;
                if let Some(decals) = decals {
                    let [replaced, in_shadow] = decals.lanes(Cell::of_index(cell));
                    for k in 0..LANES {
                        is_mesh[k] &= !replaced[k];
                    }
                    shaded = any(&in_shadow).then_some(in_shadow);
                }
                gathered.add_cell(cell, (shows, &is_mesh), shaded.as_ref(), None, target);
            }
            if let Some(under) = under {
                let mut is_under = lanes_where(shows, |what| what < TRIANGLE);
                for k in 0..LANES {
                    is_under[k] &= select(under.what[cell][k] != NOTHING, u32::MAX, 0);
                }
                gathered.add_cell(
                    cell,
                    (&under.what[cell], &is_under),
                    None,
                    Some(under),
                    target,
                );
            }
        }
        for (blocks, layer) in blocks.iter_mut().zip(&painting.layers) {
            let [on_top, below] = blocks;
            on_top.paint(&place, layer, false, target);
            below.paint(&place, layer, true, target);
        }
    }
}

/// The samples of a tile that are painted, as they are gathered.
struct Gathered<'a> {
    place: &'a Place<'a>,
    known: &'a mut [Corners],
    blocks: &'a mut [[Block; 2]],
}

impl Gathered<'_> {
    /// Adds some samples of a cell, which show those triangles; of these the ones in a shadow. Of samples under hair what is there.
    #[inline(always)]
    fn add_cell(
        &mut self,
        cell: usize,
        (shows, lanes): (&[u32; LANES], &LaneMask),
        shaded: Option<&LaneMask>,
        under: Option<&Under>,
        target: &mut Target,
    ) {
        let kind = usize::from(under.is_some());
        let mut left = bits(lanes);
        while left != 0 {
            let what = shows[left.trailing_zeros() as usize];
            let mut own = lanes_where(shows, |other| other == what);
            for k in 0..LANES {
                own[k] &= lanes[k];
            }
            left &= !bits(&own);
            let corners = &mut self.known[what as usize % KNOWN];
            if corners.what != what {
                let Some(new) = self.place.corners(what) else {
                    continue;
                };
                *corners = new;
            }
            let block = &mut self.blocks[corners.layer][kind];
            if block.cells.last().is_none_or(|(last, _)| *last != cell) {
                if block.cells.len() == SLOTS {
                    let layer = &self.place.frame.drawing.mesh_painting.layers[corners.layer];
                    block.paint(self.place, layer, under.is_some(), target);
                }
                block.begin(self.place, cell, target);
            }
            let colors = match under {
                Some(under) => &under.color,
                None => &target.color,
            };
            block.add(cell, corners, colors, self.place.stack, &own);
            if let Some(shaded) = shaded {
                for k in 0..LANES {
                    own[k] &= shaded[k];
                }
                block.shade(&own);
            }
        }
    }
}

impl Frame<'_> {
    /// The surface that a sample shows.
    #[inline(always)]
    pub(super) fn surface_of(&self, what: u32) -> Option<&crate::Surface> {
        if what < TRIANGLE || what == NOTHING {
            return None;
        }
        let triangle = &self.parts.triangles[(what & !TRIANGLE) as usize];
        Some(&self.drawing.surfaces[triangle.surface as usize])
    }

    fn is_seen_through_hair(&self, what: u32) -> bool {
        let paint = self
            .surface_of(what)
            .and_then(|surface| surface.paint.as_ref());
        let layers = &self.drawing.mesh_painting.layers;
        paint.is_some_and(|paint| layers[paint.layer as usize].through_hair > 0.0)
    }
}

/// Where a tile's samples lie.
struct Place<'a> {
    frame: &'a Frame<'a>,
    seen: &'a Seen,
    origin: [usize; 2],
    stack: &'a Stack,
}

impl Place<'_> {
    /// A painted triangle, by what a sample shows; none where it isn't painted.
    #[inline(always)]
    fn corners(&self, what: u32) -> Option<Corners> {
        let surface = self.frame.surface_of(what)?;
        let paint = surface.paint.as_ref()?;
        let drawing = self.frame.drawing;
        let triangle = &self.frame.parts.triangles[(what & !TRIANGLE) as usize];
        let own = surface.triangles[triangle.number as usize];
        let read = drawing.mesh_painting.layers[paint.layer as usize].read;
        let mut normal = [[0.0; 3]; 3];
        let mut occlusion = [0.0; 3];
        for corner in 0..3 {
            let index = own[corner] as usize;
            let inv_depth = surface.vertices[index].inv_depth;
            let own = paint.normals[index];
            normal[0][corner] = own.x * inv_depth;
            normal[1][corner] = own.y * inv_depth;
            normal[2][corner] = own.z * inv_depth;
            let own = paint.occlusion.get(index).copied().unwrap_or(0.0);
            occlusion[corner] = own * inv_depth;
        }
        let has_occlusion = read.has(SampleInput::Occlusion) && !paint.occlusion.is_empty();
        let [x, y, z] = normal;
        let numbers = triangle.interpolated(drawing, self.origin, [x, y, z, occlusion])?;
        let [x, y, z, occlusion] = numbers;
        Some(Corners {
            what,
            surface: triangle.surface,
            layer: paint.layer as usize,
            light: surface.light,
            shadow: surface.shadow,
            normal: [x, y, z],
            occlusion: has_occlusion.then_some(occlusion),
        })
    }
}

impl Block {
    fn new() -> Self {
        Self {
            cells: Vec::new(),
            colored_as: NOTHING,
            x: [[0.0; LANES]; SLOTS],
            y: [[0.0; LANES]; SLOTS],
            inv_depth: [[1.0; LANES]; SLOTS],
            normal: [[[1.0; LANES]; SLOTS]; 3],
            samples: Box::new(SampleBlock::NOTHING),
        }
    }

    /// Begins with a cell.
    #[inline(always)]
    fn begin(&mut self, place: &Place, index: usize, target: &Target) {
        let slot = self.cells.len();
        self.cells.push((index, [0; LANES]));
        self.colored_as = NOTHING;
        let cell = Cell::of_index(index);
        let left = (place.origin[0] + cell.column) as f32;
        let top = (place.origin[1] + cell.row * place.stack.height) as f32;
        let (mut x, mut y) = (place.stack.x, place.stack.y);
        for k in 0..LANES {
            x[k] += left;
        }
        for k in 0..LANES {
            y[k] += top;
        }
        (self.x[slot], self.y[slot]) = (x, y);
        // Of samples that show no surface there is none.
        self.inv_depth[slot] = target.surface[index];
    }

    /// Adds samples of the last cell, which show one triangle.
    #[inline(always)]
    fn add(
        &mut self,
        index: usize,
        corners: &Corners,
        colors: &[Plane; 3],
        stack: &Stack,
        lanes: &LaneMask,
    ) {
        let slot = self.cells.len() - 1;
        let stored = StoreMask::new(lanes);
        if let Some((_, all)) = self.cells.last_mut() {
            stored.add_to(all);
        }
        let cell = Cell::of_index(index);
        let inv_depth = self.inv_depth[slot];
        for (axis, number) in corners.normal.iter().enumerate() {
            let mut numbers = number.slope.at_samples(stack).of(cell);
            for k in 0..LANES {
                numbers[k] = number.clamp(numbers[k]);
            }
            stored.store(&numbers, &mut self.normal[axis][slot]);
        }
        let mut occlusion = [0.0; LANES];
        if let Some(number) = &corners.occlusion {
            let numbers = number.slope.at_samples(stack).of(cell);
            for k in 0..LANES {
                occlusion[k] = number.clamp(numbers[k]) / inv_depth[k];
            }
        }
        put(&mut self.samples.occlusion, slot, &occlusion, &stored);
        // Most cells show one surface: its colours go to all samples, as nobody asks for those of others.
        if self.colored_as == NOTHING {
            self.colored_as = corners.surface;
            self.tell_colors::<true>(slot, corners, colors, index, &stored);
        } else if self.colored_as != corners.surface {
            self.tell_colors::<false>(slot, corners, colors, index, &stored);
        }
    }

    /// Tells the samples of a cell, or `ALL` of a slot, a surface's own colours.
    #[inline(always)]
    fn tell_colors<const ALL: bool>(
        &mut self,
        slot: usize,
        corners: &Corners,
        colors: &[Plane; 3],
        index: usize,
        lanes: &StoreMask,
    ) {
        let (own, shade) = (&mut self.samples.color, &mut self.samples.shade_color);
        for (numbers, factors) in [
            ([&mut own.x, &mut own.y, &mut own.z], &corners.light),
            ([&mut shade.x, &mut shade.y, &mut shade.z], &corners.shadow),
        ] {
            for axis in 0..3 {
                let mut color = colors[axis][index];
                for k in 0..LANES {
                    color[k] *= factors[axis];
                }
                let numbers = &mut *numbers[axis];
                if ALL {
                    numbers[slot * LANES..][..LANES].copy_from_slice(&color);
                } else {
                    put(numbers, slot, &color, lanes);
                }
            }
        }
    }

    /// Puts samples of the last cell into the shadow of hair.
    #[inline(always)]
    fn shade(&mut self, lanes: &LaneMask) {
        let first = (self.cells.len() - 1) * LANES;
        decals::shade_occlusion(&mut self.samples.occlusion[first..][..LANES], lanes);
    }

    /// Paints the samples that were gathered, and begins anew. What isn't finite has the mesh's own colour.
    #[inline(always)]
    fn paint(&mut self, place: &Place, layer: &PaintedMeshes, is_under: bool, target: &mut Target) {
        if self.cells.is_empty() {
            return;
        }
        self.finish(place.seen, layer);
        let mut painted = Vectors::NOTHING;
        let samples = &self.samples;
        layer.program.paint_block(samples, layer.seed, &mut painted);
        let share = if is_under { layer.through_hair } else { 1.0 };
        let painted = [&painted.x, &painted.y, &painted.z];
        let own = [&samples.color.x, &samples.color.y, &samples.color.z];
        for (slot, (cell, lanes)) in self.cells.drain(..).enumerate() {
            let first = slot * LANES;
            let mut finite = [true; LANES];
            for k in 0..LANES {
                let sum = painted[0][first + k] + painted[1][first + k] + painted[2][first + k];
                finite[k] = sum.is_finite();
            }
            let stored = StoreMask::new(&lanes);
            for axis in 0..3 {
                let plane = &mut target.color[axis][cell];
                let mut color = *plane;
                for k in 0..LANES {
                    let (new, own) = (painted[axis][first + k], own[axis][first + k]);
                    let new = select(finite[k], new, own);
                    // Light beyond 0 to 1 is cut before it is mixed.
                    let new = select(is_under, new.clamp(0.0, 1.0), new);
                    let hair = color[k].clamp(0.0, 1.0);
                    color[k] = select(is_under, hair + (new - hair) * share, new);
                }
                stored.store(&color, plane);
            }
        }
    }

    /// Works out what the layer reads of the samples.
    #[inline(always)]
    fn finish(&mut self, seen: &Seen, layer: &PaintedMeshes) {
        let reads = |input| layer.read.has(input);
        let samples = &mut *self.samples;
        let (x, y, inv_depth) = (flat(&self.x), flat(&self.y), flat(&self.inv_depth));
        if reads(SampleInput::Normal) {
            let [nx, ny, nz] = self.normal.each_ref().map(flat);
            for i in 0..BLOCK {
                let square = nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i];
                // Where normals cancel out it is none.
                let inverse = select(square > 1e-30, 1.0 / square.sqrt(), 0.0);
                samples.normal.x[i] = nx[i] * inverse;
                samples.normal.y[i] = ny[i] * inverse;
                samples.normal.z[i] = nz[i] * inverse;
            }
        }
        if reads(SampleInput::Depth) {
            for i in 0..BLOCK {
                samples.depth[i] = 1.0 / (inv_depth[i] * layer.head_height_m);
            }
        }
        if reads(SampleInput::HeadDepth) {
            samples.head_depth = [layer.head_depth; BLOCK];
        }
        if reads(SampleInput::Time) {
            samples.time = [seen.time_s; BLOCK];
        }
        if reads(SampleInput::Pixels) {
            let scale = seen.camera.focal_px() * layer.head_height_m;
            for i in 0..BLOCK {
                samples.pixels[i] = scale * inv_depth[i];
            }
        }
        let of_light = [SampleInput::LightDirection, SampleInput::LightDistance];
        let of_light = of_light.map(reads).contains(&true);
        let of_point = of_light && matches!(seen.light, Light::Point(_));
        if reads(SampleInput::Position) || reads(SampleInput::ViewDirection) || of_point {
            let (position, to_eye) = (&mut samples.position, &mut samples.view_direction);
            Lens::of(seen).look([x, y, inv_depth], position, to_eye);
        }
        match seen.light {
            _ if !of_light => {}
            Light::Direction(Vec3 { x, y, z }) => {
                samples.light_direction = Vectors {
                    x: [x; BLOCK],
                    y: [y; BLOCK],
                    z: [z; BLOCK],
                };
                samples.light_distance = [FAR_LIGHT; BLOCK];
            }
            Light::Point(_) => {
                for i in 0..BLOCK {
                    let position = Vec3::from_array(samples.position.at(i).to_array());
                    let (direction, distance_m) = seen.light.seen_from(position);
                    samples.light_direction.set(i, vec3(direction.to_array()));
                    let distance_m = distance_m.unwrap_or(0.0);
                    samples.light_distance[i] = distance_m / layer.head_height_m;
                }
            }
        }
    }
}

/// The numbers of a block's samples, which its cells have.
#[inline(always)]
fn flat(cells: &[Lanes; SLOTS]) -> &[f32; BLOCK] {
    let flat = cells.as_flattened().try_into();
    flat.unwrap_or_else(|_| unreachable!("a block is {SLOTS} cells"))
}

/// Where the points of a picture lie in the world.
struct Lens {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    ahead: Vec3,
    middle: Vec2,
    focal_px: f32,
}

impl Lens {
    fn of(seen: &Seen) -> Self {
        let camera = &seen.camera;
        let [width, height] = camera.size_px().map(|side| side as f32);
        Self {
            eye: camera.eye(),
            right: camera.world_from_view_direction(Vec3::X),
            up: camera.world_from_view_direction(Vec3::Y),
            ahead: camera.world_from_view_direction(Vec3::Z),
            middle: Vec2::new(width, height) / 2.0,
            focal_px: camera.focal_px(),
        }
    }

    /// Where a block's samples lie, by their places in the picture (px) and their inverse depths (1/m), and the unit vectors from there to the
    /// eye. By numbers, as loops over vectors of three are no vector instructions.
    #[inline(always)]
    fn look(
        &self,
        [x, y, inv_depth]: [&[f32; BLOCK]; 3],
        position: &mut Vectors,
        to_eye: &mut Vectors,
    ) {
        let (right, up, ahead) = (self.right, self.up, self.ahead);
        for i in 0..BLOCK {
            let depth_m = 1.0 / inv_depth[i];
            let scale = depth_m / self.focal_px;
            let across = (x[i] - self.middle.x) * scale;
            let above = (self.middle.y - y[i]) * scale;
            // From the eye.
            let away_x = right.x * across + up.x * above + ahead.x * depth_m;
            let away_y = right.y * across + up.y * above + ahead.y * depth_m;
            let away_z = right.z * across + up.z * above + ahead.z * depth_m;
            position.x[i] = self.eye.x + away_x;
            position.y[i] = self.eye.y + away_y;
            position.z[i] = self.eye.z + away_z;
            let inverse = 1.0 / (away_x * away_x + away_y * away_y + away_z * away_z).sqrt();
            to_eye.x[i] = -away_x * inverse;
            to_eye.y[i] = -away_y * inverse;
            to_eye.z[i] = -away_z * inverse;
        }
    }
}

/// Takes on the new numbers of a slot where `lanes` is set.
#[inline(always)]
fn put(block: &mut [f32; BLOCK], slot: usize, new: &Lanes, lanes: &StoreMask) {
    let (cells, _) = block.as_chunks_mut();
    lanes.store(new, &mut cells[slot]);
}

/// The lanes whose numbers are as wanted.
#[inline(always)]
fn lanes_where(numbers: &[u32; LANES], is_wanted: impl Fn(u32) -> bool) -> LaneMask {
    let mut lanes = [0; LANES];
    for k in 0..LANES {
        lanes[k] = select(is_wanted(numbers[k]), u32::MAX, 0);
    }
    lanes
}

/// Whether tiles must know what their samples show, to be painted or drawn on.
pub(super) fn tells(frame: &Frame) -> bool {
    let drawing = frame.drawing;
    let is_painted = !(drawing.painting.is_empty() && drawing.mesh_painting.is_empty());
    is_painted || frame.parts.decals.asks_for_strands
}
