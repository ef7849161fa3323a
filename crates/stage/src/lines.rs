//! Lines of meshes as strands: which of them the eye sees, and where strokes are drawn along them (W, rows W3, W5, W7 and W8).
//!
//! Lines hang on nothing but the meshes and the eye, so that frames may be drawn in any order. A strand of theirs has no clump, and no number of
//! its own: what varies along it is fixed to the surface. Only where something varies along contours, which have no fixed place, as marks of brushes or the trembling of a hand do, these are followed
//! from frame to frame, at the preset's rate from the start on, as hair is simulated, and in a loop from the start of the round before: so a frame is the same
//! whichever frames are asked for. A moment between two frames follows the one before it, and none follows that moment.

mod marks;
mod mesh;
mod strand;

pub(crate) use strand::LineStrand;

use crate::files::StageError;
use crate::head::HeadModel;
use crate::look::LineSet;
use crate::names::{Names, meant_name};
use crate::neck::Neck;
use crate::preset::NamedLines;
use crate::script::HeadPose;
use effects::preset::{LayerSpec, PresetError, PresetErrors, suggestion};
use glam::Vec3;
use marks::Followed;
use mesh::LineMesh;
use mesh_lines::{Kind, Line, MeshError, View};
use rayon::prelude::*;
use render::Head;
use std::ops::Range;
use stroke_path::Camera;

/// The lines of a head that a look draws.
pub(crate) struct HeadLines {
    /// One for each angle of creases, as surfaces aren't smooth across a crease.
    meshes: Vec<LineMesh>,
    /// For each list of the look which of the meshes has them.
    mesh_of: Vec<usize>,
    /// For each list of the look what is seen of its lines.
    strands: Vec<Vec<LineStrand>>,
    /// For each mesh its contours from frame to frame, where something along them is to stay where it is.
    followed: Vec<Option<Followed>>,
    /// The whole frame to which they were followed, and what was seen then.
    at: Option<f64>,
    seen: Option<SeenFrom>,
    /// How often creases and borders were chained, mesh by mesh.
    #[cfg(test)]
    pub chained: usize,
}

/// What lines hang on: while it stays, there is nothing to follow.
#[derive(Clone, Copy, PartialEq)]
struct SeenFrom {
    eye: Vec3,
    /// Of a pixel at a distance of 1.
    pixel: f64,
    pose: HeadPose,
}

impl SeenFrom {
    fn of(camera: &Camera, pose: HeadPose) -> Self {
        Self {
            eye: camera.eye(),
            pixel: f64::from(camera.focal_px()).recip(),
            pose,
        }
    }
}

/// Frames closer to each other than this are one.
const SAME_FRAME: f64 = 1e-3;

impl HeadLines {
    /// None has been looked for yet.
    pub fn new(neck: &Neck, sets: &[LineSet], head: Head) -> Result<Self, StageError> {
        let mut lines = Self {
            meshes: Vec::new(),
            mesh_of: Vec::new(),
            strands: vec![Vec::new(); sets.len()],
            followed: Vec::new(),
            at: None,
            seen: None,
            #[cfg(test)]
            chained: 0,
        };
        for set in sets {
            let crease = set.crease();
            let known = lines.meshes.iter().position(|mesh| mesh.crease() == crease);
            lines.mesh_of.push(known.unwrap_or(lines.meshes.len()));
            if known.is_none() {
                let mesh = LineMesh::new(neck.rest(), crease, head);
                lines.meshes.push(mesh.map_err(fault)?);
                #[cfg(test)]
                {
                    lines.chained += 1;
                }
                lines.followed.push(None);
            }
            let followed = &mut lines.followed[lines.mesh_of[lines.mesh_of.len() - 1]];
            if set.is_followed() {
                followed.get_or_insert_default();
            }
        }
        Ok(lines)
    }

    /// The whole frames through which contours are still to be followed before they are looked for in frame `now`: none where they aren't followed. They
    /// begin anew where [`Self::frames_since`] has nothing.
    pub fn frames_before(&mut self, now: f64, round: Option<f64>) -> Range<i64> {
        if !self.is_followed() || !now.is_finite() {
            return 0..0;
        }
        self.frames_since(now, round).unwrap_or_else(|| {
            self.followed
                .iter_mut()
                .flatten()
                .for_each(|followed| *followed = Followed::default());
            self.at = None;
            self.seen = None;
            start_of(now, round)..end_of(now)
        })
    }

    /// The whole frames between the last one and frame `now`. Nothing where contours aren't followed from there: time went back, or what goes round in so
    /// many frames has come into another round. Going on would be cheaper, but then it would make a difference which frame is drawn first.
    pub fn frames_since(&self, now: f64, round: Option<f64>) -> Option<Range<i64>> {
        let goes_on =
            |at: &f64| *at <= now + SAME_FRAME && start_of(*at, round) == start_of(now, round);
        let at = self.at.filter(goes_on)?;
        Some((at + SAME_FRAME).floor() as i64 + 1..end_of(now))
    }

    /// Whether some contours are followed from frame to frame.
    pub fn is_followed(&self) -> bool {
        self.followed.iter().any(Option::is_some)
    }

    /// Whether the head was in this pose in the last frame.
    pub fn was_in(&self, pose: HeadPose) -> bool {
        self.seen.is_some_and(|seen| seen.pose == pose)
    }

    /// Whether frame `now`, in which the head has this pose, shows what the one before did: then contours are followed to it.
    pub fn stays(&mut self, camera: &Camera, pose: HeadPose, now: f64) -> bool {
        let stays = self.seen == Some(SeenFrom::of(camera, pose)) && !self.is_growing();
        if stays {
            self.at = Some(now);
        }
        stays
    }

    /// Whether a frame later shows more of lines that came from nowhere, even where nothing moves.
    pub fn is_growing(&self) -> bool {
        self.followed.iter().flatten().any(Followed::is_growing)
    }

    /// Looks for the edges anew where a mesh of numbered files has other triangles in this model.
    fn take_forms(&mut self, neck: &Neck, model: &HeadModel, head: Head) -> Result<(), StageError> {
        for mesh in self.meshes.iter_mut().filter(|mesh| !mesh.is_of(model)) {
            let rest = neck.rest().in_forms_of(model);
            *mesh = LineMesh::new(&rest, mesh.crease(), head).map_err(fault)?;
            #[cfg(test)]
            {
                self.chained += 1;
            }
        }
        Ok(())
    }

    /// Follows contours to frame `now`, in which the head is in this pose, without a picture.
    pub fn follow(
        &mut self,
        (neck, model, pose): (&Neck, &HeadModel, HeadPose),
        sets: &[LineSet],
        camera: &Camera,
        head: Head,
        now: f64,
    ) -> Result<(), StageError> {
        self.take_forms(neck, model, head)?;
        let seen_from = SeenFrom::of(camera, pose);
        let view = View::perspective(camera.eye()).map_err(fault)?;
        let pixel = seen_from.pixel;
        let sets = sets_of_meshes(&self.mesh_of, sets, self.meshes.len());
        let height_px = height_px(&view, pixel, head);
        let follow = |((mesh, followed), sets): ((&mut LineMesh, &mut Option<Followed>), Sets)| {
            let Some(followed) = followed else {
                return Ok(());
            };
            mesh.pose(model)?;
            let seen = mesh.seen(&view, pixel, wanted(mesh, &sets, true, head))?;
            followed.step(&seen, height_px)
        };
        let meshes = self.meshes.par_iter_mut().zip(&mut self.followed);
        let followed: Result<(), MeshError> = meshes.zip(sets).map(follow).collect();
        followed.map_err(fault)?;
        (self.at, self.seen) = (Some(now), Some(seen_from));
        Ok(())
    }

    /// Through how many frames contours were followed, mesh by mesh together.
    #[cfg(test)]
    pub fn steps(&self) -> usize {
        let followed = self.followed.iter().flatten();
        followed.map(|followed| followed.steps).sum()
    }

    /// Finds what the camera sees of the lines on the head in its pose: those of each list, in the look's order.
    pub fn find(
        &mut self,
        (neck, model, pose): (&Neck, &HeadModel, HeadPose),
        sets: &[LineSet],
        camera: &Camera,
        head: Head,
        now: f64,
    ) -> Result<(), StageError> {
        self.take_forms(neck, model, head)?;
        let seen_from = SeenFrom::of(camera, pose);
        // With another eye at the same time lines have no time to grow.
        let is_same_time = self.at.is_some_and(|at| (at - now).abs() <= SAME_FRAME);
        let is_there = self.seen == Some(seen_from) && (is_same_time || !self.is_growing());
        let is_whole = (now - now.round()).abs() <= SAME_FRAME;
        let view = View::perspective(camera.eye()).map_err(fault)?;
        let pixel = seen_from.pixel;
        let sets = sets_of_meshes(&self.mesh_of, sets, self.meshes.len());
        let height_px = height_px(&view, pixel, head);
        // The strands of each list of a mesh.
        let find = |((mesh, followed), sets): ((&mut LineMesh, &mut Option<Followed>), Sets)| {
            mesh.pose(model)?;
            let mesh = &*mesh;
            let is_followed = followed.is_some();
            let seen = mesh.seen(&view, pixel, wanted(mesh, &sets, is_followed, head))?;
            let mut between;
            let mut followed = followed.as_mut();
            if !is_there {
                if !is_whole {
                    between = followed.as_deref().cloned();
                    followed = between.as_mut();
                }
                if let Some(followed) = &mut followed {
                    followed.step(&seen, height_px)?;
                    if is_same_time {
                        followed.finish();
                    }
                }
            }
            let marks = followed.as_deref().map(Followed::marks);
            let strands = |(index, set): &(usize, &LineSet)| {
                let [halo_m, shortest_m] = [set.section.halo, set.section.shortest]
                    .map(|units| f64::from(units * head.unit_m()));
                let is_meant = |triangle| mesh.is_called(triangle, set.section.meshes());
                let marks = marks.as_ref().filter(|_| set.is_followed());
                let mut strands = seen.strands(set.kinds, &is_meant, halo_m, shortest_m, marks);
                if !set.has_marks() {
                    strands.iter_mut().for_each(|strand| strand.marks.clear());
                }
                (*index, strands)
            };
            Ok(sets.iter().map(strands).collect())
        };
        let meshes = self.meshes.par_iter_mut().zip(&mut self.followed);
        let found: Result<Vec<Vec<_>>, MeshError> = meshes.zip(sets).map(find).collect();
        for (index, strands) in found.map_err(fault)?.into_iter().flatten() {
            self.strands[index] = strands;
        }
        if is_whole {
            (self.at, self.seen) = (Some(now), Some(seen_from));
        }
        Ok(())
    }

    /// What was found last, for each list.
    pub fn found(&self) -> &[Vec<LineStrand>] {
        &self.strands
    }
}

/// The whole frame from which contours are followed to frame `now`: the first one, or of what goes round in so many frames that in which the round before
/// begins, so that they come out of each round as they went into it.
fn start_of(now: f64, round: Option<f64>) -> i64 {
    match round {
        Some(round) => {
            let rounds_before = ((now + SAME_FRAME) / round).floor() - 1.0;
            (rounds_before * round + SAME_FRAME).floor() as i64
        }
        None => now.floor().min(0.0) as i64,
    }
}

/// The whole frame that is the first one not before frame `now`.
fn end_of(now: f64) -> i64 {
    (now - SAME_FRAME).ceil() as i64
}

/// The lists of lines that are of one mesh, each with its place in the look.
type Sets<'s> = Vec<(usize, &'s LineSet)>;

/// Those of each of so many meshes.
fn sets_of_meshes<'s>(mesh_of: &[usize], sets: &'s [LineSet], meshes: usize) -> Vec<Sets<'s>> {
    let of_mesh = |mesh: usize| {
        let sets = sets.iter().enumerate();
        let own = sets.filter(|(index, _)| mesh_of[*index] == mesh);
        own.collect()
    };
    (0..meshes).map(of_mesh).collect()
}

/// Whether it makes a difference what the eye sees of a line of a mesh: some list draws it, or it is a contour that is followed.
fn wanted<'a>(
    mesh: &'a LineMesh,
    sets: &'a Sets,
    is_followed: bool,
    head: Head,
) -> impl Fn(&Line) -> bool + 'a {
    move |line| {
        is_followed && line.kind == Kind::Contour
            || (sets.iter()).any(|(_, set)| mesh.may_draw(set, line, head.unit_m()))
    }
}

/// How many pixels high a head is where its middle is.
fn height_px(view: &View, pixel: f64, head: Head) -> f64 {
    let height_px = f64::from(head.height_m) * view.image_scale(head.center.as_dvec3()) / pixel;
    match height_px.is_finite() {
        true => height_px.max(1.0),
        false => 1.0,
    }
}

fn fault(error: MeshError) -> StageError {
    StageError::Lines(error.to_string())
}

/// That the meshes which lines are of are there, and the lines which layers draw. A head that the caller gave in place of the preset's may lack
/// meshes: that is noted.
///
/// # Errors
///
/// Names of which there is none.
pub(crate) fn check(
    lines: &[NamedLines],
    layers: &[LayerSpec],
    head: Option<&HeadModel>,
    wears_ties: bool,
    is_given: bool,
    notes: &mut Vec<String>,
) -> Result<(), StageError> {
    let mut mistakes = Vec::new();
    for named in lines {
        let known = head.map_or(Vec::new(), |head| mesh::names(head, wears_ties));
        let names = named.section.meshes();
        let may_lack = mesh::MAY_LACK;
        let all = || known.iter().copied().chain(may_lack);
        let message = match names.unknown(all) {
            _ if names.is_empty() => "of: it names no mesh".to_owned(),
            None => continue,
            Some(name) => {
                let hint = meant_name(name, known.iter().copied());
                format!("of: there is no mesh `{name:.40}` that has lines{hint}")
            }
        };
        match is_given {
            true => notes.push(format!("lines: {message}")),
            false => mistakes.push(named.mistake(message)),
        }
    }
    for layer in layers.iter().filter(|layer| layer.effect.is_for_lines()) {
        let names = Names(layer.on.as_deref().unwrap_or_default());
        let known = || {
            lines
                .iter()
                .filter_map(|lines| lines.section.name.as_deref())
        };
        let message = match names.unknown(known) {
            _ if names.is_empty() => "on: it names no lines".to_owned(),
            None => continue,
            Some(name) => {
                let hint = suggestion(name, known());
                format!("on: the preset has no lines called `{name:.40}`{hint}")
            }
        };
        let layer_name = layer.name.clone();
        match layer.on_place.clone() {
            Some(place) => mistakes.push(PresetError { place, message }),
            None => {
                let layer = layer_name;
                return Err(StageError::MeshLayer { layer, message });
            }
        }
    }
    Ok(PresetErrors::report(mistakes)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Files, Preset, Scene};
    use effects::Registry;

    /// Lines that no list draws are left out before it is asked what the eye sees of them: the strands are those of all.
    #[test]
    fn what_no_list_draws_is_not_wanted_and_makes_no_difference() {
        for (kind, shortest) in [("contour", 0), ("crease", 40), ("border, crease", 100)] {
            let text = format!(
                "(version: 1, head: (shape: none), meshes: [(shape: gear), (shape: wings, at: (1, 0, 0))], \
                 lines: [(name: \"rim\", of: \"gear\", kind: \"{kind}\", shortest: {shortest})], \
                 layers: [(effect: \"line.ink\", on: \"rim\", params: (wobble: 0))])"
            );
            let mut registry = Registry::new();
            effects_surface::register(&mut registry).unwrap();
            let preset = Preset::parse("look.ron", &text, &registry).unwrap();
            let scene = Scene::load(&preset, &Files::default()).unwrap();
            let (set, head) = (&scene.look().lines[0], scene.head());
            let neck = scene.objects()[0].neck().unwrap();
            let mesh = LineMesh::new(neck.rest(), set.crease(), head).unwrap();
            let eye = head.center + head.height_m * Vec3::new(1.0, 1.5, 3.0);
            let view = View::perspective(eye).unwrap();
            let shortest_m = f64::from(set.section.shortest * head.unit_m());
            let is_meant = |triangle| mesh.is_called(triangle, set.section.meshes());
            let sets = vec![(0, set)];
            let wanted = wanted(&mesh, &sets, false, head);
            let seen = [
                mesh.seen(&view, 1e-3, |_| true).unwrap(),
                mesh.seen(&view, 1e-3, &wanted).unwrap(),
            ];
            let [all, some] = seen
                .each_ref()
                .map(|seen| seen.strands(set.kinds, &is_meant, 0.0, shortest_m, None));
            assert!(!all.is_empty(), "{kind}");
            assert_eq!(all, some, "{kind}");
            let lines = &seen[0].lines;
            let count = lines.iter().filter(|line| wanted(line)).count();
            assert!(count < lines.len(), "{kind}: {count}");
        }
    }

    /// A figure's outlines thin out above where it is cut off; no line is drawn along the cut.
    #[test]
    fn lines_end_above_the_crop() {
        let text = r#"(version: 1, head: (shape: figure, dress: collar, crop: 0.7), hair: (file: "styles/pixie.style.ron"),
            lines: [(name: "rim", of: "skin, dress", kind: "contour, crease", shortest: 0)],
            layers: [(effect: "line.ink", on: "rim")])"#;
        let mut registry = Registry::new();
        effects_surface::register(&mut registry).unwrap();
        let preset = Preset::parse("look.ron", text, &registry).unwrap();
        let files = Files {
            preset_folder: concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets").into(),
            ..Files::default()
        };
        let scene = Scene::load(&preset, &files).unwrap();
        let (set, head) = (&scene.look().lines[0], scene.head());
        let neck = scene.objects()[0].neck().unwrap();
        let model = neck.rest();
        let lowest = model
            .mesh
            .positions
            .iter()
            .map(|p| p.y)
            .fold(f32::MAX, f32::min);
        let mesh = LineMesh::new(model, set.crease(), head).unwrap();
        // From the front and a little from below, where the cut is the body's lower outline.
        let eye = head.center + head.height_m * Vec3::new(1.0, -0.5, 5.0);
        let view = View::perspective(eye).unwrap();
        let seen = mesh.seen(&view, 1e-3, |_| true).unwrap();
        let lowest_of = |is_meant: &dyn Fn(u32) -> bool| {
            let strands = seen.strands(set.kinds, is_meant, 0.0, 0.0, None);
            let points = strands.iter().flat_map(|strand| &strand.points);
            points.map(|p| p.y).fold(f32::MAX, f32::min) - lowest
        };
        let all = lowest_of(&|_| true);
        let drawn = lowest_of(&|triangle| mesh.is_called(triangle, set.section.meshes()));
        // Half of the 55 mm in which outlines thin out.
        assert!(all < 0.005, "{all}");
        assert!((0.01..0.1).contains(&drawn), "{drawn}");
    }
}
