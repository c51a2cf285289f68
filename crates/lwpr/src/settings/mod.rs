//! Checked parameters of a model, and quantities derived from them.

pub(crate) mod kernel;
pub(crate) mod params;

use nalgebra::{DMatrix, DMatrixView, DVector};

use crate::error::Side;
use crate::{LwprError, LwprParams, Metric, MetricAdaptation};

/// Activation below which a field does not learn from a sample.
const TRAINING_FLOOR: f64 = 0.001;

/// Larger normalised values are refused, because fourth powers must stay finite.
const LARGEST: f64 = 1e50;

/// Maximum number of inputs or outputs, and of inputs with a full metric, whose square is stored in each field.
const MOST_DIMENSIONS: usize = 1 << 16;
const MOST_TURNING: usize = 1 << 10;

/// Checked parameters and derived quantities.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Settings {
    pub(crate) params: LwprParams,
    pub(crate) n_in: usize,
    pub(crate) n_out: usize,
    /// Length of a row of state: `n_in` padded for vector instructions.
    pub(crate) width: usize,
    pub(crate) norm_in: Vec<f64>,
    pub(crate) norm_out: Vec<f64>,
    /// M with D = MᵀM: its diagonal (one row), or its columns (`n_in` rows).
    pub(crate) init_m: Vec<f64>,
    /// Factor 2γ/n of the penalty on large metrics.
    pub(crate) gamma: f64,
    /// Squared distance within which a field learns from a sample.
    pub(crate) training_squared_radius: f64,
    /// Squared distance beyond which a field affects neither learning nor the creation of fields.
    pub(crate) squared_radius: f64,
}

impl Settings {
    pub(crate) fn new(params: LwprParams, n_in: usize, n_out: usize) -> Result<Self, LwprError> {
        if n_in == 0 || n_out == 0 {
            return Err(LwprError::NoDimension { n_in, n_out });
        }
        check_dimensions(params.metric, n_in, n_out)?;
        check_scalars(&params)?;
        let width = padded(n_in);
        let init_m = match &params.init_metric {
            Some(metric) => factor(metric, params.metric, width, n_in)?,
            None => isotropic(params.init_d, params.metric, width, n_in),
        };
        Ok(Settings {
            norm_in: norm(params.norm_in.as_ref(), n_in, Side::Input)?,
            norm_out: norm(params.norm_out.as_ref(), n_out, Side::Output)?,
            gamma: 2.0 * params.penalty / n_in as f64,
            training_squared_radius: params.kernel.squared_radius(TRAINING_FLOOR),
            squared_radius: params.kernel.squared_radius(TRAINING_FLOOR.min(0.1 * params.w_gen)),
            params,
            n_in,
            n_out,
            width,
            init_m,
        })
    }

    /// Whether learning rates are learnt too.
    pub(crate) fn meta(&self) -> bool {
        matches!(self.params.adaptation, MetricAdaptation::Meta { .. })
    }

    /// Whether the rows of a field are too short to fill vector registers, so that several fields are processed at a
    /// time.
    #[inline(always)]
    pub(crate) fn narrow(&self) -> bool {
        self.width <= 8
    }

    /// Whether a batch may go field by field, with several fields side by side: few dimensions, for each of which there
    /// is specialised code, and no removal of fields in between.
    pub(crate) fn side_by_side(&self) -> bool {
        let served = match self.params.metric {
            Metric::Diagonal => matches!(self.n_in, 2 | 3 | 6),
            Metric::Full => matches!(self.n_in, 2 | 6),
        };
        served && self.params.w_prune == 1.0
    }

    /// Number of values of M that determine distances: its diagonal, or its upper triangle.
    pub(crate) fn shape_len(&self) -> usize {
        self.params.metric.len(self.n_in)
    }

    /// Refuses values that are not finite, or so large that their powers would not be.
    pub(crate) fn check(&self, values: &[f64], side: Side, sample: usize) -> Result<(), LwprError> {
        let norm = match side {
            Side::Input => &self.norm_in,
            Side::Output => &self.norm_out,
        };
        if values.len() != norm.len() {
            return Err(LwprError::Dimension { side, found: values.len(), expected: norm.len() });
        }
        match values.iter().zip(norm).position(|(value, norm)| !is_usable(value / norm)) {
            None => Ok(()),
            Some(dimension) => Err(LwprError::BadValue { side, sample, dimension, value: values[dimension] }),
        }
    }
}

/// Refuses numbers that are not finite, column by column.
pub(crate) fn require_finite(values: DMatrixView<'_, f64>, side: Side) -> Result<(), LwprError> {
    for (sample, column) in values.column_iter().enumerate() {
        if let Some(dimension) = column.iter().position(|value| !value.is_finite()) {
            return Err(LwprError::BadValue { side, sample, dimension, value: column[dimension] });
        }
    }
    Ok(())
}

/// Refuses more dimensions than a model can have, before anything is allocated for them.
fn check_dimensions(metric: Metric, n_in: usize, n_out: usize) -> Result<(), LwprError> {
    let most_inputs = match metric {
        Metric::Diagonal => MOST_DIMENSIONS,
        Metric::Full => MOST_TURNING,
    };
    for (side, found, most) in [(Side::Input, n_in, most_inputs), (Side::Output, n_out, MOST_DIMENSIONS)] {
        if found > most {
            return Err(LwprError::TooManyDimensions { side, found, most });
        }
    }
    Ok(())
}

/// Whether a normalised value and its powers are finite.
fn is_usable(value: f64) -> bool {
    value.abs() <= LARGEST
}

impl Metric {
    /// Number of values of M that determine distances in `n` dimensions.
    #[inline(always)]
    pub(crate) fn len(self, n: usize) -> usize {
        match self {
            Metric::Diagonal => n,
            Metric::Full => n * (n + 1) / 2,
        }
    }
}

/// `n` rounded up so that rows fill whole vector registers without wasting many lanes.
#[inline(always)]
pub(crate) fn padded(n: usize) -> usize {
    if n <= 8 { n.next_power_of_two() } else { n.next_multiple_of(8) }
}

fn check_scalars(p: &LwprParams) -> Result<(), LwprError> {
    let positive = |v: f64| v > 0.0 && v.is_finite();
    let non_negative = |v: f64| v >= 0.0 && v.is_finite();
    let unit = |v: f64| v > 0.0 && v <= 1.0;
    // With a smaller value a field forgets nearly everything at each sample, and its sums vanish.
    let remembers = |v: f64| (0.5..=1.0).contains(&v);
    let rate = match p.adaptation {
        MetricAdaptation::Meta { rate } => rate,
        MetricAdaptation::Fixed | MetricAdaptation::Gradient => 0.0,
    };
    let limit = p.max_receptive_fields.map_or(1.0, |limit| limit as f64);
    let checks = [
        ("init_d", p.init_d, positive(p.init_d), "positive and finite"),
        ("init_alpha", p.init_alpha, non_negative(p.init_alpha), "finite and not negative"),
        ("adaptation.rate", rate, non_negative(rate), "finite and not negative"),
        ("penalty", p.penalty, non_negative(p.penalty), "finite and not negative"),
        ("w_gen", p.w_gen, p.w_gen > 0.0 && p.w_gen < 1.0, "between 0 and 1, both excluded"),
        ("w_prune", p.w_prune, unit(p.w_prune), "in (0, 1]"),
        ("init_lambda", p.init_lambda, remembers(p.init_lambda), "in [0.5, 1]"),
        ("final_lambda", p.final_lambda, remembers(p.final_lambda), "in [0.5, 1]"),
        ("tau_lambda", p.tau_lambda, unit(p.tau_lambda), "in (0, 1]"),
        ("add_threshold", p.add_threshold, non_negative(p.add_threshold), "finite and not negative"),
        ("init_s2", p.init_s2, positive(p.init_s2), "positive and finite"),
        ("max_receptive_fields", limit, limit >= 1.0, "at least 1"),
    ];
    match checks.into_iter().find(|(_, _, fine, _)| !fine) {
        None => Ok(()),
        Some((name, value, _, range)) => Err(LwprError::Parameter { name, value, range }),
    }
}

fn norm(given: Option<&DVector<f64>>, n: usize, side: Side) -> Result<Vec<f64>, LwprError> {
    let Some(norm) = given else { return Ok(vec![1.0; n]) };
    if norm.len() != n {
        return Err(LwprError::NormLength { side, found: norm.len(), expected: n });
    }
    match norm.iter().position(|&value| !(value > 0.0 && value.is_finite())) {
        None => Ok(norm.iter().copied().collect()),
        Some(dimension) => Err(LwprError::Norm { side, dimension, value: norm[dimension] }),
    }
}

fn isotropic(d: f64, metric: Metric, width: usize, n: usize) -> Vec<f64> {
    let mut m = vec![0.0; width * if metric == Metric::Full { n } else { 1 }];
    for i in 0..n {
        let row = if metric == Metric::Full { i } else { 0 };
        m[row * width + i] = d.sqrt();
    }
    m
}

/// The upper factor M of D = MᵀM, in the row layout of the fields.
fn factor(metric: &DMatrix<f64>, shape: Metric, width: usize, n: usize) -> Result<Vec<f64>, LwprError> {
    if metric.shape() != (n, n) {
        return Err(LwprError::MetricShape { shape: metric.shape(), n_in: n });
    }
    if !metric.iter().all(|value| value.is_finite()) {
        return Err(LwprError::MetricNotPositiveDefinite);
    }
    let largest = metric.amax();
    for column in 0..n {
        for row in 0..column {
            if (metric[(row, column)] - metric[(column, row)]).abs() > 1e-12 * largest {
                return Err(LwprError::MetricAsymmetric { row, column });
            }
            if shape == Metric::Diagonal && metric[(row, column)] != 0.0 {
                return Err(LwprError::MetricNotDiagonal { row, column, value: metric[(row, column)] });
            }
        }
    }
    let lower = metric.clone().cholesky().ok_or(LwprError::MetricNotPositiveDefinite)?.unpack();
    let mut m = vec![0.0; width * if shape == Metric::Full { n } else { 1 }];
    for column in 0..n {
        match shape {
            Metric::Diagonal => m[column] = lower[(column, column)],
            Metric::Full => (0..=column).for_each(|row| m[column * width + row] = lower[(column, row)]),
        }
    }
    Ok(m)
}
