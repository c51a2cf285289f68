//! Unusual robot descriptions, each with the expected result: it loads or is refused.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::Context as _;
use kinematics::RobotModel;
use serde::Deserialize;

use super::read_json;

#[derive(Debug, Deserialize)]
struct Expected {
    loads: bool,
}

/// Number of files, and their faults.
#[derive(Debug, Default)]
pub(super) struct Odd {
    pub(super) files: usize,
    pub(super) faults: Vec<String>,
}

/// Loads every file in `list`; returns none if the list does not exist.
pub(super) fn check(list: &Path) -> anyhow::Result<Odd> {
    if !list.is_file() {
        return Ok(Odd::default());
    }
    let expected: BTreeMap<String, Expected> = read_json(list)?;
    let mut faults = Vec::new();
    for (file, expected) in &expected {
        let path = list.with_file_name(file);
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        match (RobotModel::from_urdf(&text), expected.loads) {
            (Ok(_), false) => faults.push(format!("{}: loads, but should be refused", path.display())),
            (Err(error), true) => faults.push(format!("{}: should load: {error}", path.display())),
            _ => {}
        }
    }
    Ok(Odd { files: expected.len(), faults })
}
