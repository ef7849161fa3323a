//! What frames have of the lines of meshes: found for each frame in [`crate::lines`], and drawn as paths behind all hair.

use super::along;
use crate::files::StageError;
use crate::lines::{HeadLines, LineStrand};
use crate::look::LineSet;
use crate::motion::{ObjectMotion, held_time};
use crate::neck::PosedHead;
use crate::object::Object;
use crate::placement::Placement;
use crate::reach::Sight;
use effects::layer_seed;
use glam::Vec3;
use render::{Head, NO_COLOR, NO_TAPER, StrandInfo};
use std::ops::Range;
use stroke_path::{PathKind, Paths};

/// The lines of an object's head.
#[derive(Default)]
pub(super) struct ObjectLines {
    /// Made where they are first drawn.
    of_head: Option<HeadLines>,
    /// For each list of its look's lines their joints in the last frame, and for each of their layers once more.
    joints: Vec<(Range<usize>, Vec<Range<usize>>)>,
}

/// When lines are looked for, and how many frames a second there are.
#[derive(Clone, Copy)]
pub(super) struct LineTime {
    pub time_s: f64,
    pub fps: f64,
}

/// The lists of a frame that lines are appended to, and to each joint what it is told where something reads that.
pub(super) struct LineLists<'a> {
    pub strands: &'a mut Vec<StrandInfo>,
    pub paths: &'a mut Paths,
    pub normals: Option<&'a mut Vec<Vec3>>,
    pub rest_positions: Option<&'a mut Vec<Vec3>>,
    pub marks: Option<&'a mut Vec<f32>>,
}

/// No place along marks: that of hair is its length.
pub(super) const NO_MARK: f32 = -1.0;

impl ObjectLines {
    /// Drops what was kept of another object or look.
    pub fn forget(&mut self) {
        self.of_head = None;
    }

    /// Whether some of them are still to be drawn longer.
    pub fn is_growing(&self) -> bool {
        self.of_head.as_ref().is_some_and(HeadLines::is_growing)
    }

    /// Appends what is seen of the lines of the object's head, list after list, and notes which joints each has.
    pub fn push(
        &mut self,
        object: &Object,
        posed: Option<&mut PosedHead>,
        motion: &ObjectMotion,
        time: LineTime,
        sight: &Sight,
        lists: &mut LineLists,
    ) -> Result<(), StageError> {
        self.joints.clear();
        let look = object.look();
        let sets = &look.lines;
        if sets.is_empty() {
            return Ok(());
        }
        let start = lists.paths.len();
        let none = |set: &LineSet| (start..start, vec![start..start; set.layers.len()]);
        let (Some(neck), Some(posed)) = (object.neck(), posed) else {
            self.joints.extend(sets.iter().map(none));
            return Ok(());
        };
        let rest_head = object.hair().head;
        let lines = match &mut self.of_head {
            Some(lines) => lines,
            lines => lines.insert(HeadLines::new(neck, sets, rest_head)?),
        };
        let now = time.frame();
        for frame in lines.frames_before(now) {
            // Where the script has the head then; a hand that turns it live isn't asked.
            let frame = frame as f64;
            let held = held_time(&look.sections.motion, time.fps as f32, frame / time.fps);
            let pose = object.script().head_at(held);
            if lines.stays(sight.camera(), pose, frame) {
                continue;
            }
            let model = posed.in_pose(neck, pose);
            lines.follow((model, pose), sight.camera(), rest_head, frame)?;
        }
        let pose = motion.head_pose();
        let model = (posed.in_pose(neck, pose), pose);
        let found = lines.find(model, sets, sight.camera(), rest_head, now)?;
        for (set, found) in sets.iter().zip(found) {
            let start = lists.paths.len();
            let name = set.section.name.as_deref().unwrap_or_default();
            let id = layer_seed(look.seed, name);
            for strand in found
                .iter()
                .filter(|strand| sight.may_see(&strand.points, 0.0))
            {
                lists.push(strand, id, sight, object.placement())?;
            }
            let own = start..lists.paths.len();
            object.placement().joints(lists.paths, own.clone(), &mut []);
            let of_layers = vec![own.clone(); set.layers.len()];
            self.joints.push((own, of_layers));
        }
        Ok(())
    }

    /// What a frame says of the lines of this object, whose head is there.
    pub fn of_frame<'a>(
        &'a self,
        object: &'a Object,
        head: Head,
    ) -> impl Iterator<Item = render::Object<'a>> {
        let look = object.look();
        let lists = look.lines.iter().zip(&self.joints);
        lists.map(move |(set, (joints, layer_joints))| render::Object {
            joints: joints.clone(),
            head,
            solid: None,
            surface_bias_m: render::ON_SURFACES,
            clump: &look.line_clump,
            seed: look.seed,
            layers: &set.layers,
            layer_joints,
        })
    }
}

impl LineTime {
    /// The frame that it is: a whole one where it is that as exactly as a time can say.
    fn frame(self) -> f64 {
        let now = self.time_s * self.fps;
        match (now - now.round()).abs() <= now.abs() * f64::from(f32::EPSILON) {
            true => now.round(),
            false => now,
        }
    }
}

impl LineLists<'_> {
    /// Appends a strand of that number.
    fn push(
        &mut self,
        strand: &LineStrand,
        id: u32,
        sight: &Sight,
        placement: Placement,
    ) -> Result<(), StageError> {
        let mean = strand.points.iter().sum::<Vec3>() / strand.points.len() as f32;
        let first = self.paths.len();
        let kind = PathKind::Linear { subdivision: 1 };
        self.paths.push_pieces(
            self.strands.len(),
            &strand.points,
            &[],
            None,
            kind,
            sight.camera(),
        )?;
        self.push_inputs(strand, first, placement);
        self.strands.push(StrandInfo {
            id,
            mean: placement.point(mean),
            size: 0.0,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        });
        Ok(())
    }

    /// Appends what a strand's joints are told, from joint `first` on.
    fn push_inputs(&mut self, strand: &LineStrand, first: usize, placement: Placement) {
        let u = &self.paths.u[first..];
        if let Some(normals) = &mut self.normals {
            let first = normals.len();
            let normal = |u: &f32| along(&strand.normals, *u, Vec3::lerp).normalize_or(Vec3::Y);
            normals.extend(u.iter().map(normal));
            placement.turn(&mut normals[first..]);
        }
        if let Some(positions) = &mut self.rest_positions {
            positions.extend(u.iter().map(|u| along(&strand.rest, *u, Vec3::lerp)));
        }
        if let Some(marks) = &mut self.marks {
            let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
            let mark = |u: &f32| match strand.marks.is_empty() {
                true => NO_MARK,
                false => along(&strand.marks, *u, mix),
            };
            marks.extend(u.iter().map(mark));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::frame_maker::FrameMaker;
    use crate::{Files, Motion, Preset, Scene};
    use effects::Registry;

    /// Through how many frames the contours of a thing are followed until one of these was drawn, frame after frame.
    fn steps(thing: &str, frames: &[u32]) -> Vec<usize> {
        let text = format!(
            "(version: 1, head: (shape: none), meshes: [(shape: {thing})], scene: (size: (90, 90), samples: 1), \
             lines: [(name: \"rim\")], layers: [(effect: \"line.chalk\", on: \"rim\", brush: (kind: charcoal))])"
        );
        let mut registry = Registry::new();
        effects_surface::register(&mut registry).unwrap();
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let scene = Scene::load(&preset, &Files::default()).unwrap();
        let (mut motion, mut maker) = (Motion::new(), FrameMaker::new());
        let after = |frame: &u32| {
            motion.advance_to(&scene, *frame as f32 / 24.0).unwrap();
            assert!(!maker.frame(&scene, &motion).unwrap().marks.is_empty());
            let lines = maker.objects[0].lines.of_head.as_ref().unwrap();
            lines.steps()
        };
        frames.iter().map(after).collect()
    }

    #[test]
    fn a_still_thing_is_followed_once() {
        assert_eq!(steps("cup", &[0, 1, 5, 100, 5000]), [1; 5]);
        assert_eq!(steps("cup", &[5000]), [1]);
    }

    #[test]
    fn what_moves_is_followed_through_every_frame_once() {
        assert_eq!(steps("wings", &[0, 1, 5, 5, 9]), [1, 2, 6, 6, 10]);
        assert_eq!(steps("wings", &[9]), [10]);
    }
}
