//! The thin fine hair stroke (5.5): lines on paths of their own, across clumps and out of the silhouette.

use effects::wgsl::{hash, random, random_signed, sin_pi};
use effects::{Grid, Hair, HairStrand, MOST_PATHS, MadePaths, strand_seed};
use glam::Vec3;
use rayon::prelude::*;

effects::effect!("fine");

/// `hair.fine`: each hair begins at a strand and wanders to a neighbour, lifting off on its way.
pub struct Fine;

/// Points of a hair's path: it bends less than the strand that it follows.
const POINTS: u32 = 12;

/// Where along its strand a hair begins at the earliest: roots lie under other hair, and bend sharply.
const FIRST: f32 = 0.1;

/// How far along its strand a hair may reach: a little beyond the tip.
const BEYOND: f32 = 1.08;

/// Half waves that a hair swings at least and at most.
const HALF_WAVES: [f32; 2] = [1.0, 3.0];

impl effects::StrokeEffect for Fine {
    type Program = Program;
    const ID: &'static str = "hair.fine";
    const DOC: &'static str = "fine hairs: thin lines across clumps and past the silhouette";
    const RANK: i32 = 300;
    /// They lie on the hair that they cross.
    const DEPTH_OFFSET: f32 = -0.06;
    const OWN_PATHS: bool = true;

    fn make_paths(params: &Params, hair: &Hair, seed: u32, paths: &mut MadePaths) {
        let neighbours = paths.once(|| Neighbours::of(params, hair, seed));
        paths.push_each(hair.strands.len(), |index, paths| {
            let strand = &hair.strands[index];
            let neighbours = &neighbours.of_strands[index];
            for hair_number in 0..hairs_of(params, strand, seed) {
                let seed = hash(strand_seed(seed, strand.id) ^ hash(hair_number));
                let line = FineHair::new(params, seed);
                let choice = (line.choice * neighbours.len() as f32) as usize;
                let neighbour = neighbours.get(choice).map(|&i| &hair.strands[i as usize]);
                let points = (0..POINTS).map(|i| i as f32 / (POINTS - 1) as f32);
                let points = points.map(|t| line.point(t, hair, strand, neighbour));
                paths.push(index, hair_number, points);
            }
        });
    }

    fn reach(params: &Params) -> effects::Reach {
        effects::Reach {
            clumps: 0.0,
            units: params.width,
        }
    }
}

/// How many hairs a strand has. A half hair is there for every other strand.
fn hairs_of(params: &Params, strand: &HairStrand, seed: u32) -> u32 {
    if strand.particles.len() < 2 || !strand.is_drawn {
        return 0;
    }
    let own = random(strand_seed(seed, strand.id), MOST_PATHS);
    ((params.per_strand + own) as u32).min(MOST_PATHS)
}

/// Which strands run beside each strand that has hairs, the nearest first.
struct Neighbours {
    of_strands: Vec<Vec<u32>>,
}

impl Neighbours {
    fn of(params: &Params, hair: &Hair, seed: u32) -> Self {
        let all = AllAtRest::of(hair);
        let of_strand = |(index, strand)| match hairs_of(params, strand, seed) {
            0 => Vec::new(),
            _ => all.nearest(index, params.neighbours as usize),
        };
        let strands = hair.strands.par_iter().enumerate();
        Self {
            of_strands: strands.map(of_strand).collect(),
        }
    }
}

/// A strand's root, middle and tip at rest.
type AtRest = [Vec3; 3];

fn at_rest(strand: &HairStrand) -> AtRest {
    [0.0, 0.5, 1.0].map(|u| strand.point_at_rest(u))
}

/// All strands at rest.
struct AllAtRest {
    places: Vec<AtRest>,
    /// By their middles.
    grid: Grid,
}

impl AllAtRest {
    fn of(hair: &Hair) -> Self {
        let places: Vec<AtRest> = hair.strands.iter().map(at_rest).collect();
        let middles = places.iter().map(|place| place[1]).enumerate();
        // Some strands in each cube: the surface that they are on has about so many squares of this size.
        let (low, high) = (places.iter()).fold((Vec3::MAX, Vec3::MIN), |(low, high), place| {
            (low.min(place[1]), high.max(place[1]))
        });
        let edge_m = 4.0 * (high - low).max_element() / (places.len() as f32).sqrt().max(1.0);
        let grid = Grid::new(middles, edge_m.max(1e-4));
        Self { places, grid }
    }

    /// The `number` strands that run beside strand `index` at rest, the nearest first: their roots, middles and tips are near.
    fn nearest(&self, index: usize, number: usize) -> Vec<u32> {
        let own = self.places[index];
        // No less than how far their middles are.
        let distance = |place: &AtRest| -> f32 {
            let pairs = own.iter().zip(place);
            pairs.map(|(a, b)| a.distance(*b)).sum()
        };
        let nearest = self.grid.nearest(own[1], number, |other| {
            (other != index).then(|| distance(&self.places[other]))
        });
        nearest.into_iter().map(|other| other as u32).collect()
    }
}

/// What was chosen for one hair, the same in every frame.
struct FineHair {
    /// Where along the strand it begins and ends.
    start: f32,
    end: f32,
    /// Which neighbour, from 0 to 1.
    choice: f32,
    /// Part of the way to the neighbour at its root and at its tip.
    way: [f32; 2],
    /// How far its tip stands off and how far it swings, head heights.
    lift: f32,
    wave: f32,
    phase: f32,
    half_waves: f32,
}

impl FineHair {
    fn new(params: &Params, seed: u32) -> Self {
        let between = |a: f32, b: f32, i: u32| a + (b - a) * random(seed, i);
        let start = between(FIRST, params.latest_start.max(FIRST), 0);
        let length = between(params.shortest_length, params.longest_length, 1);
        Self {
            start,
            end: (start + length).min(BEYOND),
            choice: random(seed, 2),
            way: [
                0.3 * params.crossing * random_signed(seed, 3),
                params.crossing * between(0.3, 1.0, 4),
            ],
            // Few stand off far.
            lift: params.lift * random(seed, 5) * random(seed, 6),
            wave: params.wave * random_signed(seed, 7),
            phase: random(seed, 8),
            half_waves: between(HALF_WAVES[0], HALF_WAVES[1], 9),
        }
    }

    /// The point at `t` of its way, from 0 to 1, metres.
    fn point(&self, t: f32, hair: &Hair, strand: &HairStrand, other: Option<&HairStrand>) -> Vec3 {
        let u = self.start + (self.end - self.start) * t;
        let here = strand.point(u);
        let eased = t * t * (3.0 - 2.0 * t);
        let way = self.way[0] + (self.way[1] - self.way[0]) * eased;
        let there = other.map_or(here, |other| other.point(u));
        let point = here + way * (there - here);
        let along = (strand.point(u + 0.05) - strand.point(u - 0.05)).normalize_or(Vec3::NEG_Y);
        // Off the hair: away from the head, across the strand.
        let out = (here - hair.head_center).reject_from_normalized(along);
        let out = out.normalize_or(along.any_orthonormal_vector());
        let side = along.cross(out);
        let swing = self.wave * sin_pi(self.phase + self.half_waves * t) * eased;
        // On top of the clump, whose middle the strand is.
        let on_top = 0.5 * strand.size / 300.0 * sin_pi(t);
        point + hair.head_height_m * ((self.lift * t * t + on_top) * out + swing * side)
    }
}
