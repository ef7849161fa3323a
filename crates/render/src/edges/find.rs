//! Where lines begin: samples that neighbours of another id, depth or colour lie beside.
//!
//! Neighbours are samples of the same place in the pixels around. Rows may hold several samples of each column, one after the other, so that a sample's
//! left neighbour is `STEP` numbers before it; and all of them have a column more on either side, which is the outermost one again at the picture's border, so
//! that no sample there has a neighbour that differs.

/// Numbers that are looked at at once: rows of marks are as many, or a multiple.
pub(crate) const SOME: usize = 16;

/// Ids of a row of pixels, or the bits of its numbers, and those above and below it. Each has `STEP` more than there are marks on either side.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub(crate) above: &'a [u32],
    pub(crate) own: &'a [u32],
    pub(crate) below: &'a [u32],
}

impl<'a> Rows<'a> {
    /// None at all.
    pub(crate) const NONE: Self = Self {
        above: &[],
        own: &[],
        below: &[],
    };

    /// All three, of one length, so that places are checked once.
    #[inline(always)]
    fn of_length(&self, length: usize) -> [&'a [u32]; 3] {
        let Self { above, own, below } = *self;
        [&above[..length], &own[..length], &below[..length]]
    }
}

/// What is found of: rows that a channel doesn't ask for may be [none](Rows::NONE).
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    pub(crate) objects: Rows<'a>,
    pub(crate) ids: Rows<'a>,
    pub(crate) inv_depths: Rows<'a>,
    pub(crate) components: [Rows<'a>; 3],
}

/// Working memory.
#[derive(Default)]
pub(crate) struct Scratch {
    differ: Vec<u32>,
    farthest: Vec<f32>,
}

/// Both values are worked out and one is taken, so that loops are vector instructions.
#[inline(always)]
fn select<T>(condition: bool, then: T, otherwise: T) -> T {
    std::hint::select_unpredictable(condition, then, otherwise)
}

#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    select(b < a, b, a)
}

#[inline(always)]
fn some(row: &[u32], start: usize) -> [u32; SOME] {
    let mut some = [row[start]; SOME];
    some.copy_from_slice(&row[start..start + SOME]);
    some
}

/// What bits stand for.
#[inline(always)]
fn numbers(bits: [u32; SOME]) -> [f32; SOME] {
    let mut numbers = [0.0; SOME];
    for k in 0..SOME {
        numbers[k] = f32::from_bits(bits[k]);
    }
    numbers
}

/// Marks samples beside others of another id that aren't in front of them. What is equally near belongs to the greater object, then the greater id. Where
/// `is_of_hair`, only what has hair on one side counts.
///
/// `SAME` where ids that are the same are so of the same object, but for what is drawn nowhere: objects aren't looked at then before ids differ.
#[inline(always)] // compiled for the best instructions, as all here
pub(crate) fn ids<const STEP: usize, const SAME: bool>(
    around: &Around,
    is_of_hair: bool,
    scratch: &mut Scratch,
    marks: &mut [u32],
) {
    let length = marks.len() + 2 * STEP;
    let objects = around.objects.of_length(length);
    let ids = around.ids.of_length(length);
    let depths = around.inv_depths.of_length(length);
    // Nine are alike where the three of each column are, and those of the middle row.
    scratch.differ.resize(length, 0);
    let differ = &mut scratch.differ[..length];
    for i in 0..length {
        differ[i] = (ids[0][i] ^ ids[1][i]) | (ids[2][i] ^ ids[1][i]);
        if !SAME {
            differ[i] |= (objects[0][i] ^ objects[1][i]) | (objects[2][i] ^ objects[1][i]);
        }
    }
    let is_hair = u32::from(!is_of_hair); // as all then counts as hair, whose objects are odd
    let (marks, _) = marks.as_chunks_mut::<SOME>();
    for (number, marks) in marks.iter_mut().enumerate() {
        let start = number * SOME;
        let id = some(ids[1], start + STEP);
        let object = some(objects[1], start + STEP);
        let mut any = 0;
        for k in 0..SOME {
            let [left, right] = [start + k, start + k + 2 * STEP];
            any |= differ[left] | differ[left + STEP] | differ[right];
            any |= (ids[1][left] ^ id[k]) | (ids[1][right] ^ id[k]);
            if !SAME {
                any |= (objects[1][left] ^ object[k]) | (objects[1][right] ^ object[k]);
            }
        }
        *marks = [0; SOME];
        if any == 0 {
            continue;
        }
        let depth = numbers(some(depths[1], start + STEP));
        for row in 0..3 {
            for column in 0..3 {
                let at = start + column * STEP;
                let (its_object, its_id) = (some(objects[row], at), some(ids[row], at));
                let its_depth = numbers(some(depths[row], at));
                for k in 0..SOME {
                    let is_other = (its_object[k] != object[k]) | (its_id[k] != id[k]);
                    let is_drawn = (its_object[k] | object[k] | is_hair) & 1 != 0;
                    let is_greater = (object[k] > its_object[k])
                        | ((object[k] == its_object[k]) & (id[k] > its_id[k]));
                    let is_front =
                        (depth[k] > its_depth[k]) | ((depth[k] == its_depth[k]) & is_greater);
                    marks[k] |= select(is_other & is_drawn & is_front, 1, 0);
                }
            }
        }
    }
}

/// Marks samples with one around them that is farther by more than a step, metres.
#[inline(always)]
pub(crate) fn steps<const STEP: usize>(
    around: &Around,
    step_m: f32,
    scratch: &mut Scratch,
    marks: &mut [u32],
) {
    let length = marks.len() + 2 * STEP;
    let [above, own, below] = around.inv_depths.of_length(length);
    scratch.farthest.resize(length, 0.0);
    let farthest = &mut scratch.farthest[..length];
    for i in 0..length {
        let [above, own, below] = [above[i], own[i], below[i]].map(f32::from_bits);
        farthest[i] = lesser(lesser(above, own), below);
    }
    // Farther than own / (1 + own * step), in inverse depths; nothing is infinitely far. What is grows with the other's inverse depth, also
    // in single precision, so that it is enough to ask of the farthest of nine.
    for i in 0..marks.len() {
        let of_nine = lesser(
            lesser(farthest[i], farthest[i + STEP]),
            farthest[i + 2 * STEP],
        );
        let own = f32::from_bits(own[i + STEP]);
        marks[i] = select(of_nine * (1.0 + own * step_m) < own, 1, 0);
    }
}

/// Marks samples where the squares of Sobel's filters of three components exceed a threshold, squared already.
#[inline(always)]
pub(crate) fn sobel<const STEP: usize>(around: &Around, square: f32, marks: &mut [u32]) {
    let length = marks.len() + 2 * STEP;
    let components = around.components.map(|rows| rows.of_length(length));
    for i in 0..marks.len() {
        let (middle, right) = (i + STEP, i + 2 * STEP);
        let mut sum = 0.0;
        for [above, own, below] in components {
            let across = |row: &[u32]| f32::from_bits(row[right]) - f32::from_bits(row[i]);
            let down = |x: usize| f32::from_bits(below[x]) - f32::from_bits(above[x]);
            let h = across(above) + 2.0 * across(own) + across(below);
            let v = down(i) + 2.0 * down(middle) + down(right);
            sum += h * h + v * v;
        }
        marks[i] = select(sum > square, 1, 0);
    }
}

/// The places of the marks, most of which are 0.
pub(crate) fn marked(marks: &[u32]) -> impl Iterator<Item = usize> {
    let (some, _) = marks.as_chunks::<SOME>();
    let some = some.iter().enumerate();
    let some = some.filter(|(_, marks)| marks.iter().fold(0, |all, mark| all | mark) != 0);
    some.flat_map(|(number, marks)| {
        let places = (number * SOME..).zip(marks);
        places.filter_map(|(place, mark)| (*mark != 0).then_some(place))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Columns of a row of pixels.
    const WIDTH: usize = 16;

    /// Three rows of [`WIDTH`] pixels with a column more on either side, `step` numbers a pixel.
    fn three(step: usize, value: impl Fn(usize, usize) -> u32) -> [Vec<u32>; 3] {
        [0, 1, 2].map(|row| (0..(WIDTH + 2) * step).map(|i| value(row, i)).collect())
    }

    fn rows([above, own, below]: &[Vec<u32>; 3]) -> Rows<'_> {
        Rows { above, own, below }
    }

    /// The marks of a rule that asks of a sample, by its place in a row, and one of the nine around it, by row and place.
    fn of_pairs(step: usize, is_marked: impl Fn(usize, [usize; 2]) -> bool) -> Vec<u32> {
        let marks = (step..(WIDTH + 1) * step).map(|own| {
            let columns = [own - step, own, own + step];
            let mut around = (0..3).flat_map(|row| columns.map(|at| [row, at]));
            u32::from(around.any(|other| is_marked(own, other)))
        });
        marks.collect()
    }

    fn found(step: usize, mark: impl Fn(&mut [u32])) -> Vec<u32> {
        let mut marks = vec![7; WIDTH * step];
        mark(&mut marks);
        let places: Vec<usize> = (0..marks.len()).filter(|i| marks[*i] != 0).collect();
        assert_eq!(marked(&marks).collect::<Vec<_>>(), places);
        marks
    }

    proptest! {
        #[test]
        fn ids_are_those_of_pairs(
            numbers in prop::collection::vec(0..1000_u32, 61),
            likely in 2..8_u32,
        ) {
            let some = |row: usize, i: usize, of: usize| numbers[(row * 7919 + i * 104_729 + of * 31) % 61];
            let mut count = [0, 0];
            for step in [1, 2, 4, 8] {
                // Most neighbours are alike: they change every few columns.
                let place = |i: usize| i / step / likely as usize;
                let objects = three(step, |row, i| some(row / 2, place(i), 0) % 4);
                let ids = three(step, |row, i| some(row / 2, place(i) + i % step, 1) % 3);
                let depths = three(step, |row, i| (1.0 + (some(row, i, 2) % 3) as f32).to_bits());
                let around = Around {
                    objects: rows(&objects),
                    ids: rows(&ids),
                    inv_depths: rows(&depths),
                    components: [Rows::NONE; 3],
                };
                for is_of_hair in [false, true] {
                    let key = |row: usize, at: usize| (objects[row][at], ids[row][at]);
                    let depth = |row: usize, at: usize| f32::from_bits(depths[row][at]);
                    let expected = of_pairs(step, |own, [row, at]| {
                        let (mine, other) = (key(1, own), key(row, at));
                        let is_drawn = !is_of_hair || mine.0 % 2 == 1 || other.0 % 2 == 1;
                        mine != other && is_drawn && (depth(1, own), mine) > (depth(row, at), other)
                    });
                    let marks = found(step, |marks| {
                        let mut scratch = Scratch::default();
                        match step {
                            1 => super::ids::<1, false>(&around, is_of_hair, &mut scratch, marks),
                            2 => super::ids::<2, false>(&around, is_of_hair, &mut scratch, marks),
                            4 => super::ids::<4, false>(&around, is_of_hair, &mut scratch, marks),
                            _ => super::ids::<8, false>(&around, is_of_hair, &mut scratch, marks),
                        }
                    });
                    for mark in &expected {
                        count[*mark as usize] += 1;
                    }
                    prop_assert_eq!(marks, expected);
                }
            }
            prop_assume!(count.iter().all(|count| *count > 0));
        }

        #[test]
        fn steps_are_those_of_pairs(numbers in prop::collection::vec(0..13_u32, 61)) {
            let step_m = 0.1;
            // 0 where nothing is.
            let depths = |step: usize| three(step, |row, i| match numbers[(row * 7919 + i * 104_729) % 61] {
                0 => 0,
                n => (1.0 + 0.04 * n as f32).to_bits(),
            });
            let [one, four] = [1, 4].map(depths);
            for (step, depths) in [(1, one), (4, four)] {
                let expected = of_pairs(step, |own, [row, at]| {
                    let (own, other) = (f32::from_bits(depths[1][own]), f32::from_bits(depths[row][at]));
                    other * (1.0 + own * step_m) < own
                });
                let around = Around {
                    objects: Rows::NONE,
                    ids: Rows::NONE,
                    inv_depths: rows(&depths),
                    components: [Rows::NONE; 3],
                };
                let marks = found(step, |marks| match step {
                    1 => steps::<1>(&around, step_m, &mut Scratch::default(), marks),
                    _ => steps::<4>(&around, step_m, &mut Scratch::default(), marks),
                });
                prop_assert_eq!(marks, expected);
            }
        }
    }
}
