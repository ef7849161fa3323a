//! The pictures of the pages: held to what their commands draw, or drawn again.

use std::collections::BTreeSet;
use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Where this is set to `draw`, pictures are written in place of being compared: `cargo xtask pictures`.
const VARIABLE: &str = "INKSTRAND_PICTURES";

/// How much a picture may differ from what its command draws, in 1/255 on average: a card rounds otherwise than the CPU.
const LIKENESS: f64 = 0.1;

/// Largest size and bytes of a picture, and of one that moves; bytes of all of a folder.
const LARGEST: (u32, u32) = (480, 360);
const MOST_BYTES: usize = 40_000;
const MOST_BYTES_MOVING: usize = 100_000;
const MOST_OF_ALL: usize = 2_000_000;

/// A picture, or the frames of one that moves one after the other.
struct Picture {
    size: (u32, u32),
    frames: u32,
    bytes: Vec<u8>,
}

/// Reads a picture without transparency.
fn read(path: &Path) -> Picture {
    let file = fs::File::open(path)
        .unwrap_or_else(|error| panic!("{}: {error}: cargo xtask pictures", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let frames = (reader.info().animation_control).map_or(1, |control| control.num_frames);
    let size = (reader.info().width, reader.info().height);
    let row = 3 * size.0 as usize;
    let (mut canvas, mut bytes) = (vec![0; row * size.1 as usize], Vec::new());
    let mut part = vec![0; reader.output_buffer_size().unwrap()];
    for _ in 0..frames {
        let info = reader.next_frame(&mut part).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb, "{}", path.display());
        // What changed stands in the place of what was there.
        let control = reader.info().frame_control();
        let (x, y) = control.map_or((0, 0), |c| (c.x_offset as usize, c.y_offset as usize));
        for (line, changed) in part.chunks_exact(info.line_size).enumerate() {
            if line < info.height as usize {
                let start = (y + line) * row + 3 * x;
                let width = 3 * info.width as usize;
                canvas[start..start + width].copy_from_slice(&changed[..width]);
            }
        }
        bytes.extend_from_slice(&canvas);
    }
    Picture {
        size,
        frames,
        bytes,
    }
}

/// As small as flat colours become: rows as they are, not their differences.
fn write(path: &Path, picture: &Picture) {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.size.0, picture.size.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&picture.bytes).unwrap();
    writer.finish().unwrap();
    fs::write(path, bytes).unwrap();
}

/// A folder of pictures that a page shows.
pub struct Shown {
    folder: PathBuf,
    names: BTreeSet<String>,
    draws: bool,
}

impl Shown {
    pub fn new(folder: PathBuf) -> Self {
        let draws = std::env::var_os(VARIABLE).is_some_and(|value| value == "draw");
        if draws {
            fs::create_dir_all(&folder).unwrap();
        }
        Self {
            folder,
            names: BTreeSet::new(),
            draws,
        }
    }

    /// Holds the page's picture of this name to the one that was drawn, or writes it.
    pub fn hold(&mut self, name: &str, drawn: &Path) {
        let path = self.folder.join(name);
        let picture = read(drawn);
        self.names.insert(name.to_owned());
        match (self.draws, picture.frames) {
            (false, _) => {}
            (true, 1) => write(&path, &picture),
            // The program makes those that move as small as they become.
            (true, _) => drop(fs::copy(drawn, &path).unwrap()),
        }
        let kept = read(&path);
        let shape = |picture: &Picture| (picture.size, picture.frames);
        assert_eq!(
            shape(&kept),
            shape(&picture),
            "{name}: cargo xtask pictures"
        );
        let pairs = kept.bytes.iter().zip(&picture.bytes);
        let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        let mean = sum / picture.bytes.len() as f64;
        assert!(
            mean <= LIKENESS,
            "{name} is not what its command draws, by {mean} of 255: cargo xtask pictures"
        );
    }

    /// Holds that the folder has the pictures that were shown, and no others, all of them small.
    pub fn finish(self) {
        let mut sum = 0;
        for entry in fs::read_dir(&self.folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if !self.names.contains(&name) {
                assert!(self.draws, "no page shows {name}: cargo xtask pictures");
                fs::remove_file(&path).unwrap();
                continue;
            }
            let Picture { size, frames, .. } = read(&path);
            assert!(
                size.0 <= LARGEST.0 && size.1 <= LARGEST.1,
                "{name}: {size:?}"
            );
            let bytes = fs::metadata(&path).unwrap().len() as usize;
            let most = match frames {
                1 => MOST_BYTES,
                _ => MOST_BYTES_MOVING,
            };
            assert!(bytes <= most, "{name} has {bytes} bytes");
            sum += bytes;
        }
        assert!(sum <= MOST_OF_ALL, "{sum} bytes of pictures");
    }
}
