//! Bodies with their files.

use super::forms::{End, Form, Forms};
use super::section::{BodySection, BodyShape, NamedBody, NamedKey};
use super::{Body, Key, Own};
use crate::files::StageError;
use crate::numbered::gap_note;
use crate::script::turned;
use effects::preset::{PresetErrors, suggestion};
use effects::section::Section as _;
use glam::{DVec3, Vec3};
use hair_io::orient::Orientation;
use mesh_io::{Model, Sequence, Shape};
use render::Head;
use std::path::Path;

/// The most forms of a mesh: so many fit into memory.
const MOST_FORMS: usize = 600;
/// Forms a second of an animation.
const ANIMATION_RATE: f64 = 24.0;

/// Bodies that a preset and its script list, each with the folder of the file that does, about a head at rest; with the script's keys.
///
/// # Errors
///
/// When files cannot be read, or a key's body is not there: all of these, where they are named.
pub(crate) fn load(
    named: &[(&NamedBody, &Path)],
    keys: &[NamedKey],
    head: Head,
    orientation: &Orientation,
) -> Result<Vec<Body>, StageError> {
    let mut bodies = Vec::with_capacity(named.len());
    let mut mistakes = Vec::new();
    for (body, folder) in named {
        match read(&body.section, folder, head, orientation) {
            Ok(body) => bodies.push(body),
            Err(error @ StageError::Section { .. }) => return Err(error),
            Err(error) => mistakes.push(body.unread(folder, &error).ok_or(error)?),
        }
    }
    if !mistakes.is_empty() {
        return Err(PresetErrors(mistakes).into());
    }
    for key in keys {
        let is_meant = |body: &Body| body.section.name.as_deref() == Some(key.body());
        // A script's own comes before the preset's of the same name.
        let Some(body) = bodies.iter_mut().rev().find(|body| is_meant(body)) else {
            let names = named
                .iter()
                .filter_map(|(body, _)| body.section.name.as_deref());
            mistakes.push(key.unknown(names));
            continue;
        };
        let section = &key.section;
        let time = f64::from(section.time);
        if body.keys.last().is_some_and(|last| last.time >= time) {
            mistakes.push(key.late());
        }
        body.keys.push(Key {
            time,
            shift: Vec3::from(section.at).as_dvec3() * f64::from(head.height_m),
            turn: Vec3::from(section.turn).as_dvec3(),
            size: f64::from(section.size),
        });
    }
    match mistakes.is_empty() {
        true => Ok(bodies),
        false => Err(PresetErrors(mistakes).into()),
    }
}

fn read(
    section: &BodySection,
    folder: &Path,
    head: Head,
    orientation: &Orientation,
) -> Result<Body, StageError> {
    let refused = |error| StageError::Section {
        section: "bodies",
        error,
    };
    section.check().map_err(refused)?;
    let height_m = f64::from(head.height_m);
    let place = |at: [f32; 3]| Vec3::from(at).as_dvec3() * height_m;
    let center = head.center.as_dvec3();
    let radius = f64::from(section.radius) * height_m;
    let mut gap_note = None;
    let (middle, own) = match section.shape {
        BodyShape::Sphere => (center + place(section.at), Own::Sphere { radius }),
        BodyShape::Capsule => {
            let [from, to] = [section.at, section.to].map(place);
            let half = (to - from) * 0.5;
            (center + (from + to) * 0.5, Own::Capsule { half, radius })
        }
        BodyShape::Mesh => {
            let (middle, forms, note) = mesh(section, folder, orientation)?;
            gap_note = note;
            (middle + place(section.at), Own::Mesh(forms))
        }
    };
    Ok(Body {
        section: section.clone(),
        middle,
        own,
        keys: Vec::new(),
        gap_note,
    })
}

/// What is wrong with the file of a body, if it has one.
pub(crate) fn check(section: &BodySection, folder: &Path) -> Result<(), StageError> {
    match section.shape {
        BodyShape::Mesh => mesh(section, folder, &Orientation::OURS).map(drop),
        BodyShape::Sphere | BodyShape::Capsule => Ok(()),
    }
}

/// A mesh about its middle, and where that is; with a note where files of it are missing.
fn mesh(
    section: &BodySection,
    folder: &Path,
    orientation: &Orientation,
) -> Result<(DVec3, Forms, Option<String>), StageError> {
    let path = section.path(folder);
    let wrong = |message: String| StageError::Body {
        path: path.clone().unwrap_or_default(),
        message,
    };
    let Some(path) = &path else {
        return Err(wrong("a body of shape mesh needs a `file`".to_owned()));
    };
    let mut rate = f64::from(section.rate);
    let mut end = End::of_files(section.repeat);
    let mut forms = Vec::new();
    let mut note = None;
    if section.is_sequence() {
        let sequence = Sequence::find(path)?;
        let frames = sequence.files().len();
        if frames > MOST_FORMS {
            return Err(wrong(format!(
                "there are {frames} numbered files, and a body takes {MOST_FORMS} at most"
            )));
        }
        note = gap_note("bodies", &sequence);
        for &frame in sequence.files().keys() {
            forms.push(form(&sequence.read(frame)?, None, orientation));
        }
    } else {
        let model = mesh_io::read_model(path)?;
        match &section.animation {
            None => forms.push(form(&model, None, orientation)),
            Some(name) => {
                end = End::of_animation(section.repeat);
                (rate, forms) = animated(&model, name, orientation).map_err(wrong)?;
            }
        }
    }
    let Some(first) = forms.first() else {
        return Err(wrong("it has no form".to_owned()));
    };
    let [low, high] = first.bounds();
    let middle = ((low + high) * 0.5).as_dvec3();
    let turn = turned(Vec3::from(section.turn).as_dvec3());
    for form in &mut forms {
        form.put(middle, turn, f64::from(section.size));
    }
    let several = forms.len() > 1;
    let forms = Forms::new(forms, rate, end);
    let forms = forms.map_err(|(number, error)| {
        wrong(match several {
            true => format!("its form {}: {error}", number + 1),
            false => error.to_string(),
        })
    })?;
    Ok((middle, forms, note))
}

/// The forms of an animation, from its start to its very end, and how many are a second.
fn animated(
    model: &Model,
    name: &str,
    orientation: &Orientation,
) -> Result<(f64, Vec<Form>), String> {
    let rig = model.rig.as_ref();
    let rig = rig.ok_or_else(|| "it has no animation".to_owned())?;
    let animation = rig.animation(name).ok_or_else(|| {
        let names = rig.animations.iter().filter_map(|own| own.name.as_deref());
        format!(
            "it has no animation `{name:.40}`{}",
            suggestion(name, names)
        )
    })?;
    let length = rig.animations[animation].length;
    let steps = (length * ANIMATION_RATE).ceil();
    if steps >= MOST_FORMS as f64 {
        return Err(format!(
            "its animation lasts {length:.1} s, and a body takes {:.1} s at most",
            (MOST_FORMS - 1) as f64 / ANIMATION_RATE
        ));
    }
    let rate = if steps > 0.0 {
        steps / length
    } else {
        ANIMATION_RATE
    };
    let form = |step: u32| {
        let pose = model.pose(Some(animation), f64::from(step) / rate);
        let shapes = pose.map(|pose| model.shapes(&pose));
        form(model, shapes.as_deref(), orientation)
    };
    Ok((rate, (0..=steps as u32).map(form).collect()))
}

/// All meshes of a model as one, in these shapes or as the file has them.
fn form(model: &Model, shapes: Option<&[Shape]>, orientation: &Orientation) -> Form {
    let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (index, mesh) in model.meshes.iter().enumerate() {
        let first = positions.len() as u32;
        let (own, facing) = match shapes.and_then(|shapes| shapes.get(index)) {
            Some(shape) => (&shape.positions, &shape.normals),
            None => (&mesh.positions, &mesh.normals),
        };
        positions.extend(own.iter().map(|p| orientation.apply(*p)));
        normals.extend(facing.iter().map(|n| orientation.up.to_y_up(*n)));
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| first + i)));
    }
    Form::new((positions, normals, triangles))
}
