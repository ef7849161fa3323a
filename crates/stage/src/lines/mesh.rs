//! The meshes of a head as one: what is to hide each other must be one mesh.

use super::strand::Seen;
use crate::head::HeadModel;
use crate::head::layers::{DRESS, SKIN, TIES};
use crate::look::LineSet;
use crate::names::Names;
use crate::painted::PaintedMesh;
use glam::Vec3;
use mesh_lines::{
    Bvh, Line, MeshError, Surface, TURN_COSINE, Topology, View, borders, contours, creases, facing,
    visible_of,
};
use render::Head;
use std::collections::HashMap;

/// What heads have under these names without a file, or may lack by the style and the preset's own words.
pub(super) const MAY_LACK: [&str; 2] = [DRESS, TIES];

/// The meshes of a head as one, whose lines are looked for.
pub(super) struct LineMesh {
    /// The angle of its creases, degrees; without it there are none.
    crease: Option<f32>,
    topology: Topology,
    bvh: Bvh,
    /// Where each of its vertices is found in the head.
    sources: Vec<Source>,
    /// Where they are, and the surface's normals: of its smooth vertices, as `mesh_lines` counts them.
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// The same at rest, head heights from the head's centre.
    rest: Vec<Vec3>,
    /// Its creases and borders, chained once, as they turn at rest: so they are the same lines in each pose.
    fixed: Vec<Line>,
    /// Which form of its numbered files each painted mesh of the head has.
    forms: Vec<usize>,
    /// The part of each triangle, none where outlines have thinned out and lines end, and what the parts are called.
    part_of: Vec<Option<u16>>,
    parts: Vec<Vec<String>>,
}

/// A vertex of a head.
#[derive(Clone, Copy)]
struct Source {
    of: Of,
    index: u32,
}

/// The mesh of a head that a vertex is of.
#[derive(Clone, Copy)]
enum Of {
    Head,
    Ornaments,
    Painted(u16),
}

/// What the lines of a head may be of, by name.
pub(super) fn names(head: &HeadModel, wears_ties: bool) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    if !head.is_painted() && !head.is_things {
        names.push(SKIN);
    }
    if !head.clothes.is_empty() {
        names.push(DRESS);
    }
    if wears_ties {
        names.push(TIES);
    }
    let painted = head.painted.iter().filter(|mesh| has_lines(mesh));
    names.extend(painted.flat_map(|mesh| mesh.names.iter().map(String::as_str)));
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether a mesh in its own colours has lines, and hides those behind it: not what is seen through.
fn has_lines(mesh: &PaintedMesh) -> bool {
    mesh.paint.has_outline()
}

/// The triangles of a part of a head, the mesh that they are of, and what it is called.
type Part<'h> = (Of, &'h [[u32; 3]], Vec<String>);

fn parts(head: &HeadModel) -> Vec<Part<'_>> {
    let mut parts: Vec<Part> = Vec::new();
    if !head.is_painted() && !head.is_things {
        parts.push((Of::Head, &head.skin, vec![SKIN.to_owned()]));
    }
    let clothes = head.clothes.iter();
    parts.extend(clothes.map(|(_, triangles)| {
        let name = vec![DRESS.to_owned()];
        (Of::Head, &triangles[..], name)
    }));
    let worn = &head.ornaments.triangles;
    parts.push((Of::Ornaments, worn, vec![TIES.to_owned()]));
    let painted = (0..=u16::MAX).zip(&head.painted);
    let painted = painted.filter(|(_, mesh)| has_lines(mesh));
    parts.extend(
        painted
            .map(|(number, mesh)| (Of::Painted(number), &mesh.triangles[..], mesh.names.clone())),
    );
    parts
}

/// Whether a triangle's outline has half of its width or more: not where a figure is cut off.
fn is_outlined(head: &HeadModel, of: Of, triangle: &[u32; 3]) -> bool {
    let width = |corner: &u32| head.outline.get(*corner as usize).copied();
    let widths = triangle.iter().map(|corner| width(corner).unwrap_or(1.0));
    !matches!(of, Of::Head) || widths.sum::<f32>() >= 1.5
}

impl Source {
    fn position(self, head: &HeadModel) -> Vec3 {
        let positions = match self.of {
            Of::Head => &head.mesh.positions,
            Of::Ornaments => &head.ornaments.positions,
            Of::Painted(number) => &head.painted[usize::from(number)].positions,
        };
        positions[self.index as usize]
    }
}

/// Which form of its numbered files each painted mesh of a head has.
fn forms(head: &HeadModel) -> impl Iterator<Item = usize> {
    head.painted.iter().map(|mesh| mesh.form)
}

impl LineMesh {
    /// Of a head at rest: vertices at one place are one.
    pub fn new(rest: &HeadModel, crease: Option<f32>, head: Head) -> Result<Self, MeshError> {
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let (mut sources, mut positions) = (Vec::new(), Vec::new());
        let (mut triangles, mut part_of) = (Vec::new(), Vec::new());
        let mut part_names = Vec::new();
        for (number, (of, part, name)) in (0..=u16::MAX).zip(parts(rest)) {
            for triangle in part {
                triangles.push(triangle.map(|index| {
                    let source = Source { of, index };
                    let position = source.position(rest);
                    // So that 0 and -0 are one place.
                    let place = (position + Vec3::ZERO).to_array().map(f32::to_bits);
                    *known.entry(place).or_insert_with(|| {
                        sources.push(source);
                        positions.push(position);
                        positions.len() as u32 - 1
                    })
                }));
                part_of.push(is_outlined(rest, of, triangle).then_some(number));
            }
            part_names.push(name);
        }
        let mut topology = Topology::new(&positions, &triangles)?;
        if let Some(degrees) = crease {
            let cosine = f64::from(degrees).to_radians().cos();
            topology = topology.with_creases(&positions, cosine)?;
        }
        let surface = Surface::new(&topology, &positions)?;
        let (bvh, normals) = (Bvh::new(&surface), surface.normals().to_vec());
        let mut fixed = Vec::new();
        if crease.is_some() {
            fixed.extend(creases(&surface, TURN_COSINE));
        }
        fixed.extend(borders(&surface, TURN_COSINE));
        let at_rest = |place: &Vec3| (*place - head.center) / head.height_m;
        Ok(Self {
            crease,
            bvh,
            topology,
            sources,
            rest: positions.iter().map(at_rest).collect(),
            fixed,
            positions,
            normals,
            forms: forms(rest).collect(),
            part_of,
            parts: part_names,
        })
    }

    /// Whether a head still has these meshes: of numbered files others may have come.
    pub fn is_of(&self, head: &HeadModel) -> bool {
        forms(head).eq(self.forms.iter().copied())
    }

    /// The angle of its creases, degrees.
    pub fn crease(&self) -> Option<f32> {
        self.crease
    }

    /// Takes it to where the head is.
    pub fn pose(&mut self, head: &HeadModel) -> Result<(), MeshError> {
        let mut is_still = true;
        for (place, source) in self.positions.iter_mut().zip(&self.sources) {
            let now = source.position(head);
            is_still &= now == *place;
            *place = now;
        }
        if is_still {
            return Ok(());
        }
        // The tree asks for places alone: it can be fitted while there are no new normals yet.
        let placed = Surface::with_normals(&self.topology, &self.positions, &self.normals)?;
        let (surface, ()) = rayon::join(
            || Surface::new(&self.topology, &self.positions),
            || self.bvh.refit(&placed),
        );
        let surface = surface?;
        for point in self.fixed.iter_mut().flat_map(|line| &mut line.points) {
            point.position = surface.position(point.place.vertex(&surface));
        }
        self.normals = surface.normals().to_vec();
        Ok(())
    }

    /// Whether a list draws some of a line, if the eye sees it.
    pub fn may_draw(&self, set: &LineSet, line: &Line, unit_m: f32) -> bool {
        let names = set.section.meshes();
        // Seen from near its one end and farther from the other, no line is longer than twice what it is.
        let longest_m = || 2.0 * length_m(line);
        set.kinds.have(line.kind)
            && longest_m() >= f64::from(set.section.shortest * unit_m)
            && (line.segments.iter()).any(|segment| self.is_called(segment.triangle, names))
    }

    /// Whether a triangle is of what has one of these names.
    pub fn is_called(&self, triangle: u32, names: Names) -> bool {
        let Some(part) = self.part_of[triangle as usize] else {
            return false;
        };
        let part = &self.parts[usize::from(part)];
        part.iter().any(|own| names.have(own)) || names.have("")
    }

    /// What an eye sees of those of its lines that are `wanted`; a pixel is so long in the image ([`View`]).
    pub fn seen(
        &self,
        view: &View,
        pixel: f64,
        wanted: impl Fn(&Line) -> bool,
    ) -> Result<Seen<'_>, MeshError> {
        let surface = Surface::with_normals(&self.topology, &self.positions, &self.normals)?;
        let facing = facing(&surface, view);
        let mut lines = contours(&surface, view, &facing)?;
        lines.extend_from_slice(&self.fixed);
        let spans = visible_of(&surface, &self.bvh, view, &lines, wanted, pixel)?;
        Ok(Seen {
            surface,
            forms: &self.forms,
            rest: &self.rest,
            facing,
            lines,
            spans,
            view: *view,
            pixel,
        })
    }
}

/// How long a line is.
fn length_m(line: &Line) -> f64 {
    let lengths = (0..line.segments.len()).map(|segment| {
        let [from, to] = line.ends(segment).map(|end| end.position);
        from.distance(to)
    });
    lengths.sum()
}
