//! Numbers of a glTF file: accessors in buffers.

use super::document::{Accessor, Document};
use super::error::TrackError;
use super::uri;
use crate::read::{MOST_OF_DATA, read_bytes, shown};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// The most numbers that are read: a small file can name the same ones for thousands of bones.
pub(super) const MOST_NUMBERS: usize = 1 << 26;

/// The buffers of a file, each read when it is asked for first.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    binary: Option<&'a [u8]>,
    folder: &'a Path,
    read: HashMap<usize, Cow<'a, [u8]>>,
    /// How many numbers may be read yet.
    left: usize,
}

impl<'a> Buffers<'a> {
    pub fn new(document: &'a Document, binary: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Self {
            document,
            binary,
            folder,
            read: HashMap::new(),
            left: MOST_NUMBERS,
        }
    }

    /// The files that the animations' numbers are in, each once.
    pub fn files(document: &Document, folder: &Path) -> Vec<PathBuf> {
        let samplers = document.animations.iter().flat_map(|a| &a.samplers);
        let accessors = samplers.flat_map(|sampler| [sampler.input, sampler.output]);
        let buffers = accessors.filter_map(|accessor| {
            let view = document.accessors.get(accessor)?.buffer_view?;
            Some(document.buffer_views.get(view)?.buffer)
        });
        let buffers: BTreeSet<usize> = buffers.collect();
        let mut files: Vec<PathBuf> = Vec::new();
        for buffer in buffers {
            let uri = document.buffers.get(buffer).and_then(|b| b.uri.as_ref());
            let file = uri.and_then(|uri| uri::file_in(folder, uri));
            files.extend(file.filter(|file| !files.contains(file)));
        }
        files
    }

    fn bytes(&mut self, buffer: usize) -> Result<&[u8], TrackError> {
        if !self.read.contains_key(&buffer) {
            let bytes = self.open(buffer)?;
            self.read.insert(buffer, bytes);
        }
        Ok(&self.read[&buffer])
    }

    fn open(&self, buffer: usize) -> Result<Cow<'a, [u8]>, TrackError> {
        let refused = |why: String| TrackError::Buffer { buffer, why };
        let Some(uri) = &part(&self.document.buffers, "buffer", buffer)?.uri else {
            let binary = self.binary.filter(|_| buffer == 0);
            return binary
                .map(Cow::Borrowed)
                .ok_or_else(|| refused("it has no `uri`, and the file no binary part".to_owned()));
        };
        if let Some(data) = uri.strip_prefix("data:") {
            let text = data.split_once(";base64,").map(|(_, text)| text);
            let text = text.ok_or_else(|| refused("it is not in base 64".to_owned()))?;
            let bytes = STANDARD.decode(text);
            return bytes
                .map(Cow::Owned)
                .map_err(|error| refused(error.to_string()));
        }
        let path = uri::file_in(self.folder, uri).ok_or_else(|| TrackError::Elsewhere {
            buffer,
            uri: shown(uri),
            folder: self.folder.into(),
        })?;
        read_bytes(&path, MOST_OF_DATA)
            .map(Cow::Owned)
            .map_err(|source| TrackError::File { buffer, source })
    }

    /// All numbers of an accessor of elements of `N` numbers. Whole numbers count from -1 or 0 to 1.
    pub fn numbers<const N: usize>(&mut self, index: usize) -> Result<Vec<[f64; N]>, TrackError> {
        let document = self.document;
        let accessor = part(&document.accessors, "accessor", index)?;
        let kind = Kind::of(accessor, N).ok_or(TrackError::Kind {
            accessor: index,
            wanted: N,
        })?;
        let (Some(view), None) = (accessor.buffer_view, &accessor.sparse) else {
            return Err(TrackError::Sparse(index));
        };
        let view = part(&document.buffer_views, "buffer view", view)?;
        let end = view.byte_offset.saturating_add(view.byte_length);
        let left = self.left;
        let bytes = self.bytes(view.buffer)?.get(view.byte_offset..end);
        let size = N * kind.size();
        let element = |element: usize| {
            let stride = view.byte_stride.unwrap_or(size);
            let start = accessor
                .byte_offset
                .checked_add(element.checked_mul(stride)?)?;
            bytes?.get(start..start.checked_add(size)?)
        };
        if accessor.count > 0 && element(accessor.count - 1).is_none() {
            return Err(TrackError::Outside(index));
        }
        let left = (accessor.count.checked_mul(N))
            .and_then(|count| left.checked_sub(count))
            .ok_or(TrackError::TooMany(index))?;
        let mut numbers = Vec::with_capacity(accessor.count);
        for i in 0..accessor.count {
            let bytes = element(i).ok_or(TrackError::Outside(index))?;
            let mut values = [0.0; N];
            for (value, bytes) in values.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *value = kind.number(bytes);
            }
            if !values.iter().all(|value| value.is_finite()) {
                return Err(TrackError::NotFinite(index));
            }
            numbers.push(values);
        }
        self.left = left;
        Ok(numbers)
    }
}

/// The part of this number of one of the file's lists.
pub(super) fn part<'a, T>(
    list: &'a [T],
    part: &'static str,
    index: usize,
) -> Result<&'a T, TrackError> {
    list.get(index).ok_or(TrackError::Missing {
        part,
        index,
        count: list.len(),
    })
}

/// How a number is stored.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    F32,
}

impl Kind {
    /// How numbers of an accessor are stored, where its elements have `wanted` of them.
    fn of(accessor: &Accessor, wanted: usize) -> Option<Self> {
        let dimensions = match accessor.dimensions.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => return None,
        };
        if dimensions != wanted {
            return None;
        }
        match (accessor.component_type, accessor.normalized) {
            (5120, true) => Some(Self::I8),
            (5121, true) => Some(Self::U8),
            (5122, true) => Some(Self::I16),
            (5123, true) => Some(Self::U16),
            (5126, _) => Some(Self::F32),
            _ => None,
        }
    }

    /// In bytes.
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::F32 => 4,
        }
    }

    /// A number of as many bytes as its kind has.
    fn number(self, bytes: &[u8]) -> f64 {
        let two = || [bytes[0], bytes[1]];
        match self {
            Self::I8 => (f64::from(bytes[0] as i8) / 127.0).max(-1.0),
            Self::U8 => f64::from(bytes[0]) / 255.0,
            Self::I16 => (f64::from(i16::from_le_bytes(two())) / 32767.0).max(-1.0),
            Self::U16 => f64::from(u16::from_le_bytes(two())) / 65535.0,
            Self::F32 => f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
        }
    }
}
