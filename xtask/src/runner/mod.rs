//! Runs the selected setups over their data sets, in parallel, keeping every finished one.

pub(crate) mod records;

use std::sync::Arc;

use experiments::outcome::{Outcome, Outcomes};
use experiments::seed::generator;
use experiments::{Experiment, Setup};
use rayon::prelude::*;

use crate::progress::Progress;
use records::{DataSet, Records};

/// What to run: how many data sets a setup, from which seed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    /// Overrides each experiment's own number of data sets.
    pub(crate) data_sets: Option<u32>,
    /// The same for setups that only hold learners against each other; they take longest.
    pub(crate) of_comparisons: Option<u32>,
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Plan {
    /// Repetitions of a setup of an experiment; of one that has its own number, no more than that.
    pub(crate) fn data_sets(&self, experiment: &Experiment, setup: &Setup) -> u32 {
        let own = setup.data_sets_of(experiment);
        let asked = if setup.is_of_comparisons() { self.of_comparisons } else { self.data_sets };
        asked.map_or(own, |asked| if setup.data_sets.is_some() { asked.min(own) } else { asked })
    }
}

/// All data sets of all setups, in order: those that an earlier run finished have their outcome.
pub(crate) struct Work<'a> {
    experiments: &'a [Experiment],
    plan: Plan,
    /// All that determines what a data set gives, but its number: by experiment and setup.
    definitions: Vec<Vec<String>>,
    /// By experiment, setup and data set.
    slots: Vec<Vec<Vec<Option<Outcome>>>>,
}

/// One data set of one setup that is still to be measured, and where its outcome goes.
struct Job<'a> {
    /// Its place among all data sets.
    place: usize,
    setup: &'a Setup,
    data_set: DataSet<'a>,
    slot: &'a mut Option<Outcome>,
}

impl<'a> Work<'a> {
    /// Looks for what `records` hold.
    pub(crate) fn find(experiments: &'a [Experiment], plan: Plan, records: &Records) -> anyhow::Result<Work<'a>> {
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
        Ok(Work { experiments, plan, definitions, slots })
    }

    /// How many data sets there are.
    pub(crate) fn total(&self) -> usize {
        self.slots.iter().flatten().map(Vec::len).sum()
    }

    /// Measures every data set that `is_wanted`, by its place, skipping what was found; how many those are.
    ///
    /// The result depends only on experiments, plan and program: not on the number of threads, nor on what was found.
    pub(crate) fn measure(
        &mut self,
        is_wanted: impl Fn(usize) -> bool,
        records: &Arc<Records>,
    ) -> anyhow::Result<usize> {
        let wanted = (0..self.total()).filter(|&place| is_wanted(place)).count();
        let seed = self.plan.seed;
        let jobs: Vec<Job<'_>> = self.jobs().into_iter().filter(|job| is_wanted(job.place)).collect();
        let progress = Progress::start(wanted, jobs.len(), jobs.iter().map(|job| job.setup.cost).sum());
        let measured = jobs.len();
        // One job at a time to each thread: data sets of different setups differ a hundredfold in work.
        jobs.into_par_iter().with_max_len(1).try_for_each(
            |Job { setup, data_set, slot, .. }| -> anyhow::Result<()> {
                let mut rng = generator(seed, setup.system, data_set.number);
                let outcome = Outcome::of(setup.trial.run(&mut rng), setup.rows.len());
                records.append(&data_set, &outcome)?;
                *slot = Some(outcome);
                progress.finished(data_set.experiment, &setup.id, setup.cost);
                Ok(())
            },
        )?;
        progress.done();
        Ok(measured)
    }

    /// What is not measured yet: its place, and its name for people.
    pub(crate) fn missing(&mut self) -> Vec<(usize, String)> {
        let named = |job: Job<'_>| {
            let DataSet { experiment, setup, number, .. } = job.data_set;
            (job.place, format!("{experiment} {setup}, data set {number}"))
        };
        self.jobs().into_iter().map(named).collect()
    }

    /// By experiment and setup, once nothing is missing.
    pub(crate) fn outcomes(self) -> Vec<Vec<Outcomes>> {
        let take = |slot: Option<Outcome>| slot.unwrap_or_else(|| unreachable!("every slot is found or measured"));
        let of_setup = |slots: Vec<Option<Outcome>>| slots.into_iter().map(take).collect();
        self.slots.into_iter().map(|setups| setups.into_iter().map(of_setup).collect()).collect()
    }

    fn jobs(&mut self) -> Vec<Job<'_>> {
        let plan = self.plan;
        let setups = self.experiments.iter().zip(&self.definitions).zip(&mut self.slots).flat_map(
            |((experiment, definitions), slots)| {
                let setups = experiment.setups.iter().zip(definitions).zip(slots);
                setups.map(move |((setup, definition), slots)| (experiment, setup, definition, slots))
            },
        );
        let data_sets = setups.flat_map(|(experiment, setup, definition, slots)| {
            (0..).zip(slots).map(move |(number, slot)| (name(experiment, setup, definition, plan, number), setup, slot))
        });
        let jobs = data_sets.enumerate().filter(|(_, (_, _, slot))| slot.is_none());
        jobs.map(|(place, (data_set, setup, slot))| Job { place, setup, data_set, slot }).collect()
    }
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
