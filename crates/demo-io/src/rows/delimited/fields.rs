use csv::ByteRecord;

use crate::TimeUnit;
use crate::rows::stamps::Stamp;
use crate::rows::table::Row;

/// The fields of a record as numbers, stamps and labels.
pub(super) struct Fields<'a> {
    pub(super) record: &'a ByteRecord,
    pub(super) decimal_comma: bool,
}

impl Row for Fields<'_> {
    fn number(&self, column: usize) -> Result<f64, String> {
        let field = self.record[column].trim_ascii();
        let value = if self.decimal_comma { with_decimal_comma(field) } else { parsed(field) };
        match value {
            Some(value) => Ok(value),
            None if is_missing(field) => Ok(f64::NAN),
            None => Err(String::from_utf8_lossy(field).into_owned()),
        }
    }

    fn stamp(&self, column: usize) -> Result<(Stamp, Option<TimeUnit>), String> {
        let field = self.record[column].trim_ascii();
        if is_missing(field) {
            return Ok((Stamp::MISSING, None));
        }
        let text = String::from_utf8_lossy(field);
        let pointed = if self.decimal_comma { text.replacen(',', ".", 1) } else { text.as_ref().to_owned() };
        Stamp::text(&pointed).ok_or_else(|| text.into_owned())
    }

    fn label(&self, column: usize, label: &mut String) {
        label.clear();
        let field = String::from_utf8_lossy(self.record[column].trim_ascii());
        // The form in which pandas writes integers of a column with a missing value.
        let whole = field.strip_suffix(".0").filter(|digits| digits.bytes().all(|digit| digit.is_ascii_digit()));
        label.push_str(whole.unwrap_or(&field));
    }
}

fn parsed(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

fn with_decimal_comma(field: &[u8]) -> Option<f64> {
    let mut pointed = [0; 64];
    let pointed = pointed.get_mut(..field.len())?;
    pointed.copy_from_slice(field);
    if let Some(comma) = pointed.iter().position(|&letter| letter == b',') {
        if pointed.contains(&b'.') {
            return None;
        }
        pointed[comma] = b'.';
    }
    parsed(pointed)
}

/// Whether a field is a common marker for a missing number. (The parser reads `NaN` as a number.)
fn is_missing(field: &[u8]) -> bool {
    const WORDS: [&[u8]; 8] = [b"", b"na", b"n/a", b"#n/a", b"null", b"none", b"nan", b"-"];
    WORDS.iter().any(|word| field.eq_ignore_ascii_case(word))
}
