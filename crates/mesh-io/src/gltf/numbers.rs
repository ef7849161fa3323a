//! Numbers of a glTF file: accessors in buffers.

use super::document::{Accessor, Document};
use super::error::PartError;
use crate::beside::file_of_uri;
use crate::read::{MOST_OF_DATA, read_bytes, shown};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

/// How many numbers are read beyond one a byte of the file's buffers: a small file can name the same ones for thousands of bones, and
/// accessors without a buffer view are zeros.
const SPARE_NUMBERS: usize = 1 << 23;

/// The buffers of a file, each read when it is asked for first.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    binary: Option<&'a [u8]>,
    folder: &'a Path,
    read: HashMap<usize, Cow<'a, [u8]>>,
    /// How many numbers may be read yet.
    left: usize,
    /// How many bytes of other files may be read yet.
    bytes_left: u64,
}

impl<'a> Buffers<'a> {
    pub fn new(document: &'a Document, binary: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Self {
            document,
            binary,
            folder,
            read: HashMap::new(),
            left: SPARE_NUMBERS,
            bytes_left: MOST_OF_DATA,
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
            let file = uri.and_then(|uri| file_of_uri(folder, uri));
            files.extend(file.filter(|file| !files.contains(file)));
        }
        files
    }

    fn bytes(&mut self, buffer: usize) -> Result<&[u8], PartError> {
        if !self.read.contains_key(&buffer) {
            let bytes = self.open(buffer)?;
            self.left = self.left.saturating_add(bytes.len());
            self.bytes_left = self.bytes_left.saturating_sub(bytes.len() as u64);
            self.read.insert(buffer, bytes);
        }
        Ok(&self.read[&buffer])
    }

    fn open(&self, buffer: usize) -> Result<Cow<'a, [u8]>, PartError> {
        let refused = |why: String| PartError::Buffer { buffer, why };
        let Some(uri) = &part(&self.document.buffers, "buffer", buffer)?.uri else {
            let binary = self.binary.filter(|_| buffer == 0);
            return binary
                .map(Cow::Borrowed)
                .ok_or_else(|| refused("it has no `uri`, and the file no binary part".to_owned()));
        };
        if uri.starts_with("data:") {
            return decode_data(uri).map(Cow::Owned).map_err(refused);
        }
        let path = file_of_uri(self.folder, uri).ok_or_else(|| PartError::Elsewhere {
            buffer,
            uri: shown(uri),
            folder: self.folder.into(),
        })?;
        read_bytes(&path, self.bytes_left)
            .map(Cow::Owned)
            .map_err(|source| PartError::File { buffer, source })
    }

    /// All numbers of an accessor of elements of `N` numbers, finite. Normalised ones count from -1 or 0 to 1; whole numbers that are
    /// not are refused.
    pub fn shares<const N: usize>(&mut self, index: usize) -> Result<Vec<[f64; N]>, PartError> {
        let accessor = part(&self.document.accessors, "accessor", index)?;
        let kind = Kind::of(accessor.component_type);
        if !(accessor.normalized || matches!(kind, Some(Kind::F32))) {
            return Err(PartError::NotNormalized(index));
        }
        self.numbers(index)
    }

    /// All numbers of an accessor of elements of `N` numbers, finite.
    pub fn numbers<const N: usize>(&mut self, index: usize) -> Result<Vec<[f64; N]>, PartError> {
        let document = self.document;
        let accessor = part(&document.accessors, "accessor", index)?;
        let kind = Kind::of(accessor.component_type).filter(|_| dimensions(accessor) == Some(N));
        let kind = kind.ok_or(PartError::Kind {
            accessor: index,
            wanted: N,
        })?;
        let number = |bytes: &[u8]| kind.number(bytes, accessor.normalized);

        let mut numbers = match accessor.buffer_view {
            Some(view) => {
                let place = Place {
                    view,
                    from: accessor.byte_offset,
                    stride: part(&document.buffer_views, "buffer view", view)?.byte_stride,
                    size: kind.size(),
                };
                self.elements(index, &place, accessor.count, number)?
            }
            None => {
                self.take(index, accessor.count, N)?;
                vec![[0.0; N]; accessor.count]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let indices = &sparse.indices;
            let index_kind = Kind::of(indices.component_type).filter(|kind| kind.is_index());
            let index_kind = index_kind.ok_or(PartError::NotIndices(index))?;
            let place = Place {
                view: indices.buffer_view,
                from: indices.byte_offset,
                stride: None,
                size: index_kind.size(),
            };
            let index_of = |bytes: &[u8]| index_kind.number(bytes, false);
            let places = self.elements::<1>(index, &place, sparse.count, index_of)?;
            let place = Place {
                view: sparse.values.buffer_view,
                from: sparse.values.byte_offset,
                stride: None,
                size: kind.size(),
            };
            let values = self.elements(index, &place, sparse.count, number)?;
            for ([place], value) in places.into_iter().zip(values) {
                let element = place as usize;
                let there = numbers.get_mut(element).ok_or(PartError::Sparse {
                    accessor: index,
                    element,
                })?;
                *there = value;
            }
        }
        if !numbers
            .iter()
            .flatten()
            .all(|value: &f64| value.is_finite())
        {
            return Err(PartError::NotFinite(index));
        }
        Ok(numbers)
    }

    /// All whole numbers of an accessor of single ones: indices.
    pub fn indices(&mut self, index: usize) -> Result<Vec<usize>, PartError> {
        self.whole::<1>(index)
            .map(|all| all.into_iter().map(|[index]| index).collect())
    }

    /// All whole numbers of an accessor of elements of `N` of them.
    pub fn whole<const N: usize>(&mut self, index: usize) -> Result<Vec<[usize; N]>, PartError> {
        let accessor = part(&self.document.accessors, "accessor", index)?;
        let is_index = Kind::of(accessor.component_type).is_some_and(Kind::is_index);
        if !is_index || accessor.normalized {
            return Err(PartError::NotIndices(index));
        }
        let numbers = self.numbers::<N>(index)?;
        Ok(numbers
            .into_iter()
            .map(|own| own.map(|number| number as usize))
            .collect())
    }

    /// How many numbers an element of an accessor has.
    pub fn width(&self, index: usize) -> Result<usize, PartError> {
        let accessor = part(&self.document.accessors, "accessor", index)?;
        dimensions(accessor).ok_or(PartError::Kind {
            accessor: index,
            wanted: 4,
        })
    }

    /// The bytes of a buffer view.
    pub fn view(&mut self, index: usize) -> Result<&[u8], PartError> {
        let view = part(&self.document.buffer_views, "buffer view", index)?;
        // Files that don't require it have their numbers a second time as they are.
        let packs = |name: &&String| name.contains("meshopt") && self.document.requires(name);
        if let Some(name) = view.extensions.keys().find(packs) {
            return Err(PartError::Packed(shown(name)));
        }
        let end = view.byte_offset.saturating_add(view.byte_length);
        let bytes = self.bytes(view.buffer)?;
        bytes
            .get(view.byte_offset..end)
            .ok_or(PartError::View(index))
    }

    /// The bytes of a picture in a buffer view. They count as numbers: many pictures can be in one place.
    pub fn picture(&mut self, view: usize) -> Result<Vec<u8>, PartError> {
        let bytes = self.view(view)?.to_vec();
        self.left = (self.left.checked_sub(bytes.len())).ok_or(PartError::TooMany(view))?;
        Ok(bytes)
    }

    /// Takes the numbers of an accessor from those that may be read.
    fn take(&mut self, accessor: usize, count: usize, width: usize) -> Result<(), PartError> {
        let left = (count.checked_mul(width)).and_then(|count| self.left.checked_sub(count));
        self.left = left.ok_or(PartError::TooMany(accessor))?;
        Ok(())
    }

    /// `count` elements of `N` numbers, each of `place.size` bytes.
    fn elements<const N: usize>(
        &mut self,
        accessor: usize,
        place: &Place,
        count: usize,
        number: impl Fn(&[u8]) -> f64,
    ) -> Result<Vec<[f64; N]>, PartError> {
        let &Place {
            view,
            from,
            stride,
            size,
        } = place;
        let width = N * size;
        let stride = stride.unwrap_or(width);
        // Columns of matrices would be padded in kinds of less than 4 bytes; glTF has no such matrices.
        let bytes = self.view(view)?;
        let element = |element: usize| {
            let start = from.checked_add(element.checked_mul(stride)?)?;
            bytes.get(start..start.checked_add(width)?)
        };
        if count > 0 && element(count - 1).is_none() {
            return Err(PartError::Outside(accessor));
        }
        self.take(accessor, count, N)?;
        let bytes = self.view(view)?;
        let element = |index: usize| {
            let start = from + index * stride;
            let mut values = [0.0; N];
            for (value, bytes) in values
                .iter_mut()
                .zip(bytes[start..start + width].chunks_exact(size))
            {
                *value = number(bytes);
            }
            values
        };
        Ok((0..count).map(element).collect())
    }
}

/// The bytes that are written in a URI.
pub(super) fn decode_data(uri: &str) -> Result<Vec<u8>, String> {
    let text = uri.split_once(";base64,").map(|(_, text)| text);
    let text = text.ok_or_else(|| "it is not in base 64".to_owned())?;
    STANDARD.decode(text).map_err(|error| error.to_string())
}

/// The part of this number of one of the file's lists.
pub(super) fn part<'a, T>(
    list: &'a [T],
    part: &'static str,
    index: usize,
) -> Result<&'a T, PartError> {
    list.get(index).ok_or(PartError::Missing {
        part,
        index,
        count: list.len(),
    })
}

/// Where an accessor's numbers are.
struct Place {
    view: usize,
    /// Bytes of the view before the first.
    from: usize,
    /// Bytes from one element to the next; without it they follow each other.
    stride: Option<usize>,
    /// Bytes of a number.
    size: usize,
}

/// How many numbers an element has.
fn dimensions(accessor: &Accessor) -> Option<usize> {
    Some(match accessor.dimensions.as_str() {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}

/// How a number is stored.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    fn of(component_type: u32) -> Option<Self> {
        Some(match component_type {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    /// In bytes.
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// A number of as many bytes as its kind has, by the largest of its kind where it is normalised.
    fn number(self, bytes: &[u8], is_normalized: bool) -> f64 {
        let two = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        let (number, most) = match self {
            Self::I8 => (f64::from(bytes[0] as i8), 127.0),
            Self::U8 => (f64::from(bytes[0]), 255.0),
            Self::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
            Self::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
            Self::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
            Self::F32 => return f64::from(f32::from_le_bytes(four())),
        };
        if is_normalized {
            (number / most).max(-1.0)
        } else {
            number
        }
    }
}
