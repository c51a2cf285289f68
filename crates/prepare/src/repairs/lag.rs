//! Detects velocities that were recorded later, or earlier, than the positions, and replaces or shifts late ones.

use motion::{Episode, Subject, Verdict};
use nalgebra::{DMatrix, DVector};

use crate::notes::Notes;
use crate::numbers::{counted, percent, short};
use crate::samples::noise::Noise;

/// Maximum number of steps or spans to compare, evenly spaced.
const SPANS: usize = 20_000;
/// Number of steps of a span. The noise of the positions at its ends changes its mean velocity by this number less than that of a step.
const SPAN: usize = 8;
/// Maximum lag, in samples and as a share of a movement.
const SAMPLES: usize = 20;
const SHARE: usize = 4;
/// Integration rules place a velocity up to half a sample from the middle of its step; this number of half samples is a
/// lag.
const LEAST: isize = 3;
/// Maximum mismatch of the shifted velocities with the steps, as a share of the mismatch as recorded, both without noise …
const BETTER: f64 = 0.3;
/// … or with noise, as a multiple of what the positions' noise makes.
const NOISE: f64 = 1.25;
/// The estimate of what the positions' noise makes may be too small by this factor.
const TOO_SMALL: f64 = 1.05;
/// A shift must reduce Σ mismatch by this multiple of the noise variance of a mean velocity along one axis. Without a lag, the correlation of noise
/// with the change of velocities reduces it by about one such variance …
const SIGNIFICANT: f64 = 50.0;
/// … and the correlation of the positions' noise with that of velocities by a random sum, whose standard deviation it must exceed this often.
const CHANCE: f64 = 5.0;
/// Share of the steps, those with the smallest mismatches, that determine the shift.
const KEPT: f64 = 0.9;
/// Share of the squared velocities that a lag may change before the policy is in doubt.
const HARMLESS: f64 = 0.15;

/// What is done about velocities that were recorded at another time than the steps that they match.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Remedy {
    /// The positions replace late velocities, because their noise changes the steps less than the lag does.
    Positions,
    /// Late velocities are shifted.
    Shift,
    /// Late velocities are only reported: an episode is too short to be shifted.
    None,
    /// Early velocities are only reported, because they may be commands.
    Command,
}

/// Reports the shift that makes velocities agree with the steps, and repairs late ones. Returns whether the positions replace them.
pub(crate) fn repair(episodes: &mut [Episode], noise: &Noise, notes: &mut Notes) -> bool {
    let Some(lag) = lag(episodes, noise) else { return false };
    let half_samples = lag.half_samples.unsigned_abs();
    let samples = half_samples.div_ceil(2);
    let (remedy, next) = if lag.seconds <= 0.0 {
        (
            Remedy::Command,
            "correct if they are commands that the robot follows with this delay; otherwise shift them, or --integration displacement takes velocities from the positions",
        )
    } else if noise.step_share < lag.changed {
        (Remedy::Positions, "they are taken from the positions; shift these columns to use them")
    } else if episodes.iter().all(|episode| episode.n_samples() > samples + 1) {
        (Remedy::Shift, "they are shifted; --integration displacement takes velocities from the positions instead")
    } else {
        (Remedy::None, "shift these columns, or --integration displacement takes velocities from the positions")
    };
    let is_repaired = matches!(remedy, Remedy::Positions | Remedy::Shift);
    let seconds = short(lag.seconds.abs());
    let when = if remedy == Remedy::Command { "earlier" } else { "later" };
    notes.found(
        if lag.changed > HARMLESS && !is_repaired { Verdict::Doubtful } else { Verdict::Good },
        format!(
            "velocities were recorded {seconds} s {when} than the steps that they match (this changes {} of them)",
            percent(lag.changed)
        ),
        next,
    );
    match remedy {
        Remedy::Positions => {
            let why =
                format!("those recorded are {seconds} s late, and noise of positions is smaller than the difference");
            notes.decided(Subject::Velocities, "from positions", why);
        }
        Remedy::Shift => {
            let why = format!("they match the steps there; so the last {} have none", counted(samples, "sample"));
            notes.decided(Subject::ShiftOfVelocities, format!("{seconds} s sooner"), why);
            for episode in episodes {
                *episode = sooner(episode, half_samples);
            }
        }
        Remedy::None | Remedy::Command => {}
    }
    remedy == Remedy::Positions
}

/// The episode with each sample's velocity taken from that many half samples later; the last samples, which have none, are left out.
fn sooner(episode: &Episode, half_samples: usize) -> Episode {
    let left = episode.n_samples() - half_samples.div_ceil(2);
    let moved = |velocities: &DMatrix<f64>| {
        let from = |first: usize| velocities.columns(first, left);
        (from(half_samples / 2) + from(half_samples.div_ceil(2))) * 0.5
    };
    Episode { velocities: episode.velocities.as_ref().map(moved), ..episode.part(0, left) }
}

struct Lag {
    /// Positive if velocities are late.
    half_samples: isize,
    /// Positive if velocities are late.
    seconds: f64,
    /// The part of Σ|difference|²/Σ|step|² that the shift removes.
    changed: f64,
}

/// The mismatch that remains after a shift.
struct Left {
    /// In half samples, positive if velocities are late.
    shift: isize,
    /// Σ mismatch over the compared steps or spans.
    sum: f64,
    /// The same [`without_switches`].
    without_switches: f64,
}

/// The shift at which velocities explain the steps best, or else spans of several steps, if it matters beyond the noise of the positions.
fn lag(episodes: &[Episode], noise: &Noise) -> Option<Lag> {
    let mut lengths: Vec<usize> = episodes.iter().map(Episode::n_samples).collect();
    lengths.sort_unstable();
    let most = (lengths.get(lengths.len() / 2)? / SHARE).min(SAMPLES);
    [1, SPAN].into_iter().find_map(|steps| lag_of_spans(episodes, noise, steps, most))
}

/// The shift of at most `most` samples at which velocities explain spans of that many steps best.
fn lag_of_spans(episodes: &[Episode], noise: &Noise, steps: usize, most: usize) -> Option<Lag> {
    let halves = (2 * most).cast_signed();
    let comparable = || {
        episodes.iter().flat_map(|episode| {
            let last = episode.n_samples().saturating_sub(steps + most);
            (most..last).map(move |from| Span { episode, from, steps })
        })
    };
    let every = comparable().count().div_ceil(SPANS).max(steps);
    let compared: Vec<Span<'_>> = comparable().step_by(every).collect();
    let mismatches = |shift| compared.iter().map(|span| span.mismatch(shift)).collect::<Option<Vec<f64>>>();
    let left = |shift| {
        let mismatches = mismatches(shift)?;
        let sum = mismatches.iter().sum::<f64>();
        Some(Left { shift, sum, without_switches: without_switches(mismatches) })
    };
    let lefts = (-halves..=halves).map(left).collect::<Option<Vec<_>>>()?;
    let best = lefts.iter().min_by(|a, b| a.without_switches.total_cmp(&b.without_switches))?;
    let near = lefts.iter().filter(|left| left.shift.abs() <= 1);
    let (least, recorded) = (best.sum, near.map(|left| left.sum).fold(f64::INFINITY, f64::min));
    let power = compared.iter().map(|span| span.rate().norm_squared()).sum::<f64>();
    // Both ends of a span contain the positions' noise.
    let variance = noise.positions.as_ref().map_or(0.0, |of| 2.0 * of.iter().map(|sd| sd * sd).sum::<f64>());
    let of_noise = compared.iter().map(|span| variance / span.seconds().powi(2));
    let floor = of_noise.sum::<f64>().min(least);
    let compared_axes = (compared.len() * episodes[0].positions.nrows()) as f64;
    let of_velocities = (least - TOO_SMALL * floor).max(0.0);
    let by_chance =
        (SIGNIFICANT * floor + CHANCE * 2.0 * (floor * of_velocities * compared_axes).sqrt()) / compared_axes;
    let only_noise_remains = least - floor <= BETTER * (recorded - floor) || least <= NOISE * floor;
    let is_explained = only_noise_remains && recorded - least >= by_chance;
    let step = episodes.iter().find_map(|episode| episode.times.median_step())?;
    let is_lag = best.shift.abs() >= LEAST && best.shift.abs() < halves && is_explained;
    is_lag.then(|| Lag {
        half_samples: best.shift,
        seconds: best.shift as f64 / 2.0 * step,
        changed: (recorded - least) / (power - floor),
    })
}

/// The sum of all but the largest mismatches: if a constraint ends within a step, the step lies between two velocities.
fn without_switches(mut mismatches: Vec<f64>) -> f64 {
    let kept = (KEPT * mismatches.len() as f64) as usize;
    if kept < mismatches.len() {
        mismatches.select_nth_unstable_by(kept, f64::total_cmp);
    }
    mismatches[..kept].iter().sum()
}

/// Consecutive steps of an episode.
struct Span<'a> {
    episode: &'a Episode,
    /// Its first sample.
    from: usize,
    steps: usize,
}

impl Span<'_> {
    fn seconds(&self) -> f64 {
        self.episode.times.seconds(self.from, self.from + self.steps)
    }

    /// Mean velocity, from the positions at its ends.
    fn rate(&self) -> DVector<f64> {
        let positions = &self.episode.positions;
        (positions.column(self.from + self.steps) - positions.column(self.from)) / self.seconds()
    }

    /// Squared difference between its mean velocity and that of those recorded `half_samples` after the middle of each step.
    fn mismatch(&self, half_samples: isize) -> Option<f64> {
        let Span { episode, from, steps } = *self;
        let velocities = episode.velocities.as_ref()?;
        let (mut difference, seconds) = (self.rate(), self.seconds());
        for step in from..from + steps {
            let share = episode.times.seconds(step, step + 1) / seconds;
            // The middle of the step is half a sample after its first sample.
            let at = (2 * step + 1).saturating_add_signed(half_samples);
            for sample in [at / 2, at.div_ceil(2)] {
                difference.axpy(-0.5 * share, &velocities.column(sample), 1.0);
            }
        }
        Some(difference.norm_squared())
    }
}
