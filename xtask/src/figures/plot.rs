//! Curves measured on pictures, as small SVG plots.

use std::fmt::Write as _;

/// A curve: its name and its points.
pub struct Curve {
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

/// A plot of curves over x = 0 to 1 and y = 0 to 1, with level lines.
pub struct Plot<'a> {
    pub x_axis: &'a str,
    pub y_axis: &'a str,
    pub curves: &'a [Curve],
    /// Horizontal lines: name and height.
    pub levels: &'a [(&'a str, f64)],
}

const COLORS: [&str; 6] = [
    "#1c6fb0", "#c8453a", "#3a8f4d", "#8a5fb5", "#b07b1c", "#444",
];
const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 240.0;
const LEFT: f64 = 40.0;
const BOTTOM: f64 = 36.0;
const TOP: f64 = 24.0;
/// Room for the names of curves.
const RIGHT: f64 = 190.0;

impl Plot<'_> {
    /// The plot as an SVG element.
    pub fn svg(&self) -> String {
        let x = |u: f64| LEFT + u.clamp(0.0, 1.0) * WIDTH;
        let y = |v: f64| TOP + (1.0 - v.clamp(0.0, 1.0)) * HEIGHT;
        let (full_width, full_height) = (LEFT + WIDTH + RIGHT, TOP + HEIGHT + BOTTOM);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{full_width}\" height=\"{full_height}\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <path d=\"M{} {} V{} H{}\" fill=\"none\" stroke=\"#333\"/>\n",
            x(0.0),
            y(1.0),
            y(0.0),
            x(1.0)
        );
        let mut text = |at: (f64, f64), anchor: &str, color: &str, text: &str| {
            // Writing to a String cannot fail.
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{color}\">{text}</text>",
                at.0, at.1
            );
        };
        text((x(0.5), y(0.0) + 30.0), "middle", "#333", self.x_axis);
        for tick in [0.0, 0.5, 1.0] {
            text(
                (x(tick), y(0.0) + 15.0),
                "middle",
                "#333",
                &tick.to_string(),
            );
            text(
                (x(0.0) - 5.0, y(tick) + 4.0),
                "end",
                "#333",
                &tick.to_string(),
            );
        }
        text((x(0.0) - 8.0, y(1.0) - 10.0), "start", "#333", self.y_axis);
        for (i, curve) in self.curves.iter().enumerate() {
            let row = TOP + 14.0 + 18.0 * i as f64;
            text(
                (x(1.0) + 14.0, row),
                "start",
                COLORS[i % COLORS.len()],
                &curve.name,
            );
        }
        for (name, level) in self.levels {
            text((x(1.0) + 14.0, y(*level) + 4.0), "start", "#777", name);
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let points: Vec<String> = curve
                .points
                .iter()
                .map(|(u, v)| format!("{:.1},{:.1}", x(*u), y(*v)))
                .collect();
            let color = COLORS[i % COLORS.len()];
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>",
                points.join(" ")
            );
        }
        for (_, level) in self.levels {
            let _ = writeln!(
                svg,
                "<path d=\"M{} {:.1} H{}\" stroke=\"#999\" stroke-dasharray=\"4 3\"/>",
                x(0.0),
                y(*level),
                x(1.0)
            );
        }
        svg + "</svg>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_levels_and_names_are_drawn() {
        let curves = [Curve {
            name: "size".to_owned(),
            points: vec![(0.0, 0.0), (1.0, 1.0)],
        }];
        let plot = Plot {
            x_axis: "u",
            y_axis: "width",
            curves: &curves,
            levels: &[("edge", 0.5)],
        };
        let svg = plot.svg();
        assert!(svg.contains("points=\"40.0,264.0 520.0,24.0\""), "{svg}");
        assert!(svg.contains("M40 144.0 H520") && svg.contains(">size<") && svg.contains(">edge<"));
    }
}
