//! Checks of the demonstrations for faults that no alignment mends.

use motion::{Demonstrations, Trajectory};

use crate::Warning;

/// A step longer than so many usual ones is worth a word.
const LONG: f64 = 10.0;
/// So many steps about a step tell what is usual there, itself included.
const ABOUT: usize = 7;

/// Anomalies of the demonstrations, trajectory by trajectory.
pub(crate) fn scrutinise(demonstrations: &Demonstrations) -> Vec<Warning> {
    let trajectories = demonstrations.trajectories();
    let longest = trajectories.iter().map(Trajectory::n_samples).max().unwrap_or(0);
    let dim = demonstrations.dim();
    let transposed = (2 * longest < dim).then_some(Warning::LooksTransposed { dim, n_samples: longest });
    let single = trajectories.iter().enumerate().flat_map(|(trajectory, movement)| {
        let still = stands_still(movement).then_some(Warning::StandsStill { trajectory });
        let long = long_step(movement);
        let long = long.map(|(sample, times)| Warning::LongStep { trajectory, sample, times });
        [still, long].into_iter().flatten()
    });
    transposed.into_iter().chain(single).chain(alike(trajectories)).collect()
}

fn stands_still(movement: &Trajectory) -> bool {
    movement.states().column_iter().all(|state| state == movement.state(0))
}

/// Pairs that share all states, forwards or backwards; of several alike, each with the first.
fn alike(trajectories: &[Trajectory]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let moving = |k: &usize| !stands_still(&trajectories[*k]);
    for j in (0..trajectories.len()).filter(moving) {
        let states = trajectories[j].states();
        let backwards = |other: &Trajectory| {
            let other = other.states();
            other.shape() == states.shape() && other.column_iter().rev().zip(states.column_iter()).all(|(a, b)| a == b)
        };
        if let Some(k) = (0..j).find(|&k| trajectories[k].states() == states) {
            warnings.push(Warning::Duplicated { trajectories: [k, j] });
        } else if let Some(k) = (0..j).filter(moving).find(|&k| backwards(&trajectories[k])) {
            warnings.push(Warning::Mirrored { trajectories: [k, j] });
        }
    }
    warnings
}

/// The longest step that is over ten times the median one and over ten times most of the steps about it: the sample
/// before it, and how many times the median it is.
///
/// Speeds may well differ more than that from start to end, and where a constraint gives way; a single step that stands
/// out from its neighbours does not come about so.
fn long_step(movement: &Trajectory) -> Option<(usize, f64)> {
    let x = movement.states();
    let step = |i: usize| x.column(i).iter().zip(x.column(i + 1).iter()).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
    let steps: Vec<f64> = (0..x.ncols() - 1).map(|i| step(i).sqrt()).collect();
    let usual = median(steps.iter().copied().filter(|&step| step > 0.0).collect())?;
    let stands_out = |&i: &usize| {
        let first = i.saturating_sub(ABOUT / 2).min(steps.len().saturating_sub(ABOUT));
        let about = &steps[first..(first + ABOUT).min(steps.len())];
        let shorter = about.iter().filter(|&&other| LONG * other < steps[i]).count();
        steps[i] > LONG * usual && 2 * shorter > about.len()
    };
    let longest = (0..steps.len()).filter(stands_out).max_by(|&i, &j| steps[i].total_cmp(&steps[j]))?;
    Some((longest, steps[longest] / usual))
}

/// The middle value, the upper of two.
fn median(mut values: Vec<f64>) -> Option<f64> {
    let half = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(half, f64::total_cmp).1)
}
