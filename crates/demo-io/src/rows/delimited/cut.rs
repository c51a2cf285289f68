use std::collections::HashSet;

use csv::ByteRecord;

use super::beginning::Beginning;
use super::dialect::Dialect;
use crate::ReadError;
use crate::input::Input;
use crate::raw::MOST_EPISODES;
use crate::regular_file::FileState;
use crate::rows::piece::{Cuts, Span, Start};
use crate::rows::table::{Cutting, Row as _};

/// At the start of a part, its reader would skip this mark instead of reading it as text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Cuts a text into parts of whole movements, each of at most `most` bytes unless a movement has more. Returns no part if the text
/// cannot be cut: it has no column of episodes, or one whose labels recur.
pub(crate) fn cut(
    input: &Input<'_>,
    (most, of): (u64, FileState),
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<Span>, ReadError> {
    let beginning = Beginning::of(input, progress, true)?;
    if beginning.is_transposed(input) {
        return Ok(Vec::new());
    }
    let Some(cutting) = beginning.table(input)?.cutting() else { return Ok(Vec::new()) };
    let Beginning { dialect, mut records, head, .. } = beginning;
    let (mut episodes, mut cuts) = (Episodes::new(cutting), Cuts::new(most, of));
    let (mut head, mut record) = (head.into_iter(), ByteRecord::new());
    loop {
        let line = match head.next() {
            Some((line, first)) => {
                record = first;
                line
            }
            None => match records.next(&mut record)? {
                Some(line) => line,
                None => return Ok(cuts.finish()),
            },
        };
        let byte = records.byte_of(&record);
        match (episodes.look(&record, &dialect), episodes.seen.len().saturating_sub(1)) {
            (Next::Same, _) => {}
            (Next::New, movements) => match byte.filter(|_| !record[0].starts_with(BYTE_ORDER_MARK)) {
                Some(byte) => cuts.push(Start { byte, line, movements }),
                None if movements == 0 => return Ok(Vec::new()),
                None => {}
            },
            (Next::InTheWay, _) => return Ok(Vec::new()),
        }
    }
}

/// The episodes so far, by their labels.
struct Episodes {
    cutting: Cutting,
    seen: HashSet<String>,
    /// The last record's label, as written; `label` is its parsed form.
    written: Vec<u8>,
    label: String,
    /// The first record's constraint label, in both forms.
    constraint: Option<(Vec<u8>, String)>,
}

/// The effect of a record on the cut.
enum Next {
    Same,
    /// A movement begins.
    New,
    /// The text cannot be divided into parts that could be read alone.
    InTheWay,
}

impl Episodes {
    fn new(cutting: Cutting) -> Episodes {
        Episodes { cutting, seen: HashSet::new(), written: Vec::new(), label: String::new(), constraint: None }
    }

    fn look(&mut self, record: &ByteRecord, dialect: &Dialect) -> Next {
        if self.cutting.constraint.is_some_and(|column| self.is_other_constraint(column, record, dialect)) {
            return Next::InTheWay;
        }
        let written = &record[self.cutting.episode];
        if !self.seen.is_empty() && written == self.written {
            return Next::Same;
        }
        self.written.clear();
        self.written.extend_from_slice(written);
        let mut label = String::new();
        dialect.fields(record).label(self.cutting.episode, &mut label);
        if !self.seen.is_empty() && label == self.label {
            return Next::Same;
        }
        self.label.clone_from(&label);
        // The reader of the whole file refuses more.
        if self.seen.insert(label) && self.seen.len() <= MOST_EPISODES { Next::New } else { Next::InTheWay }
    }

    fn is_other_constraint(&mut self, column: usize, record: &ByteRecord, dialect: &Dialect) -> bool {
        let meant = || {
            let mut label = String::new();
            dialect.fields(record).label(column, &mut label);
            label
        };
        match &self.constraint {
            None => self.constraint = Some((record[column].to_vec(), meant())),
            Some((written, _)) if *written == record[column] => {}
            Some((_, label)) => return *label != meant(),
        }
        false
    }
}
