//! Areas, depths and colours of the reference picture against closed forms.

use crate::drawings::*;
use glam::DVec2;
use render::{Brush, Disc, Drawing};
use std::f64::consts::PI;

/// Square pixels. A cell of the grid has 1/256 and is counted wrongly only on a border, with errors
/// of both signs that mostly cancel.
const TOLERANCE: f64 = 0.05;

fn area(drawing: &Drawing) -> f64 {
    sum(&reference::picture(drawing, 16), 3)
}

fn assert_area(discs: &[Disc], expected: f64) {
    let measured = area(&strokes(&[discs]));
    assert!(
        (measured - expected).abs() < TOLERANCE + 2e-4 * expected,
        "{measured} is not {expected}"
    );
}

/// Two discs and their outer tangents.
fn uneven_capsule_area(large: f64, small: f64, length: f64) -> f64 {
    let angle = ((large - small) / length).acos();
    large * large * (PI - angle) + small * small * angle + (large + small) * length * angle.sin()
}

#[test]
fn disc_alone() {
    assert_area(&[disc(31.3, 30.7, 20.0, 1.0)], PI * 400.0);
    assert_area(&[disc(31.3, 30.7, 0.7, 1.0)], PI * 0.49);
    assert_area(&[disc(31.3, 30.7, 0.0, 1.0)], 0.0);
}

#[test]
fn disc_cut_by_the_border_of_the_screen() {
    assert_area(&[disc(0.0, 64.0, 20.0, 1.0)], PI * 100.0);
}

#[test]
fn capsule() {
    let (from, to) = (disc(12.1, 15.3, 4.0, 1.0), disc(44.1, 39.3, 4.0, 1.0));
    assert_area(&[from, to], 40.0 * 8.0 + PI * 16.0);
}

#[test]
fn half_discs() {
    let half = |discs: &[Disc], expected: f64| {
        let drawing = Drawing {
            brush: Brush::Semicircle,
            ..strokes(&[discs])
        };
        let measured = area(&drawing);
        assert!(
            (measured - expected).abs() < TOLERANCE + 2e-4 * expected,
            "{measured} is not {expected}"
        );
    };
    let (from, to) = (disc(20.1, 24.3, 12.0, 1.0), disc(44.1, 42.3, 3.0, 1.0));
    // Half a disc and a trapezoid; the other way round what lies ahead of the larger is missing.
    half(&[from, to], PI * 72.0 + 30.0 * (12.0 + 3.0));
    half(
        &[to, from],
        uneven_capsule_area(12.0, 3.0, 30.0) - PI * 72.0,
    );
    // Without a way there is no half.
    half(&[from], PI * 144.0);
}

#[test]
fn thin_capsule() {
    let (from, to) = (disc(12.1, 15.3, 0.125, 1.0), disc(44.1, 39.3, 0.125, 1.0));
    assert_area(&[from, to], 40.0 * 0.25 + PI / 64.0);
}

#[test]
fn uneven_capsule() {
    let (from, to) = (disc(20.1, 24.3, 12.0, 1.0), disc(44.1, 42.3, 3.0, 1.0));
    assert_area(&[from, to], uneven_capsule_area(12.0, 3.0, 30.0));
    assert_area(&[to, from], uneven_capsule_area(12.0, 3.0, 30.0));
}

#[test]
fn taper_to_a_point() {
    let (from, to) = (disc(20.1, 24.3, 9.0, 1.0), disc(44.1, 42.3, 0.0, 1.0));
    assert_area(&[from, to], uneven_capsule_area(9.0, 0.0, 30.0));
}

#[test]
fn nested_discs() {
    let (inner, outer) = (disc(33.0, 30.0, 5.0, 1.0), disc(30.0, 31.0, 15.0, 2.0));
    assert_area(&[inner, outer], PI * 225.0);
    assert_area(&[outer, inner], PI * 225.0);
}

#[test]
fn joints_join_without_overlap() {
    // Three joints on a line are one capsule, and a strand that turns back on itself adds nothing.
    let joint = |x: f32| disc(x, 30.3, 5.0, 1.0);
    assert_area(&[joint(10.2), joint(25.2), joint(50.2)], 400.0 + 25.0 * PI);
    assert_area(&[joint(10.2), joint(50.2), joint(25.2)], 400.0 + 25.0 * PI);
}

#[test]
fn runs_of_a_strand_are_not_joined() {
    let mut drawing = strokes(&[&[disc(10.3, 30.4, 4.0, 1.0)], &[disc(50.7, 30.1, 4.0, 1.0)]]);
    drawing.runs[1].strand = 0;
    assert!((area(&drawing) - 32.0 * PI).abs() < TOLERANCE);
}

#[test]
fn two_crossing_strands() {
    // Bars 8 wide that cross at a right angle share a square of 8 x 8.
    let (near, far) = (2.0, 1.0);
    let across = [disc(10.0, 32.0, 4.0, far), disc(54.0, 32.0, 4.0, far)];
    let down = [disc(32.0, 10.0, 4.0, near), disc(32.0, 54.0, 4.0, near)];
    let mut drawing = strokes(&[&across, &down]);
    drawing.layers[0].colors = [RED, RED, GREEN, GREEN].to_vec();
    let picture = reference::picture(&drawing, 16);
    let bar = 44.0 * 8.0 + 16.0 * PI;
    assert!((sum(&picture, 0) - (bar - 64.0)).abs() < 0.2);
    assert!((sum(&picture, 1) - bar).abs() < 0.2);
    assert!((sum(&picture, 3) - (2.0 * bar - 64.0)).abs() < 0.2);
}

#[test]
fn depth_is_reached_by_the_nearest_disc_that_covers_the_sample() {
    // Inverse depth 1 to 3 over 40 px; a wall at 2. The disc at t covers (x, y) from
    // x - sqrt(r^2 - y^2) to x + sqrt(r^2 - y^2), so the wall hides a row of 20 px everywhere.
    let discs = [disc(12.0, 32.0, 6.0, 1.0), disc(52.0, 32.0, 6.0, 3.0)];
    let mut drawing = strokes(&[&discs]);
    add_wall(&mut drawing, 2.0, 1.0, [GREEN; 2]);
    let shown = sum(&reference::picture(&drawing, 16), 0);
    assert!((shown - (20.0 * 12.0 + 36.0 * PI)).abs() < 0.2, "{shown}");
}

#[test]
fn depth_is_the_nearest_of_all_segments() {
    // The strand folds back on itself nearer to the eye, and another run of it is nearer still.
    let joint = |x, inv_depth| disc(x, 32.0, 4.0, inv_depth);
    let folded = [
        joint(10.0, 1.0),
        joint(50.0, 1.0),
        joint(50.0, 3.0),
        joint(10.0, 3.0),
    ];
    for fold in [folded, [folded[3], folded[2], folded[1], folded[0]]] {
        let mut drawing = strokes(&[&fold, &[joint(30.0, 5.0)]]);
        drawing.runs[1].strand = 0;
        add_wall(&mut drawing, 2.0, 1.0, [GREEN; 2]);
        assert_eq!(sample(&drawing, 20.0, 32.0), opaque(WHITE));
        add_wall(&mut drawing, 4.0, 1.0, [GREEN; 2]);
        assert_eq!(sample(&drawing, 20.0, 32.0), opaque(GREEN));
        assert_eq!(sample(&drawing, 32.0, 32.0), opaque(WHITE));
    }
}

#[test]
fn perspective_depth_is_that_of_the_line_in_space() {
    // In space from x = 0 m at depth 2 m to x = 6 m at depth 6 m, drawn at x = 50 px * (x / depth).
    // At depth 3 m the line is at 1.5 m: 25 px, half-way; at a depth linear on the screen, 12.5 px.
    let radius = 0.5;
    let discs = [
        disc(0.0, 32.5, radius, 1.0 / 2.0),
        disc(50.0, 32.5, radius, 1.0 / 6.0),
    ];
    let mut drawing = strokes(&[&discs]);
    add_wall(&mut drawing, 1.0 / 3.0, 1.0, [GREEN; 2]);
    assert_eq!(sample(&drawing, 25.49, 32.5), opaque(WHITE));
    assert_eq!(sample(&drawing, 25.51, 32.5), opaque(GREEN));
}

#[test]
fn colour_is_linear_along_the_stroke_and_constant_across() {
    let mut drawing = strokes(&[&[disc(8.0, 32.0, 6.0, 1.0), disc(40.0, 32.0, 6.0, 1.0)]]);
    drawing.layers[0].colors = vec![[0.0, 1.0, 0.5], [1.0, 0.0, 0.5]];
    for y in [27.0, 32.0, 36.5] {
        assert_eq!(sample(&drawing, 16.0, y), [0.25, 0.75, 0.5, 1.0]);
    }
    assert_eq!(sample(&drawing, 45.0, 32.0), [1.0, 0.0, 0.5, 1.0]);
}

#[test]
fn colour_comes_from_the_nearest_segment_of_all_runs() {
    // Two parallel runs of one strand 6 px apart: the colour changes half-way between them.
    let upper = [disc(8.0, 29.0, 5.0, 1.0), disc(40.0, 29.0, 5.0, 1.0)];
    let lower = [disc(8.0, 35.0, 5.0, 9.0), disc(40.0, 35.0, 5.0, 9.0)];
    let mut drawing = strokes(&[&upper, &lower]);
    drawing.layers[0].colors = [RED, RED, GREEN, GREEN].to_vec();
    assert_eq!(sample(&drawing, 20.5, 31.9), opaque(GREEN)); // two strands: the nearer one
    drawing.runs[1].strand = 0;
    assert_eq!(sample(&drawing, 20.5, 31.9), opaque(RED));
    assert_eq!(sample(&drawing, 20.5, 32.1), opaque(GREEN));
}

#[test]
fn grid_converges_at_the_rate_of_lattice_points_in_a_disc() {
    // Over random places, the error of the area of a smooth convex shape on a grid of spacing h is
    // h^1.5 in the root mean square (Kendall 1948): an eighth on a grid four times as fine.
    let rms = |grid: u32| -> f64 {
        let squares = (0..50).map(|i| {
            let (x, y) = (i as f32 * 0.618_034, i as f32 * 0.754_877_7);
            let drawing = Drawing {
                size: [12, 12],
                ..strokes(&[&[disc(5.5 + x.fract(), 5.5 + y.fract(), 5.0, 1.0)]])
            };
            (sum(&reference::picture(&drawing, grid), 3) - 25.0 * PI).powi(2)
        });
        (squares.sum::<f64>() / 50.0).sqrt()
    };
    let errors = [2, 8, 32].map(rms);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((6.0..11.0).contains(&ratio), "{errors:?}");
    }
    assert!(errors[2] < 0.02, "{errors:?}");
}

#[test]
fn samples_are_where_they_are_asked_for() {
    // The left half of pixel (3, 5) is covered.
    let drawing = strokes(&[&[disc(-996.5, 5.5, 1000.0, 1.0)]]);
    let positions = [[0.1, 0.5], [0.4, 0.2], [0.6, 0.5], [0.9, 0.9]].map(DVec2::from_array);
    let picture = reference::picture_at(&drawing, &positions);
    assert_eq!(picture.pixels[5 * 64 + 3], [0.5; 4]);
    assert_eq!(picture.pixels[5 * 64 + 2], [1.0; 4]);
    assert_eq!(picture.pixels[5 * 64 + 4], [0.0; 4]);
    assert_eq!(
        reference::picture_at(&drawing, &[]).pixels[5 * 64 + 2],
        [0.0; 4]
    );
}

#[test]
fn light_is_cut_to_the_range_of_a_picture_sample_by_sample() {
    let mut drawing = strokes(&[&[disc(-996.5, 5.5, 1000.0, 1.0)]]);
    drawing.layers[0].colors[0] = [3.0, -1.0, 0.5];
    let positions = [DVec2::new(0.2, 0.5), DVec2::new(0.8, 0.5)];
    let picture = reference::picture_at(&drawing, &positions);
    assert_eq!(picture.pixels[5 * 64 + 3], [0.5, 0.0, 0.25, 0.5]);
}

#[test]
fn nothing_is_transparent_and_a_background_is_opaque() {
    let mut drawing = clumps(&[]);
    assert_eq!(sample(&drawing, 3.0, 3.0), [0.0; 4]);
    drawing.background = Some([0.25, 0.5, 0.75]);
    assert_eq!(sample(&drawing, 3.0, 3.0), [0.25, 0.5, 0.75, 1.0]);
    drawing.size = [0, 7];
    assert!(reference::picture(&drawing, 4).pixels.is_empty());
}
