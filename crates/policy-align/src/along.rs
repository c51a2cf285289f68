//! A policy's component along the direction of each movement: the only component that constraints leave unchanged.

use gp::Rows;
use motion::{LearntPolicy, Policy, SampleIndex};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// A moving sample, u = r n, and the policy's component along it.
pub(crate) struct MotionSample {
    /// Its movement, and its place in it.
    pub(crate) index: SampleIndex,
    /// The direction n, (n).
    pub(crate) direction: DVector<f64>,
    /// The speed r.
    pub(crate) speed: f64,
    /// nᵀπ̂, the policy's component along the motion; the policy may depend on the context.
    pub(crate) predicted: f64,
}

/// The samples of [`along`], by movement.
pub(crate) fn along_movements(policy: &dyn Policy, rows: &Rows) -> Vec<Vec<MotionSample>> {
    let count = rows.indices().iter().map(|index| index.trajectory + 1).max().unwrap_or(0);
    let mut movements: Vec<Vec<MotionSample>> = std::iter::repeat_with(Vec::new).take(count).collect();
    along(policy, rows).for_each(|sample| movements[sample.index.trajectory].push(sample));
    movements
}

/// The least number of movements that determines a t.
pub(crate) const FEW: usize = 5;
/// The t over movements above which an effect is real.
pub(crate) const LEAST_T: f64 = 4.0;

/// The first coefficient of a regression of r − nᵀπ̂ on two factors.
pub(crate) struct Regression {
    /// The coefficient.
    pub(crate) coefficient: f64,
    /// The coefficient divided by its standard error; the movements are the units.
    pub(crate) t: f64,
    /// Share of Σ(r − nᵀπ̂)² that it explains in addition to the second factor.
    pub(crate) share: f64,
}

impl Regression {
    /// Least squares over all samples. `None` if there are too few movements or the factors are linearly dependent.
    pub(crate) fn of(movements: &[Vec<MotionSample>], factors: impl Fn(&MotionSample) -> Vector2<f64>) -> Option<Self> {
        let parts = |sample: &MotionSample| (factors(sample), sample.speed - sample.predicted);
        let (mut matrix, mut vector, mut squares) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
        for (factors, error) in movements.iter().flatten().map(parts) {
            matrix += factors * factors.transpose();
            vector += factors * error;
            squares += error * error;
        }
        let inverse = matrix.try_inverse()?;
        let fit = inverse * vector;
        let influence = |samples: &Vec<MotionSample>| {
            let each = samples.iter().map(parts);
            each.map(|(factors, error)| (inverse * factors).x * (error - factors.dot(&fit))).sum::<f64>()
        };
        let deviation = movements.iter().map(|samples| influence(samples).powi(2)).sum::<f64>().sqrt();
        let counted = movements.iter().filter(|samples| !samples.is_empty()).count();
        let share = fit.x * fit.x / inverse.m11 / squares;
        (counted >= FEW).then_some(Regression { coefficient: fit.x, t: fit.x / deviation, share })
    }
}

/// Number of states in one call of the policy.
const BLOCK: usize = 4096;

/// All moving rows.
pub(crate) fn along<'a>(policy: &'a dyn Policy, rows: &'a Rows) -> impl Iterator<Item = MotionSample> + 'a {
    (0..rows.len()).step_by(BLOCK).flat_map(move |first| {
        let count = BLOCK.min(rows.len() - first);
        let actions = policy.actions(rows.states().columns(first, count));
        (0..count).filter_map(move |at| {
            let velocity = rows.velocities().column(first + at);
            let direction = velocity.try_normalize(0.0)?;
            let predicted = direction.dot(&actions.view((0, at), (direction.len(), 1)));
            Some(MotionSample { index: rows.indices()[first + at], direction, speed: velocity.norm(), predicted })
        })
    })
}

/// Error of a policy along the direction of motion: Σ (uᵀπ̂/r − r)², and sums for comparison.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ErrorAlongMotion {
    pub(crate) squares: f64,
    /// Σ r².
    pub(crate) observed: f64,
    /// Σ ‖π̂‖².
    pub(crate) predicted: f64,
    /// Σ ‖π̂ − π̂_GP‖², π̂_GP from the Gaussian process learnt from all movements.
    pub(crate) differences: f64,
    pub(crate) samples: usize,
    /// Samples outside the policy's support.
    pub(crate) unsupported: usize,
}

impl ErrorAlongMotion {
    /// E, relative to the motion: 0 means that movements are predicted exactly, 1 is as good as standing still.
    pub(crate) fn relative_to_motion(self) -> f64 {
        self.squares / self.observed
    }

    /// E′, relative to the policy, which may be right even if constraints hardly let it move. A policy that is zero everywhere
    /// has the error 1.
    pub(crate) fn relative_to_policy(self) -> f64 {
        let share = self.squares / self.predicted;
        if share.is_finite() { share } else { 1.0 }
    }

    /// The sums over both.
    pub(crate) fn plus(self, other: ErrorAlongMotion) -> ErrorAlongMotion {
        ErrorAlongMotion {
            squares: self.squares + other.squares,
            observed: self.observed + other.observed,
            predicted: self.predicted + other.predicted,
            differences: self.differences + other.differences,
            samples: self.samples + other.samples,
            unsupported: self.unsupported + other.unsupported,
        }
    }
}

/// Error of a policy that predicts the speed of the `test` rows. Rows whose speed is mostly noise do not count.
///
/// `reference`: another policy at every row, (n, M), for comparison.
pub(crate) fn error_along_motion(
    policy: &dyn LearntPolicy,
    rows: &Rows,
    test: &[usize],
    reference: Option<&DMatrix<f64>>,
) -> ErrorAlongMotion {
    let mut sums = ErrorAlongMotion::default();
    let mut action = DVector::zeros(policy.dim());
    for &row in test {
        let (x, u) = (rows.states().column(row), rows.velocities().column(row));
        let variance = rows.variances().map_or(0.0, |variances| variances[row]);
        let r = u.norm();
        if r == 0.0 || r * r < 9.0 * variance * rows.dim() as f64 {
            continue;
        }
        policy.action_into(x, action.as_view_mut());
        sums.squares += (u.dot(&action.rows(0, u.len())) / r - r).powi(2);
        sums.observed += r * r;
        sums.predicted += action.norm_squared();
        sums.differences += reference.map_or(0.0, |reference| (&action - reference.column(row)).norm_squared());
        sums.samples += 1;
        sums.unsupported += usize::from(policy.support(x) == 0.0);
    }
    sums
}

/// π(x) = −x in the plane.
#[cfg(test)]
pub(crate) struct Bowl;

#[cfg(test)]
impl Policy for Bowl {
    fn dim(&self) -> usize {
        2
    }

    fn action_into(&self, state: nalgebra::DVectorView<'_, f64>, mut action: nalgebra::DVectorViewMut<'_, f64>) {
        action.copy_from(&-state);
    }
}
