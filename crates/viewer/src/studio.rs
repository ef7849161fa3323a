//! All that the viewer knows, but for where its panes are.

use crate::actions::Action;
use crate::compare::Compare;
use crate::documents::{Documents, Which};
use crate::edit::{Edit, Place};
use crate::engine::{Backend, Drawn, Engine, Look, Problem, Thumbnails, Wish};
use crate::grip::Grip;
use crate::inherited::Inherited;
use crate::layers_shown::LayersShown;
use crate::motion_script::MotionTrack;
use crate::prompt::Prompt;
use crate::reference::Reference;
use crate::transport::{SETTLING_S, Transport};
use crate::view::View;
use crate::watched_files::WatchedFiles;
use document::Recovery;
use effects::Registry;
use effects::preset::edit::written;
use effects::{ParamKind, Value};
use eframe::egui::{ColorImage, Context, InputState, TextureHandle, TextureOptions};
use stage::CameraSection;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
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
    read: Option<[Option<(PathBuf, u64)>; 2]>,
    /// Which files are looked after, and what they were.
    last_housekeeping: Instant,
    /// Where the picture was, pixels; 0 before it was anywhere.
    pub picture_px: [u32; 2],
    /// Something moves that is not time: the view, the light, a parameter.
    pub is_dragging: bool,
    /// Whether the picture has the keyboard.
    pub is_picture_focused: bool,
    /// How many presets were opened and compared with: another one shows nothing of the one before.
    opened: u64,
    /// When time last passed, seconds of the window's clock.
    last_tick: Option<f64>,
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
            is_dragging: false,
            presses: 0,
            is_picture_focused: false,
            opened: 0,
            last_tick: None,
            files: WatchedFiles::new(wake.clone()),
            pending: None,
            may_close: false,
            wake,
        }
    }

    /// Opens a preset in place of the one that is open, whose changes are gone. Whether it could.
    pub fn open(&mut self, path: &Path) -> bool {
        // A bare name is of this folder, which can be listed and be a part of other paths.
        let path = match path.parent() {
            Some(folder) if folder.as_os_str().is_empty() => &Path::new(".").join(path),
            _ => path,
        };
        match Documents::open(path, self.recovery.clone(), self.wake.clone()) {
            Ok(documents) => {
                self.tell(format!("opened {}", path.display()));
                if let Some(before) = self.documents.take() {
                    before.close();
                }
                self.shown = [None, None];
                self.problems.clear();
                self.sections = stage::Sections::default();
                self.inherited = Inherited::default();
                self.opened += 1;
                if let Some(folder) = path.parent() {
                    folder.clone_into(&mut self.folder);
                }
                self.documents = Some(documents);
                self.layers = LayersShown::default();
                self.view.follow_preset();
                self.transport = Transport::default();
                self.grip.reset();
                self.compare = None;
                self.read = None;
                true
            }
            Err(error) => {
                self.tell(error.to_string());
                false
            }
        }
    }

    /// Opens a preset at once, or asks first what becomes of changes.
    pub fn ask_to_open(&mut self, path: &Path) {
        if self.documents.as_ref().is_some_and(Documents::is_changed) {
            self.prompt = Some(Prompt::Unsaved(Some(path.to_owned())));
        } else {
            self.open(path);
        }
    }

    /// Takes on a file that was dropped on the window: a preset is opened, hair, head or motion become those of the preset.
    pub fn take_file(&mut self, path: &Path) {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
        let (section, param) = if ends(&[".style.ron", ".strands.ron", ".tfx"]) {
            ("hair", "file")
        } else if ends(&[".obj"]) {
            ("head", "file")
        } else if ends(&[".motion.ron"]) {
            ("motion", "file")
        } else if ends(&[".glb", ".gltf", ".vrm"]) {
            ("motion", "gltf")
        } else if ends(&[".png", ".jpg", ".jpeg"]) {
            let shown = self.show_reference(path);
            return shown.unwrap_or_else(|error| self.tell(error));
        } else if ends(&[".ron"]) {
            return self.ask_to_open(path);
        } else {
            return self.tell(format!(
                "{}: presets (.ron), hair (.style.ron, .strands.ron, .tfx), heads (.obj), motion (.motion.ron, .glb, .gltf, .vrm) and \
                 pictures (.png, .jpg) can be dropped here",
                path.display()
            ));
        };
        let Some(documents) = &self.documents else {
            return self
                .tell("open a preset first: files of hair, heads and motion become a part of it");
        };
        let file = relative_to(path, &documents.folder());
        self.set(section, param, &Value::Text(Some(file)), &ParamKind::Text);
        self.tell(format!("{section}.{param} is {} now", path.display()));
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

    /// Changes a text. While the pointer drags something, its changes are one step of undo.
    pub fn change(&mut self, which: Which, edits: &[Edit]) {
        if edits.is_empty() {
            return;
        }
        let is_held = |input: &InputState| input.pointer.any_down() || input.pointer.any_released();
        let gesture = self.ctx.input(is_held).then_some(self.presses);
        self.is_dragging |= gesture.is_some();
        let Some(documents) = &mut self.documents else {
            return;
        };
        if let Err(error) = documents.apply(which, edits, gesture) {
            self.tell(error);
        }
    }

    /// Sets a parameter of a section of the preset.
    pub fn set(&mut self, section: &str, param: &str, value: &Value, kind: &ParamKind) {
        let place = Place::top().field(section).field(param);
        self.change(Which::Preset, &[Edit::Set(place, written(value, kind))]);
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
        // One step of undo, also without a drag.
        if let Some(documents) = &mut self.documents {
            let gesture = Some(u64::MAX - documents.preset().version());
            if let Err(error) = documents.apply(Which::Preset, &edits, gesture) {
                self.tell(error);
                return;
            }
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

    /// Writes all that is changed.
    pub fn save(&mut self) {
        let Some(documents) = &mut self.documents else {
            return;
        };
        let errors = documents.save();
        let sentence = match errors.first() {
            Some(error) => error.to_string(),
            None => "saved".to_owned(),
        };
        self.tell(sentence);
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

    /// Shows a picture to draw after.
    ///
    /// # Errors
    ///
    /// Why it cannot be read.
    pub fn show_reference(&mut self, path: &Path) -> Result<(), String> {
        self.reference = Some(Reference::open(path, &self.ctx)?);
        Ok(())
    }

    /// Compares with another preset.
    ///
    /// # Errors
    ///
    /// Why it cannot be read.
    pub fn compare_with(&mut self, path: &Path) -> Result<(), String> {
        let compare = Compare::with_preset(path).map_err(|error| error.to_string())?;
        self.start_compare(compare);
        Ok(())
    }

    /// What an export hangs on beside the files; nothing where no preset is open.
    #[must_use]
    pub fn export_state(&self) -> Option<crate::export::State> {
        let documents = self.documents.as_ref()?;
        let all = self.shown[0]
            .as_ref()
            .map(|shown| &shown.drawn.facts.layers);
        let all = all.map_or(&[][..], Vec::as_slice);
        let shown: Vec<String> = (all.iter())
            .filter(|layer| self.layers.is_shown(layer))
            .cloned()
            .collect();
        if shown.is_empty() && !all.is_empty() {
            return None;
        }
        Some(crate::export::State {
            preset: documents.preset().path().to_owned(),
            view: self.view.own().cloned(),
            time_s: self.transport.shown_s(),
            only: if shown.len() == all.len() {
                Vec::new()
            } else {
                shown
            },
        })
    }

    /// The look as it is edited.
    #[must_use]
    pub fn look(&self) -> Option<Look> {
        let documents = self.documents.as_ref()?;
        Some(Look {
            name: documents.preset().path().display().to_string(),
            folder: documents.folder(),
            text: documents.preset().text().clone(),
            texts: documents.texts(),
            files_changed: self.files_changed,
            layers: self.layers.clone(),
        })
    }

    /// What happens before a frame of the window is made: time passes, pictures and changed files come in.
    pub fn before_frame(&mut self) {
        if let Some(action) = self.pending {
            self.act(action);
            self.pending = None;
        }
        // The window's own clock: what it calls the time of a frame is a guess where nothing was asked for.
        let now_s = self.ctx.input(|input| input.time);
        let before_s = self.last_tick.replace(now_s).unwrap_or(now_s);
        let passed_s = (now_s - before_s) as f32;
        self.presses += u64::from(self.ctx.input(|input| input.pointer.any_pressed()));
        if self.last_housekeeping.elapsed() >= HOUSEKEEPING {
            self.last_housekeeping = Instant::now();
            if let Some(documents) = &mut self.documents {
                documents.keep_recovery_copies();
                documents.look_again();
                if let Some(error) = documents.recovery_error().map(str::to_owned) {
                    self.tell(format!(
                        "no copy is kept that would outlive a crash: {error}"
                    ));
                }
            }
        }
        if self.files.has_changed() {
            self.files_changed += 1;
        }
        let told = self.documents.as_mut().map(Documents::poll);
        for sentence in told.into_iter().flatten() {
            self.files_changed += 1;
            self.tell(sentence);
        }
        self.read_texts();
        // What was still drawn of the preset before is not this one's.
        let answer = self.engine.answer();
        if let Some(answer) = answer.filter(|answer| answer.opened == self.opened) {
            self.is_sharp = answer.is_final;
            self.problems = answer.problems;
            for (index, drawn) in answer.pictures.into_iter().enumerate().take(2) {
                if let Some(drawn) = drawn {
                    self.show(index, drawn);
                }
            }
        }
        self.transport.tick(passed_s);
        let step_s = 1.0 / self.transport.fps();
        self.grip.advance_to(self.transport.shown_s(), step_s);
    }

    /// What happens after: the picture that is wanted now is wished for.
    pub fn after_frame(&mut self) {
        self.look_after_texts();
        let Some(look) = self.look().filter(|_| self.picture_px != [0, 0]) else {
            return;
        };
        let mut looks = vec![look];
        looks.extend(self.compare.as_ref().map(|compare| compare.look.clone()));
        let is_moving = self.transport.is_playing || self.is_dragging;
        let is_new = self.engine.wish(Wish {
            looks,
            opened: self.opened,
            camera: Some(self.camera()),
            size_px: self.picture_px,
            is_moving,
            samples: None,
            time_s: self.transport.shown_s(),
            hand: self.grip.hand().clone(),
            backend: self.backend,
        });
        self.is_sharp &= !is_new;
        let is_held = self.ctx.input(|input| input.pointer.any_down());
        if self.transport.is_playing && !self.engine.is_drawing() {
            // While a frame is drawn its end is waited for: a window that is drawn in software would take the time that hair needs.
            let due = Duration::from_secs_f32(self.transport.next_frame_in_s());
            self.ctx.request_repaint_after(due);
        } else if self.is_dragging && !is_held {
            // What was dragged is at rest from the next frame on.
            self.ctx.request_repaint();
        }
        self.is_dragging = false;
    }

    /// Asks what becomes of copies that a crash has left, and wakes the window when its texts want care.
    fn look_after_texts(&mut self) {
        let Some(documents) = &mut self.documents else {
            return;
        };
        if self.prompt.is_none() && documents.take_copies() {
            self.prompt = Some(Prompt::Recover);
            self.ctx.request_repaint();
        }
        if documents.wants_care() {
            self.ctx.request_repaint_after(HOUSEKEEPING);
        }
    }

    fn show(&mut self, index: usize, drawn: Drawn) {
        if index == 0 {
            self.files.watch(&drawn.facts.files);
        }
        let size = drawn.size_px.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &drawn.pixels);
        if let Some(shown) = &mut self.shown[index] {
            shown.texture.set(image, TextureOptions::LINEAR);
            shown.drawn = drawn;
        } else {
            let texture =
                self.ctx
                    .load_texture(format!("picture {index}"), image, TextureOptions::LINEAR);
            self.shown[index] = Some(Shown { drawn, texture });
        }
    }

    /// Whether what is wished for is not drawn yet.
    #[must_use]
    pub fn is_drawing(&self) -> bool {
        self.engine.is_drawing()
    }

    /// The pixels of a picture: rows from above, red, green, blue, alpha, sRGB, straight.
    #[must_use]
    pub fn pixels(&self, index: usize) -> Option<&[u8]> {
        Some(&self.shown[index].as_ref()?.drawn.pixels)
    }

    /// Reads what of the texts the window itself needs.
    fn read_texts(&mut self) {
        let Some(documents) = &self.documents else {
            return;
        };
        let version = |which| {
            let document = documents.get(which)?;
            Some((document.path().to_owned(), document.version()))
        };
        let versions = [Which::Preset, Which::Motion].map(version);
        if self.read.as_ref() == Some(&versions) {
            return;
        }
        self.read = Some(versions);
        let preset = documents.preset();
        let folder = preset.path().parent().unwrap_or(Path::new(""));
        let (name, text) = (preset.name(), preset.text());
        if let Ok(read) = stage::Preset::parse_in(folder, &name, text, &self.registry) {
            let names: BTreeSet<&str> = read
                .layers
                .iter()
                .map(|layer| layer.name.as_str())
                .collect();
            self.layers.forget_others(&names);
            self.inherited = Inherited::below(&read);
            // Motion that begins anew is simulated from the beginning: where no script says what is when, that is now.
            let [own, new] =
                [&self.sections, &read.sections].map(|s| (&s.hair, &s.head, &s.dynamics));
            if own != new && self.track.end_s(SETTLING_S) == 0.0 {
                self.transport.seek(0.0);
            }
            self.sections = read.sections;
        }
        let script = documents.get(Which::Motion);
        self.track = script.map_or_else(MotionTrack::default, |script| {
            MotionTrack::read(script.text())
        });
        let end = self.track.end_s(SETTLING_S);
        self.transport.follow(self.sections.scene.fps, end);
    }
}

/// A path as a preset in `folder` names it: relative where both are in one tree, with `/` on every system.
fn relative_to(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(folder));
    let common = path
        .components()
        .zip(folder.components())
        .take_while(|(a, b)| a == b)
        .count();
    if common <= 1 {
        return path.display().to_string().replace('\\', "/");
    }
    let up = folder.components().skip(common).map(|_| "..".to_owned());
    let down = path.components().skip(common);
    let down = down.map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_relative_to_the_preset() {
        let named = |path: &str| relative_to(Path::new(path), Path::new("/a/looks"));
        assert_eq!(named("/a/looks/bob.style.ron"), "bob.style.ron");
        assert_eq!(named("/a/hair/x.tfx"), "../hair/x.tfx");
        assert_eq!(named("/b/x.tfx"), "/b/x.tfx");
    }
}
