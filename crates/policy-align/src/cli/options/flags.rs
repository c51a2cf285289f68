//! Flags that several commands share. Each group is a table of a configuration file, with the same names.

use align::Bandwidth;
use clap::Args;
use demo_io::ReadOptions;
use gp::Hypothesis;
use policy_align::{FitOptions, LearnerChoice, PrepareOptions, Repair, Smoothing, VelocityUse};
use serde::{Deserialize, Serialize};

use crate::cli::failure::Failure;

/// Flags of reading that `check --help` lists, and the help of other commands does not.
pub(crate) const RARE: [&str; 15] = [
    "constraint-column",
    "units",
    "degrees",
    "unwrap",
    "nan",
    "sort",
    "split-gap",
    "trim-still",
    "filter",
    "samples-are",
    "separator",
    "decimal",
    "topic",
    "as",
    "trust",
];

/// How files are read: table `[read]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Reading files")]
pub(crate) struct ReadFlags {
    /// State channels: names, globs or ranges, as 'q*' or 2-8
    #[arg(long, value_name = "PATTERNS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) state: Vec<String>,
    /// Velocity columns, in the order of the state
    #[arg(long, value_name = "PATTERNS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) velocity: Vec<String>,
    /// Time column
    #[arg(long, value_name = "COLUMN")]
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<String>,
    /// Episode column
    #[arg(long, value_name = "COLUMN")]
    #[serde(skip_serializing_if = "Option::is_none")]
    episode: Option<String>,
    /// Column of constraint labels
    #[arg(long, value_name = "COLUMN")]
    #[serde(skip_serializing_if = "Option::is_none")]
    constraint_column: Option<String>,
    /// Columns to ignore
    #[arg(long, value_name = "PATTERNS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ignore: Vec<String>,
    /// Seconds between samples, instead of stamps
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) dt: Option<f64>,
    /// Unit names, as m or x=m; no number changes
    #[arg(long, value_name = "UNITS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    units: Vec<String>,
    /// Channels in degrees, converted to radians
    #[arg(long, value_name = "PATTERNS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    degrees: Vec<String>,
    /// Angles to unwrap
    #[arg(long, value_name = "PATTERNS")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unwrap: Vec<String>,
    /// Samples that are not finite: refuse, drop or fill [default: refuse]
    #[arg(long, value_name = "ACTION", hide_possible_values = true, value_parser = ["refuse", "drop", "fill"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    nan: Option<String>,
    /// Sort samples by their stamps
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    sort: bool,
    /// Split episodes at longer gaps between stamps
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    split_gap: Option<f64>,
    /// Remove samples at rest at either end
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(crate) trim_still: bool,
    /// A named subset of episodes (robomimic)
    #[arg(long, value_name = "NAME")]
    #[serde(skip_serializing_if = "Option::is_none")]
    filter: Option<String>,
    /// Orientation of arrays: samples are rows or columns
    #[arg(long, value_name = "ORIENTATION", hide_possible_values = true, value_parser = ["rows", "columns"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    samples_are: Option<String>,
    /// Field separator of text files
    #[arg(long, value_name = "CHARACTER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    separator: Option<char>,
    /// Decimal point of text files
    #[arg(long, value_name = "CHARACTER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    decimal: Option<char>,
    /// Topic of a bag
    #[arg(long, value_name = "NAME")]
    #[serde(skip_serializing_if = "Option::is_none")]
    topic: Option<String>,
    /// Format: csv, tsv, npy, npz, jsonl, lerobot, parquet, hdf5, mcap or mat
    #[arg(long = "as", value_name = "FORMAT", hide_possible_values = true, value_parser = [
        "csv", "tsv", "npy", "npz", "jsonl", "lerobot", "parquet", "hdf5", "mcap", "mat",
    ])]
    #[serde(rename = "as", skip_serializing_if = "Option::is_none")]
    format: Option<String>,
    /// Allow more than 64-fold compression
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    trust: bool,
}

/// How recordings are prepared: table `[prepare]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Preparing")]
pub(crate) struct PrepareFlags {
    /// Scale a channel, as z=10
    #[arg(long, value_name = "NAME=FACTOR", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    scale: Vec<String>,
    /// Velocities: auto, velocity (recorded) or displacement (from positions)
    #[arg(long, value_name = "SOURCE", hide_possible_values = true, value_parser = ["auto", "velocity", "displacement"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    integration: Option<String>,
    /// Smoothing: auto, off, or a window in samples (9) or seconds (0.2s)
    #[arg(long, value_name = "WINDOW")]
    #[serde(skip_serializing_if = "Option::is_none")]
    smooth: Option<String>,
    /// Jumps: auto (split episodes there) or keep
    #[arg(long, value_name = "REPAIR", hide_possible_values = true, value_parser = ["auto", "keep"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    jumps: Option<String>,
    /// Angles that jump by a whole turn: auto (unwrap) or keep
    #[arg(long, value_name = "REPAIR", hide_possible_values = true, value_parser = ["auto", "keep"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    wraps: Option<String>,
}

/// How a policy is learnt: table `[fit]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Learning")]
pub(crate) struct FitFlags {
    /// Learner: auto, policy-align, slope or direct [default: auto]
    #[arg(long, value_name = "LEARNER", hide_possible_values = true, value_parser = ["auto", "policy-align", "slope", "direct"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    learner: Option<String>,
    /// Reading of the movements, if known: free or constrained
    #[arg(long, value_name = "READING", hide_possible_values = true, value_parser = ["free", "constrained"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    reading: Option<String>,
    /// For policy-align: auto, narrow, medium, wide or σ² [default: auto]
    #[arg(long, value_name = "BANDWIDTH")]
    #[serde(skip_serializing_if = "Option::is_none")]
    bandwidth: Option<String>,
    /// For policy-align: auto or 1 / squared width of fields [default: auto]
    #[arg(long, value_name = "NUMBER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    init_d: Option<String>,
    /// Folds of cross-validation [default: 5]
    #[arg(long, value_name = "NUMBER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    folds: Option<usize>,
    /// Random seed [default: 1]
    #[arg(long, value_name = "NUMBER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    /// Most samples that a Gaussian process learns from [default: 400]
    #[arg(long, value_name = "NUMBER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    max_rows: Option<usize>,
    /// Episodes to evaluate on instead of learning from them
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) hold_out: Vec<String>,
}

impl ReadFlags {
    /// Flags have the names of the options, and of a configuration file.
    pub(crate) fn options(&self) -> Result<ReadOptions, Failure> {
        let wrong = |error: &dyn std::fmt::Display| Failure::usage(error.to_string(), "flags for reading", "--help");
        let mut table = toml::Table::try_from(self).map_err(|error| wrong(&error))?;
        // What was read is trimmed afterwards.
        table.remove("trim_still");
        table.try_into().map_err(|error: toml::de::Error| wrong(&error.message()))
    }
}

impl PrepareFlags {
    pub(crate) fn options(&self, dt: Option<f64>) -> Result<PrepareOptions, Failure> {
        let scale = self.scale.iter().map(|text| {
            let pair = text.split_once('=').and_then(|(name, factor)| Some((name.to_owned(), factor.parse().ok()?)));
            pair.ok_or_else(|| Failure::usage(format!("'{text}' is not NAME=FACTOR"), "--scale", "--scale z=10"))
        });
        let velocities = match self.integration.as_deref() {
            Some("velocity") => VelocityUse::Recorded,
            Some("displacement") => VelocityUse::Ignored,
            _ => VelocityUse::Auto,
        };
        let smoothing = self.smooth.as_deref().map_or(Ok(Smoothing::Auto), smoothing)?;
        let repair = |flag: &Option<String>| match flag.as_deref() {
            Some("keep") => Repair::Keep,
            _ => Repair::Auto,
        };
        Ok(PrepareOptions {
            scale: scale.collect::<Result<_, _>>()?,
            time_step: dt,
            velocities,
            smoothing,
            jumps: repair(&self.jumps),
            wraps: repair(&self.wraps),
        })
    }
}

impl FitFlags {
    pub(crate) fn options(&self) -> Result<FitOptions, Failure> {
        let default = FitOptions::default();
        let bandwidth = match self.bandwidth.as_deref() {
            None | Some("auto") => None,
            Some("narrow") => Some(Bandwidth::Narrow),
            Some("medium") => Some(Bandwidth::Medium),
            Some("wide") => Some(Bandwidth::Wide),
            Some(text) => Some(Bandwidth::Fixed(number(text, "--bandwidth")?)),
        };
        let init_d = match self.init_d.as_deref() {
            None | Some("auto") => None,
            Some(text) => Some(number(text, "--init-d")?),
        };
        Ok(FitOptions {
            learner: match self.learner.as_deref() {
                Some("policy-align") => LearnerChoice::PolicyAlign,
                Some("slope") => LearnerChoice::Slope,
                Some("direct") => LearnerChoice::Direct,
                _ => LearnerChoice::Auto,
            },
            reading: match self.reading.as_deref() {
                Some("free") => Some(Hypothesis::Free),
                Some("constrained") => Some(Hypothesis::Constrained),
                _ => None,
            },
            bandwidth,
            init_d,
            folds: self.folds.unwrap_or(default.folds),
            seed: self.seed.unwrap_or(default.seed),
            max_rows: self.max_rows.unwrap_or(default.max_rows),
        })
    }
}

fn smoothing(text: &str) -> Result<Smoothing, Failure> {
    text.parse().map_err(|what: String| Failure::usage(what, "--smooth", "--smooth auto, off, 9 (samples) or 0.2s"))
}

fn number(text: &str, flag: &str) -> Result<f64, Failure> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| Failure::usage(format!("'{text}' is not a positive number"), flag, format!("{flag} auto")))
}

/// Numbers with commas between, as a state is given.
pub(crate) fn numbers(text: &str, flag: &str) -> Result<Vec<f64>, Failure> {
    let numbers = text.split(',').map(|number| number.trim().parse());
    let numbers: Result<Vec<f64>, _> = numbers.collect();
    numbers.map_err(|_| {
        Failure::usage(
            format!("'{text}' is not a list of numbers, separated by commas"),
            flag,
            format!("{flag} 0.3,1.2"),
        )
    })
}
