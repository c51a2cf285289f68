use csv::ByteRecord;

use super::fields::Fields;
use crate::input::Input;
use crate::{Fault, ReadError};

/// The separators of a file, and the lines before its rows.
#[derive(Debug)]
pub(super) struct Dialect {
    pub(super) separator: u8,
    /// Whether runs of blanks separate fields.
    pub(super) blanks: bool,
    pub(super) decimal_comma: bool,
    /// Length of the byte order mark in bytes.
    pub(super) mark: usize,
    /// Names from the last comment before the rows, in `numpy.savetxt`'s form.
    pub(super) header: Option<Vec<String>>,
}

/// Number of lines examined to find the separator.
const LINES: usize = 20;

impl Dialect {
    pub(super) fn of(input: &Input<'_>) -> Result<Self, ReadError> {
        let head = &input.head;
        refuse_other_encodings(head, &input.name)?;
        let mark = if head.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let text = String::from_utf8_lossy(&head[mark..]);
        // The last line may be incomplete.
        let whole = if input.len > head.len() as u64 { text.rfind('\n').map_or(0, |end| end + 1) } else { text.len() };
        if whole == 0 && input.len > head.len() as u64 {
            let what = format!("not text with lines: no line ends within {} kB", head.len() / 1024);
            return Err(ReadError::NotThisFormat(Fault::new(what, &input.name, "--as with the format it has")));
        }
        let lines = || text[..whole].lines().map(str::trim_end).filter(|line| !line.trim().is_empty());
        let rows: Vec<&str> = lines().filter(|line| !line.starts_with('#')).take(LINES).collect();
        if rows.is_empty() {
            let what = if text.trim().is_empty() { "the file is empty" } else { "there is no row" };
            return Err(ReadError::Empty(Fault::new(what, &input.name, "a file with samples")));
        }
        let separator = match input.options.separator {
            Some(separator) if separator.is_ascii() => separator as u8,
            Some(separator) => {
                let what = format!("'{separator}' cannot separate fields");
                return Err(ReadError::Option(Fault::new(what, "--separator", "--separator with an ASCII character")));
            }
            None => separator_of(&rows),
        };
        let comment = lines().take_while(|line| line.starts_with('#')).last().map(|line| line.trim_start_matches('#'));
        let fields = |line: &str| fields(line, separator);
        let count = fields(rows[0]).len();
        let header =
            comment.map(fields).filter(|names| names.len() == count && !names.iter().all(|name| is_number(name)));
        let decimal_comma = match input.options.decimal {
            Some(',') => true,
            Some('.') => false,
            Some(other) => {
                let what = format!("'{other}' is not a decimal point");
                return Err(ReadError::Option(Fault::new(what, "--decimal", "--decimal . or --decimal ,")));
            }
            None => separator != b',' && has_decimal_commas(&rows, separator),
        };
        let header = header.filter(|_| fields(rows[0]).iter().any(|field| is_number(&field.replacen(',', ".", 1))));
        Ok(Self { separator, blanks: separator == b' ', decimal_comma, mark, header })
    }

    pub(super) fn fields<'a>(&self, record: &'a ByteRecord) -> Fields<'a> {
        Fields { record, decimal_comma: self.decimal_comma }
    }
}

fn refuse_other_encodings(head: &[u8], file: &str) -> Result<(), ReadError> {
    let zeros = |first: usize| head.iter().skip(first).step_by(2).take(200).filter(|&&byte| byte == 0).count();
    let marked = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    let wide = head.len() >= 8 && zeros(0).max(zeros(1)) > head.len().min(400) / 4;
    if marked || (wide && head.iter().take(400).all(|&byte| byte < 0x80)) {
        let remedy = "save it as UTF-8 (in Python: df.to_csv(path, encoding='utf-8'); in Excel: CSV UTF-8)";
        return Err(ReadError::Encoding(Fault::new("the text is UTF-16", file, remedy)));
    }
    if head.contains(&0) {
        let what = "not text: there are zero bytes";
        return Err(ReadError::NotThisFormat(Fault::new(what, file, "--as with the format it has")));
    }
    Ok(())
}

/// The first of tab, semicolon, comma, bar and blank that divides all lines into the same number of fields, else the
/// first that divides the first line. The comma comes after the semicolon, because it may be a decimal comma.
fn separator_of(rows: &[&str]) -> u8 {
    let candidates = [b'\t', b';', b',', b'|', b' '];
    let count = |row: &str, separator: u8| fields(row, separator).len();
    let even = |&separator: &u8| {
        let first = count(rows[0], separator);
        first > 1 && rows.iter().all(|row| count(row, separator) == first)
    };
    let divides = |&separator: &u8| count(rows[0], separator) > 1;
    candidates.iter().copied().find(even).or_else(|| candidates.iter().copied().find(divides)).unwrap_or(b',')
}

/// The fields of a line. Separators between quotation marks do not count.
fn fields(line: &str, separator: u8) -> Vec<String> {
    let mut quoted = false;
    let mut fields = vec![String::new()];
    for letter in line.trim_end_matches(['\r', '\n']).chars() {
        quoted ^= letter == '"';
        if !quoted && letter == char::from(separator) {
            fields.push(String::new());
        } else if letter != '"'
            && let Some(field) = fields.last_mut()
        {
            field.push(letter);
        }
    }
    if separator == b' ' {
        return line.split_ascii_whitespace().map(str::to_owned).collect();
    }
    fields.iter().map(|field| field.trim().to_owned()).collect()
}

fn is_number(field: &str) -> bool {
    field.trim().parse::<f64>().is_ok()
}

/// Whether some field becomes a number when its comma is replaced by a point, and no number has a point.
fn has_decimal_commas(rows: &[&str], separator: u8) -> bool {
    let fields: Vec<String> = rows.iter().flat_map(|row| fields(row, separator)).collect();
    let comma = |field: &String| field.contains(',') && is_number(&field.replacen(',', ".", 1));
    let point = |field: &String| field.contains('.') && is_number(field);
    fields.iter().any(comma) && !fields.iter().any(point)
}
