//! Reference solutions: the falling strand by refinement, the strand at rest by shooting.
//!
//! Both are planar, in angles below the horizontal, in units of the strand's length and sqrt(L / g), and share no
//! code with the solvers: the chain is explicit (Runge and Kutta's fourth order) with its tensions from one
//! tridiagonal system, where the solvers are implicit, in space.

use glam::DVec2;

/// The tip of a clamped level strand that is let go, at times 0, 1, .. `frames` times `frame`: x to the right and
/// y up, in lengths. Extrapolated (Richardson) from chains of `links` and 2 `links`, whose error is of second order.
#[must_use]
pub fn drop(gamma: f64, links: usize, frame: f64, frames: usize) -> Vec<DVec2> {
    let coarse = Chain::fall(gamma, links, frame, frames);
    let fine = Chain::fall(gamma, 2 * links, frame, frames);
    let pairs = coarse.iter().zip(&fine);
    pairs.map(|(c, f)| (4.0 * *f - *c) / 3.0).collect()
}

/// Links of a chain: angles below the horizontal, and how fast they turn.
#[derive(Clone)]
struct Chain {
    gamma: f64,
    angles: Vec<f64>,
    spins: Vec<f64>,
}

impl Chain {
    /// The tip of a falling chain of `links` at every frame.
    fn fall(gamma: f64, links: usize, frame: f64, frames: usize) -> Vec<DVec2> {
        let mut chain = Self {
            gamma,
            angles: vec![0.0; links],
            spins: vec![0.0; links],
        };
        // The fastest vibration of a chain: 4 n^2 / sqrt(Gamma), that of its joints alone.
        let fastest = 4.0 * (links * links) as f64 / gamma.sqrt();
        // Of Runge and Kutta's limit 2.8 not too much; its error is far below that in space.
        let steps = (frame * fastest / 2.0).ceil().max(1.0);
        let mut rates = Rates::new(links);
        let mut path = vec![chain.tip()];
        for _ in 0..frames {
            for _ in 0..steps as usize {
                chain.step(frame / steps, &mut rates);
            }
            path.push(chain.tip());
        }
        path
    }

    fn tip(&self) -> DVec2 {
        let sum = |f: fn(f64) -> f64| self.angles.iter().map(|a| f(*a)).sum::<f64>();
        DVec2::new(sum(f64::cos), -sum(f64::sin)) / self.angles.len() as f64
    }

    fn step(&mut self, dt: f64, rates: &mut Rates) {
        let start = self.clone();
        let mut sum = vec![(0.0, 0.0); self.angles.len()];
        for (weight, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            rates.accelerations(self);
            for i in 0..sum.len() {
                let (spin, acceleration) = (self.spins[i], rates.accelerations[i]);
                sum[i].0 += weight * spin;
                sum[i].1 += weight * acceleration;
                self.angles[i] = start.angles[i] + ahead * dt * spin;
                self.spins[i] = start.spins[i] + ahead * dt * acceleration;
            }
        }
        for i in 0..sum.len() {
            self.angles[i] = start.angles[i] + dt / 6.0 * sum[i].0;
            self.spins[i] = start.spins[i] + dt / 6.0 * sum[i].1;
        }
    }
}

/// Room for the angular accelerations.
struct Rates {
    accelerations: Vec<f64>,
    along: Vec<DVec2>,
    /// Forces on the particles 1 to n, then without the tensions their accelerations.
    forces: Vec<DVec2>,
    /// Tensions' system: diagonal, upper neighbour, right side.
    system: Vec<[f64; 3]>,
}

impl Rates {
    fn new(links: usize) -> Self {
        Self {
            accelerations: vec![0.0; links],
            along: vec![DVec2::ZERO; links],
            forces: vec![DVec2::ZERO; links],
            system: vec![[0.0; 3]; links],
        }
    }

    /// Mass lumped at the joints, half of a link's at the tip; the root's joint is half a link long; a joint's moment
    /// is that of the energy k/2 (2 tan(phi / 2))^2.
    fn accelerations(&mut self, chain: &Chain) {
        let n = chain.angles.len();
        let length = 1.0 / n as f64;
        let mass = |i: usize| if i + 1 == n { 0.5 * length } else { length };
        for (along, angle) in self.along.iter_mut().zip(&chain.angles) {
            let (sin, cos) = angle.sin_cos();
            *along = DVec2::new(cos, sin);
        }
        for i in 0..n {
            self.forces[i] = DVec2::new(0.0, mass(i));
        }
        // A joint's moment turns the link after it back and the one before it on: couples of forces at their ends.
        for i in 0..n {
            let stiffness = if i == 0 { 2.0 } else { 1.0 } / (chain.gamma * length);
            let before = if i == 0 { 0.0 } else { chain.angles[i - 1] };
            let tan = (0.5 * (chain.angles[i] - before)).tan();
            let moment = 2.0 * stiffness * tan * (1.0 + tan * tan);
            self.couple(i, -moment / length);
            if i > 0 {
                self.couple(i - 1, moment / length);
            }
        }
        for i in 0..n {
            self.forces[i] /= mass(i);
        }
        self.tensions(chain, length);
        for i in 0..n {
            let before = if i == 0 {
                DVec2::ZERO
            } else {
                self.forces[i - 1]
            };
            self.accelerations[i] = self.along[i].perp().dot(self.forces[i] - before) / length;
        }
    }

    /// The force `f` across link `i` at its tip end, and -`f` at its root end.
    fn couple(&mut self, i: usize, f: f64) {
        let across = self.along[i].perp() * f;
        self.forces[i] += across;
        if i > 0 {
            self.forces[i - 1] -= across;
        }
    }

    /// Adds what the tensions of the links do to the particles, so that no link changes its length:
    /// along . (a_tip - a_root) = -length spin^2.
    fn tensions(&mut self, chain: &Chain, length: f64) {
        let n = chain.angles.len();
        let light = |i: usize| {
            if i + 1 == n {
                2.0 / length
            } else {
                1.0 / length
            }
        };
        // Row i: lower T[i-1] + diagonal T[i] + upper T[i+1] = right; solved from the root (Thomas).
        for i in 0..n {
            let before = if i == 0 {
                DVec2::ZERO
            } else {
                self.forces[i - 1]
            };
            let mut right = length * chain.spins[i] * chain.spins[i]
                + self.along[i].dot(self.forces[i] - before);
            let mut diagonal = light(i) + if i == 0 { 0.0 } else { light(i - 1) };
            let upper = match self.along.get(i + 1) {
                Some(next) => -light(i) * self.along[i].dot(*next),
                None => 0.0,
            };
            if i > 0 {
                let [diagonal_before, lower, right_before] = self.system[i - 1];
                // The system is symmetric.
                let factor = lower / diagonal_before;
                diagonal -= factor * lower;
                right -= factor * right_before;
            }
            self.system[i] = [diagonal, upper, right];
        }
        let mut tension = 0.0;
        for i in (0..n).rev() {
            let [diagonal, upper, right] = self.system[i];
            tension = (right - upper * tension) / diagonal;
            self.forces[i] -= self.along[i] * (tension * light(i));
            if i > 0 {
                self.forces[i - 1] += self.along[i] * (tension * light(i - 1));
            }
        }
    }
}

/// The tip of a clamped level strand at rest, in lengths, y up: theta'' = -Gamma (1 - s) cos theta, theta(0) = 0,
/// theta'(1) = 0, by shooting from the tip.
#[must_use]
pub fn cantilever(gamma: f64) -> DVec2 {
    // Of all tip angles whose strand is level at the root the steepest is the hanging strand's; a steeper tip has a
    // root that points down.
    let root_angle = |tip: f64| shoot(gamma, tip).0;
    let steepest = std::f64::consts::FRAC_PI_2;
    let mut less = 1e-12;
    while root_angle(steepest - less) > 0.0 {
        less *= 1.5;
    }
    let (mut low, mut high) = (steepest - less, steepest - less / 1.5);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if root_angle(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    shoot(gamma, 0.5 * (low + high)).1
}

/// From the tip at angle `tip` to the root: the root's angle, and the tip seen from the root.
fn shoot(gamma: f64, tip: f64) -> (f64, DVec2) {
    let steps = 4000;
    let h = 1.0 / f64::from(steps);
    // u is the length from the tip: theta_uu = -Gamma u cos theta.
    let rates = |u: f64, [angle, curvature, _, _]: [f64; 4]| {
        [
            curvature,
            -gamma * u * angle.cos(),
            angle.cos(),
            -angle.sin(),
        ]
    };
    let mut state = [tip, 0.0, 0.0, 0.0];
    for step in 0..steps {
        let u = f64::from(step) * h;
        let ahead = |k: [f64; 4], h: f64| std::array::from_fn(|i| state[i] + h * k[i]);
        let k1 = rates(u, state);
        let k2 = rates(u + 0.5 * h, ahead(k1, 0.5 * h));
        let k3 = rates(u + 0.5 * h, ahead(k2, 0.5 * h));
        let k4 = rates(u + h, ahead(k3, h));
        state =
            std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    (state[0], DVec2::new(state[2], state[3]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cantilever_is_that_of_the_master_curve() {
        // Of a spectral solution, to 9 digits: Gamma, x, drop.
        for (gamma, x, y) in [
            (1.0, 0.991_246_395, 0.123_471_402),
            (10.0, 0.656_353_761, 0.700_199_716),
            (100.0, 0.159_223_383, 0.937_523_935),
            (1000.0, 0.045_986_455, 0.981_141_269),
        ] {
            let error = (cantilever(gamma) - DVec2::new(x, -y)).length();
            assert!(error < 1e-8, "gamma {gamma}: {error}");
        }
    }

    #[test]
    fn a_stiff_link_swings_as_a_pendulum_on_a_spring() {
        // One link: a mass 1/2 at distance 1, a spring 2 / Gamma; small angles about the sag of gravity.
        let gamma = 0.02;
        let stiffness = 2.0 / gamma;
        let omega = (stiffness / 0.5_f64).sqrt();
        let quarter = std::f64::consts::FRAC_PI_2 / omega;
        let path = Chain::fall(gamma, 1, quarter / 16.0, 64);
        let sag = 0.5 / stiffness;
        for (tip, expected) in path.iter().step_by(16).zip([0.0, sag, 2.0 * sag, sag, 0.0]) {
            assert!((tip.y + expected).abs() < 2e-5, "{tip} {expected}");
        }
    }

    #[test]
    fn refinement_converges() {
        let paths = [10, 20, 40].map(|links| drop(10.0, links, 0.24, 10));
        let distance = |a: &[DVec2], b: &[DVec2]| {
            let most = a.iter().zip(b).map(|(a, b)| (*a - *b).length());
            most.fold(0.0, f64::max)
        };
        let far = distance(&paths[0], &paths[1]);
        let near = distance(&paths[1], &paths[2]);
        assert!(near < 0.25 * far && near < 1e-3, "{far} {near}");
    }
}
