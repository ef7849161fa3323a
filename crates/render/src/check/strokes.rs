//! What strands and their strokes must be.

use super::{DrawError, MAX_COORDINATE, first_that_is_not, is_finite};
use crate::drawing::{Disc, Drawing, LayerStrokes, Run, Stretch, Stretches};
use std::ops::Range;

/// Looks at every number of the strands, their clumps, and the strokes on them.
pub(super) fn check_strokes(drawing: &Drawing) -> Result<(), DrawError> {
    check_runs(drawing)?;
    if let Some(joint) = first_that_is_not(&drawing.clump, is_disc) {
        let disc = drawing.clump[joint];
        return Err(DrawError::ClumpDisc { joint, disc });
    }
    check_sides(drawing)?;
    for layer in &drawing.layers {
        check_layer(layer, drawing)?;
    }
    Ok(())
}

fn check_runs(drawing: &Drawing) -> Result<(), DrawError> {
    let joints = drawing.clump.len();
    // Cannot overflow: no run is longer than a list, and one that would make the sum wrap stops it.
    let mut total = 0_usize;
    for (run, piece) in drawing.runs.iter().enumerate() {
        let (start, end) = (piece.joints.start, piece.joints.end);
        if start >= end || end > joints {
            return Err(DrawError::RunJoints {
                run,
                start,
                end,
                joints,
            });
        }
        total = total.saturating_add(end - start);
    }
    if total > joints {
        return Err(DrawError::SharedJoints {
            runs: total,
            joints,
        });
    }
    for (before, pair) in drawing.runs.windows(2).enumerate() {
        if pair[1].strand < pair[0].strand {
            return Err(DrawError::RunOrder {
                run: before + 1,
                strand: pair[1].strand,
                before: pair[0].strand,
            });
        }
    }
    Ok(())
}

fn check_sides(drawing: &Drawing) -> Result<(), DrawError> {
    let (discs, joints) = (drawing.sides.len(), drawing.clump.len());
    let sides = Strokes {
        stretches: &drawing.side_stretches,
        instances: 2,
        joints: 0..joints,
        discs,
    };
    match sides.stretches {
        Stretches::Everywhere if discs != 0 && discs != 2 * joints => {
            return Err(DrawError::Sides { discs, joints });
        }
        Stretches::Everywhere => {}
        Stretches::Within(_) => sides.check(|| "the clump's sides".to_owned())?,
    }
    if let Some(index) = first_that_is_not(&drawing.sides, is_disc) {
        let (_, joint) = sides.owner(index);
        let disc = drawing.sides[index];
        return Err(DrawError::ClumpDisc { joint, disc });
    }
    Ok(())
}

/// Strokes whose discs are listed.
struct Strokes<'a> {
    stretches: &'a Stretches,
    instances: usize,
    joints: Range<usize>,
    discs: usize,
}

impl Strokes<'_> {
    /// Looks at all stretches; `of` says whose they are.
    fn check(&self, of: impl Fn() -> String) -> Result<(), DrawError> {
        let Stretches::Within(lists) = self.stretches else {
            return Ok(());
        };
        if lists.len() != self.instances {
            return Err(DrawError::StretchLists {
                of: of(),
                lists: lists.len(),
                instances: self.instances,
            });
        }
        for (instance, list) in lists.iter().enumerate() {
            let mut end = self.joints.start;
            for Stretch { joints, first } in list {
                let is_there = end <= joints.start && joints.end <= self.joints.end;
                let has_discs = joints.start < joints.end
                    && *first <= self.discs
                    && joints.end - joints.start <= self.discs - first;
                if !(is_there && has_discs) {
                    return Err(DrawError::Stretch {
                        of: of(),
                        instance,
                        start: joints.start,
                        end: joints.end,
                        first: *first,
                        joints: self.joints.clone(),
                        discs: self.discs,
                    });
                }
                end = joints.end;
            }
        }
        Ok(())
    }

    /// The stroke and the joint that have a place in the list of discs; the first ones where nobody has it.
    fn owner(&self, place: usize) -> (usize, usize) {
        let (start, joints) = (self.joints.start, self.joints.len().max(1));
        let Stretches::Within(lists) = self.stretches else {
            return (place / joints, start + place % joints);
        };
        let stretches = lists.iter().enumerate();
        let mut stretches = stretches.flat_map(|(i, list)| list.iter().map(move |s| (i, s)));
        let owner = stretches.find(|(_, stretch)| stretch.places().contains(&place));
        owner.map_or((0, start), |(instance, stretch)| {
            (instance, stretch.joints.start + place - stretch.first)
        })
    }
}

fn check_layer(layer: &LayerStrokes, drawing: &Drawing) -> Result<(), DrawError> {
    let Range { start, end } = layer.joints;
    let all = drawing.clump.len();
    let is_whole = |run: &Run| {
        let Range {
            start: first,
            end: last,
        } = run.joints;
        last <= start || end <= first || (start <= first && last <= end)
    };
    let is_range = start <= end && end <= all;
    if !is_range || !(layer.joints == (0..all) || drawing.runs.iter().all(is_whole)) {
        return Err(DrawError::LayerJoints {
            layer: layer.name.clone(),
            start,
            end,
            joints: all,
        });
    }
    let joints = layer.joints.len();
    let (discs, colors) = (layer.discs.len(), layer.colors.len());
    let length = match layer.stretches {
        Stretches::Everywhere => layer.instances.checked_mul(joints),
        Stretches::Within(_) => Some(discs),
    };
    if length != Some(discs) || length != Some(colors) {
        return Err(DrawError::LayerLength {
            layer: layer.name.clone(),
            discs,
            colors,
            instances: layer.instances,
            joints,
        });
    }
    let strokes = Strokes {
        stretches: &layer.stretches,
        instances: layer.instances,
        joints: layer.joints.clone(),
        discs,
    };
    strokes.check(|| format!("layer \"{}\"", layer.name))?;
    if let Some(index) = first_that_is_not(&layer.discs, is_disc) {
        let (instance, joint) = strokes.owner(index);
        return Err(DrawError::LayerDisc {
            layer: layer.name.clone(),
            instance,
            joint,
            disc: layer.discs[index],
        });
    }
    if let Some(index) = first_that_is_not(&layer.colors, is_finite) {
        let (instance, joint) = strokes.owner(index);
        return Err(DrawError::LayerColor {
            layer: layer.name.clone(),
            instance,
            joint,
        });
    }
    Ok(())
}

fn is_disc(disc: &Disc) -> bool {
    let [x, y] = disc.center.to_array();
    // Each comparison is false for NaN.
    (x.abs() <= MAX_COORDINATE)
        & (y.abs() <= MAX_COORDINATE)
        & (0.0..=MAX_COORDINATE).contains(&disc.radius)
        & disc.inv_depth.is_finite()
        & disc.inv_depth_biased.is_finite()
}
