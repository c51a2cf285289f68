//! Runs the selected setups over their data sets, in parallel, keeping every finished one.

use std::sync::Arc;

use rayon::prelude::*;

use crate::experiments::{Experiment, Setup};
use crate::progress::Progress;
use crate::records::{DataSet, Outcome, Records};
use crate::seed::generator;

/// The outcomes of one setup, by data set.
pub(crate) type Outcomes = Vec<Outcome>;

/// What to run: how many data sets a setup, from which seed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    /// Overrides each experiment's own number of data sets.
    pub(crate) data_sets: Option<u32>,
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Plan {
    /// Repetitions of each setup of an experiment.
    pub(crate) fn data_sets(&self, experiment: &Experiment) -> u32 {
        self.data_sets.unwrap_or(experiment.data_sets)
    }
}

/// One data set of one setup that is still to be measured, and where its outcome goes.
struct Job<'a> {
    experiment: &'a Experiment,
    setup: &'a Setup,
    data_set: u32,
    slot: &'a mut Option<Outcome>,
}

/// What was measured.
pub(crate) struct Measured {
    /// By experiment and setup.
    pub(crate) outcomes: Vec<Vec<Outcomes>>,
    /// How many data sets were finished before.
    pub(crate) resumed: usize,
}

/// Measures every data set of every setup, skipping what `records` already holds.
///
/// The result depends only on experiments, plan and program: not on the number of threads, nor on what was resumed.
pub(crate) fn run(experiments: &[Experiment], plan: Plan, records: &Arc<Records>) -> anyhow::Result<Measured> {
    let mut slots: Vec<Vec<Vec<Option<Outcome>>>> = experiments
        .iter()
        .map(|experiment| {
            let setup = |setup: &Setup| {
                (0..plan.data_sets(experiment)).map(|n| find(records, experiment, setup, plan, n)).collect()
            };
            experiment.setups.iter().map(setup).collect()
        })
        .collect();
    let total: usize = slots.iter().flatten().map(Vec::len).sum();
    let mut jobs = Vec::new();
    for (experiment, slots) in experiments.iter().zip(&mut slots) {
        for (setup, slots) in experiment.setups.iter().zip(slots) {
            for (data_set, slot) in (0..).zip(slots).filter(|(_, slot)| slot.is_none()) {
                jobs.push(Job { experiment, setup, data_set, slot });
            }
        }
    }
    let resumed = total - jobs.len();
    let progress = Progress::start(total, jobs.len(), jobs.iter().map(|job| job.setup.cost).sum());
    // One job at a time to each thread: data sets of different setups differ a hundredfold in work.
    jobs.into_par_iter().with_max_len(1).try_for_each(|job| -> anyhow::Result<()> {
        let outcome = measure(&job, plan);
        records.append(&name(job.experiment, job.setup, &definition(job.setup), plan, job.data_set), &outcome)?;
        *job.slot = Some(outcome);
        progress.finished(job.experiment.id, &job.setup.id, job.setup.cost);
        Ok(())
    })?;
    progress.done();
    let take = |slot: Option<Outcome>| slot.unwrap_or_else(|| unreachable!("every slot is resumed or measured"));
    let outcomes = slots
        .into_iter()
        .map(|setups| setups.into_iter().map(|setup| setup.into_iter().map(take).collect()).collect())
        .collect();
    Ok(Measured { outcomes, resumed })
}

fn measure(job: &Job<'_>, plan: Plan) -> Outcome {
    let mut rng = generator(plan.seed, job.setup.system, job.data_set);
    Outcome::of(job.setup.trial.run(&mut rng), job.setup.rows.len())
}

/// What an earlier run finished; nothing if the record is of another number of rows than the setup has.
fn find(records: &Records, experiment: &Experiment, setup: &Setup, plan: Plan, data_set: u32) -> Option<Outcome> {
    let outcome = records.finished(&name(experiment, setup, &definition(setup), plan, data_set))?;
    outcome.is_of_rows(setup.rows.len()).then(|| outcome.clone())
}

/// All that determines what a data set of a setup gives.
fn definition(setup: &Setup) -> String {
    format!("system {} {:?}", setup.system, setup.trial)
}

fn name<'a>(
    experiment: &'a Experiment,
    setup: &'a Setup,
    definition: &'a str,
    plan: Plan,
    data_set: u32,
) -> DataSet<'a> {
    DataSet { experiment: experiment.id, setup: &setup.id, definition, seed: plan.seed, number: data_set }
}
