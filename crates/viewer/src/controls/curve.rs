//! How a number varies along a strand, as a curve to draw and as a list of its points.

use super::icon::{Icon, icon_button};
use super::number::{NumberField, Reach, drag_value, exact, hold_steady, steady};
use super::row::Row;
use effects::{Value, Variation};
use eframe::egui::{
    Checkbox, FontId, Key, Modifiers, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo,
    emath::round_to_decimals, pos2, vec2,
};

/// Height of the drawing.
const HEIGHT: f32 = 96.0;
/// Radius of a point, and how near the pointer must come to take it.
const POINT: f32 = 4.0;
const REACH: f32 = 8.0;

/// The variation that a number of this value has.
pub(super) fn variation_of(value: &Value) -> Option<Variation> {
    match value {
        Value::Number(number) => Some(Variation {
            curve: vec![(0.0, *number)],
            vary: 0.0,
        }),
        Value::Varying(variation) => Some(variation.clone()),
        _ => None,
    }
}

/// The value of a variation, a mere number where it is one.
pub(super) fn value_of(mut variation: Variation) -> Value {
    match &mut variation.curve[..] {
        [(_, number)] if variation.vary == 0.0 => Value::Number(*number),
        [(place, _)] => {
            *place = 0.0;
            Value::Varying(variation)
        }
        _ => Value::Varying(variation),
    }
}

/// Whether it is the same number all along.
pub(super) fn is_constant(variation: &Variation) -> bool {
    variation.curve.len() == 1
}

/// The curve in little, in place of the number that it has no more.
pub(super) fn sketch(ui: &mut Ui, row: &Row, variation: &Variation, width: f32) -> bool {
    let size = vec2(width, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &row.name));
    let visuals = ui.style().interact(&response);
    let values = variation.curve.iter().map(|(_, value)| exact(*value));
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let axes = Axes {
        rect: rect.shrink2(vec2(2.0, 4.0)),
        low,
        high: if high > low { high } else { low + 1.0 },
    };
    ui.painter()
        .rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    ui.painter()
        .add(Shape::line(axes.line(&variation.curve), visuals.fg_stroke));
    response
        .on_hover_text("It varies along the strand: show the curve")
        .clicked()
}

/// How a number varies: from strand to strand, and along them. Gives the variation that its user chose.
pub(super) fn editor(
    ui: &mut Ui,
    row: &Row,
    field: &NumberField,
    variation: &Variation,
) -> Option<Variation> {
    let mut chosen = variation.clone();
    ui.horizontal(|ui| {
        let mut is_curve = !is_constant(variation);
        let along = ui.add(Checkbox::new(&mut is_curve, "along the strand"));
        if along
            .accessible_name(row.part("along the strand"))
            .changed()
        {
            let root = variation.at(0.0);
            chosen.curve = if is_curve {
                vec![(0.0, root), (1.0, root)]
            } else {
                vec![(0.0, root)]
            };
        }
        let vary = NumberField {
            range: [0.0, 1.0],
            default: 0.0,
            unit: "",
            is_whole: false,
        };
        let (response, number) =
            drag_value(ui, row, "vary", &vary, exact(variation.vary), 0.005, 52.0);
        ui.weak("vary");
        response.on_hover_text(
            "How much strands differ: 0.2 makes the number up to 20 % smaller or larger.",
        );
        if let Some(number) = number {
            chosen.vary = number as f32;
        }
    });
    if !is_constant(variation) {
        let drawn = draw(ui, row, field, &variation.curve);
        let listed = list(ui, row, field, &variation.curve);
        if let Some(curve) = drawn.or(listed) {
            chosen.curve = curve;
        }
    }
    (chosen != *variation).then_some(chosen)
}

type Curve = Vec<(f32, f32)>;

/// Where places and values are on the screen.
struct Axes {
    rect: Rect,
    low: f64,
    high: f64,
}

impl Axes {
    fn at(&self, (place, value): (f32, f32)) -> Pos2 {
        let share = (f64::from(value) - self.low) / (self.high - self.low);
        let share = share.clamp(0.0, 1.0) as f32;
        pos2(
            self.rect.left() + place * self.rect.width(),
            self.rect.bottom() - share * self.rect.height(),
        )
    }

    /// The point of the curve under a point of the screen, in round numbers.
    fn under(&self, at: Pos2, field: &NumberField) -> (f32, f32) {
        let place = (at.x - self.rect.left()) / self.rect.width();
        let share = f64::from((self.rect.bottom() - at.y) / self.rect.height());
        let value = self.low + share.clamp(0.0, 1.0) * (self.high - self.low);
        let decimals = (-((self.high - self.low) / 300.0).log10())
            .ceil()
            .clamp(0.0, 9.0);
        let [min, max] = field.range;
        let value = round_to_decimals(value, decimals as usize).clamp(min, max);
        let place = round_to_decimals(f64::from(place.clamp(0.0, 1.0)), 2);
        (place as f32, value as f32)
    }

    /// The curve from root to tip.
    fn line(&self, curve: &[(f32, f32)]) -> Vec<Pos2> {
        let ends = curve.first().zip(curve.last());
        let ends = ends.map(|(first, last)| [(0.0, first.1), (1.0, last.1)]);
        let [root, tip] = ends.unwrap_or_default();
        let whole = std::iter::once(&root).chain(curve).chain([&tip]);
        whole.map(|point| self.at(*point)).collect()
    }
}

/// The curve as it is drawn: points are dragged, a double click adds one, Delete or a click of the other button removes it.
fn draw(ui: &mut Ui, row: &Row, field: &NumberField, curve: &[(f32, f32)]) -> Option<Curve> {
    let values = || curve.iter().map(|(_, value)| exact(*value));
    let reach = steady(ui, row.id.with("axis"), || {
        let reaches = values().map(|value| field.reach(value));
        let (low, high) = reaches.fold((f64::MAX, f64::MIN), |(low, high), reach| {
            (low.min(reach.low), high.max(reach.high))
        });
        Reach {
            low,
            high,
            is_logarithmic: false,
        }
    });
    let size = vec2(ui.available_width(), HEIGHT);
    // Keys go to the list below, not to the drawing.
    let (rect, sheet) = ui.allocate_exact_size(size, Sense::CLICK);
    sheet.widget_info(|| WidgetInfo::labeled(Role::Image, true, row.part("curve")));
    let axes = Axes {
        rect: rect.shrink2(vec2(REACH, REACH)),
        low: reach.low,
        high: reach.high,
    };
    paint(ui, &axes, curve);

    let mut changed: Option<Curve> = None;
    let mut removed = None;
    let mut is_dragged = false;
    let selected_id = row.id.with("selected point");
    for (i, point) in curve.iter().enumerate() {
        let at = axes.at(*point);
        let area = Rect::from_center_size(at, vec2(2.0 * REACH, 2.0 * REACH));
        let response = ui.interact(area, row.id.with(("point", i)), Sense::CLICK | Sense::DRAG);
        if response.clicked() || response.drag_started() {
            ui.data_mut(|data| data.insert_temp(selected_id, i));
        }
        if let Some(pointer) = response
            .interact_pointer_pos()
            .filter(|_| response.dragged())
        {
            is_dragged = true;
            changed = Some(moved(curve, i, axes.under(pointer, field)));
        }
        if response.secondary_clicked() {
            removed = Some(i);
        }
        let is_selected = ui.data(|data| data.get_temp(selected_id)) == Some(i);
        let visuals = ui.style().interact_selectable(&response, is_selected);
        ui.painter()
            .circle(at, POINT, visuals.bg_fill, visuals.fg_stroke);
    }
    let has_keys = sheet.contains_pointer() && ui.memory(|memory| memory.focused().is_none());
    if has_keys && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Delete)) {
        removed = ui.data(|data| data.get_temp(selected_id));
    }
    if let Some(pointer) = sheet
        .interact_pointer_pos()
        .filter(|_| sheet.double_clicked())
    {
        changed = Some(with(curve, axes.under(pointer, field)));
    }
    if let Some(i) = removed.filter(|i| *i < curve.len() && curve.len() > 1) {
        ui.data_mut(|data| data.remove::<usize>(selected_id));
        changed = Some(without(curve, i));
    }
    hold_steady(ui, row.id.with("axis"), reach, is_dragged);
    sheet.on_hover_text(
        "From the root on the left to the tip on the right. Drag points; a double click adds one, \
         a click of the other button or Delete removes it.",
    );
    changed
}

fn paint(ui: &Ui, axes: &Axes, curve: &[(f32, f32)]) {
    let painter = ui.painter();
    let visuals = ui.visuals();
    painter.rect_filled(
        axes.rect.expand(REACH),
        visuals.widgets.inactive.corner_radius,
        visuals.extreme_bg_color,
    );
    let grid = Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color);
    for place in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let x = axes.rect.left() + place * axes.rect.width();
        painter.vline(x, axes.rect.y_range(), grid);
    }
    let font = FontId::proportional(9.0);
    let weak = visuals.text_color();
    let corner = axes.rect.left_top();
    let high = (axes.high as f32).to_string();
    painter.text(
        corner,
        eframe::egui::Align2::LEFT_TOP,
        high,
        font.clone(),
        weak,
    );
    let corner = axes.rect.left_bottom();
    let low = (axes.low as f32).to_string();
    painter.text(corner, eframe::egui::Align2::LEFT_BOTTOM, low, font, weak);
    let line = Stroke::new(1.5, visuals.text_color());
    painter.add(Shape::line(axes.line(curve), line));
}

/// The points as numbers.
fn list(ui: &mut Ui, row: &Row, field: &NumberField, curve: &[(f32, f32)]) -> Option<Curve> {
    let mut changed = None;
    for (i, &(place, value)) in curve.iter().enumerate() {
        ui.push_id(i, |ui| {
            ui.horizontal(|ui| {
                let part = |what: &str| format!("point {} {what}", i + 1);
                let [from, to] = between(curve, i);
                let places = NumberField {
                    range: [exact(from), exact(to)],
                    default: 0.0,
                    unit: "",
                    is_whole: false,
                };
                let name = part("place");
                let (_, new) = drag_value(ui, row, &name, &places, exact(place), 0.005, 52.0);
                let new_place = new.map_or(place, |new| new as f32);
                let reach = field.reach(exact(value));
                let speed = (reach.high - reach.low) / 300.0;
                let (_, new) =
                    drag_value(ui, row, &part("value"), field, exact(value), speed, 70.0);
                let new_value = new.map_or(value, |new| new as f32);
                if (new_place, new_value) != (place, value) {
                    changed = Some(moved(curve, i, (new_place, new_value)));
                }
                let remove = row.part(&format!("remove point {}", i + 1));
                if icon_button(ui, Icon::Remove, &remove, "").clicked() {
                    changed = Some(without(curve, i));
                }
            });
        });
    }
    if icon_button(ui, Icon::Add, &row.part("add point"), "Add a point").clicked() {
        changed = Some(with(curve, widest_gap(curve)));
    }
    changed
}

/// The places that a point may have: from that of the one before it to that of the one after it.
fn between(curve: &[(f32, f32)], i: usize) -> [f32; 2] {
    let before = i.checked_sub(1).and_then(|before| curve.get(before));
    let after = curve.get(i + 1);
    [
        before.map_or(0.0, |(place, _)| *place),
        after.map_or(1.0, |(place, _)| *place),
    ]
}

fn moved(curve: &[(f32, f32)], i: usize, (place, value): (f32, f32)) -> Curve {
    let [from, to] = between(curve, i);
    let mut curve = curve.to_vec();
    curve[i] = (place.clamp(from, to), value);
    curve
}

fn without(curve: &[(f32, f32)], i: usize) -> Curve {
    let mut curve = curve.to_vec();
    if curve.len() > 1 {
        curve.remove(i);
    }
    curve
}

fn with(curve: &[(f32, f32)], point: (f32, f32)) -> Curve {
    let mut curve = curve.to_vec();
    let at = curve.partition_point(|(place, _)| *place <= point.0);
    curve.insert(at, point);
    curve
}

/// The point of the curve in the middle of the widest stretch without one.
fn widest_gap(curve: &[(f32, f32)]) -> (f32, f32) {
    let places = || curve.iter().map(|(place, _)| *place);
    let starts = std::iter::once(0.0).chain(places());
    let ends = places().chain([1.0]);
    let gaps = starts.zip(ends);
    let widest = gaps.max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
    let (start, end) = widest.unwrap_or((0.0, 1.0));
    let place = round_to_decimals(f64::from(0.5 * (start + end)), 3) as f32;
    let variation = Variation {
        curve: curve.to_vec(),
        vary: 0.0,
    };
    (place, variation.at(place))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVE: [(f32, f32); 3] = [(0.0, 1.0), (0.2, 2.0), (1.0, 4.0)];

    #[test]
    fn points_stay_in_order() {
        assert_eq!(moved(&CURVE, 1, (3.0, 9.0))[1], (1.0, 9.0));
        assert_eq!(moved(&CURVE, 0, (-1.0, 9.0))[0], (0.0, 9.0));
        assert_eq!(with(&CURVE, (0.1, 7.0))[1], (0.1, 7.0));
        assert_eq!(with(&CURVE, (1.0, 7.0))[3], (1.0, 7.0));
        assert_eq!(without(&CURVE, 2), CURVE[..2].to_vec());
        assert_eq!(without(&CURVE[..1], 0), CURVE[..1].to_vec());
        assert_eq!(widest_gap(&CURVE), (0.6, 3.0));
    }

    #[test]
    fn what_does_not_vary_is_a_number() {
        let mut one = Variation {
            curve: vec![(0.5, 3.0)],
            vary: 0.0,
        };
        assert_eq!(value_of(one.clone()), Value::Number(3.0));
        one.vary = 0.1;
        let kept = variation_of(&value_of(one)).unwrap();
        assert_eq!((kept.curve, kept.vary), (vec![(0.0, 3.0)], 0.1));
        let curve = Variation {
            curve: CURVE.to_vec(),
            vary: 0.0,
        };
        assert_eq!(value_of(curve.clone()), Value::Varying(curve));
    }
}
