//! The falling strand: clamped level, let go, undamped (Romero et al. 2021); error of its tip in a second.

use super::mass_spring::Truss;
use super::own::Own;
use super::reference;
use super::rods::{Apart, GRAVITY, NEARLY_STRAIGHT, Rods, Simulation};
use super::xpbd::Rod;
use super::{names, npz};
use crate::BenchError;
use glam::{DVec2, DVec3};
use hair_sim::Pose;
use std::path::Path;

/// Frames a second, and of the fall.
const FRAMES: usize = 24;

/// The tip at every frame, in lengths, y up.
pub struct Truth {
    /// From the start on, 25 of them.
    pub path: Vec<DVec2>,
    /// Where it is from.
    pub origin: String,
}

/// The reference by refinement, of `links` and twice as many; where there is a folder of data with the spectral
/// solution of this Gamma, that.
///
/// # Errors
///
/// When the folder's file is broken.
pub fn truth(gamma: f64, links: usize, data: Option<&Path>) -> Result<Truth, BenchError> {
    let frame = (GRAVITY / Rods::level(1, 1, gamma).length).sqrt() / FRAMES as f64;
    let path = reference::drop(gamma, links, frame, FRAMES);
    let refined = format!("chains of {links} and {} links, extrapolated", 2 * links);
    let file = data.map(|folder| folder.join(format!("reference/drop_ref_G{gamma}.npz")));
    let Some(file) = file.filter(|file| file.exists()) else {
        return Ok(Truth {
            path,
            origin: refined,
        });
    };
    let spectral = std::fs::read(&file)
        .map_err(|error| BenchError::from(error.to_string()))
        .and_then(|archive| tips(&npz::read(&archive, "P")?))
        .map_err(|error| format!("{}: {error}", file.display()))?;
    let apart = error(&level_off(&path), &spectral);
    Ok(Truth {
        path: spectral,
        origin: format!("spectral solution of INKSTRAND_DATA; {refined}: {apart:.1e} from it"),
    })
}

fn level_off(path: &[DVec2]) -> Vec<DVec3> {
    path[1..].iter().map(|tip| tip.extend(0.0)).collect()
}

/// Of positions (frame, place along the strand, x and drop) in lengths those of the tip.
fn tips(positions: &npz::Array) -> Result<Vec<DVec2>, BenchError> {
    let [frames, places, 2] = positions.shape[..] else {
        return Err(format!("positions of the shape {:?}", positions.shape).into());
    };
    if frames != FRAMES + 1 || places == 0 {
        return Err(format!("{frames} frames of {places} places").into());
    }
    let tips = positions.values.chunks_exact(2 * places);
    Ok(tips
        .map(|frame| DVec2::new(frame[2 * places - 2], -frame[2 * places - 1]))
        .collect())
}

/// Root mean square of a path's distances from the truth; infinite where the path isn't finite.
pub fn error(path: &[DVec3], truth: &[DVec2]) -> f64 {
    let squares = path.iter().zip(&truth[1..]);
    let sum: f64 = squares
        .map(|(tip, truth)| (*tip - truth.extend(0.0)).length_squared())
        .sum();
    let error = (sum / path.len() as f64).sqrt();
    if error.is_finite() {
        error
    } else {
        f64::INFINITY
    }
}

/// A fall that can be timed.
pub trait Fall {
    /// Falls for a second.
    ///
    /// # Errors
    ///
    /// When the solver refuses a step.
    fn fall(&mut self) -> Result<(), BenchError>;

    /// How far the last fall was from the truth.
    fn error(&self, truth: &[DVec2]) -> f64;
}

struct Falling<S> {
    start: S,
    /// Steps a frame.
    steps: usize,
    length: f64,
    path: Vec<DVec3>,
}

impl<S: Simulation + Clone> Fall for Falling<S> {
    fn fall(&mut self) -> Result<(), BenchError> {
        let mut now = self.start.clone();
        let dt = 1.0 / (FRAMES * self.steps) as f64;
        self.path.clear();
        for _ in 0..FRAMES {
            for _ in 0..self.steps {
                now.step(dt, Pose::IDENTITY)?;
            }
            let tip = now.points(0).last().copied().unwrap_or(DVec3::NAN);
            self.path.push(tip / self.length);
        }
        Ok(())
    }

    fn error(&self, truth: &[DVec2]) -> f64 {
        error(&self.path, truth)
    }
}

/// A row to come.
pub struct Entry {
    /// Of what.
    pub method: String,
    /// Steps a frame; of [`names::XPBD_SWEEPS`] the sweeps a step.
    pub knob: usize,
    /// Ready to fall.
    pub fall: Box<dyn Fall>,
}

fn entry<S: Simulation + Clone + 'static>(
    method: String,
    [knob, steps]: [usize; 2],
    start: S,
    rods: &Rods,
) -> Entry {
    let length = rods.length;
    let path = Vec::with_capacity(FRAMES);
    let falling = Falling {
        start,
        steps,
        length,
        path,
    };
    Entry {
        method,
        knob,
        fall: Box::new(falling),
    }
}

/// Everything that falls, as `count` strands side by side.
///
/// # Errors
///
/// When our solver refuses the strands.
pub fn entries(gamma: f64, count: usize, quick: bool) -> Result<Vec<Entry>, BenchError> {
    let mut entries = Vec::new();
    let elements: &[usize] = if count == 1 { &[10, 20, 40] } else { &[20] };
    for &elements in elements {
        let rods = Rods::level(count, elements, gamma);
        let own = Own::new(&rods)?;
        for steps in [1, 2, 4, 8, 16] {
            let method = format!("{}{elements}", names::OWN);
            entries.push(entry(method, [steps; 2], own.clone(), &rods));
        }
    }
    let twisting = Rods {
        curvature: NEARLY_STRAIGHT,
        ..Rods::level(count, 20, gamma)
    };
    let solved = Own::new(&twisting)?;
    for steps in [1, 2, 4] {
        let method = names::WITH_TWIST.to_owned();
        entries.push(entry(method, [steps; 2], solved.clone(), &twisting));
    }
    let rods = Rods::level(count, 20, gamma);
    let few = quick || count > 1;
    let truss = Truss::new(&rods, 0);
    for &steps in knobs(few, &[1, 4, 16], &[64, 256, 1024]) {
        let trusses = Apart(vec![truss.clone(); count]);
        let method = names::MASS_SPRING.to_owned();
        entries.push(entry(method, [steps; 2], trusses, &rods));
    }
    let xpbd = |sweeps| Apart(vec![Rod::new(&rods, 0, sweeps); count]);
    for &steps in knobs(few, &[64, 256], &[1024, 4096]) {
        let method = names::XPBD_STEPS.to_owned();
        entries.push(entry(method, [steps; 2], xpbd(1), &rods));
    }
    for &sweeps in knobs(few, &[4, 20], &[100, 400]) {
        let method = names::XPBD_SWEEPS.to_owned();
        let steps = 16;
        entries.push(entry(method, [sweeps, steps], xpbd(sweeps), &rods));
    }
    Ok(entries)
}

fn knobs<'a>(few: bool, coarse: &'a [usize], fine: &'a [usize]) -> impl Iterator<Item = &'a usize> {
    coarse.iter().chain(fine.iter().take_while(move |_| !few))
}

/// The slope of the error of our strand of 20 elements in its step, from 1/24 to 1/96 s, against its own motion in
/// steps of 1/1536 s.
///
/// # Errors
///
/// When our solver refuses the strand.
pub fn slope_in_time(gamma: f64) -> Result<f64, BenchError> {
    let rods = Rods::level(1, 20, gamma);
    let own = Own::new(&rods)?;
    let path = |steps| {
        let mut falling = Falling {
            start: own.clone(),
            steps,
            length: rods.length,
            path: Vec::new(),
        };
        falling.fall().map(|()| falling.path)
    };
    let start = DVec2::X;
    let finest = path(64)?.into_iter().map(DVec3::truncate);
    let truth: Vec<DVec2> = std::iter::once(start).chain(finest).collect();
    let [coarse, fine] = [path(1)?, path(4)?].map(|path| error(&path, &truth));
    Ok((coarse / fine).log2() / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_known_paths() {
        let truth: Vec<DVec2> = (0..=24).map(|i| DVec2::new(1.0, f64::from(i))).collect();
        let path = |off: DVec3| -> Vec<DVec3> {
            truth[1..].iter().map(|tip| tip.extend(0.0) + off).collect()
        };
        assert_eq!(error(&path(DVec3::ZERO), &truth), 0.0);
        assert!((error(&path(DVec3::new(2.0, 1.0, 2.0)), &truth) - 3.0).abs() < 1e-12);
        assert_eq!(error(&path(DVec3::NAN), &truth), f64::INFINITY);
    }

    #[test]
    fn tips_are_the_last_places() {
        let array = npz::Array {
            shape: vec![25, 2, 2],
            values: (0..100).map(f64::from).collect(),
        };
        let tips = tips(&array).unwrap();
        assert_eq!((tips.len(), tips[1]), (25, DVec2::new(6.0, -7.0)));
        let short = npz::Array {
            shape: vec![24, 2, 2],
            values: vec![0.0; 96],
        };
        assert!(super::tips(&short).is_err());
    }

    #[test]
    #[expect(clippy::print_stdout, reason = "a test that did nothing says so")]
    fn the_reference_is_that_of_the_spectral_solution() {
        let Some(data) = std::env::var_os("INKSTRAND_DATA") else {
            println!("SKIPPED 1 test: INKSTRAND_DATA is not set");
            return;
        };
        let spectral = truth(10.0, 20, Some(Path::new(&data))).unwrap();
        assert!(spectral.origin.contains("spectral"), "{}", spectral.origin);
        let refined = truth(10.0, 20, None).unwrap();
        assert!(error(&level_off(&refined.path), &spectral.path) < 2e-3);
    }

    #[test]
    fn all_that_falls_comes_near_the_truth() {
        let truth = truth(10.0, 20, None).unwrap().path;
        for mut entry in entries(10.0, 1, true).unwrap() {
            entry.fall.fall().unwrap();
            let error = entry.fall.error(&truth);
            // The finest of each.
            let most = match (entry.method.as_str(), entry.knob) {
                (names::MASS_SPRING, 16) => 0.1,
                (names::XPBD_STEPS, 256) => 0.1,
                (method, 16) if method.starts_with(names::OWN) => 0.02,
                _ => f64::INFINITY,
            };
            assert!(error <= most, "{} {}: {error}", entry.method, entry.knob);
        }
    }
}
