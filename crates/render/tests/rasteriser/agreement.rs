//! Where a picture differs from the reference with its samples at the same places.

use glam::DVec2;
use render::{Drawing, Picture};

/// The rasteriser works in f32: a colour may differ by this much. Positions of some hundred pixels
/// have 3e-5 px, which is some thousandths of the radius of a thin stroke.
const COLOR_TOLERANCE: f32 = 4e-3;

pub fn positions(samples: u32) -> Vec<DVec2> {
    let positions = render::sample_positions(samples).unwrap();
    positions.iter().map(|p| p.as_dvec2()).collect()
}

/// The pixels that differ, which needs a sample that shows something else.
pub fn different(picture: &Picture, reference: &Picture) -> Vec<usize> {
    assert_eq!(
        (picture.width, picture.height),
        (reference.width, reference.height)
    );
    assert_eq!(picture.pixels.len(), reference.pixels.len());
    let differs = |index: &usize| {
        let channels = picture.pixels[*index].iter().zip(&reference.pixels[*index]);
        !channels
            .into_iter()
            .all(|(a, b)| (a - b).abs() <= COLOR_TOLERANCE)
    };
    (0..picture.pixels.len()).filter(differs).collect()
}

/// The number of pixels of a drawing that differ from the reference, and the first, where single precision is no
/// reason: a pixel whose reference is another one for samples a few thousandths of a pixel away, or for strands that
/// are nearer and farther by a millionth, lies at a border, or where depths are equal.
pub fn wrong(picture: &Picture, drawing: &Drawing, samples: u32) -> (usize, Option<[usize; 2]>) {
    let positions = positions(samples);
    let reference = reference::picture_at(drawing, &positions);
    let mut wrong = different(picture, &reference);
    if !wrong.is_empty() {
        let moved = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|way| {
            let positions: Vec<DVec2> = positions.iter().map(|p| *p + way * 4e-3).collect();
            reference::picture_at(drawing, &positions)
        });
        let nudged =
            [1e-6, -1e-6].map(|by| reference::picture_at(&nudged(drawing, by), &positions));
        for other in moved.iter().chain(&nudged) {
            let unsure = different(other, &reference);
            wrong.retain(|index| unsure.binary_search(index).is_err());
        }
    }
    let width = picture.width as usize;
    let first = wrong.first().map(|index| [index % width, index / width]);
    (wrong.len(), first)
}

/// Every run's strokes nearer than the run's before by a share of their depth, so that no two are at the same.
pub fn nudged(drawing: &Drawing, by: f32) -> Drawing {
    let mut nudged = drawing.clone();
    let joints = nudged.clump.len();
    for (i, run) in drawing.runs.iter().enumerate() {
        let nearer = 1.0 + by * (i + 1) as f32;
        for joint in run.joints.clone() {
            let lists = std::iter::once(&mut nudged.clump)
                .chain(std::iter::once(&mut nudged.sides))
                .chain(nudged.layers.iter_mut().map(|layer| &mut layer.discs));
            for list in lists {
                for disc in list.iter_mut().skip(joint).step_by(joints) {
                    disc.inv_depth *= nearer;
                    disc.inv_depth_biased *= nearer;
                }
            }
        }
    }
    nudged
}
