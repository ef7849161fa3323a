//! Hair as a scene has it: strands with their sizes, what the head holds of them, and the shapes that are wanted of them.

use crate::bodies::{clear, followed};
use crate::dynamics::{DynamicsSection, ZoneDynamics, turn_of};
use crate::files::StageError;
use crate::head::HeadModel;
use crate::merged::Ranks;
use crate::neck::pivot;
use crate::posture::Posture;
use crate::preset::HairSection;
use crate::reach::reach_m;
use crate::script::{HeadPose, MotionScript};
use glam::{Vec2, Vec3};
use groom::{Guides, LowTie, OrnamentMesh};
use hair_io::{HairFile, HeadFrame, Mesh};
use hair_sim::{Collider, Placed, PointCache, Pose, Strands};
use render::{Head, NO_COLOR, NO_TAPER, StrandInfo};
use std::path::PathBuf;
use std::sync::OnceLock;

/// Hair that was read, grown, or made by a program.
pub struct HairModel {
    /// Sorted by id.
    pub(crate) file: HairFile,
    /// What drawing needs of each strand; what hangs on a frame is left at zero.
    pub(crate) infos: Vec<StrandInfo>,
    /// How many strands, the first ones, are an undercoat: no hair comes loose from it.
    pub(crate) undercoat: usize,
    /// How many points from its root each strand keeps on the head.
    pub(crate) held: Vec<u32>,
    /// The taper of each strand: see [`StrandInfo`].
    pub(crate) tapers: Vec<Vec2>,
    /// The shapes that a script wants of it at times.
    pub(crate) shapes: Option<PointCache>,
    /// The bake that its file's motion is of.
    pub(crate) bake: Option<PathBuf>,
    /// The names of its style's zones; none where it doesn't come from one.
    pub(crate) zone_names: Vec<String>,
    /// Which zones of its style are cut straight.
    pub(crate) zone_cuts: Vec<bool>,
    /// How the hair of each zone of its style moves, where the style says so.
    pub(crate) zone_dynamics: Vec<Option<ZoneDynamics>>,
    /// The colours of each zone of its style at root and tip: see [`StrandInfo`].
    pub(crate) zone_colors: Vec<[Vec3; 2]>,
    /// The colours of each strand at root and tip, where its file says them; empty where not.
    pub(crate) own_colors: Vec<[Vec3; 2]>,
    /// The ties that gather it on the head, and what lies on it.
    pub(crate) ornaments: Vec<OrnamentMesh>,
    /// The ties that move with it.
    pub(crate) low_ties: Vec<LowTie>,
    /// The head that it stands on.
    pub(crate) head: Head,
    /// The roots of all strands, also of those that guides stand for.
    pub(crate) all_roots: Vec<Vec3>,
    /// The radius of the ball around the head's middle that it stays in, metres.
    pub(crate) reach_m: f32,
    /// Which strands are left where it is thin; found where it first is.
    pub(crate) ranks: OnceLock<Ranks>,
}

impl HairModel {
    /// Whether its strands have colours of their file's, as a character's own hair has.
    #[must_use]
    pub fn has_own_colors(&self) -> bool {
        self.own_colors.iter().any(|colors| colors[0] != NO_COLOR)
    }

    /// Strands of a program's own, in metres, Y up, the face towards +Z. Sizes that they lack are taken from the spacing of their
    /// roots. Without a head they stand on the sphere that fits their roots.
    ///
    /// # Errors
    ///
    /// When two strands have one id, or there are none.
    pub fn new(strands: Strands, head: Option<&HeadModel>) -> Result<Self, StageError> {
        let mut file = HairFile {
            strands,
            motion: None,
            notes: Vec::new(),
        };
        sort_by_id(&mut file);
        let ids = &file.strands;
        let twice = (1..ids.len()).find(|&i| ids.id(i) == ids.id(i - 1));
        if let Some(i) = twice {
            return Err(StageError::SameId(ids.id(i)));
        }
        if file.strands.is_empty() {
            return Err(StageError::NoHair);
        }
        let mut hair = Self::read(file, head);
        hair.choose_guides(&HairSection::default());
        Ok(hair)
    }

    /// Strands of a file, before guides are chosen.
    pub(crate) fn read(mut file: HairFile, head: Option<&HeadModel>) -> Self {
        sort_by_id(&mut file);
        // Before strands are chosen: how many are kept moves neither the camera nor any size.
        let all_roots: Vec<Vec3> = file.strands.roots().collect();
        Self {
            held: vec![1; file.strands.len()],
            tapers: vec![NO_TAPER; file.strands.len()],
            undercoat: 0,
            infos: Vec::new(),
            shapes: None,
            bake: None,
            zone_names: Vec::new(),
            zone_cuts: Vec::new(),
            zone_dynamics: Vec::new(),
            zone_colors: Vec::new(),
            own_colors: Vec::new(),
            ornaments: Vec::new(),
            low_ties: Vec::new(),
            head: match head {
                Some(head) => head.frame(&all_roots),
                None => head_of(HeadFrame::find(None, &all_roots)),
            },
            reach_m: 0.0,
            ranks: OnceLock::new(),
            all_roots,
            file,
        }
    }

    /// None, for pictures without any hair.
    pub(crate) fn none(head: Option<&HeadModel>) -> Self {
        let file = HairFile {
            strands: Strands::new(),
            motion: None,
            notes: Vec::new(),
        };
        Self::read(file, head)
    }

    /// The number of strands.
    #[must_use]
    pub fn strand_count(&self) -> usize {
        self.infos.len()
    }

    /// Keeps as many strands as the section asks for, and says what size each is: its own, the section's, or
    /// from the strands it stands for.
    pub(crate) fn choose_guides(&mut self, section: &HairSection) {
        let strands = &self.file.strands;
        let guides = match section.guides {
            0 => Guides::choose(strands, strands.len()),
            n => Guides::choose(strands, n as usize),
        };
        let set = Some(section.size).filter(|size| *size > 0.0);
        let given = |i: usize| strands.size(i).or(set);
        let sizes = if guides.kept.iter().all(|&i| given(i).is_some()) {
            vec![0.0; guides.kept.len()]
        } else {
            guides.sizes(strands, self.head.height_m)
        };
        let infos = guides.kept.iter().zip(sizes).map(|(&i, size)| StrandInfo {
            id: strands.id(i),
            mean: Vec3::ZERO,
            size: given(i).unwrap_or(size),
            taper: self.tapers[i],
            colors: self.colors(i),
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        });
        self.infos = infos.collect();
        self.keep(&guides.kept);
        self.reach_m = reach_m(&self.file.strands, &self.infos, self.head);
    }

    /// Keeps these strands, in this order.
    fn keep(&mut self, indices: &[usize]) {
        if let Some(shapes) = &self.shapes {
            let strands = &self.file.strands;
            let points = indices.iter().flat_map(|&i| strands.point_range(i));
            self.shapes = Some(shapes.select(&points.collect::<Vec<_>>()));
        }
        self.file.keep(indices);
        self.ranks = OnceLock::new();
        let is_undercoat = |i: &&usize| **i < self.undercoat;
        self.undercoat = indices.iter().filter(is_undercoat).count();
        self.held = indices.iter().map(|&i| self.held[i]).collect();
        self.tapers = indices.iter().map(|&i| self.tapers[i]).collect();
        if !self.own_colors.is_empty() {
            self.own_colors = indices.iter().map(|&i| self.own_colors[i]).collect();
        }
    }

    /// A warning of hair that its own file moves, which tells one time alone. A bake of one frame is meant.
    pub(crate) fn still_note(&self) -> Option<String> {
        let motion = self.file.motion.as_ref().filter(|_| self.bake.is_none())?;
        let [time] = *motion.times() else {
            return None;
        };
        Some(format!(
            "hair: WARNING: the `motion` of its file has one time, {time} s, so that it stands still: two times or more move it, and without `motion` it swings by itself"
        ))
    }

    /// That a zone's factors are on what the look hasn't.
    pub(crate) fn idle_notes(&self, dynamics: &DynamicsSection) -> Vec<String> {
        let zones = self.zone_names.iter().zip(&self.zone_dynamics);
        let idle = zones.flat_map(|(zone, own)| {
            let names = own.iter().flat_map(|own| own.idle(dynamics));
            names.map(move |name| {
                format!(
                    "hair: `{name}` of zone `{zone}` is a factor on the look's `dynamics.{name}`, which is 0: it changes nothing"
                )
            })
        });
        idle.collect()
    }

    /// Moves what is styled within bodies of a script out of them, as they are when the motion begins: what is so is its shape at rest.
    pub(crate) fn move_out_of_bodies(&mut self, script: &MotionScript, dynamics: &DynamicsSection) {
        if script.bodies.is_empty() || self.file.motion.is_some() {
            return;
        }
        let time = script.within(-f64::from(dynamics.warm_up));
        let posture = Posture::of(
            script.head_before(time),
            (self.head, pivot(self.head)),
            script,
            time,
        );
        // Hair is styled on a head that does not move.
        let on_head = |pose: Pose| {
            let back = posture.head.rotation.inverse();
            Pose {
                rotation: back * pose.rotation,
                translation: back * (pose.translation - posture.head.translation),
            }
        };
        let bodies = script.bodies.iter();
        let bodies: Vec<Placed> = bodies
            .map(|body| body.collider([time; 2], [&posture; 2]))
            .map(|collider| Collider::fixed(collider.shape, on_head(collider.now)))
            .map(|collider| Placed::new(&collider))
            .collect();
        let mut bodies = followed(&bodies, 0);
        let unit_m = self.head.unit_m();
        for strand in 0..self.infos.len() {
            let (range, held) = (self.file.strands.point_range(strand), self.held(strand));
            let gap = (dynamics.distance * self.infos[strand].size * unit_m).clamp(1e-4, 0.1);
            let points = &mut self.file.strands.points_mut()[range];
            clear(points, held, &mut bodies, gap, |_| [gap; 4]);
        }
        self.reach_m = reach_m(&self.file.strands, &self.infos, self.head);
    }

    /// The ties that move with the hair, where it has these points on a head in this pose.
    pub(crate) fn low_ties_at(&self, points: &[Vec3], pose: HeadPose) -> Mesh {
        let mut all = Mesh {
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
        };
        let head = pose.rotation(1.0);
        for tie in &self.low_ties {
            let place = |&(id, point): &(u32, usize)| {
                let strand = self.infos.binary_search_by_key(&id, |info| info.id).ok()?;
                let range = self.file.strands.point_range(strand);
                let at = range.start + point;
                Some([at - 1, at, (at + 1).min(range.end - 1)])
            };
            let places: Vec<[usize; 3]> = tie.members.iter().filter_map(place).collect();
            if places.is_empty() {
                continue;
            }
            let mean = |points: &[Vec3]| {
                let tied = places.iter().map(|[_, at, _]| points[*at]);
                tied.sum::<Vec3>() / places.len() as f32
            };
            let ways = places
                .iter()
                .map(|&[before, _, after]| points[after] - points[before]);
            let way: Vec3 = ways.map(Vec3::normalize_or_zero).sum();
            let turn = turn_of(tie.axis.as_dvec3(), way.as_dvec3(), head).as_quat();
            let (rest, now) = (mean(self.file.strands.points()), mean(points));
            let first = all.positions.len() as u32;
            let moved = tie.mesh.positions.iter().map(|p| turn * (*p - rest) + now);
            all.positions.extend(moved);
            all.normals
                .extend(tie.mesh.normals.iter().map(|n| turn * *n));
            let triangles = tie.mesh.triangles.iter();
            all.triangles
                .extend(triangles.map(|t| t.map(|i| first + i)));
        }
        all
    }

    /// Which strands are left where it is thin.
    pub(crate) fn ranks(&self) -> &Ranks {
        let roots = || self.file.strands.roots().collect::<Vec<Vec3>>();
        (self.ranks).get_or_init(|| Ranks::of(&roots(), self.undercoat))
    }

    /// The name of the zone in which the strand of this id grows; none of undercoat and clumps drawn by hand.
    pub(crate) fn zone_name(&self, id: u32) -> Option<&str> {
        let name = self.zone_names.get(groom::zone_of(id)?)?;
        Some(name)
    }

    /// Whether the strand of this index is of a zone that is cut straight.
    pub(crate) fn is_cut(&self, strand: usize) -> bool {
        let zone = groom::zone_of(self.infos[strand].id);
        zone.and_then(|zone| self.zone_cuts.get(zone)) == Some(&true)
    }

    /// How the strand of this id moves by its zone, where that says so.
    pub(crate) fn zone_dynamics(&self, id: u32) -> Option<&ZoneDynamics> {
        if self.zone_dynamics.is_empty() {
            return None;
        }
        self.zone_dynamics.get(groom::zone_of(id)?)?.as_ref()
    }

    /// The colours of the strand of this index: its own, or its zone's.
    fn colors(&self, strand: usize) -> [Vec3; 2] {
        if let Some(own) = self.own_colors.get(strand) {
            return *own;
        }
        let id = self.file.strands.id(strand);
        let of_zone = groom::zone_of(id).and_then(|zone| self.zone_colors.get(zone));
        of_zone.copied().unwrap_or([NO_COLOR; 2])
    }

    /// How many points from its root a strand keeps on the head, at least its root.
    pub(crate) fn held(&self, strand: usize) -> usize {
        let points = self.file.strands.strand(strand).len();
        (self.held[strand].max(1) as usize).min(points)
    }
}

fn sort_by_id(file: &mut HairFile) {
    let mut by_id: Vec<usize> = (0..file.strands.len()).collect();
    by_id.sort_by_key(|&i| file.strands.id(i));
    file.keep(&by_id);
}

pub(crate) fn head_of(frame: HeadFrame) -> Head {
    Head {
        center: frame.center,
        height_m: frame.height,
    }
}
