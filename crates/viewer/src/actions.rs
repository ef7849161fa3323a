//! What can be done by menu and by key: one table, which menus, shortcuts and the list of shortcuts are made from.

use crate::view::NamedView;
use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};

/// Something that can be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A new preset with its style.
    New,
    /// Another preset.
    Open,
    /// Writes all that is changed.
    Save,
    /// Writes the preset under another name.
    SaveAs,
    /// Pictures and sequences.
    Export,
    /// Ends the viewer.
    Quit,
    /// Takes the last change back.
    Undo,
    /// Makes it again.
    Redo,
    /// Looks for a parameter.
    Search,
    /// Keeps the look as it is, to compare it with what comes.
    KeepState,
    /// Plays and pauses.
    Play,
    /// A frame back.
    StepBack,
    /// A frame on.
    StepOn,
    /// To the beginning, with hair at rest.
    Rewind,
    /// A view by its name.
    Look(NamedView),
    /// The preset's own view.
    PresetView,
    /// Writes the view into the preset.
    KeepView,
    /// Looks at the head.
    Focus,
    /// Nearer.
    ZoomIn,
    /// Farther.
    ZoomOut,
    /// The list of shortcuts.
    Help,
}

/// How an action is shown and asked for.
pub struct Entry {
    /// The action.
    pub action: Action,
    /// Its name in menus.
    pub name: &'static str,
    /// The key.
    pub key: Option<(Modifiers, Key)>,
    /// What it does.
    pub about: &'static str,
}

const fn entry(
    action: Action,
    name: &'static str,
    key: Option<(Modifiers, Key)>,
    about: &'static str,
) -> Entry {
    Entry {
        action,
        name,
        key,
        about,
    }
}

const COMMAND: Modifiers = Modifiers::COMMAND;
const COMMAND_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};
const PLAIN: Modifiers = Modifiers::NONE;

/// All actions.
pub const ALL: &[Entry] = &[
    entry(
        Action::New,
        "New look...",
        Some((COMMAND, Key::N)),
        "Writes a preset to start from, with a hair style",
    ),
    entry(
        Action::Open,
        "Open...",
        Some((COMMAND, Key::O)),
        "Opens another preset",
    ),
    entry(
        Action::Save,
        "Save",
        Some((COMMAND, Key::S)),
        "Writes preset, style and script",
    ),
    entry(
        Action::SaveAs,
        "Save preset as...",
        Some((COMMAND_SHIFT, Key::S)),
        "Writes the preset under another name",
    ),
    entry(
        Action::Export,
        "Export...",
        Some((COMMAND, Key::E)),
        "Draws a picture or a sequence into files",
    ),
    entry(
        Action::Quit,
        "Quit",
        Some((COMMAND, Key::Q)),
        "Ends the viewer",
    ),
    entry(
        Action::Undo,
        "Undo",
        Some((COMMAND, Key::Z)),
        "Takes the last change back",
    ),
    entry(
        Action::Redo,
        "Redo",
        Some((COMMAND_SHIFT, Key::Z)),
        "Makes the change again",
    ),
    entry(
        Action::Search,
        "Search parameters",
        Some((COMMAND, Key::F)),
        "Finds parameters by name or meaning",
    ),
    entry(
        Action::KeepState,
        "Compare with this state",
        Some((COMMAND, Key::K)),
        "Keeps the look as it is now, beside what it becomes",
    ),
    entry(
        Action::Play,
        "Play or pause",
        Some((PLAIN, Key::Space)),
        "Lets time run",
    ),
    entry(
        Action::StepBack,
        "A frame back",
        Some((PLAIN, Key::Comma)),
        "Shows the frame before",
    ),
    entry(
        Action::StepOn,
        "A frame on",
        Some((PLAIN, Key::Period)),
        "Shows the next frame",
    ),
    entry(
        Action::Rewind,
        "To the beginning",
        Some((PLAIN, Key::Home)),
        "Goes to frame 0, with hair at rest and no hand on the head",
    ),
    entry(
        Action::Look(NamedView::Front),
        "Front",
        Some((PLAIN, Key::Num1)),
        "Looks at the face",
    ),
    entry(
        Action::Look(NamedView::ThreeQuarter),
        "Three-quarter",
        Some((PLAIN, Key::Num2)),
        "Looks between face and side",
    ),
    entry(
        Action::Look(NamedView::Profile),
        "Profile",
        Some((PLAIN, Key::Num3)),
        "Looks at the side",
    ),
    entry(
        Action::Look(NamedView::Back),
        "Back",
        Some((PLAIN, Key::Num4)),
        "Looks from behind",
    ),
    entry(
        Action::Look(NamedView::Above),
        "Above",
        Some((PLAIN, Key::Num5)),
        "Looks from above",
    ),
    entry(
        Action::PresetView,
        "The preset's view",
        Some((PLAIN, Key::Num0)),
        "Looks from where the preset says",
    ),
    entry(
        Action::KeepView,
        "Write this view into the preset",
        Some((PLAIN, Key::K)),
        "Makes the view the preset's own",
    ),
    entry(
        Action::Focus,
        "Look at the head",
        Some((PLAIN, Key::F)),
        "Brings the head into the middle",
    ),
    entry(
        Action::ZoomIn,
        "Nearer",
        Some((PLAIN, Key::Plus)),
        "Comes nearer",
    ),
    entry(
        Action::ZoomOut,
        "Farther",
        Some((PLAIN, Key::Minus)),
        "Goes farther away",
    ),
    entry(
        Action::Help,
        "Shortcuts",
        Some((PLAIN, Key::F1)),
        "Lists all shortcuts",
    ),
];

impl Action {
    /// Its entry in the table.
    #[must_use]
    pub fn entry(self) -> &'static Entry {
        let found = ALL.iter().find(|entry| entry.action == self);
        found.unwrap_or(&ALL[0])
    }
}

impl Entry {
    /// The key, as this system writes it.
    #[must_use]
    pub fn key_text(&self, ctx: &Context) -> String {
        self.key.map_or(String::new(), |(modifiers, key)| {
            ctx.format_shortcut(&KeyboardShortcut::new(modifiers, key))
        })
    }
}

/// The actions whose keys were pressed. Keys without Ctrl are a text's where one is written, and Space presses a button that has the keyboard.
#[must_use]
pub fn pressed(ctx: &Context, is_picture_focused: bool) -> Vec<Action> {
    let writes = ctx.text_edit_focused();
    let is_on_button = ctx.egui_wants_keyboard_input() && !is_picture_focused;
    ctx.input_mut(|input| {
        // Those with more modifiers first: Ctrl+Shift+S is no Ctrl+S.
        let mut entries: Vec<&Entry> = ALL.iter().collect();
        entries.sort_by_key(|entry| !entry.key.is_some_and(|(modifiers, _)| modifiers.shift));
        let is_pressed = |entry: &&&Entry| {
            entry.key.is_some_and(|(modifiers, key)| {
                let free = modifiers.command
                    || key == Key::F1
                    || !(writes || key == Key::Space && is_on_button);
                free && input.consume_shortcut(&KeyboardShortcut::new(modifiers, key))
            })
        };
        entries
            .iter()
            .filter(is_pressed)
            .map(|entry| entry.action)
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_does_one_thing() {
        for (index, entry) in ALL.iter().enumerate() {
            assert!(
                ALL[..index].iter().all(|other| other.key != entry.key),
                "{}",
                entry.name
            );
            assert_eq!(entry.action.entry().name, entry.name);
        }
    }
}
