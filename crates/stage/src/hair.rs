//! Hair as a scene has it: strands, what the head holds of them, and the shapes that are wanted of them.

use groom::Tie;
use hair_io::HairFile;
use hair_sim::Motion;
use render::Head;

/// Hair that was read or grown.
pub(crate) struct Hair {
    pub file: HairFile,
    /// How many strands, the first ones, are an undercoat: no hair comes loose from it.
    pub undercoat: usize,
    /// How many points from its root each strand keeps on the head.
    pub held: Vec<u32>,
    /// The shapes that a script wants of it at times.
    pub shapes: Option<Motion>,
    /// The ties that gather it.
    pub ties: Vec<Tie>,
    /// The head that it stands on.
    pub head: Head,
}

impl Hair {
    /// Keeps these strands, in this order.
    pub fn keep(&mut self, indices: &[usize]) {
        if let Some(shapes) = &self.shapes {
            let strands = &self.file.strands;
            let points = indices.iter().flat_map(|&i| strands.point_range(i));
            self.shapes = Some(shapes.select(&points.collect::<Vec<_>>()));
        }
        self.file.keep(indices);
        let is_undercoat = |i: &&usize| **i < self.undercoat;
        self.undercoat = indices.iter().filter(is_undercoat).count();
        self.held = indices.iter().map(|&i| self.held[i]).collect();
    }

    /// How many points from its root a strand keeps on the head, at least its root.
    pub fn held(&self, strand: usize) -> usize {
        let points = self.file.strands.strand(strand).len();
        (self.held[strand].max(1) as usize).min(points)
    }
}
