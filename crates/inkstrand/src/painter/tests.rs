//! What is counted, and a graphics card that is lost.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

use super::*;
use crate::builtin_effects;
use render::gpu::{AdapterKind, Gpu, GpuError, Offscreen};
use stage::{Files, Preset};

const PRESET: &str = "(
    version: 1,
    hair: (file: \"../../presets/styles/bob.style.ron\"), head: (shape: bust),
    scene: (size: (24, 18), samples: 1),
    layers: [(effect: \"hair.base\")],
)";

fn stage() -> Stage {
    let registry = builtin_effects();
    let preset = Preset::parse("test.ron", PRESET, &registry).unwrap();
    let files = Files {
        preset_folder: env!("CARGO_MANIFEST_DIR").into(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

/// Nothing where there is no driver.
fn on_card(may_fall_back: bool) -> Option<(Painter, impl FnOnce())> {
    let gpu = match Gpu::open(AdapterKind::Any) {
        Ok(gpu) => gpu,
        Err(GpuError::NoAdapter { .. }) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
            eprintln!("SKIPPED: no driver for a graphics card");
            return None;
        }
        Err(error) => panic!("{error}"),
    };
    let device = gpu.device.clone();
    let painter = Painter {
        samples: 1,
        card: Some(Card::on(Offscreen::on(gpu).unwrap())),
        may_fall_back,
        cpu: None,
        is_quiet: true,
        counts_layers: false,
        last: None,
        shown: Vec::new(),
    };
    Some((painter, move || device.destroy()))
}

#[test]
fn auto_goes_on_with_the_cpu_in_the_middle_of_a_sequence() {
    let Some((mut painter, lose)) = on_card(true) else {
        return;
    };
    let mut stage = stage();
    let (first, stats) = painter.paint(&mut stage, 0, 0.0).ok().unwrap();
    assert_eq!(stats.backend, "gpu");
    lose();
    for frame in 1..3 {
        painter.last = None; // as where something has moved
        let (next, stats) = painter.paint(&mut stage, frame, 0.0).ok().unwrap();
        assert_eq!((stats.backend, stats.frame), ("cpu", frame));
        let is_far = |(a, b): (&[f32; 4], &[f32; 4])| (0..4).any(|i| (a[i] - b[i]).abs() > 0.01);
        let far = first
            .pixels
            .iter()
            .zip(&next.pixels)
            .filter(|pair| is_far(*pair));
        assert!(far.count() <= 1);
    }
}

#[test]
fn gpu_alone_fails_and_says_what_to_do() {
    let Some((mut painter, lose)) = on_card(false) else {
        return;
    };
    lose();
    let Err(Failure::Failed(message)) = painter.paint(&mut stage(), 0, 0.0) else {
        panic!("a lost card draws nothing");
    };
    assert!(
        message.contains("was lost") && message.contains("--backend cpu"),
        "{message}"
    );
}

#[test]
fn layers_are_counted_for_who_asks() {
    let mut stage = stage();
    for counts in [false, true] {
        let mut painter = Painter::new(Backend::Cpu, 1, true).ok().unwrap();
        if counts {
            painter.count_layers();
        }
        let (_, stats) = painter.paint(&mut stage, 0, 0.0).ok().unwrap();
        assert_eq!(stats.layers.contains_key("hair.base"), counts);
        let pass = painter.paint_pass(&mut stage, 0, 0.0, Pass::Strand, 6.0);
        let (_, stats) = pass.ok().unwrap();
        assert_eq!(stats.layers.contains_key("hair.base"), counts);
    }
}
