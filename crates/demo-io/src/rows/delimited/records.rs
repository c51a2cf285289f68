use std::cell::Cell;
use std::rc::Rc;

use csv::ByteRecord;

use super::dialect::Dialect;
use super::source::TextSource;
use crate::rows::piece::Span;
use crate::{Fault, ReadError};

/// Records of equal length, with their line numbers.
pub(super) struct Records<'a> {
    reader: csv::Reader<TextSource<'a>>,
    /// Number of fields; 0 until it is known.
    pub(super) fields: usize,
    file: String,
    /// Number of lines before the reader's first.
    lines_before: u64,
    /// Bytes read since the last record.
    since_record: Rc<Cell<usize>>,
}

impl<'a> Records<'a> {
    pub(super) fn new(source: TextSource<'a>, dialect: &Dialect, file: &str) -> Self {
        let since_record = Rc::clone(&source.since_record);
        Self { reader: reader(source, dialect), fields: 0, file: file.to_owned(), lines_before: 0, since_record }
    }

    /// The records of a part, with the same number of fields.
    pub(super) fn within(self, part: &Span, dialect: &Dialect) -> Result<Self, ReadError> {
        let unreadable = |error| crate::input::unreadable(&error, &self.file);
        let source = self.reader.into_inner().within(&part.bytes).map_err(unreadable)?;
        Ok(Self { reader: reader(source, dialect), lines_before: part.line.saturating_sub(1), ..self })
    }

    /// The byte of the file at which a record begins; `None` if reading cannot start there.
    pub(super) fn byte_of(&mut self, record: &ByteRecord) -> Option<u64> {
        self.reader.get_mut().byte_of(record.position()?.byte())
    }

    pub(super) fn next(&mut self, record: &mut ByteRecord) -> Result<Option<u64>, ReadError> {
        loop {
            match self.reader.read_byte_record(record) {
                Ok(true) => {}
                Ok(false) => return Ok(None),
                Err(error) => return Err(self.unreadable(&error)),
            }
            self.since_record.set(0);
            let line = self.lines_before + record.position().map_or(0, csv::Position::line);
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

    fn unreadable(&self, error: &csv::Error) -> ReadError {
        let line = self.lines_before + self.reader.position().line();
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

fn reader<'a>(source: TextSource<'a>, dialect: &Dialect) -> csv::Reader<TextSource<'a>> {
    csv::ReaderBuilder::new()
        .delimiter(dialect.separator)
        .comment(Some(b'#'))
        .has_headers(false)
        .flexible(true)
        .buffer_capacity(1 << 16)
        .from_reader(source)
}
