//! Frames of a scene in motion. What a frame needs is kept and reused.

use crate::dynamics::Dynamics;
use crate::files::StageError;
use crate::head;
use crate::material::Material;
use crate::motion::Motion;
use crate::neck::{PosedHead, rigid};
use crate::scene::Scene;
use effects::wgsl::hash;
use effects::{HairStrand, MadePaths, layer_seed};
use glam::{Vec2, Vec3};
use render::{Frame, StrandInfo};
use std::ops::Range;
use stroke_path::{Camera, Paths};

/// Makes frames of scenes.
#[derive(Default)]
pub struct FrameMaker {
    /// The hair's strands, then those of the last frame's made paths.
    strands: Vec<StrandInfo>,
    /// How many of them are the hair's.
    strand_count: usize,
    paths: Paths,
    made: MadePaths,
    /// The strand that each made path belongs to.
    made_of: Vec<usize>,
    layer_joints: Vec<Range<usize>>,
    /// Normals of the links, where something reads them.
    material: Option<Material>,
    head: Option<PosedHead>,
    camera: Option<Camera>,
    /// The scene of the last frame.
    of: Option<Scene>,
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
        self.follow(scene);
        let (hair, look) = (scene.hair(), scene.look());
        let points = motion.points(scene);
        self.paths.clear();
        self.strands.clone_from(&hair.infos);
        self.strand_count = hair.infos.len();
        for (i, info) in self.strands.iter_mut().enumerate() {
            let particles = &points[hair.file.strands.point_range(i)];
            info.mean = particles.iter().sum::<Vec3>() / particles.len() as f32;
            self.paths
                .push_pieces(i, particles, &scene.cuts()[i], look.path(), &camera)?;
        }
        self.push_made_paths(scene, motion, &camera)?;
        self.find_material_normals(scene, motion);
        let camera = &*self.camera.insert(camera);
        let head = motion.head(scene);
        let light = look.light(camera, head);
        let surfaces = match (scene.neck(), &mut self.head) {
            (Some(neck), Some(posed)) => {
                let model = posed.in_pose(neck, motion.pose());
                head::surfaces(model, &look.paint(scene.head()), camera, &light)
            }
            _ => Vec::new(),
        };
        Ok(Frame {
            camera,
            paths: &self.paths,
            strands: &self.strands,
            head,
            light,
            clump: &look.clump,
            seed: look.seed,
            layers: &look.layers,
            layer_joints: &self.layer_joints,
            material_normals: self.material.as_ref().map_or(&[], Material::joints),
            surfaces,
            background: look.sections.scene.background,
            order: look.order(),
            edge_depth_m: look.sections.scene.edge_depth * scene.head().height_m,
            brush: look.brush(),
        })
    }

    /// Drops what was kept of another scene.
    fn follow(&mut self, scene: &Scene) {
        let is_same = (self.of.as_ref()).is_some_and(|of| of.has_hair_and_head_of(scene));
        if !is_same {
            self.material = None;
            self.head = scene.neck().map(PosedHead::new);
        }
        if scene.look().reads_material() {
            self.material.get_or_insert_default();
        } else {
            self.material = None;
        }
        self.of = Some(scene.clone());
    }

    /// Strands of the last frame that are behind the eye or wholly off the picture.
    #[must_use]
    pub fn culled(&self) -> usize {
        let (Some(camera), Some(scene)) = (&self.camera, &self.of) else {
            return 0;
        };
        let [width, height] = camera.size_px().map(|size| size as f32);
        let picture = Vec2::new(width, height);
        let mut seen = 0;
        let hair = self
            .paths
            .runs
            .iter()
            .take_while(|run| run.strand < self.strand_count);
        let hair = &self.paths.runs[..hair.count()];
        for runs in hair.chunk_by(|a, b| a.strand == b.strand) {
            let size_m = self.strands[runs[0].strand].size * scene.head().unit_m();
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
        self.strand_count - seen
    }

    /// Strands of the last frame that were left out because they are too far away to be drawn.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.paths.dropped()
    }

    /// Appends the paths that layers make, and notes which joints each layer draws on.
    fn push_made_paths(
        &mut self,
        scene: &Scene,
        motion: &Motion,
        camera: &Camera,
    ) -> Result<(), StageError> {
        let (hair, look) = (scene.hair(), scene.look());
        let points = motion.points(scene);
        let of_hair = 0..self.paths.len();
        let runs = self.paths.runs.iter();
        let of_undercoat = runs.take_while(|run| run.strand < hair.undercoat);
        let above_undercoat = of_undercoat.last().map_or(0, |run| run.joints.end);
        let head = motion.head(scene);
        self.layer_joints.clear();
        self.made_of.clear();
        for layer in &look.layers {
            if !layer.program.has_own_paths() {
                let start = match layer.program.is_on_undercoat() {
                    true => of_hair.start,
                    false => above_undercoat,
                };
                self.layer_joints.push(start..of_hair.end);
                continue;
            }
            let of_strand = |(i, info): (usize, &StrandInfo)| HairStrand {
                id: info.id,
                particles: &points[hair.file.strands.point_range(i)],
                at_rest: hair.file.strands.strand(i),
                size: info.size,
            };
            let infos = self.strands[..self.strand_count].iter().enumerate();
            let above = infos.skip(hair.undercoat);
            let strands: Vec<HairStrand> = above.map(of_strand).collect();
            let of_effects = effects::Hair {
                strands: &strands,
                head_center: head.center,
                head_height_m: head.height_m,
            };
            self.made.clear();
            let seed = layer_seed(look.seed, &layer.name);
            layer.program.make_paths(&of_effects, seed, &mut self.made);
            let start = self.paths.len();
            for (strand, number, points) in self.made.iter() {
                let parent = self.strands[hair.undercoat + strand];
                let index = self.strands.len();
                self.made_of.push(strand);
                self.strands.push(StrandInfo {
                    id: made_id(parent.id, number),
                    ..parent
                });
                self.paths.push_strand(index, points, look.path(), camera)?;
            }
            self.layer_joints.push(start..self.paths.len());
        }
        Ok(())
    }

    /// Fills in the material normals of all joints, where something reads them.
    fn find_material_normals(&mut self, scene: &Scene, motion: &Motion) {
        let Some(material) = &mut self.material else {
            return;
        };
        let hair = scene.hair();
        let rest = &hair.file.strands;
        let points = motion.points(scene);
        let strands = || (0..rest.len()).map(|strand| rest.point_range(strand));
        let (rotation, _) = rigid(motion.pose(), hair.head);
        material.turn(rest.points(), strands(), hair.head.center, rotation);
        let is_simulated = Dynamics::moves(&scene.look().sections.dynamics, scene.script());
        match motion.dynamics() {
            _ if hair.file.motion.is_some() => {
                material.follow(rest.points(), points, strands(), rotation);
            }
            _ if hair.shapes.is_some() && !is_simulated => {
                material.follow(rest.points(), points, strands(), rotation);
            }
            Some(dynamics) => {
                let (rest, now) = material.rest_and_now();
                dynamics.turn_normals(rest, now);
            }
            None => {}
        }
        let of_path = |strand: usize| match strand.checked_sub(self.strand_count) {
            Some(made) => rest.point_range(self.made_of[made]),
            None => rest.point_range(strand),
        };
        material.at_joints(&self.paths, of_path);
    }
}

/// The number that the variations of path `number` of strand `id` hang on.
fn made_id(id: u32, number: u32) -> u32 {
    hash(id ^ hash(number + 1))
}
