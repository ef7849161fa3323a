//! Parts of a pane that are opened and closed.

use crate::controls::Search;
use eframe::egui::collapsing_header::paint_default_icon;
use eframe::egui::{Button, Id, Response, RichText, Role, Sense, Ui, WidgetInfo, vec2};

/// Whether the part at `id` is open: as its user left it, but open as long as something is looked for.
pub(super) fn is_open(ui: &Ui, id: Id, at_first: bool, search: &Search) -> bool {
    search.is_active() || ui.data_mut(|data| *data.get_persisted_mut_or(id, at_first))
}

/// Opens or closes the part at `id`.
pub(super) fn set_open(ui: &Ui, id: Id, is_open: bool) {
    ui.data_mut(|data| data.insert_persisted(id, is_open));
}

/// A triangle that points down where the part of that name is open. Gives whether it was clicked.
pub(super) fn triangle(ui: &mut Ui, name: &str, is_open: bool) -> bool {
    let size = vec2(ui.spacing().icon_width, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(Role::DisclosureTriangle, ui.is_enabled(), is_open, name)
    });
    let small = eframe::egui::Rect::from_center_size(rect.center(), vec2(10.0, 10.0));
    let openness = if is_open { 1.0 } else { 0.0 };
    paint_default_icon(ui, openness, &response.clone().with_new_rect(small));
    response.clicked()
}

/// The title of a part, cut off where it is wider than `width`; it is clicked and maybe dragged as its triangle is clicked.
pub(super) fn title(ui: &mut Ui, text: RichText, width: f32, sense: Sense) -> Response {
    let title = Button::new(text).frame(false).truncate().sense(sense);
    let height = ui.spacing().interact_size.y;
    let layout = eframe::egui::Layout::left_to_right(eframe::egui::Align::Center);
    let shown = ui.allocate_ui_with_layout(vec2(width, height), layout, |ui| {
        ui.set_min_width(width);
        ui.add(title)
    });
    shown.inner
}

/// A part with a title, and what is in it where it is open.
pub(super) fn fold(
    ui: &mut Ui,
    name: &str,
    at_first: bool,
    search: &Search,
    contents: impl FnOnce(&mut Ui),
) {
    fold_named(ui, name, name, at_first, search, contents);
}

/// The same where its title is shorter than its name.
pub(super) fn fold_named(
    ui: &mut Ui,
    shown: &str,
    name: &str,
    at_first: bool,
    search: &Search,
    contents: impl FnOnce(&mut Ui),
) {
    let id = ui.make_persistent_id(("fold", name));
    let mut open = is_open(ui, id, at_first, search);
    let clicked = ui.horizontal(|ui| {
        let by_triangle = triangle(ui, &format!("open {name}"), open);
        let width = ui.available_width();
        let by_title = title(ui, RichText::new(shown).strong(), width, Sense::CLICK);
        by_triangle || by_title.accessible_name(name).clicked()
    });
    if clicked.inner && !search.is_active() {
        open = !open;
        set_open(ui, id, open);
    }
    if open {
        ui.indent(id, contents);
    }
}
