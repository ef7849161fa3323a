//! The scene on whatever Vulkan, Metal or Direct3D driver there is: what is in front hides what is behind, whoever drew it.

use embed_wgpu::picture::{self, Picture};
use embed_wgpu::view::{DepthRange, Orbit, View};
use embed_wgpu::{Demo, Outcome, PassSettings, Shown, device};
use glam::Vec3;
use render::gpu::Gpu;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

const SIZE: [u32; 2] = [240, 180];
const HAIR: Shown = Shown {
    world: false,
    hair: true,
};
const WORLD: Shown = Shown {
    world: true,
    hair: false,
};
const SKY: Shown = Shown {
    world: false,
    hair: false,
};

/// A device; nothing on machines without a driver, which those of a CI must not be.
fn gpu() -> Option<Gpu> {
    let without_window = wgpu::InstanceDescriptor::new_without_display_handle();
    match device::open(&wgpu::Instance::new(without_window), None) {
        Ok((_, gpu)) => Some(gpu),
        Err(error) if error.is::<wgpu::RequestAdapterError>() => {
            assert!(
                std::env::var("CI").as_deref() != Ok("true"),
                "no graphics driver: {error}"
            );
            // Not a macro of printing, whose words a test that passes keeps to itself.
            let said =
                b"SKIPPED 1 test of embed-wgpu: no graphics driver, not even one in software\n";
            std::io::stderr().write_all(said).unwrap();
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn preset() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/look/few.ron")
}

fn open(gpu: Gpu, samples: u32, depth: DepthRange) -> Outcome<Demo> {
    let settings = PassSettings {
        color: picture::FORMAT,
        samples,
        depth,
    };
    Demo::open(gpu, settings, &preset(), None)
}

/// The scene's parts, drawn by themselves and together.
struct Pictures {
    both: Picture,
    hair: Picture,
    world: Picture,
    sky: Picture,
    view: View,
    cubes: ([Vec3; 2], f32),
}

impl Pictures {
    fn draw(gpu: Gpu, samples: u32, depth: DepthRange) -> Self {
        let mut demo = open(gpu, samples, depth).unwrap();
        let view = demo.view(Orbit::START, SIZE);
        let cubes = demo.world().cubes(0.0);
        let mut draw = |shown| picture::draw(&mut demo, SIZE, 0.0, Orbit::START, shown).unwrap();
        Self {
            both: draw(Shown::ALL),
            hair: draw(HAIR),
            world: draw(WORLD),
            sky: draw(SKY),
            view,
            cubes,
        }
    }

    /// Pixels that hair or head cover wholly: they and their neighbours aren't sky.
    fn is_in_hair(&self, pixel: usize) -> bool {
        let width = SIZE[0] as usize;
        let around = [0, 1, 2].into_iter().flat_map(|row| {
            let middle = pixel + row * width;
            [middle - width - 1, middle - width, middle - width + 1]
        });
        let is_inside = (width + 1..self.sky.pixels.len() - width - 1).contains(&pixel);
        is_inside && { around }.all(|i| self.hair.pixels[i] != self.sky.pixels[i])
    }

    /// The pixels around a cube's middle that it covers, however it is turned.
    fn of_cube(&self, number: usize) -> Vec<usize> {
        let (middles, half) = self.cubes;
        let view = self.view.view_from_world.transform_point3(middles[number]);
        let clip = self.view.clip_from_view.project_point3(view);
        let [width, height] = SIZE.map(|side| side as f32);
        let x = (clip.x + 1.0) / 2.0 * width;
        let y = (1.0 - clip.y) / 2.0 * height;
        let radius = 0.8 * half * self.view.clip_from_view.y_axis.y / -view.z * height / 2.0;
        let is_near = |pixel: &usize| {
            let (column, row) = (pixel % SIZE[0] as usize, pixel / SIZE[0] as usize);
            (column as f32 + 0.5 - x).hypot(row as f32 + 0.5 - y) < radius
        };
        (0..self.sky.pixels.len()).filter(is_near).collect()
    }

    fn check(&self) {
        let pixels = 0..self.sky.pixels.len();
        let in_hair = pixels.clone().filter(|&i| self.is_in_hair(i)).count();
        let [width, height] = SIZE.map(|side| side as usize);
        assert!(in_hair > width * height / 20, "{in_hair} pixels of hair");

        // The cube in front hides the hair behind it.
        let front = self.of_cube(0);
        let hides = front.iter().filter(|&&i| self.is_in_hair(i)).count();
        assert!(hides > 40, "{hides} pixels of hair behind the cube");
        for i in front {
            assert_eq!(self.both.pixels[i], self.world.pixels[i], "pixel {i}");
        }

        // Hair hides the cube behind it, where it is.
        let rear = self.of_cube(1);
        let hidden = rear.iter().filter(|&&i| self.is_in_hair(i)).count();
        assert!(hidden > 40, "{hidden} pixels of hair before the cube");
        for i in rear {
            assert_ne!(self.world.pixels[i], self.sky.pixels[i], "pixel {i}");
            if self.is_in_hair(i) {
                assert_eq!(self.both.pixels[i], self.hair.pixels[i], "pixel {i}");
            }
        }

        // The ring is drawn after the hair: its glass tints hair behind it, and hair before it hides it.
        let is_glass = |[red, green, blue, _]: [u8; 4]| red > 200 && blue > green + 12;
        let on_ring = pixels.filter(|&i| self.is_in_hair(i) && is_glass(self.world.pixels[i]));
        let (hidden, tinted): (Vec<usize>, Vec<usize>) =
            on_ring.partition(|&i| self.both.pixels[i] == self.hair.pixels[i]);
        let (hidden, tinted) = (hidden.len(), tinted.len());
        assert!(
            hidden > 20 && tinted > 20,
            "{hidden} hidden, {tinted} tinted"
        );
    }
}

/// The share of pixels of which a channel differs by more than 8 of 255.
fn share_that_differs(a: &Picture, b: &Picture) -> f64 {
    let pairs = a.pixels.iter().zip(&b.pixels);
    let differ = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 8));
    differ.count() as f64 / a.pixels.len() as f64
}

#[test]
fn in_a_pass_with_four_samples_whatever_its_depths() {
    let Some(forward) = gpu() else { return };
    let Some(reversed) = gpu() else { return };
    let forward = Pictures::draw(forward, 4, DepthRange::Forward);
    forward.check();
    let reversed = Pictures::draw(reversed, 4, DepthRange::Reversed);
    reversed.check();
    let differ = share_that_differs(&forward.both, &reversed.both);
    assert!(differ < 0.002, "{differ} of all pixels");
}

#[test]
fn in_a_pass_with_one_sample() {
    let Some(gpu) = gpu() else { return };
    Pictures::draw(gpu, 1, DepthRange::Forward).check();
}

/// They have their own motion, in place of the program's.
#[test]
fn objects_of_a_preset_are_drawn() {
    let Some(gpu) = gpu() else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let settings = PassSettings {
        color: picture::FORMAT,
        samples: 4,
        depth: DepthRange::Forward,
    };
    let motion = Some(root.join("breeze.motion.ron"));
    let mut demo = Demo::open(gpu, settings, &root.join("tests/look/two.ron"), motion).unwrap();
    let mut draw = |shown| picture::draw(&mut demo, SIZE, 0.0, Orbit::START, shown).unwrap();
    let (hair, sky) = (draw(HAIR), draw(SKY));
    let pixels = hair.pixels.iter().zip(&sky.pixels);
    let drawn = pixels.filter(|(hair, sky)| hair != sky).count();
    assert!(drawn > hair.pixels.len() / 20, "{drawn} pixels of hair");
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    let Some(first) = gpu() else { return };
    let Some(second) = gpu() else { return };
    let missing = Demo::open(
        first,
        PassSettings {
            color: picture::FORMAT,
            samples: 4,
            depth: DepthRange::Forward,
        },
        Path::new("no-such-look.ron"),
        None,
    );
    let error = missing.err().unwrap().to_string();
    assert!(error.contains("no-such-look.ron"), "{error}");

    let mut demo = open(second, 4, DepthRange::Forward).unwrap();
    for size in [[0, 9], [9, 1 << 20]] {
        let error = picture::draw(&mut demo, size, 0.0, Orbit::START, Shown::ALL).err();
        let error = error.unwrap().to_string();
        assert!(error.contains(&size[1].to_string()), "{error}");
    }
    // A device that is gone says so, in place of the frame.
    demo.gpu().device.destroy();
    let error = picture::draw(&mut demo, SIZE, 0.0, Orbit::START, Shown::ALL).err();
    let error = error.unwrap().to_string();
    assert!(error.contains("lost"), "{error}");
}

#[test]
fn the_program_writes_a_picture() {
    let Some(_) = gpu() else { return };
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("embed.png");
    let _ = std::fs::remove_file(&path);
    let program = || Command::new(env!("CARGO_BIN_EXE_embed-wgpu"));
    let output = program()
        .arg(preset())
        .args(["--size", "120x90", "--time", "0.2", "--picture"])
        .arg(&path)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (120, 90));

    let output = program()
        .args(["--picture", "out.png", "--size", "0x90"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
}
