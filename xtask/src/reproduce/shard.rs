//! A run distributed over machines: `--shard I/N` measures one share of its data sets, `--merge` joins all shares into one run.
//!
//! Data sets are assigned in turn, so that every share has an equal part of each row. The result of a data set does not depend on
//! the machine: the merged run equals a single run to the last bit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::files::{relative, repository, typed, write};
use crate::progress::say;
use crate::run_folder::RunFolder;
use crate::runner::Work;
use crate::runner::records::Records;

/// The file that a shard writes beside its records.
const FILE: &str = "shard.json";

/// Number of missing data sets that are named.
const NAMED: usize = 3;

/// One of several shares of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "BTreeMap<String, u32>")]
pub(super) struct Shard {
    /// Index of the share, from 1.
    index: u32,
    /// Number of shares.
    of: u32,
}

/// Parses the contents of a shard's file.
impl TryFrom<BTreeMap<String, u32>> for Shard {
    type Error = String;

    fn try_from(members: BTreeMap<String, u32>) -> Result<Shard, String> {
        let [index, of] = ["index", "of"].map(|name| members.get(name).copied());
        match (index, of) {
            (Some(index), Some(of)) if (1..=of).contains(&index) && members.len() == 2 => Ok(Shard { index, of }),
            (Some(index), Some(of)) if members.len() == 2 => Err(format!("there is no share {index} of {of}")),
            _ => Err("it needs `index` and `of`, and nothing else".to_owned()),
        }
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let numbers = text.split_once('/').and_then(|(index, of)| Some((index.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((index, of)) if (1..=of).contains(&index) => Ok(Shard { index, of }),
            _ => Err("a share and their number, such as 2/8".to_owned()),
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl Shard {
    /// The default folder of its records.
    pub(super) fn folder(self) -> Result<PathBuf, Failure> {
        Ok(repository()?.join(format!("target/shards/{}-of-{}", self.index, self.of)))
    }

    /// Whether the data set with index `place` belongs to its share.
    fn has(self, place: usize) -> bool {
        place % self.of as usize == self.index as usize - 1
    }

    /// Measures its share, and explains how to continue.
    pub(super) fn measure(self, work: &mut Work<'_>, records: &Arc<Records>, folder: &RunFolder) -> anyhow::Result<()> {
        write(&folder.join(FILE), serde_json::to_string(&self)?)?;
        work.measure(|place| self.has(place), records)?;
        let share = (0..work.total()).filter(|&place| self.has(place)).count();
        say(&format!(
            "shard {self}: {share} of {} data sets, in {}",
            work.total(),
            relative(&folder.join("records.jsonl"))
        ));
        say("when all shards are done: the same command with --merge and their folders instead of --shard");
        Ok(())
    }

    /// The share in a folder.
    fn read(folder: &Path) -> anyhow::Result<Shard> {
        let path = folder.join(FILE);
        let name = relative(&path);
        let refused = |what: String| Failure::new(what, name.clone(), "--merge with the folders of --shard runs");
        let text = std::fs::read_to_string(&path).map_err(|error| refused(format!("not a shard: {error}")))?;
        Ok(serde_json::from_str(&text).map_err(|error| refused(format!("damaged: {error}")))?)
    }
}

/// Fails unless the shards in these folders have measured everything; names the incomplete ones.
pub(super) fn merged(work: &mut Work<'_>, folders: &[PathBuf]) -> anyhow::Result<()> {
    let shards: Vec<Shard> = folders.iter().map(|folder| Shard::read(folder)).collect::<anyhow::Result<_>>()?;
    let of = shards.first().map_or(1, |shard| shard.of);
    for (shard, folder) in shards.iter().zip(folders) {
        if shard.of != of {
            let what = format!("shard {shard} is of another run: the first is one of {of}");
            return Err(Failure::new(what, relative(folder), "--merge with the shards of one run").into());
        }
    }
    let missing = work.missing();
    let Some((first, _)) = missing.first() else { return Ok(()) };
    let shard_of = |place: usize| Shard { index: (place % of as usize) as u32 + 1, of };
    let mut lacking: Vec<Shard> = missing.iter().map(|(place, _)| shard_of(*place)).collect();
    lacking.sort();
    lacking.dedup();
    let about = |shard: &Shard| match folders.iter().zip(&shards).find(|(_, other)| *other == shard) {
        Some((folder, _)) => {
            format!("shard {shard} in {} is unfinished, damaged, or of another program", typed(folder))
        }
        None => format!("shard {shard} is not among the folders"),
    };
    let names: Vec<&str> = missing.iter().take(NAMED).map(|(_, name)| name.as_str()).collect();
    let more = if missing.len() > NAMED { "; .." } else { "" };
    let what = format!("{} of {} data sets are missing ({}{more})", missing.len(), work.total(), names.join("; "));
    let place = lacking.iter().map(about).collect::<Vec<_>>().join("; ");
    let remedy = format!("`cargo xtask reproduce --shard {}` with the same options", shard_of(*first));
    Err(Failure::new(what, place, remedy).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_data_set_has_one_shard() {
        for of in 1..9 {
            let shards: Vec<Shard> = (1..=of).map(|index| format!("{index}/{of}").parse().unwrap()).collect();
            for place in 0..100 {
                assert_eq!(shards.iter().filter(|shard| shard.has(place)).count(), 1, "{place} of {of}");
            }
        }
    }

    #[test]
    fn invalid_shard_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let read = |text: &str| {
            std::fs::write(folder.path().join(FILE), text).unwrap();
            Shard::read(folder.path())
        };
        for (text, expected) in [
            (r#"{"index":1,"of":0}"#, "there is no share 1 of 0"),
            (r#"{"index":9,"of":2}"#, "there is no share 9 of 2"),
            (r#"{"index":0,"of":2}"#, "there is no share 0 of 2"),
            ("[1,2]", "invalid type"),
            (r#"{"index":1}"#, "it needs `index` and `of`"),
            (r#"{"index":1,"of":2,"at":3}"#, "it needs `index` and `of`, and nothing else"),
            (r#"{"index":-1,"of":2}"#, "damaged"),
        ] {
            let said = read(text).unwrap_err().to_string();
            assert!(said.contains(expected) && said.contains(FILE) && said.contains("--shard"), "{said}");
        }
        let shard = Shard { index: 2, of: 3 };
        assert_eq!(read(&serde_json::to_string(&shard).unwrap()).unwrap(), shard);
    }

    #[test]
    fn invalid_shares_are_refused() {
        for text in ["", "3", "0/3", "4/3", "1/0", "a/b", "-1/2", "1/2/3", "1.0/2"] {
            assert!(text.parse::<Shard>().unwrap_err().contains("2/8"), "{text}");
        }
    }
}
