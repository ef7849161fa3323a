//! Colours: sRGB in files, linear light everywhere else.

/// The linear value of an sRGB byte, 0 to 1 (IEC 61966-2-1).
#[must_use]
pub fn linear_from_srgb(byte: u8) -> f32 {
    let encoded = f64::from(byte) / 255.0;
    let linear = if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    };
    // Seven digits, so that the last bits of a platform's `powf` do not show.
    ((linear * 1e7).round() / 1e7) as f32
}

/// The linear colour of `RRGGBB` (a leading `#` is allowed), or `None` when it is not that.
#[must_use]
pub fn parse_hex(text: &str) -> Option<[f32; 3]> {
    let hex = text.strip_prefix('#').unwrap_or(text);
    if hex.len() != 6 || !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |i: usize| {
        u8::from_str_radix(&hex[i..i + 2], 16)
            .ok()
            .map(linear_from_srgb)
    };
    Some([channel(0)?, channel(2)?, channel(4)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_colours() {
        assert_eq!(parse_hex("FFFFFF"), Some([1.0; 3]));
        assert_eq!(parse_hex("#000000"), Some([0.0; 3]));
        // sRGB 0.5 is about 0.2140 in linear light.
        let gray = parse_hex("808080").unwrap()[0];
        assert!((gray - 0.215_860_5).abs() < 1e-6, "{gray}");
        for bad in ["", "FFF", "GGGGGG", "FFFFFFF", "é2345", "+12345"] {
            assert_eq!(parse_hex(bad), None, "{bad}");
        }
    }
}
