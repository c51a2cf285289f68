use motion::TimeUnit;
use serde::{Deserialize, Serialize};

/// Options for reading files. Everything that is not set is detected.
///
/// Columns, arrays and channels are named by **patterns**: a name, a glob (`q*`, `joint?`), numbered names (`q2-8`), or a number or
/// range counted from 0 (`2`, `2-8`). One text may hold several patterns, separated by commas. A name takes precedence over a number. A
/// pattern that matches nothing is an error; for `ignore`, only if it matches nothing in any of the files. In array formats, a pattern
/// that matches no array selects columns: `x0`, by the names of the channels, or `states_1` of the array `states`. A number counts
/// arrays, or the columns of the only array.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReadOptions {
    /// `--as`: the format; by default detected by content, then by extension.
    #[serde(rename = "as")]
    pub format: Option<Format>,
    /// `--state`: patterns of the state; by default everything that has no other role.
    pub state: Vec<String>,
    /// `--velocity`: patterns of the state's velocities, in the order of the state.
    pub velocity: Vec<String>,
    /// `--context`: patterns of quantities on which movements depend and that are constant in each, such as a goal. These channels
    /// follow the state. If velocities are recorded, theirs are 0.
    pub context: Vec<String>,
    /// `--time`: the column or array of stamps.
    pub time: Option<String>,
    /// `--time-unit`: the unit of numeric stamps; by default detected by the column's name and the size of the first stamp.
    pub time_unit: Option<TimeUnit>,
    /// `--episode`: the column or array that distinguishes episodes.
    pub episode: Option<String>,
    /// `--constraint-column`: the column or array with the name of the constraint of each episode or of each sample.
    pub constraint_column: Option<String>,
    /// `--ignore`: patterns of columns or arrays to ignore.
    pub ignore: Vec<String>,
    /// Patterns that another reading of the file uses; they are not reported as unused.
    #[serde(skip)]
    pub elsewhere: Vec<String>,
    /// `--dt`: seconds between samples; overrides stamps.
    pub dt: Option<f64>,
    /// `--units`: `m` for all channels, or `x=m` for those whose names match `x`. Names units without converting numbers.
    pub units: Vec<String>,
    /// `--degrees`: patterns of channels in degrees, which are converted to radians with their velocities.
    pub degrees: Vec<String>,
    /// `--unwrap`: patterns of angles, in radians or degrees, that jump by whole turns; they are made continuous.
    pub unwrap: Vec<String>,
    /// `--nan`: the treatment of samples that are not finite.
    pub nan: Nan,
    /// `--sort`: sorts samples by their stamps.
    pub sort: bool,
    /// `--split-gap`: seconds; cuts an episode where stamps go back or are further apart than this.
    pub split_gap: Option<f64>,
    /// `--filter`: a named subset of the episodes (robomimic's masks).
    pub filter: Option<String>,
    /// `--samples-are`: the layout of arrays; by default rows, and columns in MATLAB's files.
    pub samples_are: Option<SamplesAre>,
    /// `--separator`: the separator between fields of text; by default detected.
    pub separator: Option<char>,
    /// `--decimal`: the decimal point of text; by default detected.
    pub decimal: Option<char>,
    /// `--topic`: the topic of a bag.
    pub topic: Option<String>,
    /// `--trust`: allows entries to grow more than 64-fold when they are decompressed.
    pub trust: bool,
}

impl ReadOptions {
    /// The given options that have no effect on files of this format, as flags, with the purpose of each.
    pub(crate) fn idle(&self, format: Format) -> impl Iterator<Item = (&'static str, &'static str)> {
        let text = matches!(format, Format::Csv | Format::Tsv);
        let arrays = text || matches!(format, Format::Npy | Format::Npz | Format::Hdf5 | Format::Mat | Format::Jsonl);
        let given = [
            ("--separator", "text with separators", self.separator.is_some() && !text),
            ("--decimal", "text with separators", self.decimal.is_some() && !text),
            ("--samples-are", "arrays, and text without a header", self.samples_are.is_some() && !arrays),
            ("--filter", "HDF5 as robomimic writes it", self.filter.is_some() && format != Format::Hdf5),
            ("--topic", "bags (MCAP)", self.topic.is_some() && format != Format::Mcap),
        ];
        given.into_iter().filter(|(.., idle)| *idle).map(|(flag, of, _)| (flag, of))
    }
}

/// A format, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Text with any separators.
    Csv,
    /// Text with tabs.
    Tsv,
    /// One NumPy array.
    Npy,
    /// Named NumPy arrays.
    Npz,
    /// One JSON document per line.
    #[serde(alias = "ndjson")]
    Jsonl,
    /// A folder in LeRobot's layout.
    LeRobot,
    /// A Parquet file.
    Parquet,
    /// HDF5 in robomimic's layout.
    #[serde(alias = "h5")]
    Hdf5,
    /// A ROS 2 bag.
    Mcap,
    /// MATLAB's MAT-file, up to version 7.
    Mat,
}

/// The treatment of samples that are not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Nan {
    /// They cause an error.
    #[default]
    Refuse,
    /// They are left out.
    Drop,
    /// Up to 3 in a row are interpolated; more cause an error.
    Fill,
}

/// The layout of arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SamplesAre {
    /// (N, n): one row per sample.
    Rows,
    /// (n, N): one column per sample.
    Columns,
}
