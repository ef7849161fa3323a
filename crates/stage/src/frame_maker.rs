//! Frames of a scene in motion. What a frame needs is kept and reused.

mod lines;
mod made;
mod meshes;
#[cfg(test)]
mod tests;

use crate::bodies::Body;
use crate::files::StageError;
use crate::head::layers::{Clips, MeshLayers};
use crate::hem;
use crate::levels::levels;
use crate::look::{LineSet, Look};
use crate::material::Material;
use crate::motion::{Motion, ObjectMotion};
use crate::neck::PosedHead;
use crate::object::{Object, PathShape};
use crate::reach::Sight;
use crate::scene::Scene;
use crate::script::HeadPose;
use crate::zones;
use effects::{Input, Layer};
use glam::{Vec2, Vec3};
use lines::{LineLists, LineTime, NO_MARK, ObjectLines};
use made::ObjectPaths;
use meshes::ObjectMeshes;
use rayon::prelude::*;
use render::{Ball, Frame, MeshLayer, StrandInfo};
use std::ops::Range;
use std::sync::Arc;
use stroke_path::{Camera, PathError, PathRun, Paths};

/// How many strands a thread makes the paths of at a time, and how many such parts there are before they are put together, which
/// keeps the parts of dense hair small.
const PART: usize = 16;
const PARTS: usize = 64;

/// Makes frames of scenes.
#[derive(Default)]
pub struct FrameMaker {
    /// Of each object the hair's strands, then those of the last frame's made paths.
    strands: Vec<StrandInfo>,
    paths: Paths,
    /// Working memory: paths that are made beside each other.
    parts: Vec<Paths>,
    /// Material normals of the paths' joints; empty where nothing reads them.
    normals: Vec<Vec3>,
    /// Where the joints' hair is at rest; empty where nothing reads it.
    rest_positions: Vec<Vec3>,
    /// How the joints' hair runs at rest; empty where nothing reads it.
    rest_forwards: Vec<Vec3>,
    /// How far joints are from the ends of their strands; empty where nothing reads it.
    from_ends: Vec<Vec2>,
    path_weights: Vec<f32>,
    /// Where joints of lines are along the marks of brushes; empty where none has such.
    marks: Vec<f32>,
    objects: Vec<ObjectFrame>,
    camera: Option<Camera>,
    /// Look and time (seconds) of the last frame.
    of: Option<(Arc<Look>, f32)>,
    /// Whether strands are drawn that no picture can show: to hold pictures without them against.
    #[cfg(test)]
    keeps_unseen: bool,
}

/// An object in the last frame.
struct ObjectFrame {
    of: Object,
    pose: HeadPose,
    /// The script's own time of the pose in seconds, where bodies are drawn that move by themselves; else 0.
    bodies_s: f64,
    points: Vec<Vec3>,
    /// The level of each strand of its hair; empty where there is one level.
    levels: Vec<u32>,
    /// The layers that leave each strand of its hair out ([`StrandInfo`]); empty where none does.
    left_out_by: Vec<u32>,
    /// Strands of hair of which nothing can be seen, so that it is left out as a whole.
    unseen: usize,
    /// Strands that are not drawn, as hair is thin.
    merged: usize,
    /// Its hair's strands, and its joints.
    strands: Range<usize>,
    joints: Range<usize>,
    made: ObjectPaths,
    layer_joints: Vec<Range<usize>>,
    /// Normals of the links, where something reads them.
    material: Option<Material>,
    /// Made where the head is first seen: a crowd has many that never are.
    head: Option<PosedHead>,
    /// What hides hair, in the world.
    solid: Option<Ball>,
    lines: ObjectLines,
}

impl FrameMaker {
    /// One that has made no frame.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The frame of the hair as it stands, seen by the scene's own camera.
    ///
    /// # Errors
    ///
    /// When camera or paths cannot be made.
    #[inline(never)] // a stage of a frame, which `cargo xtask bench count` finds by its name
    pub fn frame<'a>(
        &'a mut self,
        scene: &'a Scene,
        motion: &Motion,
    ) -> Result<Frame<'a>, StageError> {
        self.frame_seen_by(scene, motion, scene.own_camera()?)
    }

    /// The frame of the hair as it stands, seen by a camera of the caller's.
    ///
    /// # Errors
    ///
    /// When paths cannot be made.
    pub fn frame_seen_by<'a>(
        &'a mut self,
        scene: &'a Scene,
        motion: &Motion,
        camera: Camera,
    ) -> Result<Frame<'a>, StageError> {
        let shows_all = self.shows_all();
        // A frame that fails is none that another could be like.
        self.of = None;
        let Self {
            strands,
            paths,
            parts,
            normals,
            rest_positions,
            rest_forwards,
            from_ends,
            path_weights,
            marks,
            objects,
            ..
        } = self;
        paths.clear();
        strands.clear();
        normals.clear();
        rest_positions.clear();
        rest_forwards.clear();
        path_weights.clear();
        marks.clear();
        objects.truncate(scene.objects().len());
        let mut looks = scene.objects().iter().map(Object::look);
        let reads_material = looks
            .clone()
            .any(|look| look.reads_material() || look.lines_read(Input::MaterialNormal));
        let reads_rest = looks
            .clone()
            .any(|look| look.reads_rest() || look.lines_read(Input::RestPosition));
        let reads_rest_forward = looks.clone().any(Look::reads_rest_forward);
        let reads_ends = looks.clone().any(Look::reads_ends);
        let has_marks = looks
            .clone()
            .any(|look| look.lines.iter().any(LineSet::has_marks));
        let reads_weights = looks.any(Look::reads_weights);
        let light = scene.look().light(&camera, motion.head(scene));
        let section = &scene.look().sections.scene;
        let mut surfaces = Vec::new();
        let mut mesh_layers = Vec::new();
        let looks = scene.objects().iter().map(Object::look);
        let clips = Clips::of(looks.flat_map(|look| &look.layers))?;
        let (mut decals, mut layers_before) = (Vec::new(), 0);
        let time = LineTime::of(scene, motion);
        for (index, object) in scene.objects().iter().enumerate() {
            match objects.get_mut(index) {
                Some(frame) => frame.follow(object),
                None => objects.push(ObjectFrame::new(object)),
            }
            let frame = &mut objects[index];
            let motion = motion.of(index, object);
            let own_camera = object.placement().own_camera(&camera);
            let sight = Sight::new(&own_camera, object, section.detail, shows_all);
            frame.keep(motion);
            let first_layer = mesh_layers.len();
            let names = MeshLayers::new(&object.look().mesh_layers, first_layer, &clips);
            let meshes = ObjectMeshes {
                object,
                index,
                motion,
                sight: &sight,
                light: object.placement().own_light(light),
                layers: &names,
            };
            let (mut posed, mut lines) = (frame.head.take(), std::mem::take(&mut frame.lines));
            let weights = reads_weights.then_some(&mut *path_weights);
            let (pushed, (seen, found)) = rayon::join(
                || {
                    frame.push_strands(motion, &sight, strands, (&mut *parts, &mut *paths))?;
                    let paths = (&mut *parts, &mut *paths);
                    frame.push_made_paths(motion, &sight, light, strands, paths, weights)
                },
                || {
                    meshes.pose(&mut posed);
                    let followed = lines.follow(object, posed.as_mut(), motion, time, &sight);
                    let posed = posed.as_ref();
                    let (seen, found) = rayon::join(
                        || meshes.seen(posed),
                        || lines.find(object, posed, motion, time, &sight),
                    );
                    (seen, followed.and(found))
                },
            );
            (frame.head, frame.lines) = (posed, lines);
            pushed?;
            found?;
            frame.solid = seen.solid;
            surfaces.extend(seen.surfaces);
            if reads_material {
                frame.push_material_normals(motion, paths, normals);
            }
            if reads_rest {
                frame.push_rest_positions(paths, rest_positions);
            }
            if reads_rest_forward {
                frame.push_rest_forwards(paths, rest_forwards);
            }
            let own_normals = normals.get_mut(frame.joints.clone());
            object
                .placement()
                .joints(paths, frame.joints.clone(), own_normals.unwrap_or_default());
            let look = object.look();
            let head = object.placement().head(motion.head(object));
            mesh_layers.extend(look.mesh_layers.iter().map(|layer| MeshLayer {
                layer,
                head,
                seed: look.seed,
            }));
            let layers = look.layers.iter().zip(layers_before..);
            let of_layer = |(layer, index)| clips.decal(layer, index, head.height_m);
            decals.extend(layers.filter_map(of_layer));
            layers_before += look.layers.len();
        }
        if has_marks {
            marks.resize(paths.len(), NO_MARK);
        }
        let mut lists = LineLists {
            strands: &mut *strands,
            paths: &mut *paths,
            normals: reads_material.then_some(normals),
            rest_positions: reads_rest.then_some(rest_positions),
            marks: has_marks.then_some(marks),
        };
        for (index, object) in scene.objects().iter().enumerate() {
            let own_camera = object.placement().own_camera(&camera);
            let sight = Sight::new(&own_camera, object, section.detail, shows_all);
            objects[index].lines.push(object, &sight, &mut lists)?;
        }
        if reads_rest_forward {
            rest_forwards.resize(paths.len(), Vec3::ZERO);
        }
        if reads_weights {
            path_weights.resize(paths.len(), 1.0);
        }
        if reads_ends {
            render::from_ends(paths, from_ends);
        } else {
            from_ends.clear();
        }
        let head_of = |index: usize, object: &Object| {
            let head = motion.of(index, object).head(object);
            object.placement().head(head)
        };
        let of_frame = |(index, (frame, object)): (usize, (&'a ObjectFrame, &'a Object))| {
            let look = object.look();
            render::Object {
                joints: frame.joints.clone(),
                head: head_of(index, object),
                solid: frame.solid,
                surface_bias_m: 0.0,
                clump: &look.clump,
                seed: look.seed,
                layers: &look.layers,
                layer_joints: &frame.layer_joints,
            }
        };
        self.of = Some((scene.shared_look().clone(), motion.time_s()));
        let all = || self.objects.iter().zip(scene.objects()).enumerate();
        // Lines are behind all hair, as their joints are.
        let lines = all().flat_map(|(index, (frame, object))| {
            frame.lines.of_frame(object, head_of(index, object))
        });
        let objects = all().map(of_frame).chain(lines);
        Ok(Frame {
            camera: self.camera.insert(camera),
            paths: &self.paths,
            strands: &self.strands,
            objects: objects.collect(),
            light,
            time_s: motion.time_s(),
            material_normals: &self.normals,
            rest_positions: &self.rest_positions,
            rest_forwards: &self.rest_forwards,
            from_ends: &self.from_ends,
            path_weights: &self.path_weights,
            marks: &self.marks,
            surfaces,
            mesh_layers,
            decals,
            background: section.background,
            order: scene.look().order(),
            edge_depth_m: section.edge_depth * scene.head().height_m,
            brush: scene.brush(),
            features: render::Features::NONE,
            roundness: 1.0,
            passes: scene.look().passes(scene.head(), camera.size_px()[1]),
        })
    }

    /// Whether a frame would be the last one once more, bit for bit: scene, motion and camera are as they were, whatever the time. Then
    /// so is its picture.
    #[must_use]
    pub fn is_as_before(&self, scene: &Scene, motion: &Motion, camera: &Camera) -> bool {
        let Some((look, time)) = &self.of else {
            return false;
        };
        let other_time = (*time != motion.time_s()).then(|| LineTime::of(scene, motion));
        let is_same = Arc::ptr_eq(look, scene.shared_look())
            && self.camera.as_ref() == Some(camera)
            && self.objects.len() == scene.objects().len();
        let mut objects = self.objects.iter().zip(scene.objects()).enumerate();
        is_same
            && objects.all(|(index, (frame, object))| {
                frame.is_as_before(object, motion.of(index, object), other_time)
            })
    }

    #[cfg(not(test))]
    fn shows_all(&self) -> bool {
        false
    }

    #[cfg(test)]
    fn shows_all(&self) -> bool {
        self.keeps_unseen
    }

    /// Strands of the last frame that are behind the eye or wholly off the picture.
    #[must_use]
    pub fn culled(&self) -> usize {
        let Some(camera) = &self.camera else {
            return 0;
        };
        let [width, height] = camera.size_px().map(|size| size as f32);
        let picture = Vec2::new(width, height);
        let mut culled = 0;
        let mut all = self.paths.runs.chunk_by(|a, b| a.strand == b.strand);
        let mut next = all.next();
        for object in &self.objects {
            let unit_m = object.of.head().unit_m();
            let mut seen = 0;
            while let Some(runs) = next.filter(|runs| runs[0].joints.end <= object.joints.end) {
                next = all.next();
                if !object.strands.contains(&runs[0].strand) {
                    continue;
                }
                let size_m = self.strands[runs[0].strand].size * unit_m;
                let joints = runs.iter().flat_map(|run| run.joints.clone());
                let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
                for joint in joints {
                    // Room for a clump three times its size: shifted, with its outline and all.
                    let reach = Vec2::splat(3.0 * size_m * self.paths.px_per_metre[joint]);
                    low = low.min(self.paths.center[joint] - reach);
                    high = high.max(self.paths.center[joint] + reach);
                }
                let is_seen = high.cmpge(Vec2::ZERO).all() && low.cmple(picture).all();
                seen += usize::from(is_seen);
            }
            culled += object.unseen + object.strands.len() - object.merged - seen;
        }
        culled
    }

    /// Strands of the last frame that are thinner than [`SceneSection::detail`](crate::SceneSection) asks for and not drawn, as those
    /// beside them are wider instead.
    #[must_use]
    pub fn merged(&self) -> usize {
        self.objects.iter().map(|object| object.merged).sum()
    }

    /// Strands of the last frame that may be seen and were left out because they are too far away to be drawn.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.paths.dropped()
    }
}

impl ObjectFrame {
    fn new(object: &Object) -> Self {
        let reads_material = object.look().reads_material();
        Self {
            of: object.clone(),
            pose: HeadPose::REST,
            bodies_s: 0.0,
            points: Vec::new(),
            levels: levels_of(object),
            left_out_by: zones::left_out_by(object.hair(), object.look()),
            unseen: 0,
            merged: 0,
            strands: 0..0,
            joints: 0..0,
            made: ObjectPaths::default(),
            layer_joints: Vec::new(),
            material: reads_material.then(Material::default),
            head: None,
            solid: None,
            lines: ObjectLines::default(),
        }
    }

    /// Drops what was kept of another object.
    fn follow(&mut self, object: &Object) {
        if !self.of.has_hair_and_head_of(object) {
            self.material = None;
            self.head = None;
        }
        if !self.of.moves_as(object) || !Arc::ptr_eq(self.of.shared_look(), object.shared_look()) {
            self.lines.forget();
        }
        if !self.of.has_hair_and_head_of(object)
            || !Arc::ptr_eq(self.of.shared_look(), object.shared_look())
        {
            self.made.forget();
            self.levels = levels_of(object);
            self.left_out_by = zones::left_out_by(object.hair(), object.look());
        }
        if object.look().reads_material() {
            self.material.get_or_insert_default();
        } else {
            self.material = None;
        }
        self.of = object.clone();
    }

    /// Whether the object would be drawn as it was last; what moves in time alone only where the time is the same.
    fn is_as_before(
        &self,
        object: &Object,
        motion: &ObjectMotion,
        other_time: Option<LineTime>,
    ) -> bool {
        let look = object.look();
        // Strands may twist in their places.
        let turns = look.reads_material() && motion.dynamics().is_some();
        self.of.is_drawn_as(object)
            && self.pose == motion.head_pose()
            && self.bodies_s == bodies_s(object, motion)
            && other_time.is_none_or(|time| {
                let goes_on = turns || look.reads_time() || self.lines.is_growing();
                !goes_on && self.lines.stay(object, time)
            })
            && self.points == motion.points(object)
    }

    /// Keeps what the object's hair and head are like.
    fn keep(&mut self, motion: &ObjectMotion) {
        self.pose = motion.head_pose();
        self.bodies_s = bodies_s(&self.of, motion);
        self.points.clear();
        self.points.extend_from_slice(motion.points(&self.of));
    }

    /// The size with which each strand of the hair is drawn that has these points, none of them farther than that (m): its own, or where
    /// hair is thin that of fewer and wider strands.
    fn sizes(&self, points: &[Vec3], sight: &Sight, farthest_m: f32) -> Vec<f32> {
        let hair = self.of.hair();
        let own = hair.infos.iter().map(|info| info.size);
        let thinnest = own.clone().fold(f32::INFINITY, f32::min);
        let is_thin = sight.width(thinnest, farthest_m) < 1.0;
        if !is_thin {
            return own.collect();
        }
        let drawn = |(i, size): (usize, f32)| {
            let particles = &points[hair.file.strands.point_range(i)];
            let depths = particles.iter().map(|p| sight.camera().depth(*p));
            let width = sight.width(size, depths.fold(f32::INFINITY, f32::min));
            size * hair.ranks().factor(i, width)
        };
        own.enumerate().map(drawn).collect()
    }

    /// Appends the hair's strands, and the paths of those that may be seen.
    fn push_strands(
        &mut self,
        motion: &ObjectMotion,
        sight: &Sight,
        strands: &mut Vec<StrandInfo>,
        (parts, paths): (&mut Vec<Paths>, &mut Paths),
    ) -> Result<(), StageError> {
        let (hair, path) = (self.of.hair(), self.of.look().path());
        let points = motion.points(&self.of);
        let first = strands.len();
        self.strands = first..first + hair.infos.len();
        self.joints = paths.len()..paths.len();
        (self.unseen, self.merged) = (0, 0);
        if hair.infos.is_empty() {
            return Ok(());
        }
        // Paths that effects make may go on where no strand is.
        let makes_paths = |layer: &Layer| layer.program.has_own_paths();
        let (center, radius_m) = ball_around(points);
        let sizes = hair.infos.iter().map(|info| info.size);
        if !sight.may_see_any(center, radius_m, sizes.fold(0.0, f32::max))
            && !self.of.look().layers.iter().any(makes_paths)
        {
            self.strands.end = first;
            self.unseen = hair.infos.len();
            return Ok(());
        }
        let farthest_m = sight.camera().depth(center) + radius_m;
        let sizes = self.sizes(points, sight, farthest_m);
        let level_depth = self.of.look().clump.base().level_depth;
        let particles = |i: usize| &points[hair.file.strands.point_range(i)];
        for (i, info) in hair.infos.iter().enumerate() {
            let mean = particles(i).iter().sum::<Vec3>() / particles(i).len() as f32;
            let level = self.levels.get(i).copied().unwrap_or(0);
            strands.push(StrandInfo {
                mean: self.of.placement().point(mean),
                size: sizes[i],
                level,
                lift: level as f32 * level_depth,
                left_out_by: self.left_out_by.get(i).copied().unwrap_or(0),
                ..*info
            });
        }
        let is_merged = |i: usize| sizes[i] == 0.0 && hair.infos[i].size > 0.0;
        self.merged = (0..sizes.len()).filter(|i| is_merged(*i)).count();
        let push = |part: &mut Paths, i: usize| {
            let PathShape { cuts, detail, hem } = &self.of.shapes()[i];
            if is_merged(i) || !sight.may_see(particles(i), sizes[i]) {
                part.leave_out(cuts);
                return Ok(());
            }
            let (strand, detail) = (first + i, Some(detail));
            part.push_pieces(strand, particles(i), cuts, detail, path, sight.camera())?;
            if let Some(beside) = hem {
                let (camera, radius_m) = (sight.camera(), sizes[i] * hair.head.unit_m());
                let tip = |other: usize| particles(other).last().copied().unwrap_or_default();
                let tips = beside.map(tip);
                hem::end_along_hem(part, strand, tips, radius_m, camera);
            }
            Ok(())
        };
        let along_tangents = self.of.look().paints();
        push_beside(parts, sizes.len(), along_tangents, paths, push)?;
        self.joints.end = paths.len();
        Ok(())
    }

    /// Appends the material normals of the object's joints: any where it reads none.
    fn push_material_normals(
        &mut self,
        motion: &ObjectMotion,
        paths: &Paths,
        normals: &mut Vec<Vec3>,
    ) {
        let Some(material) = &mut self.material else {
            normals.resize(self.joints.end, Vec3::Y);
            return;
        };
        let hair = self.of.hair();
        let rest = &hair.file.strands;
        let points = motion.points(&self.of);
        let strands = || (0..rest.len()).map(|strand| rest.point_range(strand));
        let rotation = motion.head_pose().rotation(1.0);
        material.turn(rest.points(), strands(), hair.head.center, rotation);
        match motion.dynamics() {
            _ if hair.file.motion.is_some() || motion.has_points_alone(&self.of) => {
                material.follow(rest.points(), points, strands(), rotation);
            }
            None if hair.shapes.is_some() => {
                material.follow(rest.points(), points, strands(), rotation);
            }
            Some(dynamics) => {
                let (rest, now) = material.rest_and_now();
                dynamics.turn_normals(rest, now);
            }
            None => {}
        }
        let (strands, made_of) = (&self.strands, self.made.strands());
        let of_path = |strand: usize| rest.point_range(strand_of(strands, made_of, strand));
        material.push_at_joints(paths, self.joints.clone(), of_path, normals);
    }

    /// Appends where the hair of the object's joints is at rest, head heights from the head's centre. Made paths are where their strand
    /// is at the same share of its length.
    fn push_rest_positions(&self, paths: &Paths, positions: &mut Vec<Vec3>) {
        let hair = self.of.hair();
        for (run, points) in self.runs_at_rest(paths) {
            let at_rest = |joint: usize| {
                let point = along(points, paths.u[joint], Vec3::lerp);
                (point - hair.head.center) / hair.head.height_m
            };
            positions.extend(run.joints.clone().map(at_rest));
        }
    }

    /// Appends how the hair of the object's joints runs at rest, as unit vectors from each to the next one of its run, where
    /// [`Self::push_rest_positions`] has them.
    fn push_rest_forwards(&self, paths: &Paths, forwards: &mut Vec<Vec3>) {
        for (run, points) in self.runs_at_rest(paths) {
            let last = run.joints.end - 1;
            let at_rest = |joint: usize| along(points, paths.u[joint], Vec3::lerp);
            let forward = |joint: usize| {
                let from = joint.min(last.saturating_sub(1)).max(run.joints.start);
                (at_rest(last.min(from + 1)) - at_rest(from)).normalize_or_zero()
            };
            forwards.extend(run.joints.clone().map(forward));
        }
    }

    /// The object's runs, each with its strand's particles at rest.
    fn runs_at_rest<'a>(
        &'a self,
        paths: &'a Paths,
    ) -> impl Iterator<Item = (&'a PathRun, &'a [Vec3])> {
        let first = paths
            .runs
            .partition_point(|run| run.joints.end <= self.joints.start);
        paths.runs[first..].iter().map(|run| {
            let strand = strand_of(&self.strands, self.made.strands(), run.strand);
            (run, self.of.hair().file.strands.strand(strand))
        })
    }
}

/// Appends the paths of so many strands: `push` appends one's, by its number among them. They are made beside each other in `parts`, which
/// are kept from frame to frame; as [`Paths::set_along_tangents`] has it.
fn push_beside(
    parts: &mut Vec<Paths>,
    count: usize,
    along_tangents: bool,
    paths: &mut Paths,
    push: impl Fn(&mut Paths, usize) -> Result<(), PathError> + Sync,
) -> Result<(), PathError> {
    parts.resize_with(PARTS, Paths::new);
    let mut rest = 0..count;
    while !rest.is_empty() {
        let some = rest.start..rest.end.min(rest.start + PARTS * PART);
        let used = some.len().div_ceil(PART);
        let made: Result<(), PathError> = parts[..used]
            .par_iter_mut()
            .enumerate()
            .with_max_len(1)
            .map(|(number, part)| {
                part.clear();
                part.set_along_tangents(along_tangents);
                let start = some.start + number * PART;
                (start..some.end.min(start + PART)).try_for_each(|i| push(part, i))
            })
            .collect();
        made?;
        parts[..used].iter().for_each(|part| paths.append(part));
        rest.start = some.end;
    }
    Ok(())
}

/// The script's own time in seconds where bodies are drawn that move by themselves; else 0.
fn bodies_s(object: &Object, motion: &ObjectMotion) -> f64 {
    let moves = |body: &Arc<Body>| body.section.color.is_some() && body.moves();
    match object.script().bodies.iter().any(moves) {
        true => motion.posed_s(),
        false => 0.0,
    }
}

/// The levels of an object's strands; none where there is one.
fn levels_of(object: &Object) -> Vec<u32> {
    let (hair, look) = (object.hair(), object.look());
    let params = look.clump.base();
    if params.levels <= 1 {
        return Vec::new();
    }
    let rest = &hair.file.strands;
    let roots = (0..rest.len()).map(|i| rest.strand(i)[0] - hair.head.center);
    let ids: Vec<u32> = hair.infos.iter().map(|info| info.id).collect();
    levels(params, look.seed, &ids, &roots.collect::<Vec<_>>())
}

/// The strand of an object's hair that a strand of the frame is, or belongs to: `strands` are its hair's, and those behind it have made paths.
fn strand_of(strands: &Range<usize>, made_of: &[usize], strand: usize) -> usize {
    match strand.checked_sub(strands.end) {
        Some(made) => made_of[made],
        None => strand - strands.start,
    }
}

/// What lies at `u` (0 to 1) of the way along a list that has something, between the two next to it.
fn along<T: Copy>(list: &[T], u: f32, mix: impl Fn(T, T, f32) -> T) -> T {
    let last = list.len() - 1;
    let place = u * last as f32;
    let before = (place as usize).min(last);
    let after = (before + 1).min(last);
    mix(list[before], list[after], place - before as f32)
}

/// A ball that paths through these points stay in: its middle and its radius, metres. A path leaves the hull of its points by no more than
/// a third of a link.
fn ball_around(points: &[Vec3]) -> (Vec3, f32) {
    let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let radius_m = 0.5 * low.distance(high);
    (0.5 * (low + high), radius_m + 2.0 * radius_m / 3.0)
}
