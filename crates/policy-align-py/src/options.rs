//! Converts the estimators' parameters to the library's options.

use align::Bandwidth;
use policy_align::{Choice, ContextUse, FitOptions, PrepareOptions};
use pyo3::prelude::*;

use crate::refusal::Refusal;

/// A number, or a word in place of it.
#[derive(Debug, FromPyObject)]
pub(crate) enum NumberOrWord {
    Number(f64),
    Word(String),
}

/// Names, or a word in place of them.
#[derive(Debug, FromPyObject)]
pub(crate) enum NamesOrWord {
    Word(String),
    Names(Vec<String>),
}

/// Options for preparing recordings: items of a dictionary.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Preparing {
    scale: Vec<(String, f64)>,
    integration: String,
    smooth: String,
    jumps: String,
    wraps: String,
    context: NamesOrWord,
}

/// Options for learning: items of a dictionary.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Learning {
    learner: String,
    reading: Option<String>,
    bandwidth: NumberOrWord,
    init_d: NumberOrWord,
    folds: usize,
    max_rows: usize,
    inducing: usize,
    robot: Option<String>,
    seed: u64,
}

impl Preparing {
    /// `context`: the channels that were read as context.
    pub(crate) fn options(self, context: &[String]) -> Result<PrepareOptions, Refusal> {
        let context = match self.context {
            NamesOrWord::Names(names) => ContextUse::Named(names),
            NamesOrWord::Word(word) if word == "none" => ContextUse::Ignored,
            NamesOrWord::Word(word) if word != "auto" => ContextUse::Named(vec![word]),
            NamesOrWord::Word(_) if context.is_empty() => ContextUse::Auto,
            NamesOrWord::Word(_) => ContextUse::Named(context.to_vec()),
        };
        let velocities = chosen(&self.integration, "integration", "")?;
        let smoothing = self.smooth.parse();
        let smoothing = smoothing.map_err(|what: String| {
            Refusal::new(what, "smooth", "smooth=\"auto\", \"off\", 9 (samples) or \"0.2s\"")
        })?;
        let (jumps, wraps) = (chosen(&self.jumps, "jumps", "")?, chosen(&self.wraps, "wraps", "")?);
        let scale = self.scale;
        Ok(PrepareOptions { scale, velocities, smoothing, jumps, wraps, context, ..PrepareOptions::default() })
    }
}

impl Learning {
    pub(crate) fn options(self) -> Result<FitOptions, Refusal> {
        Ok(FitOptions {
            learner: chosen(&self.learner.replace('_', "-"), "learner", "")?,
            reading: self.reading.as_deref().map(|word| chosen(word, "reading", "None, ")).transpose()?,
            bandwidth: match &self.bandwidth {
                NumberOrWord::Word(word) if word == "auto" => None,
                NumberOrWord::Word(word) => Some(Bandwidth::of(word).ok_or_else(|| no_number(word, "bandwidth"))?),
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
            inducing: self.inducing,
            robot: self.robot,
        })
    }
}

/// The choice for a word; `or` begins the list of alternatives in the error.
fn chosen<C: Choice>(word: &str, name: &str, or: &str) -> Result<C, Refusal> {
    let hint = || format!("{or}{}", C::listed("\""));
    C::of(word).ok_or_else(|| Refusal::new(format!("'{word}' is none of the choices"), name, hint()))
}

fn positive(number: f64, name: &str) -> Result<f64, Refusal> {
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err(no_number(&number.to_string(), name)) }
}

fn no_number(given: &str, name: &str) -> Refusal {
    Refusal::new(format!("'{given}' is not a positive number"), name, format!("{name}=\"auto\""))
}
