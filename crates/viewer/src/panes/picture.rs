//! The picture, and what the pointer does on it.

use crate::actions::Action;
use crate::documents::Which;
use crate::edit::{Edit, Place};
use crate::light;
use crate::prompt::Prompt;
use crate::studio::{Shown, Studio, Tool};
use crate::view::NamedView;
use effects::preset::edit::written;
use effects::{ParamKind, Value};
use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Frame, Key, Margin, Painter, PointerButton, Pos2, Rect,
    Response, Sense, Slider, Stroke, Ui, emath::GuiRounding as _, pos2, vec2,
};

/// The largest side of a picture that is drawn for the window, pixels.
const MOST_PX: f32 = 4096.0;
/// Around the row of tools, points.
const ROW: Margin = Margin::symmetric(6, 3);
/// Points of a drag that an arrow key is worth.
const KEY_POINTS: f32 = 12.0;

/// Shows the picture with its tools.
pub(super) fn picture(ui: &mut Ui, studio: &mut Studio) {
    let row = Frame::NONE.fill(ui.visuals().panel_fill).inner_margin(ROW);
    let gap = std::mem::take(&mut ui.spacing_mut().item_spacing.y);
    row.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = gap;
        ui.set_width(ui.available_width());
        ui.horizontal_wrapped(|ui| tools(ui, studio));
    });
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let response = response.accessible_name("The picture");
    let scale = ui.pixels_per_point();
    // On whole pixels: a picture between them would be blurred.
    let area = area.round_to_pixels(scale);
    let rect = fitted(area, studio.sections.scene.size).round_to_pixels(scale);
    let most_px = ui.input(|input| input.max_texture_side as f32).min(MOST_PX);
    let most = most_px / (scale * rect.width().max(rect.height())).max(most_px);
    studio.picture_px =
        [rect.width(), rect.height()].map(|side| (side * scale * most).round().max(1.0) as u32);
    studio.is_picture_there = true;
    let painter = ui.painter_at(area);
    paint_ground(&painter, area, rect, ui.visuals().extreme_bg_color, studio);
    paint(&painter, rect, studio);
    if studio.documents.is_none() {
        hint(ui, &painter, area);
        return;
    }
    act(ui, &response, rect, studio);
    if studio.tool == Tool::Light
        || ui.input(|input| input.key_down(Key::L)) && !ui.ctx().text_edit_focused()
    {
        paint_light(&painter, rect, studio);
    }
}

/// The tools above the picture.
fn tools(ui: &mut Ui, studio: &mut Studio) {
    for (tool, name, about) in [
        (
            Tool::View,
            "View",
            "Drag turns the view; Shift moves it; the wheel comes nearer",
        ),
        (
            Tool::Light,
            "Light",
            "Drag puts the light where the pointer is; also with L held",
        ),
        (
            Tool::Head,
            "Head",
            "Drag turns the head, and hair follows; also with H held",
        ),
    ] {
        ui.selectable_value(&mut studio.tool, tool, name)
            .on_hover_text(about);
    }
    ui.separator();
    ui.menu_button("Look from", |ui| {
        let views = NamedView::ALL.map(Action::Look);
        for action in views
            .into_iter()
            .chain([Action::PresetView, Action::Focus, Action::KeepView])
        {
            crate::menu::item(ui, studio, action);
        }
    });
    ui.menu_button("Compare", |ui| {
        crate::menu::item(ui, studio, Action::KeepState);
        if let Some(compare) = &mut studio.compare {
            let slider = Slider::new(&mut compare.split, 0.0..=1.0)
                .show_value(false)
                .text("line between");
            ui.add(slider).accessible_name("Line between the looks");
        }
        if ui.button("With a preset...").clicked() {
            studio.prompt = Some(Prompt::compare(&studio.folder));
            ui.close();
        }
        if ui
            .add_enabled(studio.compare.is_some(), eframe::egui::Button::new("End"))
            .clicked()
        {
            studio.end_compare();
            ui.close();
        }
    });
    ui.menu_button("Reference", |ui| {
        if ui.button("A picture to draw after...").clicked() {
            studio.prompt = Some(Prompt::reference(&studio.folder));
            ui.close();
        }
        let mut is_gone = false;
        if let Some(reference) = &mut studio.reference {
            let file = reference
                .path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy();
            ui.weak(file);
            let opacity = Slider::new(&mut reference.opacity, 0.0..=1.0).text("opacity");
            ui.add(opacity);
            ui.radio_value(&mut reference.is_over, true, "over the hair");
            ui.radio_value(&mut reference.is_over, false, "under the hair");
            is_gone = ui.button("Take it away").clicked();
        }
        if is_gone {
            studio.reference = None;
        }
    });
}

/// The largest rectangle of the picture's shape in the area.
fn fitted(area: Rect, [width, height]: [u32; 2]) -> Rect {
    let size = vec2(width as f32, height as f32);
    let scale = (area.width() / size.x).min(area.height() / size.y).max(0.0);
    Rect::from_center_size(area.center(), (size * scale).max(vec2(1.0, 1.0)))
}

/// Fills what is not covered by the picture: where windows are drawn in software, each layer of pixels takes its time.
fn paint_ground(painter: &Painter, area: Rect, rect: Rect, color: Color32, studio: &Studio) {
    let is_covered =
        studio.shown[0].is_some() && studio.reference.is_none() && studio.compare.is_none();
    if !is_covered {
        painter.rect_filled(area, 0.0, color);
        return;
    }
    let (left, rest) = area.split_left_right_at_x(rect.left());
    let (rest, right) = rest.split_left_right_at_x(rect.right());
    let (above, rest) = rest.split_top_bottom_at_y(rect.top());
    let (_, below) = rest.split_top_bottom_at_y(rect.bottom());
    for part in [left, right, above, below] {
        painter.rect_filled(part, 0.0, color);
    }
}

fn paint(painter: &Painter, rect: Rect, studio: &Studio) {
    let [own, other] = &studio.shown;
    if studio.sections.scene.background.is_none() {
        paint_checks(painter, rect);
    }
    if let Some(reference) = studio
        .reference
        .as_ref()
        .filter(|reference| !reference.is_over)
    {
        paint_reference(painter, rect, reference);
    }
    let split = match (&studio.compare, other) {
        (Some(compare), Some(_)) => rect.left() + compare.split * rect.width(),
        _ => rect.left(),
    };
    let (left, right) = rect.split_left_right_at_x(split);
    let under = studio
        .reference
        .as_ref()
        .filter(|reference| !reference.is_over);
    let tint = Color32::WHITE
        .gamma_multiply(under.map_or(1.0, |reference| 1.0 - 0.999 * reference.opacity));
    let show = |part: Rect, shown: &Option<Shown>| {
        if let Some(shown) = shown {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter
                .with_clip_rect(part)
                .image(shown.texture.id(), rect, all, tint);
        }
    };
    show(right, own);
    if split > rect.left() {
        show(left, other);
        painter.vline(
            split,
            rect.y_range(),
            Stroke::new(2.0, Color32::from_rgb(230, 70, 100)),
        );
        let name = studio.compare.as_ref().map_or("", |compare| &compare.name);
        let font = FontId::proportional(13.0);
        let ground = |at: Pos2, align: Align2, text: &str| {
            let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE);
            let place = align.anchor_size(at, galley.size());
            painter.rect_filled(place.expand(3.0), 3.0, Color32::from_black_alpha(150));
            painter.galley(place.min, galley, Color32::WHITE);
        };
        ground(pos2(split - 8.0, rect.top() + 8.0), Align2::RIGHT_TOP, name);
        ground(pos2(split + 8.0, rect.top() + 8.0), Align2::LEFT_TOP, "now");
    }
    if let Some(reference) = studio
        .reference
        .as_ref()
        .filter(|reference| reference.is_over)
    {
        paint_reference(painter, rect, reference);
    }
}

fn paint_reference(painter: &Painter, rect: Rect, reference: &crate::reference::Reference) {
    let size = reference.texture.size_vec2();
    let scale = (rect.width() / size.x).min(rect.height() / size.y);
    let place = Rect::from_center_size(rect.center(), size * scale);
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let opacity = if reference.is_over {
        reference.opacity
    } else {
        1.0
    };
    painter.image(
        reference.texture.id(),
        place,
        all,
        Color32::WHITE.gamma_multiply(opacity),
    );
}

/// Checks behind a transparent picture.
fn paint_checks(painter: &Painter, rect: Rect) {
    const SIDE: f32 = 12.0;
    painter.rect_filled(rect, 0.0, Color32::from_gray(205));
    let painter = painter.with_clip_rect(rect);
    for row in 0..(rect.height() / SIDE).ceil() as u32 {
        for column in (row % 2..(rect.width() / SIDE).ceil() as u32).step_by(2) {
            let corner = rect.min + SIDE * vec2(column as f32, row as f32);
            painter.rect_filled(
                Rect::from_min_size(corner, vec2(SIDE, SIDE)),
                0.0,
                Color32::from_gray(175),
            );
        }
    }
}

/// What to do where no preset is open.
fn hint(ui: &Ui, painter: &Painter, area: Rect) {
    let text = "Begin with File, New look... or drop a preset here.\n\n\
        Drag turns the view, the wheel comes nearer, F1 lists all keys.";
    painter.text(
        area.center(),
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(16.0),
        ui.visuals().weak_text_color(),
    );
}

/// What pointer and keys do.
fn act(ui: &Ui, response: &Response, rect: Rect, studio: &mut Studio) {
    let (shift, holds_light, holds_head) = ui.input(|input| {
        (
            input.modifiers.shift,
            input.key_down(Key::L),
            input.key_down(Key::H),
        )
    });
    let delta = response.drag_delta();
    let preset = studio.sections.camera.clone();
    let pans =
        response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary);
    let by_primary = response.dragged_by(PointerButton::Primary);
    studio.is_dragging |= response.dragged();
    let pan = delta / rect.height();
    if pans || (by_primary && shift) {
        studio.view.pan(&preset, [pan.x, pan.y]);
    } else if by_primary && is_split_dragged(response, rect, studio) {
        if let (Some(compare), Some(at)) = (&mut studio.compare, response.interact_pointer_pos()) {
            compare.split = ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
        }
    } else if by_primary && (studio.tool == Tool::Light || holds_light) {
        if let Some(at) = response.interact_pointer_pos() {
            drag_light(rect, at, studio);
        }
    } else if by_primary && (studio.tool == Tool::Head || holds_head) {
        // Who takes hold of the head lets time run, so that hair follows.
        studio.transport.is_playing |= response.drag_started_by(PointerButton::Primary);
        studio.grip.drag(glam::Vec2::new(delta.x, delta.y));
    } else if by_primary {
        studio.view.orbit(&preset, [delta.x, delta.y]);
    }
    if response.drag_stopped() {
        studio.grip.let_go();
    }
    if response.double_clicked() {
        studio.view.focus(&preset);
    }
    if response.clicked() {
        response.request_focus();
    }
    if response.contains_pointer() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        let points = scroll + 300.0 * (pinch - 1.0);
        if points != 0.0 {
            studio.view.zoom(&preset, points);
            studio.is_dragging = true;
        }
    }
    studio.is_picture_focused = response.has_focus();
    if response.has_focus() {
        super::timeline::keep_arrows(ui, response.id);
        keys(ui, studio, &preset);
        ui.painter().rect_stroke(
            rect,
            0.0,
            ui.visuals().selection.stroke,
            eframe::egui::StrokeKind::Inside,
        );
    }
    let cursor = match studio.tool {
        _ if is_on_split(response, rect, studio) => CursorIcon::ResizeHorizontal,
        Tool::View => CursorIcon::Grab,
        Tool::Light => CursorIcon::Crosshair,
        Tool::Head => CursorIcon::PointingHand,
    };
    response.clone().on_hover_and_drag_cursor(cursor);
}

/// Whether the pointer is on the line between two looks.
fn is_on_split(response: &Response, rect: Rect, studio: &Studio) -> bool {
    let (Some(compare), Some(at)) = (&studio.compare, response.hover_pos()) else {
        return false;
    };
    (at.x - rect.left() - compare.split * rect.width()).abs() < 8.0
}

/// Whether the drag that goes on began on the line between two looks.
fn is_split_dragged(response: &Response, rect: Rect, studio: &Studio) -> bool {
    let Some(compare) = &studio.compare else {
        return false;
    };
    let id = response.id.with("split");
    if response.drag_started() {
        let origin = response.ctx.input(|input| input.pointer.press_origin());
        let line = rect.left() + compare.split * rect.width();
        let begins = origin.is_some_and(|at| (at.x - line).abs() < 8.0);
        response.ctx.data_mut(|data| data.insert_temp(id, begins));
    }
    response.ctx.data(|data| data.get_temp(id)).unwrap_or(false)
}

fn keys(ui: &Ui, studio: &mut Studio, preset: &stage::CameraSection) {
    let arrows = [
        (Key::ArrowLeft, [-1.0, 0.0]),
        (Key::ArrowRight, [1.0, 0.0]),
        (Key::ArrowUp, [0.0, -1.0]),
        (Key::ArrowDown, [0.0, 1.0]),
    ];
    for (key, way) in arrows {
        if ui.input(|input| input.key_pressed(key)) {
            studio
                .view
                .orbit(preset, way.map(|part| -KEY_POINTS * part));
        }
    }
}

/// Where a place on the picture is from its middle, in parts of half its shorter side.
fn from_middle(rect: Rect, at: Pos2) -> glam::Vec2 {
    let half = 0.5 * rect.width().min(rect.height());
    let away = (at - rect.center()) / half;
    glam::Vec2::new(away.x, away.y)
}

fn drag_light(rect: Rect, at: Pos2, studio: &mut Studio) {
    let fixed_to = studio.sections.light.fixed_to;
    let angles = light::angles(from_middle(rect, at), fixed_to, &studio.camera());
    let kind = ParamKind::Number {
        min: -360.0,
        max: 360.0,
        default: 0.0,
        varies: false,
    };
    let place = Place::top().field("light");
    let set =
        |name: &str, degrees| Edit::Set(place.field(name), written(&Value::Number(degrees), &kind));
    let edits = [set("yaw", angles[0]), set("pitch", angles[1])];
    studio.change(Which::Preset, &edits);
}

/// Where light comes from: full where it comes from the viewer's side, a ring where it comes from behind.
fn paint_light(painter: &Painter, rect: Rect, studio: &Studio) {
    let place = light::place(&studio.sections.light, &studio.camera());
    let half = 0.5 * rect.width().min(rect.height());
    let at = rect.center() + half * vec2(place.x, place.y);
    let gold = Color32::from_rgb(250, 190, 40);
    let dark = Color32::from_rgb(90, 60, 0);
    painter.line_segment(
        [rect.center(), at],
        Stroke::new(1.0, gold.gamma_multiply(0.5)),
    );
    painter.circle_stroke(
        rect.center(),
        0.5 * half,
        Stroke::new(1.0, gold.gamma_multiply(0.35)),
    );
    if place.length() <= 0.5 {
        painter.circle(at, 9.0, gold, Stroke::new(1.5, dark));
    } else {
        painter.circle_stroke(at, 9.0, Stroke::new(3.0, gold));
    }
}
