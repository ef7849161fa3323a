//! The clump: size profile, normal and basic colour of a strand, shared by all layers
//! (`shaders/clump.wgsl`).

use crate::joints::{Joints, LANES};
use crate::lanes::widest;
use crate::program::Parameters as _;
use crate::varied::Varied;
use crate::wgsl::{Clump, vec3};

effects::effect!("clump");

impl Varied<Program> {
    /// Sets the clumps of the joints from `first` on, block by block. `seed` is that of the clump.
    pub fn clumps(&self, joints: &Joints, first: usize, seed: u32, clumps: &mut [Clump]) {
        let mut numbers = self.numbers();
        // A row for each number of a clump, so that vector instructions store them.
        let mut rows = [[0.0; LANES]; 10];
        widest(
            #[inline(always)]
            || {
                for (k, clumps) in clumps.chunks_mut(LANES).enumerate() {
                    let first = first + k * LANES;
                    let block = first..first + clumps.len();
                    if self.varies() {
                        self.fill(&mut numbers, joints, first, seed);
                        let params = Program::with_numbers(self.base(), &numbers);
                        Program::clumps(
                            joints,
                            block,
                            seed,
                            params,
                            #[inline(always)]
                            |lane, clump| put(&mut rows, lane, clump),
                        );
                    } else {
                        Program::clumps(
                            joints,
                            block,
                            seed,
                            #[inline(always)]
                            |_| *self.base(),
                            #[inline(always)]
                            |lane, clump| put(&mut rows, lane, clump),
                        );
                    }
                    for (lane, clump) in clumps.iter_mut().enumerate() {
                        *clump = take(&rows, lane);
                    }
                }
            },
        );
    }
}

/// Sets the rows of one clump.
#[inline(always)]
fn put(rows: &mut [[f32; LANES]; 10], lane: usize, clump: Clump) {
    let triples = [clump.normal, clump.color, clump.shift];
    for (k, triple) in triples.into_iter().enumerate() {
        rows[3 * k][lane] = triple.x;
        rows[3 * k + 1][lane] = triple.y;
        rows[3 * k + 2][lane] = triple.z;
    }
    rows[9][lane] = clump.radius;
}

/// The clump that these rows have.
#[inline(always)]
fn take(rows: &[[f32; LANES]; 10], lane: usize) -> Clump {
    let triple = |row: usize| vec3([rows[row][lane], rows[row + 1][lane], rows[row + 2][lane]]);
    Clump {
        normal: triple(0),
        color: triple(3),
        shift: triple(6),
        radius: rows[9][lane],
    }
}
