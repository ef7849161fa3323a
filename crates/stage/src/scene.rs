//! A scene: the hair and head of a preset, at a time, as a frame.

use crate::bake::Bake;
use crate::dynamics::{Dynamics, feel};
use crate::files::{Files, StageError};
use crate::hair::Hair;
use crate::head::{self, HeadPaint};
use crate::load;
use crate::material::Material;
use crate::motion::{HeadPose, MotionScript};
use crate::neck::{Neck, rigid};
use crate::preset::Preset;
use crate::reach::{may_see, reach_m};
use crate::script;
use effects::wgsl::hash;
use effects::{HairStrand, Layer, MadePaths, Parameters, Values, Varied, clump, layer_seed};
use glam::{Vec2, Vec3};
use render::{Brush, Frame, Head, Light, Order, StrandInfo};
use std::ops::Range;
use stroke_path::{Camera, Cut, OrbitView, PathKind, Paths, direction_from_angles};

/// How near the eye strokes are cut, in head heights.
const NEAR: f32 = 0.05;

/// How much nearer than the inside of the head hair must be to be seen through an opening, in head
/// heights: more than the clumps around the skull reach into it.
const INSIDE_MARGIN: f32 = 0.6;

/// How much farther than the head's outline hair may be, in head heights, to cover it: hair that lies
/// on the skin.
const OUTLINE_MARGIN: f32 = 0.04;

/// How far the pieces of a strand that curls go on beyond where they meet, in parts of its full radius.
const OVERLAP: f32 = 3.0;

/// The clump's choice of normal that reads material frames.
const MATERIAL: u32 = 1;

/// A scene that makes frames. What a frame needs is kept and reused.
pub struct Stage {
    hair: Hair,
    /// The strands' sizes, and ids increasing; then those of the last frame's made paths.
    strands: Vec<StrandInfo>,
    /// How many of them are the hair's.
    strand_count: usize,
    /// Where each of these is cut.
    cuts: Vec<Vec<Cut>>,
    made: MadePaths,
    /// The strand that each made path belongs to.
    made_of: Vec<usize>,
    /// Normals of the links, where something reads them.
    material: Option<Material>,
    layer_joints: Vec<Range<usize>>,
    neck: Option<Neck>,
    /// Where the head is while nothing moves.
    head: Head,
    /// The radius of the ball around the head's middle that hair stays in.
    reach_m: f32,
    script: MotionScript,
    pose: HeadPose,
    /// What the preset says of dynamics, frames a second, and the simulation once something moves.
    dynamics_values: Values,
    fps: f32,
    dynamics: Option<Dynamics>,
    /// Sentences for the user: what was guessed.
    notes: Vec<String>,
    seed: u32,
    clump: Varied<clump::Program>,
    layers: Vec<Layer>,
    settings: Settings,
    points: Vec<Vec3>,
    paths: Paths,
    camera: Option<Camera>,
}

/// What the preset says of camera, light and picture, ready to be used.
struct Settings {
    size: [u32; 2],
    background: Option<[f32; 3]>,
    order: Order,
    edge_depth_m: f32,
    path: PathKind,
    brush: Brush,
    view: OrbitView,
    /// The target from the head's centre, head heights.
    target: Vec3,
    light_is_point: bool,
    light_follows_camera: bool,
    /// Unit vector, where the camera stands at yaw 0.
    light_direction: Vec3,
    light_distance: f32,
    paint: HeadPaint,
}

impl Stage {
    /// Reads the preset's files and prepares its frames.
    ///
    /// # Errors
    ///
    /// When hair or head cannot be read, or camera and path settings contradict each other.
    pub fn new(preset: &Preset, files: &Files) -> Result<Self, StageError> {
        let mut notes = Vec::new();
        if preset.scene.choice("order") == 1 {
            notes.push("scene: order `scattered` is no more; `rounded` is drawn".to_owned());
        }
        let mut model = load::head(preset, files, &mut notes)?;
        let mesh = model.as_ref().map(|model| &model.mesh);
        let mut hair = load::hair(preset, files, mesh, &mut notes)?;
        let head = hair.head;
        let script = script::load(preset, files, &mut hair, mesh)?;
        if let Some(model) = &mut model {
            model.add_ties(&hair.ties);
            let reach = preset.head.number("scalp");
            // A style's own coat lies there.
            if reach > 0.0 && hair.undercoat == 0 {
                let roots: Vec<Vec3> = hair.file.strands.roots().collect();
                model.find_scalp(&roots, reach * head.height_m);
            }
        }
        let strands = load::keep_guides(preset, &mut hair);
        load::bake(preset, files, &mut hair)?;
        if let Some((_, message)) = feel::unsupported(&preset.dynamics) {
            return Err(StageError::Unsupported(message));
        }
        let settings = Settings::new(preset, head)?;
        let layers: Vec<Layer> = preset.layers.iter().map(|layer| layer.build()).collect();
        let clump = Varied::<clump::Program>::new(&preset.clump);
        let reads_material = clump.base().normal == MATERIAL
            || (layers.iter()).any(|layer| layer.program.inputs().has("material_normal"));
        let without_light = |layer: &&Layer| layer.program.needs_point_light();
        if let Some(layer) = layers
            .iter()
            .find(without_light)
            .filter(|_| !settings.light_is_point)
        {
            return Err(StageError::NoPointLight(layer.name.clone()));
        }
        let cut = |(i, info): (usize, &StrandInfo)| {
            let overlap_m = OVERLAP * info.size * head.unit_m();
            stroke_path::cuts(hair.file.strands.strand(i), settings.path, overlap_m)
        };
        let cuts = strands.iter().enumerate().map(cut);
        Ok(Self {
            cuts: cuts.collect::<Result<_, _>>()?,
            reach_m: reach_m(&hair.file.strands, &strands, head),
            points: hair.file.strands.points().to_vec(),
            hair,
            strand_count: strands.len(),
            strands,
            made: MadePaths::default(),
            made_of: Vec::new(),
            material: reads_material.then(Material::default),
            layer_joints: Vec::new(),
            neck: model.map(|model| Neck::new(model, head)),
            head,
            script,
            pose: HeadPose::default(),
            dynamics_values: preset.dynamics.clone(),
            fps: preset.scene.number("fps"),
            dynamics: None,
            notes,
            seed: preset.seed,
            clump,
            layers,
            settings,
            paths: Paths::new(),
            camera: None,
        })
    }

    /// Sentences for the user: what was guessed about the files.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The number of strands.
    #[must_use]
    pub fn strand_count(&self) -> usize {
        self.strand_count
    }

    /// Strands of the last frame that are behind the eye or wholly off the picture.
    #[must_use]
    pub fn culled(&self) -> usize {
        let Some(camera) = &self.camera else { return 0 };
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
            let size_m = self.strands[runs[0].strand].size * self.head.unit_m();
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

    /// Moves head and hair to `time` (seconds): hair that moves is simulated, in steps from the start.
    ///
    /// # Errors
    ///
    /// When the simulation refuses the preset's numbers.
    pub fn advance_to(&mut self, time: f32) -> Result<(), StageError> {
        self.advance(f64::from(time), None)
    }

    /// As [`Self::advance_to`], for live programs: while this camera cannot see the hair, wherever it may be, and the head is calm, hair
    /// is simulated in one step of four frames' length every fourth frame, and what is missing is made up for before it is seen
    /// again. Motion is not quite that of [`Self::advance_to`] then, so pictures that must be the same every time are made
    /// with that.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_to`].
    pub fn advance_to_seen_by(&mut self, time: f32, camera: &Camera) -> Result<(), StageError> {
        self.advance(f64::from(time), Some(camera))
    }

    /// To `time` (seconds); without a camera hair is seen.
    fn advance(&mut self, time: f64, camera: Option<&Camera>) -> Result<(), StageError> {
        self.pose = self.script.head_at(time);
        if let Some(motion) = &self.hair.file.motion {
            motion.sample(time as f32, &mut self.points);
            return Ok(());
        }
        let is_simulated = Dynamics::moves(&self.dynamics_values, &self.script);
        match &self.hair.shapes {
            // Without dynamics hair is where its keys have it.
            Some(shapes) if !is_simulated => {
                shapes.sample_smooth(self.script.within(time), &mut self.points);
            }
            _ => (self.points).copy_from_slice(self.hair.file.strands.points()),
        }
        let (rotation, translation) = rigid(self.pose, self.head);
        for point in &mut self.points {
            *point = (rotation * point.as_dvec3() + translation).as_vec3();
        }
        if !is_simulated {
            return Ok(());
        }
        let center = self.posed_head().center;
        let is_seen = camera.is_none_or(|camera| may_see(camera, center, self.reach_m));
        let dynamics = match &mut self.dynamics {
            Some(dynamics) => dynamics,
            None => {
                let sizes: Vec<f32> = self.strands.iter().map(|strand| strand.size).collect();
                self.dynamics.insert(Dynamics::new(
                    &self.hair,
                    &sizes,
                    self.neck.as_ref().map(Neck::rest_mesh),
                    &self.dynamics_values,
                    self.script.hold,
                    self.fps,
                    self.seed,
                )?)
            }
        };
        dynamics.advance_to(time, &self.script, is_seen, &mut self.points)
    }

    /// Looks from this yaw (degrees) from now on; [`Self::frame`] refuses one that isn't finite.
    pub fn set_camera_yaw(&mut self, yaw_degrees: f32) {
        self.settings.view.yaw_degrees = yaw_degrees;
    }

    /// Adds the strands as they stand to a bake, at `time` (seconds).
    pub fn record(&self, time: f32, bake: &mut Bake) {
        bake.push(time, &self.points);
    }

    /// A bake of this scene as the text of a strands file.
    ///
    /// # Errors
    ///
    /// When it has no frames, or their times do not increase.
    pub fn bake_text(&self, bake: Bake) -> Result<String, StageError> {
        bake.text(&self.hair.file.strands, &self.strands[..self.strand_count])
    }

    /// What the simulation did in its last step; nothing where nothing is simulated.
    #[must_use]
    pub fn simulated(&self) -> hair_sim::Stats {
        self.dynamics
            .as_ref()
            .map(Dynamics::stats)
            .unwrap_or_default()
    }

    /// How many steps the simulation has taken, long ones of hair off screen counted as one.
    #[must_use]
    pub fn steps_taken(&self) -> u64 {
        self.dynamics.as_ref().map_or(0, Dynamics::taken)
    }

    /// The head where it is now.
    fn posed_head(&self) -> Head {
        let (rotation, translation) = rigid(self.pose, self.head);
        Head {
            center: (rotation * self.head.center.as_dvec3() + translation).as_vec3(),
            ..self.head
        }
    }

    /// Appends the paths that layers make, and notes which joints each layer draws on.
    fn push_made_paths(&mut self, camera: &Camera) -> Result<(), StageError> {
        let of_hair = 0..self.paths.len();
        let runs = self.paths.runs.iter();
        let of_undercoat = runs.take_while(|run| run.strand < self.hair.undercoat);
        let above_undercoat = of_undercoat.last().map_or(0, |run| run.joints.end);
        let head = self.posed_head();
        self.layer_joints.clear();
        self.made_of.clear();
        for layer in &self.layers {
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
                particles: &self.points[self.hair.file.strands.point_range(i)],
                at_rest: self.hair.file.strands.strand(i),
                size: info.size,
            };
            let infos = self.strands[..self.strand_count].iter().enumerate();
            let above = infos.skip(self.hair.undercoat);
            let strands: Vec<HairStrand> = above.map(of_strand).collect();
            let hair = effects::Hair {
                strands: &strands,
                head_center: head.center,
                head_height_m: head.height_m,
            };
            self.made.clear();
            let seed = layer_seed(self.seed, &layer.name);
            layer.program.make_paths(&hair, seed, &mut self.made);
            let start = self.paths.len();
            for (strand, number, points) in self.made.iter() {
                let parent = self.strands[self.hair.undercoat + strand];
                let index = self.strands.len();
                self.made_of.push(strand);
                self.strands.push(StrandInfo {
                    id: made_id(parent.id, number),
                    ..parent
                });
                self.paths
                    .push_strand(index, points, self.settings.path, camera)?;
            }
            self.layer_joints.push(start..self.paths.len());
        }
        Ok(())
    }

    /// Fills in the material normals of all joints, where something reads them.
    fn find_material_normals(&mut self) {
        let Some(material) = &mut self.material else {
            return;
        };
        let rest = &self.hair.file.strands;
        let strands = || (0..rest.len()).map(|strand| rest.point_range(strand));
        let (rotation, _) = rigid(self.pose, self.head);
        material.turn(rest.points(), strands(), self.head.center, rotation);
        let is_simulated = Dynamics::moves(&self.dynamics_values, &self.script);
        match &self.dynamics {
            _ if self.hair.file.motion.is_some() => {
                material.follow(rest.points(), &self.points, strands(), rotation);
            }
            _ if self.hair.shapes.is_some() && !is_simulated => {
                material.follow(rest.points(), &self.points, strands(), rotation);
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

    /// The frame of the hair as it stands, seen by the preset's camera.
    ///
    /// # Errors
    ///
    /// When camera or paths cannot be made.
    pub fn frame(&mut self) -> Result<Frame<'_>, StageError> {
        let settings = &self.settings;
        let view = OrbitView {
            target: self.head.center + settings.target * self.head.height_m,
            ..settings.view
        };
        let camera = Camera::orbit(view, settings.size, self.near_m())?;
        self.frame_seen_by(camera)
    }

    /// From which view depth on a camera should see this scene, metres.
    #[must_use]
    pub fn near_m(&self) -> f32 {
        NEAR * self.head.height_m
    }

    /// Where the head is while nothing moves, and how large.
    #[must_use]
    pub fn head(&self) -> Head {
        self.head
    }

    /// The frame of the hair as it stands, seen by a camera of the caller's.
    ///
    /// # Errors
    ///
    /// When paths cannot be made.
    pub fn frame_seen_by(&mut self, camera: Camera) -> Result<Frame<'_>, StageError> {
        let head = self.posed_head();
        self.paths.clear();
        self.strands.truncate(self.strand_count);
        for (i, info) in self.strands.iter_mut().enumerate() {
            let particles = &self.points[self.hair.file.strands.point_range(i)];
            info.mean = particles.iter().sum::<Vec3>() / particles.len() as f32;
            self.paths
                .push_pieces(i, particles, &self.cuts[i], self.settings.path, &camera)?;
        }
        self.push_made_paths(&camera)?;
        self.find_material_normals();
        let (settings, camera) = (&self.settings, &*self.camera.insert(camera));
        let light = settings.light(camera, head);
        let surfaces = match &mut self.neck {
            Some(neck) => head::surfaces(neck.posed(self.pose), &settings.paint, camera, &light),
            None => Vec::new(),
        };
        Ok(Frame {
            camera,
            paths: &self.paths,
            strands: &self.strands,
            head,
            light,
            clump: &self.clump,
            seed: self.seed,
            layers: &self.layers,
            layer_joints: &self.layer_joints,
            material_normals: self.material.as_ref().map_or(&[], Material::joints),
            surfaces,
            background: settings.background,
            order: settings.order,
            edge_depth_m: settings.edge_depth_m,
            brush: settings.brush,
        })
    }
}

/// The number that the variations of path `number` of strand `id` hang on.
fn made_id(id: u32, number: u32) -> u32 {
    hash(id ^ hash(number + 1))
}

/// What a preset's choice of an order is.
fn order(choice: u32) -> Order {
    match choice {
        2 => Order::StrandFirst,
        3 => Order::Shifted,
        // `rounded`, and `scattered`, which presets of version 1 may name.
        _ => Order::Rounded,
    }
}

impl Settings {
    fn new(preset: &Preset, head: Head) -> Result<Self, StageError> {
        let Preset {
            scene,
            camera,
            light,
            path,
            head: paint,
            ..
        } = preset;
        let subdivision = path.integer("subdivision").unsigned_abs();
        Ok(Self {
            size: scene.size("size"),
            background: scene.optional_color("background"),
            order: order(scene.choice("order")),
            edge_depth_m: scene.number("edge_depth") * head.height_m,
            path: match path.choice("kind") {
                0 => PathKind::Linear { subdivision },
                _ => PathKind::CatmullRom { subdivision },
            },
            brush: [Brush::Circle, Brush::Semicircle][path.choice("brush") as usize],
            view: OrbitView {
                target: head.center,
                yaw_degrees: camera.number("yaw"),
                pitch_degrees: camera.number("pitch"),
                distance_m: camera.number("distance") * head.height_m,
                vertical_fov_degrees: camera.number("fov"),
            },
            target: Vec3::from(camera.triple("target")),
            light_is_point: light.choice("kind") == 1,
            light_follows_camera: light.choice("fixed_to") == 1,
            light_direction: direction_from_angles(light.number("yaw"), light.number("pitch"))?,
            light_distance: light.number("distance"),
            paint: HeadPaint {
                light: paint.color("light"),
                shadow: paint.color("shadow"),
                line: paint.color("line"),
                iris: paint.color("iris"),
                iris_shadow: paint.color("iris_shadow"),
                tie: paint.color("tie"),
                tie_shadow: paint.color("tie_shadow"),
                scalp: clump::Program::params(&preset.clump).color.to_array(),
                width_m: paint.number("width") * head.unit_m(),
                inside_margin_m: INSIDE_MARGIN * head.height_m,
                outline_margin_m: OUTLINE_MARGIN * head.height_m,
                threshold: paint.number("threshold"),
            },
        })
    }

    fn light(&self, camera: &Camera, head: Head) -> Light {
        let direction = if self.light_follows_camera {
            // The angles are meant from where the eye stands, and depth grows away from the eye.
            let d = self.light_direction;
            camera.world_from_view_direction(Vec3::new(d.x, d.y, -d.z))
        } else {
            self.light_direction
        };
        if self.light_is_point {
            Light::Point(head.center + direction * self.light_distance * head.height_m)
        } else {
            Light::Direction(direction)
        }
    }
}
