//! `cargo xtask compare`: compares a run with the committed records, cell by cell.

use std::path::PathBuf;

use clap::Args;
use experiments::measure::Measure;
use experiments::results::{Cell, Results, RowResult};

use crate::failure::Failure;
use crate::files::relative;
use crate::progress::say;
use crate::run_folder::RunFolder;

/// Largest relative difference between a mean and the recorded one; the order of summation may differ.
const TOLERANCE: f64 = 1e-6;

/// Means closer than this are equal: if recovery is exact, the errors are rounding errors of arbitrary size.
const ROUNDING: f64 = 1e-9;

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Folder of a finished run, in full or in part
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Run to compare with [default: the committed run of the same seed]
    #[arg(value_name = "OTHER")]
    other: Option<PathBuf>,
}

impl Compare {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let run = RunFolder::at(&self.run).results()?;
        let other = match &self.other {
            Some(other) => RunFolder::at(other),
            None => RunFolder::committed(run.seed)?,
        };
        let other = other.results()?;
        let Comparison { cells, widest, new, faults } = Comparison::of(&run, &other);
        if cells == 0 {
            let remedy = "another run, or one of the same experiments";
            return Err(Failure::new("no cell in common with the other run", relative(&self.run), remedy).into());
        }
        let (difference, place) = widest;
        say(&format!(
            "{cells} cells compared, {new} new; the largest relative difference of means is {difference:.1e} ({place})"
        ));
        if faults.is_empty() {
            say(&format!("all means are within {TOLERANCE:e}, all verdicts the same"));
            return Ok(());
        }
        say(&faults.join("\n"));
        let remedy = "`cargo xtask publish` if these changes are intended";
        Err(Failure::new(format!("{} cell(s) differ", faults.len()), relative(&self.run), remedy).into())
    }
}

/// Cells that two runs share, and their differences.
#[derive(Debug, Default, PartialEq)]
struct Comparison {
    /// Number of cells in both.
    cells: usize,
    /// The largest relative difference of two means, and its cell.
    widest: (f64, String),
    /// Number of cells of this run that the other lacks.
    new: usize,
    faults: Vec<String>,
}

impl Comparison {
    fn of(run: &Results, other: &Results) -> Comparison {
        let mut comparison = Comparison::default();
        for result in &run.experiments {
            let recorded = other.experiment(&result.id);
            for row in &result.rows {
                let place = format!("{} {}", result.id, row.id);
                let recorded = recorded.and_then(|recorded| recorded.rows.iter().find(|other| other.id == row.id));
                comparison.row(&place, row, recorded);
            }
        }
        comparison
    }

    fn row(&mut self, place: &str, row: &RowResult, recorded: Option<&RowResult>) {
        let measured = |row: &RowResult, measure: Measure| row.measures.contains_key(&measure);
        for (&measure, cell) in &row.measures {
            match recorded.and_then(|recorded| recorded.measures.get(&measure)) {
                Some(recorded) => self.cell(format!("{place} {}", measure.name()), cell, recorded),
                None => self.new += 1,
            }
        }
        let gone = recorded.iter().flat_map(|recorded| recorded.measures.keys()).filter(|&&m| !measured(row, m));
        self.faults.extend(gone.map(|measure| format!("{place} {}: is not there any more", measure.name())));
    }

    /// Compares the data sets that both runs have. Verdicts apply to whole rows.
    fn cell(&mut self, place: String, cell: &Cell, recorded: &Cell) {
        self.cells += 1;
        let n = cell.values.len().min(recorded.values.len());
        let [ours, theirs] =
            [cell, recorded].map(|cell| cell.values[..n].iter().flatten().copied().collect::<Vec<_>>());
        if ours.len() != theirs.len() {
            self.faults.push(format!(
                "{place}: {} of {n} data sets have a value, {} had one",
                ours.len(),
                theirs.len()
            ));
            return;
        }
        let [mean, before] = [&ours, &theirs].map(|values| values.iter().sum::<f64>() / values.len().max(1) as f64);
        let is_rounding = (mean - before).abs() < ROUNDING;
        let difference = if is_rounding { 0.0 } else { (mean - before).abs() / before.abs() };
        if difference > TOLERANCE {
            self.faults.push(format!("{place}: mean {mean}, was {before}"));
        }
        if cell.values.len() == recorded.values.len() && cell.verdict != recorded.verdict {
            let [now, then] = [cell, recorded].map(|cell| cell.verdict.map_or("no verdict", |verdict| verdict.word()));
            self.faults.push(format!("{place}: {now}, was {then}"));
        }
        if difference >= self.widest.0 {
            self.widest = (difference, place);
        }
    }
}

#[cfg(test)]
mod tests {
    use experiments::verdict::Verdict;

    use super::*;

    fn committed() -> Results {
        let mut results = RunFolder::committed(2).unwrap().results().unwrap();
        results.experiments.retain(|result| result.id == "table1");
        results
    }

    fn cell(results: &mut Results) -> &mut Cell {
        results.experiments[0].rows[3].measures.get_mut(&Measure::Nupe).unwrap()
    }

    fn scaled(results: &mut Results, factor: f64) {
        for value in cell(results).values.iter_mut().flatten() {
            *value *= factor;
        }
    }

    #[test]
    fn a_run_equals_itself_and_sums_in_another_order() {
        let recorded = committed();
        let same = Comparison::of(&recorded, &recorded);
        assert!(same.cells > 40 && same.widest.0 == 0.0 && same.new == 0 && same.faults.is_empty(), "{same:?}");
        let mut run = recorded.clone();
        scaled(&mut run, 1.0 + 5e-7);
        let near = Comparison::of(&run, &recorded);
        assert!(near.faults.is_empty() && (near.widest.0 - 5e-7).abs() < 1e-9, "{near:?}");
        assert_eq!(near.widest.1, "table1 sinusoidal-40x40-narrow nupe");
    }

    #[test]
    fn a_part_of_the_data_sets_is_compared_with_that_part() {
        let (mut run, recorded) = (committed(), committed());
        for row in &mut run.experiments[0].rows {
            row.measures.values_mut().for_each(|cell| cell.values.truncate(3));
        }
        cell(&mut run).verdict = None;
        assert_eq!(Comparison::of(&run, &recorded).faults, Vec::<String>::new());
        scaled(&mut run, 1.0 + 2e-6);
        assert_eq!(Comparison::of(&run, &recorded).faults.len(), 1);
    }

    type Damage = fn(&mut Results);

    #[test]
    fn every_difference_is_reported() {
        let recorded = committed();
        let damages: [(Damage, &str); 4] = [
            (|run| scaled(run, 1.0 + 2e-6), "mean"),
            (|run| cell(run).verdict = Some(Verdict::Higher), "higher, was agrees"),
            (|run| cell(run).values[7] = None, "99 of 100 data sets have a value, 100 had one"),
            (|run| drop(run.experiments[0].rows[3].measures.remove(&Measure::Nupe)), "is not there any more"),
        ];
        for (damage, reported) in damages {
            let mut run = recorded.clone();
            damage(&mut run);
            let faults = Comparison::of(&run, &recorded).faults;
            assert!(
                faults.len() == 1 && faults[0].contains(reported) && faults[0].contains("narrow nupe"),
                "{faults:?}"
            );
        }
        let mut before = recorded.clone();
        before.experiments[0].rows[3].measures.remove(&Measure::Nupe);
        let more = Comparison::of(&recorded, &before);
        assert_eq!((more.new, more.faults.len()), (1, 0));
    }
}
