use super::*;
use crate::preset::Reader;
use proptest::prelude::*;

const TOOLS: [Tool; 6] = [
    Tool::Pencil,
    Tool::Charcoal,
    Tool::DryInk,
    Tool::Watercolour,
    Tool::Crayon,
    Tool::Zigzag,
];

fn section(kind: Tool) -> BrushSection {
    BrushSection {
        kind,
        ..BrushSection::default()
    }
}

fn mean(brush: &BrushTexture) -> f32 {
    let means = brush
        .marks()
        .map(|mark| mark.level(mark.levels() - 1).1[0][3].to_f32());
    means.sum::<f32>() / brush.marks().len() as f32
}

/// A place beside a stroke of that radius, on a head of 300 pixels.
fn place(s: f32, v: f32, radius_px: f32) -> BrushPlace {
    BrushPlace {
        s,
        whole: 1.5,
        v,
        pixels: 300.0,
        radius_px,
    }
}

#[test]
fn what_is_solid_has_no_texture() {
    assert_eq!(BrushTexture::of_tool(&BrushSection::default()), None);
    let of_file = BrushSection {
        texture: Some("a.png".to_owned()),
        ..section(Tool::Pencil)
    };
    assert_eq!(BrushTexture::of_tool(&of_file), None);
}

#[test]
fn each_tool_leaves_less_where_it_is_dry() {
    for kind in TOOLS {
        let of = |dry| {
            let section = BrushSection {
                dry,
                ..section(kind)
            };
            mean(&BrushTexture::of_tool(&section).unwrap())
        };
        let [wet, own, dry] = [0.0, 0.5, 1.0].map(of);
        assert!(
            wet > own + 0.03 && own > dry + 0.03,
            "{kind:?}: {wet}, {own}, {dry}"
        );
        assert!(wet > 0.6 && dry < 0.6, "{kind:?}: {wet}, {own}, {dry}");
    }
}

#[test]
fn strands_and_seeds_differ() {
    for kind in TOOLS {
        let brush = BrushTexture::of_tool(&section(kind)).unwrap();
        let other = BrushSection {
            seed: 2,
            ..section(kind)
        };
        assert_ne!(brush, BrushTexture::of_tool(&other).unwrap(), "{kind:?}");
        assert_eq!(brush, BrushTexture::of_tool(&section(kind)).unwrap());
        // The middle of a zigzag is whole.
        let across = if kind == Tool::Zigzag { 0.8 } else { 0.3 };
        let along = |strand: u32| -> Vec<f32> {
            let strand = brush.of_strand(crate::strand_seed(7, strand));
            (0..60)
                .map(|i| strand.coverage(&place(0.025 * i as f32, across, 8.0)))
                .collect()
        };
        let apart = |a: &[f32], b: &[f32]| -> f32 {
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>() / 60.0
        };
        let (first, second) = (along(1), along(2));
        assert!(
            apart(&first, &second) > 0.03,
            "{kind:?}: {}",
            apart(&first, &second)
        );
        assert_eq!(first, along(1));
    }
}

/// A repeated copy ends as the next begins: no seam.
#[test]
fn copies_follow_each_other_without_a_seam() {
    for kind in TOOLS {
        let section = BrushSection {
            fit: Some(Fit::Repeat),
            ..section(kind)
        };
        let brush = BrushTexture::of_tool(&section).unwrap();
        for mark in brush.marks() {
            let ([width, height], texels) = mark.level(0);
            let step = |column: usize| -> f32 {
                let of_row = |row: usize| {
                    let at = |column: usize| texels[row * width + column % width][3].to_f32();
                    (at(column) - at(column + 1)).abs()
                };
                (0..height).map(of_row).sum::<f32>() / height as f32
            };
            let usual: f32 = (0..width).map(step).sum::<f32>() / width as f32;
            assert!(
                step(width - 1) < 3.0 * usual + 0.02,
                "{kind:?}: {}",
                step(width - 1)
            );
        }
    }
}

/// From afar all of a stroke is as much covered as its mean says, so that nothing sparkles.
#[test]
fn far_away_coverage_is_the_mean() {
    for kind in [
        Tool::Pencil,
        Tool::Charcoal,
        Tool::Watercolour,
        Tool::Crayon,
    ] {
        let brush = BrushTexture::of_tool(&section(kind)).unwrap();
        for seed in 0..8 {
            let strand = brush.of_strand(seed);
            let image = &strand.mark.image;
            let mark = image.level(image.levels() - 1).1[0][3].to_f32();
            for i in 0..20 {
                let far = BrushPlace {
                    pixels: 0.5,
                    radius_px: 0.01,
                    ..place(0.07 * i as f32, 0.1 * i as f32 - 1.0, 0.0)
                };
                let coverage = strand.coverage(&far);
                assert!(
                    (coverage - mark).abs() < 0.1,
                    "{kind:?}: {coverage}, {mark}"
                );
            }
        }
    }
}

#[test]
fn a_dry_brush_opens_up_towards_the_tip() {
    let brush = BrushTexture::of_tool(&section(Tool::DryInk)).unwrap();
    assert_eq!(brush.length(), None);
    let at = |s: f32| -> f32 {
        let of_strand = |seed: u32| {
            let strand = brush.of_strand(seed);
            (0..9)
                .map(|i| strand.coverage(&place(s, 0.2 * i as f32 - 0.8, 9.0)))
                .sum::<f32>()
                / 9.0
        };
        (0..16).map(of_strand).sum::<f32>() / 16.0
    };
    let [root, middle, tip] = [0.05, 0.9, 1.45].map(at);
    assert!(
        root > 0.85 && middle < root && tip < 0.55 * middle,
        "{root}, {middle}, {tip}"
    );
}

#[test]
fn any_place_is_covered_by_a_share() {
    let numbers = [0.0, 1e-30, 1e-3, 0.5, 1.0, 7.0, 1e9, f32::MAX];
    for kind in TOOLS {
        let brush = BrushTexture::of_tool(&section(kind)).unwrap();
        for (s, whole) in [(0.0, 0.0), (0.3, 0.0), (0.3, 2.0), (1e6, 1e6)] {
            for pixels in numbers {
                for radius_px in numbers {
                    let at = BrushPlace {
                        s,
                        whole,
                        v: 0.4,
                        pixels,
                        radius_px,
                    };
                    let coverage = brush.of_strand(3).coverage(&at);
                    assert!(
                        (0.0..=1.0001).contains(&coverage),
                        "{kind:?}, {at:?}: {coverage}"
                    );
                }
            }
        }
    }
}

#[test]
fn pictures_cover_where_they_are_opaque_or_dark() {
    let section = BrushSection::default();
    let full = u16::MAX;
    let at = |texels: &[[u16; 4]]| {
        let image = Image::from_srgb([2, 1], texels.as_flattened()).unwrap();
        let brush = BrushTexture::of_picture(&section, &image).unwrap();
        let (_, texels) = brush.marks().next().unwrap().level(0);
        [texels[0][3].to_f32(), texels[1][3].to_f32()]
    };
    assert_eq!(at(&[[0, 0, 0, full], [full, full, full, full]]), [1.0, 0.0]);
    assert_eq!(at(&[[full, full, full, full], [0, 0, 0, 0]]), [1.0, 0.0]);
}

#[test]
fn mistakes_are_told_at_their_place() {
    let mistakes = [
        ("(kind: pen)", "there is no `pen`"),
        (
            "(length: NaN)",
            "length: expected a number from 0.01 to 100",
        ),
        ("(length: -1)", "length: expected a number from 0.01 to 100"),
        ("(dry: 2)", "dry: expected a number from 0 to 1"),
        ("(grain: inf)", "grain: expected a number"),
        ("(fit: tile)", "there is no `tile`"),
        ("(tool: pencil)", "brush has no `tool`"),
    ];
    for (text, message) in mistakes {
        let mut reader = Reader::new("a.ron", text);
        let _: BrushSection = reader.section(text, "brush");
        let error = reader.report().unwrap_err().to_string();
        assert!(error.contains(message), "{text}: {error}");
    }
    let text =
        "(kind: crayon, length: 2, fit: stretch, grain: 0.5, dry: 1, seed: 9, texture: \"a.png\")";
    let mut reader = Reader::new("a.ron", text);
    let read: BrushSection = reader.section(text, "brush");
    reader.report().unwrap();
    assert_eq!(
        (read.length, read.fit, read.seed),
        (Some(2.0), Some(Fit::Stretch), 9)
    );
}

/// Row 19 of S's highlights: whole teeth on a link, whatever its length, as many as come nearest to the set one; strips that meet go on in each other.
#[test]
fn a_zigzag_has_whole_teeth_and_ends_in_valleys() {
    for (grain, pitch) in [(1.0, 0.1), (0.5, 0.05), (3.0, 0.3)] {
        let section = BrushSection {
            grain,
            dry: 1.0,
            ..section(Tool::Zigzag)
        };
        let brush = BrushTexture::of_tool(&section).unwrap();
        for seed in 0..8 {
            let strand = brush.of_strand(seed);
            for fitting in [0.3, 1.2, 2.9, 3.7, 6.3, 11.0, 17.2] {
                let whole = fitting * pitch;
                let reach = |share: f32, side: f32| -> f32 {
                    let covered = |v: f32| {
                        strand.coverage(&BrushPlace {
                            s: share * whole,
                            whole,
                            v: side * v,
                            pixels: 40_000.0,
                            radius_px: 400.0,
                        }) > 0.5
                    };
                    (0..100)
                        .map(|i| 0.01 * i as f32)
                        .take_while(|v| covered(*v))
                        .count() as f32
                        / 100.0
                };
                for side in [1.0, -1.0] {
                    let edge: Vec<f32> = (0..=600).map(|i| reach(i as f32 / 600.0, side)).collect();
                    let (first, last) = (edge[0], edge[600]);
                    assert!(
                        (first - 0.15).abs() < 0.05 && (last - 0.15).abs() < 0.05,
                        "{fitting}: {first}, {last}"
                    );
                    let rises = edge
                        .windows(2)
                        .filter(|pair| pair[0] <= 0.3 && pair[1] > 0.3);
                    let teeth = rises.count() as f32;
                    assert_eq!(
                        teeth,
                        fitting.round().max(1.0),
                        "{grain}, {seed}, {fitting}"
                    );
                    // The pitch within a fifth, where a tooth more or less is no more than that.
                    let off = whole / teeth / pitch - 1.0;
                    assert!(fitting < 2.5 || off.abs() <= 0.2, "{fitting}: {off}");
                }
            }
        }
    }
}

/// Where a link's teeth become one more, both numbers are as near: it has sharp teeth there, too, in place of the ghosts of both.
#[test]
fn no_ghosts_of_teeth() {
    let brush = BrushTexture::of_tool(&section(Tool::Zigzag)).unwrap();
    for seed in 0..8 {
        let strand = brush.of_strand(seed);
        let covered = |[along, across]: [usize; 2]| {
            strand.coverage(&BrushPlace {
                s: 0.01 * along as f32 * 0.15,
                whole: 0.15,
                v: 0.01 * across as f32,
                pixels: 2000.0,
                radius_px: 100.0,
            })
        };
        let places = (0..100).flat_map(|along| (0..100).map(move |across| [along, across]));
        let ghosts = places.map(covered).filter(|part| (0.1..0.9).contains(part));
        // A pixel or two along the edge of each of 100 columns.
        assert!(ghosts.clone().count() < 200, "{seed}: {}", ghosts.count());
    }
}

/// A link that grows has a tooth more after a while: the one shape goes over into the other.
#[test]
fn teeth_come_and_go_without_a_jump() {
    let brush = BrushTexture::of_tool(&section(Tool::Zigzag)).unwrap();
    for seed in 0..4 {
        let strand = brush.of_strand(seed);
        for share in [0.11, 0.43, 0.8] {
            let at = |i: usize| {
                // In steps in which no edge, which is a pixel broad, goes far.
                let whole = 0.05 + 0.00001 * i as f32;
                strand.coverage(&BrushPlace {
                    whole,
                    ..place(share * whole, 0.5, 12.0)
                })
            };
            let jump = (1..80_000).map(|i| (at(i) - at(i - 1)).abs());
            let jump = jump.fold(0.0, f32::max);
            assert!(jump < 0.02, "{seed}, {share}: {jump}");
        }
    }
}

/// As a stroke comes nearer, or turns towards the eye, what covers a pixel of it changes little by little: no other number of lookups, no other copy jumps.
#[test]
fn nothing_jumps_as_strokes_grow() {
    const STEP: f32 = 1.0005;
    for kind in TOOLS {
        let brush = BrushTexture::of_tool(&section(kind)).unwrap();
        for seed in 0..3 {
            let strand = brush.of_strand(seed);
            for v in [-0.97, -0.4, 0.1, 0.99] {
                for pixels in [40.0, 300.0] {
                    let coverages = (0..10_000).map(|i| {
                        let radius_px = 0.2 * STEP.powi(i);
                        strand.coverage(&BrushPlace {
                            pixels,
                            ..place(0.33, v, radius_px)
                        })
                    });
                    let coverages: Vec<f32> = coverages.collect();
                    let jump = coverages.windows(2).map(|pair| (pair[1] - pair[0]).abs());
                    let jump = jump.fold(0.0, f32::max);
                    assert!(jump < 0.004, "{kind:?}, {seed}, {v}, {pixels}: {jump}");
                }
            }
        }
    }
}

proptest! {
    /// What the others ask for, which copies and how many lookups, makes no difference.
    #[test]
    fn eight_places_at_once_are_each_by_itself(
        kind in prop::sample::select(TOOLS.to_vec()),
        fit in prop::option::of(prop::sample::select(vec![Fit::Repeat, Fit::Stretch, Fit::Whole])),
        seed: u32,
        places in prop::collection::vec((-0.5..3.0_f32, 0.0..2.0_f32, -1.2..1.2_f32, 0.0..900.0_f32, prop_oneof![Just(0.0), 0.05..60.0_f32], 0.0..30.0_f32), 8),
    ) {
        let brush = BrushTexture::of_tool(&BrushSection { fit, ..section(kind) }).unwrap();
        let strand = brush.of_strand(seed);
        let mut all = BrushPlaces::<8>::ZERO;
        let mut clump_px = [0.0; 8];
        for (k, &(s, whole, v, pixels, radius_px, clump)) in places.iter().enumerate() {
            (all.s[k], all.whole[k], all.v[k], all.pixels[k], all.radius_px[k]) = (s, whole, v, pixels, radius_px);
            clump_px[k] = clump;
        }
        let (coverages, of_outlines) = (strand.coverages(&all), strand.coverages(&all.on_outline(&clump_px)));
        for (k, &(s, whole, v, pixels, radius_px, clump)) in places.iter().enumerate() {
            let own = BrushPlace { s, whole, v, pixels, radius_px };
            prop_assert_eq!(coverages[k].to_bits(), strand.coverage(&own).to_bits());
            let outline = BrushPlaces::from(own).on_outline(&[clump]);
            let width = radius_px - clump;
            if clump > 0.0 && width > 0.0 {
                let from_middle = 2.0 * (v.abs() * radius_px - clump) / width - 1.0;
                prop_assert_eq!(outline.v[0].abs(), from_middle.clamp(-1.0, 1.0).abs());
                prop_assert_eq!(outline.radius_px[0], 0.5 * width);
            } else {
                prop_assert_eq!(outline, BrushPlaces::from(own));
            }
            prop_assert_eq!(of_outlines[k].to_bits(), strand.coverages(&outline)[0].to_bits());
        }
    }
}
