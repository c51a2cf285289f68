//! The paper's figures. A run computes documents: plain numbers, stored as `figures/*.json`. Figures are drawn only
//! from documents and results, so that they can be redrawn without a run.

mod agent;
#[cfg(test)]
mod beside_paper;
mod beyond;
mod demonstrated;
mod errors;
mod grasp_playback;
mod miniature;
mod numbered;
mod overview;
mod scene;
mod sound;
mod state_plane;
pub mod view;
mod words;

use std::collections::BTreeMap;

use anyhow::{Context as _, anyhow, bail};
use experiments::Experiment;
use experiments::results::{ExperimentResult, Results};
use plot::Picture;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use sound::Sound;
use words::{Words, words};

use agent::Agent;
pub use agent::color_of;
use numbered::figure8::ALL_AROUND_DOCUMENT;
pub use numbered::figure8::{Ends, ends_of_reaching};

/// Data that a run computes for the figures, from fixed data sets.
pub struct Document {
    /// Name of the file.
    pub id: &'static str,
    /// The experiment that computes it; without one, every run does.
    experiment: Option<&'static str>,
    compute: Box<dyn Fn(u64) -> anyhow::Result<Value> + Sync>,
}

/// A figure of the paper.
pub struct Figure {
    /// Names of the files.
    pub id: &'static str,
    /// The title above the figure in the report.
    pub title: &'static str,
    /// Description of the drawing, true of every run.
    pub caption: &'static str,
    /// Comparison with the paper's figure, if there is one. Statements that depend on the run refer explicitly to the
    /// full run with seed 1, because the text appears in the reports of all runs.
    pub beside_paper: Option<&'static str>,
    /// The difference between the full run and the paper's figure, in one line.
    pub differs: Option<&'static str>,
    /// The experiment beside which the report shows it.
    pub experiment: Option<&'static str>,
    /// Documents and experiments that it requires.
    needs: &'static [&'static str],
    /// Optional documents that add to it.
    also: &'static [&'static str],
    draw: fn(&Sources) -> anyhow::Result<Drawing>,
}

/// A picture, and the numbers of its curves.
pub struct Drawing {
    /// The image.
    pub picture: Picture,
    /// Written as `figures/<figure>-<name>.csv`.
    pub tables: Vec<Csv>,
}

/// A table of numbers for other programs.
pub struct Csv {
    /// Suffix of the file's name.
    pub name: &'static str,
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

/// All data from which figures may be drawn.
pub struct Sources {
    /// Results of the run.
    pub results: Results,
    /// Documents by id.
    pub documents: BTreeMap<String, Value>,
    /// Ids of documents that belong to the run but are missing.
    pub missing: Vec<&'static str>,
}

/// All documents.
pub fn documents() -> Vec<Document> {
    use numbered::{figure_b1, figure1, figure2, figure3, figure4, figure5, figure9};
    vec![
        Document::new("overview", None, overview::overview),
        Document::new("figure1", None, |_| figure1::ready()),
        Document::new("figure2", None, |_| figure2::shown()),
        Document::new("figure3", None, |_| figure3::vectors()),
        Document::new("figure4", None, |_| figure4::hills()),
        Document::new("figure5", None, figure5::compute::levels),
        Document::new("figure9_movements", Some("figure9"), figure9::movements),
        Document::new("figureB1", Some("table1"), figure_b1::coming_apart),
        Document::new("grasp_playback", Some("table2"), grasp_playback::grasp_playback),
        Document::new(ALL_AROUND_DOCUMENT, Some("table2"), grasp_playback::all_around::all_around),
        Document::new("beyond_fields", Some("beyond"), beyond::fields),
    ]
}

/// All figures, in the paper's order.
pub fn figures() -> Vec<Figure> {
    use numbered::{figure_b1, figure1, figure2, figure3, figure4, figure5, figure6, figure7, figure8, figure9};
    vec![
        Figure::new("overview", None, &["overview"], overview::draw),
        Figure::new("figure1", None, &["figure1"], figure1::draw),
        Figure::new("figure2", None, &["figure2"], figure2::draw),
        Figure::new("figure3", None, &["figure3"], figure3::draw),
        Figure::new("figure4", None, &["figure4"], figure4::draw),
        Figure::new("figure5", Some("table1"), &["figure5"], figure5::draw::draw),
        Figure::new("figure6_left", Some("figure6_left"), &["figure6_left"], figure6::draw_left),
        Figure::new("figure6_right", Some("figure6_right"), &["figure6_right"], figure6::draw_right),
        Figure::new("figure7", Some("table2"), &["grasp_playback"], figure7::draw),
        Figure::new("figure8", Some("table2"), &["grasp_playback"], figure8::draw).with(&[ALL_AROUND_DOCUMENT]),
        Figure::new("figure9", Some("figure9"), &["figure9_movements", "figure9"], figure9::draw),
        Figure::new("figureB1", Some("table1"), &["figureB1"], figure_b1::draw),
        Figure::new("beyond", Some("beyond"), &["beyond_fields"], beyond::draw),
    ]
}

/// Computes the documents that belong to these experiments.
///
/// # Errors
/// If a data set cannot be generated or learnt from.
pub fn compute(experiments: &[Experiment], seed: u64) -> anyhow::Result<BTreeMap<String, Value>> {
    let mut wanted = documents();
    wanted.retain(|document| document.experiment.is_none_or(|id| experiments.iter().any(|e| e.id == id)));
    let document = |document: &Document| {
        let value = (document.compute)(seed).with_context(|| format!("figure data {}", document.id))?;
        Ok((document.id.to_owned(), value))
    };
    wanted.par_iter().with_max_len(1).map(document).collect()
}

impl Document {
    /// A document that `compute` generates from a seed.
    fn new<D: Serialize + 'static>(
        id: &'static str,
        experiment: Option<&'static str>,
        compute: fn(u64) -> anyhow::Result<D>,
    ) -> Document {
        Document { id, experiment, compute: Box::new(move |seed| Ok(serde_json::to_value(compute(seed)?)?)) }
    }
}

impl Figure {
    /// A figure with its texts from `crates/paper/figures/words.toml`.
    fn new(
        id: &'static str,
        experiment: Option<&'static str>,
        needs: &'static [&'static str],
        draw: fn(&Sources) -> anyhow::Result<Drawing>,
    ) -> Figure {
        let Words { title, caption, beside_paper, differs } = words(id);
        let (beside_paper, differs) = (beside_paper.as_deref(), differs.as_deref());
        Figure { id, title, caption, beside_paper, differs, experiment, needs, also: &[], draw }
    }

    /// Adds optional documents, which show more if they exist; figure data of older runs lack some.
    fn with(self, also: &'static [&'static str]) -> Figure {
        Figure { also, ..self }
    }

    /// Whether everything that it requires was run.
    pub fn can_be_drawn(&self, sources: &Sources) -> bool {
        let there = |id: &&str| sources.documents.contains_key(*id) || sources.experiment(id).is_some();
        self.needs.iter().all(there)
    }

    /// Whether it cannot be drawn only because documents are missing.
    fn misses(&self, sources: &Sources) -> bool {
        !self.can_be_drawn(sources) && self.needs.iter().any(|id| sources.missing.contains(id))
    }

    /// Whether it is drawn only in part because documents are missing.
    fn is_drawn_in_part(&self, sources: &Sources) -> bool {
        self.can_be_drawn(sources) && self.also.iter().any(|id| sources.missing.contains(id))
    }

    /// Draws it; returns `None` if something that it requires was not run.
    fn draw(&self, sources: &Sources) -> anyhow::Result<Option<Drawing>> {
        if !self.can_be_drawn(sources) {
            return Ok(None);
        }
        (self.draw)(sources).with_context(|| format!("{} cannot be drawn", self.id)).map(Some)
    }
}

/// Draws every figure whose data exist.
///
/// # Errors
/// If a document is damaged.
pub fn draw(sources: &Sources) -> anyhow::Result<Vec<(Figure, Drawing)>> {
    let drawn = |figure: Figure| Ok(figure.draw(sources)?.map(|drawing| (figure, drawing)));
    let drawn: Vec<_> = figures().into_par_iter().map(drawn).collect::<anyhow::Result<_>>()?;
    Ok(drawn.into_iter().flatten().collect())
}

/// Figures that are not drawn only because their documents are missing.
pub fn undrawn(sources: &Sources) -> Vec<Figure> {
    figures().into_iter().filter(|figure| figure.misses(sources)).collect()
}

/// Figures that are drawn only in part because documents are missing.
pub fn drawn_in_part(sources: &Sources) -> Vec<Figure> {
    figures().into_iter().filter(|figure| figure.is_drawn_in_part(sources)).collect()
}

impl Sources {
    /// Results, and those of their documents that `read` finds by id.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn of(results: Results, read: impl Fn(&str) -> anyhow::Result<Option<Value>>) -> anyhow::Result<Sources> {
        let mut sources = Sources { results, documents: BTreeMap::new(), missing: vec![] };
        for document in documents() {
            if let Some(found) = read(document.id)? {
                sources.documents.insert(document.id.to_owned(), found);
            } else if document.experiment.is_none_or(|id| sources.experiment(id).is_some()) {
                sources.missing.push(document.id);
            }
        }
        Ok(sources)
    }

    /// The results of one experiment.
    pub fn experiment(&self, id: &str) -> Option<&ExperimentResult> {
        self.results.experiment(id)
    }

    /// A document; an error if it is missing or damaged.
    fn document<D: DeserializeOwned + Sound>(&self, id: &str) -> anyhow::Result<D> {
        const AGAIN: &str = "the command of its run writes it again";
        let value = self.documents.get(id).with_context(|| format!("figure data {id} is missing"))?;
        if let Some(number) = sound::beyond(value, D::LARGEST) {
            bail!("figure data {id} is damaged: it holds the number {number:e}; {AGAIN}");
        }
        let document = D::deserialize(value)
            .with_context(|| format!("figure data {id} is damaged or has another form; {AGAIN}"))?;
        document.check().map_err(|error| anyhow!("figure data {id} is damaged: {error:#}; {AGAIN}"))?;
        Ok(document)
    }
}

impl Csv {
    /// Formats the table as comma-separated values; a value that is not finite becomes an empty cell.
    pub fn text(&self) -> String {
        let cell = |value: &f64| if value.is_finite() { value.to_string() } else { String::new() };
        let row = |row: &Vec<f64>| row.iter().map(cell).collect::<Vec<_>>().join(",") + "\n";
        self.header.join(",") + "\n" + &self.rows.iter().map(row).collect::<String>()
    }
}

/// Rounds to this many decimals, because documents store only what is visible.
fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale
}
