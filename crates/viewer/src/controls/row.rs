//! One line of a form: a name, a control, a button that takes the value back.

use super::help::help;
use super::icon::{ICON, Icon, icon_button};
use super::note;
use effects::Param;
use eframe::egui::{
    Color32, Id, Response, RichText, Sense, TextStyle, TextWrapMode, Ui, UiBuilder, WidgetText,
    vec2,
};

/// Where a control stands, and what it is called.
pub(crate) struct Row {
    /// Unique, and the same in every frame: what the control remembers hangs on it.
    pub id: Id,
    /// For screen readers: `hair.silhouette width`.
    pub name: String,
}

impl Row {
    /// The row of this name in a form that has `ui` to itself.
    pub fn new(ui: &Ui, owner: &str, name: &str) -> Self {
        Self {
            id: ui.make_persistent_id(("row", name)),
            name: if owner.is_empty() {
                name.to_owned()
            } else {
                format!("{owner} {name}")
            },
        }
    }

    /// Shows what is on the row. Whatever comes and goes above it, what is being dragged on it stays so.
    pub fn show<R>(&self, ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
        let builder = UiBuilder::new().scope_id(self.id);
        let shown = ui.scope_builder(builder, |ui| {
            let result = contents(ui);
            note::show(ui, self.id);
            result
        });
        shown.inner
    }

    /// Leaves a note below the row for a few seconds.
    pub fn note(&self, ui: &Ui, text: impl Into<String>) {
        note::leave(ui, self.id, text);
    }

    /// The name of a part of the control.
    pub fn part(&self, part: &str) -> String {
        format!("{} {part}", self.name)
    }

    /// Tells a screen reader what the parameter of this control is.
    pub fn describe(response: &Response, param: &Param) {
        response
            .ctx
            .accesskit_node_builder(response.id, |node| node.set_description(help(param)));
    }
}

/// How wide the parts of rows are.
pub(crate) struct Cells {
    /// Of the name.
    pub name: f32,
    /// Of the control, with all that belongs to it.
    pub control: f32,
}

impl Cells {
    /// Those of rows that have the width of `ui`.
    pub fn of(ui: &Ui) -> Self {
        let all = ui.available_width();
        let gap = ui.spacing().item_spacing.x;
        let name = (0.34 * all).clamp(64.0, 190.0);
        let control = (all - name - ICON - 2.0 * gap).max(40.0);
        Self { name, control }
    }
}

/// Text in a cell of that width, cut off where it is longer, of which a screen reader has no node: the control beside it has
/// the name.
pub(crate) fn cell_text(ui: &mut Ui, text: &str, width: f32, color: Color32) -> Response {
    let height = ui.spacing().interact_size.y;
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let text: WidgetText = RichText::new(text).into();
    let galley = text.into_galley(ui, Some(TextWrapMode::Truncate), width, TextStyle::Body);
    let at = rect.left_center() - vec2(0.0, galley.size().y / 2.0);
    ui.painter()
        .galley_with_override_text_color(at, galley, color);
    response
}

/// A button that takes a value back, or its place where there is nothing to take back.
pub(super) fn reset_button(ui: &mut Ui, row: &Row, is_set: bool) -> bool {
    if !is_set {
        ui.allocate_exact_size(vec2(ICON, 1.0), Sense::hover());
        return false;
    }
    icon_button(
        ui,
        Icon::Reset,
        &format!("reset {}", row.name),
        "Back to the default",
    )
    .clicked()
}
