use motion::{Demonstrations, Episode, Subject, TimeUnit, Times, Verdict, upper_median, whole_step};

use crate::PrepareError;
use crate::notes::{Notes, and_more};
use crate::numbers::{percent, short};
use crate::options::PrepareOptions;

/// Stamps are even if they differ by less than this share of a step.
const EVEN: f64 = 0.01;
/// Steps longer than this are hardly in seconds.
pub(crate) const SLOW: f64 = 5.0;
/// Units of stamps that are no seconds.
pub(crate) const UNITS: [TimeUnit; 2] = [TimeUnit::Milliseconds, TimeUnit::Microseconds];
/// A step longer than this multiple of the usual one is a gap.
const GAP: f64 = 3.0;

/// Determines the time step of every movement, or keeps its stamps if they are uneven.
pub(crate) fn decide(
    episodes: &mut [Episode],
    options: &PrepareOptions,
    notes: &mut Notes,
) -> Result<(), PrepareError> {
    if let Some(time_step) = options.time_step {
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(PrepareError::TimeStep { time_step });
        }
        for episode in episodes.iter_mut() {
            episode.times = Times::Even { step: time_step, len: episode.n_samples() };
        }
        notes.decided(Subject::TimeStep, format!("{time_step} s"), "given");
        return Ok(());
    }
    let (mut uneven, mut worst, mut gaps, mut first) = (0, 0.0_f64, 0, None);
    for episode in episodes.iter_mut() {
        let steps: Vec<f64> = episode.times.steps().collect();
        let usual = episode.times.median_step().unwrap_or(1.0);
        let jitter = steps.iter().map(|step| (step - usual).abs() / usual).filter(|&off| off < GAP - 1.0);
        let jitter = jitter.fold(0.0, f64::max);
        let long: Vec<usize> = (0..steps.len()).filter(|&step| steps[step] >= GAP * usual).collect();
        if jitter > EVEN || !long.is_empty() {
            uneven += 1;
            worst = worst.max(jitter);
        } else {
            // The mean averages out the rounding of stamps.
            let mean = steps.iter().sum::<f64>() / steps.len().max(1) as f64;
            episode.times = Times::Even { step: whole_step(mean), len: episode.n_samples() };
        }
        gaps += long.len();
        if let (None, Some(&i)) = (&first, long.first()) {
            first = Some(format!("{}: {} s instead of {} s", episode.place(i + 1), short(steps[i]), short(usual)));
        }
    }
    decided(episodes, (uneven, worst), notes);
    if let Some(first) = first {
        notes.found(
            Verdict::Good,
            format!("a step takes over {GAP} times the usual time ({first}){}: samples are missing", and_more(gaps)),
            "--split-gap SECONDS splits episodes there, if the movement went on meanwhile",
        );
    }
    Ok(())
}

/// The median of the episodes' steps, in seconds; `None` if no episode has two samples.
pub(crate) fn usual_step(episodes: &[Episode]) -> Option<f64> {
    upper_median(episodes.iter().filter_map(|episode| episode.times.median_step()).collect())
}

fn decided(episodes: &[Episode], (uneven, worst): (usize, f64), notes: &mut Notes) {
    let Some(usual) = usual_step(episodes) else { return };
    let rate = if usual < 1.0 { format!(" ({} Hz)", short(1.0 / usual)) } else { String::new() };
    let value = format!("{} s{rate}", short(usual));
    let why = match uneven {
        0 => "stamps are even".to_owned(),
        _ => format!(
            "stamps of {uneven} of {} episodes differ by up to {} of a step; each step keeps its own time",
            episodes.len(),
            percent(worst)
        ),
    };
    notes.decided(Subject::TimeStep, value, why);
}

/// Reports a time step that is hardly in seconds.
pub(crate) fn doubt(demonstrations: &Demonstrations, notes: &mut Notes) {
    let usual = demonstrations.time_step();
    if usual <= SLOW {
        return;
    }
    // The first unit in which steps are short enough.
    let [milliseconds, microseconds] = UNITS;
    let unit = if usual <= SLOW * milliseconds.per_second() { milliseconds } else { microseconds };
    let movement = &demonstrations.trajectories()[0];
    let [step, episode] = [usual, movement.duration()].map(short);
    notes.found(
        Verdict::Doubtful,
        format!("samples are {step} s apart, an episode lasts {episode} s; stamps may be {}", unit.name()),
        format!(
            "if so, --time-unit {} or --dt {}; learnt velocities are per second of the stamps",
            unit.symbol(),
            short(usual / unit.per_second())
        ),
    );
}
