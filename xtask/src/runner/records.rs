//! Records of finished data sets, saved one per line, so that an interruption loses only unfinished ones.

use std::collections::HashMap;
use std::fs::File;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::ErrorKind;
use std::path::Path;
use std::sync::MutexGuard;

use anyhow::Context as _;
use experiments::outcome::Outcome;
use journal::{Contents, Journal};
use serde::{Deserialize, Serialize};

use crate::failure::Failure;

/// The first line of the file.
pub(crate) const KIND: &str = "policy-align records 1";

/// Identifies one data set of one setup of an experiment.
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
    /// Index of the data set, from 0.
    pub(crate) number: u32,
}

/// The file of finished data sets, open for appending.
#[derive(Debug)]
pub(crate) struct Records {
    journal: Journal,
    code: u64,
    finished: HashMap<String, Outcome>,
    unreadable: usize,
}

/// The record of one data set of one setup.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    key: String,
    experiment: String,
    setup: String,
    number: u32,
    outcome: Outcome,
}

/// Whether the outcomes of earlier runs are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Earlier {
    /// Use the finished data sets.
    Resume,
    /// Discard them.
    Forget,
}

impl Records {
    /// Opens the records at `path`, or creates them. Lines that are invalid, such as the incomplete last line of a
    /// killed run, are skipped; their data sets are computed again.
    pub(crate) fn open(path: &Path, earlier: Earlier) -> anyhow::Result<Records> {
        let (journal, found) = Journal::open(path, KIND).map_err(|error| {
            let remedy = match error.kind() {
                ErrorKind::WouldBlock => "wait for the other run, or choose another --out",
                ErrorKind::AlreadyExists => "delete it if an older version wrote it, or choose another --out",
                _ => "choose an --out that can be written to",
            };
            Failure::new(format!("the records cannot be opened: {error}"), path.display().to_string(), remedy)
        })?;
        let mut records = Records { journal, code: code_identity()?, finished: HashMap::new(), unreadable: 0 };
        match earlier {
            Earlier::Resume => records.take(found),
            Earlier::Forget => records.clear()?,
        }
        Ok(records)
    }

    /// Adds the records of another file, which does not change.
    pub(crate) fn add(&mut self, path: &Path) -> anyhow::Result<()> {
        let found = journal::read(path, KIND).map_err(|error| {
            let remedy = "--merge with the folder of each shard, made by this version";
            Failure::new(format!("the records of a shard cannot be read: {error}"), path.display().to_string(), remedy)
        })?;
        self.take(found);
        Ok(())
    }

    fn take(&mut self, found: Contents<Record>) {
        self.finished.extend(found.records.into_iter().map(|record| (record.key, record.outcome)));
        self.unreadable += found.damaged;
    }

    /// Number of skipped lines.
    pub(crate) fn unreadable(&self) -> usize {
        self.unreadable
    }

    /// The outcome of a data set that an earlier run finished, with the same parameters, seed and program.
    pub(crate) fn finished(&self, data_set: &DataSet<'_>) -> Option<&Outcome> {
        self.finished.get(&self.key(data_set))
    }

    /// Immediately writes a finished data set to the file.
    pub(crate) fn append(&self, data_set: &DataSet<'_>, outcome: &Outcome) -> anyhow::Result<()> {
        let record = Record {
            key: self.key(data_set),
            experiment: data_set.experiment.to_owned(),
            setup: data_set.setup.to_owned(),
            number: data_set.number,
            outcome: outcome.clone(),
        };
        self.journal.append(&record).with_context(|| self.unwritten())
    }

    fn clear(&self) -> anyhow::Result<()> {
        self.journal.clear().with_context(|| self.unwritten())
    }

    fn unwritten(&self) -> String {
        format!("cannot write to {}", self.journal.path().display())
    }

    /// Blocks all writes while the guard exists, so that the process can exit without an incomplete line.
    pub(crate) fn writing(&self) -> MutexGuard<'_, File> {
        self.journal.writing()
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

/// A hash of the running program. Any change of the program, in a source line, a dependency or a compiler flag, starts
/// new records.
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
    fn records_are_read_back_bitwise() {
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
    fn two_runs_cannot_write_to_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("records.jsonl");
        let _first = Records::open(&path, Earlier::Resume).unwrap();
        let error = format!("{:#}", Records::open(&path, Earlier::Forget).unwrap_err());
        assert!(error.contains("another process") && error.contains("--out"), "{error}");
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
