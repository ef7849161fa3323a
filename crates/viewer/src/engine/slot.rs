//! One look as a scene in motion: what an edit leaves alone is not made again.

use super::painter::{Backend, Painter};
use super::{Drawn, Facts, Look, Problem, Times, Wish};
use effects::Registry;
use effects::preset::PresetErrors;
use stage::{
    BodySection, CameraSection, DynamicsSection, Files, FrameMaker, Heads, MeshSection, Motion,
    ObjectSection, Preset, Scene, SceneSection, Sections, StageError, Textures,
};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Instant, SystemTime};

/// A look, and the scene that it made when it was last good.
pub(super) struct Slot<'r> {
    registry: &'r Registry,
    /// The look that was last followed, good or not, and what was wrong with it.
    look: Look,
    problems: Vec<Problem>,
    /// The files that the last look that could be read names, and those that meshes among them name.
    named: Vec<PathBuf>,
    files: Vec<Stamped>,
    loaded: Option<Loaded>,
    motion: Motion,
    frames: FrameMaker,
    textures: Textures,
    heads: Heads,
    /// The last picture, and the backend that was asked for.
    last: Option<(Backend, Drawn)>,
}

/// A scene, and what it was loaded from.
struct Loaded {
    scene: Scene,
    from: From,
    facts: Arc<Facts>,
}

/// What hair, head and script of a scene hang on. Where it is the same, another look needs no file.
#[derive(PartialEq)]
struct From {
    sections: Sections,
    objects: Vec<ObjectSection>,
    /// But for their colours and outlines, which are the look's.
    meshes: Vec<MeshSection>,
    bodies: Vec<BodySection>,
    /// Those that layers name, which must be the hair's.
    zones: Vec<String>,
    /// The names of lines and of what they are of, and those of lines and meshes that layers draw.
    lines: Vec<[Option<String>; 2]>,
    texts: Vec<(PathBuf, Arc<str>)>,
    files: Vec<Stamped>,
}

/// A file, with size and date where it is there.
type Stamped = (PathBuf, Option<(u64, SystemTime)>);

fn stamped(path: PathBuf) -> Stamped {
    let stamp = || {
        let about = fs::metadata(&path).ok()?;
        Some((about.len(), about.modified().ok()?))
    };
    let stamp = stamp();
    (path, stamp)
}

impl<'r> Slot<'r> {
    pub fn new(registry: &'r Registry) -> Self {
        Self {
            registry,
            look: Look::default(),
            problems: Vec::new(),
            named: Vec::new(),
            files: Vec::new(),
            loaded: None,
            motion: Motion::new(),
            frames: FrameMaker::new(),
            textures: Textures::default(),
            heads: Heads::default(),
            last: None,
        }
    }

    /// What is known of the scene; nothing before the first good look.
    pub fn facts(&self) -> Option<Arc<Facts>> {
        self.loaded.as_ref().map(|loaded| loaded.facts.clone())
    }

    /// The files that the look is read from, also where they can't be; of the last look whose text could be read.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.files.iter().map(|(path, _)| path.clone())
    }

    /// Takes on a look. One with mistakes changes nothing, and they are told.
    pub fn follow(&mut self, look: &Look) -> Vec<Problem> {
        if *look != self.look {
            self.problems = match self.take_on(look) {
                Ok(()) => Vec::new(),
                Err(problems) => problems,
            };
            self.look = look.clone();
        }
        self.problems.clone()
    }

    fn take_on(&mut self, look: &Look) -> Result<(), Vec<Problem>> {
        let mut preset = Preset::parse_in(&look.folder, &look.name, &look.text, self.registry)
            .map_err(|e| mistakes(&e))?;
        let files = Files {
            preset_folder: look.folder.clone(),
            texts: look.texts.clone(),
            textures: self.textures.clone(),
            heads: self.heads.clone(),
            ..Files::default()
        };
        let layers = preset
            .layers
            .iter()
            .map(|layer| layer.name.clone())
            .collect();
        self.look_at_files(&preset, &files);
        let from = From::of(&preset, look, &self.files);
        preset
            .layers
            .retain(|layer| look.layers.is_shown(&layer.name));
        let made = match self.loaded.take() {
            // One object alone has a look of its own, which is not the scene's.
            Some(loaded) if loaded.from == from && preset.objects.len() != 1 => {
                stage::Look::new(&preset, &files)
                    .and_then(|own| loaded.scene.with_look(own))
                    .map_err(|error| (error, Some(loaded)))
            }
            loaded => Scene::load(&preset, &files).map_err(|error| (error, loaded)),
        };
        let scene = match made {
            Ok(scene) => scene,
            Err((error, loaded)) => {
                self.loaded = loaded;
                return Err(self.explained(error, &preset, look, &files));
            }
        };
        let section = &preset.sections.scene;
        let facts = Arc::new(Facts {
            size_px: section.size,
            fps: section.fps,
            samples: section.samples,
            camera: preset.sections.camera.clone(),
            animation_s: scene.animation_s(),
            strands: scene.strand_count(),
            notes: scene.notes().to_vec(),
            layers,
        });
        self.loaded = Some(Loaded { scene, from, facts });
        Ok(())
    }

    /// Looks which files there are. What meshes name is looked for only where something has changed: they are opened for that, and looks are edited many times
    /// a second.
    fn look_at_files(&mut self, preset: &Preset, files: &Files) {
        let named = preset.files(files);
        let is_as_before = |file: &Stamped| *file == stamped(file.0.clone());
        if named != self.named || !self.files.iter().all(is_as_before) {
            self.files = preset.all_files(files).into_iter().map(stamped).collect();
            self.named = named;
        }
    }

    /// In the words of `inkstrand check`, which knows the places.
    fn explained(
        &self,
        error: StageError,
        preset: &Preset,
        look: &Look,
        files: &Files,
    ) -> Vec<Problem> {
        match preset.check_scene(&look.name, &look.text, files) {
            Err(errors) => mistakes(&errors),
            Ok(()) => vec![Problem::Failed(error.to_string())],
        }
    }

    /// Moves the scene to the wish's time, or towards it for as long as `goes_on` says so. Whether it came there; so it did where there
    /// is no scene.
    pub fn advance(&mut self, wish: &Wish, goes_on: impl FnMut() -> bool) -> Result<bool, Problem> {
        let Some(Loaded { scene, .. }) = &self.loaded else {
            return Ok(true);
        };
        let motion = &mut self.motion;
        let advanced = motion.advance_by_hand_while(scene, wish.time_s, &wish.hand, goes_on);
        advanced.map_err(failed)
    }

    /// Draws the scene as it stands, seen by that camera. Where nothing changed since the last picture it is that one, with the times
    /// that it took.
    pub fn draw(
        &mut self,
        wish: &Wish,
        camera: &CameraSection,
        size_px: [u32; 2],
        samples: u32,
        painter: &mut Painter,
    ) -> Result<Drawn, Problem> {
        let Some(loaded) = &mut self.loaded else {
            return Err(Problem::Failed("there is nothing to draw yet".to_owned()));
        };
        loaded.scene.camera = camera.clone();
        let scene = &loaded.scene;
        let mut times = Times::default();
        let started = Instant::now();
        let camera = scene.camera_of_size(size_px).map_err(failed)?;
        // One that fails leaves no picture to be shown once more.
        if let Some((backend, last)) = self.last.take()
            && backend == wish.backend
            && (last.samples, last.size_px) == (samples, size_px)
            && self.frames.is_as_before(scene, &self.motion, &camera)
        {
            self.last = Some((backend, last.clone()));
            return Ok(last);
        }
        let frame = self
            .frames
            .frame_seen_by(scene, &self.motion, camera)
            .map_err(failed)?;
        times.paths = started.elapsed().as_secs_f64() * 1e3;
        let layers = frame.objects.iter().flat_map(|object| object.layers);
        let instances: usize = layers.map(|layer| layer.program.instances() as usize).sum();
        let links: usize = (frame.paths.runs.iter())
            .map(|run| run.joints.len().saturating_sub(1))
            .sum();
        let painted = painter.paint(&frame, wish.backend, samples)?;
        times.painted(&painted);
        let pixels = painted.picture.to_srgb8();
        painter.give_back(painted.picture);
        let drawn = Drawn {
            pixels,
            size_px,
            samples,
            times,
            segments: links * instances,
            strands: loaded.facts.strands - self.frames.culled().min(loaded.facts.strands),
            backend: painted.backend,
            facts: loaded.facts.clone(),
        };
        self.last = Some((wish.backend, drawn.clone()));
        Ok(drawn)
    }
}

impl From {
    fn of(preset: &Preset, look: &Look, files: &[Stamped]) -> Self {
        let is_named = |path: &PathBuf| files.iter().any(|(named, _)| named == path);
        let all = &preset.sections;
        Self {
            // What else is in a preset is the look's, which is made anew.
            sections: match all.hair.bake {
                // It is held against all that moves hair.
                Some(_) => all.clone(),
                None => Sections {
                    hair: all.hair.clone(),
                    head: all.head.clone(),
                    motion: all.motion.clone(),
                    dynamics: DynamicsSection {
                        // Hair that is styled in a body is moved out of it when it is read, as the body is at the first step.
                        distance: all.dynamics.distance,
                        warm_up: all.dynamics.warm_up,
                        // Whether there are any is said of a zone's factors on them.
                        recall: all.dynamics.recall.min(f32::MIN_POSITIVE),
                        locks: all.dynamics.locks.min(f32::MIN_POSITIVE),
                        ..DynamicsSection::default()
                    },
                    // Of how many frames a loop is is said, too.
                    scene: SceneSection {
                        fps: all.scene.fps,
                        ..SceneSection::default()
                    },
                    ..Sections::default()
                },
            },
            objects: (preset.objects.iter())
                .map(|object| object.section.clone())
                .collect(),
            meshes: (preset.meshes.iter())
                .map(|mesh| without_paint(&mesh.section))
                .collect(),
            bodies: (preset.bodies.iter())
                .map(|body| body.section.clone())
                .collect(),
            zones: (preset.layers.iter())
                .filter_map(|layer| layer.zones.clone())
                .collect(),
            lines: (preset.lines.iter())
                .map(|lines| [&lines.section.name, &lines.section.of].map(Option::clone))
                .chain(preset.layers.iter().map(|layer| [None, layer.on.clone()]))
                .collect(),
            texts: (look.texts.iter())
                .filter(|(path, _)| is_named(path))
                .map(|(path, text)| (path.clone(), text.clone()))
                .collect(),
            files: files.to_vec(),
        }
    }
}

/// A mesh in the colours and the outline of one of which nothing is said.
fn without_paint(mesh: &MeshSection) -> MeshSection {
    let MeshSection {
        color,
        shade,
        line,
        width,
        ..
    } = MeshSection::default();
    MeshSection {
        color,
        shade,
        line,
        width,
        ..mesh.clone()
    }
}

fn failed(error: StageError) -> Problem {
    Problem::Failed(error.to_string())
}

fn mistakes(errors: &PresetErrors) -> Vec<Problem> {
    errors.0.iter().cloned().map(Problem::Mistake).collect()
}
