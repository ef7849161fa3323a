//! A scene: the hair and head of a preset, at a time, as a frame.

use crate::head::{self, HeadModel, HeadPaint};
use crate::preset::Preset;
use crate::style;
use effects::{Layer, Parameters, clump};
use glam::Vec3;
use hair_io::orient::Axes;
use hair_io::{HairFile, HairOptions, HeadFrame, Mesh};
use render::{Frame, Head, Light, Order, StrandInfo};
use std::path::{Path, PathBuf};
use stroke_path::{Camera, OrbitView, PathKind, Paths, direction_from_angles};

/// How near the eye strokes are cut, in head heights.
const NEAR: f32 = 0.05;

/// How much nearer than the inside of the head hair must be to be seen through an opening, in head
/// heights: more than the clumps around the skull reach into it.
const HOLLOW: f32 = 0.3;

/// Radius of a clump in units of the spacing of the roots: neighbours overlap and hide the scalp.
const RADIUS_IN_SPACINGS: f32 = 0.75;

/// Files that the caller gives in place of the preset's.
#[derive(Clone, Debug, Default)]
pub struct Files {
    /// The folder that the preset's own file names are relative to.
    pub preset_folder: PathBuf,
    /// Hair, relative to the current folder.
    pub hair: Option<PathBuf>,
    /// Head, relative to the current folder.
    pub head: Option<PathBuf>,
}

/// Why there is no frame.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// The hair or head could not be read.
    #[error(transparent)]
    File(#[from] hair_io::HairError),
    /// Neither the preset nor the caller names strands.
    #[error(
        "the preset names no hair: give one with --hair FILE, or hair: (file: \"...\") in the preset"
    )]
    NoHair,
    /// A style grows on a head.
    #[error("{}: a style needs a head to grow on: --head FILE, or head: (shape: bust) in the preset", .0.display())]
    NoHead(PathBuf),
    /// A style cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A style has mistakes.
    #[error(transparent)]
    Style(#[from] effects::preset::PresetErrors),
    /// The camera cannot look like that.
    #[error(transparent)]
    Camera(#[from] stroke_path::CameraError),
    /// The paths cannot be made.
    #[error(transparent)]
    Path(#[from] stroke_path::PathError),
}

/// A scene that makes frames. What a frame needs is kept and reused.
pub struct Stage {
    hair: HairFile,
    /// The strands' sizes, and ids increasing.
    strands: Vec<StrandInfo>,
    model: Option<HeadModel>,
    head: Head,
    /// Sentences for the user: what was guessed.
    notes: Vec<String>,
    seed: u32,
    clump: clump::Params,
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
    path: PathKind,
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
        let model = load_head(preset, files, &mut notes)?;
        let mesh = model.as_ref().map(|model| &model.mesh);
        let hair = load_hair(preset, files, mesh, &mut notes)?;
        let roots: Vec<Vec3> = hair.strands.roots().collect();
        let frame = HeadFrame::find(mesh, &roots);
        let head = Head {
            center: frame.center,
            height_m: frame.height,
        };
        let settings = Settings::new(preset, head)?;
        let strands = sizes(preset, &hair, &roots, head);
        Ok(Self {
            points: hair.strands.points().to_vec(),
            hair,
            strands,
            model,
            head,
            notes,
            seed: preset.seed,
            clump: clump::Program::params(&preset.clump),
            layers: preset.layers.iter().map(|layer| layer.build()).collect(),
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
        self.strands.len()
    }

    /// Strands that no part of the last frame's paths shows: behind the eye, or too far to be drawn.
    #[must_use]
    pub fn culled(&self) -> usize {
        let mut seen = 0;
        let mut last = None;
        for run in &self.paths.runs {
            seen += usize::from(last != Some(run.strand));
            last = Some(run.strand);
        }
        self.strands.len() - seen
    }

    /// Moves the hair to `time` (seconds).
    pub fn advance_to(&mut self, time: f32) {
        match &self.hair.motion {
            Some(motion) => motion.sample(time, &mut self.points),
            None => self.points.copy_from_slice(self.hair.strands.points()),
        }
    }

    /// The frame of the hair as it stands.
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
        let near_m = NEAR * self.head.height_m;
        let camera = self
            .camera
            .insert(Camera::orbit(view, settings.size, near_m)?);
        self.paths.clear();
        for (i, info) in self.strands.iter_mut().enumerate() {
            let particles = &self.points[self.hair.strands.point_range(i)];
            info.mean = particles.iter().sum::<Vec3>() / particles.len() as f32;
            self.paths
                .push_strand(i, particles, settings.path, camera)?;
        }
        let light = settings.light(camera, self.head);
        let surfaces = match &self.model {
            Some(model) => head::surfaces(model, &settings.paint, camera, &light),
            None => Vec::new(),
        };
        Ok(Frame {
            camera,
            paths: &self.paths,
            strands: &self.strands,
            head: self.head,
            light,
            clump: &self.clump,
            seed: self.seed,
            layers: &self.layers,
            surfaces,
            background: settings.background,
            order: settings.order,
        })
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
            order: [Order::StrandFirst, Order::Shifted][scene.choice("order") as usize],
            path: match path.choice("kind") {
                0 => PathKind::Linear { subdivision },
                _ => PathKind::CatmullRom { subdivision },
            },
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
                width_m: paint.number("width") * head.unit_m(),
                hollow_m: HOLLOW * head.height_m,
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

fn axes(choice: u32) -> Option<Axes> {
    [None, Some(Axes::Y), Some(Axes::Z)][choice as usize]
}

fn scale(number: f32) -> Option<f32> {
    (number > 0.0).then_some(number)
}

/// The caller's file, or the preset's beside the preset.
fn chosen(given: Option<&PathBuf>, own: Option<&str>, folder: &Path) -> Option<PathBuf> {
    given.cloned().or_else(|| own.map(|name| folder.join(name)))
}

fn load_head(
    preset: &Preset,
    files: &Files,
    notes: &mut Vec<String>,
) -> Result<Option<HeadModel>, StageError> {
    let values = &preset.head;
    let Some(path) = chosen(
        files.head.as_ref(),
        values.text("file"),
        &files.preset_folder,
    ) else {
        let is_bust = values.choice("shape") == 1;
        return Ok(is_bust.then(HeadModel::bust));
    };
    let file = hair_io::read_head(
        &path,
        axes(values.choice("up")),
        scale(values.number("scale")),
    )?;
    notes.extend(file.notes);
    Ok(Some(file.mesh.into()))
}

/// The hair with the strands that are kept, sorted by id.
fn load_hair(
    preset: &Preset,
    files: &Files,
    head: Option<&Mesh>,
    notes: &mut Vec<String>,
) -> Result<HairFile, StageError> {
    let values = &preset.hair;
    let path = chosen(
        files.hair.as_ref(),
        values.text("file"),
        &files.preset_folder,
    )
    .ok_or(StageError::NoHair)?;
    if path.to_string_lossy().ends_with(".style.ron") {
        return grow(&path, head);
    }
    let given = hair_io::orient::Given {
        up: axes(values.choice("up")),
        scale: scale(values.number("scale")),
        offset: None,
    };
    let mut hair = hair_io::read_hair(&path, &HairOptions { given, head })?;
    notes.append(&mut hair.notes);
    let guides = values.integer("guides").unsigned_abs() as usize;
    let mut kept: Vec<usize> = match guides {
        0 => (0..hair.strands.len()).collect(),
        _ => {
            let roots: Vec<Vec3> = hair.strands.roots().collect();
            hair_io::guides::spread_evenly(&roots, guides)
        }
    };
    kept.sort_by_key(|&i| hair.strands.id(i));
    hair.keep(&kept);
    Ok(hair)
}

/// The hair of a style, grown on the head.
fn grow(path: &Path, head: Option<&Mesh>) -> Result<HairFile, StageError> {
    let head = head.ok_or_else(|| StageError::NoHead(path.to_owned()))?;
    let text = std::fs::read_to_string(path).map_err(|source| StageError::Read {
        path: path.to_owned(),
        source,
    })?;
    let style = style::parse(&path.display().to_string(), &text)?;
    let frame = HeadFrame::find(Some(head), &[]);
    let shell = groom::Shell::new(
        &head.positions,
        &head.normals,
        &head.triangles,
        frame.center,
        frame.height,
    );
    let strands = groom::grow(&style, &shell);
    let notes = vec![format!(
        "hair: {} clumps, grown from the style",
        strands.len()
    )];
    Ok(HairFile {
        strands,
        motion: None,
        notes,
    })
}

/// Each strand's id and size: its own, the preset's, or from the spacing of the roots.
fn sizes(preset: &Preset, hair: &HairFile, roots: &[Vec3], head: Head) -> Vec<StrandInfo> {
    let strands = &hair.strands;
    let set = preset.hair.number("size");
    let needs_spacing = set <= 0.0 && (0..strands.len()).any(|i| strands.size(i).is_none());
    let spacing = if needs_spacing {
        hair_io::guides::spacing(roots)
    } else {
        Vec::new()
    };
    let from_spacing = |i: usize| RADIUS_IN_SPACINGS * spacing[i] / head.unit_m();
    (0..strands.len())
        .map(|i| StrandInfo {
            id: strands.id(i),
            mean: Vec3::ZERO,
            size: strands
                .size(i)
                .unwrap_or_else(|| if set > 0.0 { set } else { from_spacing(i) }),
        })
        .collect()
}
