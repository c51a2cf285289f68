//! Learns a policy from prepared movements, with all decisions and the verdict on it.

mod actions;
mod aligning;
mod context;
mod decision;
mod digest;
mod halves;
mod inertia;
mod links;
mod options;
mod progress;
mod recorded_rows;
mod units;

pub use digest::Digest;
pub(crate) use digest::made_beside;
pub use options::{FitOptions, LearnerChoice};
pub use progress::{Progress, Step};
pub(crate) use recorded_rows::{averaged, least_noisy_rows, rows};

use gp::{AutoFit, Grouping, LeftOutRow, TrajectoryErrors};
use kinematics::RobotModel;
use motion::{LearntPolicy, Policy, spread};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::channel_joints::joints_in_degrees;
use crate::trust::{
    AlignedNumbers, CommonPlane, TrustNumbers, VerdictInput, along_the_motion, common_point, common_surface,
    extrapolated, judge, pushed, share_leaving, share_unknown, wall,
};
use crate::{DataSummary, Decision, Finding, FitError, Learnt, MadeBy, Model, PredictedSpeed, Prepared};
use aligning::AlignedFit;
use decision::{digests_decision, discarded, learner_decision, rows_decision};
use digest::{widened, with_digests};
use halves::Halves;
use links::LinkNames;

/// Learns a policy. The same seed gives the same bits with any number of threads. The model contains neither file names nor the time, which
/// only the caller knows.
///
/// # Errors
/// [`FitError`]: options out of range, too few movements for the learner, or [`FitError::Cancelled`].
pub fn fit(prepared: &Prepared, options: &FitOptions, progress: &mut Progress<'_>) -> Result<Model, FitError> {
    fit_with(prepared, &[], options, progress)
}

/// Learns a policy from these movements and from digests of further ones, in their order. Gaussian processes learn from all of them; steps
/// that need whole movements (constraints that push, the verdict's findings) use only those at hand.
///
/// # Errors
/// As [`fit()`], and [`FitError::Digest`] if digests are damaged or do not belong together, or if a robot or PolicyAlign requires whole
/// movements.
pub fn fit_with(
    prepared: &Prepared,
    digests: &[Digest],
    options: &FitOptions,
    progress: &mut Progress<'_>,
) -> Result<Model, FitError> {
    options.check()?;
    if let (false, Some(flag)) = (digests.is_empty(), options.needs_whole_recordings()) {
        return Err(FitError::Digest { reason: format!("{flag} needs whole recordings") });
    }
    let beside = if digests.is_empty() { String::new() } else { made_beside(prepared) };
    if digests.iter().any(|digest| !digest.made_for.starts_with(&beside) || digest.made_for != digests[0].made_for) {
        let reason = "digests were made for other recordings or options".to_owned();
        return Err(FitError::Digest { reason });
    }
    let steps = if options.learner == LearnerChoice::PolicyAlign { 4 } else { 2 };
    progress.begin(0, steps, "cleaning the recordings")?;
    let comparable = if prepared.context.is_empty() { None } else { Some(context::comparable(prepared, options)?) };
    let prepared = comparable.as_ref().unwrap_or(prepared);
    let robot = options.robot.as_deref().map(RobotModel::from_urdf).transpose();
    let robot = robot.map_err(|error| FitError::Robot { reason: error.to_string() })?;
    let rows_of = |prepared: &Prepared| {
        LinkNames::with_spaces(with_digests(rows(prepared)?, prepared, digests)?, prepared, robot.as_ref())
    };
    let (rows, links) = rows_of(prepared)?;
    progress.begin(1, steps, "learning with and without constraints")?;
    let readings = learn(&rows, options)?;
    let weighed = inertia::weighed(prepared, &rows, &readings, (robot.as_ref(), options))?;
    let metric = weighed.as_ref().map(|weighed| weighed.decision.clone());
    let (in_units, rows, readings) = if let Some(inertia::Weighed { rows, readings, .. }) = weighed {
        (None, rows, readings)
    } else {
        let candidates = units::candidates(prepared, &rows, &readings, options)?;
        let again = |prepared: &Prepared| {
            let (rows, _) = rows_of(prepared)?;
            let readings = learn(&rows, options)?;
            Ok((rows, readings))
        };
        units::best(prepared, candidates, options, (rows, readings), again)?
    };
    let prepared = in_units.as_ref().unwrap_or(prepared);
    let mut decisions: Vec<Decision> = prepared.decisions.iter().cloned().chain(metric).collect();
    decisions.extend(links.decision(&readings));
    decisions.extend(digests_decision(prepared, digests, &readings));
    decisions.push(learner_decision(options, &readings));
    let aligned = if options.learner == LearnerChoice::PolicyAlign {
        let reference = readings.actions(rows.states().as_view());
        Some(aligning::fit(prepared, &rows, &reference, options, progress)?)
    } else {
        // The aligned potentials learn from all samples.
        decisions.extend(rows_decision(&readings));
        None
    };
    let mut numbers = numbers(prepared, options, &readings, aligned.as_ref(), &rows);
    numbers.episodes += digests.iter().map(|digest| digest.data.episodes).sum::<usize>();
    let policy = policy(options, &readings, aligned.as_ref());
    let mut findings = prepared.findings.clone();
    for finding in digests.iter().flat_map(|digest| &digest.findings) {
        // Files with the same columns yield the same findings.
        if !findings.contains(finding) {
            findings.push(finding.clone());
        }
    }
    if let Some(push) = readings.slope().report().push.filter(|&push| push > 0.0) {
        let learnt = options.learner != LearnerChoice::PolicyAlign && takes_slope(&readings, options.learner);
        pushed(push, learnt, &mut findings);
    }
    let from_pushes = takes_slope(&readings, options.learner) && readings.slope().report().push.is_some();
    findings.extend(along_the_motion(policy, &rows, prepared, &numbers, from_pushes));
    findings.extend(robot.and_then(|robot| joints_in_degrees(&robot, &prepared.state)));
    findings.extend(extrapolated(policy, &actions::states(&rows), rows.velocities()));
    findings.extend(plane(prepared, &numbers));
    findings.extend(common_surface(&rows, &prepared.state, &numbers));
    findings.extend(common_point(&prepared.demonstrations, &prepared.state));
    let gap = if takes_slope(&readings, options.learner) { numbers.gap } else { 0.0 };
    findings.extend(wall(&rows, prepared, gap));
    let trust = judge(VerdictInput {
        numbers,
        findings: &findings,
        state: &prepared.state,
        episodes: &prepared.episodes,
        learner: options.learner,
        given: options.reading,
    });
    // In the metric of a robot's inertia, components along a movement are not lengths.
    let predicted = if rows.momenta().is_none() { predicted(&readings, options.learner) } else { vec![] };
    let not_aligned = aligned.as_ref().and_then(|aligned| aligned.policy.kept());
    let not_aligned = not_aligned.map_or_else(Vec::new, |kept| discarded(kept, &prepared.episodes));
    let learnt = match (options.learner, aligned) {
        (_, Some(aligned)) => {
            decisions.extend(aligned.decisions);
            Learnt::PolicyAlign(Box::new(aligned.policy))
        }
        (LearnerChoice::Slope, _) => Learnt::Slope(Box::new(readings.slope().clone())),
        (LearnerChoice::Direct, _) => Learnt::Direct(Box::new(readings.direct().clone())),
        _ => Learnt::Auto(Box::new(readings)),
    };
    let mut data = DataSummary::of(prepared, rows.velocities());
    data.left_out.extend(not_aligned);
    let data = digests.iter().fold(data, |data, digest| data.and(&digest.data));
    let state = widened(&prepared.state, 0, digests);
    let context = widened(&prepared.context, state.len(), digests);
    let time_step = prepared.time_step;
    let chosen_context = crate::model::no_context();
    let made_by = MadeBy::this();
    let seed = options.seed;
    Ok(Model { made_by, state, context, chosen_context, time_step, data, decisions, seed, trust, predicted, learnt })
}

fn learn(rows: &gp::Rows, options: &FitOptions) -> Result<AutoFit, FitError> {
    Ok(options.gaussian_processes().fit(rows, &mut ChaCha8Rng::seed_from_u64(options.seed))?)
}

/// Whether the Gaussian process's policy is that of the slope GP, with PolicyAlign or without.
fn takes_slope(readings: &AutoFit, learner: LearnerChoice) -> bool {
    match learner {
        LearnerChoice::Slope => true,
        LearnerChoice::Direct => false,
        LearnerChoice::Auto | LearnerChoice::PolicyAlign => readings.takes_slope(),
    }
}

/// The plane that contains all movements, if one direction was not observed.
fn plane(prepared: &Prepared, numbers: &TrustNumbers) -> Option<Finding> {
    let unseen = numbers.direction_coverage < TrustNumbers::GOOD_COVERAGE;
    let plane = unseen.then(|| CommonPlane::of(&prepared.demonstrations, &prepared.state)).flatten()?;
    Some(plane.finding(&prepared.state))
}

/// The policy that the model contains.
fn policy<'a>(options: &FitOptions, readings: &'a AutoFit, aligned: Option<&'a AlignedFit>) -> &'a dyn Policy {
    match aligned {
        Some(aligned) => &aligned.policy,
        None if options.learner == LearnerChoice::Auto => readings,
        None if takes_slope(readings, options.learner) => readings.slope(),
        None => readings.direct(),
    }
}

fn numbers(
    prepared: &Prepared,
    options: &FitOptions,
    readings: &AutoFit,
    aligned: Option<&AlignedFit>,
    rows: &gp::Rows,
) -> TrustNumbers {
    let (of, report) = (readings.numbers(), readings.slope().report());
    let takes_slope = takes_slope(readings, options.learner);
    let slope_error = of.a_s * (1.0 - of.hidden);
    let held_out_error = match aligned {
        Some(aligned) => aligned.held_out.relative_to_policy(),
        None if takes_slope => slope_error,
        None => of.a_d,
    };
    let by = Halves { max_rows: options.max_rows, seed: options.seed, recordings: &prepared.recordings() };
    let halves = if takes_slope { halves::of_slope(readings, rows, by) } else { halves::of_direct(readings, rows, by) };
    let expected = if takes_slope { report.expected_nupe } else { readings.expected_nupe() };
    let direction_coverage = of.least_seen.coverage();
    // Parts of the same movement test how a policy continues along it, not how it behaves elsewhere. Halves test that if movements go in
    // all directions.
    let own = match of.grouping {
        Grouping::BlocksOfTime if direction_coverage < TrustNumbers::GOOD_COVERAGE => expected.max(1.0),
        Grouping::BlocksOfTime => expected.max(halves.unwrap_or(1.0).min(1.0)),
        Grouping::Trajectories => expected,
    };
    let aligned_numbers = aligned.map(|aligned| {
        let aligned_count = aligned.policy.kept().map_or(prepared.demonstrations.n_trajectories(), <[usize]>::len);
        AlignedNumbers {
            sigma_squared: Some(aligned.sigma_squared),
            kept: aligned_count,
            discarded: prepared.demonstrations.n_trajectories() - aligned_count,
            residual: aligned.residual,
            unsupported: aligned.held_out.unsupported as f64 / aligned.held_out.samples.max(1) as f64,
            difference: aligned.held_out.differences / spread(&readings.actions(rows.states().as_view()))
                * rows.len() as f64
                / aligned.held_out.samples.max(1) as f64,
        }
    });
    TrustNumbers {
        episodes: prepared.demonstrations.n_trajectories(),
        reading: readings.reading(),
        held_out_error,
        episode_errors: episode_errors(readings, takes_slope, prepared.episodes.len()),
        held_out_error_direct: of.a_d,
        direct_error: of.p_d,
        gap: of.gap,
        // An upper bound: PolicyAlign's distance from the Gaussian process's policy plus that policy's distance from the truth.
        expected_error: aligned_numbers
            .as_ref()
            .map_or(own, |aligned| (aligned.difference.sqrt() + own.sqrt()).powi(2)),
        ambiguity: report.ambiguity,
        slope_r_squared: report.r_squared,
        z_squared: report.z_squared,
        direction_coverage,
        unseen_direction: of.least_seen.direction.clone(),
        least_known: report.identifiability.least,
        least_known_direction: report.identifiability.direction.clone(),
        rotation_share: report.rotational_share,
        rotation_t: report.curl_t,
        model: report.model,
        halves,
        unknown: unknown(readings, prepared, rows),
        leaving: share_leaving(policy(options, readings, aligned), &prepared.demonstrations),
        step_noise: prepared.noise.step_share,
        grouping: of.grouping,
        aligned: aligned_numbers,
    }
}

/// Uncertainty of the policy between the demonstrated movements.
fn unknown(readings: &AutoFit, prepared: &Prepared, rows: &gp::Rows) -> f64 {
    let states = actions::states(rows);
    let variance = spread(&readings.actions(states.as_view())) / states.ncols() as f64;
    share_unknown(readings, &prepared.demonstrations, variance).unwrap_or(1.0)
}

/// Predictions of the Gaussian process on left-out movements.
fn predicted(readings: &AutoFit, learner: LearnerChoice) -> Vec<PredictedSpeed> {
    let takes_slope = takes_slope(readings, learner);
    let speed = |row: &LeftOutRow| {
        let predicted = if takes_slope { row.slope? } else { row.direct };
        Some(PredictedSpeed { index: row.index, seen: row.seen, predicted })
    };
    readings.left_out_rows().iter().filter_map(speed).collect()
}

/// Left-out error E′ of every movement at hand, scaled as if its speed were the average of all movements.
fn episode_errors(readings: &AutoFit, takes_slope: bool, at_hand: usize) -> Vec<(usize, f64)> {
    let left_out = readings.left_out();
    let observed = left_out.iter().map(|errors| errors.seen).sum::<f64>() / left_out.len() as f64;
    let hidden = if takes_slope { readings.numbers().hidden } else { 0.0 };
    let error = |errors: &TrajectoryErrors| if takes_slope { errors.slope } else { errors.direct };
    let own = left_out.iter().filter(|errors| errors.trajectory < at_hand);
    own.map(|errors| (errors.trajectory, error(errors) / observed * (1.0 - hidden))).collect()
}
