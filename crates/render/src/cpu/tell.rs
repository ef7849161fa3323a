//! What the samples of a tile tell, feature by feature and row by row.

use super::ribbon::Ribbon;
use super::segment::Segment;
use super::shown::{NOTHING, Planes, TRIANGLE};
use super::tile::{self, CELLS_ACROSS, LANES, ROWS, select};
use super::{Frame, Worker};
use crate::features::{Feature, NO_ID, normal_of_triangle, object_of_hair, object_of_mesh};
use crate::planes::{BandPlanes, Sample, Stacks};
use glam::Vec3;
use std::ops::Range;

/// Samples of a row of cells.
const ROW: usize = CELLS_ACROSS * LANES;

/// A number of each of them.
type Row<T> = [T; ROW];

impl Worker {
    /// Writes down what the samples of a tile at the column `left` show, of a tile as large as that.
    #[inline(always)] // compiled for each set of `Instructions`
    pub(super) fn tell(
        &self,
        frame: &Frame,
        [width, height]: [usize; 2],
        left: usize,
        planes: &mut BandPlanes,
    ) {
        let Some(shown) = self.shown.planes() else {
            return;
        };
        let stack = &frame.stacks[0];
        for row in 0..ROWS.min(height.div_ceil(stack.height)) {
            let top = row * stack.height;
            let stacks = Stacks {
                column: left,
                columns: width,
                row: top,
                rows: stack.height.min(height - top),
                of_pixel: stack.of_pixel,
                count: stack.samples,
            };
            let what = row_of(&shown.what, row);
            let owners = frame.owners(what);
            for feature in planes.layout.declared.iter() {
                if feature.is_id() {
                    let ids = frame.ids(feature, what, &owners);
                    planes.put_ids(feature, &stacks, &ids);
                    continue;
                }
                if feature == Feature::Normal {
                    for (component, numbers) in self.normals(frame, shown, row).iter().enumerate() {
                        planes.put_numbers(feature, component, &stacks, numbers);
                    }
                    continue;
                }
                for component in 0..feature.components() {
                    let numbers = self.numbers(frame, shown, feature, component, row);
                    planes.put_numbers(feature, component, &stacks, &numbers);
                }
            }
        }
    }

    /// The same for lines that are found in the band's ribbon, of a tile at those columns.
    #[inline(always)]
    pub(super) fn tell_ribbon(&self, frame: &Frame, columns: &Range<usize>, ribbon: &mut Ribbon) {
        let Some(shown) = self.shown.planes() else {
            return;
        };
        ribbon.draw(columns);
        for row in 0..ribbon.rows().div_ceil(frame.stacks[0].height) {
            let what = row_of(&shown.what, row);
            let owners = frame.owners(what);
            for feature in ribbon.asked().iter() {
                if feature.is_id() {
                    let ids = frame.ids(feature, what, &owners);
                    ribbon.put((feature, 0), row, columns, &ids);
                    continue;
                }
                if feature == Feature::Normal {
                    let normals = self.normals(frame, shown, row);
                    for (component, numbers) in normals.iter().enumerate() {
                        ribbon.put((feature, component), row, columns, &bits(numbers));
                    }
                    continue;
                }
                for component in 0..feature.components() {
                    let numbers = self.numbers(frame, shown, feature, component, row);
                    ribbon.put((feature, component), row, columns, &bits(&numbers));
                }
            }
        }
    }

    /// A component of a feature of the samples of a row.
    #[inline(always)]
    fn numbers(
        &self,
        frame: &Frame,
        shown: &Planes,
        feature: Feature,
        component: usize,
        row: usize,
    ) -> Row<f32> {
        let what = row_of(&shown.what, row);
        let features = &frame.drawing.features;
        let mut numbers = [0.0; ROW];
        match feature {
            Feature::InvDepth => {
                let target = &self.target;
                let (surface, strand) = (row_of(&target.surface, row), row_of(&target.strand, row));
                for i in 0..ROW {
                    let depth = select(what[i] < TRIANGLE, strand[i], surface[i]);
                    numbers[i] = select(what[i] == NOTHING, 0.0, depth);
                }
            }
            Feature::V | Feature::W => {
                let plane = match feature {
                    Feature::V => &shown.v,
                    _ => &shown.w,
                };
                let places = row_of(plane, row);
                for i in 0..ROW {
                    numbers[i] = select(what[i] < TRIANGLE, places[i], 0.0);
                }
            }
            Feature::Color if component < 3 => {
                let light = row_of(&self.target.color[component], row);
                for i in 0..ROW {
                    numbers[i] = light[i].clamp(0.0, 1.0);
                }
            }
            Feature::Color => {
                let is_opaque = frame.drawing.background.is_some();
                for i in 0..ROW {
                    numbers[i] = select(is_opaque | (what[i] != NOTHING), 1.0, 0.0);
                }
            }
            Feature::U => frame.mix(&features.u, what, row_of(&shown.way, row), &mut numbers),
            Feature::S => frame.mix(&features.s, what, row_of(&shown.way, row), &mut numbers),
            Feature::Pixels => {
                frame.mix(
                    &features.pixels,
                    what,
                    row_of(&shown.way, row),
                    &mut numbers,
                );
            }
            // Three at once, or no numbers.
            Feature::Normal
            | Feature::Object
            | Feature::Strand
            | Feature::Piece
            | Feature::Layer
            | Feature::Level => {}
        }
        numbers
    }

    /// The components of the normals of the samples of a row.
    fn normals(&self, frame: &Frame, shown: &Planes, row: usize) -> [Row<f32>; 3] {
        let what = row_of(&shown.what, row);
        let (way, w) = (row_of(&shown.way, row), row_of(&shown.w, row));
        let mut normals = [[0.0; ROW]; 3];
        let mut triangle = (NOTHING, Sample::NOTHING.normal);
        for i in 0..ROW {
            let normal = if what[i] < TRIANGLE {
                let segment = &frame.parts.segments.list()[what[i] as usize];
                let [joint, next] = segment.joints();
                let features = &frame.drawing.features;
                features.normal_of_hair(joint, next, way[i], w[i])
            } else {
                if what[i] != triangle.0 {
                    triangle = (what[i], frame.normal_of_triangle(what[i]));
                }
                triangle.1
            };
            for (numbers, number) in normals.iter_mut().zip(normal.to_array()) {
                numbers[i] = number;
            }
        }
        normals
    }
}

#[inline(always)]
fn bits(numbers: &Row<f32>) -> Row<u32> {
    let mut bits = [0; ROW];
    for i in 0..ROW {
        bits[i] = numbers[i].to_bits();
    }
    bits
}

/// The samples of a row of cells.
#[inline(always)]
fn row_of<T>(plane: &[[T; LANES]; ROWS * CELLS_ACROSS], row: usize) -> &Row<T> {
    let cells = &plane[row * CELLS_ACROSS..][..CELLS_ACROSS];
    let samples = cells.as_flattened().try_into();
    samples.unwrap_or_else(|_| unreachable!("a row is {CELLS_ACROSS} cells"))
}

/// Things that samples show, one after the other, and whose they are.
struct Owned {
    first: u32,
    count: u32,
    owner: u32,
}

impl Owned {
    #[inline(always)]
    fn has(&self, what: u32) -> bool {
        what.wrapping_sub(self.first) < self.count
    }
}

/// What each of some numbers stands for; of the one number of `last` it is known.
#[inline(always)]
fn each_of(numbers: &Row<u32>, mut last: (u32, u32), of: impl Fn(u32) -> u32) -> Row<u32> {
    let mut all = [0; ROW];
    let (cells, _) = numbers.as_chunks::<LANES>();
    let (of_cells, _) = all.as_chunks_mut::<LANES>();
    // Samples beside each other mostly have the same.
    for (numbers, all) in cells.iter().zip(of_cells) {
        if all_are(numbers, last.0) {
            *all = [last.1; LANES];
            continue;
        }
        for k in 0..LANES {
            if numbers[k] != last.0 {
                last = (numbers[k], of(numbers[k]));
            }
            all[k] = last.1;
        }
    }
    all
}

/// Whether all samples of a cell show this.
#[inline(always)]
fn all_are(what: &[u32; LANES], this: u32) -> bool {
    let mut others = 0;
    for k in 0..LANES {
        others |= what[k] ^ this;
    }
    others == 0
}

impl Frame<'_> {
    /// The layer whose colour a segment has.
    fn layer_of(&self, segment: &Segment) -> Option<usize> {
        let stroke = segment.colored().checked_sub(1)?;
        Some(self.strokes[stroke as usize].layer)
    }

    /// Whose the samples are that show this: [`NOTHING`], a surface's number with [`TRIANGLE`], or that of a run.
    #[inline(always)]
    fn owners(&self, what: &Row<u32>) -> Row<u32> {
        let mut last = Owned {
            first: NOTHING,
            count: 1,
            owner: NOTHING,
        };
        let mut owners = [0; ROW];
        let (cells, _) = what.as_chunks::<LANES>();
        let (of_cells, _) = owners.as_chunks_mut::<LANES>();
        for (what, owners) in cells.iter().zip(of_cells) {
            let mut are_others = false;
            for k in 0..LANES {
                are_others |= !last.has(what[k]);
            }
            if !are_others {
                *owners = [last.owner; LANES];
                continue;
            }
            for k in 0..LANES {
                if !last.has(what[k]) {
                    last = self.owned(what[k]);
                }
                owners[k] = last.owner;
            }
        }
        owners
    }

    /// What is of the same owner as this.
    fn owned(&self, what: u32) -> Owned {
        let (first, count, owner) = match what {
            NOTHING => (what, 1, NOTHING),
            TRIANGLE.. => {
                let triangle = &self.parts.triangles[(what & !TRIANGLE) as usize];
                // A surface's triangles come one after the other.
                let surface = &self.drawing.surfaces[triangle.surface as usize];
                let count = surface.triangles.len() as u32;
                (what - triangle.number, count, triangle.surface | TRIANGLE)
            }
            _ => {
                let segment = &self.parts.segments.list()[what as usize];
                (what, 1, self.runs_of_joints[segment.joints()[0]])
            }
        };
        Owned {
            first,
            count,
            owner,
        }
    }

    /// An id of each of the samples that show this, and are of these owners.
    #[inline(always)]
    fn ids(&self, feature: Feature, what: &Row<u32>, owners: &Row<u32>) -> Row<u32> {
        let nothing = (NOTHING, Sample::NOTHING.id(feature));
        match feature {
            Feature::Layer => each_of(what, nothing, |what| self.layer(what)),
            _ => each_of(owners, nothing, |owner| self.id(feature, owner)),
        }
    }

    /// The layer that a sample shows.
    fn layer(&self, what: u32) -> u32 {
        if what >= TRIANGLE {
            return NO_ID;
        }
        let layer = self.layer_of(&self.parts.segments.list()[what as usize]);
        layer.map_or(NO_ID, |layer| layer as u32)
    }

    /// An id of what an owner's samples show.
    fn id(&self, feature: Feature, owner: u32) -> u32 {
        if owner == NOTHING {
            return Sample::NOTHING.id(feature);
        }
        if owner & TRIANGLE != 0 {
            return match feature {
                Feature::Object => {
                    let surface = &self.drawing.surfaces[(owner & !TRIANGLE) as usize];
                    object_of_mesh(surface.mesh)
                }
                _ => NO_ID,
            };
        }
        let run = owner as usize;
        let info = &self.drawing.features.runs[run];
        match feature {
            Feature::Object => object_of_hair(info.object),
            Feature::Strand => info.strand,
            Feature::Piece => self.drawing.runs[run].strand,
            Feature::Level => info.level,
            _ => NO_ID,
        }
    }

    /// What a list of joints has at the places of the samples that show hair.
    #[inline(always)]
    fn mix(&self, list: &[f32], what: &Row<u32>, way: &Row<f32>, numbers: &mut Row<f32>) {
        let (cells, _) = what.as_chunks::<LANES>();
        let (ways, _) = way.as_chunks::<LANES>();
        let (of_cells, _) = numbers.as_chunks_mut::<LANES>();
        for ((what, way), numbers) in cells.iter().zip(ways).zip(of_cells) {
            let ends = |what: u32| {
                let segment = &self.parts.segments.list()[what as usize];
                segment.joints().map(|joint| list[joint])
            };
            if all_are(what, what[0]) {
                if what[0] < TRIANGLE {
                    let [from, to] = ends(what[0]);
                    for k in 0..LANES {
                        numbers[k] = from + way[k] * (to - from);
                    }
                }
                continue;
            }
            for k in (0..LANES).filter(|k| what[*k] < TRIANGLE) {
                let [from, to] = ends(what[k]);
                numbers[k] = from + way[k] * (to - from);
            }
        }
    }

    /// The normal of a sample that shows a triangle, or nothing.
    fn normal_of_triangle(&self, what: u32) -> Vec3 {
        let Some(camera) = self.drawing.features.camera.as_ref() else {
            return Sample::NOTHING.normal;
        };
        if what == NOTHING {
            return Sample::NOTHING.normal;
        }
        let triangle = &self.parts.triangles[(what & !TRIANGLE) as usize];
        let corners = triangle.corners(self.drawing);
        let corners = corners.map(|corner| (corner.position, corner.inv_depth));
        normal_of_triangle(camera, corners)
    }
}

const _: () = assert!(ROW == tile::WIDTH * tile::STACK);
