//! Pieces of cloth end where the figure is cut off.

use super::dress::Cloth;
use super::sewn::Piece;
use glam::Vec3;
use std::collections::{BTreeMap, HashMap};

/// From where to where each edge of a cut runs, as what closes it has them, with its cloth.
type Rim = BTreeMap<u32, (u32, Cloth)>;

impl Piece {
    /// What of a closed piece lies above a height, closed there by flat triangles; nothing where none of it does.
    pub fn above(self, height: f32) -> Self {
        if self.positions.iter().all(|p| p.y >= height) {
            return self;
        }
        let mut kept = Self {
            positions: Vec::new(),
            triangles: Vec::new(),
            cloth: Vec::new(),
            is_lit_as_body: self.is_lit_as_body,
        };
        // The new place of each corner, and of where each edge passes the height: its lower end and its upper one.
        let mut places: HashMap<(u32, u32), u32> = HashMap::new();
        let mut rim = Rim::new();
        for (triangle, cloth) in self.triangles.iter().zip(&self.cloth) {
            let mut place = |low: u32, high: u32| {
                *places.entry((low, high)).or_insert_with(|| {
                    let [from, to] = [low, high].map(|i| self.positions[i as usize]);
                    kept.positions.push(match low == high {
                        true => from,
                        false => from.lerp(to, (height - from.y) / (to.y - from.y)),
                    });
                    kept.positions.len() as u32 - 1
                })
            };
            let is_over = |i: u32| self.positions[i as usize].y >= height;
            let (mut outline, mut down, mut up) = (Vec::with_capacity(4), None, None);
            for (own, next) in [(0, 1), (1, 2), (2, 0)].map(|(i, k)| (triangle[i], triangle[k])) {
                match (is_over(own), is_over(next)) {
                    (true, true) => outline.push(place(own, own)),
                    (true, false) => {
                        outline.push(place(own, own));
                        down = Some(place(next, own));
                        outline.extend(down);
                    }
                    (false, true) => {
                        up = Some(place(own, next));
                        outline.extend(up);
                    }
                    (false, false) => {}
                }
            }
            for k in 2..outline.len() {
                kept.triangles
                    .push([outline[0], outline[k - 1], outline[k]]);
                kept.cloth.push(*cloth);
            }
            if let (Some(down), Some(up)) = (down, up) {
                rim.insert(up, (down, *cloth));
            }
        }
        kept.close(rim);
        kept
    }

    /// Closes what a cut has opened: around the middle of each of its loops.
    fn close(&mut self, mut rim: Rim) {
        while let Some((&first, _)) = rim.first_key_value() {
            let middle = self.positions.len() as u32;
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            let mut from = first;
            while let Some((to, cloth)) = rim.remove(&from) {
                self.triangles.push([from, to, middle]);
                self.cloth.push(cloth);
                sum += self.positions[from as usize];
                count += 1.0;
                from = to;
            }
            self.positions.push(sum / count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cubes side by side, 1 high.
    fn two_cubes() -> Piece {
        let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let mut piece = Piece {
            positions: Vec::new(),
            triangles: Vec::new(),
            cloth: Vec::new(),
            is_lit_as_body: false,
        };
        for (first, at, cloth) in [(0, 0.0, Cloth::Dress), (8, 3.0, Cloth::Accent)] {
            piece
                .positions
                .extend((0..8).map(|i| corner(i) + at * Vec3::X));
            for [a, b, c, d] in sides.map(|side| side.map(|i| first + i)) {
                piece.triangles.extend([[a, b, c], [a, c, d]]);
                piece.cloth.extend([cloth; 2]);
            }
        }
        piece
    }

    fn volume(piece: &Piece, cloth: Cloth) -> f32 {
        let own = piece.triangles.iter().zip(&piece.cloth);
        let own = own.filter(|(_, of)| **of == cloth);
        let six = own.map(|(triangle, _)| {
            let [a, b, c] = triangle.map(|i| piece.positions[i as usize]);
            a.dot(b.cross(c))
        });
        six.sum::<f32>() / 6.0
    }

    #[test]
    fn what_is_left_is_closed() {
        let whole = two_cubes();
        assert!((volume(&whole, Cloth::Dress) - 1.0).abs() < 1e-6);
        for (height, left) in [(-0.5, 1.0), (0.25, 0.75), (0.0, 1.0), (1.5, 0.0)] {
            let piece = two_cubes().above(height);
            assert_eq!(piece.triangles.len(), piece.cloth.len());
            let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
            for [a, b, c] in &piece.triangles {
                for edge in [(*a, *b), (*b, *c), (*c, *a)] {
                    *edges.entry(edge).or_default() += 1;
                }
            }
            for ((a, b), count) in &edges {
                assert_eq!((*count, edges.get(&(*b, *a))), (1, Some(&1)), "at {height}");
            }
            // Each of them, so that their cloths are kept.
            for cloth in [Cloth::Dress, Cloth::Accent] {
                let volume = volume(&piece, cloth);
                assert!((volume - left).abs() < 1e-5, "at {height}: {volume}");
            }
            assert!(piece.positions.iter().all(|p| p.y >= height - 1e-6));
        }
    }
}
