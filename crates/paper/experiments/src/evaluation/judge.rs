//! Errors of the result on one data set relative to the truth (A1)–(A4).

use align::Aligned;
use constraints::{NullSpaceProjector, PfaffianConstraint};
use demo_gen::{Recording, Truth};
use metrics::{ncpe, nupe, potential_nmse};
use motion::{Policy, Potential, SampleIndex};
use nalgebra::{DMatrix, DVector, DVectorView};

/// The truth at some samples.
pub struct Judge<'a> {
    samples: Vec<SampleIndex>,
    states: DMatrix<f64>,
    /// Empty if the policy has no potential.
    potential: DVector<f64>,
    actions: DMatrix<f64>,
    projectors: Vec<&'a NullSpaceProjector>,
}

impl<'a> Judge<'a> {
    /// Looks up the truth at these samples, which must be in ascending order.
    pub fn new(recordings: &'a [Recording], samples: &[SampleIndex]) -> Self {
        let truth = || samples.iter().map(|at| (&recordings[at.trajectory].truth, at.sample));
        let columns = |of: fn(&Truth) -> &DMatrix<f64>| {
            DMatrix::from_columns(&truth().map(|(truth, n)| of(truth).column(n)).collect::<Vec<_>>())
        };
        Judge {
            samples: samples.to_vec(),
            states: columns(|truth| &truth.states),
            potential: truth().filter_map(|(truth, n)| truth.potential.get(n).copied()).collect::<Vec<_>>().into(),
            actions: columns(|truth| &truth.actions),
            projectors: truth().map(|(truth, n)| &truth.projectors[n]).collect(),
        }
    }

    /// Restricts the test to some of the states; variances are then over these alone.
    #[must_use]
    pub(crate) fn among(&self, wanted: impl Fn(DVectorView<'_, f64>) -> bool) -> Judge<'a> {
        let chosen: Vec<usize> = (0..self.n_samples()).filter(|&sample| wanted(self.states.column(sample))).collect();
        Judge {
            samples: chosen.iter().map(|&sample| self.samples[sample]).collect(),
            states: self.states.select_columns(&chosen),
            potential: if self.has_potential() { self.potential.select_rows(&chosen) } else { DVector::zeros(0) },
            actions: self.actions.select_columns(&chosen),
            projectors: chosen.iter().map(|&sample| self.projectors[sample]).collect(),
        }
    }

    /// Whether there is a true potential for comparison.
    pub(crate) fn has_potential(&self) -> bool {
        !self.potential.is_empty()
    }

    /// The test samples, ascending.
    pub(crate) fn samples(&self) -> &[SampleIndex] {
        &self.samples
    }

    /// Number of test states.
    pub(crate) fn n_samples(&self) -> usize {
        self.states.ncols()
    }

    /// Errors of a policy, unconstrained (A1) and under the constraints of the demonstrations (A2).
    pub(crate) fn policy(&self, policy: &dyn Policy) -> anyhow::Result<[f64; 2]> {
        let learnt = self.actions_of(policy);
        let under_training = ncpe(&self.actions, &learnt, |n, v| self.projectors[n].project_into(v))?;
        Ok([nupe(&self.actions, &learnt)?, under_training])
    }

    /// Error of a policy under a constraint at time 0 (A2), whether or not the demonstrations contain it.
    pub(crate) fn policy_under(&self, policy: &dyn Policy, constraint: &dyn PfaffianConstraint) -> anyhow::Result<f64> {
        let projectors = self.states.column_iter().map(|state| constraint.null_space_projector(state, 0.0));
        let projectors = projectors.collect::<Result<Vec<_>, _>>()?;
        Ok(ncpe(&self.actions, &self.actions_of(policy), |n, v| projectors[n].project_into(v))?)
    }

    /// Error of a learnt potential (A3).
    ///
    /// # Errors
    /// If the true potential does not vary, or a value is not finite.
    pub fn potential(&self, potential: &dyn Potential) -> anyhow::Result<f64> {
        let values = self.states.column_iter().map(|state| potential.value(state));
        let learnt = DVector::from_iterator(self.n_samples(), values);
        Ok(potential_nmse(&self.potential, &learnt)?)
    }

    /// Error of the aligned local potentials (A4). All test samples must be of kept trajectories.
    ///
    /// # Errors
    /// As [`Judge::potential`].
    pub fn alignment(&self, aligned: &Aligned) -> anyhow::Result<f64> {
        Ok(potential_nmse(&self.potential, &aligned.samples().only(&self.samples).values())?)
    }

    /// The actions of a policy at the test samples.
    fn actions_of(&self, policy: &dyn Policy) -> DMatrix<f64> {
        let mut actions = DMatrix::zeros(self.states.nrows(), self.states.ncols());
        for (state, mut action) in self.states.column_iter().zip(actions.column_iter_mut()) {
            policy.action_into(state, action.as_view_mut());
        }
        actions
    }
}

#[cfg(test)]
mod tests {
    use align::PolicyAlign;
    use demo_gen::{ToySystem, demonstrations};
    use motion::{NegativeGradient, Potential as _};

    use super::*;

    /// Tested on two movements alone, the judge gives the same errors as the measures on the truth of these.
    #[test]
    fn a_part_of_the_test_samples_is_judged_by_its_own_variance() {
        let system = ToySystem { n_trajectories: 6, ..ToySystem::default() };
        let recordings = system.record(&mut crate::seed::generator(1, 0, 0)).unwrap();
        let align = PolicyAlign { bandwidth: align::Bandwidth::Wide, ..PolicyAlign::default() };
        let aligned = align.align(&demonstrations(&recordings).unwrap()).unwrap();
        let judge = Judge::new(&recordings, aligned.samples().indices());
        assert_eq!((judge.n_samples(), judge.among(|_| true).n_samples()), (240, 240));

        let learnt = demo_gen::ToyPotential::sinusoidal();
        let near = judge.among(|state| state.norm() < 1.0);
        let truth = recordings.iter().flat_map(|r| r.truth.states.column_iter().zip(&r.truth.potential));
        let (states, truth): (Vec<_>, Vec<f64>) = truth.filter(|(state, _)| state.norm() < 1.0).unzip();
        assert!((20..220).contains(&near.n_samples()) && near.n_samples() == states.len());
        let values = DVector::from_iterator(states.len(), states.iter().map(|state| learnt.value(*state)));
        let expected = potential_nmse(&DVector::from_vec(truth), &values).unwrap();
        assert_eq!(near.potential(&learnt).unwrap(), expected);

        let errors = [&near, &judge].map(|judge| judge.policy(&NegativeGradient(&learnt)).unwrap());
        let [nupe, ncpe] = errors[0];
        assert!(ncpe < nupe);
        assert_ne!(errors[0], errors[1]);
    }
}
