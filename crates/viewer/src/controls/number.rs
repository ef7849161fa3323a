//! Numbers: typed or dragged within all of their range, or moved on a slider over a sensible part of it.

use super::help::short_unit;
use super::row::Row;
use eframe::egui::accesskit::{Action, ActionData};
use eframe::egui::emath::round_to_decimals;
use eframe::egui::{DragValue, Id, Response, Slider, SliderClamping, Ui, vec2};
use std::cell::RefCell;

/// Width of a number's field, and of one that has a word for its unit.
const FIELD: f32 = 54.0;
const FIELD_WITH_UNIT: f32 = 88.0;
/// The least width of a slider that is of use.
const LEAST_SLIDER: f32 = 20.0;

/// A number as its schema has it.
#[derive(Clone, Copy)]
pub(crate) struct NumberField<'a> {
    /// Least and largest value.
    pub range: [f64; 2],
    /// Value where the text says nothing.
    pub default: f64,
    /// Unit, empty where there is none.
    pub unit: &'a str,
    /// Whether there is nothing between 1 and 2.
    pub is_whole: bool,
}

/// The part of a range that a slider goes over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    pub low: f64,
    pub high: f64,
    pub is_logarithmic: bool,
}

/// The number that an `f32` is written as.
pub(super) fn exact(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

impl NumberField<'_> {
    /// The sensible part of the range, around the default and this value.
    pub(super) fn reach(&self, value: f64) -> Reach {
        let [min, max] = self.range;
        let own = self.own_reach();
        if own.is_logarithmic {
            return Reach {
                low: own.low.min(nice_below(value)).max(min),
                high: own.high.max(nice_above(value)).min(max),
                ..own
            };
        }
        let low = if value < own.low {
            -nice_above(-2.0 * value)
        } else {
            own.low
        };
        let high = if value > own.high {
            nice_above(2.0 * value)
        } else {
            own.high
        };
        Reach {
            low: low.max(min),
            high: high.min(max),
            ..own
        }
    }

    /// The sensible part of the range around the default.
    fn own_reach(&self) -> Reach {
        let [min, max] = self.range;
        let size = self.default.abs();
        let linear = |low: f64, high: f64| Reach {
            low: low.max(min),
            high: high.min(max),
            is_logarithmic: false,
        };
        if self.unit == "degrees" {
            return if max - min <= 720.0 {
                linear(min, max)
            } else {
                linear(-180.0, 180.0)
            };
        }
        if max - min <= 20.0 && max <= 20.0 * size.max(1.0) || self.is_whole && max - min <= 64.0 {
            return linear(min, max);
        }
        if min > 0.0 && max / min >= 100.0 && size > 0.0 {
            return Reach {
                low: (size / 100.0).max(min),
                high: (size * 100.0).min(max),
                is_logarithmic: true,
            };
        }
        let reach = if size > 0.0 && size < max {
            nice_above(4.0 * size)
        } else if self.unit == "s" {
            10.0
        } else {
            nice_above((max - min).sqrt())
        };
        linear(-reach, reach)
    }

    /// How much a value changes where a point of the screen is dragged over.
    fn speed(&self, reach: Reach, value: f64) -> f64 {
        let speed = if reach.is_logarithmic {
            0.01 * value.abs().max(reach.low)
        } else {
            (reach.high - reach.low) / 300.0
        };
        if self.is_whole { speed.max(0.1) } else { speed }
    }

    /// A value from the slider, with no more digits than its place on it has.
    fn rounded(&self, reach: Reach, value: f64) -> f64 {
        if self.is_whole {
            return value.round();
        }
        let step = if reach.is_logarithmic {
            value.abs().max(1e-9) / 100.0
        } else {
            (reach.high - reach.low) / 1000.0
        };
        let decimals = (-step.log10()).ceil().clamp(0.0, 9.0);
        round_to_decimals(value, decimals as usize)
    }
}

/// The least of 1, 2, 5, 10, 20, ... that is not below a value above 0.
fn nice_above(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.max(1e-9).log10().floor());
    let factors = [1.0, 2.0, 5.0, 10.0];
    let is_above = |factor: &&f64| **factor * power >= value * (1.0 - 1e-9);
    factors
        .iter()
        .find(is_above)
        .map_or(10.0 * power, |factor| factor * power)
}

/// The largest of 1, 0.5, 0.2, 0.1, ... that is not above a value above 0.
fn nice_below(value: f64) -> f64 {
    1.0 / nice_above(1.0 / value.max(1e-9))
}

/// A field for a number, and a slider where there is room for one in `width`. Gives the number that its user chose.
pub(super) fn number(
    ui: &mut Ui,
    row: &Row,
    field: &NumberField,
    value: f64,
    width: f32,
) -> (Response, Option<f64>) {
    let reach = steady(ui, row.id.with("reach"), || field.reach(value));
    let gap = 4.0;
    ui.spacing_mut().item_spacing.x = gap;
    let field_width = match short_unit(field.unit).chars().count() {
        0..=3 => FIELD,
        _ => FIELD_WITH_UNIT,
    };
    let [min, max] = field.range;
    let room = if min < max {
        width - field_width - gap
    } else {
        0.0
    };
    let mut slid = value;
    let mut is_sliding = false;
    if room >= LEAST_SLIDER {
        ui.spacing_mut().slider_width = room;
        let mut slider = Slider::new(&mut slid, reach.low..=reach.high)
            .show_value(false)
            .clamping(SliderClamping::Never)
            .logarithmic(reach.is_logarithmic);
        if field.is_whole {
            slider = slider.step_by(1.0);
        }
        let response = ui.add(slider).accessible_name(row.part("slider"));
        is_sliding = response.dragged();
        slid = if response.changed() {
            field.rounded(reach, slid).clamp(min, max)
        } else {
            value
        };
    }
    let speed = field.speed(reach, value);
    let (response, typed) = drag_value(ui, row, "", field, value, speed, field_width);
    hold_steady(
        ui,
        row.id.with("reach"),
        reach,
        is_sliding || response.dragged(),
    );
    let chosen = typed.or((slid != value).then_some(slid));
    (response, chosen)
}

/// What was kept of a value that must not change while something is dragged, or a new one.
pub(super) fn steady<T: Clone + Send + Sync + 'static>(
    ui: &Ui,
    id: Id,
    new: impl FnOnce() -> T,
) -> T {
    ui.data(|data| data.get_temp::<T>(id)).unwrap_or_else(new)
}

/// Keeps a value for the next frame as long as something is dragged.
pub(super) fn hold_steady<T: Clone + Send + Sync + 'static>(
    ui: &Ui,
    id: Id,
    value: T,
    is_dragged: bool,
) {
    ui.data_mut(|data| {
        if is_dragged {
            data.insert_temp(id, value);
        } else {
            data.remove::<T>(id);
        }
    });
}

/// A field for a number alone. Numbers out of range come to its end, which is noted below the row.
pub(crate) fn drag_value(
    ui: &mut Ui,
    row: &Row,
    part: &str,
    field: &NumberField,
    value: f64,
    speed: f64,
    width: f32,
) -> (Response, Option<f64>) {
    let name = if part.is_empty() {
        row.name.clone()
    } else {
        row.part(part)
    };
    let [min, max] = field.range;
    let unit = short_unit(field.unit);
    let typed = RefCell::new(None);
    let parse = |text: &str| {
        let number = typed_number(text, unit).map(|n| if field.is_whole { n.round() } else { n });
        *typed.borrow_mut() = Some((text.to_owned(), number));
        number
    };
    // A long number needs the room.
    let is_short = (value as f32).to_string().len() <= 6;
    let suffix = if is_short { unit } else { "" };
    let mut new = value;
    let drag_value = DragValue::new(&mut new)
        .speed(speed)
        .range(min..=max)
        // What a file has stays until somebody changes it.
        .clamp_existing_to_range(false)
        .update_while_editing(false)
        .min_size(vec2(width, ui.spacing().interact_size.y))
        .suffix(suffix)
        .custom_formatter(|number, _| (number as f32).to_string())
        .custom_parser(parse);
    let response = ui.add(drag_value).accessible_name(name);
    if new != value {
        new = new.clamp(min, max);
    }

    let asked = ui.input(|input| {
        let requests = input.accesskit_action_requests(response.id, Action::SetValue);
        let number = |data: &Option<ActionData>| match data {
            Some(ActionData::NumericValue(number)) => Some((number.to_string(), Some(*number))),
            _ => None,
        };
        requests.filter_map(|request| number(&request.data)).last()
    });
    match typed.into_inner().or(asked) {
        Some((text, None)) => row.note(ui, format!("`{text:.20}` is no number")),
        Some((text, Some(number))) if !(min..=max).contains(&number) => {
            row.note(
                ui,
                format!("`{text:.20}` is not from {min} to {max}: {new} was taken"),
            );
        }
        _ => {}
    }
    if field.is_whole {
        new = new.round();
    }
    let is_new = new != value && new.is_finite();
    (response, is_new.then_some(new))
}

/// The finite number that somebody typed, maybe with a comma for the point and with its unit.
fn typed_number(text: &str, unit: &str) -> Option<f64> {
    let text = text.trim().replace('−', "-").replace(',', ".");
    let text = text.strip_suffix(unit.trim()).unwrap_or(&text).trim();
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(default: f64, min: f64, max: f64, unit: &str) -> NumberField<'_> {
        NumberField {
            range: [min, max],
            default,
            unit,
            is_whole: false,
        }
    }

    #[test]
    fn sliders_go_over_a_sensible_part() {
        let reach = |field: NumberField, value: f64| {
            let reach = field.reach(value);
            (reach.low, reach.high, reach.is_logarithmic)
        };
        // All of a small range.
        assert_eq!(reach(field(0.5, 0.0, 1.0, ""), 0.5), (0.0, 1.0, false));
        assert_eq!(
            reach(field(35.0, -360.0, 360.0, "degrees"), 35.0),
            (-360.0, 360.0, false)
        );
        // A part of a large one, and more where the value is beyond.
        assert_eq!(
            reach(field(15.0, -3600.0, 3600.0, "degrees"), 0.0),
            (-180.0, 180.0, false)
        );
        assert_eq!(reach(field(2.2, 0.0, 100.0, ""), 2.2), (0.0, 10.0, false));
        assert_eq!(reach(field(2.2, 0.0, 100.0, ""), 30.0), (0.0, 100.0, false));
        assert_eq!(
            reach(field(0.0, -1000.0, 1000.0, "m"), -60.0),
            (-200.0, 50.0, false)
        );
        assert_eq!(reach(field(0.0, 0.0, 1e6, "s"), 1.0), (0.0, 10.0, false));
        // Decades.
        assert_eq!(
            reach(field(1.0, 0.001, 1000.0, ""), 1.0),
            (0.01, 100.0, true)
        );
        assert_eq!(
            reach(field(1.0, 0.001, 1000.0, ""), 700.0),
            (0.01, 1000.0, true)
        );
        assert_eq!(reach(field(1e6, 0.001, 1e6, "s"), 1.5), (1.0, 1e6, true));
    }

    #[test]
    fn people_type_numbers_in_many_ways() {
        for (text, expected) in [
            ("2.5", Some(2.5)),
            (" 2,5 ", Some(2.5)),
            ("−3", Some(-3.0)),
            ("45°", Some(45.0)),
            ("NaN", None),
            ("inf", None),
            ("", None),
            ("thick", None),
        ] {
            assert_eq!(typed_number(text, "°"), expected, "{text}");
        }
        assert_eq!(typed_number("2 heads", " heads"), Some(2.0));
    }
}
