use thiserror::Error;

/// The input to which a value belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Series {
    /// The true policy or potential.
    Truth,
    /// The learnt policy or potential.
    Learnt,
    /// The difference of the two after the caller's projection.
    Projected,
    /// The errors to be summarized.
    Errors,
}

impl std::fmt::Display for Series {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Series::Truth => "truth",
            Series::Learnt => "learnt",
            Series::Projected => "projected difference",
            Series::Errors => "errors",
        })
    }
}

/// Reasons why an error has no value. All numbers count from 0; a potential or a list counts as one dimension.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// There are no samples.
    #[error("there is no sample ({rows} rows, {columns} columns); give at least one")]
    Empty {
        /// The given number of dimensions.
        rows: usize,
        /// The given number of samples.
        columns: usize,
    },
    /// Truth and estimate have different shapes.
    #[error(
        "the truth has shape ({}, {}), the learnt one ({}, {}): evaluate both at the same states",
        truth.0, truth.1, learnt.0, learnt.1
    )]
    Shape {
        /// Dimensions and samples of the truth.
        truth: (usize, usize),
        /// Dimensions and samples of the estimate.
        learnt: (usize, usize),
    },
    /// A value is NaN or infinite.
    #[error(
        "{series}, sample {sample}, dimension {dimension}: {value} is not a finite number; fix the computation of it"
    )]
    NotFinite {
        /// Its input.
        series: Series,
        /// Its sample.
        sample: usize,
        /// Its dimension.
        dimension: usize,
        /// The value itself.
        value: f64,
    },
    /// The truth does not vary beyond rounding, so that no relative error can be computed.
    #[error(
        "the truth is constant over the {samples} sample(s) (about {magnitude:e}, deviation {deviation:e}); \
         test at states where it differs"
    )]
    ConstantTruth {
        /// Number of samples.
        samples: usize,
        /// Root mean square of the truth.
        magnitude: f64,
        /// Root mean square of its deviation from the mean.
        deviation: f64,
    },
    /// All values are finite, but the result overflows.
    #[error("the result overflows; check the units of truth and estimate")]
    Overflow,
}
