//! Lids over the holes of a mesh that something was cut off.

use glam::Vec3;
use std::collections::BTreeMap;

type Place = [u32; 3];

fn place(corner: Vec3) -> Place {
    // + 0.0 makes one zero of two.
    (corner + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// Triangles that close the holes between those that are `kept` and those that are `gone`: over each ring of edges that were both's, around its middle. Rings that
/// don't close have none.
pub(crate) fn lids(
    kept: &[[Vec3; 3]],
    gone: impl IntoIterator<Item = [Vec3; 3]>,
) -> Vec<[Vec3; 3]> {
    let mut numbers = BTreeMap::new();
    let mut corners = Vec::new();
    let mut number = |corner: Vec3| {
        *numbers.entry(place(corner)).or_insert_with(|| {
            corners.push(corner);
            corners.len() - 1
        })
    };
    // Of each edge of what is gone, by its lower and its higher end: how many kept triangles have it, and whether the last of them goes up it.
    let mut edges: BTreeMap<[usize; 2], (u32, bool)> = BTreeMap::new();
    for triangle in gone {
        for [from, to] in sides(triangle.map(&mut number)) {
            edges.insert([from.min(to), from.max(to)], (0, false));
        }
    }
    for triangle in kept {
        for side in sides(triangle.map(|corner| numbers.get(&place(corner)))) {
            if let [Some(&from), Some(&to)] = side
                && let Some((count, goes_up)) = edges.get_mut(&[from.min(to), from.max(to)])
            {
                (*count, *goes_up) = (*count + 1, from < to);
            }
        }
    }
    let rim: Vec<[usize; 2]> = (edges.into_iter())
        .filter(|([low, high], (count, _))| *count == 1 && low != high)
        .map(|([low, high], (_, goes_up))| if goes_up { [low, high] } else { [high, low] })
        .collect();

    let mut first: Vec<usize> = (0..corners.len()).collect();
    let mut count = vec![0; corners.len()];
    for [from, to] in &rim {
        let (from_first, to_first) = (first_of(&mut first, *from), first_of(&mut first, *to));
        first[from_first.max(to_first)] = from_first.min(to_first);
        count[*from] += 1;
        count[*to] += 1;
    }
    let mut is_ring = vec![true; corners.len()];
    let mut middles = vec![(Vec3::ZERO, 0.0); corners.len()];
    for [from, to] in &rim {
        for corner in [*from, *to] {
            let ring = first_of(&mut first, corner);
            is_ring[ring] &= count[corner] % 2 == 0;
            middles[ring].0 += corners[corner];
            middles[ring].1 += 1.0;
        }
    }
    let lid = |[from, to]: &[usize; 2]| {
        let ring = first_of(&mut first, *from);
        let (sum, of) = middles[ring];
        is_ring[ring].then_some([corners[*to], corners[*from], sum / of])
    };
    rim.iter().filter_map(lid).collect()
}

/// A triangle's sides, by its corners.
fn sides<T: Copy>([a, b, c]: [T; 3]) -> [[T; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

fn first_of(first: &mut [usize], mut corner: usize) -> usize {
    while first[corner] != corner {
        first[corner] = first[first[corner]];
        corner = first[corner];
    }
    corner
}

#[cfg(test)]
mod tests {
    use super::*;
    use hair_io::Mesh;

    /// The walls of a box, without the floor.
    fn walls() -> Vec<[Vec3; 3]> {
        let corner = |i: u32| Vec3::new((i & 1) as f32, ((i >> 1) & 1) as f32, (i >> 2) as f32);
        let quads = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [2, 6, 7, 3],
        ];
        quads
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
            .map(|triangle: [u32; 3]| triangle.map(corner))
            .collect()
    }

    #[test]
    fn a_box_without_a_floor_gets_one() {
        let walls = walls();
        let floor =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
        let floor = [[0, 1, 2], [0, 2, 3]].map(|t: [usize; 3]| t.map(|i| floor[i]));
        let found = lids(&walls, floor);
        assert_eq!(found.len(), 4);
        let closed = Mesh::from_corners(walls.iter().copied().chain(found));
        let volume: f32 = (closed.triangles.iter())
            .map(|t| t.map(|i| closed.positions[i as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!((volume.abs() - 1.0).abs() < 1e-6, "{volume}");
        // The box was open there before: nothing was cut.
        assert!(lids(&walls, []).is_empty());
        // Of a floor of which a half was cut off the open ring has none.
        assert!(lids(&walls, floor.into_iter().take(1)).is_empty());
    }
}
