//! What acts on the particles of a batch in a stage: their mass and weight, air, springs, and the planes of contacts.

use crate::{
    forces::springs::Spring,
    lanes::{Lane, Mask, Number, Sym3, Vec3},
};

use super::{
    batch::Batch,
    chain::Chain,
    contact::{Contact, Due, REBOUND, find::Ways},
    link::Node,
    stage::{FreeMotion, Stage, Sum},
};

/// The loads on the particles of a batch.
#[derive(Clone, Debug)]
pub(crate) struct Loads {
    pub nodes: Vec<Node>,
    /// Of a stage: positions without force, velocities without force.
    pub free_y: Vec<Vec3>,
    pub free_v: Vec<Vec3>,
    /// Whether there are any springs in this step.
    pub has_springs: bool,
    pub springs: Vec<Spring>,
    /// Strands that others pull or push in this step.
    pub driven_by_others: Mask,
    /// The share of its friction that is left to each particle, where any is recalled.
    pub grips: Vec<Lane>,
    pub contacts: Vec<Contact>,
    /// The planes that particles have in this step, by their places in `contacts`: there the first are those of bodies, one for each particle, then come
    /// those of other strands, and last second ones of bodies.
    pub touched: Vec<usize>,
    /// The strands that two bodies have planes for in this step, of which one is no part of the figure.
    pub between: Mask,
    /// Those that are near one whose shape is exact, a ball or a capsule; and all, where there is any.
    pub on_exact: Mask,
    pub have_exact: Mask,
    /// What planes of bodies were found by.
    pub ways: Ways,
}

impl Loads {
    /// For batches of at most so many particles in a row, and planes.
    pub(crate) fn new(count: usize, planes: usize) -> Self {
        Self {
            nodes: vec![Node::<Lane>::zero(); count],
            free_y: vec![Vec3::ZERO; count],
            free_v: vec![Vec3::ZERO; count],
            has_springs: false,
            springs: vec![Spring::NONE; count],
            driven_by_others: Mask::NONE,
            grips: vec![Lane::ONE; count],
            contacts: vec![Contact::NONE; planes],
            touched: Vec::with_capacity(planes),
            between: Mask::NONE,
            on_exact: Mask::NONE,
            have_exact: Mask::NONE,
            ways: Ways::new(count),
        }
    }

    /// The motion without force from the positions `y_of` and velocities `v_of`, which leaves mass and weight here.
    #[inline(always)]
    pub(crate) fn free_motion<'a>(
        &'a mut self,
        batch: &'a Batch,
        stage: &Stage,
        y_of: Sum<'a>,
        v_of: Sum<'a>,
    ) -> FreeMotion<'a> {
        let (y, v) = (&mut self.free_y[..], &mut self.free_v[..]);
        FreeMotion::new(batch, stage, (y_of, v_of), (y, v), &mut self.nodes)
    }

    /// Adds forces to mass and weight of every particle.
    pub(crate) fn add<T: Number>(&mut self, batch: &Batch, stage: &Stage, chain: &Chain) {
        if batch.has_drag.any() {
            self.add_drag::<T>(batch, stage, chain);
        }
        if self.has_springs {
            self.add_springs::<T>(batch, stage);
        }
        if !self.touched.is_empty() {
            for &plane in &self.touched {
                self.contacts[plane].forget();
            }
            let due = Due::Expected(stage.length);
            self.hold::<T>(batch, stage, chain, due, Mask::NONE.not());
        }
    }

    fn add_drag<T: Number>(&mut self, batch: &Batch, stage: &Stage, chain: &Chain) {
        T::run(
            #[inline(always)]
            move || {
                let count = batch.count();
                let (nodes, free_y) = (&mut self.nodes[..count], &self.free_y[..count]);
                let particles = &batch.particles[..count];
                let (y, tangents) = (&chain.y[..count], &chain.tangents[..count]);
                for k in 0..count {
                    let (particle, d) = (particles[k].load::<T>(), stage.length.load::<T>());
                    let rate = particle.mass * particle.drag * d;
                    let less = batch.drag_along.load::<T>() - T::splat(1.0);
                    let n = Sym3::outer(rate, tangents[k].load(), rate * less);
                    let air = stage.gusts.velocity(stage.root.load::<T>() + y[k].load());
                    let air = match batch.is_open {
                        true => air,
                        false => air.scale(particle.wind),
                    };
                    let air = air - stage.velocity.load();
                    let carried = free_y[k].load() + air.scale(d);
                    let node = nodes[k].load();
                    let node = Node {
                        n: node.n + n,
                        b: node.b + n.apply(carried),
                    };
                    nodes[k] = node.store();
                }
            },
        );
    }

    fn add_springs<T: Number>(&mut self, batch: &Batch, stage: &Stage) {
        T::run(
            #[inline(always)]
            move || {
                let count = batch.count();
                let (nodes, free_y) = (&mut self.nodes[..count], &self.free_y[..count]);
                let (particles, springs) = (&batch.particles[..count], &self.springs[..count]);
                for k in 0..count {
                    let (mass, d) = (particles[k].mass.load::<T>(), stage.length.load::<T>());
                    let spring = springs[k].load();
                    let (to, flow) = if stage.is_mid {
                        (spring.mid, spring.flow_mid)
                    } else {
                        (spring.end, spring.flow_end)
                    };
                    let carried = free_y[k].load().scale(spring.rate) + flow.scale(d);
                    let stiffness = (spring.stiffness * (d * d) + spring.rate * d) * mass;
                    let node = nodes[k].load();
                    let node = Node {
                        n: node.n + Sym3::diagonal(stiffness),
                        b: node.b + (to.scale(d * d) + carried.scale(d)).scale(mass),
                    };
                    nodes[k] = node.store();
                }
            },
        );
    }

    /// Lets planes that are due hold particles from now on, in the strands of `among`. Returns the strands where any is new.
    pub(crate) fn hold<T: Number>(
        &mut self,
        batch: &Batch,
        stage: &Stage,
        chain: &Chain,
        due: Due,
        among: Mask,
    ) -> Mask {
        T::run(
            #[inline(always)]
            move || {
                let mut new = Mask::NONE;
                let has_exact = self.have_exact.any();
                for &plane in &self.touched {
                    let (contact, k) = (&mut self.contacts[plane], batch.held_by(plane));
                    let level = if stage.is_mid {
                        contact.mid
                    } else {
                        contact.end
                    };
                    let rebound = match has_exact && batch.is_of_body(plane) {
                        true => REBOUND,
                        false => f64::INFINITY,
                    };
                    let here = contact.is_due(due, chain.y[k], level, rebound).and(among);
                    if here.any() {
                        let (mass, node) = (batch.particles[k].mass, &mut self.nodes[k]);
                        contact.hold(node, here, mass, level, stage.length, self.free_y[k]);
                        new = new.or(here);
                    }
                }
                new
            },
        )
    }

    /// Takes friction from what is recalled.
    pub(crate) fn loosen(&mut self, batch: &Batch) {
        for &plane in &self.touched {
            self.contacts[plane].loosen(self.grips[batch.held_by(plane)]);
        }
    }

    /// Gives friction to particles that came to touch in this step, in the strands of `among`. Returns the strands where any is new.
    pub(crate) fn rub<T: Number>(
        &mut self,
        batch: &Batch,
        stage: &Stage,
        chain: &Chain,
        among: Mask,
    ) -> Mask {
        T::run(
            #[inline(always)]
            move || {
                let mut new = Mask::NONE;
                for &plane in &self.touched {
                    let (contact, k) = (&mut self.contacts[plane], batch.held_by(plane));
                    let level = if stage.is_mid {
                        contact.mid
                    } else {
                        contact.end
                    };
                    let node = &mut self.nodes[k];
                    let mass = batch.particles[k].mass;
                    let places = (chain.y[k], self.free_y[k]);
                    new = new.or(contact.rub(node, mass, (level, stage.length), places, among));
                }
                new
            },
        )
    }
}
