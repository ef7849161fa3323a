//! Hot pieces of a frame beside the rasteriser: `cargo bench -p bench`.
#![allow(missing_docs, reason = "criterion's macros make the functions")]

use bench::strokes::contenders::{Contender as _, Library, Outlines, PathsAlone};
use bench::strokes::scenes;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use effects::Registry;
use glam::DVec2;
use render::cpu::Evaluator;
use render::{Disc, Drawing};
use stage::{Files, Preset, Stage};
use std::hint::black_box;
use std::path::Path;

/// From the hair to joints on the screen, and from these to strokes, for each joint.
fn frame(criterion: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/yardsticks");
    let path = folder.join("twin-tails.ron");
    let text = std::fs::read_to_string(&path).expect("the preset is there");
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).expect("no effect comes twice");
    let preset = Preset::parse("twin-tails.ron", &text, &registry).expect("it has no mistakes");
    let files = Files {
        preset_folder: folder,
        ..Files::default()
    };
    let mut stage = Stage::new(&preset, &files).expect("its files are there");
    let joints = stage.frame().expect("it can be drawn").paths.len() as u64;

    let mut group = criterion.benchmark_group("frame");
    group.throughput(Throughput::Elements(joints));
    group.bench_function("paths and surfaces", |bencher| {
        bencher.iter(|| black_box(stage.frame().map(|frame| frame.paths.len())));
    });
    let frame = stage.frame().expect("it can be drawn");
    let (mut evaluator, mut drawing) = (Evaluator::default(), Drawing::default());
    group.bench_function("effects", |bencher| {
        bencher.iter(|| evaluator.evaluate(black_box(&frame), &mut drawing));
    });
    group.finish();
}

/// The outlines of all segments, for each segment.
fn outlines(criterion: &mut Criterion) {
    let scene = scenes::ponytails();
    let mut group = criterion.benchmark_group("outlines");
    group.throughput(Throughput::Elements(scene.segments()[1] as u64));
    for (name, library) in [
        ("vello_cpu", Library::Vello),
        ("tiny-skia", Library::TinySkia),
    ] {
        let mut paths = PathsAlone::new(library, Outlines::Segments);
        group.bench_function(name, |bencher| {
            bencher.iter(|| paths.draw(black_box(&scene.drawing)));
        });
    }
    group.finish();
}

/// The reference picture in the densest part of a scene, for each sample.
fn reference(criterion: &mut Criterion) {
    const SIDE: u32 = 32;
    let mut drawing = scenes::ponytails().drawing;
    let corner = glam::Vec2::new(220.0, 180.0);
    let shift = |discs: &mut Vec<Disc>| discs.iter_mut().for_each(|disc| disc.center -= corner);
    shift(&mut drawing.clump);
    drawing
        .layers
        .iter_mut()
        .for_each(|layer| shift(&mut layer.discs));
    drawing.size = [SIDE, SIDE];
    let samples: Vec<DVec2> = render::sample_positions(4)
        .expect("a standard number")
        .iter()
        .map(|position| position.as_dvec2())
        .collect();
    let mut group = criterion.benchmark_group("reference");
    group.throughput(Throughput::Elements(
        u64::from(SIDE * SIDE) * samples.len() as u64,
    ));
    group.sample_size(20);
    group.bench_function("sample", |bencher| {
        bencher.iter(|| reference::picture_at(black_box(&drawing), &samples));
    });
    group.finish();
}

criterion_group!(kernels, frame, outlines, reference);
criterion_main!(kernels);
