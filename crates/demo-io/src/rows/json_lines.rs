//! JSON lines: an episode per line, either in [`crate::write`]'s form or as named lists, or a sample per line. Also one list of these, or
//! one object that holds episodes, over any number of lines.

mod cut;
mod entry_arrays;
mod episode_line;
mod lines;
mod movements;

pub(crate) use self::cut::cut;
use self::entry_arrays::EntryArrays;
use self::episode_line::EpisodeLines;
use self::lines::Lines;
use self::movements::{Form, rows_of_columns, within};
use crate::input::Input;
use crate::raw::RawRecordings;
use crate::rows::documents::Documents;
use crate::rows::json::Json;
use crate::rows::piece::Span;
use crate::{Fault, ReadError};

/// Reads all lines, or those of a part with an episode in each.
pub(crate) fn read(
    input: &Input<'_>,
    part: Option<&Span>,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    let mut lines = Lines::new(input)?;
    if let Some(part) = part {
        let mut episodes = EpisodeLines::new(input, "line");
        if let Some(first) = lines.next(true, &mut |_| ())? {
            episodes.push(lines.line, &first)?;
        }
        episodes.forget(part.movements);
        let mut lines = Lines::within(input, part)?;
        while let Some(document) = lines.next(false, progress)? {
            episodes.push(lines.line, &document)?;
        }
        return episodes.finish();
    }
    let mut reader: Option<Reader<'_>> = None;
    let mut add = |place: u64, word: &'static str, alone: bool, document: &Json| {
        let form = || Form::of(document, alone);
        reader.get_or_insert_with(|| Reader::of(form(), alone, input, word)).push(place, document)
    };
    let mut add_all = |entries: Vec<Json>| {
        entries.into_iter().enumerate().try_for_each(|(at, entry)| add(at as u64, "entry", false, &entry))
    };
    let Some(first) = lines.next(true, progress)? else {
        return Err(ReadError::Empty(Fault::new("there is no line", &input.name, "a file that is not empty")));
    };
    let place = lines.line;
    let second = lines.next(false, progress)?;
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
        next = lines.next(false, progress)?;
    }
    match reader {
        Some(reader) => reader.finish(),
        None => {
            Err(ReadError::Empty(Fault::new("there is no entry", &input.name, "a list of movements or of samples")))
        }
    }
}

/// The entries of a list that is the whole file. Objects stay as they are; lists of samples become episodes, one for each list or one for
/// all samples.
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

/// The kind of the lines, determined by the first.
enum Reader<'a> {
    Episodes(EpisodeLines<'a>),
    Arrays(EntryArrays<'a>),
    /// Objects of columns. If there are several, each is an episode.
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
