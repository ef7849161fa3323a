//! The preset's files: hair and head in, strands with their sizes out.

use crate::files::{Files, StageError};
use crate::hair::{HairModel, head_of};
use crate::head::HeadModel;
use crate::lids::lids;
use crate::meant::meant;
use crate::mesh_hair;
use crate::names::Names;
use crate::painted::{self, PaintedMesh, shells};
use crate::preset::{
    BlushChoice, DressChoice, ExpressionChoice, EyesChoice, HairFrom, HairSection, HeadColors,
    HeadSection, HeadShape, Preset, UpAxis,
};
use crate::skeleton::Skeleton;
use crate::style;
use effects::preset::LayerSpec;
use glam::{Vec2, Vec3};
use groom::{Blush, Dress, Expression, Eyes, Face, Figure, Taper};
use hair_io::orient::{Axes, Orientation};
use hair_io::{HairError, HairFile, HairOptions, HeadFile, HeadFrame, Mesh};
use hair_sim::Strands;
use mesh_io::Model;
use render::NO_TAPER;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// From the chin to the top of a figure, metres.
const FIGURE_HEIGHT_M: f32 = 0.24;

fn axes(up: UpAxis) -> Option<Axes> {
    match up {
        UpAxis::Guess => None,
        UpAxis::Y => Some(Axes::Y),
        UpAxis::Z => Some(Axes::Z),
    }
}

fn scale(number: f32) -> Option<f32> {
    (number > 0.0).then_some(number)
}

/// Whether a file is hair that grows.
pub(crate) fn is_style(path: &Path) -> bool {
    path.to_string_lossy().ends_with(".style.ron")
}

/// The caller's file, or the preset's beside the preset.
pub(crate) fn chosen(
    given: Option<&PathBuf>,
    own: Option<&String>,
    folder: &Path,
) -> Option<PathBuf> {
    given.cloned().or_else(|| own.map(|name| folder.join(name)))
}

/// A head as it was read.
pub(crate) struct ReadHead {
    /// What is drawn, if anything.
    pub model: Option<HeadModel>,
    /// Its own hair, where the preset's hair is from there.
    pub hair: Option<HairModel>,
    /// How its file lies in our space.
    pub orientation: Orientation,
}

/// The head that is drawn, if any, and its own hair where the preset's hair is from there.
pub(crate) fn head(
    preset: &Preset,
    files: &Files,
    notes: &mut Vec<String>,
) -> Result<ReadHead, StageError> {
    let section = &preset.sections.head;
    let own = section.file.as_ref();
    let Some(path) = chosen(files.head.as_ref(), own, &files.preset_folder) else {
        if preset.sections.motion.character {
            return Err(StageError::NoCharacter);
        }
        if wants_own_hair(preset, files) {
            if preset.sections.hair.file.is_none() {
                return Err(StageError::NoHeadsHair);
            }
            notes.push(
                "hair: there is no head's file that it could be of, the preset's file is drawn"
                    .to_owned(),
            );
        }
        let head = match section.shape {
            HeadShape::None => HeadModel::none(),
            HeadShape::Bust => HeadModel::bust(),
            HeadShape::Figure => files.heads.figure(figure(section)),
        };
        let is_none = section.shape == HeadShape::None;
        let model = match (is_none, preset.meshes.is_empty()) {
            (true, true) => None,
            (true, false) if has_hair(preset, files) => return Err(StageError::MeshesWithoutHead),
            _ => {
                let beside = beside(preset, files, &Orientation::OURS, &head, notes)?;
                let model = head.painted(Vec::new(), beside);
                Some(match is_none {
                    true => model.of_things(),
                    false => model,
                })
            }
        };
        return Ok(ReadHead {
            model,
            hair: None,
            orientation: Orientation::OURS,
        });
    };
    let HeadFile {
        mesh,
        mut model,
        orientation,
        notes: read,
    } = hair_io::read_head(&path, axes(section.up), scale(section.scale))?;
    notes.extend(read);
    notes.extend(left_beside(preset, files, &path));
    let orientation = &orientation;
    let hidden = Names(section.hide.as_deref().unwrap_or_default());
    let mut hidden = meant(hidden, &model, &path)?;
    if section.colors == HeadColors::File {
        painted::hide_clear(&model, &path, &mut hidden, notes);
    }
    // What lies around her is drawn, and no part of her shape.
    let is_shell = shells(&model, &hidden);
    let mut no_shape = hidden.clone();
    for (index, no_shape) in no_shape
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| is_shell[*i])
    {
        no_shape.fill(true);
        notes.push(format!(
            "{}: mesh `{}` faces inwards around others: an outline of the file's own, seen past their edges alone",
            path.display(),
            model.meshes[index].name
        ));
    }
    let own_hair = match wants_own_hair(preset, files) {
        true => mesh_hair::find(&model, &path, orientation, &preset.sections.hair, &no_shape)?,
        false => None,
    };
    let is_gone = match &own_hair {
        Some(own) => either(&no_shape, &own.is_hair),
        None => no_shape.clone(),
    };
    if own_hair.is_none() && preset.sections.hair.from == HairFrom::Character && lacks_head(&model)
    {
        notes.push(format!(
            "head: WARNING: {} has neither hair nor a bone called `head`, so all of its meshes are taken for a head. If they are \
             none, take a character that has one; if they are a head and more, hide the rest (head.hide, --set 'head.hide=Body*')",
            path.display()
        ));
    }
    if let (None, Some(name)) = (&own_hair, mesh_hair::in_shape(&model, &no_shape)) {
        notes.push(format!(
            "head: what is called `{name}` is a part of the head's shape, as none of it becomes strands: hide it where other hair grows there \
             (head.hide, --set 'head.hide={name}')"
        ));
    }
    let frame = match &own_hair {
        Some(_) => without_kept(&model, &path, orientation, &preset.sections.hair, &no_shape),
        None => None,
    };
    let mut mesh = match is_gone.iter().flatten().any(|gone| *gone) {
        false => mesh,
        true => {
            let nothing_left = match own_hair {
                Some(_) => StageError::AllHair,
                None => StageError::AllHidden,
            };
            let shape = shape_of(corners(&model, orientation, &is_gone, false));
            shape.ok_or_else(|| nothing_left(path.clone()))?
        }
    };
    let mut painted = match section.colors {
        HeadColors::Preset => Vec::new(),
        HeadColors::File => {
            let file = painted::Wanted::OF_FILE;
            let mut painted = painted::of_model(&model, &path, orientation, &file, &hidden, notes)?;
            for mesh in &mut painted {
                mesh.color_triangles(&model);
            }
            painted
        }
    };
    let hair_paint = own_hair
        .as_ref()
        .map(|own| own.take_away(&hidden, &mut painted));
    if own_hair.is_none() {
        painted
            .iter_mut()
            .for_each(|mesh| mesh.take_away(&hidden[mesh.index]));
    }
    let is_turned = is_inside_out(&mesh);
    if is_turned {
        notes.push("head: its triangles face inwards and are turned around".to_owned());
        turn_around(&mut mesh.triangles, &mut mesh.normals);
        for mesh in &mut painted {
            turn_around(&mut mesh.triangles, &mut mesh.normals);
            mesh.is_turned = true;
        }
    }
    for mesh in &mut painted {
        mesh.is_shell = is_shell[mesh.index];
    }
    let mut head = HeadModel::from(mesh);
    head.frame = frame.map(head_of);
    let beside = beside(preset, files, orientation, &head, notes)?;
    let mut head = head.painted(painted, beside);
    let mut no_body = is_gone;
    if preset.sections.motion.character {
        if section.colors != HeadColors::File {
            return Err(StageError::NoCharacter);
        }
        // Its pictures are on the meshes; as the file has them they are of no more use.
        model.images = Vec::new();
        let model = Arc::new(model);
        let motion = &preset.sections.motion;
        let skeleton = Skeleton::new(model.clone(), &path, orientation, motion, &no_body)?;
        no_body = either(&no_body, &skeleton.on_limbs());
        head.body = body_of(&model, orientation, &no_body, is_turned);
        head.skeleton = Some(Arc::new(skeleton));
    } else {
        head.body = body_of(&model, orientation, &no_body, is_turned);
    }
    let hair = own_hair.zip(hair_paint).map(|(own, paint)| {
        let hair = own.into_hair(&head, &preset.sections.hair, &paint)?;
        notes.extend(hair.file.notes.iter().cloned());
        note_guides(preset, &hair, notes);
        Ok::<_, StageError>(hair)
    });
    let hair = hair.transpose()?;
    if hair.is_none() && wants_own_hair(preset, files) {
        if preset.sections.hair.file.is_none() {
            return Err(StageError::NoMeshHair(path));
        }
        notes
            .push("hair: the character has none of its own, the preset's file is drawn".to_owned());
    }
    Ok(ReadHead {
        model: Some(head),
        hair,
        orientation: *orientation,
    })
}

/// Where the head is of a character some of whose hair stays a mesh: a ribbon makes it no larger. Nothing where none stays.
fn without_kept(
    model: &Model,
    path: &Path,
    orientation: &Orientation,
    section: &HairSection,
    hidden: &[Vec<bool>],
) -> Option<HeadFrame> {
    section.keep.as_ref()?;
    let all = HairSection {
        keep: None,
        ..section.clone()
    };
    let all = mesh_hair::find(model, path, orientation, &all, hidden).ok()??;
    let is_gone = either(hidden, &all.is_hair);
    let bare = shape_of(corners(model, orientation, &is_gone, false))?;
    Some(HeadFrame::find(Some(&bare), &[]))
}

/// Of a head that is one of several files, as eyes and lashes are in OBJ, a sentence that names those which aren't drawn.
fn left_beside(preset: &Preset, files: &Files, path: &Path) -> Option<String> {
    let stem = path.file_stem()?.to_str()?;
    let folder = match path.parent()? {
        here if here.as_os_str().is_empty() => Path::new("."),
        folder => folder,
    };
    let drawn = preset.meshes.iter();
    let drawn = drawn.filter_map(|mesh| mesh.section.path(&files.preset_folder));
    let drawn: Vec<_> = drawn.filter_map(|path| path.canonicalize().ok()).collect();
    let is_part = |own: &PathBuf| {
        let rest =
            (own.file_stem().and_then(|own| own.to_str())).and_then(|own| own.strip_prefix(stem));
        // What only collides is not to be seen.
        rest.is_some_and(|rest| rest.starts_with(['-', '_', '.']) && !rest.contains("collider"))
            && own.extension() == path.extension()
            && own.canonicalize().is_ok_and(|own| !drawn.contains(&own))
    };
    let entries = folder.read_dir().ok()?;
    let parts = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut parts: Vec<String> = parts
        .filter(is_part)
        .filter_map(|part| Some(part.file_name()?.to_str()?.to_owned()))
        .collect();
    parts.sort();
    let first = parts.first()?;
    Some(format!(
        "head: not drawn of what lies beside it: {}. In `meshes: [(file: \"{first}\")]` it is",
        parts.join(", ")
    ))
}

/// Whether a file of nodes has none that is a head by its name. Files of meshes alone don't say what they are.
fn lacks_head(model: &Model) -> bool {
    let Some(rig) = &model.rig else {
        return false;
    };
    let names = rig.nodes.iter().filter_map(|node| node.name.as_deref());
    let mut names = names.chain(model.meshes.iter().map(|mesh| &mesh.name[..]));
    !rig.humanoid.contains_key("head") && !names.any(|name| name.to_lowercase().contains("head"))
}

/// Whether hair is the character's own where it has some.
fn wants_own_hair(preset: &Preset, files: &Files) -> bool {
    files.hair.is_none() && preset.sections.hair.from == HairFrom::Character
}

/// What one of two says of each triangle of each mesh.
fn either(one: &[Vec<bool>], other: &[Vec<bool>]) -> Vec<Vec<bool>> {
    let either = |(one, other): (&Vec<bool>, &Vec<bool>)| {
        let both = one.iter().zip(other);
        both.map(|(one, other)| *one || *other).collect()
    };
    one.iter().zip(other).map(either).collect()
}

/// The corners of all triangles of a model of which `is_gone` is `wanted`, in our space.
fn corners(
    model: &Model,
    orientation: &Orientation,
    is_gone: &[Vec<bool>],
    wanted: bool,
) -> impl Iterator<Item = [Vec3; 3]> {
    let meshes = model.meshes.iter().zip(is_gone);
    let all = meshes.flat_map(|(mesh, is_gone)| mesh.corners().zip(is_gone));
    let these = all.filter(move |(_, gone)| **gone == wanted);
    these.map(|(corners, _)| corners.map(|p| orientation.apply(p)))
}

/// Triangles as one shape; nothing where there is none.
fn shape_of(corners: impl Iterator<Item = [Vec3; 3]>) -> Option<Mesh> {
    let shape = Mesh::from_corners(corners);
    (!shape.triangles.is_empty()).then_some(shape)
}

/// What hair is kept out of: what is left of a model, with lids where something was cut away. `is_turned` tells whether its outside is where the file has the
/// inside.
fn body_of(
    model: &Model,
    orientation: &Orientation,
    is_gone: &[Vec<bool>],
    is_turned: bool,
) -> Option<Arc<Mesh>> {
    let [kept, gone] = [false, true].map(|gone| corners(model, orientation, is_gone, gone));
    let kept: Vec<[Vec3; 3]> = kept.collect();
    let lids = lids(&kept, gone);
    let mut body = shape_of(kept.into_iter().chain(lids))?;
    if is_turned {
        turn_around(&mut body.triangles, &mut body.normals);
    }
    Some(Arc::new(body))
}

/// Turns the outside of a mesh in.
fn turn_around(triangles: &mut [[u32; 3]], normals: &mut [Vec3]) {
    triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(1, 2));
    normals.iter_mut().for_each(|normal| *normal = -*normal);
}

/// The meshes that a preset lists beside a head.
fn beside(
    preset: &Preset,
    files: &Files,
    orientation: &Orientation,
    head: &HeadModel,
    notes: &mut Vec<String>,
) -> Result<Vec<PaintedMesh>, StageError> {
    if preset.meshes.is_empty() {
        return Ok(Vec::new());
    }
    let sections: Vec<_> = preset.meshes.iter().map(|mesh| &mesh.section).collect();
    let folder = &files.preset_folder;
    painted::of_sections(&sections, folder, orientation, head.frame(&[]), notes)
}

/// Whether a file is named that holds hair.
fn has_hair(preset: &Preset, files: &Files) -> bool {
    files.hair.is_some() || preset.sections.hair.file.is_some()
}

/// Whether a picture may be one without hair: nothing that a layer draws is of hair, and something else is there.
fn may_lack_hair(preset: &Preset, head: Option<&HeadModel>) -> bool {
    let is_of_hair =
        |layer: &LayerSpec| !layer.effect.is_for_meshes() && !layer.effect.is_for_lines();
    head.is_some() && !preset.layers.iter().any(is_of_hair)
}

/// The figure that a section describes.
fn figure(section: &HeadSection) -> Figure {
    Figure {
        crop_m: section.crop * FIGURE_HEIGHT_M,
        dress: match section.dress {
            DressChoice::None => Dress::None,
            DressChoice::Choker => Dress::Choker,
            DressChoice::Turtleneck => Dress::Turtleneck,
            DressChoice::Collar => Dress::Collar,
            DressChoice::Jacket => Dress::Jacket,
            DressChoice::Sailor => Dress::Sailor,
        },
        face: Face {
            eyes: match section.eyes {
                EyesChoice::Round => Eyes::Round,
                EyesChoice::Almond => Eyes::Almond,
                EyesChoice::Sharp => Eyes::Sharp,
                EyesChoice::Sleepy => Eyes::Sleepy,
            },
            eye_size: section.eye_size,
            highlights: section.highlights,
            expression: match section.expression {
                ExpressionChoice::Neutral => Expression::Neutral,
                ExpressionChoice::Smile => Expression::Smile,
                ExpressionChoice::Laugh => Expression::Laugh,
                ExpressionChoice::Closed => Expression::Closed,
            },
            brow: section.brow,
            blush: match section.blush {
                BlushChoice::None => Blush::None,
                BlushChoice::Flat => Blush::Flat,
                BlushChoice::Hatch => Blush::Hatch,
            },
        },
    }
}

/// Whether most of a mesh faces inwards: its signed volume, seen from its middle, is below 0.
fn is_inside_out(mesh: &Mesh) -> bool {
    let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| (mesh.positions[i as usize] - middle).as_dvec3());
            a.dot(b.cross(c))
        })
        .sum();
    volume < 0.0
}

/// All strands of the hair, sorted by id.
pub(crate) fn hair(
    preset: &Preset,
    files: &Files,
    head: Option<&HeadModel>,
    notes: &mut Vec<String>,
) -> Result<HairModel, StageError> {
    let own = preset.sections.hair.file.as_ref();
    let Some(path) = chosen(files.hair.as_ref(), own, &files.preset_folder) else {
        return match may_lack_hair(preset, head) {
            true => Ok(HairModel::none(head)),
            false => Err(StageError::NoHair),
        };
    };
    let hair = strands(preset, files, &path, head, notes)?;
    note_guides(preset, &hair, notes);
    Ok(hair)
}

/// Tells how many strands are guides.
fn note_guides(preset: &Preset, hair: &HairModel, notes: &mut Vec<String>) {
    let (all, guides) = (hair.file.strands.len(), preset.sections.hair.guides);
    if guides > 0 && (guides as usize) < all {
        notes.push(format!(
            "hair: {guides} of the {all} strands are drawn, as guides (hair.guides, --guides)"
        ));
    }
}

/// All strands of a file or style as the preset reads hair, sorted by id.
pub(crate) fn strands(
    preset: &Preset,
    files: &Files,
    path: &Path,
    head: Option<&HeadModel>,
    notes: &mut Vec<String>,
) -> Result<HairModel, StageError> {
    let section = &preset.sections.hair;
    if is_style(path) {
        let mut hair = grow(files, path, head)?;
        notes.append(&mut hair.file.notes);
        return Ok(hair);
    }
    let given = hair_io::orient::Given {
        up: axes(section.up),
        scale: scale(section.scale),
        offset: None,
    };
    let mesh = head.map(|head| &head.mesh);
    let options = HairOptions { given, head: mesh };
    let mut hair = hair_io::read_hair(path, &options).map_err(with_styles)?;
    notes.append(&mut hair.notes);
    if given.scale.is_none() {
        notes.extend(misfit(&hair.strands, mesh));
    }
    notes.extend(without_length(&hair.strands));
    Ok(HairModel::read(hair, head))
}

/// A warning of strands of which all points are in one place, as nothing is drawn of them.
fn without_length(strands: &Strands) -> Option<String> {
    let is_point = |strand: &[Vec3]| strand.iter().all(|point| *point == strand[0]);
    let found = strands.iter().filter(|strand| is_point(strand)).count();
    (found > 0).then(|| {
        let all = strands.len();
        format!("hair: WARNING: {found} of {all} strands have no length, all points in one place: nothing is drawn of them")
    })
}

/// The error of a format that is not read, with styles among those that are.
pub(crate) fn with_styles(error: HairError) -> HairError {
    match error {
        HairError::Format { path, found, .. } => HairError::Format {
            path,
            found,
            reads: "TressFX (.tfx), own strands (.strands.ron) and hair styles (.style.ron)",
        },
        other => other,
    }
}

/// Sizes of hair that a head may wear, in head heights.
const PLAUSIBLE_SIZES: RangeInclusive<f32> = 0.33..=12.0;
/// How far from the head's middle that of the roots may be, in head heights.
const PLAUSIBLE_DISTANCE: f32 = 1.0;

/// A warning where hair hardly fits the head, which a wrong unit or axis does.
fn misfit(strands: &Strands, head: Option<&Mesh>) -> Option<String> {
    // The mesh alone: with roots that don't fit it, the head would be theirs.
    let head = HeadFrame::find(Some(head?), &[]);
    let size = size_of_most(strands.points());
    let roots = strands.roots().sum::<Vec3>() / strands.len() as f32;
    let away = roots.distance(head.center);
    let fits =
        PLAUSIBLE_SIZES.contains(&(size / head.height)) && away <= PLAUSIBLE_DISTANCE * head.height;
    (!fits).then(|| {
        format!(
            "hair: WARNING: it is {:.3} m large, and its roots are {:.3} m from the middle of the head, which is {:.3} m \
             high: if that is wrong, say metres a unit and the upward axis (hair.scale, hair.up; --set hair.scale=0.01)",
            size, away, head.height
        )
    })
}

/// The longest side of the box around points, without the outer twentieth on each side: strays don't count.
fn size_of_most(points: &[Vec3]) -> f32 {
    let twentieth = points.len() / 20;
    let side = |axis: usize| {
        let mut places: Vec<f32> = points.iter().map(|point| point[axis]).collect();
        places.sort_unstable_by(f32::total_cmp);
        places[places.len() - 1 - twentieth] - places[twentieth]
    };
    side(0).max(side(1)).max(side(2))
}

/// A clump's own taper, as a frame has it.
fn taper(own: &Taper) -> Vec2 {
    let or_none = |share: Option<f32>, none: f32| share.unwrap_or(none);
    Vec2::new(
        or_none(own.root_size, NO_TAPER.x),
        or_none(own.shrink_start, NO_TAPER.y),
    )
}

/// The hair of a style, grown on the head.
fn grow(files: &Files, path: &Path, head: Option<&HeadModel>) -> Result<HairModel, StageError> {
    let model = head.ok_or_else(|| StageError::NoHead(path.to_owned()))?;
    let text = files.read_text(path)?;
    let style::Written {
        style,
        dynamics,
        colors,
    } = style::parse(&path.display().to_string(), &text)?;
    // The mesh alone: the hair that grows on a head must not change its size.
    let (mesh, head) = (&model.mesh, model.frame(&[]));
    let shell = groom::Shell::new(
        &mesh.positions,
        &mesh.normals,
        &mesh.triangles,
        head.center,
        head.height_m,
    );
    let grown = groom::grow(&style, &shell);
    let notes = vec![format!(
        "hair: {} clumps, grown from the style",
        grown.strands.len()
    )];
    Ok(HairModel {
        infos: Vec::new(),
        all_roots: grown.strands.roots().collect(),
        reach_m: 0.0,
        ranks: OnceLock::new(),
        file: HairFile {
            strands: grown.strands,
            motion: None,
            notes,
        },
        held: grown.held,
        tapers: grown.tapers.iter().map(taper).collect(),
        undercoat: grown.undercoat,
        shapes: None,
        bake: None,
        own_colors: Vec::new(),
        ornaments: grown.ornaments,
        low_ties: grown.low_ties,
        zone_names: style.zones.iter().map(|zone| zone.name.clone()).collect(),
        zone_cuts: style.zones.iter().map(|zone| zone.cut.is_some()).collect(),
        zone_dynamics: dynamics,
        zone_colors: colors,
        head,
    })
}
