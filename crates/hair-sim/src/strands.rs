//! The strand model: chains of particles from root to tip.

use glam::Vec3;

/// Strands in one flat list of points, root first.
///
/// A strand keeps its `id`, its index in the source it came from, through selection and sorting:
/// every seeded variation hashes the id, never a position in this list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strands {
    points: Vec<Vec3>,
    /// `first[i]..first[i + 1]` are the points of strand `i`. Empty when there are no strands.
    first: Vec<usize>,
    ids: Vec<u32>,
    sizes: Vec<Option<f32>>,
}

/// Why a strand was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StrandError {
    /// A strand needs a root.
    #[error("strand {id} has no points")]
    Empty {
        /// The strand's id.
        id: u32,
    },
    /// Positions are finite numbers of metres.
    #[error("strand {id}, point {point}: the position {position} is not finite")]
    NotFinite {
        /// The strand's id.
        id: u32,
        /// The point's index from the root, 0 first.
        point: usize,
        /// The position as it was given.
        position: Vec3,
    },
    /// A clump size is a number from 0 to [`Strands::LARGEST_SIZE`].
    #[error(
        "strand {id}: the size {size} was found, a number from 0 to {} was expected",
        Strands::LARGEST_SIZE
    )]
    Size {
        /// The strand's id.
        id: u32,
        /// The size as it was given.
        size: f32,
    },
}

impl Strands {
    /// The largest clump size: a hundred head heights.
    pub const LARGEST_SIZE: f32 = 30_000.0;

    /// No strands.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends a strand: its points from root to tip in metres, and its clump size (radius at full
    /// size, in 1/300 of the head's height) where the source gives one.
    ///
    /// # Errors
    ///
    /// When the strand is empty, a number in it is not finite, or its size not from 0 to [`Self::LARGEST_SIZE`]. Nothing is appended then.
    pub fn push(&mut self, id: u32, points: &[Vec3], size: Option<f32>) -> Result<(), StrandError> {
        if points.is_empty() {
            return Err(StrandError::Empty { id });
        }
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            return Err(StrandError::NotFinite {
                id,
                point,
                position: points[point],
            });
        }
        if let Some(size) = size.filter(|s| !(0.0..=Self::LARGEST_SIZE).contains(s)) {
            return Err(StrandError::Size { id, size });
        }
        if self.first.is_empty() {
            self.first.push(0);
        }
        self.points.extend_from_slice(points);
        self.first.push(self.points.len());
        self.ids.push(id);
        self.sizes.push(size);
        Ok(())
    }

    /// The number of strands.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no strands.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The points of strand `index`, root first, in metres.
    ///
    /// # Panics
    ///
    /// When `index` is not below [`Self::len`].
    #[must_use]
    pub fn strand(&self, index: usize) -> &[Vec3] {
        &self.points[self.first[index]..self.first[index + 1]]
    }

    /// All strands' points, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[Vec3]> {
        (0..self.len()).map(|i| self.strand(i))
    }

    /// The root of every strand, in order.
    pub fn roots(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.iter().map(|points| points[0])
    }

    /// The id of strand `index`.
    #[must_use]
    pub fn id(&self, index: usize) -> u32 {
        self.ids[index]
    }

    /// The clump size of strand `index`, where its source gives one (1/300 of the head's height).
    #[must_use]
    pub fn size(&self, index: usize) -> Option<f32> {
        self.sizes[index]
    }

    /// The points of all strands in one list, in metres.
    #[must_use]
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// The points of all strands in one list, to move them. Their number stays.
    pub fn points_mut(&mut self) -> &mut [Vec3] {
        &mut self.points
    }

    /// The range that strand `index` has in [`Self::points`].
    #[must_use]
    pub fn point_range(&self, index: usize) -> std::ops::Range<usize> {
        self.first[index]..self.first[index + 1]
    }

    /// The strands at these indices, in this order, with their ids and sizes.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        let mut kept = Self::new();
        if !indices.is_empty() {
            kept.first.push(0);
        }
        for &i in indices {
            kept.points.extend_from_slice(self.strand(i));
            kept.first.push(kept.points.len());
            kept.ids.push(self.ids[i]);
            kept.sizes.push(self.sizes[i]);
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strands_keep_their_ids_when_selected() {
        let mut strands = Strands::new();
        strands.push(7, &[Vec3::ZERO, Vec3::X], None).unwrap();
        strands.push(3, &[Vec3::Y], Some(12.0)).unwrap();
        let kept = strands.select(&[1]);
        assert_eq!(kept.len(), 1);
        assert_eq!(kept.id(0), 3);
        assert_eq!(kept.size(0), Some(12.0));
        assert_eq!(kept.strand(0), &[Vec3::Y]);
        assert_eq!(strands.select(&[]), Strands::new());
    }

    #[test]
    fn bad_strands_are_refused_whole() {
        let mut strands = Strands::new();
        assert!(matches!(
            strands.push(1, &[], None),
            Err(StrandError::Empty { id: 1 })
        ));
        let broken = [Vec3::ZERO, Vec3::new(0.0, f32::NAN, 0.0)];
        assert!(matches!(
            strands.push(2, &broken, None),
            Err(StrandError::NotFinite {
                id: 2,
                point: 1,
                ..
            })
        ));
        for size in [-1.0, f32::NAN, 1.001 * Strands::LARGEST_SIZE, 1e30] {
            assert!(strands.push(3, &[Vec3::ZERO], Some(size)).is_err());
        }
        assert!(strands.is_empty());
        assert_eq!(strands.points().len(), 0);
    }
}
