//! Moving pictures: all frames in one animated PNG.

use hair_io::write_whole;
use png::{
    BitDepth, BlendOp, ColorType, Compression, Encoder, Filter, SrgbRenderingIntent, Writer,
};
use render::Picture;
use std::io::{self, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// An animated PNG that grows frame by frame. It repeats for ever.
pub(crate) struct Animation {
    writer: Writer<Shared>,
    bytes: Shared,
    size: [u32; 2],
    transparent: bool,
    before: Option<Vec<u8>>,
    /// The picture that these are of: it may come again.
    last: Weak<Picture>,
}

impl Animation {
    /// One of so many frames, which are shown `fps` a second.
    pub fn new(size: [u32; 2], frames: u32, fps: f32, transparent: bool) -> io::Result<Self> {
        let bytes = Shared::default();
        let mut encoder = Encoder::new(bytes.clone(), size[0], size[1]);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.set_color(color(transparent));
        encoder.set_compression(Compression::High);
        // Flat colours become smaller as they are than as differences.
        encoder.set_filter(Filter::NoFilter);
        encoder.set_animated(frames, 0)?;
        let (numerator, denominator) = delay(fps);
        encoder.set_frame_delay(numerator, denominator)?;
        // What changed replaces what was there.
        encoder.set_blend_op(BlendOp::Source)?;
        Ok(Self {
            writer: encoder.write_header()?,
            bytes,
            size,
            transparent,
            before: None,
            last: Weak::new(),
        })
    }

    /// Adds the next frame: of it what is not as it was.
    pub fn push(&mut self, picture: &Arc<Picture>) -> io::Result<()> {
        let whole = [0, 0, self.size[0], self.size[1]];
        let is_first = self.before.is_none();
        let (pixels, [x, y, width, height]) = match self.before.take() {
            Some(before) if self.last.as_ptr() == Arc::as_ptr(picture) => (before, SAME),
            Some(before) => {
                let now = pixels(picture, self.transparent);
                let part = changed(&before, &now, self.size[0], self.channels());
                (now, part)
            }
            None => (pixels(picture, self.transparent), whole),
        };
        if [x, y, width, height] != whole {
            self.writer.reset_frame_position()?;
            self.writer.set_frame_dimension(width, height)?;
            self.writer.set_frame_position(x, y)?;
        } else if !is_first {
            self.writer.reset_frame_position()?;
            self.writer.reset_frame_dimension()?;
        }
        let channels = self.channels();
        let row_bytes = self.size[0] as usize * channels;
        let part = x as usize * channels..(x + width) as usize * channels;
        let rows = pixels.chunks_exact(row_bytes);
        let rows = rows.skip(y as usize).take(height as usize);
        let data: Vec<u8> = rows.flat_map(|row| &row[part.clone()]).copied().collect();
        self.writer.write_image_data(&data)?;
        self.before = Some(pixels);
        self.last = Arc::downgrade(picture);
        Ok(())
    }

    /// Writes the file, whole or not at all. All frames must be there.
    pub fn write(self, path: &Path) -> io::Result<()> {
        self.writer.finish()?;
        write_whole(path, &self.bytes.all())
    }

    fn channels(&self) -> usize {
        color(self.transparent).samples()
    }
}

/// What a frame has of a picture like the one before: a pixel, as it must have some.
const SAME: [u32; 4] = [0, 0, 1, 1];

/// The least rectangle (x, y, width, height) outside of which both pictures are alike; [`SAME`] where they are alike everywhere.
fn changed(before: &[u8], now: &[u8], width: u32, channels: usize) -> [u32; 4] {
    let pixels = before
        .chunks_exact(channels)
        .zip(now.chunks_exact(channels));
    let places = (0..).zip(pixels).filter(|(_, (a, b))| a != b);
    let places = places.map(|(i, _): (u32, _)| (i % width, i / width));
    let bounds = places.fold(None, |bounds: Option<[u32; 4]>, (x, y)| {
        let [left, top, right, bottom] = bounds.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    });
    bounds.map_or(SAME, |[left, top, right, bottom]| {
        [left, top, right - left + 1, bottom - top + 1]
    })
}

/// Seconds of a frame as a fraction of small numbers.
fn delay(fps: f32) -> (u16, u16) {
    let fits = |factor: &u16| fps * f32::from(*factor) <= f32::from(u16::MAX);
    let factor = [1000, 100, 10].into_iter().find(fits).unwrap_or(1);
    (factor, (fps * f32::from(factor)).round() as u16)
}

/// The colours of pictures, with alpha where they are transparent.
pub(crate) fn color(transparent: bool) -> ColorType {
    match transparent {
        true => ColorType::Rgba,
        false => ColorType::Rgb,
    }
}

/// A picture's bytes in those colours: sRGB, straight alpha.
pub(crate) fn pixels(picture: &Picture, transparent: bool) -> Vec<u8> {
    let rgba = picture.to_srgb8();
    match transparent {
        true => rgba,
        false => {
            let pixels = rgba.chunks_exact(4);
            pixels
                .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
                .collect()
        }
    }
}

/// Bytes that the encoder writes and their owner reads afterwards.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Shared {
    fn all(&self) -> MutexGuard<'_, Vec<u8>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.all().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
    use std::io::BufReader;

    fn picture(size: [u32; 2], color: impl Fn(u32, u32) -> [f32; 4]) -> Picture {
        let [width, height] = size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Picture {
            width,
            height,
            pixels: pixels.map(|(x, y)| color(x, y)).collect(),
        }
    }

    /// Frames put over each other as a program that shows them does.
    fn shown(path: &Path) -> Vec<Vec<u8>> {
        let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let frames = reader.info().animation_control().unwrap().num_frames;
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        let mut canvas = vec![0; width * height * 4];
        (0..frames)
            .map(|_| {
                let mut bytes = vec![0; canvas.len()];
                reader.next_frame(&mut bytes).unwrap();
                let frame = *reader.info().frame_control().unwrap();
                let row_bytes = frame.width as usize * 4;
                for (row, data) in bytes
                    .chunks(row_bytes)
                    .take(frame.height as usize)
                    .enumerate()
                {
                    let at =
                        ((row + frame.y_offset as usize) * width + frame.x_offset as usize) * 4;
                    canvas[at..at + row_bytes].copy_from_slice(data);
                }
                canvas.clone()
            })
            .collect()
    }

    #[test]
    fn frames_come_back_as_they_were() {
        let size = [13, 9];
        let square = |at: u32| {
            picture(size, move |x, y| {
                match x.abs_diff(at) < 2 && y.abs_diff(at) < 3 {
                    true => [1.0, 0.0, 0.0, 1.0],
                    false => [0.0; 4],
                }
            })
        };
        // The same twice, the very same, a change, and one at the other end.
        let [first, again, other, last] = [2, 2, 4, 8].map(|at| Arc::new(square(at)));
        let pictures = [first, again.clone(), again, other, last];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.apng");
        let mut animation = Animation::new(size, 5, 24.0, true).unwrap();
        for picture in &pictures {
            animation.push(picture).unwrap();
        }
        animation.write(&path).unwrap();
        let expected: Vec<Vec<u8>> = pictures.iter().map(|own| own.to_srgb8()).collect();
        assert_eq!(shown(&path), expected);
    }

    #[test]
    fn delays_are_those_of_the_rate() {
        for fps in [1.0, 12.0, 23.976, 24.0, 60.0, 65.6, 99.97, 240.0, 1000.0] {
            let (numerator, denominator) = delay(fps);
            let shown = f32::from(denominator) / f32::from(numerator);
            assert!((shown / fps - 1.0).abs() < 1e-3, "{fps}: {shown}");
        }
    }

    #[test]
    fn what_changed_is_framed() {
        let before = vec![0; 5 * 4];
        let mut now = before.clone();
        assert_eq!(changed(&before, &now, 5, 1), [0, 0, 1, 1]);
        now[5 + 1] = 1;
        now[15 + 3] = 1;
        assert_eq!(changed(&before, &now, 5, 1), [1, 1, 3, 3]);
    }
}
