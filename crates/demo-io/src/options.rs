use serde::{Deserialize, Serialize};

/// What a user may say about files; by default everything is found out.
///
/// Columns, arrays and channels are named by **patterns**: a name, a glob (`q*`, `joint?`), numbered names (`q2-8`), or a
/// number or range counted from 0 (`2`, `2-8`). One text may hold several, with commas between. A name wins over a number. What names
/// nothing is an error, for `ignore` if it names nothing in any of the files. In formats of arrays, a pattern that names no array names
/// columns: `x0` as channels are called, or `states_1` of the array `states`; a number counts arrays, and columns of the only one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReadOptions {
    /// `--as`: the format; otherwise found by content, then by extension.
    #[serde(rename = "as")]
    pub format: Option<Format>,
    /// `--state`: patterns of what is state; otherwise all that is nothing else.
    pub state: Vec<String>,
    /// `--velocity`: patterns of the state's velocities, in the order of the state.
    pub velocity: Vec<String>,
    /// `--context`: patterns of what movements depend on and what stays as it is in each, such as a goal. These channels come after the
    /// state, and where velocities are recorded, theirs are 0.
    pub context: Vec<String>,
    /// `--time`: the column or array of stamps.
    pub time: Option<String>,
    /// `--time-unit`: of stamps that are numbers; otherwise found by the column's name and the size of the first.
    pub time_unit: Option<TimeUnit>,
    /// `--episode`: the column or array that tells episodes apart.
    pub episode: Option<String>,
    /// `--constraint-column`: the column or array with the name of the constraint, of an episode or of every sample.
    pub constraint_column: Option<String>,
    /// `--ignore`: patterns of what is not looked at.
    pub ignore: Vec<String>,
    /// Patterns of what another reading of the file takes: not reported as unused.
    #[serde(skip)]
    pub elsewhere: Vec<String>,
    /// `--dt`: seconds between samples; overrides stamps.
    pub dt: Option<f64>,
    /// `--units`: `m` for all channels, or `x=m` for those whose names match `x`. Names units, changes no number.
    pub units: Vec<String>,
    /// `--degrees`: patterns of channels in degrees, which become radians, with their velocities.
    pub degrees: Vec<String>,
    /// `--unwrap`: patterns of angles in radians that jump by whole turns, which are made continuous.
    pub unwrap: Vec<String>,
    /// `--nan`: what happens to samples that are not finite.
    pub nan: Nan,
    /// `--sort`: samples are put in the order of their stamps.
    pub sort: bool,
    /// `--split-gap`: seconds; an episode is cut where stamps go back or are further apart.
    pub split_gap: Option<f64>,
    /// `--filter`: a named subset of the episodes (robomimic's masks).
    pub filter: Option<String>,
    /// `--samples-are`: how arrays lie; otherwise rows, and columns in MATLAB's files.
    pub samples_are: Option<SamplesAre>,
    /// `--separator`: between fields of text; otherwise found out.
    pub separator: Option<char>,
    /// `--decimal`: the decimal point of text; otherwise found out.
    pub decimal: Option<char>,
    /// `--topic`: of a bag.
    pub topic: Option<String>,
    /// `--trust`: entries may grow more than 64-fold when they are decompressed.
    pub trust: bool,
}

impl ReadOptions {
    /// The options given that files of this format have no use for, as flags, and what each is for.
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

/// A format by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Text with separators, of any kind.
    Csv,
    /// Text with tabs.
    Tsv,
    /// One NumPy array.
    Npy,
    /// NumPy arrays with names.
    Npz,
    /// One JSON document a line.
    #[serde(alias = "ndjson")]
    Jsonl,
    /// A folder as LeRobot writes it.
    LeRobot,
    /// A Parquet file.
    Parquet,
    /// HDF5 as robomimic writes it.
    #[serde(alias = "h5")]
    Hdf5,
    /// A bag of ROS 2.
    Mcap,
    /// MATLAB's MAT-file up to version 7.
    Mat,
}

/// What happens to samples that are not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Nan {
    /// They are an error.
    #[default]
    Refuse,
    /// They are left out.
    Drop,
    /// Up to 3 in a row are interpolated; more are an error.
    Fill,
}

/// The unit of stamps that are numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TimeUnit {
    /// s.
    #[serde(rename = "s")]
    Seconds,
    /// ms.
    #[serde(rename = "ms")]
    Milliseconds,
    /// µs.
    #[serde(rename = "us")]
    Microseconds,
    /// ns.
    #[serde(rename = "ns")]
    Nanoseconds,
}

/// How arrays lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SamplesAre {
    /// (N, n): a row a sample.
    Rows,
    /// (n, N): a column a sample.
    Columns,
}
