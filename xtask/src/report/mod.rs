//! `cargo xtask report`: draws the figures of a finished run and writes its report, from what the run left behind.

mod compared;
mod legend;
mod markdown;
mod page;
mod tally;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::Args;
use rayon::prelude::*;

use crate::experiments::{Experiment, registry};
use crate::figures::{Drawing, Figure, Sources, figures};
use crate::files::{folder_of_records, write};
use crate::progress::say;
use crate::results::Results;

pub(crate) use markdown::markdown;
pub(crate) use tally::Tally;

#[derive(Debug, Args)]
pub(crate) struct Report {
    /// Folder of a finished run [default: target/reproduce, or if nothing was run yet, the committed records]
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
    /// Folder for report.html, report.md and figures/ [default: the run's own, for committed records target/report]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Report {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let experiments = registry()?;
        let (from, out) = self.folders()?;
        let sources = sources(&from)?;
        let second = results_of_another_seed(&sources.results)?;
        write_report(&experiments, &sources, second.as_ref(), &out)?;
        say(&format!("from {}: {}", from.display(), written(&out, &["report.md", "figures/"])));
        Ok(())
    }

    /// Where to read and where to write.
    fn folders(&self) -> anyhow::Result<(PathBuf, PathBuf)> {
        let of_run = PathBuf::from("target/reproduce");
        if let Some(from) = &self.from {
            return Ok((from.clone(), self.out.clone().unwrap_or_else(|| from.clone())));
        }
        if of_run.join("results.json").exists() {
            return Ok((of_run.clone(), self.out.clone().unwrap_or(of_run)));
        }
        let committed = folder_of_records(1);
        if !committed.join("results.json").exists() {
            bail!("nothing was run yet; run `cargo xtask reproduce` first");
        }
        say("nothing was run here yet: this report is of the committed records");
        Ok((committed, self.out.clone().unwrap_or_else(|| PathBuf::from("target/report"))))
    }
}

/// Where to find the report and what else was written.
pub(crate) fn written(out: &Path, besides: &[&str]) -> String {
    format!("written to {}: report.html (open it in a browser), {}", out.display(), besides.join(", "))
}

/// Reads what a run left in its folder.
pub(crate) fn sources(folder: &Path) -> anyhow::Result<Sources> {
    let results = Results::read(&folder.join("results.json"))?;
    let mut documents = BTreeMap::new();
    for document in crate::figures::documents() {
        let path = folder.join(format!("figures/{}.json", document.id));
        if path.exists() {
            let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
            let value = serde_json::from_str(&text).with_context(|| format!("{} is not JSON", path.display()))?;
            documents.insert(document.id.to_owned(), value);
        }
    }
    Ok(Sources { results, documents })
}

/// The committed results of a seed other than this run's, to hold beside it; none for a quick run.
fn results_of_another_seed(results: &Results) -> anyhow::Result<Option<Results>> {
    let other = if results.seed == 2 { 1 } else { 2 };
    let path = folder_of_records(other).join("results.json");
    if results.quick || !path.exists() {
        return Ok(None);
    }
    Results::read(&path).map(Some)
}

/// Draws every figure that there are numbers for.
pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Vec<(Figure, Drawing)>> {
    let drawn = |figure: Figure| Ok(figure.draw(sources)?.map(|drawing| (figure, drawing)));
    let drawn: Vec<_> = figures().into_par_iter().map(drawn).collect::<anyhow::Result<_>>()?;
    Ok(drawn.into_iter().flatten().collect())
}

/// Writes `report.html`, `report.md` and `figures/`.
pub(crate) fn write_report(
    experiments: &[Experiment],
    sources: &Sources,
    second: Option<&Results>,
    out: &Path,
) -> anyhow::Result<()> {
    let folder = out.join("figures");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let written = |(figure, drawing): (Figure, Drawing)| {
        let path = |ending: &str| folder.join(format!("{}{ending}", figure.id));
        let svg = drawing.picture.svg();
        write(&path(".svg"), &svg)?;
        write(&path(".png"), drawing.picture.png()?)?;
        for table in &drawing.tables {
            write(&path(&format!("-{}.csv", table.name)), table.text())?;
        }
        Ok((figure, svg))
    };
    let figures = draw(sources)?.into_par_iter().map(written).collect::<anyhow::Result<_>>()?;
    let contents = page::Contents { experiments, sources, second, figures };
    write(&out.join("report.html"), page::page(&contents))?;
    write(&out.join("report.md"), markdown(experiments, &sources.results, second))
}
