//! The hem of hair that is cut straight: locks end along it, however they lean.
//!
//! A half-round brush ends at right angles to its way. Hair hangs down and its hem lies level, so the two agree; but where locks lean, as when
//! the head turns, each would end askew, and the hem would be a saw. So the end of a cut lock is bent in the picture, until it crosses the line
//! through its neighbours' tips at right angles: by one bend, so that no lock bulges above its end. What light makes of it hangs on the hair in space, as
//! before.

use crate::hair::HairModel;
use glam::{Vec2, Vec3};
use stroke_path::{Camera, Paths};

/// How far from a tip its neighbours are, in radii of its lock: from nearer ones one tells not where the hem runs but how they fell, and
/// farther ones are another hem's.
const APART: [f32; 2] = [1.0, 4.0];

/// How far from the tip on a lock is bent, in its radii.
const BENT: f32 = 2.2;

/// Between these sines of its lean what is bent fades out: a lock that lies along the line through its neighbours' tips has no hem there.
const LEANS: [f32; 2] = [0.5, 0.8];

/// Between these shares of its length that the eye sees of a hem what is bent fades in: where a hem turns from the eye its locks' ends are narrow steps, and
/// bent ones would bulge from the outline.
const SEEN: [f32; 2] = [0.35, 0.75];

/// The strands to both sides of one along a hem; where the hem ends one of them is the strand itself.
pub(crate) type Beside = [usize; 2];

/// The neighbours of a strand along its hem, by the hair at rest; none where it is not cut, or alone.
pub(crate) fn beside(hair: &HairModel, strand: usize) -> Option<Beside> {
    if !hair.is_cut(strand) {
        return None;
    }
    let rest = &hair.file.strands;
    let tip = |strand: usize| rest.strand(strand).last().copied().unwrap_or_default();
    let way = |other: usize| tip(other) - tip(strand);
    let zone = |strand: usize| groom::zone_of(hair.infos[strand].id);
    let radius_m = hair.infos[strand].size * hair.head.unit_m();
    let is_near = |other: &usize| {
        let radii = way(*other).length() / radius_m;
        zone(*other) == zone(strand) && (APART[0]..APART[1]).contains(&radii)
    };
    let near = || (0..hair.infos.len()).filter(is_near);
    let nearer = |a: &usize, b: &usize| way(*a).length().total_cmp(&way(*b).length());
    let one = near().min_by(nearer)?;
    let is_opposite = |other: &usize| way(*other).dot(way(one)) < 0.0;
    let other = near().filter(is_opposite).min_by(nearer);
    Some([one, other.unwrap_or(strand)])
}

/// Bends the end of the last path, where it is the strand's, to the hem that runs from one tip to another (metres), as the camera sees them. The strand's
/// clump has that radius.
pub(crate) fn end_along_hem(
    paths: &mut Paths,
    strand: usize,
    tips: [Vec3; 2],
    radius_m: f32,
    camera: &Camera,
) {
    let own = paths.runs.last().filter(|run| run.strand == strand);
    let Some(joints) = own.map(|run| run.joints.clone()) else {
        return;
    };
    let tip = joints.end - 1;
    let whole_px = tips[0].distance(tips[1]) * paths.px_per_metre[tip];
    let tips = tips.map(|tip| camera.view_from_world(tip));
    if paths.u[tip] < 1.0 || tips.iter().any(|tip| tip.z < camera.near_m()) {
        return;
    }
    let radius_px = radius_m * paths.px_per_metre[tip];
    if radius_px <= 0.0 {
        return;
    }
    let hem = camera.project(tips[1]) - camera.project(tips[0]);
    let along = hem.normalize_or_zero();
    let lean = along.dot(ahead(paths.across[tip]));
    let seen = hem.length() / whole_px.max(f32::MIN_POSITIVE);
    let is_hem = 1.0 - smooth((lean.abs() - LEANS[0]) / (LEANS[1] - LEANS[0]));
    let is_seen = smooth((seen - SEEN[0]) / (SEEN[1] - SEEN[0]));
    let bend = is_hem * is_seen * lean * along;
    let (mut from_tip_px, mut after) = (0.0, paths.center[tip]);
    for joint in joints.rev() {
        let center = paths.center[joint];
        from_tip_px += center.distance(after);
        after = center;
        let share = from_tip_px / (BENT * radius_px);
        if share >= 1.0 {
            break;
        }
        let squared = share * share;
        paths.center[joint] -= BENT * radius_px * turned_from(share) * bend;
        let turned = ahead(paths.across[joint]) - bend * (1.0 - squared).powi(2);
        paths.across[joint] = turned.normalize_or(ahead(paths.across[joint])).perp();
    }
}

/// How far a joint at `share` of what is bent moves aside, in parts of that: what (1 - share²)², by which joints turn, sums up to from where the bend
/// begins.
fn turned_from(share: f32) -> f32 {
    let squared = share * share;
    8.0 / 15.0 - share * (1.0 - squared * (2.0 / 3.0 - squared / 5.0))
}

/// The way of a path on the screen that has this right angle to it.
fn ahead(across: Vec2) -> Vec2 {
    -across.perp()
}

/// Points of a strand whose end is bent: its path needs joints there that the strand at rest does without.
pub(crate) fn bent(rest: &[Vec3]) -> Vec<Vec3> {
    let mut points = rest.to_vec();
    if let [.., before, tip] = &mut points[..] {
        let link = *tip - *before;
        *tip += 0.5 * link.any_orthogonal_vector().normalize_or_zero() * link.length();
    }
    points
}

/// From 0 to 1 as `t` goes there, without a corner.
fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::together::scene;
    use crate::frame_maker::FrameMaker;
    use crate::motion::Motion;
    use std::collections::HashMap;
    use stroke_path::{OrbitView, PathKind};

    /// A lock that leans by a third of a right angle, seen from the front, with a hem through its tip that runs there: its last link, and where its tip is.
    fn ended(hem: Vec3) -> [Vec2; 2] {
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 4.0,
            vertical_fov_degrees: 10.0,
        };
        let camera = Camera::orbit(view, [400, 400], 0.1).unwrap();
        let strand = [-1.0, -0.5, 0.0].map(|t| t * 0.2 * LEANING);
        let kind = PathKind::CatmullRom { subdivision: 8 };
        let mut paths = Paths::new();
        paths.push_strand(0, &strand, kind, &camera).unwrap();
        let tips = [-0.04, 0.04].map(|metres| metres * hem);
        end_along_hem(&mut paths, 0, tips, 0.04, &camera);
        let tip = paths.len() - 1;
        [paths.center[tip] - paths.center[tip - 1], paths.center[tip]]
    }

    const LEANING: Vec3 = Vec3::new(0.5, -0.866, 0.0);

    #[test]
    fn a_leaning_lock_ends_at_right_angles_to_its_hem() {
        let own = ended(Vec3::ZERO);
        assert!((own[0].normalize().x - 0.5).abs() < 1e-3, "{own:?}");
        let level = ended(Vec3::X);
        assert!(level[0].normalize().x.abs() < 0.1, "{level:?}");
        // One bend, not a bulge: its tip moves towards what it leans from, by less than its radius.
        let (moved, radius_px) = (
            level[1] - own[1],
            0.04 * 400.0 / (2.0 * 4.0 * 5.0_f32.to_radians().tan()),
        );
        assert!(
            moved.y.abs() < 1e-3 && (-radius_px..-0.3 * radius_px).contains(&moved.x),
            "{moved}"
        );
        // One whose neighbours' tips lie along it, or behind each other, stays as it is.
        assert_eq!(ended(LEANING), own);
        assert_eq!(ended(Vec3::Z), own);
    }

    /// In the picture of a bob whose locks lean as the head turns, ends stand at right angles to the line from tip to tip where the eye sees it whole.
    #[test]
    fn a_hem_is_no_saw_as_the_head_turns() {
        let scene = scene("flat-tails-red", "head-turn");
        let object = &scene.objects()[0];
        let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
        for frame in 0..=36 {
            motion.advance_to(&scene, frame as f32 / 24.0).unwrap();
        }
        let frame = frames.frame(&scene, &motion).unwrap();
        let (camera, paths) = (frame.camera, frame.paths);
        let ends = paths
            .runs
            .iter()
            .map(|run| (run.strand, run.joints.end - 1));
        let ends: HashMap<usize, usize> = ends.collect();
        // How an end leans in the picture, and how the strand does in space.
        let leans = |(strand, end): (&usize, &usize)| {
            let [one, other] = object.shapes()[*strand]
                .hem?
                .map(|strand| ends.get(&strand));
            let (one, other) = (*one?, *other?);
            let hem = paths.center[one] - paths.center[other];
            let whole_m = paths.position[one].distance(paths.position[other]);
            let is_seen = hem.length() > 0.8 * whole_m * paths.px_per_metre[*end];
            let own = camera.view_from_world_direction(paths.forward[*end]);
            let ways = [
                paths.center[*end] - paths.center[end - 1],
                Vec2::new(own.x, -own.y),
            ];
            let [shown, own] = ways.map(|way| way.normalize().dot(hem.normalize()).abs());
            (is_seen && (0.1..0.45).contains(&own)).then_some([shown, own])
        };
        let leans: Vec<[f32; 2]> = ends.iter().filter_map(leans).collect();
        let [shown, own] =
            [0, 1].map(|i| leans.iter().map(|lean| lean[i]).sum::<f32>() / leans.len() as f32);
        assert!(
            leans.len() > 10 && shown < 0.4 * own,
            "{}: {shown}, {own}",
            leans.len()
        );
    }
}
