//! Light on painted hair: rows 11 to 17.

use super::shown::{Shown, shown, toon};
use super::strands::{Strand, strands};
use std::collections::BTreeMap;

/// Grays by the row alone: black at 0, white at 1.
const GLOSS: &str = r#"mode: replace, root_fade: 0, tones: [(v: 0, stops: [(0, "000000")]), (v: 1, stops: [(0, "FFFFFF")])]"#;
/// Grays by light alone.
const LIT: &str = r#"mode: replace, root_fade: 0, tones: [(0, "000000"), (1, "FFFFFF")]"#;
const STYLES: [&str; 4] = ["long-straight", "waves", "curls", "layered-medium"];

/// Row 11: a ramp's colours are those of the ramp in double precision, at the light that there is.
#[test]
fn ramps_are_those_of_double_precision() {
    let stops = [
        (0.1, [255.0, 0.0, 0.0]),
        (0.4, [0.0, 255.0, 0.0]),
        (0.8, [51.0, 102.0, 255.0]),
    ];
    let linear = |srgb: f64| match srgb / 255.0 {
        s if s <= 0.04045 => s / 12.92,
        s => ((s + 0.055) / 1.055).powf(2.4),
    };
    let ramp = |light: f64| {
        let after = stops.partition_point(|(place, _)| *place < light);
        let [a, b] = [after.max(1) - 1, after.min(stops.len() - 1)].map(|i| stops[i]);
        let way = if a.0 < b.0 {
            (light - a.0) / (b.0 - a.0)
        } else {
            0.0
        };
        [0, 1, 2].map(|i| linear(a.1[i]) + way * (linear(b.1[i]) - linear(a.1[i])))
    };
    for style in STYLES {
        let gray = shown(&toon(style, LIT), &[]);
        let tones = r#"mode: replace, root_fade: 0, tones: [(0.1, "FF0000"), (0.4, "00FF00"), (0.8, "3366FF")]"#;
        let colored = shown(&toon(style, tones), &[]);
        let mut off = 0.0_f64;
        for i in gray.hair() {
            let expected = ramp(gray.gray(i));
            for (found, expected) in colored.samples[i].color.iter().zip(expected) {
                off = off.max((f64::from(*found) - expected).abs());
            }
        }
        println!(
            "row 11, {style}: colours are off by up to {:.2} / 255",
            255.0 * off
        );
        assert!(off < 1.0 / 255.0, "{style}: {off}");
    }
}

/// Row 12: nothing overlaps, so a ramp of steps shows its own colours alone.
#[test]
fn no_colour_is_off_the_ramp() {
    let steps =
        r#"mode: replace, tones: (steps: [(0, "000000"), (0.3, "FF0000"), (0.7, "FFFFFF")])"#;
    for style in ["waves", "twin-tails", "curls"] {
        let shown = shown(&toon(style, steps), &[]);
        let mut found: BTreeMap<[u32; 3], usize> = BTreeMap::new();
        for i in shown.hair() {
            let [r, g, b, _] = shown.samples[i].color.map(f32::to_bits);
            *found.entry([r, g, b]).or_default() += 1;
        }
        let one = 1.0_f32.to_bits();
        let ramp = [[0; 3], [one, 0, 0], [one; 3]];
        let found: Vec<_> = found.into_keys().collect();
        assert_eq!(found, ramp, "{style}");
    }
}

/// Row 13: nearness on a logarithmic scale, of each sample's strand where the sample is.
#[test]
fn nearness_is_exact() {
    // Joints are left out that make a difference of less than 0.05 pixels, here of 0.03 % of a head's height.
    let large = [("scene.size", "(640, 720)"), ("path.subdivision", "16")];
    let (near, far) = (-0.4_f64, 0.5_f64);
    for style in STYLES {
        let text = toon(
            style,
            &format!("{GLOSS}, detail: depth, near: {near}, far: {far}"),
        );
        let shown = shown(&text, &large);
        let strands = strands(&text, &large, &shown.camera);
        let height = f64::from(shown.head.height_m);
        let depth = |place| f64::from(shown.camera.view_from_world(place).z) / height;
        let middle = depth(shown.head.center);
        let [from, to] = [middle + near, middle + far];
        let mut off = 0.0_f64;
        for i in shown.hair() {
            let strand = &strands[&shown.samples[i].strand];
            let place = strand.position_at(shown.samples[i].s);
            let z = depth(place.as_vec3());
            let expected = 1.0 - ((z / from).ln() / (to / from).ln()).clamp(0.0, 1.0);
            off = off.max((shown.gray(i) - expected).abs());
        }
        println!("row 13, {style}: nearness is off by up to {off:.5}");
        assert!(off < 1e-3, "{style}: {off}");
    }
}

/// The means of grays at the rims of a strand and at its middle, of strands that show both.
fn rims_and_middles(shown: &Shown) -> Vec<[f64; 2]> {
    let mut sums: BTreeMap<u32, [(f64, f64); 2]> = BTreeMap::new();
    for i in shown.hair() {
        let sample = &shown.samples[i];
        let part = match sample.w.abs() {
            w if w > 0.85 => 0,
            w if w < 0.3 => 1,
            _ => continue,
        };
        let sum = &mut sums.entry(sample.strand).or_default()[part];
        *sum = (sum.0 + shown.gray(i), sum.1 + 1.0);
    }
    let shows_both = |parts: &&[(f64, f64); 2]| parts.iter().all(|(_, count)| *count >= 10.0);
    let means = sums.values().filter(shows_both);
    means
        .map(|parts| parts.map(|(sum, count)| sum / count))
        .collect()
}

/// Row 14: with light added by how much hair faces the eye, each lock is brighter at its rim (D's Fig 4.8).
#[test]
fn each_lock_is_brighter_at_its_rim() {
    let params = "mode: add, roundness: 1, root_fade: 0, detail: facing, exponent: 0.8, \
                  tones: [(v: 0, stops: [(0, \"FFFFFF\")]), (v: 1, stops: [(0, \"000000\")])]";
    for style in STYLES {
        let shown = shown(&toon(style, params), &[("clump.color", "\"404040\"")]);
        let locks = rims_and_middles(&shown);
        let brighter = locks
            .iter()
            .filter(|[rim, middle]| *rim > middle + 0.1)
            .count();
        println!(
            "row 14, {style}: {brighter} of {} locks are brighter at their rim",
            locks.len()
        );
        assert!(
            locks.len() > 10 && brighter == locks.len(),
            "{style}: {locks:?}"
        );
    }
}

/// How far along a strand a highlight is looked for from where it should be, pixels: a curl has one in each of its turns.
const NEAR_PX: f32 = 16.0;

/// How far highlights on strands are from where they are in double precision, pixels; of strands that show the place.
fn off_peaks(shown: &Shown, strands: &BTreeMap<u32, Strand>) -> Vec<f32> {
    let mut of_strands: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for i in shown.hair() {
        of_strands
            .entry(shown.samples[i].strand)
            .or_default()
            .push(i);
    }
    let off_peak = |(id, samples): (&u32, &Vec<usize>)| {
        let strand = &strands[id];
        let by_light = |a: &usize, b: &usize| strand.blinn(*a).total_cmp(&strand.blinn(*b));
        let peak = (0..strand.s.len()).max_by(by_light)?;
        let place = |i: usize| strand.at(shown.samples[i].s);
        let shows = |is_beyond: fn(usize, usize) -> bool| {
            samples
                .iter()
                .any(|i| is_beyond(place(*i), peak) && strand.pixels_between(place(*i), peak) < 1.0)
        };
        let is_seen = strand.blinn(peak) > 0.95 && shows(|a, b| a < b) && shows(|a, b| a > b);
        let by_gray = |a: &&usize, b: &&usize| shown.gray(**a).total_cmp(&shown.gray(**b));
        let is_near = |i: &&usize| strand.pixels_between(place(**i), peak) < NEAR_PX;
        let brightest = samples.iter().filter(is_near).max_by(by_gray)?;
        is_seen.then(|| strand.pixels_between(place(*brightest), peak))
    };
    of_strands.iter().filter_map(off_peak).collect()
}

/// Row 15: highlights are brightest where they are on the exact curve, in double precision, within a pixel.
#[test]
fn highlights_are_where_they_should_be() {
    for style in STYLES {
        let text = toon(
            style,
            &format!("{GLOSS}, roundness: 0, detail: blinn, exponent: 40"),
        );
        let mut off = Vec::new();
        for yaw in ["-20", "20", "50"] {
            let light = [("light.yaw", yaw), ("light.pitch", "50")];
            let shown = shown(&text, &light);
            off.extend(off_peaks(&shown, &strands(&text, &light, &shown.camera)));
        }
        let most = off.iter().copied().fold(0.0, f32::max);
        println!(
            "row 15, {style}: {} highlights, off by up to {most:.2} px",
            off.len()
        );
        assert!(off.len() >= 8 && most <= 1.0, "{style}: {off:?}");
    }
}

/// Row 16: where a ramp goes by Blinn's highlight its step says how large the highlight is: it covers what is brighter than the step.
#[test]
fn the_step_of_a_ramp_is_the_size_of_highlights() {
    let blinn = "roundness: 0.4, detail: blinn, exponent: 20";
    for style in STYLES {
        let smooth = shown(&toon(style, &format!("{GLOSS}, {blinn}")), &[]);
        let sizes = ["0.3", "0.6", "0.9"].map(|step| {
            let tones = format!(
                "mode: replace, root_fade: 0, {blinn}, tones: [(v: 0, stops: [(0, \"000000\")]), (v: {step}, stops: [(0, \"000000\")]), \
                 (v: {step}, stops: [(0, \"FFFFFF\")])]"
            );
            let hard = shown(&toon(style, &tones), &[]);
            let step: f64 = step.parse().unwrap();
            for i in hard.hair() {
                let (hard, light) = (hard.gray(i), smooth.gray(i));
                // Rows of a picture have a width.
                let is_clear = (light - step).abs() > 0.01;
                assert!(!is_clear || hard == f64::from(u8::from(light > step)), "{style}: {hard} at {light}");
            }
            hard.hair().filter(|i| hard.gray(*i) > 0.5).count()
        });
        println!("row 16, {style}: highlights of {sizes:?} pixels with steps at 0.3, 0.6 and 0.9");
        assert!(
            sizes.windows(2).all(|pair| pair[1] < pair[0]) && sizes[2] > 0,
            "{sizes:?}"
        );
    }
}

/// Row 17: light from above; the weight moves the highlight from the tips to the roots.
#[test]
fn the_weight_moves_highlights_along_the_strand() {
    let means = [0.0, 0.25, 0.5, 0.75, 1.0].map(|weight| {
        let params = format!("{GLOSS}, detail: weighted, exponent: 20, weight: {weight}");
        let shown = shown(&toon("long-straight", &params), &[("light.pitch", "80")]);
        let (mut sum, mut of_u) = (0.0, 0.0);
        for i in shown.hair() {
            let bright = shown.gray(i);
            sum += bright;
            of_u += bright * f64::from(shown.samples[i].u);
        }
        of_u / sum
    });
    println!("row 17: mean u of highlights by weight: {means:.3?}");
    assert!(means.windows(2).all(|pair| pair[1] < pair[0]), "{means:?}");
}
