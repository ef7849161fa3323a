//! Time below the picture: buttons, the line of time with the script's moves, the wind's dial.

use crate::actions::Action;
use crate::grip::STRONGEST_WIND;
use crate::studio::Studio;
use crate::transport::SPEEDS;
use eframe::egui::{
    Align2, Button, Color32, ComboBox, EventFilter, FontId, Id, Key, Pos2, Rect, Sense, Stroke,
    StrokeKind, Ui, pos2, vec2,
};

/// Height of a row of moves on the line, points.
const ROW: f32 = 13.0;
/// Rows that are shown.
const ROWS: usize = 3;
/// The dial's side, points.
const DIAL: f32 = 54.0;

/// Shows time.
pub fn timeline(ui: &mut Ui, studio: &mut Studio) {
    ui.horizontal(|ui| {
        ui.vertical(|ui| {
            ui.set_width((ui.available_width() - DIAL - 16.0).max(120.0));
            ui.horizontal_wrapped(|ui| buttons(ui, studio));
            line(ui, studio);
        });
        dial(ui, studio);
    });
}

fn buttons(ui: &mut Ui, studio: &mut Studio) {
    let is_playing = studio.transport.is_playing;
    for (action, label) in [
        (Action::Rewind, "|<"),
        (Action::StepBack, "<"),
        (Action::Play, if is_playing { "Pause" } else { "Play" }),
        (Action::StepOn, ">"),
    ] {
        let entry = action.entry();
        let about = format!("{} ({})", entry.about, entry.key_text(ui.ctx()));
        let button = ui.add(Button::new(label)).on_hover_text(about);
        if button.accessible_name(entry.name).clicked() {
            studio.act(action);
        }
    }
    let transport = &mut studio.transport;
    ComboBox::from_id_salt("speed")
        .selected_text(format!("{} x", transport.speed))
        .width(56.0)
        .show_ui(ui, |ui| {
            for speed in SPEEDS {
                ui.selectable_value(&mut transport.speed, speed, format!("{speed} x"));
            }
        })
        .response
        .accessible_name("Speed")
        .on_hover_text("How fast time runs");
    ui.checkbox(&mut transport.is_looping, "loop");
    ui.label(format!(
        "frame {}  {:.2} s",
        transport.frame(),
        transport.shown_s()
    ));
}

fn line(ui: &mut Ui, studio: &mut Studio) {
    let size = vec2(ui.available_width(), ROW * ROWS as f32 + 6.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let response = response.accessible_name("Time line");
    let span = studio.transport.span_s().max(1e-3);
    let x = |time_s: f32| rect.left() + rect.width() * (time_s / span).clamp(0.0, 1.0);
    if let Some(at) = response
        .interact_pointer_pos()
        .filter(|_| response.dragged() || response.clicked())
    {
        studio.transport.is_playing = false;
        studio
            .transport
            .seek(span * (at.x - rect.left()) / rect.width());
        studio.is_dragging |= response.dragged();
    }
    if response.has_focus() {
        keep_arrows(ui, response.id);
        for (key, frames) in [(Key::ArrowLeft, -1), (Key::ArrowRight, 1)] {
            if ui.input(|input| input.key_pressed(key)) {
                studio.transport.step(frames);
            }
        }
    }
    let painter = ui.painter_at(rect);
    let visuals = ui.visuals();
    painter.rect_filled(rect, 2.0, visuals.extreme_bg_color);
    let font = FontId::proportional(10.0);
    for (index, span) in studio.track.spans.iter().enumerate() {
        let top = rect.top() + 3.0 + ROW * (index % ROWS) as f32;
        let (from, to) = (x(span.start_s), x(span.start_s + span.length_s));
        let bar = Rect::from_min_max(pos2(from, top), pos2(to.max(from + 3.0), top + ROW - 2.0));
        painter.rect_filled(bar, 2.0, color(span.list));
        painter.with_clip_rect(bar.intersect(rect)).text(
            bar.left_center() + vec2(3.0, 0.0),
            Align2::LEFT_CENTER,
            &span.name,
            font.clone(),
            Color32::BLACK,
        );
    }
    let mut second = 1.0;
    while second < span && span <= 120.0 {
        painter.vline(
            x(second),
            rect.y_range(),
            Stroke::new(0.5, visuals.weak_text_color()),
        );
        second += 1.0;
    }
    painter.vline(
        x(studio.transport.shown_s()),
        rect.y_range(),
        Stroke::new(2.0, Color32::from_rgb(230, 70, 100)),
    );
    let told = studio.track.spans.iter().find(|span| {
        let at = response
            .hover_pos()
            .map_or(-1.0, |at| span_at(rect, at, studio.transport.span_s()));
        at >= span.start_s
            && at <= span.start_s + span.length_s.max(0.02 * studio.transport.span_s())
    });
    if let Some(span) = told {
        let text = format!(
            "{} {} of {}, from {} s on",
            span.name, span.index, span.list, span.start_s
        );
        response.on_hover_text_at_pointer(text);
    }
}

fn span_at(rect: Rect, at: Pos2, span_s: f32) -> f32 {
    span_s * (at.x - rect.left()) / rect.width()
}

fn color(list: &str) -> Color32 {
    match list {
        "moves" => Color32::from_rgb(120, 190, 230),
        "winds" => Color32::from_rgb(150, 220, 160),
        "keys" => Color32::from_rgb(240, 200, 110),
        "body_keys" => Color32::from_rgb(225, 160, 120),
        _ => Color32::from_rgb(220, 150, 210),
    }
}

/// Arrows are for what has the keyboard, and don't go to the next widget.
pub(super) fn keep_arrows(ui: &Ui, id: Id) {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
}

/// The wind of the dial: seen from above, the face below; where the point is dragged, wind blows to.
fn dial(ui: &mut Ui, studio: &mut Studio) {
    let (rect, response) = ui.allocate_exact_size(vec2(DIAL, DIAL), Sense::click_and_drag());
    let response = response.accessible_name("Wind").on_hover_text(
        "Wind, seen from above with the face below: drag to where it blows; a double click ends it. It is not a part of the preset.",
    );
    let radius = 0.5 * DIAL - 3.0;
    if let Some(at) = response
        .interact_pointer_pos()
        .filter(|_| response.dragged())
    {
        let away = (at - rect.center()) / radius;
        let wind = glam::Vec2::new(away.x, away.y).clamp_length_max(1.0);
        studio.grip.wind = STRONGEST_WIND * wind;
        studio.transport.is_playing |= response.drag_started();
        studio.is_dragging = true;
    }
    if response.double_clicked() {
        studio.grip.wind = glam::Vec2::ZERO;
    }
    let painter = ui.painter_at(rect);
    let visuals = ui.visuals();
    painter.circle(
        rect.center(),
        radius,
        visuals.extreme_bg_color,
        Stroke::new(1.0, visuals.weak_text_color()),
    );
    painter.circle_stroke(
        rect.center(),
        0.25 * radius,
        Stroke::new(1.0, visuals.weak_text_color()),
    );
    painter.line_segment(
        [
            rect.center() + vec2(0.0, 0.25 * radius),
            rect.center() + vec2(0.0, 0.38 * radius),
        ],
        Stroke::new(2.0, visuals.weak_text_color()),
    );
    let wind = studio.grip.wind / STRONGEST_WIND * radius;
    let tip = rect.center() + vec2(wind.x, wind.y);
    let green = Color32::from_rgb(110, 190, 120);
    painter.line_segment([rect.center(), tip], Stroke::new(2.5, green));
    painter.circle_filled(tip, 4.0, green);
    if response.has_focus() {
        keep_arrows(ui, response.id);
        painter.rect_stroke(rect, 2.0, visuals.selection.stroke, StrokeKind::Inside);
        let keys = [
            (Key::ArrowLeft, [-1.0, 0.0]),
            (Key::ArrowRight, [1.0, 0.0]),
            (Key::ArrowUp, [0.0, -1.0]),
            (Key::ArrowDown, [0.0, 1.0]),
        ];
        for (key, way) in keys {
            if ui.input(|input| input.key_pressed(key)) {
                let wind = studio.grip.wind + glam::Vec2::from(way);
                studio.grip.wind = wind.clamp_length_max(STRONGEST_WIND);
            }
        }
    }
}
