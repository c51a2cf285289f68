//! Fixes a model's context to the one that `--context` chooses.

use policy_align::Model;

use crate::cli::describe::context_flag;
use crate::cli::failure::Failure;

/// Parses NAME=NUMBER pairs.
fn named_numbers(pairs: &[String], flag: &str) -> Result<Vec<(String, f64)>, Failure> {
    let pair = |text: &str| {
        let pair = text.split_once('=').and_then(|(name, number)| Some((name.to_owned(), number.trim().parse().ok()?)));
        pair.ok_or_else(|| Failure::usage(format!("'{text}' is not NAME=NUMBER"), flag, format!("{flag} goal_x=0.4")))
    };
    pairs.iter().flat_map(|text| text.split(',')).map(pair).collect()
}

/// The model in the given context, if any.
pub(crate) fn in_context(model: Model, pairs: &[String]) -> Result<Model, Failure> {
    if pairs.is_empty() {
        return Ok(model);
    }
    let context = model.in_named_context(&named_numbers(pairs, "--context")?);
    context.map_err(|error| {
        let flag = context_flag(&model);
        let remedy = if flag.is_empty() { "no --context" } else { flag.trim() };
        Failure::usage(error.to_string(), "--context", remedy)
    })
}

/// Refuses a model with an open context.
pub(crate) fn chosen_context(model: &Model) -> Result<(), Failure> {
    if model.open_context().is_empty() {
        return Ok(());
    }
    let what = format!("the policy depends on {}: a number is needed for each", model.context_names().join(", "));
    Err(Failure::usage(what, "--context, which is not given", format!("for example{}", context_flag(model))))
}
