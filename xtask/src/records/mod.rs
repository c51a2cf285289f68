//! Finished data sets, kept one JSON line each so that nothing but what is in flight is ever lost.

mod line;

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Context as _;
use experiments::outcome::Outcome;

use crate::failure::Failure;
use line::Record;

/// Names one data set of one setup of an experiment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DataSet<'a> {
    /// The experiment's id.
    pub(crate) experiment: &'a str,
    /// The setup's id.
    pub(crate) setup: &'a str,
    /// All parameters of the setup.
    pub(crate) definition: &'a str,
    /// The seed of the run.
    pub(crate) seed: u64,
    /// The repetition, from 0.
    pub(crate) number: u32,
}

/// The file of finished data sets, open for appending.
#[derive(Debug)]
pub(crate) struct Records {
    path: PathBuf,
    code: u64,
    finished: HashMap<String, Outcome>,
    unreadable: usize,
    file: Mutex<File>,
}

/// Whether the outcomes of earlier runs are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Earlier {
    /// Pick up what is finished.
    Resume,
    /// Forget it.
    Forget,
}

impl Records {
    /// Opens the records at `path`, creating them where there are none. Lines that cannot be believed, such as the torn
    /// last line of a killed run, are passed over; their data sets are computed again.
    pub(crate) fn open(path: &Path, earlier: Earlier) -> anyhow::Result<Records> {
        let (file, bytes) = open(path, earlier).map_err(|error| {
            let remedy = "wait for the other run, or choose another --out";
            Failure::new(format!("the records cannot be opened: {error:#}"), path.display().to_string(), remedy)
        })?;
        let (finished, unreadable) = read(&bytes);
        Ok(Records { path: path.to_owned(), code: code_identity()?, finished, unreadable, file: Mutex::new(file) })
    }

    /// Adds what another file holds, which stays as it is.
    pub(crate) fn add(&mut self, path: &Path) -> anyhow::Result<()> {
        let bytes = std::fs::read(path).map_err(|error| {
            let remedy = "--merge with the folder of each shard";
            Failure::new(format!("the records of a shard cannot be read: {error}"), path.display().to_string(), remedy)
        })?;
        let (records, unreadable) = read(&bytes);
        self.finished.extend(records);
        self.unreadable += unreadable;
        Ok(())
    }

    /// How many lines were passed over.
    pub(crate) fn unreadable(&self) -> usize {
        self.unreadable
    }

    /// The outcome of a data set that an earlier run finished, with the same parameters, seed and program.
    pub(crate) fn finished(&self, data_set: &DataSet<'_>) -> Option<&Outcome> {
        self.finished.get(&self.key(data_set))
    }

    /// Writes a finished data set to the file at once.
    pub(crate) fn append(&self, data_set: &DataSet<'_>, outcome: &Outcome) -> anyhow::Result<()> {
        let record = Record {
            key: self.key(data_set),
            experiment: data_set.experiment.to_owned(),
            setup: data_set.setup.to_owned(),
            number: data_set.number,
            outcome: outcome.clone(),
        };
        let line = record.line()?;
        self.writing().write_all(&line).with_context(|| format!("cannot write to {}", self.path.display()))
    }

    /// Holds back every write while the guard lives, so that a process may end without tearing a line.
    pub(crate) fn writing(&self) -> MutexGuard<'_, File> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn key(&self, data_set: &DataSet<'_>) -> String {
        let mut hasher = DefaultHasher::new();
        self.code.hash(&mut hasher);
        data_set.seed.hash(&mut hasher);
        data_set.definition.hash(&mut hasher);
        let definition = hasher.finish();
        format!("{}/{}/{}/{definition:016x}", data_set.experiment, data_set.setup, data_set.number)
    }
}

/// What the lines of a file hold, and how many are torn or damaged.
fn read(bytes: &[u8]) -> (HashMap<String, Outcome>, usize) {
    let lines = bytes.split(|&byte| byte == b'\n').filter(|line| !line.is_empty());
    let records: Vec<Option<Record>> = lines.map(Record::read).collect();
    let unreadable = records.iter().filter(|record| record.is_none()).count();
    (records.into_iter().flatten().map(|record| (record.key, record.outcome)).collect(), unreadable)
}

/// Opens a file that no other run has open, and reads it; a last line that was torn is ended.
fn open(path: &Path, earlier: Earlier) -> anyhow::Result<(File, Vec<u8>)> {
    let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
    file.try_lock().context("another run is writing there")?;
    if earlier == Earlier::Forget {
        file.set_len(0)?;
    }
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.read_to_end(&mut bytes)?;
    if bytes.last().is_some_and(|&last| last != b'\n') {
        file.write_all(b"\n")?;
    }
    Ok((file, bytes))
}

/// A hash of the running program itself: whatever changes the program, be it a source line, a dependency or a compiler
/// flag, starts new records.
fn code_identity() -> anyhow::Result<u64> {
    let bytes = std::env::current_exe().and_then(std::fs::read).context("cannot read the running program")?;
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    Ok(hasher.finish())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use experiments::measure::Measure;

    use super::*;

    const DATA_SET: DataSet<'static> =
        DataSet { experiment: "table1", setup: "narrow", definition: "K = 40", seed: 1, number: 7 };

    fn measured(value: f64) -> Outcome {
        Outcome::Measured(vec![BTreeMap::from([(Measure::Nupe, value)])])
    }

    #[test]
    fn what_was_written_is_found_again_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        let outcome = measured(0.1 + 0.2);
        let records = Records::open(&path, Earlier::Resume).unwrap();
        assert_eq!(records.finished(&DATA_SET), None);
        records.append(&DATA_SET, &outcome).unwrap();
        drop(records);
        assert_eq!(Records::open(&path, Earlier::Resume).unwrap().finished(&DATA_SET), Some(&outcome));
    }

    #[test]
    fn another_seed_definition_setup_or_program_finds_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        Records::open(&path, Earlier::Resume).unwrap().append(&DATA_SET, &measured(1.0)).unwrap();
        let mut records = Records::open(&path, Earlier::Resume).unwrap();
        for other in [
            DataSet { seed: 2, ..DATA_SET },
            DataSet { definition: "K = 41", ..DATA_SET },
            DataSet { setup: "wide", ..DATA_SET },
            DataSet { experiment: "table1-literal", ..DATA_SET },
            DataSet { number: 8, ..DATA_SET },
        ] {
            assert_eq!(records.finished(&other), None, "{other:?}");
        }
        records.code ^= 1;
        assert_eq!(records.finished(&DATA_SET), None);
    }

    #[test]
    fn a_torn_last_line_costs_only_itself() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        let records = Records::open(&path, Earlier::Resume).unwrap();
        records.append(&DATA_SET, &measured(1.0)).unwrap();
        records.append(&DataSet { number: 8, ..DATA_SET }, &measured(2.0)).unwrap();
        drop(records);
        let length = std::fs::metadata(&path).unwrap().len();
        OpenOptions::new().write(true).open(&path).unwrap().set_len(length - 5).unwrap();

        let records = Records::open(&path, Earlier::Resume).unwrap();
        assert_eq!(records.finished(&DATA_SET), Some(&measured(1.0)));
        assert_eq!((records.finished(&DataSet { number: 8, ..DATA_SET }), records.unreadable()), (None, 1));
        records.append(&DataSet { number: 9, ..DATA_SET }, &measured(3.0)).unwrap();
        drop(records);
        let records = Records::open(&path, Earlier::Resume).unwrap();
        assert_eq!(records.finished(&DataSet { number: 9, ..DATA_SET }), Some(&measured(3.0)));
    }

    #[test]
    fn two_runs_cannot_write_to_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        let _first = Records::open(&path, Earlier::Resume).unwrap();
        let error = format!("{:#}", Records::open(&path, Earlier::Forget).unwrap_err());
        assert!(error.contains("another run") && error.contains("--out"), "{error}");
    }

    #[test]
    fn a_fresh_start_forgets() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        Records::open(&path, Earlier::Resume).unwrap().append(&DATA_SET, &measured(1.0)).unwrap();
        assert_eq!(Records::open(&path, Earlier::Forget).unwrap().finished(&DATA_SET), None);
        assert_eq!(Records::open(&path, Earlier::Resume).unwrap().finished(&DATA_SET), None);
    }
}
