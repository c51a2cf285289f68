//! Runs the selected setups on their data sets in parallel, and saves every finished one.

pub(crate) mod records;

use std::sync::Arc;

use experiments::outcome::{Outcome, Outcomes};
use experiments::seed::generator;
use experiments::{Experiment, Setup};
use rayon::prelude::*;

use crate::progress::Progress;
use records::{DataSet, Records};

/// Number of data sets per setup, and their seed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    /// Overrides the experiments' numbers of data sets.
    pub(crate) data_sets: Option<u32>,
    /// The same for setups that only compare learners; they take longest.
    pub(crate) of_comparisons: Option<u32>,
    /// Seed of all random numbers.
    pub(crate) seed: u64,
}

impl Plan {
    /// Number of data sets of a setup in an experiment. If a setup defines a number, that is the maximum.
    pub(crate) fn data_sets(&self, experiment: &Experiment, setup: &Setup) -> u32 {
        let own = setup.data_sets_of(experiment);
        let asked = if setup.is_of_comparisons() { self.of_comparisons } else { self.data_sets };
        asked.map_or(own, |asked| if setup.data_sets.is_some() { asked.min(own) } else { asked })
    }
}

/// All data sets of all setups, in order. Those that an earlier run finished have their outcome.
pub(crate) struct Work<'a> {
    experiments: &'a [Experiment],
    plan: Plan,
    /// Everything that determines the outcome of a data set except its number, by experiment and setup.
    definitions: Vec<Vec<String>>,
    /// By experiment, setup and data set.
    slots: Vec<Vec<Vec<Option<Outcome>>>>,
}

/// A data set that is still to be measured, and the slot for its outcome.
struct Job<'a> {
    /// Its index among all data sets.
    place: usize,
    setup: &'a Setup,
    data_set: DataSet<'a>,
    slot: &'a mut Option<Outcome>,
}

impl<'a> Work<'a> {
    /// Looks up the outcomes in `records`.
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

    /// Number of data sets.
    pub(crate) fn total(&self) -> usize {
        self.slots.iter().flatten().map(Vec::len).sum()
    }

    /// Measures every data set whose index `is_wanted`, except those already found; returns the number measured.
    ///
    /// The result depends only on experiments, plan and program, not on the number of threads or on the outcomes found.
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
        // Each thread takes one job at a time, because the work of data sets of different setups varies a hundredfold.
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

    /// The data sets that are not measured yet, with index and a readable name.
    pub(crate) fn missing(&mut self) -> Vec<(usize, String)> {
        let named = |job: Job<'_>| {
            let DataSet { experiment, setup, number, .. } = job.data_set;
            (job.place, format!("{experiment} {setup}, data set {number}"))
        };
        self.jobs().into_iter().map(named).collect()
    }

    /// All outcomes by experiment and setup; none may be missing.
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

/// The outcome from an earlier run; `None` if the record's number of rows differs from the setup's.
fn find(records: &Records, setup: &Setup, data_set: &DataSet<'_>) -> Option<Outcome> {
    let outcome = records.finished(data_set)?;
    outcome.is_of_rows(setup.rows.len()).then(|| outcome.clone())
}

/// A data set of a setup; `definition` contains everything that determines its outcome.
fn name<'a>(experiment: &Experiment, setup: &'a Setup, definition: &'a str, plan: Plan, number: u32) -> DataSet<'a> {
    DataSet { experiment: experiment.id, setup: &setup.id, definition, seed: plan.seed, number }
}
