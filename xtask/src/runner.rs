//! Runs the selected rows over their data sets, in parallel, keeping every finished one.

use std::sync::Arc;

use rayon::prelude::*;

use crate::experiments::{Experiment, Row};
use crate::progress::Progress;
use crate::records::{DataSet, Outcome, Records};
use crate::seed::generator;

/// The outcomes of one row, by data set.
pub(crate) type RowOutcomes = Vec<Outcome>;

/// What to run: how many data sets a row, from which seed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    /// Overrides each experiment's own number of data sets.
    pub(crate) data_sets: Option<u32>,
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Plan {
    /// Repetitions of each row of an experiment.
    pub(crate) fn data_sets(&self, experiment: &Experiment) -> u32 {
        self.data_sets.unwrap_or(experiment.data_sets)
    }
}

/// One data set of one row that is still to be measured, and where its outcome goes.
struct Job<'a> {
    experiment: &'a Experiment,
    row: &'a Row,
    data_set: u32,
    slot: &'a mut Option<Outcome>,
}

/// Measures every data set of every row, skipping what `records` already holds.
///
/// The result depends only on experiments, plan and program: not on the number of threads, nor on what was resumed.
pub(crate) fn run(
    experiments: &[Experiment],
    plan: Plan,
    records: &Arc<Records>,
) -> anyhow::Result<Vec<Vec<RowOutcomes>>> {
    let mut slots: Vec<Vec<Vec<Option<Outcome>>>> = experiments
        .iter()
        .map(|experiment| {
            let row =
                |row: &Row| (0..plan.data_sets(experiment)).map(|n| find(records, experiment, row, plan, n)).collect();
            experiment.rows.iter().map(row).collect()
        })
        .collect();
    let total: usize = slots.iter().flatten().map(Vec::len).sum();
    let mut jobs = Vec::new();
    for (experiment, slots) in experiments.iter().zip(&mut slots) {
        for (row, slots) in experiment.rows.iter().zip(slots) {
            for (data_set, slot) in (0..).zip(slots).filter(|(_, slot)| slot.is_none()) {
                jobs.push(Job { experiment, row, data_set, slot });
            }
        }
    }
    let progress = Progress::start(total, jobs.len(), jobs.iter().map(|job| job.row.trial.cost()).sum());
    // One job at a time to each thread: data sets of different rows differ a hundredfold in work.
    jobs.into_par_iter().with_max_len(1).try_for_each(|job| -> anyhow::Result<()> {
        let outcome = measure(&job, plan);
        records.append(&name(job.experiment, job.row, &job.row.trial.definition(), plan, job.data_set), &outcome)?;
        *job.slot = Some(outcome);
        progress.finished(job.experiment.id, &job.row.id, job.row.trial.cost());
        Ok(())
    })?;
    progress.done();
    let take = |slot: Option<Outcome>| slot.unwrap_or_else(|| unreachable!("every slot is resumed or measured"));
    Ok(slots
        .into_iter()
        .map(|rows| rows.into_iter().map(|row| row.into_iter().map(take).collect()).collect())
        .collect())
}

fn measure(job: &Job<'_>, plan: Plan) -> Outcome {
    let mut rng = generator(plan.seed, job.row.trial.system(), job.data_set);
    match job.row.trial.run(&mut rng) {
        Ok(measures) => Outcome::Measured(measures),
        Err(error) => Outcome::Failed(format!("{error:#}")),
    }
}

fn find(records: &Records, experiment: &Experiment, row: &Row, plan: Plan, data_set: u32) -> Option<Outcome> {
    records.finished(&name(experiment, row, &row.trial.definition(), plan, data_set)).cloned()
}

fn name<'a>(experiment: &'a Experiment, row: &'a Row, definition: &'a str, plan: Plan, data_set: u32) -> DataSet<'a> {
    DataSet { experiment: experiment.id, row: &row.id, definition, seed: plan.seed, data_set }
}
