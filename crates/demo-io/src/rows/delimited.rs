//! Text with separators: CSV, TSV, columns between blanks.

mod dialect;
mod fields;
mod source;

use std::cell::Cell;
use std::rc::Rc;

use csv::ByteRecord;

use self::dialect::Dialect;
use self::source::TextSource;
use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::arrays::flat;
use crate::input::Input;
use crate::raw::{RawRecordings, remark};
use crate::rows::roles::Column;
use crate::rows::table::{HEAD_ROWS, Row as _, Table, content};
use crate::{Fault, ReadError, SamplesAre};

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let dialect = Dialect::of(input)?;
    let source = TextSource::new(input, &dialect, progress)?;
    let since_record = Rc::clone(&source.since_record);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(dialect.separator)
        .comment(Some(b'#'))
        .has_headers(false)
        .flexible(true)
        .buffer_capacity(1 << 16)
        .from_reader(source);
    let mut rows = Rows { reader: &mut reader, fields: 0, file: input.name.clone(), since_record };
    let mut record = ByteRecord::new();
    let mut head: Vec<(u64, ByteRecord)> = Vec::new();
    let header = match &dialect.header {
        Some(header) => Some(header.clone()),
        None => rows.header(&dialect, &mut record, &mut head)?,
    };
    if let Some(header) = &header {
        rows.fields = header.len();
    }
    while head.len() < HEAD_ROWS {
        let Some(line) = rows.next(&mut record)? else { break };
        head.push((line, record.clone()));
    }
    if header.is_none() && input.options.samples_are == Some(SamplesAre::Columns) {
        return transposed(input, &dialect, &mut rows, &head);
    }
    let Some((first_line, first)) = head.first() else {
        let what = if header.is_some() { "there is a header but no row" } else { "there is no row" };
        return Err(ReadError::Empty(Fault::new(what, &input.name, "a file with samples")));
    };
    let no_header = header.is_none();
    let names = header.unwrap_or_else(|| (0..first.len()).map(|column| format!("c{column}")).collect());
    if no_header && input.options.state.is_empty() {
        let n = names.len();
        let what = format!("there is no header: line {first_line} begins with numbers, and {n} columns have no name");
        let remedy = "--state 2,3 --time 1 (columns count from 0; also --episode 0, --velocity 4,5), or write a first line with names";
        let remedy = if n > head.len() {
            format!("--samples-are columns if each line is a channel; else {remedy}")
        } else {
            remedy.to_owned()
        };
        return Err(ReadError::NoRoles(Fault::new(what, &input.name, remedy)));
    }
    let column = |(column, name): (usize, String)| Column {
        name,
        content: content(head.iter().map(|(_, record)| dialect.fields(record).number(column))),
    };
    let columns: Vec<Column> = names.into_iter().enumerate().map(column).collect();
    let mut table = Table::new(&columns, (&input.name, &input.stem), "line", input.options)?;
    table.hint = hint;
    for (line, record) in &head {
        table.push(*line, &dialect.fields(record))?;
    }
    drop(head);
    while let Some(line) = rows.next(&mut record)? {
        table.push(line, &dialect.fields(&record))?;
    }
    let mut drafts = table.finish();
    if dialect.decimal_comma {
        let what = format!("decimal commas of {} were read as points", input.name);
        drafts.findings.push(remark(what, "--decimal . if they are something else"));
    }
    Ok(drafts)
}

/// Text without names that holds a channel a line: an array whose samples are columns.
fn transposed<R: std::io::Read>(
    input: &Input<'_>,
    dialect: &Dialect,
    rows: &mut Rows<'_, R>,
    head: &[(u64, ByteRecord)],
) -> Result<RawRecordings, ReadError> {
    let mut numbers = Vec::new();
    let mut push = |line: u64, record: &ByteRecord| {
        input.charge(8 * record.len() as u64)?;
        for column in 0..record.len() {
            let number = dialect.fields(record).number(column);
            numbers.push(number.map_err(|text| {
                let what = format!("'{}' is not a number", text.chars().take(40).collect::<String>());
                let place = format!("{}, line {line}, column {column}", input.name);
                ReadError::NotANumber(Fault::new(what, place, "lines of numbers only, or a first line with names"))
            })?);
        }
        Ok(())
    };
    head.iter().try_for_each(|(line, record)| push(*line, record))?;
    let mut lines = head.len();
    let mut record = ByteRecord::new();
    while let Some(line) = rows.next(&mut record)? {
        push(line, &record)?;
        lines += 1;
    }
    let mut samples = rows.fields;
    // A separator at the end of each line.
    if samples > 1 && numbers.chunks_exact(samples).all(|line| line[samples - 1].is_nan()) {
        numbers = numbers.chunks_exact(samples).flat_map(|line| &line[..samples - 1]).copied().collect();
        samples -= 1;
    }
    let shape = vec![lines, samples];
    let described = [ArraySpec { name: input.stem.clone(), shape, kind: Kind::Number("float64") }];
    flat::drafts(input, &described, &mut |_| Ok(Data::Numbers(numbers.clone())))
}

/// Records of equal length, with their lines.
struct Rows<'a, R> {
    reader: &'a mut csv::Reader<R>,
    /// 0 until it is known.
    fields: usize,
    file: String,
    /// Bytes read since the last record.
    since_record: Rc<Cell<usize>>,
}

impl<R: std::io::Read> Rows<'_, R> {
    fn next(&mut self, record: &mut ByteRecord) -> Result<Option<u64>, ReadError> {
        loop {
            match self.reader.read_byte_record(record) {
                Ok(true) => {}
                Ok(false) => return Ok(None),
                Err(error) => return Err(self.unreadable(&error)),
            }
            self.since_record.set(0);
            let line = record.position().map_or(0, csv::Position::line);
            let blank = record.len() == 1 && record[0].trim_ascii().is_empty();
            if blank && self.fields != 1 {
                continue;
            }
            if self.fields == 0 {
                self.fields = record.len();
            }
            if record.len() != self.fields {
                let what = format!("{} fields where {} are expected", record.len(), self.fields);
                let place = format!("{}, line {line}", self.file);
                let remedy = "correct the line; --separator if fields are divided wrongly";
                return Err(ReadError::Ragged(Fault::new(what, place, remedy)));
            }
            return Ok(Some(line));
        }
    }

    /// The first record if it is a header; otherwise it goes to `head`.
    fn header(
        &mut self,
        dialect: &Dialect,
        record: &mut ByteRecord,
        head: &mut Vec<(u64, ByteRecord)>,
    ) -> Result<Option<Vec<String>>, ReadError> {
        let Some(line) = self.next(record)? else { return Ok(None) };
        let fields = dialect.fields(record);
        let number = |column| fields.number(column).is_ok() && !record[column].trim_ascii().is_empty();
        if (0..record.len()).any(number) && !is_counted(record) {
            head.push((line, record.clone()));
            return Ok(None);
        }
        let name = |field: &[u8]| String::from_utf8(field.trim_ascii().to_vec());
        record.iter().map(name).collect::<Result<_, _>>().map(Some).map_err(|_| {
            let (what, place) = ("the text is not UTF-8", format!("{}, line {line}", self.file));
            ReadError::Encoding(Fault::new(what, place, "save it as UTF-8 (or plain ASCII)"))
        })
    }

    fn unreadable(&self, error: &csv::Error) -> ReadError {
        let line = self.reader.position().line();
        let place = format!("{}, line {line}", self.file);
        match error.kind() {
            csv::ErrorKind::Io(error) if error.kind() == std::io::ErrorKind::FileTooLarge => {
                let what = "a line of more than 16 MB, or a quotation mark that is never closed";
                ReadError::NotThisFormat(Fault::new(what, place, "correct the line"))
            }
            _ => ReadError::Unreadable(Fault::new(error.to_string(), place, "another copy of the file")),
        }
    }
}

/// What pandas writes where columns have no names: `,0,1,2`.
fn is_counted(record: &ByteRecord) -> bool {
    let names = record.iter().enumerate().filter(|(at, field)| *at > 0 || !field.is_empty());
    record.len() > 2 && names.enumerate().all(|(number, (_, field))| field == number.to_string().as_bytes())
}

/// A decimal comma among points.
fn hint(text: &str) -> Option<String> {
    let (whole, decimals) = text.split_once(',')?;
    let digits = |text: &str| {
        !text.is_empty() && text.bytes().all(|letter| letter.is_ascii_digit() || b"+-eE".contains(&letter))
    };
    (digits(whole) && digits(decimals)).then(|| "--decimal , (this seems to be a decimal comma)".to_owned())
}
