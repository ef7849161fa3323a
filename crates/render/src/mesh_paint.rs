//! Surfaces whose samples layers paint: what is known of them, and the programs that paint.

use crate::drawing::Surface;
use crate::frame::{Frame, Head, Light};
use effects::{Layer, LayerProgram, SampleSet, layer_seed};
use glam::Vec3;
use std::fmt;
use std::sync::Arc;
use stroke_path::Camera;

/// What paints a surface's samples, in place of its two colours: [`Surface::light`] and [`Surface::shadow`] are what the program is told
/// as its own colours.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePaint {
    /// Which of [`Frame::mesh_layers`](crate::Frame::mesh_layers), or of [`MeshPainting::layers`].
    pub layer: u32,
    /// For each vertex its unit normal, in the world.
    pub normals: Vec<Vec3>,
    /// For each vertex how much it lies in shadow whatever the light, 0 to 1; empty is not at all.
    pub occlusion: Vec<f32>,
}

/// A layer that paints surfaces.
#[derive(Clone, Copy)]
pub struct MeshLayer<'a> {
    /// The layer, of an effect for meshes.
    pub layer: &'a Layer,
    /// The head of its object, and the measure of sizes.
    pub head: Head,
    /// The seed of its object's style.
    pub seed: u32,
}

/// The layers that paint surfaces of a drawing. By default there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPainting {
    /// The layers, by their numbers.
    pub layers: Vec<PaintedMeshes>,
    /// What sees them, and what light they lie in; there where there are layers.
    pub seen: Option<Seen>,
}

/// What painted surfaces are seen in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The eye.
    pub camera: Camera,
    /// The light.
    pub light: Light,
    /// Time of the scene in seconds.
    pub time_s: f32,
}

/// A layer that paints surfaces of a drawing.
#[derive(Clone)]
pub struct PaintedMeshes {
    /// What paints them.
    pub program: Arc<dyn LayerProgram>,
    /// The layer's seed.
    pub seed: u32,
    /// How much is seen through hair before it, 0 to 1.
    pub through_hair: f32,
    /// Height of its object's head, metres, above 0.
    pub head_height_m: f32,
    /// Depth of the head's centre, head heights.
    pub head_depth: f32,
    /// Of what its program declares of samples that which it makes use of.
    pub(crate) read: SampleSet,
}

impl PartialEq for PaintedMeshes {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |it: &Self| (it.seed, it.through_hair, it.head_height_m, it.head_depth);
        Arc::ptr_eq(&self.program, &other.program) && numbers(self) == numbers(other)
    }
}

impl fmt::Debug for PaintedMeshes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut structure = f.debug_struct("PaintedMeshes");
        let structure = structure.field("through_hair", &self.through_hair);
        structure.field("seed", &self.seed).finish_non_exhaustive()
    }
}

impl PaintedMeshes {
    /// A layer that this program paints, of an object with that head.
    #[must_use]
    pub fn new(layer: &MeshLayer, camera: &Camera) -> Self {
        let MeshLayer { layer, head, seed } = *layer;
        Self {
            read: layer.program.reads(),
            program: layer.program.clone(),
            seed: layer_seed(seed, &layer.name),
            through_hair: layer.through_hair,
            head_height_m: head.height_m,
            head_depth: camera.view_from_world(head.center).z / head.height_m,
        }
    }
}

impl MeshPainting {
    /// Whether nothing is painted.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// Whether something is seen through hair.
    #[must_use]
    pub fn sees_through(&self) -> bool {
        self.layers.iter().any(|layer| layer.through_hair > 0.0)
    }

    /// Takes on what a checked frame says, in place of what was there.
    pub(crate) fn fill(&mut self, frame: &Frame) {
        let layers = frame.mesh_layers.iter();
        self.layers.clear();
        self.layers
            .extend(layers.map(|layer| PaintedMeshes::new(layer, frame.camera)));
        self.seen = (!self.layers.is_empty()).then_some(Seen {
            camera: *frame.camera,
            light: frame.light,
            time_s: frame.time_s,
        });
    }
}

impl Surface {
    /// The colours that it is drawn in, of light and shadow: what is painted is drawn white, so that its picture is there alone.
    #[inline]
    pub(crate) fn drawn_colors(&self) -> [[f32; 3]; 2] {
        match self.paint {
            None => [self.light, self.shadow],
            Some(_) => [[1.0; 3]; 2],
        }
    }
}
