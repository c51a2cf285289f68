//! Summaries of the outcomes of many data sets: a cell of a table for every measure of every row.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context as _, ensure};
use metrics::Summary;

use crate::measure::Measure;
use crate::outcome::Outcomes;
use crate::results::{Cell, ExperimentResult, Results, RowResult};
use crate::verdict::verdict;
use crate::{Experiment, Row};

/// Summarises the outcomes of every setup, in the order of `experiments`.
///
/// # Errors
/// If no data set of a row has a value.
pub fn summarise(experiments: &[Experiment], outcomes: &[Vec<Outcomes>]) -> anyhow::Result<Vec<ExperimentResult>> {
    let experiment = |(experiment, outcomes): (&Experiment, &Vec<Outcomes>)| {
        let mut rows = Vec::new();
        for (setup, outcomes) in experiment.setups.iter().zip(outcomes) {
            for (at, row) in setup.rows.iter().enumerate() {
                rows.push(summarise_row(experiment, row, at, outcomes)?);
            }
        }
        Ok(ExperimentResult { id: experiment.id.to_owned(), section: experiment.section.to_owned(), rows })
    };
    experiments.iter().zip(outcomes).map(experiment).collect()
}

/// Checks that every cell is the summary of its values, compared with the printed numbers.
///
/// # Errors
/// Names the cell that is not.
pub fn check(experiments: &[Experiment], results: &Results) -> anyhow::Result<()> {
    results.check_known(experiments)?;
    for experiment in experiments {
        let result = results.experiments.iter().filter(|result| result.id == experiment.id);
        for found in result.flat_map(|result| &result.rows) {
            check_row(experiment, found).with_context(|| format!("{} {}", experiment.id, found.id))?;
        }
    }
    Ok(())
}

fn check_row(experiment: &Experiment, found: &RowResult) -> anyhow::Result<()> {
    let row = experiment.rows().find(|row| row.id == found.id).context("there is no such row")?;
    for (&measure, found_cell) in &found.measures {
        let (values, wanted) = (found_cell.values.len(), found.data_sets);
        ensure!(values == wanted, "{} has {values} values of {wanted} data sets", measure.name());
        let expected = cell(experiment, row, measure, found_cell.values.clone())?;
        ensure!(*found_cell == expected, "{} is not what its values come to", measure.name());
    }
    Ok(())
}

/// Summarises the row with index `at` in its setup.
fn summarise_row(experiment: &Experiment, row: &Row, at: usize, outcomes: &Outcomes) -> anyhow::Result<RowResult> {
    let rows: Vec<Option<&BTreeMap<Measure, f64>>> = outcomes.iter().map(|outcome| outcome.row(at)).collect();
    let failed = rows.iter().filter(|row| row.is_none()).count();
    let measures: BTreeSet<Measure> = rows.iter().flatten().flat_map(|row| row.keys().copied()).collect();
    let cell = |measure: Measure| {
        let values = rows.iter().map(|row| (*row)?.get(&measure).copied()).collect();
        Ok((measure, cell(experiment, row, measure, values)?))
    };
    let measures = measures.into_iter().map(cell).collect::<anyhow::Result<_>>()?;
    Ok(RowResult {
        id: row.id.clone(),
        tested_on: row.tested_on.to_owned(),
        data_sets: outcomes.len(),
        failed,
        measures,
    })
}

fn cell(experiment: &Experiment, row: &Row, measure: Measure, values: Vec<Option<f64>>) -> anyhow::Result<Cell> {
    let Summary { mean, sd, median, .. } = Summary::of(&values.iter().flatten().copied().collect::<Vec<_>>())?;
    let paper = experiment.paper(&row.id, measure);
    let verdict = paper.map(|paper| verdict(measure.kind(row.of), mean, paper));
    Ok(Cell { mean, sd, median, values, paper, verdict })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;
    use crate::verdict::Verdict;

    #[test]
    fn cells_inconsistent_with_their_values_are_found() {
        let experiments = registry().unwrap();
        let text = include_str!("../../../../docs/records/seed-2/results.json");
        let mut committed = Results::read("results.json", text).unwrap();
        committed.experiments.retain(|result| result.id == "table1");
        check(&experiments, &committed).unwrap();
        let damages: [fn(&mut Cell); 7] = [
            |cell| cell.mean *= 1.001,
            |cell| cell.sd = cell.sd.map(|sd| sd * 1.001),
            |cell| cell.median *= 1.001,
            |cell| cell.values[7] = cell.values[7].map(|value| value * 1.001),
            |cell| cell.values[7] = None,
            |cell| cell.values.push(Some(0.5)),
            |cell| cell.verdict = Some(Verdict::Higher),
        ];
        for (number, damage) in damages.iter().enumerate() {
            let mut damaged = committed.clone();
            damage(damaged.experiments[0].rows[3].measures.get_mut(&Measure::Nupe).unwrap());
            let error = format!("{:#}", check(&experiments, &damaged).unwrap_err());
            assert!(error.starts_with("table1 sinusoidal-40x40-narrow: nupe "), "{number}: {error}");
        }
    }
}
