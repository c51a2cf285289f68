//! Flags that several commands share. Each group is a table of a configuration file, with the same names.

use std::collections::HashSet;
use std::path::PathBuf;

use align::Bandwidth;
use clap::builder::PossibleValuesParser;
use clap::{Arg, Args, Command, Id};
use demo_io::{ReadOptions, TimeUnit};
use gp::Hypothesis;
use policy_align::{
    Choice, ContextUse, FitOptions, LearnerChoice, Model, PrepareOptions, Repair, Smoothing, VelocityUse,
};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::cli::failure::Failure;
use crate::cli::options::values::urdf;

/// The parser for the words of a choice.
fn words<C: Choice>() -> PossibleValuesParser {
    PossibleValuesParser::new(C::WORDS.iter().map(|(word, _)| *word))
}

/// Flags for reading that every command's help lists; `check --help` also lists the others.
const USUAL: [&str; 7] = ["state", "velocity", "context", "time", "episode", "ignore", "dt"];

/// Flags for reading that only `check --help` lists.
pub(crate) fn rare() -> HashSet<Id> {
    let reading = ReadFlags::augment_args(Command::new("read"));
    let is_rare = |flag: &&Arg| flag.get_long().is_some_and(|long| !USUAL.contains(&long));
    reading.get_arguments().filter(is_rare).map(|flag| flag.get_id().clone()).collect()
}

/// The word for movements that depend on the state alone.
const NO_CONTEXT: &str = "none";

/// How files are read: table `[read]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Reading files")]
pub(crate) struct ReadFlags {
    /// State channels: names, globs or ranges, as 'q*' or 2-8
    #[arg(long, value_name = "PATTERNS")]
    pub(crate) state: Vec<String>,
    /// Velocity columns, in the order of the state
    #[arg(long, value_name = "PATTERNS")]
    pub(crate) velocity: Vec<String>,
    /// Constant in an episode, e.g. a goal; or none [default: by name]
    #[arg(long, value_name = "PATTERNS")]
    pub(crate) context: Vec<String>,
    /// Time column
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// Unit of stamps that are numbers: s, ms, us or ns [default: found]
    #[arg(long, value_name = "UNIT", hide_possible_values = true, value_parser = TimeUnit::ALL.map(TimeUnit::symbol))]
    time_unit: Option<String>,
    /// Episode column
    #[arg(long, value_name = "COLUMN")]
    episode: Option<String>,
    /// Column that names constraints, which switch where it changes
    #[arg(long, value_name = "COLUMN")]
    constraint_column: Option<String>,
    /// Columns to ignore
    #[arg(long, value_name = "PATTERNS")]
    ignore: Vec<String>,
    /// Seconds between samples, instead of stamps
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(crate) dt: Option<f64>,
    /// Unit names, as m or x=m; no number changes
    #[arg(long, value_name = "UNITS")]
    units: Vec<String>,
    /// Channels in degrees, converted to radians
    #[arg(long, value_name = "PATTERNS")]
    degrees: Vec<String>,
    /// Angles to unwrap in what is read, also by `convert`
    #[arg(long, value_name = "PATTERNS")]
    unwrap: Vec<String>,
    /// Samples that are not finite: refuse, drop or fill [default: refuse]
    #[arg(long, value_name = "ACTION", hide_possible_values = true, value_parser = ["refuse", "drop", "fill"])]
    nan: Option<String>,
    /// Sort samples by their stamps
    #[arg(long)]
    sort: bool,
    /// Split episodes at longer gaps, and where stamps go back
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    split_gap: Option<f64>,
    /// Remove samples at rest at either end
    #[arg(long)]
    pub(crate) trim_still: bool,
    /// A named subset of episodes (robomimic)
    #[arg(long, value_name = "NAME")]
    filter: Option<String>,
    /// Orientation of arrays: samples are rows or columns
    #[arg(long, value_name = "ORIENTATION", hide_possible_values = true, value_parser = ["rows", "columns"])]
    samples_are: Option<String>,
    /// Field separator of text files
    #[arg(long, value_name = "CHARACTER")]
    separator: Option<char>,
    /// Decimal point of text files
    #[arg(long, value_name = "CHARACTER")]
    decimal: Option<char>,
    /// Topic of a bag
    #[arg(long, value_name = "NAME")]
    topic: Option<String>,
    /// Format: csv, tsv, npy, npz, jsonl, lerobot, parquet, hdf5, mcap or mat
    #[arg(long = "as", value_name = "FORMAT", hide_possible_values = true, value_parser = [
        "csv", "tsv", "npy", "npz", "jsonl", "lerobot", "parquet", "hdf5", "mcap", "mat",
    ])]
    #[serde(rename = "as")]
    format: Option<String>,
    /// Allow more than 64-fold compression
    #[arg(long)]
    trust: bool,
    /// Patterns of what the command reads besides: not reported as unused.
    #[arg(skip)]
    #[serde(skip)]
    pub(crate) elsewhere: Vec<String>,
}

/// How recordings are prepared: table `[prepare]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Preparing")]
pub(crate) struct PrepareFlags {
    /// Scale a channel, as z=10
    #[arg(long, value_name = "NAME=FACTOR", value_delimiter = ',')]
    pub(crate) scale: Vec<String>,
    /// Velocities: auto, velocity (recorded) or displacement (from positions)
    #[arg(long, value_name = "SOURCE", hide_possible_values = true, value_parser = words::<VelocityUse>())]
    integration: Option<String>,
    /// Smoothing: auto, off, or a window in samples (9) or seconds (0.2s)
    #[arg(long, value_name = "WINDOW")]
    smooth: Option<String>,
    /// Jumps: auto (interpolate single samples, else split) or keep
    #[arg(long, value_name = "REPAIR", hide_possible_values = true, value_parser = words::<Repair>())]
    jumps: Option<String>,
    /// Wraps and signs of quaternions found: auto (undo them) or keep
    #[arg(long, value_name = "REPAIR", hide_possible_values = true, value_parser = words::<Repair>())]
    wraps: Option<String>,
}

/// How a policy is learnt: table `[fit]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Learning")]
pub(crate) struct FitFlags {
    /// Learner: auto, policy-align, slope or direct [default: auto]
    #[arg(long, value_name = "LEARNER", hide_possible_values = true, value_parser = words::<LearnerChoice>())]
    learner: Option<String>,
    /// For auto: reading of the movements, if known: free or constrained
    #[arg(long, value_name = "READING", hide_possible_values = true, value_parser = words::<Hypothesis>())]
    reading: Option<String>,
    /// For policy-align: auto, narrow, medium, wide or σ² [default: auto]
    #[arg(long, value_name = "BANDWIDTH")]
    bandwidth: Option<String>,
    /// For policy-align: auto or 1 / squared width of fields [default: auto]
    #[arg(long, value_name = "NUMBER")]
    init_d: Option<String>,
    /// For policy-align: folds of cross-validation [default: 5]
    #[arg(long, value_name = "NUMBER")]
    folds: Option<usize>,
    /// Random seed [default: 1]
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Samples on which Gaussian processes are selected [default: 400]
    #[arg(long, value_name = "NUMBER")]
    max_rows: Option<usize>,
    /// Samples that represent all; 0 drops the others [default: 500]
    #[arg(long, value_name = "NUMBER")]
    inducing: Option<usize>,
    /// Robot with these joints: tries its links and its inertia
    #[arg(long, value_name = "FILE.urdf")]
    robot: Option<PathBuf>,
    /// Size of files and pieces held together, as 2GB or all [default: 256MB]
    #[arg(long, value_name = "SIZE")]
    pub(crate) at_once: Option<String>,
    /// Episodes to evaluate on, not to learn from: names, or a share as 20%
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) hold_out: Vec<String>,
}

/// The flags that are set, by their keys in a configuration file: lists with entries, and switches that are on.
pub(crate) fn given(flags: &impl Serialize) -> Result<Table, toml::ser::Error> {
    let mut table = Table::try_from(flags)?;
    table.retain(|_, value| match value {
        Value::Array(entries) => !entries.is_empty(),
        Value::Boolean(on) => *on,
        _ => true,
    });
    Ok(table)
}

impl ReadFlags {
    /// Uses the channels of a model unless others are given.
    pub(crate) fn with_channels_of(mut self, model: &Model) -> Self {
        if self.state.is_empty() {
            self.state = model.channels();
        }
        if self.context.is_empty() {
            self.context = model.context_names();
        }
        self
    }

    /// How the context channels that were read are used.
    pub(crate) fn context_use(&self, named: Vec<String>) -> ContextUse {
        match &self.context[..] {
            [] => ContextUse::Auto,
            [word] if word == NO_CONTEXT => ContextUse::Ignored,
            _ => ContextUse::Named(named),
        }
    }

    /// The flags have the names of the options and of the configuration file's keys.
    pub(crate) fn options(&self) -> Result<ReadOptions, Failure> {
        let wrong = |error: &dyn std::fmt::Display| Failure::usage(error.to_string(), "flags for reading", "--help");
        let mut table = given(self).map_err(|error| wrong(&error))?;
        // Recordings are trimmed after reading.
        table.remove("trim_still");
        if self.context == [NO_CONTEXT] {
            table.remove("context");
        }
        let options = table.try_into().map_err(|error: toml::de::Error| wrong(&error.message()))?;
        Ok(ReadOptions { elsewhere: self.elsewhere.clone(), ..options })
    }
}

impl PrepareFlags {
    /// All options except the context, which depends on the recordings.
    pub(crate) fn options(&self, read: &ReadFlags) -> Result<PrepareOptions, Failure> {
        let scale = self.scale.iter().map(|text| {
            let pair = text.split_once('=').and_then(|(name, factor)| Some((name.to_owned(), factor.parse().ok()?)));
            pair.ok_or_else(|| Failure::usage(format!("'{text}' is not NAME=FACTOR"), "--scale", "--scale z=10"))
        });
        Ok(PrepareOptions {
            scale: scale.collect::<Result<_, _>>()?,
            time_step: read.dt,
            time_unit_given: read.time_unit.is_some(),
            velocities: chosen(self.integration.as_deref(), "--integration")?.unwrap_or_default(),
            smoothing: self.smooth.as_deref().map_or(Ok(Smoothing::Auto), smoothing)?,
            jumps: chosen(self.jumps.as_deref(), "--jumps")?.unwrap_or_default(),
            wraps: chosen(self.wraps.as_deref(), "--wraps")?.unwrap_or_default(),
            context: ContextUse::Auto,
        })
    }
}

impl FitFlags {
    pub(crate) fn options(&self) -> Result<FitOptions, Failure> {
        let default = FitOptions::default();
        let bandwidth = |text| match Bandwidth::of(text) {
            Some(rule) => Ok(rule),
            None => number(text, "--bandwidth").map(Bandwidth::Fixed),
        };
        Ok(FitOptions {
            learner: chosen(self.learner.as_deref(), "--learner")?.unwrap_or_default(),
            reading: chosen(self.reading.as_deref(), "--reading")?,
            bandwidth: not_auto(self.bandwidth.as_deref()).map(bandwidth).transpose()?,
            init_d: not_auto(self.init_d.as_deref()).map(|text| number(text, "--init-d")).transpose()?,
            folds: self.folds.unwrap_or(default.folds),
            seed: self.seed.unwrap_or(default.seed),
            max_rows: self.max_rows.unwrap_or(default.max_rows),
            inducing: self.inducing.unwrap_or(default.inducing),
            robot: self.robot.as_ref().map(|path| urdf(path)).transpose()?,
        })
    }
}

fn chosen<C: Choice>(word: Option<&str>, flag: &str) -> Result<Option<C>, Failure> {
    let refused = |word| Failure::usage(format!("'{word}' is none of the choices"), flag, C::listed(""));
    word.map(|word| C::of(word).ok_or_else(|| refused(word))).transpose()
}

fn not_auto(text: Option<&str>) -> Option<&str> {
    text.filter(|text| *text != "auto")
}

fn smoothing(text: &str) -> Result<Smoothing, Failure> {
    text.parse().map_err(|what: String| Failure::usage(what, "--smooth", "--smooth auto, off, 9 (samples) or 0.2s"))
}

fn number(text: &str, flag: &str) -> Result<f64, Failure> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| Failure::usage(format!("'{text}' is not a positive number"), flag, format!("{flag} auto")))
}
