//! Tries families and rotation in sequence: steps 3 to 9 of a fit.

use rayon::prelude::*;

use crate::GpError;
use crate::evidence::family_fit::each_until_exact;
use crate::kernel::family::Family;
use crate::left_out::curl_test::{CurlTest, curl_t, takes_rotation};
use crate::left_out::weights_test::{weights_cost, weights_pay, weights_t};
use crate::report::trust_report::{FamilyReport, ModelKind};
use crate::rows::kept::Kept;
use crate::rows::noise_weights::{certain_weights, slope_weights};
use crate::slope::candidate::Candidate;
use crate::slope::data::SlopeData;
use crate::slope::least_hidden::least_hidden;
use crate::slope::slope_gp::SlopeGp;

/// First guess of the policy's length, in root mean squares of the observed speeds.
const HIDDEN: f64 = 1.3;
/// Number of times that noise weights are computed again from a policy with rotation.
const ROUNDS: usize = 3;
/// Models whose error on some rows is at most this multiple of the least may be the best on more rows.
pub(super) const NEARLY: f64 = 4.0;

/// The selected model, the other one, and all fits.
pub(crate) struct SlopeOutcome {
    pub(crate) data: SlopeData,
    pub(crate) taken: Candidate,
    pub(crate) other: Option<Candidate>,
    pub(crate) curl_t: Option<f64>,
    pub(crate) families: Vec<FamilyReport>,
    /// Whether step 8 selected the model.
    pub(crate) least_hidden: bool,
}

/// The search: steps 3 to 8, and step 9, which weights certain velocities if they are not predicted nearly exactly.
pub(crate) fn outcome(gp: &SlopeGp, kept: &Kept) -> Result<SlopeOutcome, GpError> {
    let alike = search_with_weights(gp, kept, data_with_noise_weights(gp, kept)?)?;
    if kept.variances.is_some() || kept.of_stretches.is_some() || alike.taken.left_out.is_nearly_exact() {
        return Ok(alike);
    }
    Ok(search_with_speed_weights(gp, kept, &alike)?.unwrap_or(alike))
}

/// Steps 5 to 8 with given noise weights.
fn search_with_weights(gp: &SlopeGp, kept: &Kept, data: SlopeData) -> Result<SlopeOutcome, GpError> {
    let mut families = Vec::new();
    let tried = each_until_exact(
        &gp.families,
        |family| candidate(gp, &data, kept, family, ModelKind::Potential),
        |candidate| &candidate.left_out,
    );
    let potential = best_of(tried.into_iter(), ModelKind::Potential, &mut families).ok_or(GpError::NoFactor)?;
    let Some(rotation) = rotation(gp, &data, kept, &potential, &mut families) else {
        return Ok(SlopeOutcome { data, taken: potential, other: None, curl_t: None, families, least_hidden: false });
    };
    choose_rotation(gp, kept, data, (Some(potential), rotation), families)
}

/// Steps 7 and 8 for the best models with a potential, if any, and with rotation.
fn choose_rotation(
    gp: &SlopeGp,
    kept: &Kept,
    data: SlopeData,
    (potential, rotation): (Option<Candidate>, Candidate),
    mut families: Vec<FamilyReport>,
) -> Result<SlopeOutcome, GpError> {
    let t = potential.as_ref().map(|potential| {
        curl_t(&potential.left_out, &rotation.left_out, &data.targets.noise_weights, &data.targets.groups)
    });
    let rotates = match (&potential, t) {
        (Some(potential), Some(t)) => takes_rotation(t, &potential.contender(), &rotation.contender()),
        _ => true,
    };
    let (data, rotation) = if rotates { reweighted(gp, kept, data, rotation)? } else { (data, rotation) };
    let hides_least = least_hidden(&data, kept, potential.as_ref(), &rotation);
    families.extend(hides_least.as_ref().map(Candidate::report));
    let least_hidden = hides_least.is_some();
    let (taken, other) = match (hides_least, potential) {
        (Some(hides_least), potential) => (hides_least, potential),
        (None, Some(potential)) if !rotates => (potential, Some(rotation)),
        (None, potential) => (rotation, potential),
    };
    Ok(SlopeOutcome { data, taken, other, curl_t: t, families, least_hidden })
}

/// The search on more rows of stretches than `fewer`, restricted to the models that were nearly the best there.
pub(crate) fn outcome_of_nearly_best(gp: &SlopeGp, kept: &Kept, fewer: &SlopeOutcome) -> Result<SlopeOutcome, GpError> {
    let data = data_with_noise_weights(gp, kept)?;
    let nearly_best = nearly_best(fewer.families.iter(), NEARLY);
    let mut families = Vec::new();
    let mut best = |kind| {
        let is_one =
            |family: &Family| nearly_best.iter().any(|report| (report.family, report.model) == (*family, kind));
        let tried: Vec<Family> = Family::ALL.into_iter().filter(is_one).collect();
        let tried = tried.into_par_iter().map(|family| (family, candidate(gp, &data, kept, family, kind)));
        best_of(tried.collect::<Vec<_>>().into_iter(), kind, &mut families)
    };
    match (best(ModelKind::Potential), best(ModelKind::Helmholtz)) {
        (potential, Some(rotation)) => choose_rotation(gp, kept, data, (potential, rotation), families),
        (Some(taken), None) => {
            Ok(SlopeOutcome { data, taken, other: None, curl_t: None, families, least_hidden: false })
        }
        (None, None) => Err(GpError::NoFactor),
    }
}

/// The models of the same rows whose error on left-out movements is at most `nearly` times that of the best.
pub(super) fn nearly_best<'a>(
    reports: impl Iterator<Item = &'a FamilyReport> + Clone,
    nearly: f64,
) -> Vec<&'a FamilyReport> {
    let left = |report: &FamilyReport| report.fit.as_ref().map_or(f64::INFINITY, |fit| 1.0 - fit.r_squared);
    let least = reports.clone().map(left).fold(f64::INFINITY, f64::min);
    reports.filter(|report| report.fit.is_some() && left(report) <= nearly * least).collect()
}

/// Step 9: repeats the search with the weights (S18) of a pilot policy, which is itself fitted with the weights from the
/// selected model; `None` if that does not predict better, or if the pilot already predicts clearly worse.
fn search_with_speed_weights(gp: &SlopeGp, kept: &Kept, alike: &SlopeOutcome) -> Result<Option<SlopeOutcome>, GpError> {
    let weighed_by = |lengths: &[f64]| SlopeData::from_kept(kept, certain_weights(&kept.speeds, lengths));
    let data = weighed_by(&alike.taken.lengths())?;
    let Some(pilot) = candidate(gp, &data, kept, alike.taken.family, alike.taken.kind) else { return Ok(None) };
    if weights_cost(gain_t(kept, alike, (&data, &pilot))) {
        return Ok(None);
    }
    let weighed = search_with_weights(gp, kept, weighed_by(&pilot.lengths())?)?;
    Ok(weights_pay(gain_t(kept, alike, (&weighed.data, &weighed.taken))).then_some(weighed))
}

/// t of (S18): the certainty that a model with weights predicts left-out movements better.
fn gain_t(kept: &Kept, alike: &SlopeOutcome, (data, weighed): (&SlopeData, &Candidate)) -> f64 {
    let errors = |data: &SlopeData, candidate: &Candidate| -> Vec<f64> {
        candidate.left_out.residuals.iter().map(|residual| data.unit * residual).collect()
    };
    let both = (errors(&alike.data, &alike.taken), errors(data, weighed));
    weights_t((&both.0, &both.1), &kept.speeds, &data.targets.noise_weights, &data.targets.groups)
}

/// Steps 3 and 4: noise weights, first from a guess of the policy's length, then from a pilot policy.
fn data_with_noise_weights(gp: &SlopeGp, kept: &Kept) -> Result<SlopeData, GpError> {
    if let Some(of_stretches) = &kept.of_stretches {
        return SlopeData::from_kept(kept, of_stretches.weights.clone());
    }
    let Some(variances) = &kept.variances else {
        return SlopeData::from_kept(kept, vec![1.0; kept.speeds.len()]);
    };
    let mean_square = kept.speeds.iter().map(|r| r * r).sum::<f64>() / kept.speeds.len() as f64;
    let guess = vec![HIDDEN * mean_square.sqrt(); kept.speeds.len()];
    let data = SlopeData::from_kept(kept, slope_weights(variances, &kept.speeds, &guess))?;
    match candidate(gp, &data, kept, Family::Medium, ModelKind::Potential) {
        Some(pilot) => SlopeData::from_kept(kept, slope_weights(variances, &kept.speeds, &pilot.lengths())),
        None => Ok(data),
    }
}

/// Step 5 for one family; `None` if its covariance has no Cholesky factor.
pub(super) fn candidate(
    gp: &SlopeGp,
    data: &SlopeData,
    kept: &Kept,
    family: Family,
    kind: ModelKind,
) -> Option<Candidate> {
    let blocks = match kind {
        ModelKind::Potential => family.blocks(gp.trend),
        ModelKind::Helmholtz => family.helmholtz_blocks(gp.trend),
    };
    let fit = data.fit(&blocks, &kept.hyper, family.second_start(&blocks).as_deref())?;
    Some(Candidate::new(data, kept, (family, kind), blocks, fit))
}

/// Step 6: the highest R², ties to the first; records all results.
pub(super) fn best_of(
    tried: impl Iterator<Item = (Family, Option<Candidate>)>,
    model: ModelKind,
    families: &mut Vec<FamilyReport>,
) -> Option<Candidate> {
    let mut best: Option<Candidate> = None;
    for (family, candidate) in tried {
        families.push(FamilyReport { family, model, fit: candidate.as_ref().map(Candidate::numbers) });
        let Some(candidate) = candidate else { continue };
        if best.as_ref().is_none_or(|best| candidate.left_out.r_squared > best.left_out.r_squared) {
            best = Some(candidate);
        }
    }
    best
}

/// Step 7: the best family with rotation, and `smooth` unless both predict nearly exactly. If no potential predicts well,
/// the best family of potentials is uninformative, so `smooth` is tried as well.
fn rotation(
    gp: &SlopeGp,
    data: &SlopeData,
    kept: &Kept,
    best: &Candidate,
    families: &mut Vec<FamilyReport>,
) -> Option<Candidate> {
    if gp.curl_test == CurlTest::AssumePotential || kept.velocities.nrows() == 1 {
        return None;
    }
    let with = |family| candidate(gp, data, kept, family, ModelKind::Helmholtz);
    let first = with(best.family);
    let nearly_exact = |candidate: &Candidate| candidate.left_out.is_nearly_exact();
    let one_is_enough = nearly_exact(best) && first.as_ref().is_some_and(nearly_exact);
    let mut tried = vec![(best.family, first)];
    if !one_is_enough && best.family != Family::Smooth {
        tried.push((Family::Smooth, with(Family::Smooth)));
    }
    best_of(tried.into_iter(), ModelKind::Helmholtz, families)
}

/// Repeats step 4 with the policy with rotation, as often as useful, and fits again each time.
fn reweighted(
    gp: &SlopeGp,
    kept: &Kept,
    mut data: SlopeData,
    mut taken: Candidate,
) -> Result<(SlopeData, Candidate), GpError> {
    let Some(variances) = &kept.variances else { return Ok((data, taken)) };
    for _ in 0..ROUNDS {
        let weights = slope_weights(variances, &kept.speeds, &taken.lengths());
        let anew = SlopeData::from_kept(kept, weights)?;
        let Some(candidate) = candidate(gp, &anew, kept, taken.family, taken.kind) else { break };
        (data, taken) = (anew, candidate);
    }
    Ok((data, taken))
}
