use std::borrow::Cow;

use motion::{Demonstrations, Subject, Verdict};
use nalgebra::{DMatrix, DVector, DVectorView};
use serde::{Deserialize, Serialize};
use smoothing::{PositionNoise, VelocityNoise};

use crate::VelocitySource;
use crate::notes::Notes;
use crate::numbers::percent_of_all;
use crate::repairs::velocity_origin::VelocityOrigin;

/// Positions count as exact if noise is less than this share of the squared steps.
const EXACT: f64 = 0.01;
/// Up to this share of their squares, noise of velocities does not prevent them from correcting positions.
const CORRECTING: f64 = 1e-3;
/// Velocities with more noise than this are worth less than positions.
const USELESS_VELOCITIES: f64 = 0.2;

/// Tolerance for a step to be a multiple of another, as a share of the latter.
const WHOLE: f64 = 0.01;
/// Values have few digits if each occurs this often on average.
const REPEATED: usize = 4;

/// Noise of recordings, estimated from third differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Standard deviation of the noise in each channel, (n), in scaled units; `None` if there are too few samples for an
    /// estimate.
    pub positions: Option<Vec<f64>>,
    /// Share of noise in the squared steps; 0 if it cannot be estimated.
    pub step_share: f64,
    /// Share of noise in the squared recorded velocities; `None` if there are none or it cannot be estimated.
    pub velocity_share: Option<f64>,
}

impl Noise {
    /// Share of noise in the squared steps above which positions are noisy.
    pub const NOISY: f64 = 0.1;

    /// Whether noise makes up so much of the steps that it is reported, and positions are smoothed before they are integrated.
    pub fn is_noisy(&self) -> bool {
        self.step_share > Noise::NOISY
    }

    /// Whether recorded velocities are exact enough to correct positions, or to make smoothing unnecessary.
    pub fn velocities_correct_positions(&self) -> bool {
        self.velocity_share.is_none_or(|share| share <= CORRECTING)
    }
}

/// Noise of positions, and of velocities if they were recorded.
pub(crate) fn of(demonstrations: &Demonstrations) -> Noise {
    let positions = PositionNoise::of(demonstrations).ok().map(|noise| with_resolution(demonstrations, noise));
    let velocity_share = VelocityNoise::of(demonstrations).map(|noise| noise.share);
    Noise {
        step_share: positions.as_ref().map_or(0.0, |noise| noise.step_share),
        positions: positions.map(|noise| noise.deviations.iter().copied().collect()),
        velocity_share,
    }
}

/// Lower limit on noise for positions with few digits: a step q of the last digit is noise with the standard deviation
/// q/√12, which differences do not show while the digits are constant.
fn with_resolution(demonstrations: &Demonstrations, noise: PositionNoise) -> PositionNoise {
    let least = DVector::from_fn(demonstrations.dim(), |axis, _| {
        resolution(demonstrations, axis).unwrap_or(0.0) / 12f64.sqrt()
    });
    let deviations = noise.deviations.sup(&least);
    let before = noise.deviations.norm_squared();
    if deviations == noise.deviations {
        return noise;
    }
    let (sum, count) = squared_steps(demonstrations);
    let step_share = noise.step_share + 2.0 * (deviations.norm_squared() - before) * count as f64 / sum;
    PositionNoise { deviations, step_share: step_share.min(1.0) }
}

/// Sum of the squared steps, and their number.
pub(crate) fn squared_steps(demonstrations: &Demonstrations) -> (f64, usize) {
    let steps = demonstrations.trajectories().iter().map(|movement| {
        let (x, steps) = (movement.states(), movement.n_samples() - 1);
        ((x.columns(1, steps) - x.columns(0, steps)).norm_squared(), steps)
    });
    steps.fold((0.0, 0), |(sum, count), (square, steps)| (sum + square, count + steps))
}

/// The step of which all differences between a channel's values are multiples, if there are few distinct values.
pub(crate) fn resolution(demonstrations: &Demonstrations, axis: usize) -> Option<f64> {
    let mut values: Vec<f64> = demonstrations.values(axis).collect();
    let all = values.len();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let least = values.windows(2).map(|pair| pair[1] - pair[0]).min_by(f64::total_cmp)?;
    let whole = |step: f64| (step / least - (step / least).round()).abs() < WHOLE;
    let few = REPEATED * values.len() < all;
    (few && values.windows(2).all(|pair| whole(pair[1] - pair[0]))).then_some(least)
}

/// Calls `see` with the recorded velocities, or, without them, with those of the steps, (n) each.
pub(crate) fn each_velocity(demonstrations: &Demonstrations, mut see: impl FnMut(DVectorView<'_, f64>)) {
    for movement in demonstrations.trajectories() {
        let steps = || Cow::Owned(movement.step_velocities());
        let velocities = movement.velocities().map_or_else(steps, Cow::Borrowed);
        velocities.column_iter().for_each(&mut see);
    }
}

/// Applies `of` to each of these velocities, (M).
pub(crate) fn of_velocities(demonstrations: &Demonstrations, of: impl Fn(DVectorView<'_, f64>) -> f64) -> Vec<f64> {
    let mut found = Vec::with_capacity(demonstrations.n_samples());
    each_velocity(demonstrations, |velocity| found.push(of(velocity)));
    found
}

/// These velocities, (n, M).
pub(crate) fn all_velocities(demonstrations: &Demonstrations) -> DMatrix<f64> {
    let mut all = Vec::with_capacity(demonstrations.n_samples() * demonstrations.dim());
    each_velocity(demonstrations, |velocity| all.extend(velocity.iter()));
    DMatrix::from_vec(demonstrations.dim(), all.len() / demonstrations.dim(), all)
}

/// Variance of the noise of [`each_velocity`] per axis, averaged over axes; 0 if it cannot be estimated.
pub(crate) fn velocity_variance(demonstrations: &Demonstrations, noise: &Noise) -> f64 {
    VelocityNoise::of(demonstrations)
        .map_or(steps_variance(demonstrations, noise), |noise| noise.variance / demonstrations.dim() as f64)
}

/// The same of the velocities of steps.
pub(crate) fn steps_variance(demonstrations: &Demonstrations, noise: &Noise) -> f64 {
    let positions = noise.positions.iter().flatten().map(|deviation| deviation.powi(2)).sum::<f64>();
    2.0 * positions / (demonstrations.dim() as f64 * demonstrations.time_step().powi(2))
}

/// The source of velocities if the user requested smoothing.
pub(crate) fn as_requested(demonstrations: &Demonstrations, origin: VelocityOrigin) -> VelocitySource {
    if matches!(origin, VelocityOrigin::Missing | VelocityOrigin::Differences) {
        return VelocitySource::PositionsAsRequested;
    }
    if origin == VelocityOrigin::Measured { of_recorded(demonstrations) } else { VelocitySource::Recorded }
}

/// Recorded velocities, with their noise if it is not negligible.
pub(crate) fn of_recorded(demonstrations: &Demonstrations) -> VelocitySource {
    match VelocityNoise::of(demonstrations).filter(|noise| !noise.is_negligible()) {
        Some(noise) => VelocitySource::Noisy(noise.variance / demonstrations.dim() as f64),
        None => VelocitySource::Recorded,
    }
}

/// Decides on the source of velocities for the learners.
pub(crate) fn decide(
    demonstrations: &Demonstrations,
    noise: &Noise,
    origin: VelocityOrigin,
    notes: &mut Notes,
) -> VelocitySource {
    let share = noise.step_share;
    let words = match &noise.positions {
        None => "too few consecutive samples to estimate position noise".to_owned(),
        Some(_) if share < 1e-4 => "position noise is negligible".to_owned(),
        Some(_) => format!("noise makes {} of the squared steps", percent_of_all(share)),
    };
    let of_velocities = noise.velocity_share.unwrap_or(0.0);
    let recorded = match origin {
        VelocityOrigin::Missing | VelocityOrigin::Differences => VelocitySource::Positions,
        VelocityOrigin::Steps if share > EXACT => VelocitySource::Positions,
        _ if of_velocities > USELESS_VELOCITIES => VelocitySource::Positions,
        _ if share > EXACT && noise.velocities_correct_positions() => VelocitySource::Fused,
        _ => of_recorded(demonstrations),
    };
    let (value, why) = match recorded {
        VelocitySource::Recorded => ("velocities as recorded", words),
        VelocitySource::Fused => ("velocities as recorded, positions fused with them", words),
        VelocitySource::Noisy(_) => (
            "velocities as recorded, with their noise",
            format!("noise share of their squares: {}", percent_of_all(of_velocities)),
        ),
        VelocitySource::Positions if origin == VelocityOrigin::Missing => ("positions smoothed piecewise", words),
        VelocitySource::Positions | VelocitySource::PositionsAsRequested => {
            ("positions smoothed piecewise", format!("{words}; velocities are no better"))
        }
    };
    notes.decided(Subject::Smoothing, value, why);
    if recorded == VelocitySource::Positions && noise.is_noisy() {
        notes.found(
            Verdict::Good,
            format!("noise makes {} of the squared steps", percent_of_all(share)),
            "record velocities or commands, or measure positions more exactly",
        );
    }
    recorded
}
