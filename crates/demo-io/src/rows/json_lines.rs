//! JSON lines: a line an episode, as [`crate::write`] makes them, or a line a sample; or one list of either, over any lines.

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
    let mut add = |place: u64, word: &'static str, document: &Json| {
        let reader = reader.get_or_insert_with(|| Reader::of(document, input, word));
        match reader {
            Reader::Episodes(episodes) => episodes.push(place, document),
            Reader::Samples(rows) => rows.push(place, document),
        }
    };
    let mut first = true;
    while let Some(document) = lines.next(&input.name, first, progress)? {
        match document {
            Json::List(entries) if first => {
                let listed = episodes_of(entries).into_iter().enumerate();
                listed.into_iter().try_for_each(|(at, entry)| add(at as u64, "entry", &entry))?;
            }
            document => add(lines.line, "line", &document)?,
        }
        first = false;
    }
    match reader {
        Some(Reader::Episodes(episodes)) => episodes.finish(),
        Some(Reader::Samples(rows)) => rows.finish(),
        None => Err(ReadError::Empty(Fault::new("there is no line", &input.name, "a file that is not empty"))),
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
    Samples(Box<Documents<'a>>),
}

impl<'a> Reader<'a> {
    fn of(first: &Json, input: &'a Input<'a>, word: &'static str) -> Self {
        match episode_line::state(first) {
            Some(_) => Reader::Episodes(EpisodeLines::new(input, word)),
            None => Reader::Samples(Box::new(Documents::new(input, word))),
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
