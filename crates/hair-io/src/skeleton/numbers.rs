//! Numbers of a glTF file: accessors in buffers.

use super::error::TrackError;
use base64::Engine as _;
use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Buffer, Source};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The buffers of a file, each read when it is asked for first.
pub(super) struct Buffers {
    blob: Option<Vec<u8>>,
    folder: PathBuf,
    read: HashMap<usize, Vec<u8>>,
}

impl Buffers {
    pub fn new(blob: Option<Vec<u8>>, folder: &Path) -> Self {
        Self {
            blob,
            folder: folder.to_owned(),
            read: HashMap::new(),
        }
    }

    fn bytes(&mut self, buffer: &Buffer) -> Result<&[u8], TrackError> {
        let index = buffer.index();
        if !self.read.contains_key(&index) {
            let bytes = self.open(buffer)?;
            self.read.insert(index, bytes);
        }
        Ok(&self.read[&index])
    }

    fn open(&mut self, buffer: &Buffer) -> Result<Vec<u8>, TrackError> {
        let refused = |why: String| TrackError::Buffer {
            buffer: buffer.index(),
            why,
        };
        match buffer.source() {
            Source::Bin => self
                .blob
                .take()
                .ok_or_else(|| refused("the file has no binary part".to_owned())),
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let text = data.split_once(";base64,").map(|(_, text)| text);
                    let text = text.ok_or_else(|| refused("it is not in base 64".to_owned()))?;
                    (base64::engine::general_purpose::STANDARD.decode(text))
                        .map_err(|error| refused(error.to_string()))
                }
                None => {
                    let path = self.folder.join(uri);
                    std::fs::read(&path)
                        .map_err(|error| refused(format!("{}: {error}", path.display())))
                }
            },
        }
    }

    /// All numbers of an accessor of elements of `N` numbers. Whole numbers count from -1 or 0 to 1.
    pub fn numbers<const N: usize>(
        &mut self,
        accessor: &Accessor,
    ) -> Result<Vec<[f64; N]>, TrackError> {
        let dimensions = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4 => 0,
        };
        let is_number = accessor.data_type() == DataType::F32 || accessor.normalized();
        if dimensions != N || !is_number || accessor.data_type() == DataType::U32 {
            return Err(TrackError::Kind {
                accessor: accessor.index(),
                wanted: N,
            });
        }
        let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
            return Err(TrackError::Sparse(accessor.index()));
        };
        let size = accessor.data_type().size();
        let stride = view.stride().unwrap_or(N * size);
        let outside = TrackError::Outside(accessor.index());
        let within = accessor.count().checked_mul(stride).is_some_and(|bytes| {
            bytes.saturating_add(accessor.offset()) <= view.length().saturating_add(stride)
        });
        if !within {
            return Err(outside);
        }
        let bytes = self.bytes(&view.buffer())?;
        let end = view.offset().saturating_add(view.length());
        let Some(bytes) = bytes.get(view.offset()..end) else {
            return Err(outside);
        };
        let mut numbers = Vec::with_capacity(accessor.count());
        for element in 0..accessor.count() {
            let start = accessor.offset().saturating_add(element * stride);
            let mut values = [0.0; N];
            for (i, value) in values.iter_mut().enumerate() {
                let at = start.saturating_add(i * size);
                let Some(bytes) = bytes.get(at..at.saturating_add(size)) else {
                    return Err(outside);
                };
                *value = number(accessor.data_type(), bytes);
                if !value.is_finite() {
                    return Err(TrackError::NotFinite(accessor.index()));
                }
            }
            numbers.push(values);
        }
        Ok(numbers)
    }
}

/// A number of as many bytes as its type has.
fn number(kind: DataType, bytes: &[u8]) -> f64 {
    let two = || [bytes[0], bytes[1]];
    match kind {
        DataType::I8 => (f64::from(bytes[0] as i8) / 127.0).max(-1.0),
        DataType::U8 => f64::from(bytes[0]) / 255.0,
        DataType::I16 => (f64::from(i16::from_le_bytes(two())) / 32767.0).max(-1.0),
        DataType::U16 => f64::from(u16::from_le_bytes(two())) / 65535.0,
        DataType::U32 => f64::NAN,
        DataType::F32 => f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
    }
}
