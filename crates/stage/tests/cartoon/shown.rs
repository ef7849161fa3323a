//! Presets as pictures of one sample a pixel, with what each sample tells.

use effects::Registry;
use glam::{Vec2, Vec3};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Feature, Features, Frame, Picture, Sample, SamplePlanes};
use stage::{Files, Preset, Stage};
use std::path::{Path, PathBuf};
use stroke_path::Camera;

/// What a picture of one sample a pixel shows.
pub struct Shown {
    pub samples: Vec<Sample>,
    pub picture: Picture,
    /// Places of the samples in the world, metres.
    pub places: Vec<Vec3>,
    pub head: render::Head,
    pub camera: Camera,
    /// What was drawn.
    pub drawing: Drawing,
}

/// The project's presets.
pub fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

/// A preset of the project.
pub fn preset(name: &str) -> String {
    std::fs::read_to_string(presets().join(name)).unwrap()
}

/// A preset with these settings.
pub fn stage(text: &str, settings: &[(&str, &str)]) -> Stage {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let mut preset = match Preset::parse("look.ron", text, &registry) {
        Ok(preset) => preset,
        Err(errors) => panic!("{errors}"),
    };
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: presets(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

/// Draws a preset with these settings.
pub fn shown(text: &str, settings: &[(&str, &str)]) -> Shown {
    draw(&mut stage(text, settings))
}

/// Draws what a stage shows.
pub fn draw(stage: &mut Stage) -> Shown {
    draw_changed(stage, |_| {})
}

/// Draws what a stage shows, of a frame with other numbers.
pub fn draw_changed(stage: &mut Stage, change: impl FnOnce(&mut Frame)) -> Shown {
    let mut frame = stage.frame().unwrap();
    frame.features = Features::of(Feature::ALL);
    change(&mut frame);
    let (camera, head) = (*frame.camera, frame.objects[0].head);
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    let mut rasterizer = Rasterizer::new(1, Some(2)).unwrap();
    let picture = rasterizer.draw(&drawing).unwrap();
    let [width, height] = drawing.size.map(|side| side as usize);
    let mut samples = Vec::new();
    let mut planes = SamplePlanes::default();
    rasterizer
        .draw_samples(&drawing, &mut planes, |planes| {
            let all = (0..width * height).map(|i| planes.sample(0, i % width, i / width));
            samples.extend(all);
        })
        .unwrap();
    let middle = Vec2::new(width as f32, height as f32) / 2.0;
    let place = |(i, sample): (usize, &Sample)| {
        let pixel = pixel(width, i);
        let depth = 1.0 / sample.inv_depth.max(1e-6);
        let aside = (pixel - middle) * depth / camera.focal_px();
        let view = Vec3::new(aside.x, -aside.y, depth);
        assert!(camera.project(view).distance(pixel) < 0.01);
        camera.world_from_view(view)
    };
    Shown {
        places: samples.iter().enumerate().map(place).collect(),
        samples,
        picture,
        head,
        camera,
        drawing,
    }
}

/// The middle of a pixel, by its number.
pub fn pixel(width: usize, i: usize) -> Vec2 {
    Vec2::new((i % width) as f32, (i / width) as f32) + 0.5
}

impl Shown {
    /// Pixels that show hair.
    pub fn hair(&self) -> impl Iterator<Item = usize> {
        (0..self.samples.len()).filter(|&i| self.samples[i].object % 2 == 1)
    }

    /// How bright a sample is, of a picture in grays.
    pub fn gray(&self, i: usize) -> f64 {
        f64::from(self.samples[i].color[0])
    }
}

/// Hair of a style that `hair.toon` paints with these parameters.
pub fn toon(style: &str, params: &str) -> String {
    format!(
        "(version: 1, hair: (file: \"styles/{style}.style.ron\"), head: (shape: bust), \
         scene: (size: (240, 270)), camera: (yaw: 25, pitch: 8, distance: 4.2, target: (0, -0.3, 0)), \
         path: (kind: catmull_rom, subdivision: 5), clump: (size_variation: 0), \
         layers: [(effect: \"hair.toon\", params: ({params}))])"
    )
}
