//! Cutting a mesh along lines on its surface.

use crate::surface_nets::Net;
use glam::Vec3;
use std::collections::HashMap;

/// No cut comes nearer to an end of an edge, in parts of it: slivers have no direction.
const NEAREST: f32 = 0.04;

/// Cuts triangles where field number `field` passes `level`. Each field has a value a position, and
/// where edges are cut values run on linearly.
pub(crate) fn cut(net: &mut Net, fields: &mut [Vec<f32>], field: usize, level: f32) {
    let mut middles = HashMap::new();
    let mut triangles = Vec::with_capacity(net.triangles.len());
    for &triangle in &net.triangles {
        let over = triangle.map(|i| fields[field][i as usize] >= level);
        // The corner that is alone on its side, first.
        let Some(alone) = (0..3).find(|&i| {
            let [own, next, last] = [over[i], over[(i + 1) % 3], over[(i + 2) % 3]];
            own != next && next == last
        }) else {
            triangles.push(triangle);
            continue;
        };
        let [a, b, c] = [0, 1, 2].map(|i| triangle[(alone + i) % 3]);
        let mut middle = |from: u32, to: u32| {
            let key = (from.min(to), from.max(to));
            *middles
                .entry(key)
                .or_insert_with(|| halve(&mut net.positions, fields, key, field, level))
        };
        let (ab, ac) = (middle(a, b), middle(a, c));
        triangles.extend([[a, ab, ac], [ab, b, c], [ab, c, ac]]);
    }
    net.triangles = triangles;
}

/// A new position on an edge, where the field has the level.
fn halve(
    positions: &mut Vec<Vec3>,
    fields: &mut [Vec<f32>],
    (a, b): (u32, u32),
    field: usize,
    level: f32,
) -> u32 {
    let (a, b) = (a as usize, b as usize);
    let (at_a, at_b) = (fields[field][a], fields[field][b]);
    let t = ((level - at_a) / (at_b - at_a)).clamp(NEAREST, 1.0 - NEAREST);
    let index = positions.len() as u32;
    positions.push(positions[a].lerp(positions[b], t));
    for (i, values) in fields.iter_mut().enumerate() {
        let value = values[a] + (values[b] - values[a]) * t;
        // What lies on the line belongs to neither side.
        values.push(if i == field { level } else { value });
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_cut_along_a_line() {
        let mut net = Net {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let mut fields = vec![net.positions.iter().map(|p| p.x + 0.2 * p.y).collect()];
        cut(&mut net, &mut fields, 0, 0.5);
        let area = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| net.positions[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let (mut below, mut above) = (0.0, 0.0);
        for triangle in &net.triangles {
            assert!(area(triangle) > 0.0);
            let values = triangle.map(|i| fields[0][i as usize]);
            if values.iter().all(|v| *v <= 0.5) {
                below += area(triangle);
            } else {
                assert!(values.iter().all(|v| *v >= 0.5), "{values:?}");
                above += area(triangle);
            }
        }
        // The line runs from (0.5, 0) to (0.3, 1).
        assert!(
            (below - 0.4).abs() < 1e-6 && (above - 0.6).abs() < 1e-6,
            "{below} {above}"
        );
        assert_eq!(
            net.positions.len(),
            7,
            "edges are cut once for both of their sides"
        );
    }
}
