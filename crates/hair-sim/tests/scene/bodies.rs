use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, Params, Pose, Shape, SignedDistance, Solver, State, Strands, Surroundings, Wind,
};

use crate::{after, among, farthest, in_wind, params, run, shape, straight};

const BALL: Shape = Shape::Sphere {
    center: DVec3::ZERO,
    radius: 0.1,
};

/// How deep the deepest particle but the root is in the ball at `center`.
fn depth(solver: &Solver, state: &State, center: DVec3) -> f64 {
    (solver.points(state, 0).skip(1))
        .map(|p| 0.101 - (p - center).length())
        .fold(0.0, f64::max)
}

#[test]
fn hair_lies_on_a_ball() {
    let ball = Collider::fixed(BALL, Pose::IDENTITY);
    let capsule = Collider::fixed(
        Shape::Capsule {
            from: DVec3::ZERO,
            to: DVec3::new(0.0, 0.0, 1e-9),
            radius: 0.1,
        },
        Pose::IDENTITY,
    );
    let mut shapes = Vec::new();
    for collider in [ball, capsule] {
        // Falls from beside the pole.
        let rest = straight(Vec3::new(0.0, 0.102, 0.0), Vec3::new(1.0, 0.0, 0.0));
        let (mut solver, mut state) = Solver::new(&rest, &params(200.0)).unwrap();
        let colliders = [collider];
        let surroundings = among(&colliders);
        let (mut contacts, mut deepest) = (0, 0.0_f64);
        for _ in 0..240 {
            contacts += solver
                .step(&mut state, &surroundings, 1.0 / 24.0)
                .unwrap()
                .contacts;
            deepest = deepest.max(depth(&solver, &state, DVec3::ZERO));
        }
        println!(
            "deepest {deepest:.1e}, at rest {:.1e}",
            depth(&solver, &state, DVec3::ZERO)
        );
        assert!(contacts > 1000, "{contacts}");
        assert!(deepest < 2e-3, "{deepest}");
        assert!(depth(&solver, &state, DVec3::ZERO) < 2e-4);
        shapes.push(shape(&solver, &state));
    }
    assert!(farthest(&shapes[0], &shapes[1]) < 1e-3);
}

/// Each strand goes by the body that it meets, whichever number that has, and whatever others there are.
#[test]
fn bodies_that_a_strand_cannot_meet_leave_it_its_bits() {
    const COUNT: usize = 9;
    let place = |i: usize| DVec3::X * 3.0 * i as f64;
    let mut rest = Strands::new();
    for i in 0..COUNT {
        let root = place(i).as_vec3() + Vec3::new(0.01, 0.102, 0.0);
        let points: Vec<Vec3> = (0..=20)
            .map(|k| root + Vec3::X * 0.015 * k as f32)
            .collect();
        rest.push(i as u32, &points, None).unwrap();
    }
    let ball = |i: usize| {
        let translation = place(i);
        Collider::fixed(
            BALL,
            Pose {
                translation,
                ..Pose::IDENTITY
            },
        )
    };
    let fall = |colliders: &[Collider]| {
        let (mut solver, mut state) = Solver::new(&rest, &params(200.0)).unwrap();
        run(&mut solver, &mut state, &among(colliders), 1.0 / 60.0, 40);
        let tip = |i: usize| solver.points(&state, i).last().unwrap();
        (0..COUNT).map(tip).collect::<Vec<DVec3>>()
    };
    let all: Vec<Collider> = (0..COUNT).map(ball).collect();
    let (among_all, alone) = (fall(&all), fall(&[]));
    for i in 0..COUNT {
        let own = fall(&[ball(i)])[i];
        assert_eq!(among_all[i], own, "{i}");
        assert!((own - alone[i]).length() > 0.01, "{i}");
    }
}

#[test]
fn a_body_that_goes_lets_hair_go_at_once() {
    let rest = straight(Vec3::new(0.0, 0.102, 0.0), Vec3::X);
    let (mut solver, mut beside) = Solver::new(&rest, &params(200.0)).unwrap();
    let lies = [Collider::fixed(BALL, Pose::IDENTITY)];
    run(&mut solver, &mut beside, &among(&lies), 1.0 / 60.0, 240);
    let mut alone = beside.clone();
    // Away from under the hair at 1 m/s: faster than the hair falls.
    let goes = [Collider {
        now: Pose {
            translation: DVec3::NEG_Y / 60.0,
            ..Pose::IDENTITY
        },
        ..lies[0]
    }];
    run(&mut solver, &mut beside, &among(&goes), 1.0 / 60.0, 1);
    run(
        &mut solver,
        &mut alone,
        &Surroundings::default(),
        1.0 / 60.0,
        1,
    );
    let top = |shape: Vec<DVec3>| shape[1..5].to_vec();
    let apart = farthest(&top(shape(&solver, &beside)), &top(shape(&solver, &alone)));
    assert!(apart < 1e-5, "{apart}");
}

#[test]
fn a_mesh_is_as_the_ball_that_it_shows() {
    let (points, triangles) = mesh();
    let grid = SignedDistance::new(&points, &triangles, 0.004).unwrap();
    let [ball, mesh] = [BALL, Shape::Grid(&grid)].map(|shape| {
        let rest = straight(Vec3::new(0.0, 0.102, 0.0), Vec3::X);
        let colliders = [Collider::fixed(shape, Pose::IDENTITY)];
        after(&rest, &params(200.0), &among(&colliders), 1.0 / 24.0, 240)
    });
    let error = farthest(&ball, &mesh);
    assert!(error < 3e-3, "{error}");
}

/// A grid ends three cells from its mesh. Hair that keeps about as far away goes by there as it does in the open.
#[test]
fn nothing_holds_hair_where_a_grid_ends() {
    // A board of which the far end is as far away as hair reaches.
    let (points, triangles) = block(Vec3::new(0.06, 0.15, 0.15));
    let grid = SignedDistance::new(&points, &triangles, 0.004).unwrap();
    let rest = straight(Vec3::new(-0.0715, 0.1, 0.0), Vec3::NEG_Y);
    let strand = Params {
        thickness: 0.01,
        ..params(30.0)
    };
    let gale = in_wind(Wind {
        steady: DVec3::NEG_X * 4.0,
        ..Wind::default()
    });
    let beside = [Collider::fixed(Shape::Grid(&grid), Pose::IDENTITY)];
    for steps in [6, 12, 24] {
        let [open, beside] = [&[][..], &beside].map(|colliders| {
            let surroundings = Surroundings { colliders, ..gale };
            after(&rest, &strand, &surroundings, 1.0 / 60.0, steps)
        });
        let way = farthest(&open, &after(&rest, &strand, &gale, 1.0 / 60.0, 1));
        let apart = farthest(&open, &beside);
        println!("blown {way:.3} m away from a mesh: {apart:.1e} m from where it is without");
        assert!(way > 0.005 && apart < 1e-4, "{way} {apart}");
    }
}

/// What comes over a strand, past its own middle, has all of it come out in front, where the root is: in part on the other side it would hang for good.
#[test]
fn what_a_wall_swallows_comes_out_where_it_went_in() {
    let (points, triangles) = block(Vec3::new(0.1, 0.5, 0.5));
    let grid = SignedDistance::new(&points, &triangles, 0.01).unwrap();
    let at = |x: f64| Pose {
        translation: DVec3::X * x,
        ..Pose::IDENTITY
    };
    // The first body is the figure's.
    let figure = Collider::fixed(BALL, at(-10.0));
    let rest = straight(Vec3::new(-0.005, 0.0, 0.0), Vec3::X);
    for rate in [24.0, 60.0] {
        let (mut solver, mut state) = Solver::new(&rest, &params(200.0)).unwrap();
        let place = at(0.1);
        let wall = |pose| [figure, Collider::fixed(Shape::Grid(&grid), pose)];
        let mut go = |pose, seconds: f64| {
            let colliders = wall(pose);
            let steps = (seconds * rate) as usize;
            run(
                &mut solver,
                &mut state,
                &among(&colliders),
                1.0 / rate,
                steps,
            );
            shape(&solver, &state)
        };
        let before = go(at(10.0), 1.0 / rate);
        assert!(before[20].x > 0.19, "{}", before[20]);
        let after = go(place, 2.0);
        let farthest = after.iter().map(|at| at.x).fold(f64::MIN, f64::max);
        println!("1/{rate} s: {:.1} mm past the front", farthest * 1e3);
        assert!(farthest < 2e-3, "{farthest}");
    }
}

/// A mesh of so much to either side of its middle, m.
fn block(half: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |i: u32| {
        let side = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        half * Vec3::new(side(1), side(2), side(4))
    };
    let walls = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let triangles = walls.into_iter().flat_map(halves).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn mesh() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (rings, around) = (40_u32, 80_u32);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=rings {
        let polar = std::f32::consts::PI * i as f32 / rings as f32;
        for j in 0..around {
            let angle = std::f32::consts::TAU * j as f32 / around as f32;
            let level = polar.sin();
            points.push(Vec3::new(level * angle.cos(), polar.cos(), level * angle.sin()) * 0.1);
            if i < rings {
                let (a, b) = (i * around + j, i * around + (j + 1) % around);
                triangles.push([a, b, b + around]);
                triangles.push([a, b + around, a + around]);
            }
        }
    }
    (points, triangles)
}

#[test]
fn a_fast_ball_does_not_pass_through() {
    // 20 m/s: 0.83 m in a frame, eight times its radius. It flies past the root and takes the strand along.
    let rest = straight(Vec3::new(0.0, 0.25, 0.0), Vec3::NEG_Y);
    let (mut solver, mut state) = Solver::new(&rest, &params(20.0)).unwrap();
    let place = |i: i32| Pose {
        rotation: DQuat::IDENTITY,
        translation: DVec3::new(-1.0 + f64::from(i) * 20.0 / 24.0, 0.0, 0.0),
    };
    for i in 0..2 {
        let colliders = [Collider {
            shape: BALL,
            before: place(i),
            now: place(i + 1),
            was: None,
        }];
        let surroundings = among(&colliders);
        solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        // All that the ball swept is in front of it, or was pushed over it.
        let center = place(i + 1).translation;
        let points = shape(&solver, &state);
        for p in &points[1..] {
            let behind = p.x < center.x && p.y.abs() < 0.05 && i == 1;
            assert!(!behind, "frame {i}: {p} is behind the ball at {center}");
        }
    }
}

#[test]
fn friction_holds_what_slides_without_it() {
    // On the shoulder of a large ball: a slope of about 20 degrees.
    let slide = |friction: f64| {
        let large = Shape::Sphere {
            center: DVec3::new(0.0, -2.0, 0.0),
            radius: 2.0,
        };
        let p = Params {
            friction,
            drag: 0.5,
            ..params(400.0)
        };
        let rest = straight(Vec3::new(0.0, 0.003, 0.0), Vec3::Z);
        let (mut solver, mut state) = Solver::new(&rest, &p).unwrap();
        let colliders = [Collider::fixed(large, Pose::IDENTITY)];
        let mut surroundings = among(&colliders);
        run(&mut solver, &mut state, &surroundings, 1.0 / 60.0, 60);
        let before = shape(&solver, &state);
        surroundings.gravity.x = 2.0;
        run(&mut solver, &mut state, &surroundings, 1.0 / 60.0, 60);
        farthest(&before, &shape(&solver, &state))
    };
    let (smooth, rough) = (slide(0.0), slide(1.0));
    println!("slides {smooth:.4} m without friction, {rough:.4} m with");
    assert!(smooth > 0.05, "{smooth}");
    assert!(rough < 0.005, "{rough}");
}

#[test]
fn a_style_that_starts_inside_a_body_stays_where_it_is() {
    let p = Params {
        natural: hair_sim::Natural::Balanced,
        ..params(5.0)
    };
    // From inside the ball outwards.
    let rest = straight(Vec3::new(0.0, 0.08, 0.0), Vec3::new(0.6, 0.8, 0.0));
    let (mut solver, mut state) = Solver::new(&rest, &p).unwrap();
    let before = shape(&solver, &state);
    let colliders = [Collider::fixed(BALL, Pose::IDENTITY)];
    let surroundings = among(&colliders);
    run(&mut solver, &mut state, &surroundings, 1.0 / 24.0, 240);
    let moved = farthest(&before, &shape(&solver, &state));
    assert!(moved < 1e-9, "{moved}");
}

/// Straight through a wall, from one side of it to the other, and on a windy day.
#[test]
fn a_style_that_goes_through_a_wall_stays_in_it() {
    let (points, triangles) = block(Vec3::new(0.05, 0.5, 0.5));
    let grid = SignedDistance::new(&points, &triangles, 0.01).unwrap();
    let figure = Collider::fixed(
        BALL,
        Pose {
            translation: DVec3::X * -10.0,
            ..Pose::IDENTITY
        },
    );
    let colliders = [figure, Collider::fixed(Shape::Grid(&grid), Pose::IDENTITY)];
    let p = Params {
        natural: hair_sim::Natural::Balanced,
        ..params(5.0)
    };
    let rest = straight(Vec3::new(-0.1, 0.0, 0.0), Vec3::X);
    for steady in [-0.3, 0.3] {
        let (mut solver, mut state) = Solver::new(&rest, &p).unwrap();
        let before = shape(&solver, &state);
        let surroundings = Surroundings {
            colliders: &colliders,
            ..in_wind(Wind {
                steady: DVec3::new(steady, 0.0, 0.05),
                ..Wind::default()
            })
        };
        run(&mut solver, &mut state, &surroundings, 1.0 / 24.0, 240);
        let moved = farthest(&before, &shape(&solver, &state));
        println!("moved by {:.1} mm", moved * 1e3);
        assert!(moved < 1e-3, "{moved}");
    }
}

#[test]
fn what_sticks_does_not_creep() {
    // As above, on for a minute: what friction holds comes to rest.
    let large = Shape::Sphere {
        center: DVec3::new(0.0, -2.0, 0.0),
        radius: 2.0,
    };
    let colliders = [Collider::fixed(large, Pose::IDENTITY)];
    let p = Params {
        friction: 0.5,
        ..params(400.0)
    };
    let rest = straight(Vec3::new(0.0, 0.002, 0.0), Vec3::X);
    let (mut solver, mut state) = Solver::new(&rest, &p).unwrap();
    let mut surroundings = among(&colliders);
    surroundings.gravity.z = 0.2 * 9.81;
    let mut go_on = |seconds: usize| {
        run(
            &mut solver,
            &mut state,
            &surroundings,
            1.0 / 60.0,
            60 * seconds,
        );
        shape(&solver, &state)
    };
    let (early, late) = (go_on(5), go_on(55));
    let crept = farthest(&early, &late);
    println!("crept {crept:.1e} m in 55 s");
    assert!(crept < 1e-4, "{crept}");
}

#[test]
fn friction_acts_from_the_first_touch() {
    // A strand falls on a slope: how far it has gone to the side soon after.
    let slid = |friction: f64, rate: usize| {
        let large = Shape::Sphere {
            center: DVec3::new(0.0, -2.0, 0.0),
            radius: 2.0,
        };
        let colliders = [Collider::fixed(large, Pose::IDENTITY)];
        let p = Params {
            friction,
            ..params(400.0)
        };
        let rest = straight(Vec3::new(0.0, 0.006, 0.0), Vec3::X);
        let mut surroundings = among(&colliders);
        surroundings.gravity.z = 4.0;
        let end = after(&rest, &p, &surroundings, 1.0 / rate as f64, rate / 6);
        end.last().unwrap().z
    };
    let exact = slid(0.3, 1920);
    for rate in [24, 60, 120] {
        let [smooth, rough] = [0.0, 0.3].map(|friction| slid(friction, rate));
        println!(
            "1/{rate} s: {smooth:.4} m without friction, {rough:.4} with, {exact:.4} in fine steps"
        );
        let error = (rough - exact).abs();
        assert!(error < 0.3 * (smooth - exact), "1/{rate} s: {error}");
    }
}

/// How deep hair that has fallen on a body is in it at most while that goes from share 0 to 1 of its way, and how high above its root it comes, m.
fn lifted<'a>(rate: f64, seconds: f64, body: &dyn Fn(f64, f64) -> Collider<'a>) -> (f64, f64) {
    let rest = straight(Vec3::new(-0.1, 0.031, 0.0), Vec3::X);
    let (mut solver, mut state) = Solver::new(&rest, &params(200.0)).unwrap();
    let dt = 1.0 / rate;
    let at = |time: f64| (time / seconds).clamp(0.0, 1.0);
    let (mut time, mut deepest, mut highest) = (0.0, 0.0_f64, 0.0_f64);
    let start = [body(0.0, 0.0)];
    run(&mut solver, &mut state, &among(&start), dt, 200);
    while time < seconds + 0.5 {
        let bodies = [body(at(time), at(time + dt))];
        run(&mut solver, &mut state, &among(&bodies), dt, 1);
        time += dt;
        for point in &shape(&solver, &state)[1..] {
            deepest = deepest.max(-bodies[0].distance(*point));
            highest = highest.max(point.y - 0.031);
        }
    }
    (deepest, highest)
}

#[test]
fn hair_moves_with_a_body_that_changes_its_shape() {
    let wall = |half: f32| {
        let side = |i: u32, bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        let corner = |i: u32| {
            let y = if i & 2 == 0 { -0.1 } else { half };
            Vec3::new(0.3 * side(i, 1), y, 0.3 * side(i, 4))
        };
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let points: Vec<Vec3> = (0..8).map(corner).collect();
        let triangles: Vec<[u32; 3]> = faces
            .iter()
            .flat_map(|f: &[u32; 4]| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])
            .collect();
        SignedDistance::new(&points, &triangles, 0.02).unwrap()
    };
    let (low, high) = (wall(0.0), wall(0.03));
    type Shapes<'a> = Box<dyn Fn(f64) -> Shape<'a> + 'a>;
    let mesh: Shapes = Box::new(|share| Shape::Form {
        from: &low,
        to: &high,
        share,
        size: 1.0,
    });
    // As high under the strand as the mesh.
    let ball: Shapes = Box::new(|share| Shape::Sphere {
        center: DVec3::NEG_Y * 4.0,
        radius: 4.0 + 0.03 * share,
    });
    // Slowly, and at 0.3 m/s, which throws it.
    for (name, shape_at) in [("mesh", mesh), ("ball", ball)] {
        for (rate, seconds) in [(60.0, 0.5), (24.0, 0.5), (60.0, 0.1), (24.0, 0.1)] {
            let (deepest, highest) = lifted(rate, seconds, &|before, now| Collider {
                was: Some(shape_at(before)),
                ..Collider::fixed(shape_at(now), Pose::IDENTITY)
            });
            // One that moves as a whole.
            let pose = |share: f64| Pose {
                translation: DVec3::Y * (0.03 * share),
                ..Pose::IDENTITY
            };
            let (_, known) = lifted(rate, seconds, &|before, now| Collider {
                before: pose(before),
                ..Collider::fixed(shape_at(0.0), pose(now))
            });
            println!(
                "{name} in {seconds} s, {rate} steps a second: {deepest:.1e} m in it, {highest:.1e} m above, {known:.1e} above one that moves as a whole"
            );
            assert!(deepest < 1e-3, "{name}: {deepest}");
            // In two steps it is thrown in one way or the other.
            let steps = rate * seconds;
            assert!(
                steps < 3.0 || highest < 1.2 * known + 1e-3,
                "{name}: {highest} of {known}"
            );
        }
    }
}
