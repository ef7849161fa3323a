//! All that the viewer knows, but for where its panes are.

mod files;
mod frames;

use crate::actions::Action;
use crate::compare::Compare;
use crate::documents::{Documents, Which};
use crate::edit::{Edit, Place};
use crate::engine::{Backend, Drawn, Engine, Problem, Thumbnails};
use crate::grip::Grip;
use crate::inherited::Inherited;
use crate::layers_shown::LayersShown;
use crate::motion_script::MotionTrack;
use crate::prompt::Prompt;
use crate::reference::Reference;
use crate::transport::Transport;
use crate::view::View;
use crate::watched_files::WatchedFiles;
use document::Recovery;
use effects::Registry;
use effects::preset::edit::written;
use effects::{ParamKind, Value};
use eframe::egui::{Context, InputState, TextureHandle};
use stage::CameraSection;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a sentence stays on the screen.
const TOLD_FOR: Duration = Duration::from_secs(8);
/// How often copies are kept that outlive a crash, and files on the disk are looked after.
const HOUSEKEEPING: Duration = Duration::from_secs(1);

/// When the window is drawn that something woke: without a wait it would be drawn twice, which takes long in software.
const SOON: Duration = Duration::from_millis(1);

/// What a drag on the picture does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Turns the view.
    #[default]
    View,
    /// Moves the light.
    Light,
    /// Turns the head.
    Head,
}

/// A picture on the screen.
pub struct Shown {
    /// What was drawn.
    pub drawn: Drawn,
    /// Its pixels, where the window draws from.
    pub texture: TextureHandle,
}

/// How many changes of files on the disk there were, and where preset and script are, in which of their versions.
type Versions = (u64, [Option<(PathBuf, u64)>; 2]);

/// All that the viewer knows, but for where its panes are.
pub struct Studio {
    /// The effects that there are.
    pub registry: Arc<Registry>,
    engine: Engine,
    /// Small pictures of presets.
    pub thumbnails: Thumbnails,
    ctx: Context,
    recovery: Recovery,
    /// The texts that are open; nothing before a preset is.
    pub documents: Option<Documents>,
    /// The folder whose presets are offered.
    pub folder: PathBuf,
    /// Which layers are looked at.
    pub layers: LayersShown,
    /// From where it is looked.
    pub view: View,
    /// What a drag on the picture does.
    pub tool: Tool,
    /// Time.
    pub transport: Transport,
    /// The hand on head and wind.
    pub grip: Grip,
    /// What the script does when.
    pub track: MotionTrack,
    /// What draws.
    pub backend: Backend,
    /// Another state or look beside this one.
    pub compare: Option<Compare>,
    /// A picture to draw after.
    pub reference: Option<Reference>,
    /// The pictures: this look's, and what it is compared with.
    pub shown: [Option<Shown>; 2],
    /// Whether what is shown is as sharp as it gets.
    pub is_sharp: bool,
    /// What is wrong.
    pub problems: Vec<Problem>,
    /// Whether the picture is still of the last look without mistakes.
    pub is_outdated: bool,
    /// The last thing that was done, in a sentence, and when.
    told: Option<(String, Instant)>,
    /// What is looked for.
    pub search: String,
    /// Whether the search field is to have the keyboard.
    pub focuses_search: bool,
    /// The window that asks something.
    pub prompt: Option<Prompt>,
    /// The light and camera of the preset, as its text has them; of its last text that could be read.
    pub sections: stage::Sections,
    /// What its base says where it says nothing itself.
    pub inherited: Inherited,
    /// Counts changes of files on the disk.
    files_changed: u64,
    /// Which text the track and sections were read from.
    read: Option<Versions>,
    /// Which files are looked after, and what they were.
    last_housekeeping: Instant,
    /// Where the picture was, pixels; 0 before it was anywhere.
    pub picture_px: [u32; 2],
    /// Whether it is in this frame of the window: it may be behind another tab.
    pub is_picture_there: bool,
    /// Something moves that is not time: the view, the light, a parameter.
    pub is_dragging: bool,
    /// Whether the picture has the keyboard.
    pub is_picture_focused: bool,
    /// How many presets were opened and compared with: another one shows nothing of the one before.
    opened: u64,
    /// When time last passed, seconds of the window's clock.
    last_tick: Option<f64>,
    /// Why no copies are kept, as it was told last.
    recovery_error: Option<String>,
    /// Files of the looks that nobody else watches: hair, heads, characters.
    files: WatchedFiles,
    /// An action that waits until what is typed has been taken.
    pending: Option<Action>,
    /// How often a button of the pointer was pressed: each press is a gesture of its own.
    presses: u64,
    /// Whether the window may close with changes that are not saved.
    pub may_close: bool,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Studio {
    /// A studio with no preset.
    pub fn new(
        registry: Arc<Registry>,
        ctx: &Context,
        backend: Backend,
        recovery: Recovery,
    ) -> Self {
        let waker = ctx.clone();
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || waker.request_repaint_after(SOON));
        let [for_engine, for_thumbnails] = [wake.clone(), wake.clone()];
        Self {
            engine: Engine::start(registry.clone(), move || for_engine()),
            thumbnails: Thumbnails::start(registry.clone(), move || for_thumbnails()),
            registry,
            ctx: ctx.clone(),
            recovery,
            documents: None,
            folder: PathBuf::from("presets"),
            layers: LayersShown::default(),
            view: View::default(),
            tool: Tool::default(),
            transport: Transport::default(),
            grip: Grip::default(),
            track: MotionTrack::default(),
            backend,
            compare: None,
            reference: None,
            shown: [None, None],
            is_sharp: false,
            problems: Vec::new(),
            is_outdated: false,
            told: None,
            search: String::new(),
            focuses_search: false,
            prompt: None,
            sections: stage::Sections::default(),
            inherited: Inherited::default(),
            files_changed: 0,
            read: None,
            last_housekeeping: Instant::now(),
            picture_px: [0, 0],
            is_picture_there: false,
            is_dragging: false,
            presses: 0,
            is_picture_focused: false,
            opened: 0,
            last_tick: None,
            recovery_error: None,
            files: WatchedFiles::new(wake.clone()),
            pending: None,
            may_close: false,
            wake,
        }
    }

    /// Writes one of the texts.
    pub fn write(&mut self, which: Which, text: String, gesture: Option<u64>) {
        if let Some(documents) = &mut self.documents {
            documents.write(which, text, gesture);
        }
    }

    /// Shows a sentence for a while.
    pub fn tell(&mut self, sentence: impl Into<String>) {
        self.told = Some((sentence.into(), Instant::now()));
        self.ctx.request_repaint_after(TOLD_FOR);
    }

    /// The sentence that is shown now.
    #[must_use]
    pub fn told(&self) -> Option<&str> {
        let (sentence, at) = self.told.as_ref()?;
        (at.elapsed() < TOLD_FOR).then_some(sentence)
    }

    /// Changes a text. While the pointer drags something, its changes are one step of undo. Whether it could; else why not is told.
    pub fn change(&mut self, which: Which, edits: &[Edit]) -> bool {
        if edits.is_empty() {
            return true;
        }
        let is_held = |input: &InputState| input.pointer.any_down() || input.pointer.any_released();
        let gesture = self.ctx.input(is_held).then_some(self.presses);
        self.is_dragging |= gesture.is_some();
        let Some(documents) = &mut self.documents else {
            return false;
        };
        if let Err(error) = documents.apply(which, edits, gesture) {
            self.tell(error);
            return false;
        }
        true
    }

    /// Sets a parameter of a section of the preset. Whether it could; else why not is told.
    pub fn set(&mut self, section: &str, param: &str, value: &Value, kind: &ParamKind) -> bool {
        let place = Place::top().field(section).field(param);
        self.change(Which::Preset, &[Edit::Set(place, written(value, kind))])
    }

    /// The camera that is looked from.
    #[must_use]
    pub fn camera(&self) -> CameraSection {
        self.view.camera(&self.sections.camera)
    }

    /// Writes the view into the preset.
    pub fn keep_view(&mut self) {
        let Some(own) = self.view.own().cloned() else {
            self.tell("this is the preset's view already");
            return;
        };
        let section = CameraSection::TABLE;
        let rounded = |number: f32| (1000.0 * number).round() / 1000.0;
        let values = [
            ("yaw", Value::Number(rounded(own.yaw))),
            ("pitch", Value::Number(rounded(own.pitch))),
            ("distance", Value::Number(rounded(own.distance))),
            ("target", Value::Triple(own.target.map(rounded))),
        ];
        let place = Place::top().field("camera");
        let edits: Vec<Edit> = (values.iter())
            .filter_map(|(name, value)| {
                let param = section.iter().find(|param| param.name == *name)?;
                Some(Edit::Set(place.field(name), written(value, &param.kind)))
            })
            .collect();
        if let Some(documents) = &mut self.documents
            && let Err(error) = documents.apply(Which::Preset, &edits, None)
        {
            self.tell(error);
            return;
        }
        self.view.follow_preset();
        self.tell("the view is the preset's now");
    }

    /// Does what a menu or key asks for. What is typed into a field and not taken yet is taken before anything is saved, or left.
    pub fn act(&mut self, action: Action) {
        let leaving = [
            Action::Save,
            Action::SaveAs,
            Action::Export,
            Action::Quit,
            Action::Open,
            Action::New,
        ];
        let leaves = leaving.contains(&action);
        if leaves && self.pending.is_none() && self.leave_field() {
            self.pending = Some(action);
            return;
        }
        match action {
            Action::New => self.prompt = Some(Prompt::new_look(&self.folder)),
            Action::Open => self.prompt = Some(Prompt::open(&self.folder)),
            Action::Save => self.save(),
            Action::SaveAs => self.prompt = self.documents.as_ref().map(Prompt::save_as),
            Action::Export => {
                let backend = self.backend;
                self.prompt = (self.documents.as_ref()).map(|texts| Prompt::export(texts, backend));
            }
            Action::Quit => self
                .ctx
                .send_viewport_cmd(eframe::egui::ViewportCommand::Close),
            Action::Undo | Action::Redo => self.undo(action),
            Action::Search => self.focuses_search = true,
            Action::KeepState => self.keep_state(),
            Action::Play => self.transport.is_playing = !self.transport.is_playing,
            Action::StepBack => self.transport.step(-1),
            Action::StepOn => self.transport.step(1),
            Action::Rewind => {
                self.transport.rewind();
                self.grip.reset();
            }
            Action::Look(named) => self.view.look_from(&self.sections.camera, named),
            Action::PresetView => self.view.follow_preset(),
            Action::KeepView => self.keep_view(),
            Action::Focus => self.view.focus(&self.sections.camera),
            Action::ZoomIn => self.view.zoom(&self.sections.camera, 60.0),
            Action::ZoomOut => self.view.zoom(&self.sections.camera, -60.0),
            Action::Help => self.prompt = Some(Prompt::Shortcuts),
        }
    }

    /// Takes the keyboard from the field that has it. Whether one had.
    pub fn leave_field(&self) -> bool {
        let has_field = self.ctx.text_edit_focused();
        if has_field {
            self.ctx.memory_mut(|memory| {
                if let Some(id) = memory.focused() {
                    memory.surrender_focus(id);
                }
            });
            self.ctx.request_repaint();
        }
        has_field
    }

    /// Undoes or redoes in the text that changed last.
    fn undo(&mut self, action: Action) {
        let Some(documents) = &mut self.documents else {
            return;
        };
        let is_done = match action {
            Action::Redo => documents.redo(),
            _ => documents.undo(),
        };
        if !is_done {
            self.tell("there is nothing to take back or make again");
        }
    }

    fn keep_state(&mut self) {
        if let Some(look) = self.look() {
            self.start_compare(Compare::with_state(look));
            self.tell("the left side keeps this state, the right side is what it becomes");
        }
    }

    fn start_compare(&mut self, compare: Compare) {
        self.end_compare();
        self.opened += 1;
        self.compare = Some(compare);
    }

    /// Shows one look alone again.
    pub fn end_compare(&mut self) {
        self.compare = None;
        self.shown[1] = None;
    }
}
