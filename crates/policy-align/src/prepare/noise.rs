use motion::{Demonstrations, Trajectory};
use serde::{Deserialize, Serialize};
use smoothing::PositionNoise;

use super::options::PrepareOptions;
use super::prepared::{Notes, Recorded};
use super::velocities::Agreement;
use crate::Verdict;

/// Positions count as exact if noise makes less than this share of the squared steps.
const EXACT: f64 = 0.01;
/// Above this share the user should know.
const NOISY: f64 = 0.1;
/// Velocities count as exact if noise makes less than this share of their squares.
const EXACT_VELOCITIES: f64 = 1e-3;
/// Velocities this noisy are worth less than positions.
const USELESS_VELOCITIES: f64 = 0.2;

/// How noisy recordings are, by third differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Standard deviation of the noise in each channel, (n), in scaled units; none with too few samples to tell.
    pub positions: Option<Vec<f64>>,
    /// Share of the squared steps that is noise; 0 where nobody can tell.
    pub step_share: f64,
    /// Share of the squared recorded velocities that is noise; none where there are none or nobody can tell.
    pub velocity_share: Option<f64>,
}

/// Of positions, and of velocities where they were recorded.
pub(super) fn of(demonstrations: &Demonstrations) -> Noise {
    let positions = PositionNoise::of(demonstrations).ok();
    let velocity_share = velocity_noise(demonstrations).map(|(variance, power)| variance / power);
    Noise {
        step_share: positions.as_ref().map_or(0.0, |noise| noise.step_share),
        positions: positions.map(|noise| noise.deviations.iter().copied().collect()),
        velocity_share,
    }
}

/// Variance of noise in recorded velocities, summed over axes, and their mean square.
fn velocity_noise(demonstrations: &Demonstrations) -> Option<(f64, f64)> {
    let as_positions = |trajectory: &Trajectory| {
        let velocities = Trajectory::new(trajectory.velocities()?.clone(), trajectory.time_step()).ok()?;
        match trajectory.times() {
            None => Some(velocities),
            Some(times) => velocities.with_times(times.to_vec()).ok(),
        }
    };
    let velocities: Option<Vec<_>> = demonstrations.trajectories().iter().map(as_positions).collect();
    let noise = PositionNoise::of(&Demonstrations::new(velocities?).ok()?).ok()?;
    let each = demonstrations.trajectories().iter().filter_map(Trajectory::velocities);
    let (power, count) = each.fold((0.0, 0), |(power, count), u| (power + u.norm_squared(), count + u.ncols()));
    Some((noise.deviations.norm_squared(), power / count as f64))
}

/// What learners are given.
pub(super) fn decide(
    demonstrations: &Demonstrations,
    noise: &Noise,
    agreement: Agreement,
    _options: &PrepareOptions,
    notes: &mut Notes,
) -> Recorded {
    let share = noise.step_share;
    let words = match &noise.positions {
        None => "too few samples in a row to tell how noisy positions are".to_owned(),
        Some(_) if share < 1e-4 => "positions are as good as exact".to_owned(),
        Some(_) => format!("noise makes {} of the squared steps", percent(share)),
    };
    let noisy_velocities = noise.velocity_share.filter(|&share| share > EXACT_VELOCITIES);
    let recorded = match agreement {
        Agreement::None => Recorded::Positions,
        Agreement::Differences if share > EXACT => Recorded::Positions,
        _ if noisy_velocities.is_some_and(|share| share > USELESS_VELOCITIES) => Recorded::Positions,
        _ if share > EXACT && noisy_velocities.is_none() => Recorded::FusedVelocities,
        _ => match noisy_velocities.and(velocity_noise(demonstrations)) {
            Some((variance, _)) => Recorded::NoisyVelocities(variance / demonstrations.dim() as f64),
            None => Recorded::Velocities,
        },
    };
    let (value, why) = match recorded {
        Recorded::Velocities => ("velocities as recorded", words),
        Recorded::FusedVelocities => ("velocities as recorded, positions fused with them", words),
        Recorded::NoisyVelocities(_) => (
            "velocities as recorded, with their noise",
            format!("noise makes {} of their squares", percent(noisy_velocities.unwrap_or(0.0))),
        ),
        Recorded::Positions if agreement == Agreement::None => ("positions smoothed, piece by piece", words),
        Recorded::Positions => ("positions smoothed, piece by piece", format!("{words}; velocities are no better")),
    };
    notes.decided("smoothing", value, why, "--smooth");
    if recorded == Recorded::Positions && share > NOISY {
        notes.found(
            Verdict::Good,
            format!("noise makes {} of the squared steps", percent(share)),
            "better: record velocities or commands, or measure positions more exactly",
        );
    }
    recorded
}

fn percent(share: f64) -> String {
    if share < 0.1 { format!("{:.2} %", 100.0 * share) } else { format!("{:.0} %", 100.0 * share) }
}
