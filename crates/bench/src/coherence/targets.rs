//! What pictures in motion are held to.

use super::animation::Kind;
use super::{Figures, SceneFigures};
use crate::targets::{Found, Limit, Target};
use render::Order;

/// How far strands may move in 1/384 s, in pixels, for that time to tell all: a line that moves on by its own width changes no
/// more if it moves farther. Where they move farther, half the time is held to the same besides.
const SLOW_PX: f64 = 0.6;

/// The control that moves steadily scores so much at least; where it is fast, in half the time.
const STEADY: f64 = 1.9;
const STEADY_FAST: f64 = 1.85;

/// Times of which the first is over half of it.
#[derive(Clone, Copy)]
enum Times {
    /// 1/384 s.
    Long,
    /// 1/768 s.
    Short,
}

/// All targets of the scenes: of the order that presets have unless they say otherwise.
#[must_use]
pub fn targets(scenes: &[SceneFigures]) -> Vec<Target> {
    let mut targets = Vec::new();
    for scene in scenes {
        let own = of_order(scene, Order::default());
        match scene.kind {
            Kind::Hair => targets.extend(of_hair(scene, own)),
            Kind::Passes => {}
            Kind::Continuous if is_slow(scene) => {
                targets.push(refinement(scene, own, Times::Long, Limit::AtLeast(STEADY)));
            }
            Kind::Continuous => {
                let limit = Limit::AtLeast(STEADY_FAST);
                targets.push(refinement(scene, own, Times::Short, limit));
            }
            Kind::Jumping => {
                targets.push(refinement(scene, own, Times::Long, Limit::AtMost(1.1)));
            }
        }
    }
    targets
}

fn of_order(scene: &SceneFigures, order: Order) -> Option<&Figures> {
    let mut orders = scene.orders.iter().zip(&scene.figures);
    orders
        .find(|((_, found), _)| *found == order)
        .map(|(_, figures)| figures)
}

fn is_slow(scene: &SceneFigures) -> bool {
    scene.motion.0[0] <= SLOW_PX
}

fn refinement(scene: &SceneFigures, own: Option<&Figures>, times: Times, limit: Limit) -> Target {
    let found = own.map(|own| &own.continuity);
    let (time, found) = match times {
        Times::Long => ("1/384 s", found.and_then(|found| found.ratio())),
        Times::Short => ("1/768 s", found.and_then(|found| found.fine_ratio())),
    };
    Target {
        text: format!("{}: largest change in {time} over that in half", scene.name),
        found: found.map(Found::Is),
        limit,
    }
}

fn of_hair(scene: &SceneFigures, own: Option<&Figures>) -> Vec<Target> {
    let shifted = of_order(scene, Order::Shifted);
    let target = |text: &str, found: Option<f64>, most| Target {
        text: format!("{}: {text}", scene.name),
        found: found.map(Found::Is),
        limit: Limit::AtMost(most),
    };
    let over_shifted = |value: fn(&Figures) -> f64| {
        let [own, shifted] = [value(own?), value(shifted?)];
        // Nothing that pops is as good as it gets, also beside nothing.
        Some(if own > 0.0 { own / shifted } else { 0.0 })
    };
    let mut targets = vec![
        refinement(scene, own, Times::Long, Limit::AtLeast(1.8)),
        target("time over shifted's", over_shifted(|of| of.seconds), 1.3),
        target(
            "popped pixels, worst, over shifted's",
            over_shifted(|of| of.continuity.popped[0]),
            1.0,
        ),
        target(
            "popped pixels, mean, over shifted's",
            over_shifted(|of| of.continuity.popped[1]),
            1.0,
        ),
    ];
    if !is_slow(scene) {
        targets.push(refinement(scene, own, Times::Short, Limit::AtLeast(1.8)));
    }
    if let Some(still) = own.and_then(|own| own.still) {
        targets.push(target(
            "pixels that change though nothing moves",
            Some(still as f64),
            0.0,
        ));
    }
    targets
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coherence::scenes::ORDERS;
    use crate::coherence::search::{Continuity, Motion};
    use crate::targets::report;

    /// A scene whose figures reach everything.
    fn good() -> SceneFigures {
        let figures = Figures {
            continuity: Continuity {
                largest: [0.1, 0.05, 0.025],
                popped: [0.01, 0.001],
                ..Continuity::default()
            },
            warp: [None; 2],
            still: Some(0),
            seconds: 0.01,
        };
        SceneFigures {
            name: "scene".to_owned(),
            kind: Kind::Hair,
            motion: Motion::default(),
            orders: ORDERS.to_vec(),
            figures: vec![figures; ORDERS.len()],
        }
    }

    fn missed(scene: SceneFigures) -> Vec<String> {
        let targets = targets(&[scene]);
        let missed = targets.iter().filter(|target| !target.is_met());
        missed.map(|target| target.text.clone()).collect()
    }

    /// The figures of the order that is held to something.
    fn own(scene: &mut SceneFigures) -> &mut Figures {
        let place = ORDERS.iter().position(|of| of.1 == Order::default());
        &mut scene.figures[place.unwrap()]
    }

    #[test]
    fn good_figures_are_met() {
        let targets = targets(&[good()]);
        assert_eq!(targets.len(), 5);
        assert!(targets.iter().all(Target::is_met), "{}", report(&targets));
    }

    #[test]
    fn each_bad_figure_is_missed() {
        type Spoil = fn(&mut Figures);
        let cases: [(Spoil, &str); 5] = [
            (|own| own.continuity.largest[1] = 0.06, "in half"),
            (|own| own.continuity.popped[0] = 0.011, "worst"),
            (|own| own.continuity.popped[1] = 0.0011, "mean"),
            (|own| own.seconds = 0.0131, "time"),
            (|own| own.still = Some(1), "nothing moves"),
        ];
        for (spoil, text) in cases {
            let mut scene = good();
            spoil(own(&mut scene));
            let missed = missed(scene);
            assert!(missed.len() == 1 && missed[0].contains(text), "{missed:?}");
        }
    }

    #[test]
    fn fast_motion_is_held_to_a_shorter_time_besides() {
        let fast = || SceneFigures {
            motion: Motion([1.0, 0.5]),
            ..good()
        };
        assert_eq!(targets(&[fast()]).len(), 6);
        let mut scene = fast();
        own(&mut scene).continuity.largest = [0.05, 0.05, 0.025];
        assert!(missed(scene)[0].contains("1/384 s over"));
        let mut scene = fast();
        own(&mut scene).continuity.largest = [0.1, 0.05, 0.04];
        assert!(missed(scene)[0].contains("1/768 s over"));
    }

    #[test]
    fn what_does_not_pop_is_met_beside_anything() {
        let mut scene = good();
        for figures in &mut scene.figures {
            figures.continuity.popped = [0.0; 2];
        }
        assert!(missed(scene).is_empty());
        let mut scene = good();
        for figures in &mut scene.figures {
            figures.continuity.popped = [0.0; 2];
        }
        own(&mut scene).continuity.popped = [1e-4; 2];
        assert_eq!(missed(scene).len(), 2);
    }

    #[test]
    fn the_measure_is_held_to_its_controls() {
        for (kind, largest, met) in [
            (Kind::Continuous, [0.1, 0.051], true),
            (Kind::Continuous, [0.1, 0.0535], false),
            (Kind::Continuous, [0.1, 0.06], false),
            (Kind::Jumping, [0.1, 0.1], true),
            (Kind::Jumping, [0.1, 0.08], false),
            (Kind::Jumping, [0.0, 0.0], false),
        ] {
            let mut scene = SceneFigures { kind, ..good() };
            own(&mut scene).continuity.largest = [largest[0], largest[1], 0.0];
            assert_eq!(missed(scene).is_empty(), met, "{kind:?} {largest:?}");
        }
    }
}
