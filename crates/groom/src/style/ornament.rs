//! What hair wears: the ties that gather it, bows, clips and hairbands, as meshes.

use super::scalp::on_line;
use crate::shell::{Place, Shell, direction};
use crate::trig::{sin_cos_degrees, sin_cos_turns};
use glam::Vec3;

/// Corners around a ring, and around its section.
const AROUND: u32 = 32;
const SECTION: u32 = 12;
/// Half the thickness of a ring, in its radii.
const THICKNESS: f32 = 0.42;
/// Half the length of a band along the hair and its thickness, in radii of the hair.
const BAND_LENGTH: f32 = 0.55;
const BAND_THICKNESS: f32 = 0.16;
/// Folds of a scrunchie, and how deep they are.
const FOLDS: f32 = 9.0;
const FOLD_DEPTH: f32 = 0.3;
/// Stations along a hairband.
const HAIRBAND_STATIONS: usize = 40;

/// What gathers hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TieKind {
    /// A thick ring.
    Ring,
    /// A flat band that fits the hair.
    Band,
    /// A folded ring of cloth.
    Scrunchie,
    /// A band with a bow on it.
    Bow,
    /// A bar across the hair, as a pin.
    Clip,
}

/// A tie around gathered hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    /// What it is.
    pub kind: TieKind,
    /// Its middle, metres.
    pub center: Vec3,
    /// The way of the hair through it, a unit vector.
    pub axis: Vec3,
    /// Radius of the hair in it, metres.
    pub radius_m: f32,
}

/// What is put into the hair without gathering it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccessoryKind {
    /// A bar that holds hair.
    Clip,
    /// A bow.
    Bow,
    /// A band over the head, along a line.
    Hairband,
}

/// Something that lies on the hair.
#[derive(Clone, Debug, PartialEq)]
pub struct Accessory {
    /// What it is.
    pub kind: AccessoryKind,
    /// Its place, or the line that a hairband runs along; one or more.
    pub at: Vec<Place>,
    /// Height above the skin, head heights.
    pub lift: f32,
    /// Half its length, or half the width of a hairband, head heights.
    pub size: f32,
    /// How far it is turned on the hair, degrees: 0 lies level.
    pub turn: f32,
    /// Also on the head's other side.
    pub mirror: bool,
}

/// An ornament as a closed mesh: positions in metres, unit normals, triangles that face outwards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrnamentMesh {
    /// Corners, metres.
    pub positions: Vec<Vec3>,
    /// A unit normal for each corner.
    pub normals: Vec<Vec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Tie {
    /// Its surface.
    #[must_use]
    pub fn mesh(&self) -> OrnamentMesh {
        match self.kind {
            TieKind::Ring => self.ring(),
            TieKind::Band => self.band(),
            TieKind::Scrunchie => self.scrunchie(),
            TieKind::Clip => {
                let facing = self.facing();
                let along = self.axis.cross(facing).normalize_or(Vec3::X);
                let center = self.center + facing * (0.9 * self.radius_m);
                clip(center, facing, along, 1.3 * self.radius_m)
            }
            TieKind::Bow => {
                let mut mesh = self.band();
                let facing = self.facing();
                let facing = (facing + 0.35 * self.axis).normalize_or(facing);
                let across = self.axis.cross(facing).normalize_or(Vec3::X);
                let center = self.center + facing * (1.3 * self.radius_m);
                mesh.append(bow(center, facing, across, 2.6 * self.radius_m));
                mesh
            }
        }
    }

    /// To the front and up, as far as the hair's way leaves room.
    fn facing(&self) -> Vec3 {
        let wanted = Vec3::new(0.0, 0.6, 1.0);
        (wanted - self.axis * wanted.dot(self.axis)).normalize_or(Vec3::Z)
    }

    fn ring(&self) -> OrnamentMesh {
        let u = self.axis.any_orthonormal_vector();
        let v = self.axis.cross(u);
        let thickness_m = THICKNESS * self.radius_m;
        let mut ring = OrnamentMesh::default();
        for around in 0..AROUND {
            let (sin, cos) = sin_cos_turns(around as f32 / AROUND as f32);
            let outwards = u * cos + v * sin;
            for section in 0..SECTION {
                let (sin, cos) = sin_cos_turns(section as f32 / SECTION as f32);
                let normal = outwards * cos + self.axis * sin;
                ring.normals.push(normal);
                ring.positions
                    .push(self.center + outwards * self.radius_m + normal * thickness_m);
                let corner = |i: u32, j: u32| (i % AROUND) * SECTION + j % SECTION;
                let (a, b) = (corner(around, section), corner(around + 1, section));
                let (c, d) = (corner(around, section + 1), corner(around + 1, section + 1));
                ring.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        ring
    }

    /// A ring whose section is a flat ellipse along the hair.
    fn band(&self) -> OrnamentMesh {
        self.hoop(|_| (1.0, BAND_LENGTH, BAND_THICKNESS))
    }

    fn scrunchie(&self) -> OrnamentMesh {
        self.hoop(|turn| {
            let (sin, _) = sin_cos_turns(FOLDS * turn);
            let fold = 1.0 + FOLD_DEPTH * sin;
            (1.1, 0.7 * fold, 0.5 * fold)
        })
    }

    /// A hoop around the hair; `section` says for each share of a turn how far its middle lies from the hair's, how far it
    /// reaches along the hair, and how thick it is, in radii of the hair.
    fn hoop(&self, section: impl Fn(f32) -> (f32, f32, f32)) -> OrnamentMesh {
        let u = self.axis.any_orthonormal_vector();
        let v = self.axis.cross(u);
        let count = 2 * AROUND;
        let stations = (0..count).map(|around| {
            let turn = around as f32 / count as f32;
            let (sin, cos) = sin_cos_turns(turn);
            let outwards = u * cos + v * sin;
            let (distance, along, thick) = section(turn);
            Station {
                center: self.center + outwards * (distance * self.radius_m),
                across: self.axis * (along * self.radius_m),
                out: outwards * (thick * self.radius_m),
            }
        });
        tube(&stations.collect::<Vec<_>>(), true)
    }
}

impl Accessory {
    /// Its surface on a head; `side` is 1 on the character's left, -1 on its right.
    ///
    /// # Panics
    ///
    /// When it is [`at`](Self::at) no place.
    #[must_use]
    pub fn mesh(&self, side: f32, shell: &Shell) -> OrnamentMesh {
        let mirrored = |way: Vec3| way * Vec3::new(side, 1.0, 1.0);
        let size_m = self.size * shell.height();
        if self.kind == AccessoryKind::Hairband {
            return self.hairband(side, shell);
        }
        let outwards = mirrored(direction(self.at[0]));
        let center = shell.above(outwards, self.lift);
        let level = Vec3::Y.cross(outwards).normalize_or(Vec3::X);
        let up = outwards.cross(level);
        let (sin, cos) = sin_cos_degrees(self.turn * side);
        let along = level * cos + up * sin;
        match self.kind {
            AccessoryKind::Bow => bow(center, outwards, along, size_m),
            _ => clip(center, outwards, along, size_m),
        }
    }

    fn hairband(&self, side: f32, shell: &Shell) -> OrnamentMesh {
        let point = |step: usize| {
            let along = step as f32 / (HAIRBAND_STATIONS - 1) as f32;
            let way = on_line(&self.at, along) * Vec3::new(side, 1.0, 1.0);
            (way, shell.above(way, self.lift))
        };
        let half_width_m = self.size * shell.height();
        let stations = (0..HAIRBAND_STATIONS).map(|step| {
            let (way, center) = point(step);
            let next = point((step + 1).min(HAIRBAND_STATIONS - 1)).1;
            let before = point(step.saturating_sub(1)).1;
            let along = (next - before).normalize_or(Vec3::X);
            // Its ends are round.
            let t = step as f32 / (HAIRBAND_STATIONS - 1) as f32;
            let full = (16.0 * t * (1.0 - t)).min(1.0).sqrt().max(0.05);
            Station {
                center,
                across: way.cross(along).normalize_or(Vec3::Z) * (half_width_m * full),
                out: way * (0.3 * half_width_m * full),
            }
        });
        tube(&stations.collect::<Vec<_>>(), false)
    }
}

impl OrnamentMesh {
    /// Adds another mesh.
    fn append(&mut self, other: Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        let triangles = other.triangles.iter().map(|t| t.map(|i| first + i));
        self.triangles.extend(triangles);
    }
}

/// A bar that lies on the hair: `half_m` long on each side.
fn clip(center: Vec3, outwards: Vec3, along: Vec3, half_m: f32) -> OrnamentMesh {
    let across = outwards.cross(along);
    let stations = (0..=10).map(|step| {
        let t = step as f32 / 5.0 - 1.0;
        let squared = t * t;
        let full = (1.0 - squared * squared).max(0.02).sqrt();
        Station {
            center: center + along * (t * half_m),
            across: across * (0.22 * half_m * full),
            out: outwards * (0.12 * half_m * full),
        }
    });
    tube(&stations.collect::<Vec<_>>(), false)
}

/// A bow that faces `facing`: two loops along `across`, two tails below them, a knot.
fn bow(center: Vec3, facing: Vec3, across: Vec3, half_m: f32) -> OrnamentMesh {
    const STEPS: usize = 12;
    let up = facing.cross(across);
    let mut mesh = OrnamentMesh::default();
    for side in [1.0, -1.0] {
        let blade = |length: f32, drop: f32, height: f32, thick: f32, widest: f32| {
            let stations = (0..=STEPS).map(|step| {
                let t = step as f32 / STEPS as f32;
                // From the knot to its widest, then closed in a round end.
                let open = (t / widest).min(1.0);
                let close = ((t - widest) / (1.0 - widest)).max(0.0);
                let full = (0.25 + 0.75 * open) * (1.0 - close * close).max(0.01).sqrt();
                Station {
                    center: center + (across * (side * t * length) - up * (t * drop)) * half_m
                        - facing * (0.12 * t * half_m),
                    across: (up * length + across * (side * drop)).normalize_or(up)
                        * (height * full * half_m),
                    out: facing * (thick * full * half_m),
                }
            });
            tube(&stations.collect::<Vec<_>>(), false)
        };
        mesh.append(blade(1.0, -0.18, 0.42, 0.2, 0.68));
        mesh.append(blade(0.5, 1.05, 0.2, 0.06, 0.85));
    }
    let knot = (0..=8).map(|step| {
        let t = step as f32 / 4.0 - 1.0;
        let full = (1.0 - t * t).max(0.01).sqrt();
        Station {
            center: center + up * (0.22 * t * half_m),
            across: across * (0.2 * full * half_m),
            out: facing * (0.24 * full * half_m),
        }
    });
    mesh.append(tube(&knot.collect::<Vec<_>>(), false));
    mesh
}

/// An elliptic section of a tube: its middle and its two half axes, metres.
struct Station {
    center: Vec3,
    across: Vec3,
    out: Vec3,
}

/// The tube through sections; `is_hoop` joins the last to the first, else the ends are closed.
fn tube(stations: &[Station], is_hoop: bool) -> OrnamentMesh {
    let count = stations.len() as u32;
    let mut positions = Vec::with_capacity(stations.len() * SECTION as usize + 2);
    for station in stations {
        for corner in 0..SECTION {
            let (sin, cos) = sin_cos_turns(corner as f32 / SECTION as f32);
            positions.push(station.center + station.across * sin + station.out * cos);
        }
    }
    let corner = |station: u32, around: u32| (station % count) * SECTION + around % SECTION;
    let joints = if is_hoop { count } else { count - 1 };
    let mut triangles = Vec::new();
    for station in 0..joints {
        for around in 0..SECTION {
            let [a, b] = [corner(station, around), corner(station + 1, around)];
            let [c, d] = [corner(station, around + 1), corner(station + 1, around + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    if !is_hoop {
        let first = positions.len() as u32;
        positions.extend([stations[0].center, stations[stations.len() - 1].center]);
        for around in 0..SECTION {
            triangles.push([first, corner(0, around), corner(0, around + 1)]);
            let [a, b] = [0, 1].map(|i| corner(count - 1, around + i));
            triangles.push([first + 1, b, a]);
        }
    }
    facing_outwards(&positions, &mut triangles);
    OrnamentMesh {
        normals: smooth_normals(&positions, &triangles),
        positions,
        triangles,
    }
}

/// Turns all triangles of a closed mesh around where it is inside out.
fn facing_outwards(positions: &[Vec3], triangles: &mut [[u32; 3]]) {
    let origin = positions[0];
    let volume: f32 = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| positions[i as usize] - origin);
            a.dot(b.cross(c))
        })
        .sum();
    if volume < 0.0 {
        for triangle in triangles {
            triangle.swap(1, 2);
        }
    }
}

/// The mean of the normals around each corner, by area.
fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a);
        for &i in triangle {
            normals[i as usize] += normal;
        }
    }
    let unit = |normal: Vec3| normal.normalize_or(Vec3::Y);
    normals.into_iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tie(kind: TieKind) -> Tie {
        Tie {
            kind,
            center: Vec3::new(0.1, 1.5, -0.1),
            axis: Vec3::new(0.6, 0.0, -0.8),
            radius_m: 0.01,
        }
    }

    fn volume(mesh: &OrnamentMesh, from: Vec3) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| (mesh.positions[i as usize] - from).as_dvec3());
            a.dot(b.cross(c)) / 6.0
        };
        mesh.triangles.iter().map(of).sum()
    }

    /// Each edge has one triangle on each of its sides.
    fn is_closed(mesh: &OrnamentMesh) -> bool {
        let mut edges = std::collections::HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        edges
            .iter()
            .all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1))
    }

    #[test]
    fn a_ring_is_closed_and_faces_outwards() {
        let tie = tie(TieKind::Ring);
        let ring = tie.mesh();
        for triangle in &ring.triangles {
            let [a, b, c] = triangle.map(|i| (ring.positions[i as usize] - tie.center).as_dvec3());
            let face = (b - a).cross(c - a).normalize().as_vec3();
            let normal: Vec3 = triangle.iter().map(|i| ring.normals[*i as usize]).sum();
            assert!(face.dot(normal.normalize()) > 0.9);
        }
        // 2 pi^2 R r^2, a little less since it has corners.
        let radius = f64::from(tie.radius_m);
        let exact = 2.0 * std::f64::consts::PI.powi(2) * radius.powi(3) * 0.42 * 0.42;
        let volume = volume(&ring, tie.center);
        assert!(
            (0.93..1.0).contains(&(volume / exact)),
            "{}",
            volume / exact
        );
        for p in &ring.positions {
            let way = *p - tie.center;
            assert!(way.dot(tie.axis).abs() <= 0.42 * tie.radius_m + 1e-6);
        }
    }

    #[test]
    fn a_band_fits_the_hair_in_it() {
        let tie = tie(TieKind::Band);
        let band = tie.mesh();
        // 2 pi R times the section's area.
        let radius = f64::from(tie.radius_m);
        let section = std::f64::consts::PI * f64::from(BAND_LENGTH * BAND_THICKNESS);
        let exact = 2.0 * std::f64::consts::PI * section * radius.powi(3);
        let volume = volume(&band, tie.center);
        assert!(
            (0.93..1.0).contains(&(volume / exact)),
            "{}",
            volume / exact
        );
        for p in &band.positions {
            let way = *p - tie.center;
            let from_axis = (way - tie.axis * way.dot(tie.axis)).length() / tie.radius_m;
            assert!((0.83..1.17).contains(&from_axis), "{from_axis}");
        }
    }

    #[test]
    fn all_ornaments_are_closed_and_face_outwards() {
        let shell = Shell::new(&[], &[], &[], Vec3::new(0.0, 1.5, 0.0), 0.24);
        let place = |longitude, latitude| Place {
            longitude,
            latitude,
        };
        let accessory = |kind| Accessory {
            kind,
            at: vec![place(90.0, 0.0), place(0.0, 70.0), place(-90.0, 0.0)],
            lift: 0.05,
            size: 0.1,
            turn: 30.0,
            mirror: false,
        };
        let accessories = [
            AccessoryKind::Clip,
            AccessoryKind::Bow,
            AccessoryKind::Hairband,
        ];
        let ties = [
            TieKind::Ring,
            TieKind::Band,
            TieKind::Scrunchie,
            TieKind::Bow,
            TieKind::Clip,
        ];
        let meshes = accessories
            .map(|kind| accessory(kind).mesh(-1.0, &shell))
            .into_iter()
            .chain(ties.map(|kind| tie(kind).mesh()));
        for (index, mesh) in meshes.enumerate() {
            assert!(is_closed(&mesh), "{index}");
            assert!(volume(&mesh, mesh.positions[0]) > 0.0, "{index}");
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
        }
    }
}
