//! Hair that is moved out of bodies as a whole: what is styled in them, what guides carry, and what the solver leaves in them between two particles.

use glam::Vec3;
use hair_sim::{LEADS_OUT, Placed};

/// How often points are moved out: each move may push others in.
const CLEARINGS: u32 = 16;
/// Where along a link it is looked at: at its end, and on the way there. What is known of the first two bounds the others.
const PLACES: [f32; 4] = [1.0, 0.5, 0.25, 0.75];
/// What part of a point's way the next one goes along, towards the tip and towards the root.
const BEYOND: f32 = 0.75;
const BEHIND: f32 = 0.5;
/// Places may be nearer than they should by this, m.
const NEAR: f32 = 1e-4;
/// Moves no longer than this, m, are the last: what they push in is no deeper.
const ENOUGH: f32 = 5e-5;
/// Moves no shorter than this part of those before are in vain. So many times in a row and they are the last where hair may have no room: they would only take it along, sideways.
const IN_VAIN: f32 = 0.8;
const PATIENCE: u32 = 2;
/// The next points aren't taken along by less than this, m.
const LEAST: f32 = 1e-5;
/// How many times as long as it was the link behind the last point that is held may become, and others: what a body that comes fast has swallowed stays in it as far as it would tear.
const MOST_STRETCHED: [f32; 2] = [1.25, 2.0];
/// How far out of a mesh that it grows under hair may sway, as the solver has it, m.
const WORN_LOOSELY: f32 = 1e-2;
/// What single precision may change a distance by, m.
const ROUNDING: f32 = 1e-6;

/// How far the places of the link that ends at a point are kept from bodies, m; below 0, how deep they may be.
pub(crate) type Gap = [f32; PLACES.len()];

/// Moves the points of a strand behind the first `held` out of bodies, with the way that is drawn between them, until each place is as far away as
/// `gap` says of the link that ends at a point, which is `most` m at most, but for a tenth of a millimetre, and but for what would [tear](MOST_STRETCHED) links; where the last held point is in a ball or a capsule, hair comes
/// out of it by and by ([`LEADS_OUT`]), and where it is in a mesh that is [worn](followed), as under a hat, hair stays in that until it leaves it by itself. Where there is no room between the figure and
/// another body, hair is in that. Whether any moved: what is clear stays, to the bit.
pub(crate) fn clear(
    points: &mut [Vec3],
    held: usize,
    bodies: &mut [Followed],
    most: f32,
    gap: impl Fn(usize) -> Gap,
) -> bool {
    let held = held.max(1);
    let mut near = Near::new(bodies);
    near.root(points, held - 1);
    let may_jam = near.bodies.iter().any(|(_, known)| !known.is_of_figure);
    // Where points were from the last that is held on, once any has been moved.
    let mut before = Vec::new();
    let (mut last_farthest, mut in_vain) = (f32::INFINITY, 0);
    for _ in 0..CLEARINGS {
        let mut farthest = 0.0_f32;
        near.start(points, held - 1);
        for i in held..points.len() {
            if near.is_clear(points, i, most) {
                continue;
            }
            let mut moves_here = false;
            for (place, gap) in gap(i).into_iter().enumerate() {
                let Some(push) = near.push(points, i, place, (gap - NEAR, moves_here)) else {
                    continue;
                };
                if before.is_empty() {
                    before = points[held - 1..].to_vec();
                }
                // As little as moves the place by that much; what is held stays.
                let t = PLACES[place];
                let (start, end) = match i == held {
                    true => (0.0, 1.0),
                    false => {
                        let squared = (1.0 - t) * (1.0 - t) + t * t;
                        ((1.0 - t) / squared, t / squared)
                    }
                };
                farthest = farthest.max(push.length());
                let (start, end) = (push * start, push * end);
                points[i - 1] += start;
                points[i] += end;
                take_along(&mut points[i + 1..], end, BEYOND);
                let behind = &mut points[held..(i - 1).max(held)];
                take_along(behind.iter_mut().rev(), start, BEHIND);
                moves_here = true;
            }
            if moves_here {
                near.start(points, i);
            }
        }
        in_vain = if farthest > IN_VAIN * last_farthest {
            in_vain + 1
        } else {
            0
        };
        if farthest <= ENOUGH || may_jam && in_vain == PATIENCE {
            break;
        }
        last_farthest = farthest;
    }
    hold_together(&mut points[held - 1..], &before);
    !before.is_empty()
}

/// Takes back of the ways that points have come since `before` what makes links longer than [`MOST_STRETCHED`] times what they were: of both ends of such a link that which has come farther
/// goes back as far as it has to. So nothing is moved that had not been.
fn hold_together(points: &mut [Vec3], before: &[Vec3]) {
    for _ in 0..CLEARINGS {
        let mut is_whole = true;
        for (i, was) in before.windows(2).enumerate() {
            let most = MOST_STRETCHED[i.min(1)] * was[0].distance(was[1]);
            if points[i].distance(points[i + 1]) <= most {
                continue;
            }
            is_whole = false;
            let way = |point: usize| points[point].distance_squared(before[point]);
            let (farther, other) = match way(i) > way(i + 1) {
                true => (i, i + 1),
                false => (i + 1, i),
            };
            points[farther] = back(before[farther], points[farther], (points[other], most));
        }
        if is_whole {
            return;
        }
    }
}

/// The last place on the way from `start` to `end` that is within `most` m of another, from the end on; where none is, the start.
fn back(start: Vec3, end: Vec3, (other, most): (Vec3, f32)) -> Vec3 {
    let (way, off) = (end - start, start - other);
    // |off + t way| = most
    let (a, b, c) = (
        way.length_squared(),
        way.dot(off),
        off.length_squared() - most * most,
    );
    let t = (-b + (b * b - a * c).max(0.0).sqrt()) / a;
    match c <= 0.0 && t.is_finite() {
        true => start + way * (0.999 * t).clamp(0.0, 1.0),
        false => start,
    }
}

/// Moves the next points of a strand by less and less, so that it bends and does not break.
fn take_along<'p>(points: impl IntoIterator<Item = &'p mut Vec3>, by: Vec3, share: f32) {
    let mut by = by;
    for point in points {
        by *= share;
        if by.length_squared() < LEAST * LEAST {
            return;
        }
        *point += by;
    }
}

/// How far the places of a strand's links are from bodies, for each point those of the link that ends there: `most` m where they are farther away.
/// The first point has no link. What grows under a body that is [worn](followed) isn't asked how far it is from that.
pub(crate) fn gaps(
    points: &[Vec3],
    (bodies, of_figure): (&[Placed], usize),
    most: f32,
) -> Vec<Gap> {
    let mut gaps = vec![[most; PLACES.len()]; points.len()];
    let mut followed = followed(bodies, of_figure);
    let mut near = Near::new(&mut followed);
    near.root(points, 0);
    near.start(points, 0);
    for i in 1..points.len() {
        if near.is_clear(points, i, most) {
            continue;
        }
        for (place, gap) in gaps[i].iter_mut().enumerate() {
            let at = on_path(points, i, PLACES[place]);
            let asked = |known: &Known| known.may_meet && !known.is_under(i, place);
            for (body, _) in near.bodies.iter().filter(|(_, known)| asked(known)) {
                *gap = gap.min(body.distance(at));
            }
        }
    }
    gaps
}

/// A body, and what is known of its distance from the strand that is followed.
pub(crate) type Followed<'a> = (&'a Placed<'a>, Known);

/// Bodies that strands are followed along, one strand after the other: the first ones are the figure's own, whose skin roots are in; meshes after those may be worn.
pub(crate) fn followed<'a>(bodies: &'a [Placed<'a>], of_figure: usize) -> Vec<Followed<'a>> {
    let known = |(index, body): (usize, &'a Placed<'a>)| {
        let known = Known {
            is_of_figure: index < of_figure,
            may_be_worn: index >= of_figure && body.is_sampled(),
            ..Known::default()
        };
        (body, known)
    };
    bodies.iter().enumerate().map(known).collect()
}

/// How far a strand is from each body at the point that it has been followed to.
struct Near<'a, 'b> {
    bodies: &'b mut [Followed<'a>],
    /// The length of the link to there, and how far the way that is drawn there is from it at most, m.
    link: f32,
    bulge: f32,
    /// How far the links there are from going on straight and even, m.
    bend: f32,
    /// Where the last point that is held is in a ball or a capsule: how far hair leads out of it to each point, m. Else nothing.
    led: Vec<f32>,
}

/// Distances from a body, or less than those, m.
#[derive(Default)]
pub(crate) struct Known {
    /// At the point, at the one before, and half way there.
    distance: f32,
    before: f32,
    middle: f32,
    /// Whether the way to there may come nearer than was asked for. Then the first is the distance.
    may_meet: bool,
    /// At the last point that is held, where that is in a ball or a capsule; else infinity.
    root: f32,
    is_of_figure: bool,
    /// Whether it is a mesh that isn't the figure's.
    may_be_worn: bool,
    /// The first point behind the last one that is held that is out of it, where that one is in it as under a hat; else 0.
    leaves: usize,
}

impl Known {
    /// Whether hair is under it at a place of the link that ends at point `to`. That by which it leaves it goes through its surface.
    fn is_under(&self, to: usize, place: usize) -> bool {
        to < self.leaves || to == self.leaves && place > 0
    }
}

impl<'a, 'b> Near<'a, 'b> {
    fn new(bodies: &'b mut [Followed<'a>]) -> Self {
        Self {
            bodies,
            link: 0.0,
            bulge: 0.0,
            bend: 0.0,
            led: Vec::new(),
        }
    }

    /// Takes note of which bodies the last point that is held is in.
    fn root(&mut self, points: &[Vec3], at: usize) {
        let mut is_in = false;
        for (body, known) in &mut *self.bodies {
            known.leaves = 0;
            if known.may_be_worn && body.distance(points[at]) < 0.0 {
                let is_out = |at: &Vec3| body.distance(*at) >= WORN_LOOSELY;
                let behind = points[at + 1..].iter().position(is_out);
                known.leaves = behind.map_or(points.len(), |first| at + 1 + first);
            }
            // Most roots are in the mesh of their head.
            let root = if body.is_sampled() {
                0.0
            } else {
                body.distance(points[at])
            };
            known.root = if root < 0.0 { root } else { f32::INFINITY };
            is_in |= root < 0.0;
        }
        if is_in {
            let links = points.windows(2).map(|link| link[0].distance(link[1]));
            let lengths = links
                .enumerate()
                .map(|(i, link)| if i < at { 0.0 } else { link });
            let led = lengths.scan(0.0, |along, length| {
                *along += length * LEADS_OUT as f32;
                Some(*along)
            });
            self.led = std::iter::once(0.0).chain(led).collect();
        }
    }

    /// Begins at a point.
    fn start(&mut self, points: &[Vec3], at: usize) {
        for (body, known) in &mut *self.bodies {
            known.distance = body.distance(points[at]);
        }
        self.bend = bend(points, at);
    }

    /// Goes on to the next point, `to`. Whether all on the way that is drawn there is farther from bodies than `gap` m.
    #[inline(always)] // a call for each link would cost as much as what is done there
    fn is_clear(&mut self, points: &[Vec3], to: usize, gap: f32) -> bool {
        let (link, bend) = (points[to].distance(points[to - 1]), bend(points, to));
        // No place of the spline is farther than this from the link.
        let bulge = 0.125 * bend.max(self.bend) + ROUNDING;
        (self.link, self.bulge, self.bend) = (link, bulge, bend);
        let mut is_clear = true;
        for (body, known) in &mut *self.bodies {
            known.before = known.distance;
            if to < known.leaves {
                known.distance = f32::NEG_INFINITY;
                known.may_meet = false;
                continue;
            }
            // Nothing on the way is nearer than this: so the distance itself is not asked for.
            known.distance -= link;
            known.may_meet = known.distance - bulge <= gap;
            if known.may_meet {
                known.distance = body.distance(points[to]);
                // A place of the link is no nearer than the mean of its ends less half of it.
                known.middle = 0.5 * (known.before + known.distance - link) - bulge;
                known.may_meet = known.middle <= gap;
                is_clear &= !known.may_meet;
            }
        }
        is_clear
    }

    /// What takes a place of the link that was gone on to last out of the body that it is deepest in, to `gap` m from it; nothing where it is out of all, or can't go farther. Where the figure
    /// leaves it no room there, as under an arm that lies on a back, it goes no farther than to that, and out of that if it is in it; where another body does, to the middle between the two. Pushed
    /// out of one and the other in turns it would come out at their sides, now here, now there. What `moves` may have come near others than it could meet before.
    fn push(
        &mut self,
        points: &[Vec3],
        to: usize,
        place: usize,
        (gap, moves): (f32, bool),
    ) -> Option<Vec3> {
        let (link, bulge) = (self.link, self.bulge);
        let mut deepest: Option<(f32, usize, &Placed)> = None;
        let mut at = None;
        let led = self.led.get(to - 1..=to);
        let led = led.map(|led| led[0] + (led[1] - led[0]) * PLACES[place]);
        for (index, (body, known)) in self.bodies.iter_mut().enumerate() {
            if !(known.may_meet || moves) || known.is_under(to, place) {
                continue;
            }
            let gap = led.map_or(gap, |led| gap.min(known.root + led));
            // No more than the distance.
            let least = match place {
                _ if moves => f32::NEG_INFINITY,
                0 => known.distance,
                1 => known.middle,
                _ => {
                    let end = [known.before, known.distance][place - 2];
                    let from_end = end - 0.25 * link - bulge;
                    from_end.max(0.5 * (end + known.middle) - 0.25 * link - 1.5 * bulge)
                }
            };
            if least >= gap {
                continue;
            }
            let distance = match place {
                0 if !moves => least,
                _ => body.distance(*at.get_or_insert_with(|| on_path(points, to, PLACES[place]))),
            };
            if place == 1 {
                known.middle = distance;
            }
            let lack = gap - distance;
            if lack > 0.0 && deepest.is_none_or(|(other, ..)| lack > other) {
                deepest = Some((lack, index, *body));
            }
        }
        let (lack, index, body) = deepest?;
        let at = at.unwrap_or_else(|| on_path(points, to, PLACES[place]));
        let out = body.outwards(at);
        let mut way = lack;
        let mut in_figure: Option<(f32, &Placed)> = None;
        let is_of_figure = self.bodies[index].1.is_of_figure;
        for (other, known) in self.bodies.iter().filter(|_| !is_of_figure) {
            // What it has no room for may touch it.
            let gap = led.map_or(gap, |led| gap.min(known.root + led)).min(0.0);
            let room = other.distance(at) - gap;
            if room >= lack || known.is_under(to, place) {
                continue;
            }
            if known.is_of_figure && room < in_figure.map_or(0.0, |(room, _)| room) {
                in_figure = Some((room, *other));
            }
            let towards = -out.dot(other.outwards(at));
            if towards > 0.0 {
                let all = room / towards;
                let way_here = if known.is_of_figure {
                    all
                } else {
                    0.5 * (lack + all)
                };
                way = way.min(way_here);
            }
        }
        if let Some((room, figure)) = in_figure.filter(|_| way <= 0.0) {
            return Some(figure.outwards(at) * -room);
        }
        (way > 0.0).then(|| out * way)
    }
}

/// How far the links at a point are from going on straight and even, m: their difference.
fn bend(points: &[Vec3], at: usize) -> f32 {
    match (at.checked_sub(1), points.get(at + 1)) {
        (Some(before), Some(after)) => (points[before] + *after - 2.0 * points[at]).length(),
        _ => 0.0,
    }
}

/// A place on the way that is drawn through points, Catmull and Rom's spline: at `t`, 0 to 1, of the link that ends at a point.
fn on_path(points: &[Vec3], to: usize, t: f32) -> Vec3 {
    let [b, c] = [points[to - 1], points[to]];
    if t == 1.0 {
        return c;
    }
    let a = to.checked_sub(2).map_or(2.0 * b - c, |i| points[i]);
    let d = points.get(to + 1).copied().unwrap_or(2.0 * c - b);
    let (from, to, way) = (0.5 * (c - a), 0.5 * (d - b), c - b);
    b + (from + (3.0 * way - 2.0 * from - to + (from + to - 2.0 * way) * t) * t) * t
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use hair_sim::{Collider, Pose, Shape};
    use proptest::prelude::*;

    fn ball(y: f64, radius: f64) -> Placed<'static> {
        let center = DVec3::new(0.0, y, 0.0);
        Placed::new(&Collider::fixed(
            Shape::Sphere { center, radius },
            Pose::IDENTITY,
        ))
    }

    /// How far a place is from the nearest body, m, negative inside.
    fn distance(at: Vec3, bodies: &[Placed]) -> f32 {
        let distances = bodies.iter().map(|body| body.distance(at));
        distances.fold(f32::INFINITY, f32::min)
    }

    /// The nearest place to bodies of the way that is drawn through points.
    fn nearest(points: &[Vec3], bodies: &[Placed]) -> f32 {
        let links = 1..points.len();
        let places =
            links.flat_map(|to| (0..=20).map(move |t| on_path(points, to, t as f32 / 20.0)));
        places
            .map(|at| distance(at, bodies))
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn strands_are_moved_out_with_their_links() {
        let ball = ball(-0.1, 0.05);
        let straight: Vec<Vec3> = (0..9)
            .map(|i| Vec3::new(0.004, -0.025 * i as f32, 0.0))
            .collect();
        let mut moved = straight.clone();
        assert!(clear(
            &mut moved,
            1,
            &mut followed(&[ball], 1),
            1e-3,
            |_| [1e-3; 4]
        ));
        assert_eq!(moved[0], straight[0]);
        let depth = -nearest(&moved, &[ball]);
        assert!(depth < 5e-4, "{depth}");
        // What may be inside stays.
        let mut same = straight.clone();
        assert!(!clear(
            &mut same,
            1,
            &mut followed(&[ball], 1),
            -0.06,
            |_| [-0.06; 4]
        ));
        assert_eq!(same, straight);
    }

    /// A root that a ball has swallowed stays; what follows comes out by and by, and its links aren't torn.
    #[test]
    fn what_is_rooted_in_a_body_comes_out_of_it_whole() {
        let ball = ball(0.0, 0.06);
        let straight: Vec<Vec3> = (0..9)
            .map(|i| Vec3::new(0.01, -0.01 - 0.025 * i as f32, 0.02))
            .collect();
        let mut moved = straight.clone();
        let gap = 1e-3;
        let mut bodies = followed(std::slice::from_ref(&ball), 1);
        clear(&mut moved, 1, &mut bodies, gap, |_| [gap; 4]);
        assert_eq!(moved[0], straight[0]);
        for link in moved.windows(2) {
            let length = link[0].distance(link[1]);
            assert!((length - 0.025).abs() < 0.004, "{length}");
        }
        let nearest = (moved[5..].iter())
            .map(|at| ball.distance(*at))
            .fold(f32::INFINITY, f32::min);
        assert!(nearest > gap - 2.0 * NEAR, "{nearest}");
    }

    /// What a body has swallowed is drawn out of it no farther than its links allow, the root's less than others, and what hangs below stays there.
    #[test]
    fn what_is_swallowed_is_not_torn() {
        let long = |link: f32, from: Vec3, along: Vec3| -> Vec<Vec3> {
            (0..30).map(|i| from + along * link * i as f32).collect()
        };
        // From just above a ball through it, and by a link that leaves it on the other side of a thin one.
        let hangs = long(0.025, Vec3::new(0.01, 0.0, 0.0), Vec3::NEG_Y);
        let across = long(0.065, Vec3::new(-0.06, 0.0, 0.0), Vec3::X);
        for (straight, ball, link) in [
            (hangs, ball(-0.14, 0.12), 0.025),
            (across, ball(0.0, 0.05), 0.065),
        ] {
            let mut moved = straight.clone();
            let gap = 1e-3;
            let mut bodies = followed(std::slice::from_ref(&ball), 1);
            assert!(clear(&mut moved, 1, &mut bodies, gap, |_| [gap; 4]));
            for (i, ends) in moved.windows(2).enumerate() {
                let stretched = ends[0].distance(ends[1]) / link;
                assert!(stretched < [1.26, 2.01][i.min(1)], "{i}: {stretched}");
            }
            assert!(moved[29].distance(straight[29]) < 5e-3, "{}", moved[29]);
        }
    }

    /// Hair between a back and an arm that comes 30 mm into it is left out of the back, on its own side, and in the arm; without the back it is moved out of the arm.
    #[test]
    fn what_has_no_room_stays_out_of_the_figure() {
        // Its skin is at z = 0.
        let back = Placed::new(&Collider::fixed(
            Shape::Sphere {
                center: DVec3::NEG_Z,
                radius: 1.0,
            },
            Pose::IDENTITY,
        ));
        let arm = Placed::new(&Collider::fixed(
            Shape::Capsule {
                from: DVec3::new(-0.3, 0.0, 0.01),
                to: DVec3::new(0.3, 0.0, 0.01),
                radius: 0.04,
            },
            Pose::IDENTITY,
        ));
        let hanging: Vec<Vec3> = (0..13)
            .map(|i| Vec3::new(0.01, 0.3 - 0.05 * i as f32, 0.006))
            .collect();
        let gap = 1e-3;
        let cleared = |bodies: &[Placed], of_figure: usize| {
            let mut moved = hanging.clone();
            let mut bodies = followed(bodies, of_figure);
            clear(&mut moved, 1, &mut bodies, gap, |_| [gap; 4]);
            moved
        };
        let pressed = cleared(&[back, arm], 1);
        let farthest = |moved: &[Vec3]| {
            let ways = moved.iter().zip(&hanging).map(|(a, b)| a.distance(*b));
            ways.fold(0.0, f32::max)
        };
        let in_back = -nearest(&pressed, &[back]);
        assert!(in_back < 1e-3, "{in_back}");
        assert!(farthest(&pressed) < 0.02, "{}", farthest(&pressed));
        let alone = cleared(&[arm], 0);
        let in_arm = -nearest(&alone, &[arm]);
        assert!(in_arm < 5e-4, "{in_arm}");
    }

    proptest! {
        /// What is as far away as it began stays, to the bit, wherever that is.
        #[test]
        fn what_is_as_near_as_it_began_stays(
            way in prop::array::uniform3(-1.0_f32..1.0),
            from in prop::array::uniform3(-0.2_f32..0.2),
            radius in 0.01..0.15_f64,
        ) {
            let bodies = [ball(-0.1, radius), ball(0.3, 0.1)];
            let way = Vec3::from(way).normalize_or(Vec3::X) * 0.02;
            let side = way.any_orthogonal_vector();
            let at = |i: u32| Vec3::from(from) + way * i as f32 + side * (0.6 * i as f32).sin();
            let points: Vec<Vec3> = (0..12).map(at).collect();
            let own = gaps(&points, (&bodies, bodies.len()), 1e-3);
            for i in 1..points.len() {
                for (t, gap) in PLACES.into_iter().zip(own[i]) {
                    let place = on_path(&points, i, t);
                    prop_assert_eq!(gap, 1e-3_f32.min(distance(place, &bodies)));
                }
            }
            let mut same = points.clone();
            prop_assert!(!clear(&mut same, 1, &mut followed(&bodies, 0), 1e-3, |i| own[i]));
            prop_assert!(same == points);
        }
    }
}
