//! A policy's component along the direction of each movement: the only component that constraints leave unchanged.

use gp::Rows;
use motion::{Policy, SampleIndex};
use nalgebra::{DVector, Matrix2, Vector2};

/// A moving sample, u = r n, and the policy's component along it.
pub(crate) struct Along {
    /// Index of its movement.
    pub(crate) trajectory: usize,
    /// Its index in the movement.
    pub(crate) sample: usize,
    /// The direction n, (n).
    pub(crate) direction: DVector<f64>,
    /// The speed r.
    pub(crate) speed: f64,
    /// nᵀπ̂; the policy may depend on the context.
    pub(crate) wanted: f64,
}

/// The samples of [`along`], by movement.
pub(crate) fn along_movements(policy: &dyn Policy, rows: &Rows) -> Vec<Vec<Along>> {
    let count = rows.indices().iter().map(|index| index.trajectory + 1).max().unwrap_or(0);
    let mut movements: Vec<Vec<Along>> = std::iter::repeat_with(Vec::new).take(count).collect();
    along(policy, rows).for_each(|sample| movements[sample.trajectory].push(sample));
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
    pub(crate) fn of(movements: &[Vec<Along>], factors: impl Fn(&Along) -> Vector2<f64>) -> Option<Self> {
        let parts = |sample: &Along| (factors(sample), sample.speed - sample.wanted);
        let (mut matrix, mut vector, mut squares) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
        for (factors, error) in movements.iter().flatten().map(parts) {
            matrix += factors * factors.transpose();
            vector += factors * error;
            squares += error * error;
        }
        let inverse = matrix.try_inverse()?;
        let fit = inverse * vector;
        let influence = |samples: &Vec<Along>| {
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
pub(crate) fn along<'a>(policy: &'a dyn Policy, rows: &'a Rows) -> impl Iterator<Item = Along> + 'a {
    (0..rows.len()).step_by(BLOCK).flat_map(move |first| {
        let count = BLOCK.min(rows.len() - first);
        let actions = policy.actions(rows.states().columns(first, count));
        (0..count).filter_map(move |at| {
            let velocity = rows.velocities().column(first + at);
            let direction = velocity.try_normalize(0.0)?;
            let wanted = direction.dot(&actions.view((0, at), (direction.len(), 1)));
            let SampleIndex { trajectory, sample } = rows.indices()[first + at];
            Some(Along { trajectory, sample, direction, speed: velocity.norm(), wanted })
        })
    })
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
