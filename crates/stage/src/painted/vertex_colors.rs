//! Colours that a file gives of vertices, by a picture in which each triangle has four texels: from the middle of one to those beside it and
//! below it, between which texels are mixed, its corners' colours run evenly (glTF 2.0, 3.9.2).

use super::materials::{MeshPicture, mean_color, vertex_colors_of};
use super::{MeshPaint, PaintedMesh};
use effects::{Image, linear_from_srgb};
use glam::Vec2;
use mesh_io::{Attribute, Mesh, Model};
use render::Coverage;
use std::collections::HashMap;
use std::sync::Arc;

/// The colours of a triangle's corners, in sRGB.
type Corners = [[u16; 3]; 3];

impl PaintedMesh {
    /// Gives triangles the colours of their corners, where those of the mesh differ and no picture is on it. Of a whole mesh, as [`super::of_model`] has it.
    pub(crate) fn color_triangles(&mut self, model: &Model) {
        let mesh = &model.meshes[self.index];
        let Some(colors) = vertex_colors_of(mesh, &self.paint) else {
            return;
        };
        if self.paint.picture.is_some() || mean_color(colors).1 {
            return;
        }
        let Some(palette) = Palette::new(mesh, colors) else {
            return;
        };
        // A corner is a vertex for each place that its triangles have it at.
        let mut numbers = HashMap::new();
        let mut vertices = Vec::new();
        for (triangle, block) in self.triangles.iter_mut().zip(&palette.blocks) {
            for (k, corner) in triangle.iter_mut().enumerate() {
                let texel = palette.texel(*block, k);
                *corner = *numbers.entry((*corner, texel)).or_insert_with(|| {
                    vertices.push((*corner as usize, texel));
                    vertices.len() as u32 - 1
                });
            }
        }
        self.kept = vertices.iter().map(|(corner, _)| *corner).collect();
        self.positions = self.kept.iter().map(|i| self.positions[*i]).collect();
        self.normals = self.kept.iter().map(|i| self.normals[*i]).collect();
        let size = palette.image.size().map(|side| side as f32);
        let middle =
            |[x, y]: [usize; 2]| Vec2::new((x as f32 + 0.5) / size[0], (y as f32 + 0.5) / size[1]);
        self.places = vertices.iter().map(|(_, texel)| middle(*texel)).collect();
        let material = mesh.material.and_then(|index| model.materials.get(index));
        let own = material.map_or([1.0; 4], |material| material.base_color);
        self.paint = MeshPaint {
            color: Some([own[0], own[1], own[2]]),
            picture: Some(MeshPicture {
                image: Arc::new(palette.image),
                repeats: false,
                coverage: Coverage::Ignored,
            }),
            ..self.paint.clone()
        };
    }
}

/// Where a triangle has its four texels.
#[derive(Clone, Copy)]
struct Block {
    number: usize,
    /// The corner that has the first texel; none where all are of one colour, and have it together.
    first: Option<usize>,
}

/// The colours of a mesh's triangles.
struct Palette {
    /// Of blocks of two by two texels, so many in a row.
    image: Image,
    row: usize,
    blocks: Vec<Block>,
}

impl Palette {
    /// Nothing where there are too many for a picture.
    fn new(mesh: &Mesh, colors: &Attribute) -> Option<Self> {
        let mut numbers = HashMap::new();
        let blocks = mesh.triangles.iter().map(|triangle| {
            let corners: Corners = triangle.map(|corner| {
                let own = colors.of(corner as usize);
                [0, 1, 2].map(|i| nearest_srgb(own.get(i).copied().unwrap_or(1.0)))
            });
            let is_flat = corners == [corners[0]; 3];
            let first = (!is_flat).then(|| evenest(&corners));
            let mut in_order = corners;
            in_order.rotate_left(first.unwrap_or(0));
            let count = numbers.len();
            let number = *numbers.entry(in_order).or_insert(count);
            Block { number, first }
        });
        let blocks = blocks.collect();
        // Nearly square: it has room for some millions of triangles.
        let row = (numbers.len() as f64).sqrt().ceil() as usize;
        let size = [2 * row, 2 * numbers.len().div_ceil(row.max(1))];
        if size.iter().any(|side| *side > Image::MOST_TEXELS) {
            return None;
        }
        let mut rgba = vec![[u16::MAX; 4]; size[0] * size[1]];
        for ([a, b, c], block) in numbers {
            for (k, [red, green, blue]) in [a, b, c, across([a, b, c])].into_iter().enumerate() {
                let (x, y) = (2 * (block % row) + k % 2, 2 * (block / row) + k / 2);
                rgba[y * size[0] + x] = [red, green, blue, u16::MAX];
            }
        }
        let image = Image::from_srgb(size, rgba.as_flattened()).ok()?;
        // Smaller copies would mix triangles that have nothing to do with each other.
        Some(Self {
            image: image.without_copies(),
            row,
            blocks,
        })
    }

    /// The texel of a triangle's corner.
    fn texel(&self, block: Block, corner: usize) -> [usize; 2] {
        let k = block.first.map_or(0, |first| (corner + 3 - first) % 3);
        [
            2 * (block.number % self.row) + k % 2,
            2 * (block.number / self.row) + k / 2,
        ]
    }
}

/// The light across from a triangle's first corner with which all four run evenly: there may be no such colour.
fn light_across(corners: [[u16; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|color| color.map(|x| linear_from_srgb(f64::from(x) / 65535.0)));
    [0, 1, 2].map(|i| b[i] + c[i] - a[i])
}

/// The colour nearest to that.
fn across(corners: Corners) -> [u16; 3] {
    light_across(corners).map(|x| nearest_srgb(x as f32))
}

/// The corner across from which light is nearest to a colour: two of one colour and a third run evenly from either of the two.
fn evenest(corners: &Corners) -> usize {
    let beyond = |first: usize| {
        let mut corners = *corners;
        corners.rotate_left(first);
        let over = light_across(corners).map(|x| (x - x.clamp(0.0, 1.0)).abs());
        over.iter().sum::<f64>()
    };
    let [a, b, c] = [0, 1, 2].map(beyond);
    match (a <= b && a <= c, b <= c) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
    }
}

/// The number of 16 bits whose sRGB value is nearest to a linear one.
fn nearest_srgb(linear: f32) -> u16 {
    let is_below = |x: u16| linear_from_srgb((f64::from(x) + 0.5) / 65535.0) < f64::from(linear);
    let (mut low, mut high) = (0, u16::MAX);
    while low < high {
        let middle = low + (high - low) / 2;
        match is_below(middle) {
            true => low = middle + 1,
            false => high = middle,
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_the_nearest_that_there_are() {
        for byte in 0..=255_u16 {
            let linear = linear_from_srgb(f64::from(byte) / 255.0) as f32;
            assert!(nearest_srgb(linear).abs_diff(byte * 257) <= 1, "{byte}");
        }
        assert_eq!([-1.0, 2.0, f32::NAN].map(nearest_srgb), [0, 65535, 0]);
    }
}
