/// Contents of the first rows of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// Integers, each the previous one plus 1, or restarting.
    Counting,
    /// Numbers, or missing values.
    Numbers,
    /// Only words that begin with a letter.
    Words,
    /// Anything else.
    Text,
}

/// Number of rows by which columns are judged.
pub(crate) const HEAD_ROWS: usize = 64;

/// Determines the contents of a column from its numbers in the first rows.
pub(crate) fn content(numbers: impl Iterator<Item = Result<f64, String>>) -> Content {
    let mut last: Option<f64> = None;
    let (mut counting, mut words, mut rows) = (true, 0, 0);
    for number in numbers {
        rows += 1;
        let value = match number {
            Ok(value) => value,
            Err(text) if text.starts_with(char::is_alphabetic) => {
                words += 1;
                continue;
            }
            Err(_) => return Content::Text,
        };
        counting &= value.fract() == 0.0 && last.is_none_or(|last| value == last + 1.0 || value < last);
        last = Some(value);
    }
    if words > 0 {
        return if words == rows { Content::Words } else { Content::Text };
    }
    if counting { Content::Counting } else { Content::Numbers }
}
