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
    /// The same for setups that only hold learners against each other; they take longest.
    pub(crate) of_contestants: Option<u32>,
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Plan {
    /// Repetitions of a setup of an experiment; of one that has its own number, no more than that.
    pub(crate) fn data_sets(&self, experiment: &Experiment, setup: &Setup) -> u32 {
        let own = setup.data_sets.unwrap_or(experiment.data_sets);
        let asked = if setup.is_of_contestants() { self.of_contestants } else { self.data_sets };
        asked.map_or(own, |asked| if setup.data_sets.is_some() { asked.min(own) } else { asked })
    }
}

/// One data set of one setup that is still to be measured, and where its outcome goes.
struct Job<'a> {
    setup: &'a Setup,
    data_set: DataSet<'a>,
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
    let definition = |setup: &Setup| Ok(serde_json::to_string(&(setup.system, setup.trial.parameters()?))?);
    let of_setups = |e: &Experiment| e.setups.iter().map(definition).collect::<anyhow::Result<Vec<String>>>();
    let definitions = experiments.iter().map(of_setups).collect::<anyhow::Result<Vec<_>>>()?;
    let mut slots: Vec<Vec<Vec<Option<Outcome>>>> = Vec::new();
    for (experiment, definitions) in experiments.iter().zip(&definitions) {
        let slots_of = |(setup, definition): (&Setup, &String)| {
            let find = |number| find(records, setup, &name(experiment, setup, definition, plan, number));
            (0..plan.data_sets(experiment, setup)).map(find).collect()
        };
        slots.push(experiment.setups.iter().zip(definitions).map(slots_of).collect());
    }
    let total: usize = slots.iter().flatten().map(Vec::len).sum();
    let mut jobs = Vec::new();
    for ((experiment, definitions), slots) in experiments.iter().zip(&definitions).zip(&mut slots) {
        for ((setup, definition), slots) in experiment.setups.iter().zip(definitions).zip(slots) {
            for (number, slot) in (0..).zip(slots).filter(|(_, slot)| slot.is_none()) {
                jobs.push(Job { setup, data_set: name(experiment, setup, definition, plan, number), slot });
            }
        }
    }
    let resumed = total - jobs.len();
    let progress = Progress::start(total, jobs.len(), jobs.iter().map(|job| job.setup.cost).sum());
    // One job at a time to each thread: data sets of different setups differ a hundredfold in work.
    jobs.into_par_iter().with_max_len(1).try_for_each(|Job { setup, data_set, slot }| -> anyhow::Result<()> {
        let mut rng = generator(plan.seed, setup.system, data_set.number);
        let outcome = Outcome::of(setup.trial.run(&mut rng), setup.rows.len());
        records.append(&data_set, &outcome)?;
        *slot = Some(outcome);
        progress.finished(data_set.experiment, &setup.id, setup.cost);
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

/// What an earlier run finished; nothing if the record is of another number of rows than the setup has.
fn find(records: &Records, setup: &Setup, data_set: &DataSet<'_>) -> Option<Outcome> {
    let outcome = records.finished(data_set)?;
    outcome.is_of_rows(setup.rows.len()).then(|| outcome.clone())
}

/// A data set of a setup; `definition` is all that determines what it gives.
fn name<'a>(experiment: &Experiment, setup: &'a Setup, definition: &'a str, plan: Plan, number: u32) -> DataSet<'a> {
    DataSet { experiment: experiment.id, setup: &setup.id, definition, seed: plan.seed, number }
}
