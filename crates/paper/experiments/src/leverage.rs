//! How much hangs on what is fitted: printed cells whose verdict is another where one setting is a fifth smaller or larger.
//! `cargo xtask leverage` measures it.

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use crate::Setting;
use crate::measure::Measure;
use crate::verdict::Verdict;

/// The committed one.
const COMMITTED: &str = include_str!("../../../../docs/records/leverage.json");

/// What was measured, for every setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leverage {
    /// Seed of the data sets.
    pub seed: u64,
    /// How many there were of each row.
    pub data_sets: u32,
    /// Setting by setting, in the order of [`settings`](crate::settings).
    pub settings: Vec<Changed>,
}

/// What comes of it when one setting is changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Changed {
    /// The experiment's id.
    pub experiment: String,
    /// The setting's name.
    pub setting: String,
    /// Where it is a fifth smaller.
    pub smaller: Vec<Turned>,
    /// Where it is a fifth larger.
    pub larger: Vec<Turned>,
}

/// A cell that gets another verdict.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Turned {
    /// Its row.
    pub row: String,
    /// Its measure.
    pub measure: Measure,
    /// The verdict at the value that is used.
    pub was: Verdict,
    /// The verdict at the other value.
    pub is: Verdict,
}

impl Turned {
    /// "agrees → lower".
    pub fn change(&self) -> String {
        format!("{} → {}", self.was.word(), self.is.word())
    }

    /// "narrow nUPE: agrees → lower".
    pub fn named(&self) -> String {
        format!("{} {}: {}", self.row, self.measure.label(), self.change())
    }
}

impl Leverage {
    /// What texts and pages show.
    ///
    /// # Errors
    /// If it is damaged.
    pub fn committed() -> anyhow::Result<Leverage> {
        serde_json::from_str(COMMITTED).context("docs/records/leverage.json is damaged")
    }

    /// As the committed one is written.
    ///
    /// # Errors
    /// Never; serialising these types cannot fail.
    pub fn json(&self) -> anyhow::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// What was measured of a setting.
    pub fn of(&self, setting: &Setting) -> Option<&Changed> {
        let is_meant = |changed: &&Changed| changed.experiment == setting.experiment && changed.setting == setting.name;
        self.settings.iter().find(is_meant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry, settings};

    /// A setting that was renamed or added has to be measured; cells are those that are printed.
    #[test]
    fn every_setting_was_measured() {
        let committed = Leverage::committed().unwrap();
        let names: Vec<_> = committed.settings.iter().map(|c| (c.experiment.as_str(), c.setting.as_str())).collect();
        let expected: Vec<_> = settings().iter().map(|setting| (setting.experiment, setting.name)).collect();
        assert_eq!(names, expected);
        let experiments = registry().unwrap();
        for changed in &committed.settings {
            let experiment = experiments.iter().find(|experiment| experiment.id == changed.experiment).unwrap();
            for turned in changed.smaller.iter().chain(&changed.larger) {
                assert!(
                    experiment.paper(&turned.row, turned.measure).is_some() && turned.was != turned.is,
                    "{turned:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let committed = Leverage::committed().unwrap();
        assert_eq!(committed.json().unwrap(), COMMITTED);
    }
}
