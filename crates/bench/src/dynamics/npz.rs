//! Reads arrays of `numpy.savez`: a zip archive of uncompressed `.npy` files.

use crate::BenchError;

/// An array of numbers, the last index fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Sizes.
    pub shape: Vec<usize>,
    /// As many as the product of the sizes.
    pub values: Vec<f64>,
}

/// The array `name` of an archive.
///
/// # Errors
///
/// When the archive is broken or compressed, or has no such array of little-endian f64 in C order.
pub fn read(archive: &[u8], name: &str) -> Result<Array, BenchError> {
    let file = format!("{name}.npy");
    let mut rest = archive;
    // Members one after another, each after its own header (APPNOTE.TXT, 4.3.7).
    while let Some(header) = rest.strip_prefix(b"PK\x03\x04") {
        let method = number(header, 4, 2)?;
        let mut size = number(header, 14, 4)?;
        let name_length = number(header, 22, 2)? as usize;
        let extra_length = number(header, 24, 2)? as usize;
        let name = part(header, 26, name_length)?;
        let extra = part(header, 26 + name_length, extra_length)?;
        // Savez writes 64-bit sizes: the size is in the first extra field then, after its tag and length.
        if size == u64::from(u32::MAX) {
            size = number(extra, 4, 8)?;
        }
        if method != 0 {
            return Err("the archive is compressed".into());
        }
        let start = 26 + name_length + extra_length;
        let size = usize::try_from(size).map_err(|error| error.to_string())?;
        let content = part(header, start, size)?;
        if name == file.as_bytes() {
            return array(content);
        }
        rest = &header[start + size..];
    }
    Err(format!("the archive has no array {name}").into())
}

/// A `.npy` file, version 1.0.
fn array(file: &[u8]) -> Result<Array, BenchError> {
    if part(file, 0, 8)? != b"\x93NUMPY\x01\x00" {
        return Err("not a .npy file of version 1.0".into());
    }
    let length = number(file, 8, 2)? as usize;
    let header = std::str::from_utf8(part(file, 10, length)?).map_err(|error| error.to_string())?;
    if !header.contains("'descr': '<f8'") || !header.contains("'fortran_order': False") {
        return Err(format!("not little-endian f64 in C order: {header}").into());
    }
    let shape = header
        .split_once("'shape': (")
        .and_then(|(_, rest)| rest.split_once(')'))
        .ok_or("the array has no shape")?
        .0;
    let shape: Vec<usize> = shape
        .split(',')
        .map(str::trim)
        .filter(|size| !size.is_empty())
        .map(|size| size.parse::<usize>().map_err(|error| error.to_string()))
        .collect::<Result<_, _>>()?;
    let values: Vec<f64> = file[10 + length..]
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(std::array::from_fn(|i| bytes[i])))
        .collect();
    let count = shape
        .iter()
        .try_fold(1_usize, |all, size| all.checked_mul(*size));
    if count != Some(values.len()) {
        return Err(format!("{} numbers for the shape {shape:?}", values.len()).into());
    }
    Ok(Array { shape, values })
}

fn part(bytes: &[u8], start: usize, length: usize) -> Result<&[u8], BenchError> {
    start
        .checked_add(length)
        .and_then(|end| bytes.get(start..end))
        .ok_or_else(|| "the file is cut short".into())
}

/// A little-endian number of up to 8 bytes.
fn number(bytes: &[u8], start: usize, length: usize) -> Result<u64, BenchError> {
    let bytes = part(bytes, start, length)?.iter().rev();
    Ok(bytes.fold(0, |number, byte| number << 8 | u64::from(*byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn npy(header: &str, values: &[f64]) -> Vec<u8> {
        let mut file = b"\x93NUMPY\x01\x00".to_vec();
        file.extend((header.len() as u16).to_le_bytes());
        file.extend(header.as_bytes());
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        file
    }

    /// An archive of uncompressed members, with 64-bit sizes as `numpy` writes them.
    fn zip(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
        let mut archive = Vec::new();
        for (name, content) in members {
            archive.extend(b"PK\x03\x04");
            archive.extend([45, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4]);
            archive.extend([0xff; 8]);
            archive.extend((name.len() as u16).to_le_bytes());
            archive.extend(20_u16.to_le_bytes());
            archive.extend(name.as_bytes());
            archive.extend([1, 0, 16, 0]);
            archive.extend((content.len() as u64).to_le_bytes());
            archive.extend((content.len() as u64).to_le_bytes());
            archive.extend(content);
        }
        archive.extend(b"PK\x01\x02 and so on");
        archive
    }

    const HEADER: &str = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n";
    const VALUES: [f64; 6] = [0.0, 1.5, -2.0, 3.0, 1e300, 5.0];

    fn good() -> Vec<u8> {
        let scalar = "{'descr': '<f8', 'fortran_order': False, 'shape': (), }\n";
        zip(&[
            ("L.npy", npy(scalar, &[0.3])),
            ("P.npy", npy(HEADER, &VALUES)),
        ])
    }

    #[test]
    fn arrays_come_back() {
        let array = read(&good(), "P").unwrap();
        assert_eq!((array.shape, &array.values[..]), (vec![2, 3], &VALUES[..]));
        assert_eq!(read(&good(), "L").unwrap().values, [0.3]);
        let missing = read(&good(), "Q").unwrap_err().to_string();
        assert!(missing.contains("no array Q"));
    }

    #[test]
    fn what_is_broken_is_refused() {
        let good = good();
        for length in 0..good.len() - 16 {
            assert!(read(&good[..length], "P").is_err(), "{length} bytes");
        }
        let compressed = {
            let mut archive = good.clone();
            archive[8] = 8;
            archive
        };
        let refused = read(&compressed, "P").unwrap_err().to_string();
        assert!(refused.contains("compressed"));
        for header in [
            HEADER.replace("(2, 3)", "(2, 4)"),
            HEADER.replace("(2, 3)", "(99999999999, 99999999999)"),
            HEADER.replace("<f8", ">f8"),
            HEADER.replace("'shape'", "'form'"),
        ] {
            assert!(read(&zip(&[("P.npy", npy(&header, &VALUES))]), "P").is_err());
        }
    }
}
