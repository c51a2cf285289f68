//! Checks of numbers.

use super::problem::{LARGEST, UrdfProblem};

/// The number, which must be finite. `attribute` is `tag.attribute`.
pub(super) fn finite(attribute: &'static str, value: f64) -> Result<f64, UrdfProblem> {
    if value.is_finite() { Ok(value) } else { Err(UrdfProblem::NotFinite { attribute, text: value.to_string() }) }
}

/// The number, which must be finite and no larger than [`LARGEST`].
pub(crate) fn bounded(attribute: &'static str, value: f64) -> Result<f64, UrdfProblem> {
    let value = finite(attribute, value)?;
    if value.abs() <= LARGEST { Ok(value) } else { Err(UrdfProblem::TooLarge { attribute, value }) }
}

/// A length that is bounded and not negative; −0 becomes 0.
pub(super) fn size(attribute: &'static str, value: f64) -> Result<f64, UrdfProblem> {
    let value = bounded(attribute, value)?;
    if value < 0.0 { Err(UrdfProblem::NegativeSize { attribute, value }) } else { Ok(value.abs()) }
}

/// Applies a check to each of several numbers.
pub(super) fn each<const N: usize>(
    attribute: &'static str,
    values: [f64; N],
    check: fn(&'static str, f64) -> Result<f64, UrdfProblem>,
) -> Result<[f64; N], UrdfProblem> {
    let mut checked = values;
    for value in &mut checked {
        *value = check(attribute, *value)?;
    }
    Ok(checked)
}
