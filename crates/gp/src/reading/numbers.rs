use motion::{LeastSeen, SampleIndex};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::Rows;
use crate::direct::free_rows::FreeRowsFit;
use crate::direct::model::DirectModel;
use crate::left_out::LeftOutPredictions;
use crate::left_out::comparison::{NEGLIGIBLE, difference, log_ratio, t_of_mean};
use crate::report::identifiability::least_seen;
use crate::rows::kept::Grouping;
use crate::slope::data::SlopeData;
use crate::slope::model::SlopeModel;

/// The numbers that determine the reading (R7). Both learners predict the speed along the direction of a held-out movement; only the
/// slope GP uses that direction as an input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReadingNumbers {
    /// Held-out squared error of the slope GP, as a share of the squared speed.
    pub a_s: f64,
    /// The same for the direct GP.
    pub a_d: f64,
    /// Their ratio.
    pub q: f64,
    /// t of the mean gain per trajectory.
    pub t: f64,
    /// Mean over trajectories of the log ratio of their errors.
    pub lambda: f64,
    /// t of λ.
    pub t_lambda: f64,
    /// Left-out error of the direct policy, as a share of its variance.
    pub p_d: f64,
    /// Difference of the two policies at the rows, as a share of the slope policy's variance.
    pub gap: f64,
    /// The direction with the least motion.
    pub least_seen: LeastSeen,
    /// Share of the slope policy's squared length that constraints hid, approximately.
    pub hidden: f64,
    /// Number of trajectories that have rows.
    pub trajectories: usize,
    /// The unit of leave-one-out.
    pub grouping: Grouping,
    /// If only some rows were constrained: the numbers of the direct GP are then those of the one learnt from the others (R10).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeRows>,
}

/// The rows that move freely if constraints deflected the others (R10).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeRows {
    /// Their share of all rows.
    pub share: f64,
    /// Largest distance of a free velocity from its prediction, in units of the state per second.
    pub within: f64,
    /// Mean squared left-out error along the motion of deflected rows, in squares of `within`.
    pub misfit: f64,
    /// Share of the deflected rows' squared left-out errors along their motion: 0 for orthogonal constraints, 1/d for noise.
    pub along: f64,
}

/// Held-out errors of a trajectory: weighted sums of squares along the direction of motion (R7), in squared
/// units of the state per second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrajectoryErrors {
    /// The trajectory. If one or two trajectories were cut into blocks of time, each block has an entry.
    pub trajectory: usize,
    /// E^s of the slope GP.
    pub slope: f64,
    /// E^d of the direct GP.
    pub direct: f64,
    /// R, the squared speed to predict.
    pub seen: f64,
}

/// Speed along the direction of a movement, as observed and as predicted from all other movements, in units of the state per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOutRow {
    /// The recorded sample; for a mean (S33), its first sample.
    pub index: SampleIndex,
    /// r, the observed speed.
    pub seen: f64,
    /// Prediction of the slope GP; `None` if it learnt from rows of stretches.
    pub slope: Option<f64>,
    /// Prediction of the direct GP.
    pub direct: f64,
}

/// Two models of the same rows.
#[derive(Clone, Copy)]
pub(crate) struct Compared<'a> {
    pub(crate) speeds: &'a [f64],
    pub(crate) grouping: Grouping,
    /// The sample of each row.
    pub(crate) indices: &'a [SampleIndex],
    pub(crate) data: &'a SlopeData,
    /// Held-out predictions of the slope GP, and its policy at the rows, (n, M).
    pub(crate) slope: (&'a LeftOutPredictions, &'a DMatrix<f64>),
    /// The same of the direct GP.
    pub(crate) direct: (&'a LeftOutPredictions, &'a DMatrix<f64>),
    /// ū.
    pub(crate) direct_unit: f64,
    /// The free rows from which the direct GP was learnt, if not from all.
    pub(crate) free_rows_fit: Option<&'a FreeRowsFit>,
    /// The slope GP's error on each group, as a share of the quantity to predict, if it learnt from other rows than `data`.
    pub(crate) shares: Option<&'a [f64]>,
}

impl Compared<'_> {
    /// E^s_T, E^d_T and R_T of (R7).
    pub(crate) fn errors(&self) -> Vec<TrajectoryErrors> {
        let &Compared { speeds, indices, data, .. } = self;
        let mean_weight =
            data.targets.noise_weights.iter().map(|d| 1.0 / d).sum::<f64>() / data.targets.noise_weights.len() as f64;
        let weight = |row: usize| 1.0 / (data.targets.noise_weights[row] * mean_weight);
        let errors = |(group, rows): (usize, &Vec<usize>)| {
            let power = |of: &dyn Fn(usize) -> f64| rows.iter().map(|&row| weight(row) * of(row).powi(2)).sum::<f64>();
            let seen = power(&|row| speeds[row]);
            TrajectoryErrors {
                trajectory: indices[rows[0]].trajectory,
                slope: match self.shares {
                    Some(shares) => shares[group] * seen,
                    None => power(&|row| self.slope_residual(row)),
                },
                direct: power(&|row| self.direct_residual(row)),
                seen,
            }
        };
        data.targets.groups.iter().enumerate().map(errors).collect()
    }

    /// Predictions of every row.
    pub(crate) fn rows(&self) -> Vec<LeftOutRow> {
        let row = |(row, (&seen, &index)): (usize, (&f64, &SampleIndex))| LeftOutRow {
            index,
            seen,
            slope: self.shares.is_none().then(|| seen - self.slope_residual(row)),
            direct: seen - self.direct_residual(row),
        };
        self.speeds.iter().zip(self.indices).enumerate().map(row).collect()
    }

    /// (R10).
    fn free(&self) -> Option<FreeRows> {
        let &FreeRowsFit { ref free, within, along, .. } = self.free_rows_fit?;
        let squares = (0..free.len()).filter(|&row| !free[row]).map(|row| self.direct_residual(row).powi(2));
        let (count, sum) = squares.fold((0, 0.0), |(count, sum), square| (count + 1, sum + square));
        let misfit = sum / f64::from(count.max(1)) / within.powi(2);
        Some(FreeRows { share: 1.0 - f64::from(count) / free.len() as f64, within, misfit, along })
    }

    /// e^s of (R7).
    fn slope_residual(&self, row: usize) -> f64 {
        self.data.unit * self.slope.0.residuals[(row, 0)]
    }

    /// e^d of (R7).
    fn direct_residual(&self, row: usize) -> f64 {
        self.direct_unit * (self.direct.0.residuals.row(row) * self.data.n.column(row)).x
    }
}

impl ReadingNumbers {
    /// Compares two models conditioned on all of these rows, each with its held-out predictions.
    pub fn of(
        rows: &Rows,
        data: &SlopeData,
        (slope, slope_left_out): (&SlopeModel, &LeftOutPredictions),
        (direct, direct_left_out): (&DirectModel, &LeftOutPredictions),
    ) -> Self {
        let speeds: Vec<f64> = rows.velocities().column_iter().map(|velocity| velocity.norm()).collect();
        Self::from_comparison(&Compared {
            speeds: &speeds,
            grouping: Grouping::Trajectories,
            indices: rows.indices(),
            data,
            slope: (slope_left_out, &slope.actions(rows.states())),
            direct: (direct_left_out, &direct.moving_actions(rows.states().as_view())),
            direct_unit: direct.unit,
            free_rows_fit: None,
            shares: None,
        })
    }

    pub(crate) fn from_comparison(compared: &Compared<'_>) -> Self {
        let &Compared { speeds, grouping, data, slope, direct, .. } = compared;
        let errors = compared.errors();
        let each = |of: fn(&TrajectoryErrors) -> f64| -> Vec<f64> { errors.iter().map(of).collect() };
        let (e_s, e_d, r) = (each(|of| of.slope), each(|of| of.direct), each(|of| of.seen));
        let total = |values: &[f64]| values.iter().sum::<f64>();
        let (a_s, a_d) = (total(&e_s) / total(&r), total(&e_d) / total(&r));
        let gains: Vec<f64> = e_d.iter().zip(&e_s).map(|(d, s)| d - s).collect();
        let log_ratios: Vec<f64> = (0..r.len()).map(|k| log_ratio(e_d[k], e_s[k], r[k])).collect();
        let seen: f64 = speeds.iter().map(|r| r * r).sum();
        ReadingNumbers {
            a_s,
            a_d,
            q: (a_s + NEGLIGIBLE) / (a_d + NEGLIGIBLE),
            t: t_of_mean(&gains),
            lambda: total(&log_ratios) / log_ratios.len() as f64,
            t_lambda: t_of_mean(&log_ratios),
            p_d: 1.0 - direct.0.r_squared,
            gap: difference(slope.1, direct.1),
            least_seen: least_seen(&data.n),
            hidden: (1.0 - seen / slope.1.norm_squared()).max(0.0),
            trajectories: data.targets.groups.len(),
            grouping,
            free: compared.free(),
        }
    }
}
