//! Heads that were made, and what keeps hair out of them.

use crate::dynamics::Bodies;
use crate::head::HeadModel;
use crate::kept::Kept;
use groom::Figure;
use render::Head;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Figures, and distances that keep hair out of heads and shoulders: most of the time of loading a scene. Copies share them.
#[derive(Clone, Default)]
pub struct Heads {
    figures: Kept<Figure, Arc<HeadModel>, 4>,
    bodies: Kept<Solid, SharedBodies, 4>,
}

/// What hair cannot enter, once it moves.
pub(crate) type SharedBodies = Arc<OnceLock<Arc<Bodies>>>;

/// What hair cannot enter is made of.
#[derive(Clone)]
struct Solid {
    model: Arc<HeadModel>,
    head: Head,
}

impl fmt::Debug for Heads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Heads")
    }
}

impl PartialEq for Solid {
    fn eq(&self, other: &Self) -> bool {
        let has_mesh_of = || {
            let [own, others] = [self, other].map(|solid| solid.model.body_mesh());
            own == others
        };
        self.head == other.head && (Arc::ptr_eq(&self.model, &other.model) || has_mesh_of())
    }
}

impl Heads {
    /// The head of a figure.
    pub(crate) fn figure(&self, figure: Figure) -> HeadModel {
        let made = |figure: &Figure| Arc::new(HeadModel::figure(figure));
        self.figures.get(figure, made).as_ref().clone()
    }

    /// What hair cannot enter of a model, which stands where `head` says: that of an equal one before, if there was one.
    pub(crate) fn bodies(&self, model: Arc<HeadModel>, head: Head) -> SharedBodies {
        self.bodies
            .get(Solid { model, head }, |_| SharedBodies::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use groom::Dress;

    #[test]
    fn what_keeps_hair_out_of_equal_heads_is_one() {
        let heads = Heads::default();
        let head = |dress| {
            let figure = Figure {
                dress,
                ..Figure::default()
            };
            Arc::new(heads.clone().figure(figure))
        };
        let [plain, again, jacket] = [Dress::None, Dress::None, Dress::Jacket].map(head);
        let place = plain.frame(&[]);
        let bodies = |model: &Arc<HeadModel>, place| heads.bodies(model.clone(), place);
        let own = bodies(&plain, place);
        assert!(Arc::ptr_eq(&own, &bodies(&again, place)));
        assert!(!Arc::ptr_eq(&own, &bodies(&jacket, place)));
        let larger = Head {
            height_m: 2.0 * place.height_m,
            ..place
        };
        assert!(!Arc::ptr_eq(&own, &bodies(&plain, larger)));
    }
}
