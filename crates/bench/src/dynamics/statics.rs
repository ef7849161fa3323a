//! The strand at rest: clamped level, it hangs as Euler's elastica.

use super::mass_spring::Truss;
use super::names::{CANTILEVER, GAMMAS, MASS_SPRING, OWN, XPBD_SWEEPS};
use super::own::Own;
use super::reference;
use super::rods::{Apart, Rods, Simulation};
use super::xpbd::Rod;
use crate::BenchError;
use crate::results::Row;
use hair_sim::Pose;
use std::time::Instant;

/// In s: long enough for all to come to rest by the drag of 20 a second.
const SECONDS: f64 = 10.0;

/// A row each Gamma, method and number of elements (the knob): seconds are those of a simulated second; the error is the tip's
/// distance from the elastica's in lengths.
///
/// # Errors
///
/// When our solver refuses a strand or a step.
pub fn rows(mut done: impl FnMut()) -> Result<Vec<Row>, BenchError> {
    let mut rows = Vec::new();
    for gamma in GAMMAS {
        let truth = reference::cantilever(gamma);
        for elements in [10, 20, 40] {
            let rods = Rods {
                drag: 20.0,
                ..Rods::level(1, elements, gamma)
            };
            // In steps that the method needs: its own at 1/24 s, springs at 1/384, XPBD at 1/1536 with 20 sweeps.
            let simulations: [(&str, usize, Box<dyn Simulation>); 3] = [
                (OWN, 24, Box::new(Own::new(&rods)?)),
                (
                    MASS_SPRING,
                    384,
                    Box::new(Apart(vec![Truss::new(&rods, 0)])),
                ),
                (
                    XPBD_SWEEPS,
                    1536,
                    Box::new(Apart(vec![Rod::new(&rods, 0, 20)])),
                ),
            ];
            for (method, rate, mut simulation) in simulations {
                let start = Instant::now();
                for _ in 0..(SECONDS * rate as f64) as usize {
                    simulation.step(1.0 / rate as f64, Pose::IDENTITY)?;
                }
                let seconds = start.elapsed().as_secs_f64() / SECONDS;
                let points = simulation.points(0);
                let tip = points[elements] / rods.length;
                let error = (tip - truth.extend(0.0)).length();
                rows.push(Row {
                    scene: format!("{CANTILEVER}{gamma}"),
                    method: method.trim_end_matches('-').to_owned(),
                    knob: elements,
                    seconds,
                    error: Some(if error.is_finite() {
                        error
                    } else {
                        f64::INFINITY
                    }),
                });
            }
            done();
        }
    }
    Ok(rows)
}
