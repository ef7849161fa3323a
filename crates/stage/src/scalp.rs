//! Where a head has hair: what of its mesh is seen between clumps in the hair's colour, so that gaps are no bald spots.

use glam::{IVec3, Vec3};
use std::collections::{HashMap, HashSet};

/// Bare places in the hair are scalp too, up to this share of its area.
const LARGEST_GAP: f32 = 0.25;

/// A mesh whose triangles are cut along the hairline, which lies `reach_m` from the outermost roots, in a smooth line whatever the
/// triangles' size.
pub(crate) struct Split {
    /// Corners of the cuts: the two corners of the mesh that each lies between, and its share of the way.
    pub between: Vec<([u32; 2], f32)>,
    /// Triangles that have hair, and those that have none. Corners beyond the mesh's own are those of `between`.
    pub triangles: [Vec<[u32; 3]>; 2],
}

/// Tells the part of a mesh that has hair from the part that has none.
pub(crate) fn split(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    roots: &[Vec3],
    reach_m: f32,
) -> Split {
    let roots = Roots::new(roots, reach_m);
    // Above 0 within the hairline.
    let inside: Vec<f32> = positions
        .iter()
        .map(|p| reach_m - roots.distance(*p))
        .collect();
    let mut cuts = Cuts {
        first: positions.len() as u32,
        inside: &inside,
        between: Vec::new(),
        of_edge: HashMap::new(),
    };
    let (mut scalp, mut skin) = (Vec::new(), Vec::new());
    for triangle in triangles {
        let has_hair = triangle.map(|i| inside[i as usize] > 0.0);
        match has_hair.iter().filter(|has| **has).count() {
            3 => scalp.push(*triangle),
            0 => skin.push(*triangle),
            count => {
                // The corner that is alone on its side of the line first.
                let alone = has_hair.iter().position(|has| *has == (count == 1));
                let [a, b, c] = turned(*triangle, alone.unwrap_or(0));
                let [ab, ac] = [cuts.corner(a, b), cuts.corner(a, c)];
                let (of_one, of_two) = match count {
                    1 => (&mut scalp, &mut skin),
                    _ => (&mut skin, &mut scalp),
                };
                of_one.push([a, ab, ac]);
                of_two.extend([[ab, b, c], [ab, c, ac]]);
            }
        }
    }
    let between = cuts.between;
    let place = |i: u32| match positions.get(i as usize) {
        Some(place) => *place,
        None => {
            let ([a, b], t) = between[i as usize - positions.len()];
            positions[a as usize].lerp(positions[b as usize], t)
        }
    };
    fill_gaps(&mut scalp, &mut skin, place);
    Split {
        between,
        triangles: [scalp, skin],
    }
}

/// The same triangle from its corner `first` on.
fn turned(triangle: [u32; 3], first: usize) -> [u32; 3] {
    [0, 1, 2].map(|i| triangle[(first + i) % 3])
}

/// Corners on the line, one an edge.
struct Cuts<'a> {
    first: u32,
    inside: &'a [f32],
    between: Vec<([u32; 2], f32)>,
    of_edge: HashMap<[u32; 2], u32>,
}

impl Cuts<'_> {
    fn corner(&mut self, a: u32, b: u32) -> u32 {
        let edge = [a.min(b), a.max(b)];
        *self.of_edge.entry(edge).or_insert_with(|| {
            let [from, to] = edge.map(|i| self.inside[i as usize]);
            self.between.push((edge, from / (from - to)));
            self.first + self.between.len() as u32 - 1
        })
    }
}

/// Distances to the nearest root, up to twice the reach.
struct Roots {
    cells: HashMap<IVec3, Vec<Vec3>>,
    farthest_m: f32,
}

impl Roots {
    fn new(roots: &[Vec3], reach_m: f32) -> Self {
        let mut roots_of = Self {
            cells: HashMap::new(),
            farthest_m: 2.0 * reach_m,
        };
        for root in roots {
            let cell = roots_of.cell(*root);
            roots_of.cells.entry(cell).or_default().push(*root);
        }
        roots_of
    }

    fn cell(&self, point: Vec3) -> IVec3 {
        (point / self.farthest_m).floor().as_ivec3()
    }

    fn distance(&self, point: Vec3) -> f32 {
        let middle = self.cell(point);
        // Saturating, as places may lie any number of cells away.
        let around =
            (0..27).map(|i| middle.saturating_add(IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
        let roots = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let squared = roots.map(|root| root.distance_squared(point));
        squared
            .fold(self.farthest_m * self.farthest_m, f32::min)
            .sqrt()
    }
}

/// Bare places that the scalp surrounds become scalp, where they are small beside it.
fn fill_gaps(scalp: &mut Vec<[u32; 3]>, skin: &mut Vec<[u32; 3]>, place: impl Fn(u32) -> Vec3) {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(&place);
        0.5 * (b - a).cross(c - a).length()
    };
    let mut islands = Islands::default();
    for [a, b, c] in &*skin {
        islands.join(*a, *b);
        islands.join(*b, *c);
    }
    // Corners of the hairline have triangles on both sides; skin that has none of them is no gap.
    let mut at_hair: HashSet<u32> = HashSet::new();
    for corner in scalp.iter().flatten() {
        if islands.parent.contains_key(corner) {
            at_hair.insert(islands.find(*corner));
        }
    }
    let mut areas: HashMap<u32, f32> = HashMap::new();
    for triangle in &*skin {
        *areas.entry(islands.find(triangle[0])).or_default() += area(triangle);
    }
    let most = LARGEST_GAP * scalp.iter().map(area).sum::<f32>();
    let is_gap = |triangle: &[u32; 3]| {
        let island = islands.find(triangle[0]);
        at_hair.contains(&island) && areas[&island] < most
    };
    let (gaps, bare): (Vec<_>, Vec<_>) = skin.iter().partition(|triangle| is_gap(triangle));
    *skin = bare;
    scalp.extend(gaps);
}

/// Corners that triangles join.
#[derive(Default)]
struct Islands {
    parent: HashMap<u32, u32>,
}

impl Islands {
    fn find(&self, mut corner: u32) -> u32 {
        while let Some(parent) = self.parent.get(&corner).filter(|parent| **parent != corner) {
            corner = *parent;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let roots = [a, b].map(|corner| {
            self.parent.entry(corner).or_insert(corner);
            self.find(corner)
        });
        let root = roots[0].min(roots[1]);
        // All corners on both ways lead straight there from now on.
        for mut corner in [a, b] {
            while let Some(parent) = self.parent.insert(corner, root).filter(|p| *p != corner) {
                corner = parent;
            }
        }
        self.parent.insert(root, root);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hair_io::Mesh;

    /// A strip of squares along x, 1 wide.
    fn strip(length: u32) -> Mesh {
        let corners = 2 * (length + 1);
        let positions = (0..corners).map(|i| Vec3::new((i / 2) as f32, (i % 2) as f32, 0.0));
        let triangles = (0..corners - 2).map(|i| match i % 2 {
            0 => [i, i + 1, i + 2],
            _ => [i + 1, i, i + 2],
        });
        Mesh {
            positions: positions.collect(),
            normals: vec![Vec3::Z; corners as usize],
            triangles: triangles.collect(),
        }
    }

    fn places(mesh: &Mesh, split: &Split) -> Vec<Vec3> {
        let cut = split
            .between
            .iter()
            .map(|([a, b], t)| mesh.positions[*a as usize].lerp(mesh.positions[*b as usize], *t));
        mesh.positions.iter().copied().chain(cut).collect()
    }

    fn area(places: &[Vec3], triangles: &[[u32; 3]]) -> f32 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| places[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        triangles.iter().map(of).sum()
    }

    #[test]
    fn the_hairline_cuts_triangles() {
        let mesh = strip(9);
        let roots = [Vec3::new(0.0, 0.5, 0.0), Vec3::new(2.0, 0.5, 0.0)];
        let split = split(&mesh.positions, &mesh.triangles, &roots, 2.5);
        let places = places(&mesh, &split);
        // Both sides of the line together are the mesh, facing as before.
        let [scalp, skin] = split.triangles.each_ref().map(|t| area(&places, t));
        assert!((scalp + skin - 9.0).abs() < 1e-4, "{scalp} {skin}");
        for triangle in split.triangles.iter().flatten() {
            let [a, b, c] = triangle.map(|i| places[i as usize]);
            assert!((b - a).cross(c - a).z <= 0.0 || mesh.triangles.contains(triangle));
        }
        // The line is where the last root reaches to: a little beyond x = 4.4.
        assert!((4.3..4.6).contains(&scalp), "{scalp}");
        for place in &places[mesh.positions.len()..] {
            assert!((place.distance(roots[1]) - 2.5).abs() < 0.1, "{place}");
        }
    }

    #[test]
    fn nothing_is_scalp_without_roots() {
        let mesh = strip(9);
        for roots in [&[][..], &[Vec3::MAX, Vec3::MIN]] {
            let split = split(&mesh.positions, &mesh.triangles, roots, 1e-3);
            assert!(split.triangles[0].is_empty() && split.between.is_empty());
            assert_eq!(split.triangles[1], mesh.triangles);
        }
    }

    #[test]
    fn a_gap_in_the_hair_is_scalp() {
        // A disc of rings around one corner, and far away another piece of skin.
        let (rings, around) = (8_u32, 24_u32);
        let mut positions = vec![Vec3::ZERO];
        let mut triangles = Vec::new();
        for ring in 1..=rings {
            for i in 0..around {
                let turn = std::f32::consts::TAU * i as f32 / around as f32;
                positions.push(ring as f32 * Vec3::new(turn.cos(), turn.sin(), 0.0));
                let corner = |ring: u32, i: u32| match ring {
                    0 => 0,
                    _ => 1 + (ring - 1) * around + i % around,
                };
                let [a, b] = [corner(ring - 1, i), corner(ring - 1, i + 1)];
                let [c, d] = [corner(ring, i), corner(ring, i + 1)];
                triangles.push([a, c, d]);
                if ring > 1 {
                    triangles.push([a, d, b]);
                }
            }
        }
        let first = positions.len() as u32;
        positions.extend([Vec3::X * 50.0, Vec3::X * 51.0, Vec3::new(50.0, 1.0, 0.0)]);
        triangles.push([first, first + 1, first + 2]);
        let mesh = Mesh {
            normals: vec![Vec3::Z; positions.len()],
            positions,
            triangles,
        };
        // Roots on a ring: bare inside it, and outside.
        let roots: Vec<Vec3> = (0..48)
            .map(|i| {
                let turn = std::f32::consts::TAU * i as f32 / 48.0;
                4.0 * Vec3::new(turn.cos(), turn.sin(), 0.0)
            })
            .collect();
        let split = split(&mesh.positions, &mesh.triangles, &roots, 2.5);
        let [scalp, skin] = &split.triangles;
        assert!(
            scalp.iter().flatten().any(|i| *i == 0),
            "the middle is a gap"
        );
        assert!(skin.contains(&[first, first + 1, first + 2]));
        let rim = first - 1;
        assert!(skin.iter().flatten().any(|i| *i == rim), "the rim is bare");
        assert!(scalp.iter().flatten().all(|i| *i != rim));
    }
}
