//! Howard's later learner as a baseline: one least-squares problem on radial basis functions, without alignment.

use motion::{Demonstrations, LearntPolicy, Policy, Potential, SampleIndex, SampleSet};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use serde::Serialize;

/// Learns the potential φ(x) = Σ w exp(−‖x − c‖² / 2h²) whose policy has the observed speed in the observed direction,
/// by least squares of ûᵀ(−∇φ(x)) − ‖u‖ over all samples. Under any constraint, the projection of the policy onto û has
/// length ‖u‖ (Howard, Klanke, Gienger, Goerick and Vijayakumar, *A novel method for learning policies from variable
/// constraint data*, Autonomous Robots 27, 2009).
#[derive(Serialize)]
pub(crate) struct ConstraintConsistent {
    /// Number of centres c along each axis of the bounding box of the samples; h is their distance.
    pub(crate) centres: usize,
    /// Added to the diagonal of the normal equations, relative to its mean.
    pub(crate) ridge: f64,
}

impl Default for ConstraintConsistent {
    fn default() -> Self {
        ConstraintConsistent { centres: 12, ridge: 1e-6 }
    }
}

/// The learnt potential.
#[derive(Debug)]
pub(crate) struct RadialBasis {
    /// (n, K).
    centres: DMatrix<f64>,
    width: f64,
    weights: DVector<f64>,
}

impl ConstraintConsistent {
    /// Learns from all samples of planar movements except the held-out ones, using recorded velocities, or else u = (x'
    /// − x) / δt.
    pub(crate) fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
    ) -> anyhow::Result<RadialBasis> {
        let held_out = SampleSet::of(held_out);
        let mut samples: Vec<(DVector<f64>, DVector<f64>)> = Vec::new();
        for (trajectory, movement) in demonstrations.trajectories().iter().enumerate() {
            let velocities = movement.velocities().cloned().unwrap_or_else(|| movement.step_velocities());
            for (sample, velocity) in velocities.column_iter().enumerate() {
                if !held_out.contains(SampleIndex { trajectory, sample }) && velocity.norm() > 0.0 {
                    samples.push((movement.state(sample).into_owned(), velocity.into_owned()));
                }
            }
        }
        let (low, high) = (corner(&samples, f64::min), corner(&samples, f64::max));
        let spacing = (&high - &low).max() / (self.centres - 1) as f64;
        let along = |axis: usize, k: usize| low[axis] + (high[axis] - low[axis]) * k as f64 / (self.centres - 1) as f64;
        let grid = DMatrix::from_fn(2, self.centres.pow(2), |axis, k| {
            along(axis, if axis == 0 { k % self.centres } else { k / self.centres })
        });
        let mut learnt = RadialBasis { width: spacing, weights: DVector::zeros(grid.ncols()), centres: grid };
        let rows = samples.iter().map(|(state, velocity)| learnt.slopes(state.as_view(), &velocity.normalize()));
        let design = DMatrix::from_columns(&rows.collect::<Vec<_>>());
        let speeds = DVector::from_iterator(samples.len(), samples.iter().map(|(_, velocity)| velocity.norm()));
        let mut normal = &design * design.transpose();
        let ridge = self.ridge * normal.diagonal().mean();
        normal.set_diagonal(&normal.diagonal().add_scalar(ridge));
        let solved = normal.cholesky().map(|cholesky| cholesky.solve(&(design * speeds)));
        learnt.weights = solved.ok_or_else(|| anyhow::anyhow!("the normal equations are singular"))?;
        Ok(learnt)
    }
}

fn corner(samples: &[(DVector<f64>, DVector<f64>)], extreme: fn(f64, f64) -> f64) -> DVector<f64> {
    let first = samples[0].0.clone();
    samples.iter().fold(first, |corner, (state, _)| corner.zip_map(state, extreme))
}

impl RadialBasis {
    /// The contribution of each basis function to ûᵀ(−∇φ), (K).
    fn slopes(&self, state: DVectorView<'_, f64>, direction: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(
            self.weights.len(),
            self.centres.column_iter().map(|centre| {
                let away = state - centre;
                self.basis(&away) * away.dot(direction) / self.width.powi(2)
            }),
        )
    }

    fn basis(&self, away: &DVector<f64>) -> f64 {
        (-away.norm_squared() / (2.0 * self.width.powi(2))).exp()
    }
}

impl Potential for RadialBasis {
    fn dim(&self) -> usize {
        self.centres.nrows()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        let terms = self.centres.column_iter().zip(&self.weights);
        terms.map(|(centre, weight)| weight * self.basis(&(state - centre))).sum()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.fill(0.0);
        for (centre, weight) in self.centres.column_iter().zip(&self.weights) {
            let away = state - centre;
            gradient.axpy(-weight * self.basis(&away) / self.width.powi(2), &away, 1.0);
        }
    }
}

impl Policy for RadialBasis {
    fn dim(&self) -> usize {
        self.centres.nrows()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        self.gradient_into(state, action.as_view_mut());
        action.neg_mut();
    }
}

impl LearntPolicy for RadialBasis {
    fn potential(&self) -> Option<&dyn Potential> {
        Some(self)
    }

    /// This learner has no measure of support: 1 everywhere.
    fn support(&self, _state: DVectorView<'_, f64>) -> f64 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use demo_gen::{ToySystem, demonstrations};

    use super::*;
    use crate::evaluation::judge::Judge;
    use crate::evaluation::observation_model::samples_of;
    use crate::seed::generator;

    /// From clean movements it recovers the policy, which is −∇φ of its potential.
    #[test]
    fn clean_movements_recover_the_policy() {
        let recordings = ToySystem::default().record(&mut generator(1, 0, 0)).unwrap();
        let learnt = ConstraintConsistent::default().learn(&demonstrations(&recordings).unwrap(), &[]).unwrap();
        let judge = Judge::new(&recordings, &samples_of(&recordings, 0..recordings.len()));
        let [nupe, ncpe] = judge.policy(&learnt).unwrap();
        assert!(nupe < 0.1 && ncpe < nupe, "{nupe} {ncpe}");

        let x = recordings[0].truth.states.column(7).into_owned();
        for axis in 0..2 {
            let mut step = DVector::zeros(2);
            step[axis] = 1e-6;
            let difference = learnt.value((&x + &step).as_view()) - learnt.value((&x - &step).as_view());
            assert!((learnt.action(x.as_view())[axis] + difference / 2e-6).abs() < 1e-6);
        }
    }
}
