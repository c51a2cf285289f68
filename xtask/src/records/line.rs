//! One line of the file: a record as JSON, and a hash of its text by which a damaged line is known.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use experiments::outcome::Outcome;
use serde::{Deserialize, Serialize};
use serde_json::value::{RawValue, to_raw_value};

/// What is kept of one data set of one setup.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    pub(super) key: String,
    pub(super) experiment: String,
    pub(super) setup: String,
    pub(super) number: u32,
    pub(super) outcome: Outcome,
}

#[derive(Serialize, Deserialize)]
struct Line<T> {
    hash: String,
    record: T,
}

impl Record {
    /// The line, with its end.
    pub(super) fn line(&self) -> serde_json::Result<Vec<u8>> {
        let record = to_raw_value(self)?;
        let mut line = serde_json::to_vec(&Line { hash: hash(&record), record })?;
        line.push(b'\n');
        Ok(line)
    }

    /// Reads a line without its end; none if it is torn or damaged.
    pub(super) fn read(line: &[u8]) -> Option<Record> {
        let Line::<Box<RawValue>> { hash: written, record } = serde_json::from_slice(line).ok()?;
        (written == hash(&record)).then(|| serde_json::from_str(record.get()).ok())?
    }
}

fn hash(record: &RawValue) -> String {
    let mut hasher = DefaultHasher::new();
    record.get().hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use experiments::measure::Measure;
    use proptest::prelude::*;

    use super::*;

    fn record(value: f64) -> Record {
        let outcome = Outcome::Measured(vec![BTreeMap::from([(Measure::Nupe, value), (Measure::Ncpe, 0.25)])]);
        let [key, experiment, setup] = ["table1/narrow/7/0123456789abcdef", "table1", "narrow"].map(str::to_owned);
        Record { key, experiment, setup, number: 7, outcome }
    }

    proptest! {
        /// Bytes changed, lost or added: what is read is what was written, or nothing.
        #[test]
        fn a_damaged_line_is_never_believed(
            value in -1e3..1e3_f64, at in any::<prop::sample::Index>(), byte in any::<u8>(), kind in 0..3
        ) {
            let record = record(value);
            let mut line = record.line().unwrap();
            prop_assert_eq!(line.pop(), Some(b'\n'));
            prop_assert_eq!(Record::read(&line), Some(record.clone()));
            let at = at.index(line.len());
            match kind {
                0 => line[at] = byte,
                1 => drop(line.remove(at)),
                _ => line.insert(at, byte),
            }
            prop_assert!(Record::read(&line).is_none_or(|read| read == record), "{}", String::from_utf8_lossy(&line));
        }
    }

    #[test]
    fn every_changed_digit_is_noticed() {
        let line = record(0.0123456789).line().unwrap();
        for at in (0..line.len()).filter(|&at| line[at].is_ascii_digit()) {
            let mut changed = line.clone();
            changed[at] = b'0' + (line[at] - b'0' + 1) % 10;
            assert_eq!(Record::read(&changed), None, "{}", String::from_utf8_lossy(&changed));
        }
    }

    #[test]
    fn what_has_no_hash_or_a_wrong_one_is_not_believed() {
        let empty = r#"{"key":"k","experiment":"e","setup":"s","number":0,"outcome":{"measured":[{}]}}"#;
        let wrong = format!(r#"{{"hash":"0123456789abcdef","record":{empty}}}"#);
        for line in [empty, &wrong, r#"{"measured":[{}]}"#, "", "{", "null", "\0"] {
            assert_eq!(Record::read(line.as_bytes()), None, "{line}");
        }
    }
}
