//! Blocks, as meshes that tests know the distances of.

use glam::Vec3;

/// The points and the triangles of blocks, each between two corners, one beside the other.
pub(crate) fn blocks(corners: &[[Vec3; 2]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let walls = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for ends in corners {
        let first = points.len() as u32;
        let end = |i: usize, bit: usize| ends[usize::from(i & bit != 0)];
        points.extend((0..8).map(|i| Vec3::new(end(i, 1).x, end(i, 2).y, end(i, 4).z)));
        for [a, b, c, d] in walls {
            triangles.push([a, b, c].map(|corner| first + corner));
            triangles.push([a, c, d].map(|corner| first + corner));
        }
    }
    (points, triangles)
}
