//! Where a head has hair: what of its mesh is seen between clumps in the hair's colour, so that gaps are no bald spots.

use glam::{IVec3, Vec3};
use std::collections::HashMap;

/// The triangles of which every corner is within `reach_m` of a root, then the others.
pub(crate) fn split(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    roots: &[Vec3],
    reach_m: f32,
) -> [Vec<[u32; 3]>; 2] {
    let cell = |point: Vec3| -> IVec3 { (point / reach_m).floor().as_ivec3() };
    let mut cells: HashMap<IVec3, Vec<Vec3>> = HashMap::new();
    for root in roots {
        cells.entry(cell(*root)).or_default().push(*root);
    }
    let has_root = |point: Vec3| {
        let middle = cell(point);
        // Saturating, as places may lie any number of cells away.
        let around =
            (0..27).map(|i| middle.saturating_add(IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
        let near = |root: &Vec3| root.distance_squared(point) <= reach_m * reach_m;
        around
            .filter_map(|cell| cells.get(&cell))
            .any(|roots| roots.iter().any(near))
    };
    let is_scalp: Vec<bool> = positions.iter().map(|p| has_root(*p)).collect();
    let all = |triangle: &&[u32; 3]| triangle.iter().all(|&i| is_scalp[i as usize]);
    let (scalp, skin): (Vec<_>, Vec<_>) = triangles.iter().partition(all);
    [scalp, skin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_around_roots_are_scalp() {
        // A strip of squares along x, 1 wide.
        let positions = (0..20).map(|i| Vec3::new((i / 2) as f32, (i % 2) as f32, 0.0));
        let triangles = (0..18).map(|i| [i, i + 1, i + 2]);
        let (positions, triangles): (Vec<Vec3>, Vec<_>) =
            (positions.collect(), triangles.collect());
        let parts = |roots: &[Vec3], reach: f32| split(&positions, &triangles, roots, reach);
        let roots = [Vec3::new(0.0, 0.5, 0.0), Vec3::new(1.0, 0.5, 0.0)];
        let [scalp, skin] = parts(&roots, 1.3);
        // Roots at 0 and 1 reach to x = 2.2.
        let last = |triangles: &[[u32; 3]]| triangles.iter().flatten().copied().max();
        assert_eq!(last(&scalp), Some(5));
        assert_eq!(scalp.len() + skin.len(), 18);
        assert_eq!(parts(&[], 1.0)[0].len(), 0);
        assert_eq!(parts(&[Vec3::MAX, Vec3::MIN], 1e-30)[0].len(), 0);
    }
}
