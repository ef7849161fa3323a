//! Buttons that are one sign, drawn as lines: the window's font has no such signs.

use eframe::egui::{
    Color32, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};
use std::f32::consts::TAU;

/// Width of a button that is one sign.
pub(crate) const ICON: f32 = 20.0;
/// Width and height of a sign.
const SIGN: f32 = 11.0;

/// A sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Icon {
    /// A turn back.
    Reset,
    /// A plus.
    Add,
    /// A bin.
    Remove,
    /// Two sheets.
    Copy,
    /// An arrowhead.
    Up,
    /// An arrowhead.
    Down,
    /// An eye.
    Eye,
    /// An eye that is struck out.
    ClosedEye,
}

/// A button with a sign. `name` is for screen readers, `help` is shown above it, the name where that is empty.
pub(crate) fn icon_button(ui: &mut Ui, icon: Icon, name: &str, help: &str) -> Response {
    let size = vec2(ICON, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        if response.hovered() || response.has_focus() {
            ui.painter()
                .rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
        }
        let color = match icon {
            Icon::ClosedEye => ui.visuals().weak_text_color(),
            _ => visuals.fg_stroke.color,
        };
        let sign = Rect::from_center_size(rect.center(), vec2(SIGN, SIGN));
        for shape in icon.shapes(sign, color) {
            ui.painter().add(shape);
        }
    }
    let help = if help.is_empty() { name } else { help };
    response.on_hover_text(help)
}

impl Icon {
    /// Its lines in a square.
    fn shapes(self, square: Rect, color: Color32) -> Vec<Shape> {
        let stroke = Stroke::new(1.2, color);
        // From 0, the upper left, to 1.
        let at = |x: f32, y: f32| square.lerp_inside(vec2(x, y));
        let line = |points: &[(f32, f32)]| {
            let points = points.iter().map(|(x, y)| at(*x, *y)).collect();
            Shape::line(points, stroke)
        };
        let eye = || {
            let lid = |height: f32| {
                let points = (0..=12).map(|i| {
                    let x = i as f32 / 12.0;
                    at(x, 0.5 + height * (0.5 * TAU * x).sin())
                });
                Shape::line(points.collect(), stroke)
            };
            let pupil = Shape::circle_filled(at(0.5, 0.5), 0.17 * SIGN, color);
            vec![lid(-0.4), lid(0.4), pupil]
        };
        match self {
            Self::Reset => {
                let turn = |angle: f32| at(0.5 + 0.42 * angle.cos(), 0.5 + 0.42 * angle.sin());
                let points: Vec<Pos2> = (0..=14).map(|i| turn(-0.6 - 0.33 * i as f32)).collect();
                let end = turn(-0.6 - 0.33 * 14.0);
                let head = vec![
                    end,
                    pos2(end.x + 4.0, end.y + 0.5),
                    pos2(end.x + 0.5, end.y - 4.0),
                ];
                let head = Shape::convex_polygon(head, color, Stroke::NONE);
                vec![Shape::line(points, stroke), head]
            }
            Self::Add => vec![
                line(&[(0.5, 0.05), (0.5, 0.95)]),
                line(&[(0.05, 0.5), (0.95, 0.5)]),
            ],
            Self::Remove => vec![
                line(&[(0.05, 0.2), (0.95, 0.2)]),
                line(&[(0.35, 0.2), (0.35, 0.02), (0.65, 0.02), (0.65, 0.2)]),
                line(&[(0.17, 0.2), (0.23, 1.0), (0.77, 1.0), (0.83, 0.2)]),
                line(&[(0.5, 0.4), (0.5, 0.8)]),
            ],
            Self::Copy => {
                let sheet = |from: f32, to: f32| {
                    let sheet = Rect::from_two_pos(at(from, from), at(to, to));
                    Shape::rect_stroke(sheet, 1.0, stroke, StrokeKind::Middle)
                };
                vec![sheet(0.0, 0.68), sheet(0.32, 1.0)]
            }
            Self::Up => vec![line(&[(0.1, 0.7), (0.5, 0.3), (0.9, 0.7)])],
            Self::Down => vec![line(&[(0.1, 0.3), (0.5, 0.7), (0.9, 0.3)])],
            Self::Eye => eye(),
            Self::ClosedEye => {
                let mut eye = eye();
                eye.push(line(&[(0.1, 0.95), (0.9, 0.05)]));
                eye
            }
        }
    }
}
