//! What the samples of a tile show: triangles, and points on the axes of strokes.

use super::stroke::Places;
use super::tile::{IdPlane, LANES, LaneMask, Lanes, Plane, StoreMask, id_plane, plane, select};

/// A sample of nothing, in [`Shown::what`].
pub(super) const NOTHING: u32 = u32::MAX;
/// Set in the numbers of triangles, and not in those of segments: no picture has as many of either.
pub(super) const TRIANGLE: u32 = 1 << 31;

/// What each sample of a tile shows. Its planes are made when they are first needed.
#[derive(Default)]
pub(super) struct Shown(Option<Planes>);

/// The planes themselves.
pub(super) struct Planes {
    /// [`NOTHING`], a triangle's number with [`TRIANGLE`], or a segment's number.
    pub(super) what: IdPlane,
    /// The way from the segment's first joint to the next.
    pub(super) way: Plane,
    /// Places across the stroke and across the clump.
    pub(super) v: Plane,
    pub(super) w: Plane,
}

impl Shown {
    /// Forgets what samples show.
    pub(super) fn clear(&mut self) {
        let planes = self.0.get_or_insert_with(|| Planes {
            what: id_plane(),
            way: plane(),
            v: plane(),
            w: plane(),
        });
        planes.what.fill([NOTHING; LANES]);
    }

    /// What they show, once there is something.
    pub(super) fn planes(&self) -> Option<&Planes> {
        self.0.as_ref()
    }

    /// Some samples of a cell show a triangle.
    #[inline(always)]
    pub(super) fn put_triangle(&mut self, cell: usize, index: u32, samples: &StoreMask) {
        if let Some(planes) = &mut self.0 {
            samples.store_ids(&[index | TRIANGLE; LANES], &mut planes.what[cell]);
        }
    }

    /// Some samples of a cell show a stroke.
    #[inline(always)]
    pub(super) fn put_stroke<const COLORED: bool>(
        &mut self,
        cell: usize,
        places: &Places<COLORED>,
        samples: &LaneMask,
    ) {
        if let Some(planes) = &mut self.0 {
            let samples = StoreMask::new(samples);
            samples.store_ids(&places.index, &mut planes.what[cell]);
            samples.store(&places.way, &mut planes.way[cell]);
            samples.store(&places.across(), &mut planes.v[cell]);
        }
    }

    /// Some samples of a cell, which show a stroke, lie outside of the clump.
    #[inline(always)]
    pub(super) fn put_outside<const COLORED: bool>(
        &mut self,
        cell: usize,
        places: &Places<COLORED>,
        samples: &LaneMask,
    ) {
        if let Some(planes) = &mut self.0 {
            let across = places.across();
            let mut outside: Lanes = [1.0; LANES];
            for k in 0..LANES {
                outside[k] = select(across[k] < 0.0, -1.0, 1.0);
            }
            StoreMask::new(samples).store(&outside, &mut planes.w[cell]);
        }
    }

    /// Some samples of a cell, which show a stroke, lie within the clump.
    #[inline(always)]
    pub(super) fn put_clump<const COLORED: bool>(
        &mut self,
        cell: usize,
        places: &Places<COLORED>,
        samples: &LaneMask,
    ) {
        if let Some(planes) = &mut self.0 {
            StoreMask::new(samples).store(&places.across(), &mut planes.w[cell]);
        }
    }
}
