//! What a style's zones grow, on the bust.

use glam::Vec3;
use groom::{
    Drawn, Edit, Form, Grown, Line, MOST_CLUMPS, Place, Scalp, Shell, Style, Taper, TieKind, Zone,
    bust, grow,
};
use proptest::prelude::*;
use std::sync::LazyLock;

const HEIGHT: f32 = 0.24;

static SHELL: LazyLock<Shell> = LazyLock::new(|| {
    let bust = bust();
    Shell::new(
        &bust.positions,
        &bust.normals,
        &bust.triangles,
        Vec3::new(0.0, 1.5, 0.0),
        HEIGHT,
    )
});

fn place(longitude: f32, latitude: f32) -> Place {
    Place {
        longitude,
        latitude,
    }
}

/// Six equal clumps from the crown to the brow.
fn plain() -> Zone {
    Zone {
        name: "zone".to_owned(),
        form: Form::Rows,
        count: 6,
        rows: 1,
        roots: Line::Through(vec![place(-40.0, 60.0), place(40.0, 60.0)]),
        tips: Some(Line::Through(vec![place(-50.0, 0.0), place(50.0, 0.0)])),
        mirror: false,
        across: 0.0,
        bow: 0.0,
        root_lift: 0.02,
        lift: 0.08,
        tip_lift: 0.03,
        lift_variation: 0.0,
        held: 0.5,
        hang: 0.0,
        length_variation: 0.0,
        weight: 0.5,
        spread: 0.0,
        sway: 0.12,
        flick: 0.0,
        curl: 0.0,
        curl_length: 0.5,
        curl_flatness: 0.0,
        fullness: 0.15,
        tie: 0.0,
        tie_kind: TieKind::Ring,
        points: 10,
        low_tie: 0.0,
        low_tie_size: 0.05,
        size: None,
        overlap: 1.5,
        mixed_sizes: 0.0,
        scatter: 0.0,
        sweep: 0.0,
        s_curve: 0.0,
        swell: 0.3,
        groups: 0,
        gather: 0.7,
        peak: 0.3,
        cut: None,
        taper: Taper::default(),
    }
}

fn style(zones: Vec<Zone>) -> Style {
    Style {
        seed: 1,
        scalp: Scalp::default(),
        undercoat: false,
        cap: 0.05,
        coat: 0,
        zones,
        edits: Vec::new(),
        drawn: Vec::new(),
        accessories: Vec::new(),
    }
}

fn grown(zone: Zone) -> Grown {
    grow(&style(vec![zone]), &SHELL)
}

fn length(points: &[Vec3]) -> f32 {
    points.windows(2).map(|p| p[0].distance(p[1])).sum()
}

fn lift(point: Vec3) -> f32 {
    SHELL.lift_of(point).0
}

#[test]
fn a_row_leads_from_its_roots_to_its_tips_at_its_heights() {
    let hair = grown(plain()).strands;
    assert_eq!(hair.len(), 6);
    for points in hair.iter() {
        assert!((lift(points[0]) - 0.02).abs() < 1e-3);
        assert!((lift(points[points.len() - 1]) - 0.03).abs() < 1e-3);
        let highest = points.iter().map(|p| lift(*p)).fold(0.0, f32::max);
        assert!((0.07..=0.081).contains(&highest), "{highest}");
    }
    // Evenly from the character's right to the left.
    let roots: Vec<f32> = hair.roots().map(|p| p.x).collect();
    assert!(roots.is_sorted());
    assert!((roots[0] + roots[5]).abs() < 0.002);
}

#[test]
fn hair_is_held_for_its_share_of_the_way_and_wholly_in_a_tie() {
    let held = |zone: Zone| grown(zone).held[0];
    let zone = Zone {
        hang: 0.5,
        ..plain()
    };
    assert_eq!(
        held(Zone {
            held: 0.0,
            ..zone.clone()
        }),
        1
    );
    assert_eq!(
        held(Zone {
            held: 1.0,
            ..zone.clone()
        }),
        8
    );
    let tips = Some(Line::Through(vec![place(0.0, 0.0)]));
    assert_eq!(
        held(Zone {
            held: 0.0,
            tips,
            ..zone
        }),
        8
    );
}

#[test]
fn widths_cover_the_row_as_often_as_overlap_says() {
    // At the widest place of equal clumps of a row, neighbours are a width / overlap apart.
    for overlap in [1.0, 2.5] {
        let hair = grown(Zone {
            overlap,
            count: 12,
            ..plain()
        })
        .strands;
        let middle = |i: usize| hair.strand(i)[3];
        let apart = middle(6).distance(middle(5)) / HEIGHT * 300.0;
        let width = 2.0 * hair.size(5).unwrap();
        assert!(
            (width / apart / overlap - 1.0).abs() < 0.2,
            "{width} {apart}"
        );
    }
}

#[test]
fn bigger_clumps_take_more_of_the_row() {
    let hair = grown(Zone {
        count: 9,
        mixed_sizes: 0.8,
        ..plain()
    })
    .strands;
    let sizes: Vec<f32> = (0..9).map(|i| hair.size(i).unwrap()).collect();
    let classes = [0.42, 0.7, 1.0].map(|class| {
        let whole = sizes.iter().fold(0.0_f32, |a, b| a.max(*b));
        sizes
            .iter()
            .filter(|size| (**size / whole - class).abs() < 0.13)
            .count()
    });
    assert!(
        classes.iter().all(|n| *n > 0),
        "three size classes: {sizes:?}"
    );
    let apart = |i: usize| hair.strand(i)[0].distance(hair.strand(i + 1)[0]);
    for i in 0..7 {
        let (a, b) = (sizes[i] + sizes[i + 1], sizes[i + 1] + sizes[i + 2]);
        if a > 1.15 * b {
            assert!(apart(i) > apart(i + 1), "{i}: {sizes:?}");
        }
    }
}

#[test]
fn lower_rows_start_nearer_the_tips_and_lie_below() {
    let hair = grown(Zone { rows: 3, ..plain() }).strands;
    assert_eq!(hair.len(), 18);
    let height_at = |row: usize, y: f32| {
        let points = hair.strand(row * 6 + 3);
        let nearest = points
            .iter()
            .min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs()));
        lift(*nearest.unwrap())
    };
    for row in 1..3 {
        assert!(hair.strand(row * 6 + 3)[0].y < hair.strand((row - 1) * 6 + 3)[0].y);
        let y = hair.strand(row * 6 + 3)[2].y;
        assert!(height_at(row, y) < height_at(row - 1, y));
    }
}

#[test]
fn mirrored_halves_are_images_with_variations_of_their_own() {
    let zone = Zone {
        mirror: true,
        roots: Line::Through(vec![place(30.0, 50.0), place(120.0, 40.0)]),
        tips: Some(Line::Through(vec![place(40.0, 0.0), place(150.0, -10.0)])),
        bow: 12.0,
        hang: 0.5,
        curl: 0.02,
        ..plain()
    };
    let hair = grown(zone.clone()).strands;
    assert_eq!(hair.len(), 12);
    let image = |p: Vec3| p * Vec3::new(-1.0, 1.0, 1.0);
    for i in 0..6 {
        let (left, right) = (hair.strand(i), hair.strand(i + 6));
        assert_eq!(hair.id(i + 6), hair.id(i) + MOST_CLUMPS);
        for (a, b) in left.iter().zip(right).take(8) {
            assert!(a.distance(image(*b)) < 0.01, "{a} {b}");
        }
    }
    let varied = grown(Zone {
        scatter: 4.0,
        ..zone
    })
    .strands;
    assert!(varied.strand(0)[0].distance(image(varied.strand(6)[0])) > 0.001);
}

#[test]
fn hair_hangs_as_long_as_it_is_told_and_outside_the_body() {
    let hair = grown(Zone {
        roots: Line::Hairline {
            from: 110.0,
            to: 250.0,
        },
        tips: None,
        hang: 2.0,
        ..plain()
    })
    .strands;
    for points in hair.iter() {
        assert!((length(points) / HEIGHT - 2.0).abs() < 0.12);
        for pair in points.windows(2) {
            let middle = (pair[0] + pair[1]) * 0.5;
            assert!(SHELL.keep_out(middle, 0.0).distance(middle) < 0.005);
        }
    }
}

#[test]
fn curls_turn_around_the_hair_they_are_made_of() {
    let zone = Zone {
        count: 1,
        tips: None,
        hang: 2.0,
        weight: 0.9,
        spread: 0.6,
        ..plain()
    };
    let straight = grown(zone.clone()).strands;
    let curled = grown(Zone {
        curl: 0.1,
        curl_length: 0.4,
        ..zone
    })
    .strands;
    let (line, points) = (straight.strand(0), curled.strand(0));
    assert!(points.len() >= 5 * 8, "enough points for five turns");
    // In the lower half the curl has its radius.
    let distance = |p: Vec3| {
        line.windows(2)
            .map(|ends| {
                let way = ends[1] - ends[0];
                let t = ((p - ends[0]).dot(way) / way.length_squared()).clamp(0.0, 1.0);
                p.distance(ends[0] + way * t)
            })
            .fold(f32::MAX, f32::min)
    };
    for p in &points[points.len() / 2..points.len() - 2] {
        assert!((distance(*p) / HEIGHT - 0.1).abs() < 0.02);
    }
}

#[test]
fn a_bun_is_a_ball_above_its_tie() {
    let zone = Zone {
        form: Form::Bun,
        roots: Line::Through(vec![place(180.0, 50.0)]),
        fullness: 0.2,
        tie: 0.1,
        ..plain()
    };
    let bun = grown(zone);
    assert_eq!(bun.ties.len(), 1);
    assert!((bun.ties[0].radius_m - 0.1 * HEIGHT).abs() < 1e-6);
    let all: Vec<Vec3> = bun.strands.iter().flatten().copied().collect();
    let middle = all.iter().sum::<Vec3>() / all.len() as f32;
    for p in all {
        let radius = p.distance(middle) / HEIGHT;
        assert!((0.1..0.3).contains(&radius), "{radius}");
        assert!(lift(p) > -0.02);
    }
    // All of it stays with the head.
    let counts = bun.strands.iter().map(|points| points.len() as u32);
    assert!(bun.held.iter().copied().eq(counts));
}

#[test]
fn the_plaits_of_a_braid_change_places() {
    let hair = grown(Zone {
        form: Form::Braid,
        count: 3,
        roots: Line::Through(vec![place(180.0, 0.0)]),
        root_lift: 0.1,
        hang: 2.0,
        spread: 0.5,
        curl_length: 0.5,
        fullness: 0.1,
        ..plain()
    })
    .strands;
    let most_left = |point: usize| {
        (0..3)
            .max_by(|a, b| {
                hair.strand(*a)[point]
                    .x
                    .total_cmp(&hair.strand(*b)[point].x)
            })
            .unwrap()
    };
    let order: Vec<usize> = (4..24).map(most_left).collect();
    for plait in 0..3 {
        assert!(order.contains(&plait), "{order:?}");
    }
}

#[test]
fn clumps_are_edited_one_by_one() {
    let zone = Zone {
        hang: 0.5,
        ..plain()
    };
    let before = grown(zone.clone()).strands;
    let edit = |clump| Edit {
        zone: "zone".to_owned(),
        clump,
        mirrored: false,
        remove: false,
        size: 1.0,
        length: 1.0,
        turn: [0.0, 0.0],
        raise: 0.0,
    };
    let mut edited = style(vec![zone]);
    edited.edits = vec![
        Edit {
            remove: true,
            ..edit(0)
        },
        Edit {
            size: 2.0,
            length: 1.5,
            ..edit(2)
        },
        Edit {
            turn: [90.0, 0.0],
            ..edit(3)
        },
    ];
    edited.drawn = vec![Drawn {
        points: vec![(place(0.0, 80.0), 0.0), (place(0.0, 40.0), 0.2)],
        size: 7.0,
        mirror: true,
    }];
    let after = grow(&edited, &SHELL).strands;
    assert_eq!(after.len(), 6 - 1 + 2);
    let by_id = |id| (0..after.len()).find(|i| after.id(*i) == id);
    assert_eq!(by_id(before.id(0)), None);
    // Whatever is not edited keeps its every bit.
    for i in [1, 4, 5] {
        let same = by_id(before.id(i)).unwrap();
        assert_eq!(after.strand(same), before.strand(i));
    }
    let longer = by_id(before.id(2)).unwrap();
    assert_eq!(after.size(longer).unwrap(), 2.0 * before.size(2).unwrap());
    let grew = length(after.strand(longer)) - length(before.strand(2));
    assert!((grew / HEIGHT - 0.25).abs() < 0.03, "{grew}");
    let turned = by_id(before.id(3)).unwrap();
    let (from, to) = (before.strand(3)[4], after.strand(turned)[4]);
    let center = SHELL.center();
    assert!(((to - center).x - (from - center).z).abs() < 1e-6);
    assert!((lift(after.strand(0)[1]) - 0.2).abs() < 1e-3);
}

#[test]
fn a_zone_keeps_its_clumps_when_others_change() {
    let other = |count| Zone {
        name: "other".to_owned(),
        count,
        scatter: 3.0,
        ..plain()
    };
    let zone = Zone {
        scatter: 3.0,
        mixed_sizes: 0.5,
        ..plain()
    };
    let few = grow(&style(vec![other(2), zone.clone()]), &SHELL).strands;
    let many = grow(&style(vec![other(5), zone]), &SHELL).strands;
    for i in 0..6 {
        assert_eq!(few.strand(2 + i), many.strand(5 + i));
        assert_eq!(few.id(2 + i), many.id(5 + i));
    }
}

#[test]
fn the_undercoat_lies_below_its_cap_and_leaves_the_face_free() {
    for cap in [0.0, 0.05] {
        let bare = Style {
            undercoat: true,
            cap,
            ..style(Vec::new())
        };
        let grown = grow(&bare, &SHELL);
        let coat = grown.strands;
        assert!(coat.len() > 50);
        assert_eq!(grown.undercoat, coat.len());
        let mut highest = f32::NEG_INFINITY;
        for (index, points) in coat.iter().enumerate() {
            let radius = coat.size(index).unwrap() / 300.0;
            for p in points {
                highest = highest.max(lift(*p) + 0.35 * radius);
                assert!(
                    lift(*p) > -radius && bare.scalp.contains(SHELL.place(*p)),
                    "{p}"
                );
            }
        }
        assert!((highest - cap).abs() < 0.005, "{highest} for {cap}");
    }
}

fn number(low: f32, high: f32) -> impl Strategy<Value = f32> {
    prop_oneof![4 => low..=high, 1 => Just(low), 1 => Just(high)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever a style says within its ranges, hair is made of finite points and sizes, the same ones
    /// every time.
    #[test]
    fn extremes_grow_finite_hair(
        form in 0..4_usize,
        count in 1..12_u32,
        rows in 1..4_u32,
        places in prop::collection::vec((number(-360.0, 360.0), number(-90.0, 90.0)), 1..4),
        tips in prop::collection::vec((number(-360.0, 360.0), number(-90.0, 90.0)), 0..4),
        lifts in [number(-0.2, 1.0), number(0.0, 1.0), number(0.0, 1.0)],
        hang in [number(0.0, 20.0), number(0.0, 1.0), number(-2.0, 2.0), number(-4.0, 4.0)],
        curl in [number(0.0, 1.0), number(0.02, 10.0), number(0.0, 1.0)],
        full in [number(0.0, 2.0), number(0.0, 1.0), number(0.1, 10.0)],
        turned in [number(-90.0, 90.0), number(-60.0, 60.0), number(0.0, 45.0)],
    ) {
        let line = |places: &[(f32, f32)]| {
            Line::Through(places.iter().map(|(lon, lat)| place(*lon, *lat)).collect())
        };
        let zone = Zone {
            form: [Form::Rows, Form::Tail, Form::Bun, Form::Braid][form],
            count,
            rows,
            roots: line(&places),
            tips: (!tips.is_empty()).then(|| line(&tips)),
            mirror: true,
            across: turned[0],
            bow: turned[1],
            scatter: turned[2],
            root_lift: lifts[0],
            lift: lifts[1],
            tip_lift: lifts[2],
            lift_variation: 1.0,
            hang: hang[0],
            weight: hang[1],
            spread: hang[2],
            flick: hang[3],
            length_variation: 1.0,
            curl: curl[0],
            curl_length: curl[1],
            curl_flatness: curl[2],
            fullness: full[0],
            tie: full[1],
            overlap: full[2],
            mixed_sizes: 1.0,
            ..plain()
        };
        let once = grown(zone.clone());
        let clumps = if form == 0 { count * rows } else { count };
        prop_assert_eq!(once.strands.len(), 2 * clumps as usize);
        prop_assert_eq!(once.held.len(), once.strands.len());
        for (index, points) in once.strands.iter().enumerate() {
            prop_assert!(points.len() <= 400);
            prop_assert!(once.held[index] as usize <= points.len());
            for p in points {
                prop_assert!(p.is_finite() && p.distance(SHELL.center()) < 50.0 * HEIGHT);
            }
        }
        prop_assert_eq!(once, grown(zone));
    }
}

/// Distances between the tips of neighbours, head heights.
fn gaps(hair: &hair_sim::Strands) -> Vec<f32> {
    let tips: Vec<Vec3> = hair.iter().map(|points| points[points.len() - 1]).collect();
    let gap = |pair: &[Vec3]| pair[0].distance(pair[1]) / HEIGHT;
    tips.windows(2).map(gap).collect()
}

#[test]
fn clumps_of_a_group_come_together() {
    for hang in [0.0, 0.8] {
        let zone = Zone {
            count: 12,
            hang,
            sway: 0.0,
            peak: 0.0,
            ..plain()
        };
        let apart = gaps(&grown(zone.clone()).strands);
        let grouped = Zone {
            groups: 3,
            gather: 1.0,
            ..zone.clone()
        };
        let hair = grown(grouped).strands;
        let together = gaps(&hair);
        // 12 clumps in 3 groups: nine gaps close, two open.
        let is_closed = |(now, before): &(&f32, &f32)| **now < 0.35 * **before;
        let closed = together.iter().zip(&apart).filter(is_closed).count();
        assert_eq!(closed, 9, "{hang}: {together:?} {apart:?}");
        let widest = together.iter().copied().fold(0.0, f32::max);
        assert!(widest > 2.0 * apart[5], "{hang}: {together:?} {apart:?}");
        // Roots stay where they were.
        let roots: Vec<Vec3> = grown(zone).strands.roots().collect();
        assert_eq!(hair.roots().collect::<Vec<_>>(), roots);
    }
}

#[test]
fn the_middle_of_a_group_is_its_longest() {
    for hang in [0.0, 0.8] {
        let zone = Zone {
            count: 9,
            hang,
            sway: 0.0,
            groups: 1,
            gather: 0.0,
            peak: 0.5,
            ..plain()
        };
        let hair = grown(zone).strands;
        let lengths: Vec<f32> = hair.iter().map(length).collect();
        assert!(lengths[..5].is_sorted(), "{hang}: {lengths:?}");
        assert!(
            lengths[4..].is_sorted_by(|a, b| a >= b),
            "{hang}: {lengths:?}"
        );
        assert!(lengths[0] < 0.85 * lengths[4], "{hang}: {lengths:?}");
    }
}

#[test]
fn tips_of_a_tail_come_together_in_groups() {
    let tail = |groups| Zone {
        form: Form::Tail,
        count: 20,
        roots: Line::Through(vec![place(180.0, 30.0)]),
        tips: None,
        hang: 1.5,
        groups,
        gather: 1.0,
        peak: 0.0,
        sway: 0.0,
        ..plain()
    };
    let nearest = |hair: &hair_sim::Strands| -> f32 {
        let tips: Vec<Vec3> = hair.iter().map(|points| points[points.len() - 1]).collect();
        let of = |i: usize| {
            let others = (0..tips.len()).filter(|j| *j != i);
            others
                .map(|j| tips[i].distance(tips[j]))
                .fold(f32::MAX, f32::min)
        };
        (0..tips.len()).map(of).sum::<f32>() / tips.len() as f32
    };
    let (alone, grouped) = (
        nearest(&grown(tail(0)).strands),
        nearest(&grown(tail(4)).strands),
    );
    assert!(grouped < 0.3 * alone, "{grouped} {alone}");
}

#[test]
fn cut_hair_ends_on_one_level() {
    let zone = Zone {
        hang: 0.7,
        length_variation: 0.8,
        cut: Some(-0.4),
        ..plain()
    };
    let level = SHELL.center().y - 0.4 * HEIGHT;
    for points in grown(zone).strands.iter() {
        let tip = points[points.len() - 1];
        assert!((tip.y - level).abs() < 1e-5, "{} {level}", tip.y);
        assert!(points[1..points.len() - 1].iter().all(|p| p.y >= level));
    }
}

#[test]
fn hair_leans_as_it_is_told() {
    let tips = |zone: Zone| -> Vec<Vec3> {
        let hair = grown(zone).strands;
        hair.iter().map(|points| points[points.len() - 1]).collect()
    };
    let zone = Zone {
        hang: 0.8,
        sway: 0.0,
        roots: Line::Through(vec![place(80.0, 60.0)]),
        tips: Some(Line::Through(vec![place(90.0, 0.0)])),
        count: 1,
        mirror: true,
        ..plain()
    };
    let straight = tips(zone.clone());
    let swept = tips(Zone {
        sweep: 0.6,
        ..zone.clone()
    });
    for (a, b) in straight.iter().zip(&swept) {
        assert!(
            b.z < a.z - 0.05 * HEIGHT,
            "to the back on both sides: {a} {b}"
        );
    }
    let curved = grown(Zone {
        s_curve: 0.6,
        ..zone.clone()
    });
    let straight = grown(zone).strands;
    let off = curved.strands.strand(0).iter().zip(straight.strand(0));
    let off: Vec<f32> = off.map(|(a, b)| (a.z - b.z) / HEIGHT).collect();
    let [back, front] = [-1.0, 1.0].map(|way| off.iter().map(|z| way * z).fold(0.0, f32::max));
    assert!(
        back > 0.03 && front > 0.03,
        "to one side, then to the other: {off:?}"
    );
}

#[test]
fn clumps_have_the_tapers_of_their_zones() {
    let taper = Taper {
        root_size: Some(0.7),
        shrink_start: None,
    };
    let zone = Zone { taper, ..plain() };
    assert_eq!(grown(zone).tapers, [taper; 6]);
    assert_eq!(grown(plain()).tapers, [Taper::default(); 6]);
}

#[test]
fn a_broad_coat_is_of_as_many_clumps_as_are_asked_for() {
    for coat in [12, 24, 30] {
        let style = Style {
            undercoat: true,
            coat,
            ..style(Vec::new())
        };
        assert_eq!(grow(&style, &SHELL).undercoat, coat as usize);
    }
}
