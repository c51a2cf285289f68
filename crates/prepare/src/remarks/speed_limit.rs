//! Detects speeds that are cut off at a limit.

use motion::{Demonstrations, Finding, Verdict};

use crate::StateChannel;
use crate::numbers::{percent, short};
use crate::samples::noise::{Noise, of_velocities, velocity_variance};

/// Relative tolerance for speeds at a limit without noise, because turning shortens steps.
const EQUAL: f64 = 2e-3;
/// Half the width of a plateau, in standard deviations of the noise.
const DEVIATIONS: f64 = 2.5;
/// Noise above this share of the limit hides it.
const LOUD: f64 = 0.1;
/// Minimum share of samples at the limit.
const SHARE: f64 = 0.05;
/// Maximum share of faster samples, which noise may cause.
const FASTER: f64 = 0.01;
/// Minimum ratio to the number of samples in the next slower interval; peaks of equal movements are below 3.
const CROWDED: f64 = 3.0;
/// An axis whose mean velocity is this share of the plateau is pressed, not limited.
const STEADY: f64 = 0.9;

/// Reports the maximum speed of the robot, or of some of its axes.
pub(super) fn speed_limit(demonstrations: &Demonstrations, state: &[StateChannel], noise: &Noise) -> Option<Finding> {
    let deviation = velocity_variance(demonstrations, noise).sqrt();
    if let Some(plateau) = plateau(of_velocities(demonstrations, |u| u.norm()), deviation) {
        return Some(plateau.finding(""));
    }
    let axes: Vec<(Plateau, &str)> = (0..state.len())
        .filter_map(|axis| {
            let plateau = plateau(of_velocities(demonstrations, |u| u[axis].abs()), deviation)?;
            let along = of_velocities(demonstrations, |u| u[axis]);
            let mean = along.iter().sum::<f64>() / along.len() as f64;
            (mean.abs() < STEADY * plateau.speed).then(|| (plateau, state[axis].name.as_str()))
        })
        .collect();
    let names: Vec<&str> = axes.iter().map(|&(_, name)| name).collect();
    axes.first().map(|(plateau, _)| plateau.finding(&format!(" along {}", names.join(", "))))
}

struct Plateau {
    speed: f64,
    /// Share of all samples.
    share: f64,
}

impl Plateau {
    fn finding(&self, along: &str) -> Finding {
        let (share, speed) = (percent(self.share), short(self.speed));
        Finding {
            verdict: Verdict::Doubtful,
            what: format!("{share} of the samples have the same largest speed{along}, {speed}: a speed limit?"),
            next: "at the limit only the policy's direction is observed: raise the limit, teach more slowly, or record the velocities that were commanded".to_owned(),
        }
    }
}

/// The fastest speed that many samples share.
fn plateau(mut speeds: Vec<f64>, deviation: f64) -> Option<Plateau> {
    speeds.sort_by(f64::total_cmp);
    let samples = speeds.len() as f64;
    let below = |speed: f64| speeds.partition_point(|&other| other < speed);
    let within = |low: f64, high: f64| (below(high) - below(low)) as f64;
    let first = speeds.len().saturating_sub(1 + (samples * (FASTER + SHARE)) as usize);
    let crowd = |&speed: &f64| {
        let width = (EQUAL * speed).max(DEVIATIONS * deviation);
        (within(speed - width, speed + width), speed, width)
    };
    let (count, speed, width) = speeds[first..].iter().map(crowd).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let slower = within(speed - 3.0 * width, speed - width);
    let faster = (speeds.len() - below(speed + width)) as f64;
    let is_limit = deviation <= LOUD * speed
        && speed > 0.0
        && count >= SHARE * samples
        && faster <= FASTER * samples
        && count >= CROWDED * slower;
    is_limit.then_some(Plateau { speed, share: count / samples })
}
