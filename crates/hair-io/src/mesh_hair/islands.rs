//! Which triangles hang together.

use super::MeshHair;
use glam::Vec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// For each triangle the number of its island, which is the index of the island's first triangle: those that share a place, whatever
/// their normals and textures there, hang together. One with another index than a position's, or a corner that isn't finite, is an island of its
/// own.
#[must_use]
pub fn islands(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<usize> {
    let groups = vec![Some(0); triangles.len()];
    numbered(&MeshHair {
        positions,
        triangles,
        groups: &groups,
        depths: &[],
    })
    .into_iter()
    .enumerate()
    .map(|(index, island)| island.unwrap_or(index))
    .collect()
}

/// The triangles of each island of hair, by its first.
pub(super) fn grouped(hair: &MeshHair) -> Vec<Vec<usize>> {
    let mut found: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (triangle, island) in numbered(hair).into_iter().enumerate() {
        if let Some(island) = island {
            found.entry(island).or_default().push(triangle);
        }
    }
    found.into_values().collect()
}

/// The first triangle of each triangle's island; none where it is no hair.
fn numbered(hair: &MeshHair) -> Vec<Option<usize>> {
    let mut parents: Vec<usize> = (0..hair.triangles.len()).collect();
    let mut first_at: HashMap<(u32, PlaceBits), usize> = HashMap::new();
    let mut is_hair = vec![false; hair.triangles.len()];
    for (index, triangle) in hair.triangles.iter().enumerate() {
        let corners = triangle.map(|corner| hair.positions.get(corner as usize));
        let (Some(group), [Some(a), Some(b), Some(c)]) = (hair.groups[index], corners) else {
            continue;
        };
        if !(a.is_finite() && b.is_finite() && c.is_finite()) {
            continue;
        }
        is_hair[index] = true;
        for place in [a, b, c] {
            let other = *first_at.entry((group, key(*place))).or_insert(index);
            let [own, other] = [index, other].map(|of| root_of(&mut parents, of));
            // The lower one stays, so that an island has its first triangle's number.
            parents[own.max(other)] = own.min(other);
        }
    }
    (0..is_hair.len())
        .map(|index| is_hair[index].then(|| root_of(&mut parents, index)))
        .collect()
}

/// The places where an island touches triangles that are no hair, or those of another group.
pub(super) fn borders(hair: &MeshHair) -> HashSet<PlaceBits> {
    let mut first_at: HashMap<PlaceBits, Option<u32>> = HashMap::new();
    let mut borders = HashSet::new();
    for (triangle, group) in hair.triangles.iter().zip(hair.groups) {
        let places = triangle
            .iter()
            .filter_map(|corner| hair.positions.get(*corner as usize));
        for place in places {
            if first_at.entry(key(*place)).or_insert(*group) != group {
                borders.insert(key(*place));
            }
        }
    }
    borders
}

/// A place's bits, which tell whether two are one.
pub(super) type PlaceBits = [u32; 3];

/// A place's bits; + 0.0 makes one zero of two.
pub(super) fn key(place: Vec3) -> PlaceBits {
    (place + Vec3::ZERO).to_array().map(f32::to_bits)
}

fn root_of(parents: &mut [usize], mut of: usize) -> usize {
    while parents[of] != of {
        parents[of] = parents[parents[of]];
        of = parents[of];
    }
    of
}
