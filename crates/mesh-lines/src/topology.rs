//! Which triangles are beside each other: half-edges, oriented alike.

mod sharp;

use crate::{MeshError, surface::check_positions};
use glam::{DVec3, Vec3};

/// No half-edge.
const NONE: u32 = u32::MAX;
/// The edge belongs to one triangle alone.
const BORDER: u32 = u32::MAX - 1;
/// The edge belongs to three triangles or more.
const NON_MANIFOLD: u32 = u32::MAX - 2;
/// So that three half-edges a triangle have numbers below the marks above.
const MOST_TRIANGLES: usize = 1 << 30;

/// What lies on the other side of a half-edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// One other triangle: its half-edge.
    Twin(u32),
    /// Nothing.
    Border,
    /// Two triangles or more.
    NonManifold,
    /// The triangle was left out.
    LeftOut,
}

/// Which triangles of a mesh are beside each other: one for all frames of a mesh that moves, made of the first or of the mesh at rest.
///
/// Half-edge `3 t + k` runs from corner `k` of triangle `t` to the next corner. What isn't a clean surface is read by these rules:
///
/// - A triangle with a corner twice, and one with the same three corners as a triangle before it, are left out: they keep their
///   number, and have no lines.
/// - Two triangles at an edge are neighbours whichever way they are wound. In each set of neighbours all are turned as most of them are;
///   where that can't be (a Möbius strip), each as the neighbour from which it was first reached. What is closed is turned outwards.
/// - At an edge of three triangles or more nobody is a neighbour; it is a crease.
/// - Triangles that meet in a vertex alone are no neighbours.
/// - Who aren't neighbours have one normal at a common vertex all the same, until [`Topology::with_creases`] parts them.
/// - Vertices of no triangle have no normal and no lines.
/// - Vertices with equal positions are different vertices: join them before, as `mesh_io::Welded` does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    vertices: usize,
    triangles: Vec<[u32; 3]>,
    /// Of each half-edge the one beside it, or a mark.
    beside: Vec<u32>,
    /// Of each edge with three triangles or more, its half-edges, together; edge after edge.
    non_manifold: Vec<Vec<u32>>,
    /// Half-edges sorted by the vertex from which they run, and where each vertex's begin.
    leaving: Vec<u32>,
    leaving_start: Vec<u32>,
    /// Of each triangle, whether the set of neighbours in which it is has no end anywhere.
    closed: Vec<bool>,
    /// Half-edges of sharp edges, in order.
    sharp: Vec<u32>,
    /// Of each triangle its smooth vertices, and of each of these the vertex. Empty where none is parted: then they are the vertices.
    smooth_corners: Vec<[u32; 3]>,
    smooth_vertices: Vec<u32>,
}

impl Topology {
    /// Reads the triangles of a mesh. About `n log n` in their number.
    ///
    /// # Errors
    ///
    /// When a triangle names a vertex that there isn't, a position isn't finite, or there are too many of either.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let vertices = positions.len();
        if triangles.len() > MOST_TRIANGLES || vertices > u32::MAX as usize {
            return Err(MeshError::TooLarge {
                triangles: triangles.len(),
                vertices,
            });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            for &vertex in corners {
                if vertex as usize >= vertices {
                    return Err(MeshError::Index {
                        triangle,
                        vertex,
                        vertices,
                    });
                }
            }
        }
        check_positions(positions)?;
        let mut topology = Self {
            vertices,
            closed: vec![true; triangles.len()],
            triangles: without_repeated(triangles),
            beside: vec![NONE; triangles.len() * 3],
            ..Self::default()
        };
        topology.find_twins();
        topology.orient(positions);
        topology.sort_by_origin();
        Ok(topology)
    }

    /// How many vertices the mesh has.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// The triangles, as many as were given and in their order, wound alike. One that was left out has three equal corners.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// True if the triangle counts.
    #[must_use]
    pub fn is_kept(&self, triangle: u32) -> bool {
        let [a, b, _] = self.triangles[triangle as usize];
        a != b
    }

    /// The vertices from which and to which a half-edge runs.
    #[must_use]
    pub fn ends(&self, half_edge: u32) -> [u32; 2] {
        let corners = self.triangles[half_edge as usize / 3];
        let corner = half_edge as usize % 3;
        [corners[corner], corners[(corner + 1) % 3]]
    }

    /// What lies on the other side of a half-edge.
    #[must_use]
    pub fn beside(&self, half_edge: u32) -> Beside {
        match self.beside[half_edge as usize] {
            NONE => Beside::LeftOut,
            BORDER => Beside::Border,
            NON_MANIFOLD => Beside::NonManifold,
            twin => Beside::Twin(twin),
        }
    }

    /// The edges with three triangles or more, each as its half-edges.
    #[must_use]
    pub fn non_manifold_edges(&self) -> &[Vec<u32>] {
        &self.non_manifold
    }

    /// The half-edges that run from a vertex: one for each triangle around it.
    #[must_use]
    pub fn around(&self, vertex: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|next| self.leaving_start[vertex as usize + next] as usize);
        &self.leaving[start..end]
    }

    /// True if the triangle is of a surface that has an inside, which nobody sees: no border, no edge of three triangles or more, two sides.
    #[must_use]
    pub fn is_closed(&self, triangle: u32) -> bool {
        self.closed[triangle as usize]
    }

    fn find_twins(&mut self) {
        let mut edges: Vec<(u32, u32, u32)> = (0..self.beside.len() as u32)
            .filter(|&half_edge| self.is_kept(half_edge / 3))
            .map(|half_edge| {
                let [from, to] = self.ends(half_edge);
                (from.min(to), from.max(to), half_edge)
            })
            .collect();
        edges.sort_unstable();
        for edge in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            match *edge {
                [(.., alone)] => self.beside[alone as usize] = BORDER,
                [(.., a), (.., b)] => {
                    self.beside[a as usize] = b;
                    self.beside[b as usize] = a;
                }
                _ => {
                    let half_edges: Vec<u32> =
                        edge.iter().map(|&(.., half_edge)| half_edge).collect();
                    for &half_edge in &half_edges {
                        self.beside[half_edge as usize] = NON_MANIFOLD;
                    }
                    self.non_manifold.push(half_edges);
                }
            }
        }
    }

    /// Turns triangles so that neighbours are wound alike, as most of them are.
    fn orient(&mut self, positions: &[Vec3]) {
        let mut reached = vec![false; self.triangles.len()];
        let mut turned = vec![false; self.triangles.len()];
        let mut set = Vec::new();
        for first in 0..self.triangles.len() as u32 {
            if reached[first as usize] {
                continue;
            }
            set.clear();
            set.push(first);
            reached[first as usize] = true;
            let mut next = 0;
            let mut closed = true;
            while let Some(&triangle) = set.get(next) {
                next += 1;
                for half_edge in triangle * 3..triangle * 3 + 3 {
                    let Beside::Twin(twin) = self.beside(half_edge) else {
                        closed = false;
                        continue;
                    };
                    let other = (twin / 3) as usize;
                    let is_alike = self.ends(half_edge)[0] != self.ends(twin)[0];
                    let as_here = turned[triangle as usize] == is_alike;
                    if !reached[other] {
                        reached[other] = true;
                        turned[other] = as_here;
                        set.push(other as u32);
                    } else if turned[other] != as_here {
                        // One-sided: no inside.
                        closed = false;
                    }
                }
            }
            let others = if closed {
                self.volume(positions, &set, &turned) < 0.0
            } else {
                let turns = set.iter().filter(|&&t| turned[t as usize]).count();
                turns * 2 > set.len()
            };
            if others {
                set.iter().for_each(|&t| turned[t as usize] ^= true);
            }
            set.iter().for_each(|&t| self.closed[t as usize] = closed);
        }
        self.turn(&turned);
    }

    /// Six times the volume within triangles, some of them turned.
    fn volume(&self, positions: &[Vec3], triangles: &[u32], turned: &[bool]) -> f64 {
        let place = |vertex: u32| positions[vertex as usize].as_dvec3();
        // From a point of their own, so that what is small and far away keeps its digits.
        let origin = place(self.triangles[triangles[0] as usize][0]);
        let volume = |&triangle: &u32| {
            let [a, b, c] = self.triangles[triangle as usize].map(|v| place(v) - origin);
            let volume: f64 = DVec3::cross(a, b).dot(c);
            if turned[triangle as usize] {
                -volume
            } else {
                volume
            }
        };
        triangles.iter().map(volume).sum()
    }

    /// Turns triangles, and gives their half-edges the numbers that they have then.
    fn turn(&mut self, turned: &[bool]) {
        if !turned.contains(&true) {
            return;
        }
        // Corners a, b, c become a, c, b: edges ab, bc, ca become ca, bc, ab.
        let renamed = |half_edge: u32| match half_edge {
            _ if half_edge >= NON_MANIFOLD || !turned[half_edge as usize / 3] => half_edge,
            _ => half_edge / 3 * 3 + (2 - half_edge % 3),
        };
        let before = self.beside.clone();
        for (half_edge, &twin) in before.iter().enumerate() {
            self.beside[renamed(half_edge as u32) as usize] = renamed(twin);
        }
        for edge in &mut self.non_manifold {
            edge.iter_mut()
                .for_each(|half_edge| *half_edge = renamed(*half_edge));
        }
        for (corners, _) in self
            .triangles
            .iter_mut()
            .zip(turned)
            .filter(|(_, turned)| **turned)
        {
            corners.swap(1, 2);
        }
    }

    fn sort_by_origin(&mut self) {
        let mut start = vec![0; self.vertices + 1];
        let kept = || (0..self.beside.len() as u32).filter(|half_edge| self.is_kept(half_edge / 3));
        for half_edge in kept() {
            start[self.ends(half_edge)[0] as usize + 1] += 1;
        }
        for vertex in 0..self.vertices {
            start[vertex + 1] += start[vertex];
        }
        let mut place = start.clone();
        let mut leaving = vec![0; start[self.vertices] as usize];
        for half_edge in kept() {
            let next = &mut place[self.ends(half_edge)[0] as usize];
            leaving[*next as usize] = half_edge;
            *next += 1;
        }
        (self.leaving, self.leaving_start) = (leaving, start);
    }
}

/// The triangles, where those that don't count have their first corner three times.
fn without_repeated(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut sorted: Vec<([u32; 3], u32)> = (0..)
        .zip(triangles)
        .map(|(number, corners)| {
            let mut corners = *corners;
            corners.sort_unstable();
            (corners, number)
        })
        .collect();
    sorted.sort_unstable();
    let mut kept = triangles.to_vec();
    for same in sorted.chunk_by(|a, b| a.0 == b.0) {
        let ([a, b, c], _) = same[0];
        let first_that_counts = usize::from(a != b && b != c);
        for &(_, number) in &same[first_that_counts..] {
            kept[number as usize] = [triangles[number as usize][0]; 3];
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TETRAHEDRON: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];

    #[test]
    fn a_tetrahedron_is_closed_whichever_way_its_faces_are_wound() {
        let right = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let reference = Topology::new(&TETRAHEDRON, &right).unwrap();
        for flipped in 0..4 {
            let mut triangles = right;
            triangles[flipped].swap(0, 1);
            let topology = Topology::new(&TETRAHEDRON, &triangles).unwrap();
            for t in 0..4 {
                let mut turned = topology.triangles()[t];
                let place = turned.iter().position(|v| *v == right[t][0]).unwrap();
                turned.rotate_left(place);
                assert_eq!(turned, right[t]);
            }
            for half_edge in 0..12 {
                let Beside::Twin(twin) = topology.beside(half_edge) else {
                    panic!("{half_edge} has no twin");
                };
                let [from, to] = topology.ends(half_edge);
                assert_eq!(topology.ends(twin), [to, from]);
            }
        }
        // All of them inside out are turned too.
        let inside_out = right.map(|[a, b, c]| [b, a, c]);
        let topology = Topology::new(&TETRAHEDRON, &inside_out).unwrap();
        assert!(
            (0..4).all(|t| topology.is_closed(t)
                && topology.triangles()[t as usize] != inside_out[t as usize])
        );
        assert_eq!(reference.triangles(), right);
        assert_eq!(reference.around(3).len(), 3);
    }

    #[test]
    fn what_is_no_surface_follows_the_rules() {
        // Three pages of a book, one of them twice, a triangle without area, and a lonely vertex.
        let triangles = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [3, 0, 1], [4, 4, 0]];
        let topology = Topology::new(&[Vec3::ZERO; 6], &triangles).unwrap();
        let kept: Vec<bool> = (0..5).map(|t| topology.is_kept(t)).collect();
        assert_eq!(kept, [true, true, true, false, false]);
        assert_eq!(topology.non_manifold_edges(), [vec![0, 3, 6]]);
        assert_eq!(topology.beside(0), Beside::NonManifold);
        assert_eq!(topology.beside(1), Beside::Border);
        assert_eq!(topology.beside(9), Beside::LeftOut);
        assert!(topology.around(5).is_empty());
        assert_eq!(
            Topology::new(&[Vec3::ZERO; 2], &[[0, 1, 2]]),
            Err(MeshError::Index {
                triangle: 0,
                vertex: 2,
                vertices: 2
            })
        );
        assert!(Topology::new(&[], &[]).unwrap().triangles().is_empty());
    }

    proptest! {
        #[test]
        fn twins_are_mutual_whatever_the_triangles(
            triangles in prop::collection::vec(prop::array::uniform3(0u32..9), 0..40),
        ) {
            let topology = Topology::new(&[Vec3::ZERO; 9], &triangles).unwrap();
            let mut left = 0;
            for half_edge in 0..triangles.len() as u32 * 3 {
                match topology.beside(half_edge) {
                    Beside::Twin(twin) => {
                        prop_assert_eq!(topology.beside(twin), Beside::Twin(half_edge));
                        let [mut a, mut b] = [topology.ends(half_edge), topology.ends(twin)];
                        a.sort_unstable();
                        b.sort_unstable();
                        prop_assert_eq!(a, b);
                    }
                    Beside::NonManifold => {
                        prop_assert!(topology.non_manifold_edges().iter().any(|edge| edge.contains(&half_edge)));
                    }
                    Beside::LeftOut => left += 1,
                    Beside::Border => {}
                }
            }
            let around: usize = (0..9).map(|vertex| topology.around(vertex).len()).sum();
            prop_assert_eq!(around + left, triangles.len() * 3);
        }
    }
}
