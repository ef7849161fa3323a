//! What pictures in motion are held to.

use super::animation::Kind;
use super::{Figures, ORDERS, SceneFigures};
use crate::targets::{Found, Limit, Target};
use render::Order;

/// All targets of the scenes: of the order that presets have unless they say otherwise.
#[must_use]
pub fn targets(scenes: &[SceneFigures]) -> Vec<Target> {
    let mut targets = Vec::new();
    for scene in scenes {
        let own = of_order(scene, Order::default());
        match scene.kind {
            Kind::Hair => targets.extend(of_hair(scene, own)),
            Kind::Continuous => targets.push(refinement(scene, own, Limit::AtLeast(1.9))),
            Kind::Jumping => targets.push(refinement(scene, own, Limit::AtMost(1.1))),
        }
    }
    targets
}

fn of_order(scene: &SceneFigures, order: Order) -> Option<&Figures> {
    let mut orders = ORDERS.iter().zip(&scene.orders);
    orders
        .find(|((_, found), _)| *found == order)
        .map(|(_, figures)| figures)
}

fn refinement(scene: &SceneFigures, own: Option<&Figures>, limit: Limit) -> Target {
    Target {
        text: format!(
            "{}: largest change in 1/384 s over that in half",
            scene.name
        ),
        found: own.and_then(|own| own.continuity.ratio()).map(Found::Is),
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
        refinement(scene, own, Limit::AtLeast(1.8)),
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
        target("time over shifted's", over_shifted(|of| of.seconds), 1.3),
    ];
    if let Some(still) = own.and_then(|own| own.still) {
        targets.push(target(
            "pixels that change though nothing moves",
            Some(still as f64),
            0.0,
        ));
    }
    targets
}
