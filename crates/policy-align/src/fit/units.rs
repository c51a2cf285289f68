//! The unit of each channel, learnt where constraints tell of another than the recorded one.

use gp::{AutoFit, Hypothesis, LearntScales, PushTest, Rows, SlopeGp};
use motion::Decision;
use nalgebra::DVector;
use prepare::numbers::squared_error;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::decision::decision;
use super::options::{FitOptions, LearnerChoice};
use crate::{FitError, Prepared};

/// The movements in the units that the constraints tell of; none if the recorded ones are as good, or the user chose one.
pub(super) fn learnt(
    prepared: &Prepared,
    rows: &Rows,
    readings: &AutoFit,
    options: &FitOptions,
) -> Result<Option<Prepared>, FitError> {
    let chosen = prepared.decisions.iter().any(|decision| decision.flag == "--scale");
    let reading = options.reading.unwrap_or(readings.reading());
    let constrained = !matches!(reading, Hypothesis::Free | Hypothesis::TooFew);
    let report = readings.slope().report();
    // A robot's joints have the units in which its links keep to constraints.
    if chosen
        || report.task_space.is_some()
        || !constrained
        || report.is_nearly_exact()
        || options.learner == LearnerChoice::Direct
    {
        return Ok(None);
    }
    let family = report.family;
    let (families, push_test) = (vec![family], PushTest::Fit);
    let gp = SlopeGp { families, push_test, max_rows: options.max_rows, ..SlopeGp::default() };
    let Some(scales) = gp.learn_scales(rows, &mut ChaCha8Rng::seed_from_u64(options.seed))? else { return Ok(None) };
    let factors = DVector::from_iterator(scales.factors.len(), scales.factors.iter().map(|&factor| in_short(factor)));
    let mut rescaled = prepared.rescaled(&factors).map_err(|error| super::recorded_rows::cleaning(&error))?;
    if !rescaled.context.is_empty() {
        rescaled = super::context::comparable(&rescaled, options)?;
    }
    rescaled.decisions.extend(decisions(prepared, &scales, &factors));
    Ok(Some(rescaled))
}

/// Rows up to which a fit is kept while another is made.
const KEPT: usize = 20_000;

/// The fit of the `recorded` units, made already, or of those `learnt`, whichever predicts left-out movements better: the search for
/// units knows less than a whole fit, and constraints that turn mislead it.
pub(super) fn better<'p>(
    (recorded, learnt): (&'p Prepared, &'p Prepared),
    (rows, readings): (Rows, AutoFit),
    fit: impl Fn(&Prepared) -> Result<(Rows, AutoFit), FitError>,
) -> Result<(&'p Prepared, Rows, AutoFit), FitError> {
    let as_recorded = readings.slope().report().r_squared;
    // Two large ones would take twice the memory.
    let kept = (rows.len() <= KEPT).then_some((rows, readings));
    let (rows, readings) = fit(learnt)?;
    if readings.slope().report().r_squared > as_recorded {
        return Ok((learnt, rows, readings));
    }
    drop((rows, readings));
    let (rows, readings) = kept.map_or_else(|| fit(recorded), Ok)?;
    Ok((recorded, rows, readings))
}

/// With four significant digits, so that it can be typed.
fn in_short(factor: f64) -> f64 {
    format!("{factor:.3e}").parse().expect("a number that was printed")
}

fn decisions(prepared: &Prepared, scales: &LearntScales, factors: &DVector<f64>) -> Vec<Decision> {
    let (before, after) = scales.left_out;
    let why = format!(
        "constraints are at right angles in this unit: error relative to the motion {}, as recorded {}",
        squared_error(after),
        squared_error(before)
    );
    let changed = prepared.state.iter().zip(factors).filter(|(_, factor)| **factor != 1.0);
    changed
        .map(|(channel, factor)| decision("scale", format!("{} times {factor}", channel.name), why.as_str(), "--scale"))
        .collect()
}
