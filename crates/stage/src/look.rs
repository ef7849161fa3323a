//! The look: how hair and head are drawn and move, whatever hair and head they are.

use crate::files::{Files, StageError};
use crate::head::HeadPaint;
use crate::names::Names;
use crate::preset::{
    BrushChoice, EdgesChoice, FixedTo, LightKind, LineKinds, LineSection, MeshSection, OrderChoice,
    PassSection, PathChoice, Preset, Sections, ShadowColors,
};
use crate::textures::with_textures;
use effects::preset::LayerSpec;
use effects::section::Section;
use effects::{Input, Layer, Parameters, Reach, SampleInput, Values, Varied, clump, layer_seed};
use glam::Vec3;
use render::{Brush, EdgeChannel, Edges, Head, Light, Order};
use stroke_path::{Camera, PathKind, direction_from_angles};

/// How much nearer than the inside of the head hair must be to be seen through an opening, in head
/// heights: more than the clumps around the skull reach into it.
const INSIDE_MARGIN: f32 = 0.6;

/// How much farther than the head's outline hair may be, in head heights, to cover it: hair that lies
/// on the skin.
const OUTLINE_MARGIN: f32 = 0.04;

/// Lines of meshes, and the layers that draw them.
#[derive(Clone)]
pub(crate) struct LineSet {
    pub section: LineSection,
    pub kinds: LineKinds,
    pub layers: Vec<Layer>,
}

impl LineSet {
    /// The angle of their creases, degrees; nothing where they have none.
    pub fn crease(&self) -> Option<f32> {
        self.kinds.crease.then_some(self.section.crease)
    }

    /// Whether contours among them are followed from frame to frame, as something along them is to stay where it is: marks of brushes, or what a hand does.
    pub fn is_followed(&self) -> bool {
        let mut layers = self.layers.iter();
        let has_contours = self.kinds.contour;
        self.has_marks() || has_contours && layers.any(|layer| layer.program.follows_lines())
    }

    /// Whether brushes leave marks along them that are to stay on the surface.
    pub fn has_marks(&self) -> bool {
        // Others lie by the line's length: all of a list have the same places.
        let mut brushes = self.layers.iter().filter_map(|layer| layer.brush.as_ref());
        self.layers.iter().any(|layer| layer.brush.is_some())
            && brushes.all(|brush| brush.length().is_some() && brush.parts().is_none())
    }
}

/// A layer that draws shadows in a colour of the look's, and its number among the layers of strokes.
#[derive(Clone)]
struct Shadow {
    layer: usize,
    /// The same in shades of the hair's own colour.
    in_shades: Layer,
}

/// What a preset says of strokes, colours, light, picture and dynamics, ready to be used.
#[derive(Clone)]
pub struct Look {
    pub(crate) seed: u32,
    pub(crate) sections: Sections,
    pub(crate) clump: Varied<clump::Program>,
    pub(crate) layers: Vec<Layer>,
    /// Of these shadows, as they are on hair that has colours of its file's.
    shadows: Vec<Shadow>,
    /// Those that paint meshes.
    pub(crate) mesh_layers: Vec<Layer>,
    /// The lines that are drawn.
    pub(crate) lines: Vec<LineSet>,
    /// What lines are drawn around: nothing.
    pub(crate) line_clump: Varied<clump::Program>,
    passes: Vec<PassSection>,
    /// How the preset's meshes are painted, in their order.
    meshes: Vec<MeshSection>,
    /// Unit vector to the light, where the camera stands at yaw 0.
    light_direction: Vec3,
}

impl Look {
    /// The look of a preset, read or made by a program. Of the files that it names it reads those of textures, in `files`' folder.
    ///
    /// # Errors
    ///
    /// When a value is outside of its range, the solver can't do what the section `dynamics` asks for, a layer needs another
    /// light, or a texture can't be read.
    pub fn new(preset: &Preset, files: &Files) -> Result<Self, StageError> {
        let sections = preset.sections.clone();
        sections
            .check()
            .map_err(|(section, error)| StageError::Section { section, error })?;
        for pass in &preset.passes {
            let section = "passes";
            pass.check()
                .map_err(|error| StageError::Section { section, error })?;
        }
        if let Some((section, _, message)) = preset.unsupported() {
            return Err(StageError::Unsupported { section, message });
        }
        let light = &sections.light;
        let light_direction = direction_from_angles(light.yaw, light.pitch)?;
        let layers = preset.layers.iter();
        let layers = layers.map(|layer| with_textures(layer, &layer.values, files));
        let layers = layers.collect::<Result<Vec<_>, StageError>>()?;
        let (mut strokes, mut mesh_layers, mut line_layers) = (Vec::new(), Vec::new(), Vec::new());
        let mut shadows = Vec::new();
        for (layer, spec) in layers.into_iter().zip(&preset.layers) {
            if spec.effect.is_for_meshes() {
                mesh_layers.push(layer);
            } else if layer.program.reach() == Reach::NOWHERE {
                // Neither its paths nor its lines are looked for.
            } else if spec.effect.is_for_lines() {
                line_layers.push(layer);
            } else {
                if sections.hair.shadows == ShadowColors::Own
                    && let Some(values) = in_shades(spec, &layer)
                {
                    shadows.push(Shadow {
                        layer: strokes.len(),
                        in_shades: with_textures(spec, &values, files)?,
                    });
                }
                strokes.push(layer);
            }
        }
        let look = Self {
            seed: preset.seed,
            clump: Varied::new(&sections.clump.0),
            sections,
            layers: strokes,
            shadows,
            mesh_layers,
            lines: line_sets(preset, &line_layers)?,
            line_clump: Varied::new(&Values::defaults(clump::Program::PARAMS)),
            passes: preset.passes.clone(),
            meshes: preset
                .meshes
                .iter()
                .map(|mesh| mesh.section.clone())
                .collect(),
            light_direction,
        };
        look.lights(&look)?;
        Ok(look)
    }

    /// The same for hair that has colours of its file's: shadows on it are shades of these. Nothing where that makes no difference.
    pub(crate) fn in_shades_of_hair(&self) -> Option<Self> {
        if self.shadows.is_empty() {
            return None;
        }
        let mut look = self.clone();
        for shadow in std::mem::take(&mut look.shadows) {
            look.layers[shadow.layer] = shadow.in_shades;
        }
        Some(look)
    }

    /// A sentence for the user that [`Self::in_shades_of_hair`] makes a difference.
    pub(crate) fn shades_note(&self) -> Option<String> {
        let names = (self.shadows.iter()).map(|shadow| &self.layers[shadow.layer].name[..]);
        let names: Vec<&str> = names.collect();
        (!names.is_empty()).then(|| {
            format!(
                "hair: shadows on the character's own hair are darker shades of it; with `hair: (shadows: look)` they have the look's colour ({})",
                names.join(", ")
            )
        })
    }

    /// Whether the light of this look is one that the layers of another can be drawn in.
    pub(crate) fn lights(&self, other: &Self) -> Result<(), StageError> {
        if self.sections.light.kind == LightKind::Point {
            return Ok(());
        }
        let needs_place = |layer: &&Layer| layer.program.needs_point_light();
        match other.layers.iter().find(needs_place) {
            Some(layer) => Err(StageError::NoPointLight(layer.name.clone())),
            None => Ok(()),
        }
    }

    /// Whether anything reads material normals.
    pub(crate) fn reads_material(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::MaterialNormal);
        self.clump.base().normal == clump::Params::NORMAL_MATERIAL || self.layers.iter().any(reads)
    }

    /// Whether anything reads where hair is at rest.
    pub(crate) fn reads_rest(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::RestPosition);
        self.layers.iter().any(reads)
    }

    /// Whether anything reads how hair runs at rest.
    pub(crate) fn reads_rest_forward(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::RestForward);
        self.layers.iter().any(reads) || self.lines_read(Input::RestForward)
    }

    /// Whether anything that is drawn along lines of meshes reads that.
    pub(crate) fn lines_read(&self, input: Input) -> bool {
        let mut layers = self.lines.iter().flat_map(|set| &set.layers);
        layers.any(|layer| layer.program.inputs().has(input))
    }

    /// Whether anything reads how far it is to the ends of strands.
    pub(crate) fn reads_ends(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::FromEnds);
        self.layers.iter().any(reads) || self.lines_read(Input::FromEnds)
    }

    /// Whether anything reads how much of the paths that effects made is there.
    pub(crate) fn reads_weights(&self) -> bool {
        let reads = |layer: &Layer| layer.program.inputs().has(Input::PathWeight);
        self.layers.iter().any(reads) || self.lines_read(Input::PathWeight)
    }

    /// Whether pictures change with time alone.
    pub(crate) fn reads_time(&self) -> bool {
        let reads = |layer: &Layer| {
            let painted = layer.program.paints().unwrap_or_default();
            layer.program.inputs().has(Input::Time) || painted.has(SampleInput::Time)
        };
        let of_lines = self.lines.iter().flat_map(|set| &set.layers);
        let mut all = self.layers.iter().chain(&self.mesh_layers).chain(of_lines);
        all.any(reads)
    }

    /// Whether a layer paints its samples.
    pub(crate) fn paints(&self) -> bool {
        let paints = |layer: &Layer| layer.program.paints().is_some();
        self.layers.iter().any(paints)
    }

    pub(crate) fn path(&self) -> PathKind {
        let subdivision = self.sections.path.subdivision;
        match self.sections.path.kind {
            PathChoice::Linear => PathKind::Linear { subdivision },
            PathChoice::CatmullRom => PathKind::CatmullRom { subdivision },
        }
    }

    pub(crate) fn brush(&self) -> Brush {
        match self.sections.path.brush {
            BrushChoice::Circle => Brush::Circle,
            BrushChoice::Semicircle => Brush::Semicircle,
        }
    }

    /// What is done with the samples of a picture so many pixels high.
    pub(crate) fn passes(&self, head: Head, height_px: u32) -> Vec<Edges> {
        let edges = |pass: &PassSection| {
            let channel = match pass.edges {
                EdgesChoice::None => return None,
                _ if pass.width.curve.iter().all(|(_, width)| *width == 0.0) => return None,
                EdgesChoice::Level => EdgeChannel::Level,
                EdgesChoice::Strand => EdgeChannel::Strand,
                EdgesChoice::Object => EdgeChannel::Object,
                EdgesChoice::Normal => EdgeChannel::Normal,
                EdgesChoice::Depth => EdgeChannel::Depth,
                EdgesChoice::Color => EdgeChannel::Color,
            };
            let mut width_px = pass.width.clone();
            for (_, width) in &mut width_px.curve {
                *width *= height_px as f32 / 720.0;
            }
            Some(Edges {
                channel,
                threshold: pass.threshold,
                step_m: pass.depth * head.height_m,
                width_px,
                seed: layer_seed(self.seed, "passes"),
                fade_to: pass.fade,
                color: pass.color,
            })
        };
        self.passes.iter().filter_map(edges).collect()
    }

    pub(crate) fn order(&self) -> Order {
        match self.sections.scene.order {
            OrderChoice::Rounded | OrderChoice::Scattered => Order::Rounded,
            OrderChoice::StrandFirst => Order::StrandFirst,
            OrderChoice::Shifted => Order::Shifted,
        }
    }

    /// The light on a head that this camera sees.
    pub(crate) fn light(&self, camera: &Camera, head: Head) -> Light {
        let section = &self.sections.light;
        let direction = match section.fixed_to {
            FixedTo::Camera => {
                // The angles are meant from where the eye stands, and depth grows away from the eye.
                let d = self.light_direction;
                camera.world_from_view_direction(Vec3::new(d.x, d.y, -d.z))
            }
            FixedTo::World => self.light_direction,
        };
        match section.kind {
            LightKind::Point => {
                Light::Point(head.center + direction * section.distance * head.height_m)
            }
            LightKind::Direction => Light::Direction(direction),
        }
    }

    /// How the preset's meshes are painted, in their order.
    pub(crate) fn meshes(&self) -> &[MeshSection] {
        &self.meshes
    }

    /// How a head is painted.
    pub(crate) fn paint(&self, head: Head) -> HeadPaint {
        let section = &self.sections.head;
        HeadPaint {
            light: section.light,
            shadow: section.shadow,
            line: section.line,
            iris: section.iris,
            iris_shadow: section.iris_shadow,
            iris_light: section.iris_light,
            blush: section.blush_color,
            mouth: section.mouth,
            dress: section.dress_light,
            dress_shadow: section.dress_shadow,
            dress_line: section.dress_line,
            accent: section.accent,
            accent_shadow: section.accent_shadow,
            tie: section.tie,
            tie_shadow: section.tie_shadow,
            scalp: clump::Program::params(&self.sections.clump.0)
                .color
                .to_array(),
            unit_m: head.unit_m(),
            width_m: section.width * head.unit_m(),
            inside_margin_m: INSIDE_MARGIN * head.height_m,
            outline_margin_m: OUTLINE_MARGIN * head.height_m,
            threshold: section.threshold,
        }
    }
}

/// A layer's values where its shadows are shades of the hair's own colour; nothing where that changes none.
fn in_shades(spec: &LayerSpec, layer: &Layer) -> Option<Values> {
    let mut values = spec.values.clone();
    for name in layer.program.shadow_colors() {
        values.take_color(name);
    }
    (values != spec.values).then_some(values)
}

/// The lines that layers draw, each with its layers.
fn line_sets(preset: &Preset, layers: &[Layer]) -> Result<Vec<LineSet>, StageError> {
    let mut sets = Vec::new();
    for lines in &preset.lines {
        let section = &lines.section;
        let own = section.name.as_deref().unwrap_or_default();
        let draws = |layer: &&Layer| Names(layer.on.as_deref().unwrap_or_default()).have(own);
        let layers: Vec<Layer> = layers.iter().filter(draws).cloned().collect();
        if layers.is_empty() {
            continue;
        }
        section.check().map_err(|error| StageError::Section {
            section: "lines",
            error,
        })?;
        let kinds = section.kinds().map_err(StageError::Lines)?;
        sets.push(LineSet {
            section: section.clone(),
            kinds,
            layers,
        });
    }
    Ok(sets)
}
