//! The measures of one data set (A1)–(A4).

use std::collections::BTreeMap;

use align::{Aligned, Samples};
use demo_gen::Recording;
use metrics::{alignment_nmse, ncpe, nupe, potential_nmse};
use motion::{Policy, Potential};
use nalgebra::{DMatrix, DVector};

use crate::measure::Measure;

/// Scores a learnt potential and policy on held-out samples of kept trajectories.
pub(crate) fn score(
    recordings: &[Recording],
    aligned: &Aligned,
    held_out: &Samples,
    potential: &dyn Potential,
    policy: &dyn Policy,
) -> anyhow::Result<BTreeMap<Measure, f64>> {
    let truth = TruthAtSamples::new(recordings, held_out);
    let mut learnt_actions = DMatrix::zeros(policy.n_states(), held_out.len());
    let mut learnt_potential = DVector::zeros(held_out.len());
    for (n, state) in truth.states.column_iter().enumerate() {
        policy.action_into(state, learnt_actions.column_mut(n));
        learnt_potential[n] = potential.value(state);
    }
    let discarded = aligned.discarded().len() as f64 / recordings.len() as f64;
    Ok(BTreeMap::from([
        (Measure::PotentialNmse, potential_nmse(&truth.potential, &learnt_potential)?),
        (Measure::Nupe, nupe(&truth.actions, &learnt_actions)?),
        (Measure::Ncpe, ncpe(&truth.actions, &learnt_actions, |n, v| truth.project(n, v))?),
        (Measure::Disc, 100.0 * discarded),
        (Measure::AlignmentNmse, alignment_nmse(&truth.potential, held_out.potentials())?),
    ]))
}
