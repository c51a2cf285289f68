//! The colours of a drawing in dark mode. Greys and tints are inverted. Saturated colours do not change, except that dark
//! ones become lighter.

/// Background and foreground in dark mode, as on the pages.
const PAPER: [f64; 3] = [27.0, 31.0, 35.0];
pub(crate) const INK: [f64; 3] = [228.0, 231.0, 234.0];

/// Largest difference between the components of a grey or a tint; the colours of heights have larger ones.
const TINT: f64 = 44.0;

/// Minimum contrast with the background. It is that required for text, which shares the colours of lines (WCAG 2, 1.4.3).
const CONTRAST: f64 = 4.5;

/// Number of steps from a colour to white.
const STEPS: u32 = 32;

/// A colour's counterpart in dark mode, `#rrggbb`; `None` if it does not change or is not a colour.
pub(crate) fn dark(color: &str) -> Option<String> {
    let color = parts(color)?;
    let (least, most) = (color.iter().copied().fold(255.0, f64::min), color.iter().copied().fold(0.0, f64::max));
    let dark = if most - least <= TINT { opposite(color, f64::midpoint(least, most)) } else { lighter(color) };
    (dark != color).then(|| hex(dark))
}

/// A colour in the notation of the drawing.
pub(crate) fn hex(color: [f64; 3]) -> String {
    let [red, green, blue] = color.map(|part| part.round().clamp(0.0, 255.0) as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Red, green and blue, 0 to 255.
fn parts(color: &str) -> Option<[f64; 3]> {
    let digits = match color {
        "white" => "ffffff",
        "black" => "000000",
        _ => color.strip_prefix('#').filter(|digits| digits.len() == 6)?,
    };
    let number = u32::from_str_radix(digits, 16).ok()?;
    Some([number >> 16, number >> 8 & 255, number & 255].map(f64::from))
}

/// Inverts a colour: it is as far from the dark background as this grey is from white, with the same tint.
fn opposite(color: [f64; 3], grey: f64) -> [f64; 3] {
    std::array::from_fn(|i| INK[i] + (PAPER[i] - INK[i]) * grey / 255.0 + color[i] - grey)
}

/// Mixes a colour with as little white as is necessary for legibility.
fn lighter(color: [f64; 3]) -> [f64; 3] {
    let readable = |color: &[f64; 3]| (luminance(*color) + 0.05) / (luminance(PAPER) + 0.05) >= CONTRAST;
    let mixed = |step: u32| color.map(|part| (part + (255.0 - part) * f64::from(step) / f64::from(STEPS)).round());
    (0..=STEPS).map(mixed).find(readable).unwrap_or(color)
}

/// Relative luminance according to WCAG 2.
fn luminance(color: [f64; 3]) -> f64 {
    let linear = color
        .map(|part| part / 255.0)
        .map(|part| if part <= 0.040_45 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) });
    0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_becomes_dark_ink_light_and_saturated_colours_stay() {
        assert_eq!([dark("white"), dark("#ffffff")], [(); 2].map(|()| Some("#1b1f23".to_owned())));
        assert_eq!([dark("black"), dark("#000000")], [(); 2].map(|()| Some("#e4e7ea".to_owned())));
        for stays in ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "none", "url(#clip)", "#fff", "#gggggg"] {
            assert_eq!(dark(stays), None, "{stays}");
        }
    }

    #[test]
    fn lines_can_be_seen_on_dark_paper_and_tints_stay_near_it() {
        let contrast = |color: &str| {
            let color = dark(color).unwrap_or_else(|| color.to_owned());
            (luminance(parts(&color).unwrap()) + 0.05) / (luminance(PAPER) + 0.05)
        };
        for line in ["#003a5c", "#7a3200", "#7a4b94", "#0072b2", "#d55e00", "#1a1a1a", "#5a5a5a", "#333333"] {
            assert!(contrast(line) >= CONTRAST, "{line}: {:.2}", contrast(line));
        }
        for at in 0..=100 {
            let color = hex(crate::drawing::style::height(f64::from(at) / 100.0).map(f64::from));
            assert_eq!(dark(&color), None, "{color}, of a surface");
        }
        for area in ["#efe6d6", "#c6dbef", "#e4e4e4", "#f6f6f6"] {
            assert!(contrast(area) < 2.0, "{area}: {:.2}", contrast(area));
        }
    }
}
