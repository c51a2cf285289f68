//! Detects velocities that were recorded later, or earlier, than the positions, and replaces late ones.

use motion::{Episode, Verdict};

use crate::notes::Notes;
use crate::numbers::{percent, short};
use crate::samples::noise::Noise;

/// Maximum number of steps to compare, evenly spaced.
const STEPS: usize = 20_000;
/// Maximum lag, in samples and as a share of a movement.
const SAMPLES: usize = 20;
const SHARE: usize = 4;
/// Integration rules place a velocity up to half a sample from the middle of its step; this number of half samples is a
/// lag.
const LEAST: isize = 3;
/// Maximum mismatch of the shifted velocities with the steps, as a share of the mismatch as recorded.
const BETTER: f64 = 0.3;
/// A shift must reduce Σ mismatch by this multiple of the noise variance of a step's velocity along one axis. Without a lag, the
/// correlation of noise with the change of velocities reduces it by about one such variance.
const SIGNIFICANT: f64 = 50.0;
/// Share of the steps, those with the smallest mismatches, that determine the shift.
const KEPT: f64 = 0.9;
/// Share of the squared velocities that a lag may change before the policy is in doubt.
const HARMLESS: f64 = 0.15;

/// Reports the shift that makes velocities agree with the steps. Returns whether the positions replace them: if the velocities are late
/// and the noise of the positions changes the steps less than the shift does. Early velocities may be commands.
pub(crate) fn are_replaced(episodes: &[Episode], noise: &Noise, notes: &mut Notes) -> bool {
    let Some(lag) = lag(episodes, noise) else { return false };
    let late = lag.seconds > 0.0;
    let replaced = late && noise.step_share < lag.changed;
    let next = match (replaced, late) {
        (true, _) => "they are taken from the positions; shift these columns to use them",
        (false, true) => "shift these columns, or --integration displacement takes velocities from the positions",
        (false, false) => {
            "correct if they are commands that the robot follows with this delay; otherwise shift them, or --integration displacement takes velocities from the positions"
        }
    };
    let (seconds, when) = (short(lag.seconds.abs()), if late { "later" } else { "earlier" });
    notes.found(
        if lag.changed > HARMLESS && !replaced { Verdict::Doubtful } else { Verdict::Good },
        format!(
            "velocities were recorded {seconds} s {when} than the steps that they match (this changes {} of them)",
            percent(lag.changed)
        ),
        next,
    );
    if replaced {
        let why = format!("those recorded are {seconds} s late, and noise of positions is smaller than the difference");
        notes.decided("velocities", "from positions", why, "--integration");
    }
    replaced
}

struct Lag {
    /// Positive if velocities are late.
    seconds: f64,
    /// The part of Σ|difference|²/Σ|step|² that the shift removes.
    changed: f64,
}

/// The mismatch that remains after a shift.
struct Left {
    /// In half samples, positive if velocities are late.
    shift: isize,
    /// Σ mismatch over the compared steps.
    sum: f64,
    /// The same [`without_switches`].
    without_switches: f64,
}

/// The shift at which velocities explain the steps best, if it matters beyond the noise of the positions.
fn lag(episodes: &[Episode], noise: &Noise) -> Option<Lag> {
    let mut lengths: Vec<usize> = episodes.iter().map(Episode::n_samples).collect();
    lengths.sort_unstable();
    let most = (lengths.get(lengths.len() / 2)? / SHARE).min(SAMPLES);
    let halves = (2 * most).cast_signed();
    let comparable = || {
        episodes.iter().flat_map(|episode| {
            let last = episode.n_samples().saturating_sub(1 + most);
            (most..last).map(move |step| (episode, step))
        })
    };
    let every = comparable().count().div_ceil(STEPS).max(1);
    let compared: Vec<(&Episode, usize)> = comparable().step_by(every).collect();
    let mismatches =
        |shift| compared.iter().map(|(episode, step)| mismatch(episode, *step, shift)).collect::<Option<Vec<f64>>>();
    let left = |shift| {
        let mismatches = mismatches(shift)?;
        let sum = mismatches.iter().sum::<f64>();
        Some(Left { shift, sum, without_switches: without_switches(mismatches) })
    };
    let lefts = (-halves..=halves).map(left).collect::<Option<Vec<_>>>()?;
    let best = lefts.iter().min_by(|a, b| a.without_switches.total_cmp(&b.without_switches))?;
    let near = lefts.iter().filter(|left| left.shift.abs() <= 1);
    let (least, recorded) = (best.sum, near.map(|left| left.sum).fold(f64::INFINITY, f64::min));
    let power = compared.iter().map(|(episode, step)| rate(episode, *step).norm_squared()).sum::<f64>();
    // Both ends of a step contain the positions' noise.
    let variance = noise.positions.as_ref().map_or(0.0, |of| 2.0 * of.iter().map(|sd| sd * sd).sum::<f64>());
    let of_noise = compared.iter().map(|(episode, step)| variance / episode.times.seconds(*step, *step + 1).powi(2));
    let floor = of_noise.sum::<f64>().min(least);
    let of_an_axis = floor / (compared.len() * episodes[0].positions.nrows()) as f64;
    let is_explained = least - floor <= BETTER * (recorded - floor) && recorded - least >= SIGNIFICANT * of_an_axis;
    let step = episodes.iter().find_map(|episode| episode.times.median_step())?;
    let is_lag = best.shift.abs() >= LEAST && best.shift.abs() < halves && is_explained;
    is_lag.then(|| Lag { seconds: best.shift as f64 / 2.0 * step, changed: (recorded - least) / (power - floor) })
}

/// The sum of all but the largest mismatches: if a constraint ends within a step, the step lies between two velocities.
fn without_switches(mut mismatches: Vec<f64>) -> f64 {
    let kept = (KEPT * mismatches.len() as f64) as usize;
    if kept < mismatches.len() {
        mismatches.select_nth_unstable_by(kept, f64::total_cmp);
    }
    mismatches[..kept].iter().sum()
}

/// Mean velocity of a step.
fn rate(episode: &Episode, step: usize) -> nalgebra::DVector<f64> {
    episode.step(step) / episode.times.seconds(step, step + 1)
}

/// Squared difference between a step's velocity and the one recorded `half_samples` after its middle.
fn mismatch(episode: &Episode, step: usize, half_samples: isize) -> Option<f64> {
    let velocities = episode.velocities.as_ref()?;
    // The middle of the step is half a sample after its first sample.
    let at = (2 * step + 1).saturating_add_signed(half_samples);
    let (before, after) = (at / 2, at.div_ceil(2));
    let recorded = (velocities.column(before) + velocities.column(after)) * 0.5;
    Some((rate(episode, step) - recorded).norm_squared())
}
