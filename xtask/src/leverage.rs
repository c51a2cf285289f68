//! `cargo xtask leverage`: how much hangs on what is fitted.
//!
//! Every setting that the paper does not give is changed by a fifth, up and down, one at a time, on the first data sets of
//! a seed; the printed cells whose verdict is another than at the value used are named. What texts quote of other values is
//! measured beside.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;
use experiments::measure::Measure;
use experiments::results::ExperimentResult;
use experiments::summary::summarise;
use experiments::variants::{Cell, Quote, Variants, quotes};
use experiments::verdict::Verdict;
use experiments::{Experiment, Setting, Setup, quotable, registry, settings};
use page::markdown_table;

use crate::files::{repository, write};
use crate::progress::say;
use crate::records::{Earlier, Records};
use crate::runner::{Plan, Work};

/// By how much settings are changed.
const FACTORS: [f64; 2] = [0.8, 1.2];

#[derive(Debug, Args)]
pub(crate) struct Leverage {
    /// Data sets a row
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(2..))]
    data_sets: u32,
    /// Seed of all random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Folder for the records of finished data sets: what was stopped goes on from there [default: target/leverage]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What the README quotes of Table 1's system with fewer movements.
const README: &str = "\
    is {movements = 10: parabola-40x40-medium nupe_fresh} with 10 movements, \
    {movements = 15: parabola-40x40-medium nupe_fresh} with 15, {movements = 20: parabola-40x40-medium nupe_fresh} with 20 and \
    {movements = 30: parabola-40x40-medium nupe_fresh} with 30; on its sinusoid \
    {movements = 10: sinusoidal-40x40-medium nupe_fresh}, {movements = 15: sinusoidal-40x40-medium nupe_fresh}, \
    {movements = 20: sinusoidal-40x40-medium nupe_fresh} and {movements = 30: sinusoidal-40x40-medium nupe_fresh}.";

/// The verdict of every printed cell.
type Verdicts = Vec<(Cell, Verdict)>;

impl Leverage {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let folder = self.out.clone().unwrap_or_else(|| repository().join("target/leverage"));
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let records = Arc::new(Records::open(&folder.join("records.jsonl"), Earlier::Resume)?);
        let mut text = self.preface();
        let (mut experiment, mut rows, mut base) = ("", Vec::new(), Vec::new());
        for setting in settings() {
            if setting.experiment != experiment {
                add_table(&mut text, experiment, &rows);
                (experiment, rows) = (setting.experiment, Vec::new());
                base = self.verdicts(&setting, setting.used, &records)?;
            }
            rows.push(self.row(&setting, &base, &records)?);
        }
        add_table(&mut text, experiment, &rows);
        write(&repository().join("docs/leverage.md"), text)?;
        write(&repository().join("docs/records/variants.json"), self.quoted(&records)?.json()?)?;
        say("written: docs/leverage.md, docs/records/variants.json");
        Ok(())
    }

    /// What texts quote of other settings.
    fn quoted(&self, records: &Arc<Records>) -> anyhow::Result<Variants> {
        let mut variants = Variants::from_seed(self.seed);
        for experiment in registry()? {
            let of_readme = if experiment.id == "table1" { readme_quotes()? } else { Vec::new() };
            for (quote, cell) in experiment.explanations.quotes.iter().chain(&of_readme) {
                let is_meant = |setting: &Setting| setting.experiment == experiment.id && setting.name == quote.setting;
                let setting = quotable().find(is_meant);
                let setting = setting.with_context(|| format!("{} has no setting {}", experiment.id, quote.setting))?;
                let of_cell = |setup: &Setup| setup.rows.iter().any(|row| row.id == cell.0);
                let result = self.result(&setting, quote.value, of_cell, records)?;
                let row = result.rows.iter().find(|row| row.id == cell.0);
                let found = row.and_then(|row| row.measures.get(&cell.1));
                let found = found.with_context(|| format!("{} has no {} {}", experiment.id, cell.0, cell.1.name()))?;
                variants.add(experiment.id, quote, cell, found.values.iter().flatten().copied().collect());
            }
        }
        Ok(variants)
    }

    fn preface(&self) -> String {
        format!(
            "# How much hangs on what is fitted\n\nWritten by `cargo xtask leverage --data-sets {} --seed {}`. The paper leaves these settings open; \
             they were chosen so that\nthe printed figures come out. Here each is changed by a fifth (whole numbers to the nearest), one at a time, and the printed cells are \
             named whose verdict is\nthen another than at the value used, on the same data sets. Verdicts are those of \
             [reproduction.md](reproduction.md); with fewer data\nsets they may differ from those there.\n",
            self.data_sets, self.seed
        )
    }

    fn row(&self, setting: &Setting, base: &Verdicts, records: &Arc<Records>) -> anyhow::Result<Vec<String>> {
        let mut row = vec![setting.name.to_owned(), setting.paper.to_owned(), number(setting.used)];
        for factor in FACTORS {
            let value = setting.used * factor;
            say(&format!("{}: {} = {}", setting.experiment, setting.name, number(value)));
            let turned = turned(base, &self.verdicts(setting, value, records)?);
            row.push(if turned.is_empty() { "none".to_owned() } else { turned.join("; ") });
        }
        Ok(row)
    }

    fn verdicts(&self, setting: &Setting, value: f64, records: &Arc<Records>) -> anyhow::Result<Verdicts> {
        Ok(verdicts(&self.result(setting, value, |_| true, records)?).collect())
    }

    /// The experiment at a setting's value, as far as its setups are wanted.
    fn result(
        &self,
        setting: &Setting,
        value: f64,
        wanted: impl Fn(&Setup) -> bool,
        records: &Arc<Records>,
    ) -> anyhow::Result<ExperimentResult> {
        let found = registry()?.into_iter().find(|experiment| experiment.id == setting.experiment);
        let mut experiment = found.with_context(|| format!("there is no experiment {}", setting.experiment))?;
        experiment.setups = (setting.with)(value)?;
        experiment.setups.retain(wanted);
        let experiments: [Experiment; 1] = [experiment];
        let plan = Plan { data_sets: Some(self.data_sets), of_contestants: Some(0), seed: self.seed };
        let mut work = Work::find(&experiments, plan, records)?;
        work.measure(|_| true, records)?;
        summarise(&experiments, &work.outcomes())?.pop().context("one experiment has one result")
    }
}

fn readme_quotes() -> anyhow::Result<Vec<(Quote, Cell)>> {
    // Every one names its cell.
    quotes(&(String::new(), Measure::NupeFresh), README)
}

fn verdicts(result: &ExperimentResult) -> impl Iterator<Item = (Cell, Verdict)> {
    let cells = result.rows.iter().flat_map(|row| row.measures.iter().map(move |(measure, cell)| (row, measure, cell)));
    cells.filter_map(|(row, measure, cell)| Some(((row.id.clone(), *measure), cell.verdict?)))
}

/// Cells whose verdict is another, from what to what.
fn turned(base: &Verdicts, other: &Verdicts) -> Vec<String> {
    let both = base.iter().zip(other).filter(|((cell, was), (same, is))| cell == same && was != is);
    both.map(|(((row, measure), was), (_, is))| format!("{row} {}: {} → {}", measure.label(), was.word(), is.word()))
        .collect()
}

/// As short as it was written.
fn number(value: f64) -> String {
    let rounded = format!("{value:.6}");
    if value.abs() < 1e-3 {
        format!("{value:.1e}")
    } else {
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

fn add_table(text: &mut String, experiment: &str, rows: &[Vec<String>]) {
    if !rows.is_empty() {
        let header = ["setting", "the paper says", "used", "a fifth less turns", "a fifth more turns"];
        let _ = write!(text, "\n## `{experiment}`\n\n{}", markdown_table(&header, rows));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every setting's value in use is the one that its experiment has: the same parameters, to the last digit.
    #[test]
    fn what_is_said_to_be_used_is_used() {
        let experiments = registry().unwrap();
        for setting in settings() {
            let experiment = experiments.iter().find(|experiment| experiment.id == setting.experiment).unwrap();
            for setup in (setting.with)(setting.used).unwrap() {
                let own = experiment.setups.iter().find(|own| own.id == setup.id).unwrap();
                let parameters = [&setup, own].map(|setup| setup.trial.parameters().unwrap());
                assert_eq!(parameters[0], parameters[1], "{} {}", setting.experiment, setting.name);
            }
            for setup in (setting.with)(1.2 * setting.used).unwrap() {
                let own = experiment.setups.iter().find(|own| own.id == setup.id).unwrap();
                let parameters = [&setup, own].map(|setup| setup.trial.parameters().unwrap());
                assert_ne!(parameters[0], parameters[1], "{} {}", setting.experiment, setting.name);
            }
        }
    }

    #[test]
    fn the_readme_quotes_what_was_measured() {
        let readme = std::fs::read_to_string(repository().join("README.md")).unwrap();
        let readme = readme.split_whitespace().collect::<Vec<_>>().join(" ");
        let quoted = Variants::committed().unwrap().filled("table1", &(String::new(), Measure::Nupe), README).unwrap();
        assert!(readme.contains(&quoted), "the README does not say: {quoted}");
    }

    #[test]
    fn cells_that_turn_are_named() {
        let cell = |verdict| vec![(("narrow".to_owned(), Measure::Nupe), verdict)];
        assert_eq!(turned(&cell(Verdict::Agrees), &cell(Verdict::Agrees)), Vec::<String>::new());
        assert_eq!(turned(&cell(Verdict::Agrees), &cell(Verdict::Lower)), ["narrow nUPE: agrees → lower"]);
        assert_eq!([0.17, 20.0, 1e-5, 24.0, -7.2].map(number), ["0.17", "20", "1.0e-5", "24", "-7.2"]);
    }
}
