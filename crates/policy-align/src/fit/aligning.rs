//! PolicyAlign on recordings: chooses the rule of integration, and the bandwidth and receptive fields by cross-validation over
//! movements.

use align::{Aligned, Bandwidth, Integration, LwprRegressor, PolicyAlign, PotentialPolicy};
use gp::Rows;
use lwpr::LwprParams;
use motion::{Demonstrations, Potential};
use nalgebra::DMatrix;
use prepare::numbers::squared_error;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use smoothing::SavitzkyGolay;

use super::options::FitOptions;
use super::progress::Progress;
use super::recorded_rows::averaged;
use crate::along::{ErrorAlongMotion, error_along_motion};
use crate::{Decision, FitError, Prepared, Smoothing, Subject, VelocitySource};

/// Candidate values of `init_d`: one over the squared width of receptive fields, in units of the states' spread.
const INIT_D: [f64; 5] = [1.0, 2.5, 6.0, 15.0, 40.0];
const BANDWIDTHS: [Bandwidth; 3] = [Bandwidth::Narrow, Bandwidth::Medium, Bandwidth::Wide];

/// PolicyAlign's policy, and its predictions of held-out movements.
#[derive(Debug, Clone)]
pub(crate) struct AlignedFit {
    pub(crate) policy: PotentialPolicy,
    /// The σ² of the responsibilities.
    pub(crate) sigma_squared: f64,
    pub(crate) decisions: Vec<Decision>,
    /// Held-out errors with the chosen settings.
    pub(crate) held_out: ErrorAlongMotion,
    /// Root mean square of the potentials' disagreement after alignment, over their standard deviation.
    pub(crate) residual: f64,
}

/// One point of the grid, with its error in every fold.
struct Tried {
    bandwidth: Bandwidth,
    sigma_squared: f64,
    init_d: f64,
    folds: Vec<ErrorAlongMotion>,
}

impl Tried {
    fn total(&self) -> ErrorAlongMotion {
        self.folds.iter().copied().fold(ErrorAlongMotion::default(), ErrorAlongMotion::plus)
    }

    /// Standard error of E over the folds.
    fn standard_error(&self) -> f64 {
        let errors: Vec<f64> = self.folds.iter().map(|fold| fold.relative_to_motion()).collect();
        motion::mean_and_error(&errors).1
    }
}

/// Positions, averaged and smoothed if that is better, and the rule that integrates them.
fn integrable(prepared: &Prepared) -> Result<(Demonstrations, Integration, &'static str), FitError> {
    let averaged = averaged(prepared)?;
    let smooth = || SavitzkyGolay::default().smooth(&averaged);
    Ok(match prepared.velocities {
        VelocitySource::PositionsAsRequested => {
            (averaged, Integration::Displacement, "positions smoothed as requested")
        }
        VelocitySource::Noisy(_) if prepared.smoothing != Smoothing::Auto => {
            (averaged, Integration::Velocity, "recorded; positions smoothed as requested")
        }
        VelocitySource::Recorded => (averaged, Integration::Velocity, "recorded; they agree with the steps"),
        VelocitySource::Noisy(_) if prepared.noise.velocities_correct_positions() => {
            (averaged, Integration::Velocity, "recorded; their noise is small")
        }
        VelocitySource::Fused | VelocitySource::Noisy(_) => {
            (smooth()?, Integration::Velocity, "recorded; positions smoothed (9 samples, degree 2)")
        }
        VelocitySource::Positions if prepared.noise.is_noisy() => {
            (smooth()?, Integration::Displacement, "positions smoothed (9 samples, degree 2), then differences")
        }
        VelocitySource::Positions => (averaged, Integration::Displacement, "positions are exact enough"),
    })
}

pub(super) fn fit(
    prepared: &Prepared,
    rows: &Rows,
    reference: &DMatrix<f64>,
    options: &FitOptions,
    progress: &mut Progress<'_>,
) -> Result<AlignedFit, FitError> {
    let (demonstrations, integration, why) = integrable(prepared)?;
    let mut decisions = vec![Decision::new(Subject::Integration, format!("{integration:?}").to_lowercase(), why)];
    progress.begin(2, 4, "choosing bandwidth and receptive fields")?;
    let tried = grid(&demonstrations, integration, (rows, reference), options, progress)?;
    let best = choose(&tried).ok_or(FitError::Cancelled)?;
    let why_best = format!(
        "best of {} by cross-validation over {} folds of episodes: error relative to the motion {}",
        tried.len(),
        best.folds.len(),
        squared_error(best.total().relative_to_motion())
    );
    let given = |flag: bool| if flag { "given".to_owned() } else { why_best.clone() };
    decisions.push(Decision::new(
        Subject::Bandwidth,
        format!("{:?} (σ² {:.3e})", best.bandwidth, best.sigma_squared).to_lowercase(),
        given(options.bandwidth.is_some()),
    ));
    decisions.push(Decision::new(Subject::InitD, format!("{}", best.init_d), given(options.init_d.is_some())));
    progress.begin(3, 4, "aligning all movements")?;
    let align = PolicyAlign { integration, bandwidth: Bandwidth::Fixed(best.sigma_squared), ..PolicyAlign::default() };
    let aligned = align.align(&demonstrations)?;
    let policy = aligned.learn(&regressor(best.init_d), &mut ChaCha8Rng::seed_from_u64(options.seed))?;
    let residual = residual(&aligned, &policy);
    Ok(AlignedFit { policy, sigma_squared: best.sigma_squared, decisions, held_out: best.total(), residual })
}

fn regressor(init_d: f64) -> LwprRegressor {
    let regressor = LwprRegressor::default();
    LwprRegressor { params: LwprParams { init_d, ..regressor.params }, ..regressor }
}

/// Evaluates every setting in every fold, in parallel.
fn grid(
    demonstrations: &Demonstrations,
    integration: Integration,
    (rows, reference): (&Rows, &DMatrix<f64>),
    options: &FitOptions,
    progress: &Progress<'_>,
) -> Result<Vec<Tried>, FitError> {
    let bandwidths = options.bandwidth.map_or_else(|| BANDWIDTHS.to_vec(), |given| vec![given]);
    let sizes = options.init_d.map_or_else(|| INIT_D.to_vec(), |given| vec![given]);
    let cancelled = progress.cancelled;
    let folds = folds(demonstrations.n_trajectories(), options);
    let mut tried = Vec::new();
    let mut refused = None;
    for bandwidth in bandwidths {
        let align = PolicyAlign { integration, bandwidth, ..PolicyAlign::default() };
        match align.align(demonstrations) {
            Err(error) => refused = Some(error),
            Ok(aligned) => tried.extend(sizes.iter().map(|&init_d| Tried {
                bandwidth,
                sigma_squared: aligned.sigma_squared(),
                init_d,
                folds: Vec::new(),
            })),
        }
    }
    if tried.is_empty() {
        return Err(refused.map_or(FitError::Cancelled, FitError::Align));
    }
    let mut settings: Vec<f64> = tried.iter().map(|tried| tried.sigma_squared).collect();
    settings.dedup();
    let jobs: Vec<(f64, usize)> = settings.iter().flat_map(|&s| (0..folds.len()).map(move |fold| (s, fold))).collect();
    let fold_errors = |&(sigma_squared, fold): &(f64, usize)| {
        if cancelled.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(FitError::Cancelled);
        }
        let held: Vec<usize> = folds[fold].clone();
        let others: Vec<_> = (0..demonstrations.n_trajectories()).filter(|k| !held.contains(k)).collect();
        let training = others.iter().map(|&k| demonstrations.trajectories()[k].clone()).collect();
        // A fold does not contain all movements, so the training set is not empty.
        let training = Demonstrations::new(training)?;
        let align = PolicyAlign { integration, bandwidth: Bandwidth::Fixed(sigma_squared), ..PolicyAlign::default() };
        let aligned = align.align(&training)?;
        let test: Vec<usize> = (0..rows.len()).filter(|&row| held.contains(&rows.indices()[row].trajectory)).collect();
        let errors = sizes.iter().map(|&init_d| {
            let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
            rng.set_stream(1 + fold as u64);
            Ok(error_along_motion(&aligned.learn(&regressor(init_d), &mut rng)?, rows, &test, Some(reference)))
        });
        errors.collect::<Result<Vec<ErrorAlongMotion>, FitError>>()
    };
    let results: Vec<_> = jobs.par_iter().map(fold_errors).collect();
    for ((sigma_squared, _), errors) in jobs.iter().zip(results) {
        for (init_d, error) in sizes.iter().zip(errors?) {
            let has_settings = |tried: &&mut Tried| tried.sigma_squared == *sigma_squared && tried.init_d == *init_d;
            tried.iter_mut().filter(has_settings).for_each(|tried| tried.folds.push(error));
        }
    }
    Ok(tried)
}

/// Among the settings within one standard error of the lowest E, the one with the narrowest bandwidth, then the smallest
/// `init_d`.
fn choose(tried: &[Tried]) -> Option<&Tried> {
    let error = |tried: &Tried| {
        let error = tried.total().relative_to_motion();
        if error.is_finite() { error } else { f64::INFINITY }
    };
    let best = tried.iter().min_by(|a, b| error(a).total_cmp(&error(b)))?;
    let limit = error(best) + best.standard_error().max(0.0);
    let near = tried.iter().filter(|tried| error(tried) <= limit);
    near.min_by(|a, b| a.sigma_squared.total_cmp(&b.sigma_squared).then(a.init_d.total_cmp(&b.init_d))).or(Some(best))
}

/// Distributes the episodes over the folds in random order.
fn folds(episodes: usize, options: &FitOptions) -> Vec<Vec<usize>> {
    use rand::seq::SliceRandom;
    let mut order: Vec<usize> = (0..episodes).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(options.seed));
    let count = options.folds.min(episodes);
    (0..count).map(|fold| order.iter().copied().skip(fold).step_by(count).collect()).collect()
}

fn residual(aligned: &Aligned, policy: &PotentialPolicy) -> f64 {
    let potential = policy.global_potential();
    let pairs: Vec<(f64, f64)> = aligned.samples().iter().map(|(x, level)| (potential.value(x), level)).collect();
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let shift = mean(&|(f, level)| level - f);
    let left = mean(&|(f, level)| (level - f - shift).powi(2));
    let middle = mean(&|(_, level)| *level);
    (left / mean(&|(_, level)| (level - middle).powi(2))).sqrt()
}
