//! What painted samples are told of joints: mixed of two joints a cell at a time, and finished for a block of them.

use super::tile::{LANES, LaneMask, Lanes, OneByOne, StoreMask, greater, select};
use crate::painting::Painting;
use effects::wgsl::{Vec3, vec3};
use effects::{BLOCK, SampleBlock, SampleInput, SampleSet, Samples, Vectors};

/// What is linear between joints.
const NUMBERS: [SampleInput; 6] = [
    SampleInput::U,
    SampleInput::S,
    SampleInput::Depth,
    SampleInput::HeadDepth,
    SampleInput::LightDistance,
    SampleInput::Pixels,
];
const VECTORS: [SampleInput; 5] = [
    SampleInput::Position,
    SampleInput::Forward,
    SampleInput::Normal,
    SampleInput::LightDirection,
    SampleInput::ViewDirection,
];

/// Room for the numbers of a joint, as many as [`OneByOne`] has: so no place is checked.
const WIDTH: usize = u32::BITS as usize;

const _: () = assert!(NUMBERS.len() + 3 * VECTORS.len() < WIDTH);

/// What samples are mixed of, a row of numbers for each joint: so that all of a joint lies together.
#[derive(Default)]
pub(super) struct JointRows {
    /// What is in a row, in order: first the numbers, then the vectors.
    numbers: Vec<SampleInput>,
    vectors: Vec<SampleInput>,
    /// All rows, one behind the other, and then [`WIDTH`] numbers of no row, so that as many can be read from where any row begins.
    rows: Vec<f32>,
}

impl JointRows {
    /// Those of a drawing's joints, in place of what was there.
    pub(super) fn fill(&mut self, painting: &Painting, joints: usize) {
        let read = painting.read_lists();
        for (list, all) in [
            (&mut self.numbers, &NUMBERS[..]),
            (&mut self.vectors, &VECTORS[..]),
        ] {
            list.clear();
            list.extend(all.iter().filter(|input| read.has(**input)));
        }
        let width = self.width();
        if width == 0 {
            self.rows.clear();
            return;
        }
        self.rows.resize(width * joints + WIDTH, 0.0);
        for (place, input) in self.numbers.iter().enumerate() {
            let numbers = numbers(&painting.joints, *input);
            for (row, number) in self.rows.chunks_exact_mut(width).zip(numbers) {
                row[place] = *number;
            }
        }
        for (i, input) in self.vectors.iter().enumerate() {
            let place = self.numbers.len() + 3 * i;
            let vectors = of_joints(&painting.joints, *input);
            for (row, vector) in self.rows.chunks_exact_mut(width).zip(vectors) {
                row[place..place + 3].copy_from_slice(&vector.to_array());
            }
        }
    }

    /// How many numbers a row has.
    #[inline(always)]
    fn width(&self) -> usize {
        self.numbers.len() + 3 * self.vectors.len()
    }

    /// That of a joint, and what is behind it.
    #[inline(always)]
    fn of(&self, joint: usize) -> &[f32; WIDTH] {
        let row = self.rows[joint * self.width()..].first_chunk();
        row.unwrap_or_else(|| unreachable!("there is room behind the last row"))
    }
}

/// A list of numbers of joints; empty of what isn't one.
fn numbers(joints: &Samples, input: SampleInput) -> &[f32] {
    match input {
        SampleInput::U => &joints.u,
        SampleInput::S => &joints.s,
        SampleInput::Depth => &joints.depth,
        SampleInput::HeadDepth => &joints.head_depth,
        SampleInput::LightDistance => &joints.light_distance,
        SampleInput::Pixels => &joints.pixels,
        _ => &[],
    }
}

/// A list of vectors of joints; empty of what isn't one.
fn of_joints(joints: &Samples, input: SampleInput) -> &[Vec3<f32>] {
    match input {
        SampleInput::Position => &joints.position,
        SampleInput::Forward => &joints.forward,
        SampleInput::Normal => &joints.normal,
        SampleInput::LightDirection => &joints.light_direction,
        SampleInput::ViewDirection => &joints.view_direction,
        _ => &[],
    }
}

/// Cells of a block.
pub(super) const SLOTS: usize = BLOCK / LANES;

/// A number of each sample of a block, by cells.
type Plane = [Lanes; SLOTS];

/// A vector of each sample of a block.
type Directions<'a> = [&'a [f32; BLOCK]; 3];

/// A block of samples while they are gathered.
pub(super) struct Mixed {
    /// As a joint's row, of each sample; vectors are no unit vectors yet.
    planes: [Plane; WIDTH],
    /// Which samples there are, and the first of the joints that they are mixed of.
    set: [LaneMask; SLOTS],
    joint: [[u32; LANES]; SLOTS],
    pub(super) samples: SampleBlock,
}

impl Mixed {
    pub(super) fn new() -> Self {
        Self {
            planes: [[[0.0; LANES]; SLOTS]; WIDTH],
            set: [[0; LANES]; SLOTS],
            joint: [[0; LANES]; SLOTS],
            samples: SampleBlock::NOTHING,
        }
    }

    /// Forgets the samples that were mixed.
    pub(super) fn clear(&mut self) {
        self.set = [[0; LANES]; SLOTS];
    }

    /// Some samples of a slot lie so far on the way from a joint to the next. Where they are the `FIRST` of the slot, the others of it become anything.
    #[inline(always)]
    pub(super) fn mix<const FIRST: bool>(
        &mut self,
        slot: usize,
        rows: &JointRows,
        [joint, next]: [usize; 2],
        way: &Lanes,
        lanes: &StoreMask,
    ) {
        let mut rest = *way;
        for k in 0..LANES {
            rest[k] = 1.0 - way[k];
        }
        lanes.add_to(&mut self.set[slot]);
        if FIRST {
            self.joint[slot] = [joint as u32; LANES];
        } else {
            lanes.store_ids(&[joint as u32; LANES], &mut self.joint[slot]);
        }
        if rows.rows.is_empty() {
            return; // nothing is read of joints that is linear between them
        }
        let put = |mixed: &Lanes, plane: &mut Lanes| match FIRST {
            true => *plane = *mixed,
            false => lanes.store(mixed, plane),
        };
        let (from, to) = (rows.of(joint), rows.of(next));
        let (numbers, width) = (rows.numbers.len(), rows.width());
        for i in OneByOne::of(&(0..numbers)) {
            let i = i % WIDTH; // one that compilers know to be there
            let mut mixed = *way;
            for k in 0..LANES {
                mixed[k] = from[i] + way[k] * (to[i] - from[i]);
            }
            put(&mixed, &mut self.planes[i][slot]);
        }
        for i in OneByOne::of(&(numbers..width)) {
            let i = i % WIDTH;
            let mut mixed = *way;
            for k in 0..LANES {
                mixed[k] = from[i] * rest[k] + to[i] * way[k];
            }
            put(&mixed, &mut self.planes[i][slot]);
        }
    }

    /// Works out what samples have of what was mixed, which is forgotten: the next block may be of another frame.
    #[inline(always)]
    pub(super) fn finish(&mut self, rows: &JointRows, joints: &Samples, read: SampleSet) {
        let Self {
            planes,
            set,
            joint,
            samples,
        } = self;
        let mixed = std::mem::replace(set, [[0; LANES]; SLOTS]);
        let (set, joint) = (flat(&mixed), flat(joint));
        let (numbers, vectors) = planes.split_at(rows.numbers.len());
        let (vectors, _) = vectors.as_chunks::<3>();
        let vectors = rows.vectors.iter().zip(vectors);
        for (input, plane) in rows.numbers.iter().zip(numbers) {
            let number = match input {
                SampleInput::U => &mut samples.u,
                SampleInput::S => &mut samples.s,
                SampleInput::Depth => &mut samples.depth,
                SampleInput::HeadDepth => &mut samples.head_depth,
                SampleInput::LightDistance => &mut samples.light_distance,
                _ => &mut samples.pixels,
            };
            *number = *flat(plane);
        }
        let mut tube = (None, None);
        for (input, [x, y, z]) in vectors {
            let mixed = [flat(x), flat(y), flat(z)];
            match input {
                SampleInput::Forward => tube.0 = Some(mixed),
                SampleInput::ViewDirection => tube.1 = Some(mixed),
                _ => {}
            }
            if !read.has(*input) {
                continue; // but by another layer, or for the tube alone
            }
            let unit = match input {
                SampleInput::Position => {
                    let [x, y, z] = mixed.map(|numbers| *numbers);
                    samples.position = Vectors { x, y, z };
                    continue;
                }
                SampleInput::Forward => &mut samples.forward,
                SampleInput::Normal => &mut samples.normal,
                SampleInput::LightDirection => &mut samples.light_direction,
                _ => &mut samples.view_direction,
            };
            if !make_unit(&mixed, set, unit) {
                // Joints that look against each other: as at the first one.
                let list = of_joints(joints, *input);
                for i in (0..BLOCK).filter(|i| set[*i] != 0) {
                    let vector = glam::Vec3::from_array(mixed.map(|numbers| numbers[i]));
                    let first = glam::Vec3::from_array(list[joint[i] as usize].to_array());
                    unit.set(i, vec3(vector.normalize_or(first).to_array()));
                }
            }
        }
        let of_joint = [
            SampleInput::Strand,
            SampleInput::Seed,
            SampleInput::Level,
            SampleInput::Time,
        ];
        for input in of_joint.into_iter().filter(|input| read.has(*input)) {
            for i in (0..BLOCK).filter(|i| set[*i] != 0) {
                let joint = joint[i] as usize;
                match input {
                    SampleInput::Strand => samples.strand[i] = joints.strand[joint],
                    SampleInput::Seed => samples.seed[i] = joints.seed[joint],
                    SampleInput::Level => samples.level[i] = joints.level[joint],
                    _ => samples.time[i] = joints.time[joint],
                }
            }
        }
        if let (true, (Some(forward), Some(to_eye))) = (read.has(SampleInput::Tube), tube) {
            make_tube(&forward, &to_eye, &samples.w, &mut samples.tube);
        }
    }
}

/// The numbers of a block's samples, which its cells have.
#[inline(always)]
fn flat<T>(cells: &[[T; LANES]; SLOTS]) -> &[T; BLOCK] {
    let flat = cells.as_flattened().try_into();
    flat.unwrap_or_else(|_| unreachable!("a block is {SLOTS} cells"))
}

/// 1 over the length of a vector, and whether there is such a number.
#[inline(always)]
fn inverse_length([x, y, z]: [f32; 3]) -> (f32, bool) {
    let inverse = 1.0 / (x * x + y * y + z * z).sqrt();
    (inverse, inverse.is_finite() & (inverse > 0.0))
}

/// The cross product.
#[inline(always)]
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - b[1] * a[2],
        a[2] * b[0] - b[2] * a[0],
        a[0] * b[1] - b[0] * a[1],
    ]
}

/// Makes unit vectors. Tells whether all that are set have one.
#[inline(always)]
fn make_unit(mixed: &Directions, set: &[u32; BLOCK], unit: &mut Vectors) -> bool {
    let mut lost = 0;
    for i in 0..BLOCK {
        let [x, y, z] = mixed.map(|numbers| numbers[i]);
        let (inverse, is_there) = inverse_length([x, y, z]);
        unit.x[i] = x * inverse;
        unit.y[i] = y * inverse;
        unit.z[i] = z * inverse;
        lost |= select(is_there, 0, set[i]);
    }
    lost == 0
}

/// [`tube_normal`](crate::features::tube_normal) of each sample; towards the eye where there is none.
#[inline(always)]
fn make_tube(forward: &Directions, to_eye: &Directions, w: &[f32; BLOCK], tube: &mut Vectors) {
    for i in 0..BLOCK {
        let (along, eye) = (
            forward.map(|numbers| numbers[i]),
            to_eye.map(|numbers| numbers[i]),
        );
        let across = cross(along, eye);
        let (inverse, has_side) = inverse_length(across);
        let across = across.map(|x| x * inverse);
        let facing = cross(across, along);
        let (inverse, has_front) = inverse_length(facing);
        let facing = facing.map(|x| x * inverse);
        let (inverse, has_eye) = inverse_length(eye);
        let front = greater(1.0 - w[i] * w[i], 0.0).sqrt();
        let normal = |axis: usize, otherwise: f32| {
            let round = w[i] * across[axis] + front * facing[axis];
            let flat = select(has_eye, eye[axis] * inverse, otherwise);
            select(has_side & has_front, round, flat)
        };
        tube.x[i] = normal(0, 0.0);
        tube.y[i] = normal(1, 0.0);
        tube.z[i] = normal(2, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::tube_normal;
    use glam::Vec3;

    /// Vectors of all directions and lengths, none among them.
    fn vectors(seed: u32) -> Vectors {
        let mut vectors = Vectors::NOTHING;
        for i in 0..BLOCK as u32 {
            let [x, y, z] = [0, 1, 2].map(|axis| effects::wgsl::random_signed(seed + axis, i));
            let size = [0.0, 1e-30, 1.0, 1e30][i as usize % 4];
            vectors.set(i as usize, vec3([size * x, size * y, size * z]));
        }
        vectors
    }

    fn directions(vectors: &Vectors) -> Directions<'_> {
        [&vectors.x, &vectors.y, &vectors.z]
    }

    #[test]
    fn lanes_are_as_single_vectors() {
        let (along, eye) = (vectors(1), vectors(9));
        let at = |vectors: &Vectors, i| Vec3::from_array(vectors.at(i).to_array());
        let w = std::array::from_fn(|i| i as f32 / 32.0 - 1.0);
        let (mut unit, mut tube) = (Vectors::NOTHING, Vectors::NOTHING);
        let all = [u32::MAX; BLOCK];
        assert!(!make_unit(&directions(&along), &all, &mut unit));
        make_tube(&directions(&along), &directions(&eye), &w, &mut tube);
        for i in 0..BLOCK {
            if let Some(expected) = at(&along, i).try_normalize() {
                assert_eq!(at(&unit, i), expected, "{i}");
            }
            let expected = tube_normal(at(&along, i), at(&eye, i), w[i]);
            let expected = expected.unwrap_or(at(&eye, i).normalize_or(Vec3::Z));
            assert_eq!(at(&tube, i), expected, "{i}");
        }
        // Those that have a length alone.
        let some = std::array::from_fn(|i| select(i % 4 == 2, u32::MAX, 0));
        assert!(make_unit(&directions(&along), &some, &mut unit));
    }
}
