/// What the first rows of a column hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// Whole numbers, each one more than the last, or starting again.
    Counting,
    /// Numbers, or nothing.
    Numbers,
    /// Words that begin with a letter, throughout.
    Words,
    /// Anything else.
    Text,
}

/// Columns are judged by so many rows.
pub(crate) const HEAD_ROWS: usize = 64;

/// What a column holds, judged by its numbers in the first rows.
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
