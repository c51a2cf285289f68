//! Test movements, which no learner sees, from new starts and under separate constraints. They measure a policy where
//! the movements kept by alignment may never have been.

use demo_gen::{Recording, ToySystem};
use motion::LearntPolicy;
use rand_chacha::ChaCha8Rng;

use crate::Measures;
use crate::evaluation::judge::Judge;
use crate::evaluation::observation_model::samples_of;
use crate::measure::Measure;
use crate::seed;

/// Number of movements per data set.
const MOVEMENTS: usize = 10;

/// Movements of a system. They do not advance the generator of the data set.
pub(crate) fn fresh(system: &ToySystem, rng: &ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
    let system = ToySystem { n_trajectories: MOVEMENTS, ..system.clone() };
    Ok(system.record(&mut seed::fresh(rng))?)
}

/// Adds each learner's error on these movements to its row.
pub(crate) fn add_errors<'a>(
    rows: &mut Measures,
    learnt: impl Iterator<Item = &'a dyn LearntPolicy>,
    recordings: &[Recording],
) -> anyhow::Result<()> {
    let judge = Judge::new(recordings, &samples_of(recordings, 0..recordings.len()));
    for (row, learnt) in rows.iter_mut().zip(learnt) {
        let [nupe, _] = judge.policy(&learnt)?;
        row.insert(Measure::NupeFresh, nupe);
    }
    Ok(())
}
