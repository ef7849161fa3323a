//! Lists: each item with a header to open, move, copy and remove it.

use super::fold;
use crate::controls::{ICON, Icon, Search, icon_button};
use eframe::egui::{DragAndDrop, Id, RichText, Sense, Stroke, Ui};

/// A list as a pane shows it.
pub(super) struct List<'a> {
    /// What one of its items is called: `zone`.
    pub noun: &'a str,
    /// Titles of the items.
    pub titles: Vec<String>,
    /// Which items a search finds.
    pub found: Vec<bool>,
    /// Whether the order of the items is its user's to choose.
    pub is_movable: bool,
    /// Whether items may go.
    pub may_remove: bool,
}

/// What is to be done with an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    Remove(usize),
    Duplicate(usize),
    Move(usize, usize),
}

/// An item that is being dragged, of the list of that id.
struct Dragged {
    list: Id,
    index: usize,
}

impl List<'_> {
    /// Shows the items. `before` is shown before an item's title, `contents` below it where it is open. Gives what is to be
    /// done, once what `contents` asked for is.
    pub fn show(
        &self,
        ui: &mut Ui,
        search: &Search,
        mut before: impl FnMut(&mut Ui, usize),
        mut contents: impl FnMut(&mut Ui, usize),
    ) -> Option<Change> {
        let list = ui.make_persistent_id(("list", self.noun));
        let mut change = None;
        for index in 0..self.titles.len() {
            if !self.found[index] {
                continue;
            }
            ui.push_id((self.noun, index), |ui| {
                let id = list.with(index);
                let open = fold::is_open(ui, id, false, search);
                let asked = self.header(ui, list, index, open, &mut before);
                if asked.toggled && !search.is_active() {
                    fold::set_open(ui, id, !open);
                }
                change = change.or(asked.change);
                if open {
                    ui.indent(id, |ui| contents(ui, index));
                }
            });
        }
        if let Some(change) = change {
            self.keep_open(ui, list, change);
        }
        change
    }

    fn header(
        &self,
        ui: &mut Ui,
        list: Id,
        index: usize,
        open: bool,
        before: &mut impl FnMut(&mut Ui, usize),
    ) -> Asked {
        let title = &self.titles[index];
        let mut asked = Asked::default();
        let shown = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            asked.toggled = fold::triangle(ui, &format!("open {} {title}", self.noun), open);
            before(ui, index);
            let buttons = if self.is_movable { 4.0 } else { 2.0 };
            let room = ui.available_width() - buttons * (ICON + 2.0);
            let sense = match self.is_movable {
                true => Sense::CLICK | Sense::DRAG,
                false => Sense::CLICK,
            };
            let handle = fold::title(ui, RichText::new(title), room.max(20.0), sense);
            if self.is_movable {
                handle.dnd_set_drag_payload(Dragged { list, index });
            }
            asked.toggled |= handle.clicked();
            asked.change = self.buttons(ui, index);
        });
        if let Some(change) = self.dropped(ui, list, index, shown.response.rect) {
            asked.change = Some(change);
        }
        asked
    }

    fn buttons(&self, ui: &mut Ui, index: usize) -> Option<Change> {
        let item = format!("{} {}", self.noun, self.titles[index]);
        let mut change = None;
        if self.is_movable {
            let button = |ui: &mut Ui, enabled: bool, icon: Icon, way: &str| {
                ui.add_enabled_ui(enabled, |ui| {
                    icon_button(ui, icon, &format!("move {item} {way}"), "").clicked()
                })
                .inner
            };
            if button(ui, index > 0, Icon::Up, "up") {
                change = Some(Change::Move(index, index - 1));
            }
            if button(ui, index + 1 < self.titles.len(), Icon::Down, "down") {
                change = Some(Change::Move(index, index + 1));
            }
        }
        if icon_button(ui, Icon::Copy, &format!("duplicate {item}"), "").clicked() {
            change = Some(Change::Duplicate(index));
        }
        ui.add_enabled_ui(self.may_remove, |ui| {
            if icon_button(ui, Icon::Remove, &format!("remove {item}"), "").clicked() {
                change = Some(Change::Remove(index));
            }
        });
        change
    }

    /// What dropping a dragged item on this header does; a line shows it before.
    fn dropped(&self, ui: &Ui, list: Id, index: usize, rect: eframe::egui::Rect) -> Option<Change> {
        let dragged = DragAndDrop::payload::<Dragged>(ui.ctx())?;
        let pointer = ui.input(|input| input.pointer.latest_pos())?;
        // The list may have become shorter since it was taken.
        let is_there = dragged.list == list && dragged.index < self.titles.len();
        if !is_there || !ui.rect_contains_pointer(rect) {
            return None;
        }
        let is_below = pointer.y > rect.center().y;
        let gap = if is_below { index + 1 } else { index };
        // Once it is out of the list, what comes after it moves up.
        let to = if gap > dragged.index { gap - 1 } else { gap };
        let y = if is_below { rect.bottom() } else { rect.top() };
        let line = Stroke::new(2.0, ui.visuals().selection.bg_fill);
        ui.painter().hline(rect.x_range(), y, line);
        let is_released = ui.input(|input| input.pointer.any_released());
        (is_released && to != dragged.index).then_some(Change::Move(dragged.index, to))
    }

    /// Items that were open stay so under their new numbers.
    fn keep_open(&self, ui: &Ui, list: Id, change: Change) {
        let is_open = |i: usize| ui.data_mut(|data| data.get_persisted(list.with(i)));
        let mut open: Vec<bool> = (0..self.titles.len())
            .map(|i| is_open(i).unwrap_or(false))
            .collect();
        match change {
            Change::Remove(i) => _ = open.remove(i),
            Change::Duplicate(i) => open.insert(i + 1, true),
            Change::Move(from, to) => {
                let moved = open.remove(from);
                open.insert(to, moved);
            }
        }
        open.push(false);
        for (i, open) in open.into_iter().enumerate() {
            fold::set_open(ui, list.with(i), open);
        }
    }
}

#[derive(Default)]
struct Asked {
    toggled: bool,
    change: Option<Change>,
}

/// A name that is like `wanted` and none of those that there are: `fringe`, `fringe-2`, ...
pub(super) fn new_name<'a>(wanted: &str, taken: impl Fn(&str) -> bool + 'a) -> String {
    if !taken(wanted) {
        return wanted.to_owned();
    }
    let stem = wanted.trim_end_matches(|c: char| c.is_ascii_digit());
    let stem = stem
        .strip_suffix('-')
        .filter(|stem| !stem.is_empty())
        .unwrap_or(wanted);
    let numbered = (2..).map(|number: u64| format!("{stem}-{number}"));
    let mut free = numbered.filter(|name| !taken(name));
    // As many numbers as there are names are enough.
    free.next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_names_are_free() {
        let taken = ["fringe", "fringe-2", "back-3", "9"];
        let name = |wanted: &str| new_name(wanted, |name| taken.contains(&name));
        assert_eq!(name("side"), "side");
        assert_eq!(name("fringe"), "fringe-3");
        assert_eq!(name("fringe-2"), "fringe-3");
        assert_eq!(name("back-3"), "back-2");
        assert_eq!(name("9"), "9-2");
    }
}
