//! JSON lines: a line an episode, as [`crate::write`] makes them, or a line a sample.

mod episode_line;

use std::io::{BufRead, BufReader, Read as _};

use self::episode_line::EpisodeLines;
use crate::input::Input;
use crate::raw::RawRecordings;
use crate::rows::documents::Documents;
use crate::rows::json::Json;
use crate::{Fault, ReadError};

/// A line of more bytes is not read.
const LONGEST_LINE: u64 = 1 << 30;

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let mut lines = Lines { file: BufReader::with_capacity(1 << 16, input.open()?), line: 0, text: Vec::new() };
    let mut reader: Option<Reader<'_>> = None;
    while let Some(document) = lines.next(&input.name, progress)? {
        let reader = reader.get_or_insert_with(|| Reader::of(&document, input));
        match reader {
            Reader::Episodes(episodes) => episodes.push(lines.line, &document)?,
            Reader::Samples(rows) => rows.push(lines.line, &document)?,
        }
    }
    match reader {
        Some(Reader::Episodes(episodes)) => episodes.finish(),
        Some(Reader::Samples(rows)) => rows.finish(),
        None => Err(ReadError::Empty(Fault::new("there is no line", &input.name, "a file that is not empty"))),
    }
}

/// What a line is, judged by the first.
enum Reader<'a> {
    Episodes(EpisodeLines<'a>),
    Samples(Box<Documents<'a>>),
}

impl<'a> Reader<'a> {
    fn of(first: &Json, input: &'a Input<'a>) -> Self {
        match episode_line::state(first) {
            Some(_) => Reader::Episodes(EpisodeLines::new(input)),
            None => Reader::Samples(Box::new(Documents::new(input, "line"))),
        }
    }
}

struct Lines<R> {
    file: R,
    line: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// The next line that is not blank.
    fn next(&mut self, file: &str, progress: &mut dyn FnMut(u64)) -> Result<Option<Json>, ReadError> {
        loop {
            self.text.clear();
            let read = (&mut self.file).take(LONGEST_LINE).read_until(b'\n', &mut self.text);
            let read = read.map_err(|error| crate::input::unreadable(&error, file))? as u64;
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
            if !text.trim_ascii().is_empty() {
                return serde_json::from_slice(text).map(Some).map_err(|error| self.malformed(&error, file));
            }
        }
    }

    fn malformed(&self, error: &serde_json::Error, file: &str) -> ReadError {
        let place = format!("{file}, line {}, column {}", self.line, error.column());
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
