use motion::{Demonstrations, Trajectory};

use crate::episodes::Take;
use crate::in_words::{percent, short};
use crate::options::PrepareOptions;
use crate::prepared::Notes;
use crate::{PrepareError, Verdict};

/// Stamps that differ by less than this share of a step are even.
const EVEN: f64 = 0.01;
/// A time step this near to a whole rate is that rate.
const WHOLE: f64 = 1e-3;
/// Longer steps than this are hardly seconds.
pub(crate) const SLOW: f64 = 5.0;
/// A step over so many usual ones is a gap.
const GAP: f64 = 3.0;

/// The time step of every movement, or its stamps where they are uneven.
pub(crate) fn decide(takes: &mut [Take], options: &PrepareOptions, notes: &mut Notes) -> Result<(), PrepareError> {
    if let Some(time_step) = options.time_step {
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(PrepareError::TimeStep { time_step });
        }
        for take in takes.iter_mut() {
            take.times = (0..take.n_samples()).map(|i| time_step * i as f64).collect();
            take.time_step = Some(time_step);
        }
        notes.decided("time step", format!("{time_step} s"), "given", "--dt");
        return Ok(());
    }
    let (mut uneven, mut worst, mut gaps) = (0, 0.0_f64, 0);
    for take in takes.iter_mut() {
        let steps: Vec<f64> = take.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let usual = median(steps.clone()).unwrap_or(1.0);
        let jitter = steps.iter().map(|step| (step - usual).abs() / usual).filter(|&off| off < GAP - 1.0);
        let jitter = jitter.fold(0.0, f64::max);
        let holes = steps.iter().filter(|&&step| step >= GAP * usual).count();
        gaps += holes;
        if jitter > EVEN || holes > 0 {
            uneven += 1;
            worst = worst.max(jitter);
        } else {
            // The mean forgets how stamps were rounded.
            let mean = steps.iter().sum::<f64>() / steps.len().max(1) as f64;
            take.time_step = Some(whole(if steps.is_empty() { 1.0 } else { mean }));
        }
    }
    say(takes, (uneven, worst, gaps), notes);
    Ok(())
}

fn say(takes: &[Take], (uneven, worst, gaps): (usize, f64, usize), notes: &mut Notes) {
    let steps = takes.iter().filter_map(|take| take.time_step.or_else(|| step_of(take)));
    let Some(usual) = median(steps.collect()) else { return };
    let rate = if usual < 1.0 { format!(" ({} Hz)", short(1.0 / usual)) } else { String::new() };
    let value = format!("{} s{rate}", short(usual));
    if uneven == 0 {
        notes.decided("time step", value, "stamps are even", "--dt");
    } else {
        let why = format!(
            "stamps of {uneven} of {} episodes differ by up to {} of a step; each step keeps its own time",
            takes.len(),
            percent(worst)
        );
        notes.decided("time step", value, why, "--dt");
    }
    if gaps > 0 {
        notes.found(
            Verdict::Good,
            format!("{gaps} steps take over {GAP} times the usual time: samples are missing"),
            "split episodes there (--split-gap) if the movement went on meanwhile",
        );
    }
}

/// A time step that is hardly one in seconds.
pub(crate) fn doubt(demonstrations: &Demonstrations, notes: &mut Notes) {
    let steps = demonstrations.trajectories().iter().map(Trajectory::time_step).collect();
    let Some(usual) = median(steps).filter(|&usual| usual > SLOW) else { return };
    let movement = &demonstrations.trajectories()[0];
    notes.found(
        Verdict::Doubtful,
        format!(
            "samples are {} s apart, an episode lasts {} s: are stamps milliseconds?",
            short(usual),
            short(movement.seconds(0, movement.n_samples() - 1))
        ),
        format!(
            "if so, name the column's unit or give --dt {}; learnt velocities are per second of the stamps",
            short(usual / 1000.0)
        ),
    );
}

fn step_of(take: &Take) -> Option<f64> {
    median(take.times.windows(2).map(|pair| pair[1] - pair[0]).collect())
}

/// 1/k s or k ms where that is as near as stamps are usually rounded.
fn whole(time_step: f64) -> f64 {
    let near = |candidate: f64| (candidate > 0.0 && (candidate / time_step - 1.0).abs() < WHOLE).then_some(candidate);
    let rate = near(1.0 / (1.0 / time_step).round()).filter(|step| step.is_finite());
    let milliseconds = near((time_step * 1000.0).round() / 1000.0);
    match (rate, milliseconds) {
        (Some(rate), Some(ms)) if (ms - time_step).abs() < (rate - time_step).abs() => ms,
        (Some(rate), _) => rate,
        (None, Some(ms)) => ms,
        (None, None) => time_step,
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
