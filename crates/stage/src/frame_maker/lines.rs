//! What frames have of the lines of meshes: found for each frame in [`crate::lines`], and drawn as paths behind all hair.

use super::along;
use crate::files::StageError;
use crate::lines::{HeadLines, LineStrand};
use crate::motion::{Motion, ObjectMotion, held_time, time_of_frame};
use crate::neck::PosedHead;
use crate::object::Object;
use crate::placement::Placement;
use crate::preset::HeldChoice;
use crate::reach::Sight;
use crate::scene::Scene;
use crate::script::HeadPose;
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
    /// Whether they were looked for in the last frame: there is a head, and it has been seen.
    is_there: bool,
    /// For each list of its look's lines their joints in the last frame, and for each of their layers once more.
    joints: Vec<(Range<usize>, Vec<Range<usize>>)>,
}

/// When lines are looked for, and how many frames a second there are.
#[derive(Clone, Copy)]
pub(super) struct LineTime {
    time_s: f64,
    fps: f64,
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

    /// Whether they would be found as they are at another time, at which the object's head is as it was: in between it was so, too, as far as that matters.
    pub fn stay(&self, object: &Object, time: LineTime) -> bool {
        let lines = self.of_head.as_ref();
        lines
            .filter(|lines| lines.is_followed())
            .is_none_or(|lines| {
                let frames = lines.frames_since(time.frame(), time.round(object));
                let was_so = |frame: i64| lines.was_in(pose_in(frame as f64, time.fps, object));
                frames.is_some_and(|mut frames| frames.all(was_so))
            })
    }

    /// Follows the lines of the object's head to this frame, but for the frame itself: through poses that it was in before. It is left in its own.
    pub fn follow(
        &mut self,
        object: &Object,
        posed: Option<&mut PosedHead>,
        motion: &ObjectMotion,
        time: LineTime,
        sight: &Sight,
    ) -> Result<(), StageError> {
        let look = object.look();
        let sets = &look.lines;
        self.is_there = !sets.is_empty() && object.neck().is_some() && posed.is_some();
        let (Some(neck), Some(posed), true) = (object.neck(), posed, self.is_there) else {
            return Ok(());
        };
        let rest_head = object.hair().head;
        let lines = match &mut self.of_head {
            Some(lines) => lines,
            lines => lines.insert(HeadLines::new(neck, sets, rest_head)?),
        };
        for frame in lines.frames_before(time.frame(), time.round(object)) {
            let frame = frame as f64;
            let pose = pose_in(frame, time.fps, object);
            if lines.stays(sight.camera(), pose, frame) {
                continue;
            }
            let model = posed.in_pose(neck, pose);
            lines.follow((neck, model, pose), sets, sight.camera(), rest_head, frame)?;
        }
        posed.in_pose(neck, motion.head_pose());
        Ok(())
    }

    /// Finds what is seen of them in this frame, in which the head is `posed`.
    pub fn find(
        &mut self,
        object: &Object,
        posed: Option<&PosedHead>,
        motion: &ObjectMotion,
        time: LineTime,
        sight: &Sight,
    ) -> Result<(), StageError> {
        let lines = self.of_head.as_mut().filter(|_| self.is_there);
        let (Some(lines), Some(neck), Some(posed)) = (lines, object.neck(), posed) else {
            return Ok(());
        };
        let model = (neck, posed.model(), motion.head_pose());
        let (sets, head) = (&object.look().lines, object.hair().head);
        lines.find(model, sets, sight.camera(), head, time.frame())
    }

    /// Appends what was found, list after list, and notes which joints each has.
    pub fn push(
        &mut self,
        object: &Object,
        sight: &Sight,
        lists: &mut LineLists,
    ) -> Result<(), StageError> {
        self.joints.clear();
        let look = object.look();
        let sets = &look.lines;
        let found = self.of_head.as_ref().filter(|_| self.is_there);
        let found = found.map(HeadLines::found).unwrap_or_default();
        let found = found.iter().map(Vec::as_slice);
        let found = found.chain(std::iter::repeat(&[][..]));
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

/// Where the script has the object's head in a whole frame; a hand that turns it live isn't asked.
fn pose_in(frame: f64, fps: f64, object: &Object) -> HeadPose {
    let section = &object.look().sections.motion;
    let time_s = time_of_frame(frame, fps);
    object.script().head_at(match section.held {
        HeldChoice::All => held_time(section, fps as f32, time_s),
        HeldChoice::Hair => time_s,
    })
}

impl LineTime {
    /// That of a scene in motion.
    pub fn of(scene: &Scene, motion: &Motion) -> Self {
        Self {
            time_s: f64::from(motion.time_s()),
            fps: f64::from(scene.fps()),
        }
    }

    /// In how many frames the object's script goes round, where it does.
    fn round(self, object: &Object) -> Option<f64> {
        let script = object.script();
        let period = script.period.filter(|_| script.closes)?;
        Some(period * self.fps)
    }

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
    use super::ObjectLines;
    use crate::frame_maker::FrameMaker;
    use crate::lines::HeadLines;
    use crate::{Files, Motion, Preset, Scene};
    use effects::Registry;
    use glam::{Vec2, Vec3};
    use stroke_path::{Camera, OrbitView};

    const CHALK: &str = "effect: \"line.chalk\", brush: (kind: charcoal)";
    /// A hand that neither presses nor trembles.
    const STEADY: &str = "effect: \"line.ink\", params: (wobble: 0)";
    const TREMBLING: &str = "effect: \"line.ink\", params: (wobble: 1, wobble_length: 0.1)";

    /// A thing with the lines of these kinds, drawn so.
    fn scene(thing: &str, kind: &str, layer: &str) -> Scene {
        let text = format!(
            "(version: 1, head: (shape: none), meshes: [(shape: {thing})], scene: (size: (90, 90), samples: 1), \
             lines: [(name: \"rim\", kind: \"{kind}\")], layers: [({layer}, on: \"rim\")])"
        );
        let mut registry = Registry::new();
        effects_surface::register(&mut registry).unwrap();
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        Scene::load(&preset, &Files::default()).unwrap()
    }

    /// What is `counted` of a scene's lines after each of these frames.
    fn counts(scene: &Scene, frames: &[u32], counted: impl Fn(&HeadLines) -> usize) -> Vec<usize> {
        let (mut motion, mut maker) = (Motion::new(), FrameMaker::new());
        let after = |frame: &u32| {
            motion.advance_to(scene, *frame as f32 / 24.0).unwrap();
            assert!(!maker.frame(scene, &motion).unwrap().paths.is_empty());
            let ObjectLines { of_head, .. } = &maker.objects[0].lines;
            counted(of_head.as_ref().unwrap())
        };
        frames.iter().map(after).collect()
    }

    /// Through how many frames the contours of a thing are followed until one of these was drawn, frame after frame.
    fn steps(thing: &str, layer: &str, frames: &[u32]) -> Vec<usize> {
        counts(&scene(thing, "contour", layer), frames, HeadLines::steps)
    }

    #[test]
    fn a_still_thing_is_followed_once() {
        for layer in [CHALK, TREMBLING] {
            assert_eq!(steps("cup", layer, &[0, 1, 5, 100, 5000]), [1; 5]);
            assert_eq!(steps("cup", layer, &[5000]), [1]);
        }
    }

    #[test]
    fn what_moves_is_followed_through_every_frame_once() {
        for layer in [CHALK, TREMBLING] {
            assert_eq!(steps("wings", layer, &[0, 1, 5, 5, 9]), [1, 2, 6, 6, 10]);
            assert_eq!(steps("wings", layer, &[9]), [10]);
        }
    }

    #[test]
    fn a_hand_that_does_not_tremble_follows_nothing() {
        assert_eq!(steps("wings", STEADY, &[0, 1, 9]), [0; 3]);
        // Nor does one that draws edges alone, which have places of their own.
        let edges = scene("wings", "crease", TREMBLING);
        assert_eq!(counts(&edges, &[0, 1, 9], HeadLines::steps), [0; 3]);
    }

    /// Also of a mesh that bends: creases are those at rest.
    #[test]
    fn creases_are_chained_once() {
        for (thing, layer) in [("cup", STEADY), ("cup", CHALK), ("wings", TREMBLING)] {
            let scene = scene(thing, "contour, crease, border", layer);
            let chained = counts(&scene, &[0, 1, 2, 9, 4], |lines| lines.chained);
            assert_eq!(chained, [1; 5], "{thing} {layer}");
        }
    }

    /// While the eye goes around a cup, what a hand does stays on its contours: it slides by less than 0.3 pixels in 1/24 s in the median.
    #[test]
    fn a_hands_trembling_stays_on_the_line_as_the_eye_moves() {
        let scene = scene("cup", "contour", TREMBLING);
        let (mut motion, mut maker) = (Motion::new(), FrameMaker::new());
        // Places and how far along the line they are, head heights, of the runs of a frame.
        let mut before: Vec<(Vec3, f32)> = Vec::new();
        let mut slides = Vec::new();
        for frame in 0..24_u8 {
            motion.advance_to(&scene, f32::from(frame) / 24.0).unwrap();
            let head = scene.head();
            let view = OrbitView {
                target: head.center,
                yaw_degrees: 0.5 * f32::from(frame),
                pitch_degrees: 20.0,
                distance_m: 3.0 * head.height_m,
                vertical_fov_degrees: 30.0,
            };
            let camera = Camera::orbit(view, [960, 720], 0.01).unwrap();
            let pixel = |place: Vec3| camera.project(camera.view_from_world(place));
            let head_px = camera.px_per_metre(camera.depth(head.center)) * head.height_m;
            let made = maker.frame_seen_by(&scene, &motion, camera).unwrap();
            let along: Vec<f32> = made.rest_positions.iter().map(|place| place.x).collect();
            let links = || {
                let runs = made.paths.runs.iter();
                runs.flat_map(|run| run.joints.start..run.joints.end - 1)
            };
            // Nearest in the picture, within 6 pixels.
            let nearest = |point: Vec2| {
                let found = links().map(|joint| {
                    let [a, b] = [joint, joint + 1].map(|joint| pixel(made.paths.position[joint]));
                    let way = b - a;
                    let share = (point - a).dot(way) / way.length_squared().max(1e-12);
                    let share = share.clamp(0.0, 1.0);
                    let there = along[joint] + (along[joint + 1] - along[joint]) * share;
                    (a.lerp(b, share).distance(point), there)
                });
                let nearest = found.min_by(|a, b| a.0.total_cmp(&b.0));
                nearest.filter(|(off, _)| *off < 6.0)
            };
            for (place, was) in &before {
                if let Some((_, is)) = nearest(pixel(*place)) {
                    slides.push((is - was).abs() * head_px);
                }
            }
            let joints = links().step_by(5);
            let samples = joints.map(|joint| (made.paths.position[joint], along[joint]));
            before = samples.collect();
        }
        slides.sort_by(f32::total_cmp);
        assert!(slides.len() > 1000, "{}", slides.len());
        let [median, most] = [0.5, 0.9].map(|share| slides[(slides.len() as f32 * share) as usize]);
        assert!(median < 0.3 && most < 3.0, "{median} {most}");
    }
}
