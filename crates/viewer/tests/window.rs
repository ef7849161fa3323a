//! The program in a real window: Xvfb, a driver that draws in software, a mouse and a keyboard.
//!
//! Where there is no Xvfb it says SKIPPED, and fails where `CI=true`.

#![cfg(target_os = "linux")]
#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod common;

use common::{LOOK, Looks};
use std::io::{BufRead as _, BufReader};
use std::ops::Range;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ConnectionExt as _, ImageFormat, InputFocus,
    KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

const SIZE: [u16; 2] = [1280, 800];
const PATIENCE: Duration = Duration::from_secs(90);

/// X's names of keys: those of Latin 1 are their characters.
const CONTROL: u32 = 0xffe3;

/// A screen that nobody sees, and the viewer on it. Both end with it.
struct Screen {
    server: Child,
    viewer: Child,
    x: RustConnection,
    root: Window,
    display: String,
}

impl Drop for Screen {
    fn drop(&mut self) {
        for process in [&mut self.viewer, &mut self.server] {
            // It may have ended by itself.
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

impl Screen {
    /// A screen with the viewer of a preset on it; nothing where there is no Xvfb.
    fn open(looks: &Looks) -> Option<Self> {
        let [width, height] = SIZE;
        let server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                &format!("{width}x{height}x24"),
                "-nolisten",
                "tcp",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match server {
            Ok(server) => server,
            Err(error) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
                eprintln!("SKIPPED: there is no Xvfb ({error}); `cargo xtask setup` installs it");
                return None;
            }
            Err(error) => panic!("Xvfb: {error}"),
        };
        let mut number = String::new();
        let output = server.stdout.take().unwrap();
        BufReader::new(output).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        let (x, screen) = x11rb::connect(Some(&display)).unwrap();
        let root = x.setup().roots[screen].root;
        let viewer = Command::new(env!("CARGO_BIN_EXE_viewer"))
            .arg("look.ron")
            .current_dir(looks.path(""))
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_STATE_HOME", looks.path("state"))
            .spawn()
            .unwrap();
        Some(Self {
            server,
            viewer,
            x,
            root,
            display,
        })
    }

    /// The viewer's window, once it is there; it gets the keyboard.
    fn focus(&mut self) {
        self.wait_for("the window", |screen| {
            let windows = screen
                .x
                .query_tree(screen.root)
                .unwrap()
                .reply()
                .unwrap()
                .children;
            let shown = windows.into_iter().find(|window| {
                let size = screen.x.get_geometry(*window).unwrap().reply();
                size.is_ok_and(|size| size.width > 400)
            });
            let Some(window) = shown else { return false };
            // It may be shown only now.
            let focused = screen
                .x
                .set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME);
            focused.unwrap().check().is_ok()
        });
    }

    fn wait_for(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let started = Instant::now();
        while !is_so(self) {
            if let Some(ended) = self.viewer.try_wait().unwrap() {
                panic!("the viewer ended while {what} was waited for: {ended}");
            }
            if started.elapsed() > PATIENCE {
                let file = self.keep_picture();
                panic!("waited in vain for {what}; {file} shows the screen");
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// An event of mouse or keyboard.
    fn send(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        let sent = self.x.xtest_fake_input(kind, detail, 0, self.root, x, y, 0);
        sent.unwrap().check().unwrap();
        std::thread::sleep(Duration::from_millis(40));
    }

    /// The key of a keysym.
    fn key(&self, keysym: u32) -> u8 {
        let setup = self.x.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let map = self
            .x
            .get_keyboard_mapping(first, last - first + 1)
            .unwrap()
            .reply()
            .unwrap();
        let per_key = usize::from(map.keysyms_per_keycode);
        let found = map
            .keysyms
            .chunks(per_key)
            .position(|keysyms| keysyms.contains(&keysym));
        first + u8::try_from(found.unwrap()).unwrap()
    }

    fn hold(&self, keysym: u32, presses: impl FnOnce()) {
        self.send(KEY_PRESS_EVENT, self.key(keysym), [0, 0]);
        presses();
        self.send(KEY_RELEASE_EVENT, self.key(keysym), [0, 0]);
    }

    /// What is on the screen: rows from above, red, green, blue.
    fn picture(&self) -> image::RgbImage {
        let [width, height] = SIZE;
        let all = u32::MAX;
        let got = self
            .x
            .get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, all);
        let data = got.unwrap().reply().unwrap().data;
        let pixels = data
            .chunks_exact(4)
            .flat_map(|bgrx| [bgrx[2], bgrx[1], bgrx[0]])
            .collect();
        image::RgbImage::from_raw(width.into(), height.into(), pixels).unwrap()
    }

    /// Writes what is on the screen into the folder of the tests; the file's name.
    fn keep_picture(&self) -> String {
        let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("window.png");
        self.picture().save(&file).unwrap();
        file.display().to_string()
    }

    /// How many pixels of the left half, where the picture is, have about this colour.
    fn count(&self, color: [u8; 3]) -> usize {
        let picture = self.picture();
        let half = picture.width() / 2;
        let is_near =
            |pixel: &image::Rgb<u8>| pixel.0.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 6);
        picture
            .enumerate_pixels()
            .filter(|(x, _, pixel)| *x < half && is_near(pixel))
            .count()
    }
}

/// Where the window is the same in every run, between the lines that name files and times: from above, pixels. Mistakes are below time.
const ABOVE_TIME: Range<u32> = 28..690;
const ABOVE_STATUS: Range<u32> = 28..774;
/// Other versions of a driver that draws in software smooth letters and edges in other ways: the part of pixels that may differ, and by more than what.
const MAY_DIFFER: f64 = 0.01;
const DIFFERENCE: u8 = 40;

/// How long the window must not change before it is taken for how it should look.
const SETTLED: Duration = Duration::from_secs(4);

/// The part of pixels in which two windows differ.
fn difference(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        let channels = a.0.iter().zip(b.0);
        channels.map(|(a, b)| a.abs_diff(b)).max() > Some(DIFFERENCE)
    };
    let count = a.pixels().zip(b.pixels()).filter(|pair| differs(*pair));
    count.count() as f64 / f64::from(a.width() * a.height())
}

impl Screen {
    /// Rows of what is on the screen.
    fn rows(&self, rows: &Range<u32>) -> image::RgbImage {
        let picture = self.picture();
        let [width, height] = [picture.width(), rows.end - rows.start];
        image::imageops::crop_imm(&picture, 0, rows.start, width, height).to_image()
    }

    /// Waits until these rows of the window look as they should. `INKSTRAND_BLESS=1` takes them for how they should, once they stay as they are.
    fn wait_for_golden(&mut self, name: &str, rows: &Range<u32>) {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
        let golden = folder.join(name).with_extension("png");
        if std::env::var_os("INKSTRAND_BLESS").is_some() {
            let mut before = self.rows(rows);
            let mut since = Instant::now();
            while since.elapsed() < SETTLED {
                std::thread::sleep(Duration::from_millis(200));
                let now = self.rows(rows);
                if now != before {
                    (before, since) = (now, Instant::now());
                }
            }
            before.save(&golden).unwrap();
            return;
        }
        let expected = image::open(&golden).unwrap().to_rgb8();
        self.wait_for(&format!("what {} shows", golden.display()), |screen| {
            difference(&screen.rows(rows), &expected) <= MAY_DIFFER
        });
    }

    fn click(&self, at: [i16; 2]) {
        self.send(MOTION_NOTIFY_EVENT, 0, at);
        // A busy machine draws few frames a second, and takes a press and release within one of them for none; a long one is none either.
        std::thread::sleep(Duration::from_millis(400));
        self.send(BUTTON_PRESS_EVENT, 1, at);
        std::thread::sleep(Duration::from_millis(250));
        self.send(BUTTON_RELEASE_EVENT, 1, at);
        std::thread::sleep(Duration::from_millis(800));
    }

    fn press(&self, keysym: u32) {
        self.hold(keysym, || {});
    }

    fn press_with_control(&self, key: char) {
        self.hold(CONTROL, || self.press(u32::from(key)));
    }
}

/// Where things are in the window: a tab, the fold of what is above the zones and that of the first zone, a menu, what it has, and where
/// nothing is.
const STYLE_TAB: [i16; 2] = [939, 37];
const STYLE_ITSELF: [i16; 2] = [832, 88];
const FIRST_ZONE: [i16; 2] = [851, 147];
const WINDOW_MENU: [i16; 2] = [100, 12];
const LIGHT_THEME: [i16; 2] = [96, 103];
const NOWHERE: [u16; 2] = [500, 12];

/// The line between two looks, and mistakes.
const SPLIT_LINE: [u8; 3] = [230, 70, 100];
const MISTAKE: [u8; 3] = [190, 20, 20];

/// The skin's colours in the light and in the shadow, as the look has them.
const LIT_SKIN: [u8; 3] = [0xF8, 0xDC, 0xC8];
const DARK_SKIN: [u8; 3] = [0xE3, 0xB4, 0x9C];

#[test]
fn a_look_is_lit_and_saved_in_a_window() {
    let looks = Looks::new();
    let Some(mut screen) = Screen::open(&looks) else {
        return;
    };
    screen.focus();
    screen.wait_for("the head", |screen| screen.count(LIT_SKIN) > 3_000);
    screen.wait_for_golden("window", &ABOVE_TIME);
    let dark = screen.count(DARK_SKIN);
    // With L held, light is dragged to where it comes from behind. A busy machine draws few frames a second, and takes a press and release
    // within one of them for none: so the button is let go of when the light has moved.
    let light = screen.key(u32::from('l'));
    screen.send(KEY_PRESS_EVENT, light, [0, 0]);
    screen.send(MOTION_NOTIFY_EVENT, 0, [400, 400]);
    screen.send(BUTTON_PRESS_EVENT, 1, [400, 400]);
    screen.wait_for("shadow on the face", |screen| {
        for x in [200, 60] {
            screen.send(MOTION_NOTIFY_EVENT, 0, [x, 360]);
            std::thread::sleep(Duration::from_millis(400));
        }
        screen.count(DARK_SKIN) > dark + 2_000
    });
    screen.send(BUTTON_RELEASE_EVENT, 1, [60, 360]);
    screen.send(KEY_RELEASE_EVENT, light, [0, 0]);
    screen.press_with_control('s');
    screen.wait_for("the saved preset", |_| looks.read("look.ron") != LOOK);
    let saved = looks.read("look.ron");
    let line = saved.lines().find(|line| line.contains("light:")).unwrap();
    assert_eq!(
        saved.replace(line, "    light: (yaw: 40, pitch: 45),"),
        LOOK
    );

    screen.keep_picture();
    screen.press_with_control('q');
    let ended = screen.viewer.wait().unwrap();
    assert!(ended.success(), "{ended}");
}

#[test]
fn its_panes_look_as_they_should() {
    let looks = Looks::new();
    let Some(mut screen) = Screen::open(&looks) else {
        return;
    };
    screen.focus();
    screen.wait_for("the head", |screen| screen.count(LIT_SKIN) > 3_000);
    screen.click(STYLE_TAB);
    screen.click(STYLE_ITSELF);
    screen.click(FIRST_ZONE);
    screen.wait_for_golden("style", &ABOVE_TIME);

    // Two states, the light on the one from the right and on the other from the left.
    screen.wait_for("light colours", |screen| {
        screen.click(WINDOW_MENU);
        std::thread::sleep(Duration::from_secs(1));
        screen.click(LIGHT_THEME);
        screen.click(NOWHERE.map(u16::cast_signed));
        let [x, y] = NOWHERE.map(u32::from);
        screen.picture().get_pixel(x, y).0 > [200; 3]
    });
    screen.press_with_control('k');
    screen.wait_for("two looks", |screen| screen.count(SPLIT_LINE) > 500);
    let other = LOOK.replace("yaw: 40, pitch: 45", "yaw: -60, pitch: 20");
    let dark = screen.count(DARK_SKIN);
    std::fs::write(looks.path("look.ron"), &other).unwrap();
    screen.wait_for("shadow on the face", |screen| {
        screen.count(DARK_SKIN) > dark + 2_000
    });
    screen.wait_for_golden("compare", &ABOVE_TIME);

    let broken = other.replace("width: 1.5", "widht: 1.5");
    std::fs::write(looks.path("look.ron"), broken).unwrap();
    screen.wait_for("the mistake", |screen| screen.count(MISTAKE) > 20);
    screen.wait_for_golden("mistake", &ABOVE_STATUS);
}

/// The program without what it needs: what it says, and that it fails.
fn refused(arrange: impl FnOnce(&mut Command) -> &mut Command) -> String {
    let mut viewer = Command::new(env!("CARGO_BIN_EXE_viewer"));
    let ended = arrange(
        viewer
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET"),
    )
    .output()
    .unwrap();
    assert_eq!(ended.status.code(), Some(1));
    String::from_utf8(ended.stderr).unwrap()
}

#[test]
fn without_a_screen_or_a_preset_it_says_so() {
    let told = refused(|viewer| viewer.env_remove("DISPLAY"));
    assert!(
        told.contains("there is no screen") && told.lines().count() == 1,
        "{told}"
    );
    let told = refused(|viewer| viewer.arg("no-such-look.ron"));
    assert!(
        told.contains("no-such-look.ron") && told.lines().count() == 1,
        "{told}"
    );
}

#[test]
fn without_a_driver_it_names_one() {
    let looks = Looks::new();
    let Some(screen) = Screen::open(&looks) else {
        return;
    };
    let told = refused(|viewer| {
        viewer
            .env("DISPLAY", &screen.display)
            .env("VK_DRIVER_FILES", "/dev/null")
    });
    assert!(
        told.contains("mesa-vulkan-drivers") && told.lines().count() == 1,
        "{told}"
    );
}
