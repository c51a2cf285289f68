use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Take};

use crate::input::{Input, unreadable};
use crate::rows::json::Json;
use crate::rows::piece::Span;
use crate::{Fault, ReadError};

/// Maximum number of bytes of a line.
const LONGEST_LINE: u64 = 1 << 30;

/// The documents of a file.
pub(super) struct Lines {
    file: BufReader<Take<File>>,
    name: String,
    /// Line of the last document, counted from 1.
    pub(super) line: u64,
    text: Vec<u8>,
}

impl Lines {
    pub(super) fn new(input: &Input<'_>) -> Result<Self, ReadError> {
        let file = BufReader::with_capacity(1 << 16, input.open()?.take(u64::MAX));
        Ok(Self { file, name: input.name.clone(), line: 0, text: Vec::new() })
    }

    /// The lines of a part.
    pub(super) fn within(input: &Input<'_>, part: &Span) -> Result<Self, ReadError> {
        let mut lines = Self::new(input)?;
        lines.file.seek(SeekFrom::Start(part.bytes.start)).map_err(|error| unreadable(&error, &input.name))?;
        lines.file.get_mut().set_limit(part.size());
        lines.line = part.line.saturating_sub(1);
        Ok(lines)
    }

    /// Reads the next line that is not blank; the `first` document may extend over all lines.
    pub(super) fn next(&mut self, first: bool, progress: &mut dyn FnMut(u64)) -> Result<Option<Json>, ReadError> {
        loop {
            let file = &self.name;
            self.text.clear();
            let read = (&mut self.file).take(LONGEST_LINE).read_until(b'\n', &mut self.text);
            let read = read.map_err(|error| unreadable(&error, file))? as u64;
            if read == 0 {
                return Ok(None);
            }
            self.line += 1;
            progress(read);
            if read == LONGEST_LINE {
                let place = format!("{file}, line {}", self.line);
                let remedy = "one line per episode, or per sample";
                return Err(ReadError::TooLarge(Fault::new("a line of more than 1 GB", place, remedy)));
            }
            let text = self.text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&self.text);
            if text.trim_ascii().is_empty() {
                continue;
            }
            let error = match serde_json::from_slice(text) {
                Ok(document) => return Ok(Some(document)),
                Err(error) => error,
            };
            if first && error.is_eof() {
                let mut whole = text.to_owned();
                let rest = (&mut self.file).take(LONGEST_LINE).read_to_end(&mut whole);
                progress(rest.map_err(|error| unreadable(&error, file))? as u64);
                if let Ok(document) = serde_json::from_slice(&whole) {
                    return Ok(Some(document));
                }
            }
            return Err(self.malformed(&error));
        }
    }

    fn malformed(&self, error: &serde_json::Error) -> ReadError {
        let place = format!("{}, line {}, column {}", self.name, self.line, error.column());
        let text = error.to_string();
        let what = text.rsplit_once(" at line").map_or(&text[..], |(what, _)| what);
        let remedy = if self.text.windows(3).any(|letters| letters == b"NaN") {
            "null where a number is missing: NaN is not JSON"
        } else {
            "correct the line: each must be one JSON document"
        };
        ReadError::Json(Fault::new(format!("this is not JSON: {what}"), place, remedy))
    }
}
