//! Learns the unit of each channel if the constraints imply another than the recorded one.

use gp::{AutoFit, Hypothesis, LearntScales, PushTest, Rows, SlopeGp};
use motion::Decision;
use nalgebra::DVector;
use prepare::numbers::squared_error;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::decision::decision;
use super::options::{FitOptions, LearnerChoice};
use crate::{FitError, Prepared};

/// The movements in the units implied by the constraints; `None` if the recorded units are as good or the user chose one.
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
    // With a robot, the joints' own units are those in which its links keep constraints.
    if chosen
        // Free motion shows the policy in any unit.
        || readings.numbers().free.is_some()
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

/// Largest number of rows for which a fit is kept while another is made.
const KEPT: usize = 20_000;

/// The existing fit in the `recorded` units or a new one in the `learnt` units, whichever predicts left-out movements better. The
/// search for units uses less information than a whole fit, and rotating constraints mislead it.
pub(super) fn better<'p>(
    (recorded, learnt): (&'p Prepared, &'p Prepared),
    (rows, readings): (Rows, AutoFit),
    fit: impl Fn(&Prepared) -> Result<(Rows, AutoFit), FitError>,
) -> Result<(&'p Prepared, Rows, AutoFit), FitError> {
    let as_recorded = readings.slope().report().r_squared;
    // Two large fits would take twice the memory.
    let kept = (rows.len() <= KEPT).then_some((rows, readings));
    let (rows, readings) = fit(learnt)?;
    if readings.slope().report().r_squared > as_recorded {
        return Ok((learnt, rows, readings));
    }
    drop((rows, readings));
    let (rows, readings) = kept.map_or_else(|| fit(recorded), Ok)?;
    Ok((recorded, rows, readings))
}

/// Rounds to four significant digits, so that a user can type the factor.
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
