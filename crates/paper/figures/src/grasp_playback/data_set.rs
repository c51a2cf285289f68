//! The table's first data set, and the starts from which movements are shown.

use anyhow::ensure;
use demo_gen::{Grasp, GraspStart, Recording};
use experiments::GRASP_SYSTEM;
use experiments::seed::generator;
use rand_chacha::ChaCha8Rng;

use super::STARTS;
use super::starts::chosen;

/// The training data.
pub(super) struct DataSet {
    pub(super) recordings: Vec<Recording>,
    /// The starts from which movements are shown.
    pub(super) shown: Vec<GraspStart>,
    /// The random number generator, after the data set was drawn.
    pub(super) rng: ChaCha8Rng,
}

impl DataSet {
    pub(super) fn draw(grasp: &Grasp, seed: u64) -> anyhow::Result<DataSet> {
        let mut rng = generator(seed, GRASP_SYSTEM, 0);
        let starts = (0..grasp.n_trajectories).map(|_| grasp.start(&mut rng)).collect::<Result<Vec<_>, _>>()?;
        let recordings = starts.iter().map(|start| grasp.movement(start)).collect::<Result<Vec<_>, _>>()?;
        let shown = chosen(&grasp.body, &starts, STARTS);
        ensure!(shown.len() == STARTS, "of {} starts only {} differ enough to be shown", starts.len(), shown.len());
        let shown = shown.into_iter().map(|at| starts[at].clone()).collect();
        Ok(DataSet { recordings, shown, rng })
    }
}
