//! Colours: sRGB in files, linear light everywhere else.

pub use portable_math::linear_from_srgb;

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
            .map(|byte| linear_from_srgb(f64::from(byte) / 255.0) as f32)
    };
    Some([channel(0)?, channel(2)?, channel(4)?])
}

/// `RRGGBB` of a linear colour, the nearest that there is; of one brighter than white that of white. What [`parse_hex`]
/// gives is written as it was.
#[must_use]
pub fn to_hex(linear: [f32; 3]) -> String {
    let bytes = linear.map(nearest_byte);
    format!("{:02X}{:02X}{:02X}", bytes[0], bytes[1], bytes[2])
}

/// The byte whose sRGB value is nearest: the number of limits between two bytes that are below.
fn nearest_byte(linear: f32) -> u8 {
    let is_below =
        |byte: &u8| linear_from_srgb((f64::from(*byte) + 0.5) / 255.0) < f64::from(linear);
    (0..255).take_while(is_below).count() as u8
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

    #[test]
    fn hex_of_hex_is_the_same() {
        for byte in 0..=255_u8 {
            let hex = format!("{byte:02X}{:02X}{:02X}", 255 - byte, byte / 2);
            assert_eq!(to_hex(parse_hex(&hex).unwrap()), hex);
        }
        assert_eq!(to_hex([-1.0, 1.5, f32::NAN]), "00FF00");
        // A little beside a byte's light it is still that byte.
        let gray = parse_hex("808080").unwrap()[0];
        assert_eq!(to_hex([gray * 0.999, gray * 1.001, gray]), "808080");
    }
}
