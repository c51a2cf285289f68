use csv::ByteRecord;

use super::dialect::Dialect;
use super::records::Records;
use super::source::TextSource;
use crate::input::Input;
use crate::rows::roles::{Column, HEAD_ROWS, content};
use crate::rows::table::{Row as _, Table};
use crate::{Fault, ReadError, SamplesAre};

/// A text whose first records have been read. They determine how to read all others.
pub(super) struct Beginning<'a> {
    pub(super) dialect: Dialect,
    pub(super) header: Option<Vec<String>>,
    /// The first records with their line numbers.
    pub(super) head: Vec<(u64, ByteRecord)>,
    /// The records that follow.
    pub(super) records: Records<'a>,
}

impl<'a> Beginning<'a> {
    /// `is_cut`: whether [`Records::byte_of`] will be called.
    pub(super) fn of(input: &Input<'_>, progress: &'a mut dyn FnMut(u64), is_cut: bool) -> Result<Self, ReadError> {
        let dialect = Dialect::of(input)?;
        let mut records = Records::new(TextSource::new(input, &dialect, progress, is_cut)?, &dialect, &input.name);
        let mut record = ByteRecord::new();
        let mut head: Vec<(u64, ByteRecord)> = Vec::new();
        let header = match &dialect.header {
            Some(header) => Some(header.clone()),
            None => header(&mut records, &dialect, &input.name, &mut head)?,
        };
        if let Some(header) = &header {
            records.fields = header.len();
        }
        while head.len() < HEAD_ROWS {
            let Some(line) = records.next(&mut record)? else { break };
            head.push((line, record.clone()));
        }
        // These records determine the contents of columns.
        let again = |(_, record): &&(u64, ByteRecord)| header.as_ref().is_some_and(|names| is_header(record, names));
        match head.iter().find(again) {
            Some((line, _)) => Err(header_again(*line, &input.name)),
            None => Ok(Self { dialect, header, head, records }),
        }
    }

    /// Whether each line holds a channel.
    pub(super) fn is_transposed(&self, input: &Input<'_>) -> bool {
        self.header.is_none() && input.options.samples_are == Some(SamplesAre::Columns)
    }

    /// The first of `n` columns whose numbers rise from line to line, as stamps do.
    fn rising(&self, n: usize) -> Option<usize> {
        let Self { dialect, head, .. } = self;
        let rises = |column: &usize| {
            let numbers: Result<Vec<f64>, _> =
                head.iter().map(|(_, record)| dialect.fields(record).number(*column)).collect();
            numbers.is_ok_and(|numbers| numbers.len() > 2 && numbers.windows(2).all(|pair| pair[0] < pair[1]))
        };
        [0, n - 1].into_iter().find(rises)
    }

    /// A table that contains the first records.
    pub(super) fn table(&self, input: &Input<'_>) -> Result<Table, ReadError> {
        let Self { dialect, header, head, .. } = self;
        let Some((first_line, first)) = head.first() else {
            let what = if header.is_some() { "there is a header but no row" } else { "there is no row" };
            return Err(ReadError::Empty(Fault::new(
                what,
                &input.name,
                "a file with samples; instead of a folder, name the files in it that are recordings",
            )));
        };
        if header.is_none() && input.options.state.is_empty() {
            let n = first.len();
            let what =
                format!("there is no header: line {first_line} begins with numbers, and {n} columns have no name");
            let roles = match self.rising(n) {
                Some(0) if n > 1 => format!("--state 1-{} --time 0", n - 1),
                Some(last) if last > 0 && last == n - 1 => format!("--state 0-{} --time {last}", n - 2),
                _ => format!("--state 0-{} --dt SECONDS", n - 1),
            };
            let remedy = format!(
                "{roles} (columns count from 0; --velocity and --episode name others), or write a first line with names"
            );
            let remedy = if n > head.len() {
                format!("--samples-are columns if each line is a channel; else {remedy}")
            } else {
                remedy
            };
            return Err(ReadError::NoRoles(Fault::new(what, &input.name, remedy)));
        }
        let counted = || (0..first.len()).map(|column| format!("c{column}")).collect();
        let names = header.clone().unwrap_or_else(counted);
        let column = |(column, name): (usize, String)| Column {
            name,
            content: content(head.iter().map(|(_, record)| dialect.fields(record).number(column))),
        };
        let columns: Vec<Column> = names.into_iter().enumerate().map(column).collect();
        let mut table = Table::new(&columns, (&input.name, &input.stem), "line", input.options)?;
        table.hint = hint;
        for (line, record) in head {
            table.push(*line, &dialect.fields(record))?;
        }
        Ok(table)
    }
}

/// Whether a record repeats the header.
pub(super) fn is_header(record: &ByteRecord, names: &[String]) -> bool {
    let is_name = |(field, name): (&[u8], &String)| field.trim_ascii() == name.as_bytes();
    names.len() == record.len() && record.iter().zip(names).all(is_name)
}

/// Error: a text that was joined from several.
pub(super) fn header_again(line: u64, file: &str) -> ReadError {
    let remedy = "the files as they were before they were joined (several can be named), or one header, and a column that tells episodes apart";
    ReadError::NotANumber(Fault::new("the header is repeated", format!("{file}, line {line}"), remedy))
}

/// Returns the first record if it is a header; otherwise moves it to `head`.
fn header(
    records: &mut Records<'_>,
    dialect: &Dialect,
    file: &str,
    head: &mut Vec<(u64, ByteRecord)>,
) -> Result<Option<Vec<String>>, ReadError> {
    let mut record = ByteRecord::new();
    let Some(line) = records.next(&mut record)? else { return Ok(None) };
    let fields = dialect.fields(&record);
    let number = |column| fields.number(column).is_ok() && !record[column].trim_ascii().is_empty();
    if (0..record.len()).any(number) && !is_counted(&record) {
        head.push((line, record));
        return Ok(None);
    }
    let name = |field: &[u8]| String::from_utf8(field.trim_ascii().to_vec());
    record.iter().map(name).collect::<Result<_, _>>().map(Some).map_err(|_| {
        let (what, place) = ("the text is not UTF-8", format!("{file}, line {line}"));
        ReadError::Encoding(Fault::new(what, place, "save it as UTF-8 (or plain ASCII)"))
    })
}

/// Whether a record is pandas' header for columns without names: `,0,1,2`.
fn is_counted(record: &ByteRecord) -> bool {
    let names = record.iter().enumerate().filter(|(at, field)| *at > 0 || !field.is_empty());
    record.len() > 2 && names.enumerate().all(|(number, (_, field))| field == number.to_string().as_bytes())
}

/// Advice on a decimal comma among decimal points.
fn hint(text: &str) -> Option<String> {
    let (whole, decimals) = text.split_once(',')?;
    let digits = |text: &str| {
        !text.is_empty() && text.bytes().all(|letter| letter.is_ascii_digit() || b"+-eE".contains(&letter))
    };
    (digits(whole) && digits(decimals)).then(|| "--decimal , (this seems to be a decimal comma)".to_owned())
}
