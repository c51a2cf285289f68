//! `cargo xtask report`: draws the figures of a finished run and writes its report, from the run's files.

use std::path::PathBuf;

use clap::Args;
use experiments::results::Results;
use experiments::{Experiment, registry};
use figures::{Drawing, Figure, Sources, draw, drawn_in_part, figures, undrawn};
use rayon::prelude::*;
use report::{Contents, markdown, page};

use crate::failure::Failure;
use crate::files::{relative, repository, write};
use crate::progress::say;
use crate::run_folder::RunFolder;

#[derive(Debug, Args)]
pub(crate) struct Report {
    /// Folder of a finished run [default: target/reproduce in the repository, or the committed records if there is none]
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
    /// Folder for report.html, report.md and figures/ [default: the run's own; for committed records target/report]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Report {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let experiments = registry()?;
        let from = self.from()?;
        let out = self.out(&from)?;
        let sources = from.sources()?;
        sources.results.check_known(&experiments)?;
        if !sources.missing.is_empty() {
            say(&missing(&sources, &from));
        }
        write_report(&experiments, &sources, &out)?;
        say(&written(&out));
        Ok(())
    }

    /// The folder to read.
    fn from(&self) -> Result<RunFolder, Failure> {
        if let Some(from) = &self.from {
            return Ok(RunFolder::at(from));
        }
        let latest = RunFolder::of_latest_run()?;
        if latest.is_finished() {
            return Ok(latest);
        }
        say("no run here yet: this report is of the committed records");
        RunFolder::committed(1)
    }

    /// The folder to write.
    fn out(&self, from: &RunFolder) -> Result<RunFolder, Failure> {
        Ok(match &self.out {
            Some(out) => RunFolder::at(out),
            None if from.is_committed() => RunFolder::at(&repository()?.join("target/report")),
            None => from.clone(),
        })
    }
}

/// Names the files to open.
pub(crate) fn written(out: &RunFolder) -> String {
    let [page, text, figures] = ["report.html", "report.md", "figures"].map(|name| relative(&out.join(name)));
    format!("written: {page} (open it in a browser),\n         {text}, {figures}")
}

/// Names the figures that cannot be drawn, and the remedy.
fn missing(sources: &Sources, from: &RunFolder) -> String {
    let ids = |figures: &[Figure]| figures.iter().map(|figure| figure.id).collect::<Vec<_>>().join(", ");
    let (undrawn, in_part) = (undrawn(sources), drawn_in_part(sources));
    let what = match (undrawn.is_empty(), in_part.is_empty()) {
        (false, false) => format!("not drawn: {}; drawn in part: {}", ids(&undrawn), ids(&in_part)),
        (true, false) => format!("drawn in part: {}", ids(&in_part)),
        _ => format!("not drawn: {}", ids(&undrawn)),
    };
    format!(
        "{what}: the run has no figure data {}; `{}` computes them",
        sources.missing.join(", "),
        from.command(&sources.results)
    )
}

/// The committed results of a different seed, for comparison; `None` for a quick run.
fn results_of_another_seed(results: &Results) -> Option<Results> {
    let other = RunFolder::committed(if results.seed == 2 { 1 } else { 2 }).ok()?;
    if results.quick || !other.is_finished() {
        return None;
    }
    let other = other.results().map_err(|error| say(&format!("shown without the committed run: {error:#}")));
    other.ok()
}

/// Writes `report.html`, `report.md` and `figures/`.
pub(crate) fn write_report(experiments: &[Experiment], sources: &Sources, out: &RunFolder) -> anyhow::Result<()> {
    let drawn = draw(sources)?;
    out.make()?;
    figures().iter().filter(|figure| !figure.can_be_drawn(sources)).try_for_each(|figure| out.forget(figure))?;
    let keep = |(figure, drawing): (Figure, Drawing)| {
        let path = |ending: &str| out.join(&format!("figures/{}{ending}", figure.id));
        let svg = drawing.picture.svg();
        write(&path(".svg"), &svg)?;
        write(&path(".png"), drawing.picture.png()?)?;
        for table in &drawing.tables {
            write(&path(&format!("-{}.csv", table.name)), table.text())?;
        }
        Ok((figure, svg))
    };
    let figures = drawn.into_par_iter().map(keep).collect::<anyhow::Result<_>>()?;
    let second = results_of_another_seed(&sources.results);
    let contents = Contents { experiments, sources, second: second.as_ref(), figures };
    write(&out.join("report.html"), page(&contents))?;
    write(&out.join("report.md"), markdown(experiments, &sources.results, second.as_ref()))
}

/// Writes `report.md` alone.
pub(crate) fn write_tables(experiments: &[Experiment], results: &Results, out: &RunFolder) -> anyhow::Result<()> {
    let second = results_of_another_seed(results);
    write(&out.join("report.md"), markdown(experiments, results, second.as_ref()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn committed_records_are_never_written_to_unasked() {
        let report = |from: PathBuf, out: Option<PathBuf>| {
            let report = Report { from: Some(from), out };
            report.out(&report.from().unwrap()).unwrap()
        };
        let target = repository().unwrap().join("target/report");
        let committed = repository().unwrap().join("docs/records/seed-1");
        assert_eq!(report(committed.clone(), None), RunFolder::at(&target));
        assert_eq!(report(committed.join("../seed-2"), None), RunFolder::at(&target));
        assert_eq!(report(committed.clone(), Some(committed.clone())), RunFolder::at(&committed));
        assert_eq!(report("elsewhere".into(), None), RunFolder::at("elsewhere".as_ref()));
    }
}
