//! Time against error, a panel a scene.

use crate::BenchError;
use crate::results::Row;
use plotters::coord::combinators::IntoLogRange as _;
use plotters::prelude::*;

/// Of a panel, in pixels.
const PANEL: (u32, u32) = (760, 520);

/// An SVG in which each method is a line along its knob: errors to the right, described by `errors`, times
/// upwards, both logarithmic. Rows without a finite error are left out.
///
/// # Errors
///
/// When the plot cannot be drawn.
pub fn time_against_error(rows: &[Row], errors: &str) -> Result<String, BenchError> {
    let mut scenes: Vec<&str> = Vec::new();
    let mut methods: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| has_place(row)) {
        if !scenes.contains(&row.scene.as_str()) {
            scenes.push(&row.scene);
        }
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    let columns = scenes.len().clamp(1, 2);
    let lines = scenes.len().div_ceil(2).max(1);
    let size = (PANEL.0 * columns as u32, PANEL.1 * lines as u32);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(|error| error.to_string())?;
        let panels = area.split_evenly((lines, columns));
        for (scene, panel) in scenes.iter().zip(&panels) {
            let rows: Vec<&Row> = rows.iter().filter(|row| row.scene == *scene).collect();
            draw_panel(scene, &rows, &methods, errors, panel).map_err(|error| error.to_string())?;
        }
        area.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}

/// A logarithmic scale has no place for 0, for infinity and for nothing.
fn has_place(row: &Row) -> bool {
    row.error
        .is_some_and(|error| error > 0.0 && error.is_finite())
        && row.seconds > 0.0
}

fn draw_panel<B: DrawingBackend>(
    scene: &str,
    rows: &[&Row],
    methods: &[&str],
    errors: &str,
    area: &DrawingArea<B, plotters::coord::Shift>,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| has_place(row))
        .filter_map(|row| Some((row.error?, 1e3 * row.seconds)))
        .collect();
    let range = |values: fn(&(f64, f64)) -> f64| {
        let values = || points.iter().map(values);
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(0.0, f64::max);
        0.7 * least..1.4 * most
    };
    let mut chart = ChartBuilder::on(area)
        .caption(scene, ("sans-serif", 22))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(64)
        .build_cartesian_2d(
            range(|point| point.0).log_scale(),
            range(|point| point.1).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc(errors)
        .y_desc("milliseconds")
        .x_label_formatter(&|error| format!("{error:.0e}"))
        .draw()?;
    for (index, method) in methods.iter().enumerate() {
        let mut rows: Vec<&&Row> = rows
            .iter()
            .filter(|row| row.method == *method && has_place(row))
            .collect();
        if rows.is_empty() {
            continue;
        }
        rows.sort_by_key(|row| row.knob);
        let color = Palette99::pick(index).to_rgba();
        let place = |row: &&&Row| (row.error.unwrap_or_default(), 1e3 * row.seconds);
        chart
            .draw_series(LineSeries::new(
                rows.iter().map(place),
                color.stroke_width(2),
            ))?
            .label(*method)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(3)));
        chart.draw_series(
            rows.iter()
                .map(|row| Circle::new(place(row), 3, color.filled())),
        )?;
        chart.draw_series(rows.iter().map(|row| {
            let style = ("sans-serif", 11).into_font().color(&BLACK.mix(0.7));
            Text::new(row.knob.to_string(), place(row), style)
        }))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_method_and_knob_is_in_the_plot() {
        let row = |scene: &str, method: &str, knob, error| Row {
            scene: scene.to_owned(),
            method: method.to_owned(),
            knob,
            seconds: 0.01 * knob as f64,
            error,
        };
        let rows = [
            row("tails", "sweep", 1, Some(0.1)),
            row("tails", "sweep", 4, Some(0.02)),
            row("curtain", "stamping", 17, Some(0.3)),
            row("curtain", "paths", 1, None),
            row("curtain", "perfect", 1, Some(0.0)),
            row("curtain", "broken", 1, Some(f64::INFINITY)),
        ];
        let svg = time_against_error(&rows, "mean error").unwrap();
        for text in [
            "tails",
            "curtain",
            "sweep",
            "stamping",
            "17",
            "milliseconds",
            "mean error",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        for text in ["paths", "perfect", "broken"] {
            assert!(!svg.contains(text), "{text}");
        }
        assert!(svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn no_rows_are_an_empty_plot() {
        assert!(time_against_error(&[], "").unwrap().contains("<svg"));
    }
}
