//! Lines by image filters on hair: rows 8 and 9.

use super::shown::{Shown, preset, shown, stage, toon};
use glam::Vec3;

/// Row 9: lines whose width grows from nothing at 0.4 of the strand to all of it at 0.65 leave the crown, by 60 % within a quarter of a head height
/// of the whorl, and are as they were beyond 0.7, within 2 %. By half a cosine they leave it too, but not as much: strands of this style are at half
/// their length there.
#[test]
fn lines_fade_at_the_whorl_and_nowhere_else() {
    let text = preset("shin-levels.ron");
    let from_behind = [
        ("scene.size", "(480, 432)"),
        ("camera.yaw", "180"),
        ("camera.pitch", "40"),
        ("passes.1.fade", "0"),
        // Wide enough for areas to be counted in whole pixels.
        ("passes.1.width", "8"),
    ];
    let with = |pass: &[(&str, &str)]| shown(&text, &[&from_behind, pass].concat());
    let none = with(&[("passes.1.edges", "none")]);
    let lines = |of: &Shown| -> Vec<usize> {
        let is_line = |i: &usize| of.picture.pixels[*i] != none.picture.pixels[*i];
        none.hair().filter(is_line).collect()
    };
    let full = lines(&with(&[]));
    let cosine = lines(&with(&[("passes.1.fade", "0.7")]));
    let curve = lines(&with(&[(
        "passes.1.width",
        "(curve: [(0.4, 0), (0.65, 8)])",
    )]));
    // The style's whorl is at longitude 176, latitude 70 degrees.
    let (longitude, latitude) = (176.0_f32.to_radians(), 70.0_f32.to_radians());
    let to_whorl = Vec3::new(
        longitude.sin() * latitude.cos(),
        latitude.sin(),
        longitude.cos() * latitude.cos(),
    );
    let off = |i: usize| {
        let from_center = none.places[i] - none.head.center;
        from_center.normalize_or_zero().dot(to_whorl)
    };
    let whorl = none
        .hair()
        .max_by(|a, b| off(*a).total_cmp(&off(*b)))
        .unwrap();
    assert!(off(whorl) > 0.99, "the whorl is seen: {}", off(whorl));
    let at_whorl =
        |i: &usize| none.places[*i].distance(none.places[whorl]) < 0.25 * none.head.height_m;
    let at_tips = |i: &usize| none.samples[*i].u > 0.7;
    let count = |lines: &[usize], is_there: &dyn Fn(&usize) -> bool| {
        lines.iter().filter(|i| is_there(i)).count() as f64
    };
    let shares = |faded: &[usize]| {
        let share =
            |is_there: &dyn Fn(&usize) -> bool| count(faded, is_there) / count(&full, is_there);
        [share(&at_whorl), share(&at_tips)]
    };
    let found = [("a curve", shares(&curve)), ("a cosine", shares(&cosine))];
    for (by, [whorl, tips]) in found {
        println!(
            "row 9: lines that fade by {by}: {whorl:.3} of them left at the whorl, {tips:.3} at the tips"
        );
    }
    assert!(count(&full, &at_whorl) > 100.0 && count(&full, &at_tips) > 500.0);
    let [(_, [whorl, tips]), (_, [by_cosine, _])] = found;
    assert!(whorl <= 0.4 && tips >= 0.98, "{found:?}");
    assert!(by_cosine < 0.7, "{found:?}");
}

/// Whether a pixel lies beside one for which `is_other` holds.
fn is_beside(shown: &Shown, i: usize, is_other: impl Fn(usize) -> bool) -> bool {
    let [width, height] = shown.drawing.size.map(|side| side as usize);
    let (x, y) = (i % width, i / width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x))
        .any(is_other)
}

/// Row 8: in front of nothing, lines lie on hair and head alone, on all of their edges but at the picture's border.
#[test]
fn lines_lie_on_what_is_there() {
    let plain = toon("curls", "tones: none");
    // Hair that the picture's border cuts.
    let close = [("camera.distance", "2.2"), ("scene.background", "none")];
    let none = shown(&plain, &close);
    let lined = plain.replacen(
        ", layers:",
        ", passes: [(edges: object, width: 3, color: \"FF0000\")], layers:",
        1,
    );
    let lined = shown(&lined, &close);
    let red = [1.0, 0.0, 0.0, 1.0];
    let is_front = |i: usize, other: usize| {
        let [own, other] = [i, other].map(|i| &none.samples[i]);
        let is_nearer = (own.inv_depth, own.object) > (other.inv_depth, other.object);
        own.object != other.object && is_nearer
    };
    let mut lines = 0;
    for (i, (before, after)) in none
        .picture
        .pixels
        .iter()
        .zip(&lined.picture.pixels)
        .enumerate()
    {
        let is_edge = is_beside(&none, i, |beside| is_front(i, beside));
        assert_eq!(after, if is_edge { &red } else { before }, "pixel {i}");
        lines += usize::from(is_edge);
    }
    let at_border = |i: &usize| i.is_multiple_of(240) || *i < 240;
    let cut = none.hair().filter(at_border).count();
    println!(
        "row 8: {lines} pixels of lines; {cut} pixels of hair at the border have none of its own"
    );
    assert!(lines > 500 && cut > 20);
}

/// Row 8: wide lines of hair grow into what is transparent, and are as opaque there.
#[test]
fn wide_lines_cover_what_is_transparent() {
    let text = toon("curls", "tones: none").replacen(
        ", layers:",
        ", passes: [(edges: object, width: 20, color: \"FF0000\")], layers:",
        1,
    );
    let shown = shown(&text, &[("scene.background", "none")]);
    let is_line = |i: &usize| shown.samples[*i].object == 0 && shown.picture.pixels[*i][3] > 0.0;
    let lines: Vec<usize> = (0..shown.samples.len()).filter(is_line).collect();
    assert!(lines.len() > 500);
    for i in lines {
        assert_eq!(
            shown.picture.pixels[i],
            [1.0, 0.0, 0.0, 1.0],
            "{} {}",
            i % 240,
            i / 240
        );
    }
}

/// Lines of no width are no lines: samples aren't compared for them.
#[test]
fn lines_of_no_width_cost_nothing() {
    let text = preset("shin-levels.ron");
    let passes = |width: &str| {
        let mut stage = stage(&text, &[("passes.1.width", width)]);
        stage.frame().unwrap().passes.len()
    };
    assert_eq!(passes("0"), 0);
    for some in ["1", "(curve: [(0, 0), (1, 1)])"] {
        assert_eq!(passes(some), 1, "{some}");
    }
    let small = ("scene.size", "(64, 64)");
    let pixels = |setting| shown(&text, &[small, setting]).picture.pixels;
    assert_eq!(
        pixels(("passes.1.width", "0")),
        pixels(("passes.1.edges", "none"))
    );
}
