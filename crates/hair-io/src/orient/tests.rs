use super::unit::UNITS;
use super::*;
use proptest::prelude::*;

/// Hair of a scalp of radius 0.093 m: Y up, the face towards +Z, hanging and combed back.
fn groom(center: Vec3) -> Strands {
    let mut strands = Strands::new();
    for i in 0..300 {
        let y = 1.0 - (i as f32 + 0.5) / 300.0 * 1.5;
        let angle = i as f32 * 2.399_963;
        let ring = (1.0 - y * y).sqrt();
        let out = Vec3::new(ring * angle.sin(), y, ring * angle.cos());
        if out.z > 0.35 && out.y < 0.6 {
            continue; // the face
        }
        let root = center + out * 0.093;
        let points: Vec<Vec3> = (0..8)
            .map(|k| root + (out * 0.3 + Vec3::new(0.0, -1.0, -0.4)) * (k as f32 * 0.02))
            .collect();
        strands.push(strands.len() as u32, &points, None).unwrap();
    }
    strands
}

/// The groom as a file of these axes and units has it.
fn as_file(strands: &Strands, up: Axes, scale: f32) -> Strands {
    let mut file = strands.clone();
    for p in file.points_mut() {
        *p = match up {
            Axes::Y => *p,
            Axes::Z => Vec3::new(p.x, -p.z, p.y),
        } / scale;
    }
    file
}

/// A ball of the groom's size on a neck and shoulders.
fn bust(center: Vec3) -> Mesh {
    let rings = [
        (0.094, 0.0),
        (0.085, 0.04),
        (0.06, 0.072),
        (0.03, 0.089),
        (0.0, 0.094),
        (-0.04, 0.085),
        (-0.08, 0.07),
        (-0.13, 0.05),
        (-0.16, 0.045),
        (-0.2, 0.045),
        (-0.23, 0.17),
        (-0.35, 0.15),
    ];
    let point = |ring: usize, step: usize| {
        let (y, radius): (f32, f32) = rings[ring];
        let angle = step as f32 / 24.0 * std::f32::consts::TAU;
        center + Vec3::new(radius * angle.sin(), y, radius * angle.cos())
    };
    let quads = (1..rings.len()).flat_map(|ring| (0..24).map(move |step| (ring, step)));
    Mesh::from_corners(quads.flat_map(|(ring, step)| {
        let [a, b] = [point(ring - 1, step), point(ring - 1, (step + 1) % 24)];
        let [c, d] = [point(ring, step), point(ring, (step + 1) % 24)];
        [[a, c, b], [b, c, d]]
    }))
}

#[test]
fn usual_axes_and_units_are_found_with_and_without_a_head() {
    for center in [
        Vec3::ZERO,
        Vec3::new(0.0, 1.56, 0.0),
        Vec3::new(0.2, 1.1, -0.3),
    ] {
        let (groom, head) = (groom(center), bust(center));
        for up in [Axes::Y, Axes::Z] {
            for (name, scale, _) in UNITS {
                let file = as_file(&groom, up, scale as f32);
                for mesh in [None, Some(&head)] {
                    let (found, note) = hair(&file, mesh, &Given::default());
                    let case = format!("{center} {up:?} {name} {}: {note}", mesh.is_some());
                    assert_eq!(
                        (found.up, found.scale, found.offset),
                        (up, scale as f32, Vec3::ZERO),
                        "{case}"
                    );
                    assert_eq!(
                        note,
                        format!(
                            "hair: {} strands, guessed {}, {name}",
                            groom.len(),
                            up.name()
                        )
                    );
                }
            }
        }
    }
}

#[test]
fn hair_beside_the_head_is_moved_onto_it() {
    let center = Vec3::new(0.0, 1.56, 0.02);
    let head = bust(center);
    for scale in [1.0, 0.01, 0.0037] {
        for up in [Axes::Y, Axes::Z] {
            let beside = as_file(&groom(Vec3::new(0.05, 0.4, 0.0)), up, scale);
            let (found, note) = hair(&beside, Some(&head), &Given::default());
            let expected = groom(center);
            let worst = beside
                .points()
                .iter()
                .zip(expected.points())
                .map(|(p, e)| found.apply(*p).distance(*e))
                .fold(0.0, f32::max);
            assert!(worst < 0.02, "{worst}: {note}");
            assert!(note.ends_with("m onto the head"), "{note}");
        }
    }
}

/// Hair of a larger head, in metres: a unit that nobody uses would have it as large as this one, and lower, over the eyes.
#[test]
fn hair_of_another_head_is_not_stretched() {
    let center = Vec3::new(0.0, 1.56, 0.0);
    let head = bust(center);
    for larger in [1.06, 1.1] {
        for lift in [0.0, 0.03] {
            let mut hair_of_another = groom(Vec3::ZERO);
            for p in hair_of_another.points_mut() {
                *p = *p * larger + center + Vec3::Y * lift;
            }
            let (found, note) = hair(&hair_of_another, Some(&head), &Given::default());
            assert_eq!(found.scale, 1.0, "{larger} {lift}: {note}");
        }
    }
}

#[test]
fn what_is_given_is_not_guessed() {
    let strands = groom(Vec3::Y);
    let given = Given {
        up: Some(Axes::Z),
        scale: Some(0.5),
        offset: Some(Vec3::X),
    };
    for head in [None, Some(&bust(Vec3::Y))] {
        let (found, note) = hair(&strands, head, &given);
        assert_eq!(
            found,
            Orientation {
                up: Axes::Z,
                scale: 0.5,
                offset: Vec3::X
            }
        );
        assert!(
            note.ends_with(
                "Z up, 5.0000e-1 m a unit as given, moved by (1.000, 0.000, 0.000) m as given"
            ),
            "{note}"
        );
    }
    let (_, note) = hair(
        &strands,
        None,
        &Given {
            up: Some(Axes::Y),
            ..Given::default()
        },
    );
    assert!(note.ends_with("Y up as given, guessed metres"), "{note}");
    assert_eq!(count(11400), "11,400");
    assert_eq!(count(999), "999");
    assert_eq!(count(1_000_000), "1,000,000");
}

#[test]
fn the_unit_of_a_bust_is_that_of_its_head() {
    let mesh = bust(Vec3::Y * 1.5);
    for (name, scale, _) in UNITS {
        let mut file = mesh.clone();
        file.positions.iter_mut().for_each(|p| *p /= scale as f32);
        let (found, note) = head(&file, &Given::default());
        assert_eq!(
            (found.up, found.scale),
            (Axes::Y, scale as f32),
            "{name}: {note}"
        );
    }
    let mut blender = mesh.clone();
    blender
        .positions
        .iter_mut()
        .for_each(|p| *p = Vec3::new(p.x, -p.z, p.y));
    assert_eq!(head(&blender, &Given::default()).0.up, Axes::Z);
}

proptest! {
    #[test]
    fn any_hair_gets_a_scale(
        roots in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0f32..1.0, Just(0.0), Just(3e38), Just(1e-44)]), 0..9),
    ) {
        let mut strands = Strands::new();
        for root in roots {
            strands.push(strands.len() as u32, &[Vec3::from(root)], None).unwrap();
        }
        for head in [None, Some(&bust(Vec3::ZERO)), Some(&Mesh::default())] {
            let (found, note) = hair(&strands, head, &Given::default());
            prop_assert!(found.scale > 0.0 && found.scale.is_finite(), "{note}");
        }
    }
}
