//! What the estimators' parameters mean to the library.

use align::Bandwidth;
use gp::Hypothesis;
use policy_align::{FitOptions, LearnerChoice, PrepareOptions, Repair, VelocityUse};
use pyo3::prelude::*;

use crate::refusal::Refusal;

/// A number, or a word in its place.
#[derive(Debug, FromPyObject)]
pub(crate) enum NumberOrWord {
    Number(f64),
    Word(String),
}

/// How recordings are prepared: items of a dictionary.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Preparing {
    scale: Vec<(String, f64)>,
    integration: String,
    smooth: String,
    jumps: String,
    wraps: String,
}

/// How a policy is learnt: items of a dictionary.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Learning {
    learner: String,
    reading: Option<String>,
    bandwidth: NumberOrWord,
    init_d: NumberOrWord,
    folds: usize,
    max_rows: usize,
    seed: u64,
}

impl Preparing {
    pub(crate) fn options(self) -> Result<PrepareOptions, Refusal> {
        let velocities = match self.integration.as_str() {
            "auto" => VelocityUse::Auto,
            "velocity" => VelocityUse::Recorded,
            "displacement" => VelocityUse::Ignored,
            other => return Err(unknown(other, "integration", "\"auto\", \"velocity\" or \"displacement\"")),
        };
        let smoothing = self.smooth.parse();
        let smoothing = smoothing.map_err(|what: String| {
            Refusal::new(what, "smooth", "smooth=\"auto\", \"off\", 9 (samples) or \"0.2s\"")
        })?;
        let (jumps, wraps) = (repair(&self.jumps, "jumps")?, repair(&self.wraps, "wraps")?);
        Ok(PrepareOptions { scale: self.scale, time_step: None, velocities, smoothing, jumps, wraps })
    }
}

impl Learning {
    pub(crate) fn options(self) -> Result<FitOptions, Refusal> {
        Ok(FitOptions {
            learner: match self.learner.as_str() {
                "policy_align" => LearnerChoice::PolicyAlign,
                "slope" => LearnerChoice::Slope,
                "direct" => LearnerChoice::Direct,
                _ => LearnerChoice::Auto,
            },
            reading: match self.reading.as_deref() {
                None => None,
                Some("free") => Some(Hypothesis::Free),
                Some("constrained") => Some(Hypothesis::Constrained),
                Some(other) => return Err(unknown(other, "reading", "None, \"free\" or \"constrained\"")),
            },
            bandwidth: match &self.bandwidth {
                NumberOrWord::Word(word) => match word.as_str() {
                    "auto" => None,
                    "narrow" => Some(Bandwidth::Narrow),
                    "medium" => Some(Bandwidth::Medium),
                    "wide" => Some(Bandwidth::Wide),
                    _ => return Err(no_number(word, "bandwidth")),
                },
                NumberOrWord::Number(number) => Some(Bandwidth::Fixed(positive(*number, "bandwidth")?)),
            },
            init_d: match &self.init_d {
                NumberOrWord::Word(word) if word == "auto" => None,
                NumberOrWord::Word(word) => return Err(no_number(word, "init_d")),
                NumberOrWord::Number(number) => Some(positive(*number, "init_d")?),
            },
            folds: self.folds,
            seed: self.seed,
            max_rows: self.max_rows,
        })
    }
}

fn repair(word: &str, name: &str) -> Result<Repair, Refusal> {
    match word {
        "auto" => Ok(Repair::Auto),
        "keep" => Ok(Repair::Keep),
        other => Err(unknown(other, name, "\"auto\" or \"keep\"")),
    }
}

fn positive(number: f64, name: &str) -> Result<f64, Refusal> {
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err(no_number(&number.to_string(), name)) }
}

fn no_number(given: &str, name: &str) -> Refusal {
    Refusal::new(format!("'{given}' is no positive number"), name, format!("{name}=\"auto\""))
}

fn unknown(given: &str, name: &str, known: &str) -> Refusal {
    Refusal::new(format!("'{given}' is none of the choices"), name, known)
}
