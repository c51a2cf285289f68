//! Values that flags of several commands take: numbers, a robot.

use std::path::Path;

use crate::cli::failure::Failure;

/// The text of a robot's URDF.
pub(crate) fn urdf(path: &Path) -> Result<String, Failure> {
    demo_io::read_text(path).map_err(|error| Failure::reading(path, error))
}

/// Parses numbers separated by commas, such as a state.
pub(crate) fn numbers(text: &str, flag: &str) -> Result<Vec<f64>, Failure> {
    let numbers = text.split(',').map(|number| number.trim().parse());
    let numbers: Result<Vec<f64>, _> = numbers.collect();
    let what = || format!("'{text}' is not a list of numbers, separated by commas");
    numbers.map_err(|_| Failure::usage(what(), flag, format!("{flag} 0.3,1.2")))
}
