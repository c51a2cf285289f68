use thiserror::Error;

/// The argument of a call to which an error refers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The inputs x.
    Input,
    /// The targets y.
    Output,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Side::Input => "input",
            Side::Output => "output",
        })
    }
}

/// Reasons why a model cannot be built, trained, evaluated or read. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LwprError {
    /// A model needs at least one input and one output.
    #[error("a model of {n_in} input(s) and {n_out} output(s): at least one of each is needed")]
    NoDimension {
        /// Requested number of inputs.
        n_in: usize,
        /// Requested number of outputs.
        n_out: usize,
    },
    /// A model has more inputs or outputs than possible.
    #[error(
        "a model of {found} {side}(s): at most {most} are possible (of inputs fewer with a full metric than with a diagonal one)"
    )]
    TooManyDimensions {
        /// Inputs or outputs.
        side: Side,
        /// Requested number.
        found: usize,
        /// The limit.
        most: usize,
    },
    /// A parameter is outside its range.
    #[error("parameter {name} is {value}: it must be {range}")]
    Parameter {
        /// Name of the field of [`LwprParams`](crate::LwprParams).
        name: &'static str,
        /// The given value.
        value: f64,
        /// The valid range, in words.
        range: &'static str,
    },
    /// `init_metric` does not have one row and one column for each input.
    #[error("init_metric has shape ({}, {}), the model has {n_in} input(s): give a square matrix, one row an input", shape.0, shape.1)]
    MetricShape {
        /// Given numbers of rows and columns.
        shape: (usize, usize),
        /// Number of inputs.
        n_in: usize,
    },
    /// `init_metric` is not symmetric.
    #[error("init_metric is not symmetric: element ({row}, {column}) differs from ({column}, {row}); use (D + Dᵀ)/2")]
    MetricAsymmetric {
        /// Row of the worst element.
        row: usize,
        /// Column of the worst element.
        column: usize,
    },
    /// `init_metric` is not positive definite, so that some direction would have no finite width.
    #[error("init_metric is not positive definite (or not finite); all its eigenvalues must be positive")]
    MetricNotPositiveDefinite,
    /// `init_metric` has an off-diagonal element, but the diagonal mode would never adapt it.
    #[error(
        "init_metric has {value} at ({row}, {column}), which a diagonal metric cannot hold; choose Metric::Full or drop it"
    )]
    MetricNotDiagonal {
        /// Row of the element.
        row: usize,
        /// Column of the element.
        column: usize,
        /// The element.
        value: f64,
    },
    /// The length of `norm_in` or `norm_out` differs from the number of dimensions.
    #[error("the norm of the {side}s has {found} element(s), the model {expected} {side}(s)")]
    NormLength {
        /// Inputs or outputs.
        side: Side,
        /// Number of given elements.
        found: usize,
        /// Number of required elements.
        expected: usize,
    },
    /// A norm is not a positive finite number.
    #[error("the norm of {side} {dimension} is {value}: it must be positive and finite (a typical size or spread)")]
    Norm {
        /// Inputs or outputs.
        side: Side,
        /// Index of the element.
        dimension: usize,
        /// The given value.
        value: f64,
    },
    /// The number of rows of a vector or matrix differs from the number of dimensions.
    #[error("the {side}s have {found} dimension(s), the model {expected}; samples are columns")]
    Dimension {
        /// Inputs or outputs.
        side: Side,
        /// Number of given rows.
        found: usize,
        /// Number of required rows.
        expected: usize,
    },
    /// A value is NaN or infinite, or so large against its norm (over 1e50) that its powers would be.
    #[error(
        "{side} {dimension} of sample {sample} is {value}: not finite, or over 1e50 times its norm; mend or drop the sample"
    )]
    BadValue {
        /// Inputs or outputs.
        side: Side,
        /// Column of the value; 0 for a single sample.
        sample: usize,
        /// Row of the value.
        dimension: usize,
        /// The value itself.
        value: f64,
    },
    /// The numbers of inputs and targets differ.
    #[error("{inputs} input sample(s) but {outputs} target(s): give one target a sample")]
    SampleCount {
        /// Number of columns of the inputs.
        inputs: usize,
        /// Number of columns of the targets.
        outputs: usize,
    },
    /// A batch has no sample.
    #[error("the batch has no sample (0 columns)")]
    EmptyBatch,
    /// A sample needs a new receptive field, but there are already `max_receptive_fields`.
    #[error(
        "sample {sample} needs another receptive field for output {output}, which has its {limit} already: \
         widen the fields (smaller init_d or w_gen) or raise max_receptive_fields; the model is unchanged"
    )]
    TooManyReceptiveFields {
        /// Column of the sample (in the given order; 0 for a single one).
        sample: usize,
        /// Index of the output.
        output: usize,
        /// The limit.
        limit: usize,
    },
    /// A serialised model or predictor is not consistent.
    #[error("the stored model is not consistent: {reason}")]
    Corrupt {
        /// Description of the fault.
        reason: String,
    },
}
