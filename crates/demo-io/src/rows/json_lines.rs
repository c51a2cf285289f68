//! JSON lines: a line an episode, as [`crate::write`] makes them or with lists by name, or a line a sample; or one list of either, or one
//! object that holds episodes, over any lines.

mod entry_arrays;
mod episode_line;
mod movements;

use std::io::{BufRead, BufReader, Read as _};

use self::entry_arrays::EntryArrays;
use self::episode_line::EpisodeLines;
use self::movements::{Form, rows_of_columns, within};
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
    let mut add = |place: u64, word: &'static str, alone: bool, document: &Json| {
        let form = || Form::of(document, alone);
        reader.get_or_insert_with(|| Reader::of(form(), alone, input, word)).push(place, document)
    };
    let mut add_all = |entries: Vec<Json>| {
        entries.into_iter().enumerate().try_for_each(|(at, entry)| add(at as u64, "entry", false, &entry))
    };
    let Some(first) = lines.next(&input.name, true, progress)? else {
        return Err(ReadError::Empty(Fault::new("there is no line", &input.name, "a file that is not empty")));
    };
    let place = lines.line;
    let second = lines.next(&input.name, false, progress)?;
    match first {
        Json::List(entries) => add_all(episodes_of(entries))?,
        first => match within(&first).filter(|_| second.is_none()) {
            Some(entries) => add_all(entries)?,
            None => add(place, "line", second.is_none(), &first)?,
        },
    }
    let mut next = second;
    while let Some(document) = next {
        add(lines.line, "line", false, &document)?;
        next = lines.next(&input.name, false, progress)?;
    }
    match reader {
        Some(reader) => reader.finish(),
        None => {
            Err(ReadError::Empty(Fault::new("there is no entry", &input.name, "a list of movements or of samples")))
        }
    }
}

/// The entries of a list that is a whole file: objects as they are, and lists of samples as episodes, one of each or one in all.
fn episodes_of(entries: Vec<Json>) -> Vec<Json> {
    let list_of_lists =
        |value: &Json| value.list().is_some_and(|rows| !rows.is_empty() && rows.iter().all(|row| row.list().is_some()));
    let episode = |samples: Json| Json::Map(vec![("state".to_owned(), samples)]);
    if entries.iter().all(list_of_lists) {
        return entries.into_iter().map(episode).collect();
    }
    let samples = Json::List(entries);
    match samples {
        samples if list_of_lists(&samples) => vec![episode(samples)],
        Json::List(entries) => entries,
        other => vec![other],
    }
}

/// What a line is, judged by the first.
enum Reader<'a> {
    Episodes(EpisodeLines<'a>),
    Arrays(EntryArrays<'a>),
    /// Objects of columns, of which each is an episode if there are several.
    Columns {
        rows: Box<Documents<'a>>,
        alone: bool,
    },
    Samples(Box<Documents<'a>>),
}

impl<'a> Reader<'a> {
    fn of(form: Form, alone: bool, input: &'a Input<'a>, word: &'static str) -> Self {
        let rows = || Box::new(Documents::new(input, word));
        match form {
            Form::Episode => Reader::Episodes(EpisodeLines::new(input, word)),
            Form::Arrays => Reader::Arrays(EntryArrays::new(input, word)),
            Form::Columns => Reader::Columns { rows: rows(), alone },
            Form::Other => Reader::Samples(rows()),
        }
    }

    fn push(&mut self, place: u64, document: &Json) -> Result<(), ReadError> {
        match self {
            Reader::Episodes(episodes) => episodes.push(place, document),
            Reader::Arrays(arrays) => arrays.push(place, document),
            Reader::Columns { rows, alone } => {
                let label = place.to_string();
                let label = Some(&label[..]).filter(|_| !*alone);
                rows_of_columns(document, label).iter().try_for_each(|row| rows.push(place, row))
            }
            Reader::Samples(rows) => rows.push(place, document),
        }
    }

    fn finish(self) -> Result<RawRecordings, ReadError> {
        match self {
            Reader::Episodes(episodes) => episodes.finish(),
            Reader::Arrays(arrays) => arrays.finish(),
            Reader::Columns { rows, .. } | Reader::Samples(rows) => rows.finish(),
        }
    }
}

struct Lines<R> {
    file: R,
    line: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// The next line that is not blank; the `first` document may take all lines.
    fn next(&mut self, file: &str, first: bool, progress: &mut dyn FnMut(u64)) -> Result<Option<Json>, ReadError> {
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
                progress(rest.map_err(|error| crate::input::unreadable(&error, file))? as u64);
                if let Ok(document) = serde_json::from_slice(&whole) {
                    return Ok(Some(document));
                }
            }
            return Err(self.malformed(&error, file));
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
