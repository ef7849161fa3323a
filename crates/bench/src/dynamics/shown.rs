//! Dense hair as a picture needs it: ten thousand strands that are shown, of which some are simulated and carry the others.

use super::motion::Moving;
use crate::BenchError;
use crate::frame::{YARDSTICKS, preset, registry};
use glam::Vec3;
use hair_sim::{Stats, Strands};
use stage::{Files, HairModel, HeadModel, Motion, Scene};
use std::path::Path;

/// Strands that are shown.
pub const SHOWN: usize = 10_000;
/// Strands of them that are simulated.
const SIMULATED: u32 = 1500;
/// Of a strand.
const POINTS: usize = 16;
/// Steps a second.
pub const RATE: f32 = 120.0;
/// Steps before the first one that is timed: the wind of the walk blows from 0.3 s on.
const BEFORE: u32 = 40;
/// The look whose dynamics and head it has, and the walk that moves it.
const LOOK: &str = "twin-tails.ron";
const WALK: &str = "motions/walk-in-wind.motion.ron";

/// Hair on a bust that walks in wind, simulated and carried.
pub struct Shown {
    scene: Scene,
    motion: Motion,
    steps: u32,
}

impl Shown {
    /// # Errors
    ///
    /// When the yardstick's files can't be read.
    pub fn new(root: &Path) -> Result<Self, BenchError> {
        let registry = registry()?;
        let folder = root.join(YARDSTICKS);
        let mut preset = preset(&folder.join(LOOK), &registry)?;
        preset.sections.scene.fps = RATE;
        preset.sections.dynamics.step = 1.0 / RATE;
        preset.sections.dynamics.guides = SIMULATED;
        let files = Files {
            motion: Some(folder.join(WALK)),
            preset_folder: folder,
            ..Files::default()
        };
        let said = |error: stage::StageError| error.to_string();
        let scene = Scene::load(&preset, &files).map_err(said)?;
        let girl = &scene.objects()[0];
        let head = girl.head();
        let bust = HeadModel::bust();
        let hair = HairModel::new(hair(head.center, head.height_m)?, Some(&bust));
        let girl = girl.with_hair(hair.map_err(said)?).map_err(said)?;
        let mut shown = Self {
            scene: scene.with_object(0, girl).map_err(said)?,
            motion: Motion::new(),
            steps: 0,
        };
        for _ in 0..BEFORE {
            shown.advance()?;
        }
        Ok(shown)
    }

    /// Takes a step. How many the simulation took.
    fn advance(&mut self) -> Result<u64, BenchError> {
        let before = self.motion.steps_taken();
        self.steps += 1;
        let time = (f64::from(self.steps) / f64::from(RATE)) as f32;
        let moved = self.motion.advance_to(&self.scene, time);
        moved.map_err(|error| error.to_string())?;
        Ok(self.motion.steps_taken() - before)
    }

    /// What was asked for must have happened.
    fn check(&self, stats: &Stats, steps: u64) -> Result<(), BenchError> {
        let shown = self.scene.objects()[0].hair().strand_count();
        let is_all = shown == SHOWN
            && stats.strands == SIMULATED as usize
            && stats.set_aside + stats.asleep == 0
            && stats.wind > 0
            && stats.contacts > 0
            && stats.links > 0
            && steps == 1;
        if is_all {
            return Ok(());
        }
        let number = self.steps;
        Err(format!("{shown} strands shown, step {number}: {steps} steps, {stats:?}").into())
    }
}

impl Moving for Shown {
    fn step(&mut self) -> Result<(), BenchError> {
        let steps = self.advance()?;
        self.check(&self.motion.simulated(), steps)
    }
}

/// Strands that leave the upper half of a head on all sides and hang down past it.
fn hair(center: Vec3, height_m: f32) -> Result<Strands, BenchError> {
    let mut strands = Strands::new();
    for id in 0..SHOWN {
        // The golden angle.
        let angle = id as f32 * 2.399_963_2;
        let up = 1.0 - 0.7 * (id as f32 + 0.5) / SHOWN as f32;
        let level = (1.0 - up * up).sqrt();
        let out = Vec3::new(level * angle.cos(), up, level * angle.sin());
        let points: Vec<Vec3> = (0..POINTS)
            .map(|i| {
                let u = i as f32 / (POINTS - 1) as f32;
                let away = 0.46 + 0.25 * u;
                center + height_m * (away * out + Vec3::new(0.0, 0.1 - 0.9 * u * u, 0.0))
            })
            .collect();
        strands
            .push(id as u32, &points, Some(2.0))
            .map_err(|error| error.to_string())?;
    }
    Ok(strands)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_there_or_a_step_fails() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut shown = Shown::new(&root).unwrap();
        for _ in 0..3 {
            shown.step().unwrap();
        }
        let good = shown.motion.simulated();
        for bad in [
            Stats {
                strands: 1499,
                ..good
            },
            Stats { wind: 0, ..good },
            Stats {
                contacts: 0,
                ..good
            },
            Stats { links: 0, ..good },
            Stats { asleep: 1, ..good },
        ] {
            assert!(shown.check(&bad, 1).is_err(), "{bad:?}");
        }
        assert!(shown.check(&good, 2).is_err());
    }
}
