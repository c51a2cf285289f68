//! The results of a run, as written to `results.json`.

use std::collections::BTreeMap;

use anyhow::{Context as _, anyhow, bail, ensure};
use serde::{Deserialize, Serialize, Serializer, ser::Error as _};
use serde_json::Value;

use crate::Experiment;
use crate::measure::Measure;
use crate::paper::Printed;
use crate::verdict::Verdict;

/// Version of the format of `results.json`.
pub const SCHEMA: u32 = 3;

/// The oldest format that can still be read; it does not identify the program.
const OLDEST_SCHEMA: u32 = 2;

/// The whole file. Everything except `run` is identical to the bit for the same seed and program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Whether the run was restricted to a few data sets per row.
    pub quick: bool,
    /// Properties that differ between repetitions of the same run.
    pub run: Run,
    /// Tables and figures.
    pub experiments: Vec<ExperimentResult>,
}

impl Results {
    /// Reads the text of a `results.json`; error messages call it `name`.
    ///
    /// # Errors
    /// If it is damaged or has an unsupported format.
    pub fn read(name: &str, text: &str) -> anyhow::Result<Results> {
        let value: Value = serde_json::from_str(text).map_err(|error| anyhow!("{name} is damaged ({error})"))?;
        let schema = value["schema"].as_u64().with_context(|| format!("{name} is not a results.json"))?;
        ensure!(
            (u64::from(OLDEST_SCHEMA)..=u64::from(SCHEMA)).contains(&schema),
            "{name} is of form {schema}, which this version does not read (but forms {OLDEST_SCHEMA} to {SCHEMA})"
        );
        let results: Results = serde_json::from_value(value).map_err(|error| anyhow!("{name} is damaged ({error})"))?;
        if let Some(text) = results.texts().into_iter().find(|text| !is_plain(text)) {
            bail!("{name} is damaged ({text:?} is neither a name of a row or experiment nor a command of a run)");
        }
        Ok(results)
    }

    /// Texts that are shown to readers unchanged.
    fn texts(&self) -> Vec<&str> {
        let mut texts = vec![self.run.command.as_str()];
        for result in &self.experiments {
            texts.extend([result.id.as_str(), &result.section]);
            texts.extend(result.rows.iter().map(|row| row.id.as_str()));
        }
        texts
    }

    /// The results of one experiment, if it was run.
    pub fn experiment(&self, id: &str) -> Option<&ExperimentResult> {
        self.experiments.iter().find(|result| result.id == id)
    }

    /// The experiments of the run, each with its results.
    pub fn of<'a>(
        &'a self,
        experiments: &'a [Experiment],
    ) -> impl Iterator<Item = (&'a Experiment, &'a ExperimentResult)> {
        experiments.iter().filter_map(|experiment| Some((experiment, self.experiment(experiment.id)?)))
    }

    /// Fails if there are results of other experiments than these.
    ///
    /// # Errors
    /// Names the unknown experiment.
    pub fn check_known(&self, experiments: &[Experiment]) -> anyhow::Result<()> {
        let known = |id: &str| experiments.iter().any(|experiment| experiment.id == id);
        match self.experiments.iter().find(|result| !known(&result.id)) {
            Some(result) => bail!("there is no experiment {:?}, but the run has results of it", result.id),
            None => Ok(()),
        }
    }

    /// Formats the results for `results.json`.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn json(&self) -> anyhow::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

/// Whether a text has no special meaning in a shell, in Markdown or in a terminal.
fn is_plain(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_alphanumeric() || " ._,/-".contains(c))
}

/// Writes hundreds of numbers on one line, because only programs read them.
fn on_one_line<S: Serializer>(values: &Vec<Option<f64>>, serializer: S) -> Result<S::Ok, S::Error> {
    serde_json::value::to_raw_value(values).map_err(S::Error::custom)?.serialize(serializer)
}

/// Circumstances of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The command that repeats the run.
    pub command: String,
    /// Worker threads.
    pub threads: usize,
    /// Number of data sets from earlier calls of the command; the times do not include them.
    pub resumed: usize,
    /// Elapsed seconds.
    pub wall_seconds: f64,
    /// Processor seconds of all threads.
    pub cpu_seconds: f64,
    /// Version of the program.
    pub version: String,
    /// The commit it was built from, with `-dirty` if files were changed; `None` outside a checkout.
    #[serde(default)]
    pub revision: Option<String>,
    /// The compiler.
    #[serde(default)]
    pub rustc: String,
    /// The compilation target.
    #[serde(default)]
    pub target: String,
}

impl Run {
    /// "one thread", "2 threads".
    pub fn threads_in_words(&self) -> String {
        if self.threads == 1 { "one thread".to_owned() } else { format!("{} threads", self.threads) }
    }
}

/// One table or figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExperimentResult {
    /// Identifier.
    pub id: String,
    /// Section of the paper.
    pub section: String,
    /// Rows, in the table's order.
    pub rows: Vec<RowResult>,
}

/// One row of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RowResult {
    /// Identifier.
    pub id: String,
    /// Description of the test samples.
    #[serde(default)]
    pub tested_on: String,
    /// Number of data sets requested.
    pub data_sets: usize,
    /// Number of data sets that failed; the measures do not include them.
    pub failed: usize,
    /// Summaries over the other data sets, for the measures that have values.
    pub measures: BTreeMap<Measure, Cell>,
}

/// One number: ours, the paper's, and their comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Mean over data sets.
    pub mean: f64,
    /// Sample standard deviation over data sets; null for a single data set.
    pub sd: Option<f64>,
    /// Median over data sets.
    pub median: f64,
    /// The value of each data set, in order; null if it failed or has no value.
    #[serde(serialize_with = "on_one_line")]
    pub values: Vec<Option<f64>>,
    /// The printed number, if there is one.
    pub paper: Option<Printed>,
    /// The comparison, if there is a printed number.
    pub verdict: Option<Verdict>,
}

impl Cell {
    /// Number of data sets with a value.
    pub fn n(&self) -> usize {
        self.values.iter().flatten().count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names from a file are inserted into Markdown, a page and the hint of a command.
    #[test]
    fn hostile_row_names_are_refused() {
        let file = |row: &str| {
            let results = serde_json::json!({
                "schema": SCHEMA, "seed": 1, "quick": false,
                "run": { "command": "cargo xtask reproduce", "threads": 1, "resumed": 0, "wall_seconds": 1.0,
                         "cpu_seconds": 1.0, "version": "0.1.0" },
                "experiments": [{ "id": "table1", "section": "4.1", "rows": [
                    { "id": row, "tested_on": "held-out samples", "data_sets": 1, "failed": 0, "measures": {} }
                ] }],
            });
            Results::read("results.json", &results.to_string())
        };
        assert_eq!(file("parabola-40x40-narrow").unwrap().experiments.len(), 1);
        for row in ["|a|b|", "<script>alert(1)</script>", "$(rm -rf .)", "a\nb", "\u{1b}[2J", "`id`"] {
            let error = file(row).unwrap_err().to_string();
            assert!(error.contains("is damaged") && error.contains("neither a name of a row"), "{row:?}: {error}");
        }
    }
}
