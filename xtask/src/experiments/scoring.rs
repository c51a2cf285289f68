//! The measures of one data set (A1)–(A4).

use std::collections::BTreeMap;

use align::{Aligned, Samples};
use demo_gen::{Recording, Truth};
use metrics::{alignment_nmse, ncpe, nupe, potential_nmse};
use motion::{Policy, Potential};
use nalgebra::{DMatrix, DVector, DVectorViewMut};

use crate::measure::Measure;

/// Scores a learnt potential and policy, and the alignment they came from, on held-out samples of kept trajectories.
pub(crate) fn score(
    recordings: &[Recording],
    aligned: &Aligned,
    held_out: &Samples<'_>,
    potential: &impl Potential,
    policy: &impl Policy,
) -> anyhow::Result<BTreeMap<Measure, f64>> {
    let truth = TruthAtSamples::new(recordings, held_out);
    let learnt_potential = DVector::from_iterator(held_out.len(), held_out.iter().map(|(x, _)| potential.value(x)));
    let mut learnt_actions = DMatrix::zeros(policy.n_states(), held_out.len());
    for (mut action, (state, _)) in learnt_actions.column_iter_mut().zip(held_out) {
        policy.action_into(state, action.as_view_mut());
    }
    let discarded = aligned.discarded().len() as f64 / recordings.len() as f64;
    Ok(BTreeMap::from([
        (Measure::PotentialNmse, potential_nmse(&truth.potential, &learnt_potential)?),
        (Measure::Nupe, nupe(&truth.actions, &learnt_actions)?),
        (Measure::Ncpe, ncpe(&truth.actions, &learnt_actions, |n, v| truth.project(n, v))?),
        (Measure::Disc, 100.0 * discarded),
        (Measure::AlignmentNmse, alignment_nmse(&truth.potential, &held_out.values())?),
    ]))
}

/// What is true at some samples.
struct TruthAtSamples<'a> {
    samples: Vec<(&'a Truth, usize)>,
    potential: DVector<f64>,
    actions: DMatrix<f64>,
}

impl<'a> TruthAtSamples<'a> {
    fn new(recordings: &'a [Recording], samples: &Samples<'_>) -> Self {
        let at = samples.indices().iter().map(|index| (&recordings[index.trajectory].truth, index.sample));
        let samples: Vec<(&Truth, usize)> = at.collect();
        let actions: Vec<_> = samples.iter().map(|(truth, sample)| truth.actions.column(*sample)).collect();
        TruthAtSamples {
            potential: DVector::from_iterator(samples.len(), samples.iter().map(|(truth, n)| truth.potential[*n])),
            actions: DMatrix::from_columns(&actions),
            samples,
        }
    }

    /// Projects a vector by the constraint that held at the n-th sample (3).
    fn project(&self, n: usize, vector: DVectorViewMut<'_, f64>) {
        let (truth, sample) = self.samples[n];
        truth.projectors[sample].project_into(vector);
    }
}
