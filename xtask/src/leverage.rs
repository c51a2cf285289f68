//! `cargo xtask leverage`: measures the influence of the fitted settings.
//!
//! Changes every setting that the paper does not give by a fifth, up and down, one at a time, on the first data sets of
//! a seed, and names the printed cells whose verdict changes. Also measures the results at other settings that texts
//! quote.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;
use experiments::leverage::{Changed, Leverage as Measured, Turned};
use experiments::measure::Measure;
use experiments::results::{ExperimentResult, RowResult};
use experiments::summary::summarise;
use experiments::variants::{Cell, Variants, quotes};
use experiments::verdict::Verdict;
use experiments::{Experiment, Setting, Setup, quotable, registry, settings, shown};
use page::markdown_table;

use crate::files::{repository, write};
use crate::progress::say;
use crate::runner::records::{Earlier, Records};
use crate::runner::{Plan, Work};

/// The output: the measurements, their page of documentation, and the values that texts quote.
const LEVERAGE: &str = "docs/records/leverage.json";
pub(crate) const PAGE: &str = "docs/leverage.md";
const VARIANTS: &str = "docs/records/variants.json";

/// Factors by which settings are changed.
const SMALLER: f64 = 0.8;
const LARGER: f64 = 1.2;

#[derive(Debug, Args)]
pub(crate) struct Leverage {
    /// Data sets per row
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(2..))]
    data_sets: u32,
    /// Seed of all random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Folder of finished data sets, from which a stopped run resumes [default: target/leverage]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// The quotes in `docs/which-learner.md` about Table 1's system with fewer movements.
const FEW_MOVEMENTS: &str = "\
    is {movements = 10: parabola-40x40-medium nupe_fresh} with 10 movements, \
    {movements = 15: parabola-40x40-medium nupe_fresh} with 15, {movements = 20: parabola-40x40-medium nupe_fresh} with 20 and \
    {movements = 30: parabola-40x40-medium nupe_fresh} with 30; on its sinusoid \
    {movements = 10: sinusoidal-40x40-medium nupe_fresh}, {movements = 15: sinusoidal-40x40-medium nupe_fresh}, \
    {movements = 20: sinusoidal-40x40-medium nupe_fresh} and {movements = 30: sinusoidal-40x40-medium nupe_fresh}.";

/// The verdict of every printed cell.
type Verdicts = Vec<(Cell, Verdict)>;

impl Leverage {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let root = repository()?;
        let folder = self.out.clone().unwrap_or_else(|| root.join("target/leverage"));
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let records = Arc::new(Records::open(&folder.join("records.jsonl"), Earlier::Resume)?);
        let mut leverage = Measured { seed: self.seed, data_sets: self.data_sets, settings: Vec::new() };
        let (mut experiment, mut base) = ("", Vec::new());
        for setting in settings() {
            if setting.experiment != experiment {
                experiment = setting.experiment;
                base = self.verdicts(&setting, setting.used, &records)?;
            }
            leverage.settings.push(self.changed(&setting, &base, &records)?);
        }
        write(&root.join(LEVERAGE), leverage.json()?)?;
        write(&root.join(PAGE), page_of(&leverage))?;
        write(&root.join(VARIANTS), self.quoted(&records)?.json()?)?;
        say(&format!("written: {PAGE}, {LEVERAGE}, {VARIANTS}"));
        Ok(())
    }

    /// The results at other settings that texts quote.
    fn quoted(&self, records: &Arc<Records>) -> anyhow::Result<Variants> {
        let mut variants = Variants::from_seed(self.seed);
        for experiment in registry()? {
            let text = if experiment.id == "table1" { FEW_MOVEMENTS } else { "" };
            // Every quote of the page names its cell explicitly.
            let of_page = quotes(&(String::new(), Measure::NupeFresh), text)?;
            for (quote, cell) in experiment.explanations.quotes.iter().chain(&of_page) {
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

    fn changed(&self, setting: &Setting, base: &Verdicts, records: &Arc<Records>) -> anyhow::Result<Changed> {
        let turned = |factor: f64| -> anyhow::Result<Vec<Turned>> {
            let value = setting.used * factor;
            say(&format!("{}: {} = {}", setting.experiment, setting.name, shown(value)));
            Ok(turned(base, &self.verdicts(setting, value, records)?))
        };
        let (experiment, name) = (setting.experiment.to_owned(), setting.name.to_owned());
        Ok(Changed { experiment, setting: name, smaller: turned(SMALLER)?, larger: turned(LARGER)? })
    }

    fn verdicts(&self, setting: &Setting, value: f64, records: &Arc<Records>) -> anyhow::Result<Verdicts> {
        let result = self.result(setting, value, |_| true, records)?;
        let of_row = |RowResult { id, measures, .. }| {
            measures.into_iter().filter_map(move |(measure, cell)| Some(((id.clone(), measure), cell.verdict?)))
        };
        Ok(result.rows.into_iter().flat_map(of_row).collect())
    }

    /// The result of the experiment at a setting's value, restricted to the wanted setups.
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
        let plan = Plan { data_sets: Some(self.data_sets), of_comparisons: Some(0), seed: self.seed };
        let mut work = Work::find(&experiments, plan, records)?;
        work.measure(|_| true, records)?;
        summarise(&experiments, &work.outcomes())?.pop().context("one experiment has one result")
    }
}

/// Cells whose verdict changes, with both verdicts.
fn turned(base: &Verdicts, other: &Verdicts) -> Vec<Turned> {
    let both = base.iter().zip(other).filter(|((cell, was), (same, is))| cell == same && was != is);
    both.map(|(((row, measure), was), (_, is))| Turned { row: row.clone(), measure: *measure, was: *was, is: *is })
        .collect()
}

/// The page of documentation: a table for each experiment.
pub(crate) fn page_of(leverage: &Measured) -> String {
    let (data_sets, seed) = (leverage.data_sets, leverage.seed);
    let mut text = format!(
        "# Settings that the paper leaves open, and their influence\n\nGenerated from `cargo xtask leverage --data-sets {data_sets} --seed \
         {seed}`. Each setting is changed by a fifth, one at a time; the\ntable names the printed cells whose verdict changes with it. With so few data \
         sets a cell near the edge of its band may\ndiffer from [reproduction.md](reproduction.md). A regression that was fitted errs less, but not as the paper's:\n[decisions/align-api.md](decisions/align-api.md).\n"
    );
    for of_experiment in settings().chunk_by(|a, b| a.experiment == b.experiment) {
        let rows: Vec<Vec<String>> = of_experiment.iter().map(|setting| row(setting, leverage.of(setting))).collect();
        let header = ["setting", "class", "the paper says", "used", "a fifth less changes", "a fifth more changes"];
        let _ = write!(text, "\n## `{}`\n\n{}", of_experiment[0].experiment, markdown_table(&header, &rows));
    }
    text
}

fn row(setting: &Setting, changed: Option<&Changed>) -> Vec<String> {
    let named = |turned: &[Turned]| match turned {
        [] => "–".to_owned(),
        _ => turned.iter().map(Turned::named).collect::<Vec<_>>().join("; "),
    };
    let [smaller, larger] = changed.map_or_else(Default::default, |c| [&c.smaller, &c.larger].map(|t| named(t)));
    vec![
        setting.name.to_owned(),
        setting.class.name().to_owned(),
        setting.paper.to_owned(),
        setting.shown(),
        smaller,
        larger,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every setting's recorded value equals the experiment's: the parameters are identical to the last digit.
    #[test]
    fn recorded_settings_match_the_experiments() {
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
    fn errors_with_few_movements_are_quoted_as_measured() {
        let page = std::fs::read_to_string(repository().unwrap().join("docs/which-learner.md")).unwrap();
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        let own = (String::new(), Measure::Nupe);
        let quoted = Variants::committed().unwrap().filled("table1", &own, FEW_MOVEMENTS).unwrap();
        assert!(page.contains(&quoted), "docs/which-learner.md does not say: {quoted}");
    }

    #[test]
    fn cells_that_turn_are_named() {
        let cell = |verdict| vec![(("narrow".to_owned(), Measure::Nupe), verdict)];
        assert_eq!(turned(&cell(Verdict::Agrees), &cell(Verdict::Agrees)), Vec::new());
        let (narrow, measure) = ("narrow".to_owned(), Measure::Nupe);
        let lower = Turned { row: narrow, measure, was: Verdict::Agrees, is: Verdict::Lower };
        assert_eq!(turned(&cell(Verdict::Agrees), &cell(Verdict::Lower)), std::slice::from_ref(&lower));
        let setting = &settings()[0];
        let (experiment, name) = (setting.experiment.to_owned(), setting.name.to_owned());
        let changed = Changed { experiment, setting: name, smaller: vec![lower], larger: vec![] };
        assert_eq!(row(setting, Some(&changed))[4..], ["narrow nUPE: agrees → lower", "–"]);
    }

    #[test]
    fn the_page_shows_what_was_measured() {
        let written = std::fs::read_to_string(repository().unwrap().join(PAGE)).unwrap();
        assert_eq!(written, page_of(&Measured::committed().unwrap()));
    }
}
