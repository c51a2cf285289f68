//! Formatting of numbers in findings, decisions and on the terminal.

/// Squared errors below this share count as exact, because recordings of four or five digits show no smaller ones.
const EXACT: f64 = 1e-8;

/// Larger shares are not informative.
const MOST_PERCENT: f64 = 10_000.0;

/// Formats three significant digits.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{value:.2e}");
    }
    let digits = (2 - exponent).max(0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A squared error as a share of the predicted quantity: three digits, or "exact".
pub fn squared_error(share: f64) -> String {
    if (0.0..EXACT).contains(&share) { "exact".to_owned() } else { short(share) }
}

/// A share in per cent, with two digits: "0.5 %", "16 %".
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent.abs() {
        0.0 => "0 %".to_owned(),
        size if size < 0.1 => "under 0.1 %".to_owned(),
        size if size < 10.0 => format!("{percent:.1} %"),
        size if size >= MOST_PERCENT => format!("over {MOST_PERCENT} %"),
        _ => format!("{percent:.0} %"),
    }
}

/// An estimated share of a whole, in per cent; the estimate may exceed the whole.
pub fn percent_of_all(share: f64) -> String {
    percent(share.min(1.0))
}

/// "1 episode", "40 episodes".
pub fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_are_printed() {
        for (value, expected) in [
            (0.0, "0"),
            (1.0, "1"),
            (-2.0855, "-2.09"),
            (0.05, "0.05"),
            (1600.0, "1600"),
            (123456.0, "123456"),
            (0.000123456, "0.000123"),
            (1.5e-7, "1.50e-7"),
            (2.5e9, "2.50e9"),
            (-0.0, "0"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(short(value), expected);
        }
    }

    #[test]
    fn errors_are_exact_or_numbers() {
        for (share, expected) in [
            (0.0, "exact"),
            (9.9e-9, "exact"),
            (1e-8, "1.00e-8"),
            (0.5821, "0.582"),
            (f64::NAN, "NaN"),
            (-1e-9, "-1.00e-9"),
        ] {
            assert_eq!(squared_error(share), expected);
        }
    }

    #[test]
    fn shares_are_percentages() {
        assert_eq!(percent(1e30), "over 10000 %");
        for (share, expected) in
            [(0.0, "0 %"), (1e-5, "under 0.1 %"), (0.005, "0.5 %"), (0.0213, "2.1 %"), (0.158, "16 %"), (-0.2, "-20 %")]
        {
            assert_eq!(percent(share), expected);
        }
    }
}
