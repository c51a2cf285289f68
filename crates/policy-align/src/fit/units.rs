//! Finds the unit of each channel if the constraints imply another than the recorded one.

use std::f64::consts::PI;

use gp::{AutoFit, Hypothesis, LearntScales, PushTest, Rows, SlopeGp};
use motion::{Decision, Subject, standard_deviation, upper_median};
use nalgebra::DVector;
use prepare::numbers::squared_error;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::options::{FitOptions, LearnerChoice};
use crate::{FitError, Prepared};

/// Ratios of usual units: metres, centimetres and millimetres; radians and degrees.
const LENGTHS: [f64; 3] = [1.0, 100.0, 1000.0];
const ANGLES: [f64; 2] = [1.0, 180.0 / PI];
/// Usual units are also tried if the logarithms of their factors differ by less from those that were learnt: noise blurs learnt units.
const BLURRED: f64 = 1.0;
/// So are those that make the spreads of the channels similar, to such a logarithm, if they differ from those recorded by this factor: a
/// joint that moves no constraint has no learnt unit.
const SIMILAR: f64 = 2.0;
const MIXED: f64 = 50.0;
/// Units must leave at most this share of the left-out error in those recorded. Where constraints act on groups of channels, a factor
/// between the groups changes the error a little, by chance.
const LEFT: f64 = 0.5;

/// Units that the constraints imply or that are usual, as factors on the channels, (n) each; none if the user chose the units, or if they hardly matter.
pub(super) fn candidates(
    prepared: &Prepared,
    rows: &Rows,
    readings: &AutoFit,
    options: &FitOptions,
) -> Result<Vec<DVector<f64>>, FitError> {
    let reading = options.reading.unwrap_or(readings.reading());
    let constrained = !matches!(reading, Hypothesis::Free | Hypothesis::TooFew);
    let report = readings.slope().report();
    // With a robot, the joints' own units are those in which its links keep constraints.
    if !prepared.given_scales.is_empty()
        // Free motion shows the policy in any unit.
        || readings.numbers().free.is_some()
        || report.task_space.is_some()
        || !constrained
        || report.is_nearly_exact()
        || options.learner == LearnerChoice::Direct
    {
        return Ok(Vec::new());
    }
    let family = report.family;
    let (families, push_test) = (vec![family], PushTest::Fit);
    let gp = SlopeGp { families, push_test, max_rows: options.max_rows, ..SlopeGp::default() };
    let learnt = gp.learn_scales(rows, &mut ChaCha8Rng::seed_from_u64(options.seed))?;
    let learnt = learnt.map(|LearntScales { factors, .. }| DVector::from_vec(factors).map(in_short));
    let states = rows.states();
    let spread = |axis| standard_deviation(states.row(axis).iter().copied());
    let alike = DVector::from_fn(prepared.state.len(), |axis, _| spread(axis).recip());
    let similar = usual_units_near(&alike, SIMILAR).into_iter().filter(|usual| usual.max() > MIXED * usual.min());
    let near = learnt.iter().flat_map(|learnt| usual_units_near(learnt, BLURRED));
    let recorded = DVector::repeat(prepared.state.len(), 1.0);
    let mut distinct: Vec<DVector<f64>> = Vec::new();
    for factors in near.chain(similar).chain(learnt.clone()) {
        if factors != recorded && !distinct.contains(&factors) {
            distinct.push(factors);
        }
    }
    Ok(distinct)
}

fn rescaled(prepared: &Prepared, factors: &DVector<f64>, options: &FitOptions) -> Result<Prepared, FitError> {
    let rescaled = prepared.rescaled(factors)?;
    if rescaled.context.is_empty() { Ok(rescaled) } else { super::context::comparable(&rescaled, options) }
}

/// Largest number of rows for which a fit is kept while another is made.
const KEPT: usize = 20_000;

/// The `recorded` movements with their fit, or those in a candidate's units with a new one, whichever predicts left-out movements best.
/// The search for units uses less information than a whole fit, and rotating constraints mislead it. `None` stands for the recorded units.
pub(super) fn best(
    recorded: &Prepared,
    candidates: Vec<DVector<f64>>,
    options: &FitOptions,
    (rows, readings): (Rows, AutoFit),
    fit: impl Fn(&Prepared) -> Result<(Rows, AutoFit), FitError>,
) -> Result<(Option<Prepared>, Rows, AutoFit), FitError> {
    let error = |readings: &AutoFit| 1.0 - readings.slope().report().r_squared;
    let (as_recorded, all) = (error(&readings), rows.len());
    let (mut least, mut units, mut kept) = (as_recorded, None, Some((rows, readings)));
    for factors in candidates {
        let mut prepared = rescaled(recorded, &factors, options)?;
        if all > KEPT {
            // Two large fits would take twice the memory.
            kept = None;
        }
        let (rows, readings) = fit(&prepared)?;
        let now = error(&readings);
        if now < least.min(LEFT * as_recorded) {
            prepared.decisions.extend(decisions(recorded, &factors, (as_recorded, now)));
            (least, units, kept) = (now, Some(prepared), Some((rows, readings)));
        }
    }
    let (rows, readings) = kept.map_or_else(|| fit(units.as_ref().unwrap_or(recorded)), Ok)?;
    Ok((units, rows, readings))
}

/// The factors rounded to ratios of lengths or of angles, the first being 1, if no logarithm changes by `within` or more.
fn usual_units_near(factors: &DVector<f64>, within: f64) -> Vec<DVector<f64>> {
    let reference = upper_median(factors.as_slice().to_vec()).unwrap_or(1.0);
    let rounded = |units: &[f64]| {
        let ratios: Vec<f64> = units.iter().copied().chain(units.iter().map(|unit| unit.recip())).collect();
        let nearest = |factor: &f64| {
            let off = |ratio: &f64| (factor / reference / ratio).ln().abs();
            ratios.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|ratio| off(ratio) < within)
        };
        let rounded = DVector::from_vec(factors.iter().map(nearest).collect::<Option<Vec<_>>>()?);
        Some((&rounded / rounded[0]).map(in_short))
    };
    [&LENGTHS[..], &ANGLES].into_iter().filter_map(rounded).collect()
}

/// Rounds to four significant digits, so that a user can type the factor.
fn in_short(factor: f64) -> f64 {
    format!("{factor:.3e}").parse().expect("a number that was printed")
}

fn decisions(prepared: &Prepared, factors: &DVector<f64>, (before, after): (f64, f64)) -> Vec<Decision> {
    let why = format!(
        "constraints are at right angles in this unit: error relative to the motion {}, as recorded {}",
        squared_error(after),
        squared_error(before)
    );
    let changed = prepared.state.iter().zip(factors).filter(|(_, factor)| **factor != 1.0);
    changed
        .map(|(channel, factor)| {
            Decision::new(Subject::Scale, format!("{} times {factor}", channel.name), why.as_str())
        })
        .collect()
}
