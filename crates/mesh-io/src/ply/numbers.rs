//! The numbers of a PLY file, one after the other.

use super::PlyError;
use super::header::{Element, Format, Kind, Property};
use crate::read::shown;

/// The numbers after the header.
pub(super) struct Numbers<'a> {
    pub(super) format: Format,
    pub(super) rest: &'a [u8],
    pub(super) line: usize,
}

impl Numbers<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, String> {
        if self.format == Format::Text {
            return self.word();
        }
        let Some((bytes, rest)) = self.rest.split_at_checked(kind.size()) else {
            return Err("the file ends here".to_owned());
        };
        self.rest = rest;
        let mut ordered = [0; 8];
        for (i, byte) in bytes.iter().enumerate() {
            ordered[if self.format == Format::Big {
                bytes.len() - 1 - i
            } else {
                i
            }] = *byte;
        }
        Ok(kind.number(ordered))
    }

    fn word(&mut self) -> Result<f64, String> {
        while let [first, rest @ ..] = self.rest
            && first.is_ascii_whitespace()
        {
            self.line += usize::from(*first == b'\n');
            self.rest = rest;
        }
        let length = self
            .rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(length);
        self.rest = rest;
        let text = String::from_utf8_lossy(word);
        match text.parse() {
            Ok(number) => Ok(number),
            Err(_) if word.is_empty() => Err("the file ends here".to_owned()),
            Err(_) => Err(format!(
                "line {}: a number was expected, found `{}`",
                self.line + 1,
                shown(&text)
            )),
        }
    }

    /// Gives the numbers of each property of each of the elements, and takes memory only for what is there.
    pub(super) fn each(
        &mut self,
        element: &Element,
        mut take: impl FnMut(usize, &[f64]),
    ) -> Result<(), PlyError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut values = Vec::new();
        for index in 0..element.count {
            for (number, property) in element.properties.iter().enumerate() {
                values.clear();
                self.property(property, &mut values)
                    .map_err(|what| PlyError::Element {
                        element: shown(&element.name),
                        index,
                        what,
                    })?;
                take(number, &values);
            }
        }
        Ok(())
    }

    fn property(&mut self, property: &Property, values: &mut Vec<f64>) -> Result<(), String> {
        let count = match property.list {
            None => 1,
            Some(kind) => {
                let count = self.next(kind)?;
                // Each number has a byte or more.
                if !(count >= 0.0 && count <= self.rest.len() as f64 && count.fract() == 0.0) {
                    return Err(format!(
                        "its list `{}` is {count} long",
                        shown(&property.name)
                    ));
                }
                count as usize
            }
        };
        for _ in 0..count {
            values.push(self.next(property.kind)?);
        }
        Ok(())
    }
}
