//! What flags of several commands are given: numbers, a context, a robot.

use std::path::Path;

use policy_align::Model;

use crate::cli::failure::Failure;

/// The text of a robot.
pub(crate) fn urdf(path: &Path) -> Result<String, Failure> {
    demo_io::read_text(path).map_err(|error| Failure::reading(path, error))
}

/// Numbers by name, as a context is given.
fn named_numbers(pairs: &[String], flag: &str) -> Result<Vec<(String, f64)>, Failure> {
    let pair = |text: &str| {
        let pair = text.split_once('=').and_then(|(name, number)| Some((name.to_owned(), number.trim().parse().ok()?)));
        pair.ok_or_else(|| Failure::usage(format!("'{text}' is not NAME=NUMBER"), flag, format!("{flag} goal_x=0.4")))
    };
    pairs.iter().flat_map(|text| text.split(',')).map(pair).collect()
}

/// A model in the context that was given, if any.
pub(crate) fn in_context(model: Model, pairs: &[String]) -> Result<Model, Failure> {
    if pairs.is_empty() {
        return Ok(model);
    }
    let context = model.in_named_context(&named_numbers(pairs, "--context")?);
    context.map_err(|error| {
        let names: Vec<String> = model.context_names().iter().map(|name| format!("{name}=…")).collect();
        let remedy =
            if names.is_empty() { "no --context".to_owned() } else { format!("--context {}", names.join(",")) };
        Failure::usage(error.to_string(), "--context", remedy)
    })
}

/// Numbers with commas between, as a state is given.
pub(crate) fn numbers(text: &str, flag: &str) -> Result<Vec<f64>, Failure> {
    let numbers = text.split(',').map(|number| number.trim().parse());
    let numbers: Result<Vec<f64>, _> = numbers.collect();
    let what = || format!("'{text}' is not a list of numbers, separated by commas");
    numbers.map_err(|_| Failure::usage(what(), flag, format!("{flag} 0.3,1.2")))
}
