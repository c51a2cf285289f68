//! Sensitivity to the fitted settings: printed cells whose verdict changes if one setting is a fifth smaller or larger.
//! Measured by `cargo xtask leverage`.

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use crate::Setting;
use crate::measure::Measure;
use crate::verdict::Verdict;

/// The committed file.
const COMMITTED: &str = include_str!("../../../../docs/records/leverage.json");

/// Measured changes of verdicts, for every setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leverage {
    /// Seed of the data sets.
    pub seed: u64,
    /// Number of data sets of each row.
    pub data_sets: u32,
    /// One entry per setting, in the order of [`settings`](crate::settings).
    pub settings: Vec<Changed>,
}

/// Effect of changing one setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Changed {
    /// The experiment's id.
    pub experiment: String,
    /// The setting's name.
    pub setting: String,
    /// Cells with another verdict if the setting is a fifth smaller.
    pub smaller: Vec<Turned>,
    /// Cells with another verdict if the setting is a fifth larger.
    pub larger: Vec<Turned>,
}

/// A cell with another verdict.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Turned {
    /// The id of its row.
    pub row: String,
    /// Its measure.
    pub measure: Measure,
    /// The verdict at the value in use.
    pub was: Verdict,
    /// The verdict at the changed value.
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
    /// The committed measurements, which texts and pages show.
    ///
    /// # Errors
    /// If the file is damaged.
    pub fn committed() -> anyhow::Result<Leverage> {
        serde_json::from_str(COMMITTED).context("docs/records/leverage.json is damaged")
    }

    /// Formats the measurements like the committed file.
    ///
    /// # Errors
    /// Never; serialising these types cannot fail.
    pub fn json(&self) -> anyhow::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// The effect of changing a setting.
    pub fn of(&self, setting: &Setting) -> Option<&Changed> {
        let is_meant = |changed: &&Changed| changed.experiment == setting.experiment && changed.setting == setting.name;
        self.settings.iter().find(is_meant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry, settings};

    /// The committed file covers every setting, including new and renamed ones, and names only printed cells.
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
    fn committed_leverage_round_trips() {
        let committed = Leverage::committed().unwrap();
        assert_eq!(committed.json().unwrap(), COMMITTED);
    }
}
