//! Detects speeds that are cut off at a limit.

use motion::{Demonstrations, Finding};
use nalgebra::{DMatrix, DVectorView};

use crate::StateChannel;
use crate::numbers::{percent, short};
use crate::samples::noise::{Noise, all_velocities, steps_variance, velocity_variance};

/// Relative tolerance for speeds at a limit without noise, because turning shortens steps.
const EQUAL: f64 = 2e-3;
/// Half the width of a plateau, in standard deviations of the noise.
const DEVIATIONS: f64 = 2.5;
/// Numbers of steps of the spans.
const SPANS: [usize; 3] = [2, 4, 8];
/// Spans are tried if noise exceeds this share of the usual velocity.
const AUDIBLE: f64 = 0.01;
/// Noise above this share of the limit hides it.
const LOUD: f64 = 0.1;
/// Minimum share of samples at the limit.
const SHARE: f64 = 0.05;
/// The same of spans: those that overlap at the peak of one movement have nearly the same speed.
const SHARE_OF_SPANS: f64 = 0.1;
/// Maximum share of faster samples, which noise may cause.
const FASTER: f64 = 0.01;
/// Minimum ratio to the number of samples in the next slower interval; peaks of equal movements are below 3.
const CROWDED: f64 = 3.0;
/// An axis whose mean velocity is this share of the plateau is pressed, not limited.
const STEADY: f64 = 0.9;

/// Reports the maximum speed of the robot, or of some of its axes. If noise of the velocities hides it, those over several steps of
/// the positions may show it.
pub(super) fn speed_limit(demonstrations: &Demonstrations, state: &[StateChannel], noise: &Noise) -> Option<Finding> {
    let deviation = velocity_variance(demonstrations, noise).sqrt();
    let of_samples = Speeds { velocities: all_velocities(demonstrations), deviation, equal: EQUAL, share: SHARE };
    let spans = if deviation > AUDIBLE * of_samples.usual() { &SPANS[..] } else { &[] };
    let found = of_samples.limit(state);
    drop(of_samples);
    found.or_else(|| {
        let of_steps = steps_variance(demonstrations, noise).sqrt();
        let of_spans = |steps: usize| Speeds {
            velocities: over_spans(demonstrations, steps),
            deviation: of_steps / steps as f64,
            equal: EQUAL * steps as f64,
            share: SHARE_OF_SPANS,
        };
        spans.iter().find_map(|&steps| of_spans(steps).limit(state))
    })
}

/// Velocities over spans of several steps, (n, N).
fn over_spans(demonstrations: &Demonstrations, steps: usize) -> DMatrix<f64> {
    let dim = demonstrations.dim();
    let mut all = Vec::with_capacity(demonstrations.n_samples() * dim);
    for movement in demonstrations.trajectories() {
        for end in steps..movement.n_samples() {
            let (from, to, seconds) =
                (movement.state(end - steps), movement.state(end), movement.seconds(end - steps, end));
            all.extend(to.iter().zip(from.iter()).map(|(to, from)| (to - from) / seconds));
        }
    }
    DMatrix::from_vec(dim, all.len() / dim, all)
}

/// Velocities whose sizes are compared.
struct Speeds {
    /// (n, N).
    velocities: DMatrix<f64>,
    /// Standard deviation of their noise along an axis.
    deviation: f64,
    /// Relative tolerance for equal speeds without noise.
    equal: f64,
    /// Minimum share of them at a limit.
    share: f64,
}

impl Speeds {
    /// Root mean square along an axis.
    fn usual(&self) -> f64 {
        (self.velocities.norm_squared() / self.velocities.len().max(1) as f64).sqrt()
    }

    fn limit(&self, state: &[StateChannel]) -> Option<Finding> {
        let speeds_by =
            |of: &dyn Fn(DVectorView<'_, f64>) -> f64| -> Vec<f64> { self.velocities.column_iter().map(of).collect() };
        if let Some(plateau) = self.plateau(speeds_by(&|u| u.norm())) {
            return Some(plateau.finding(""));
        }
        let axes: Vec<(Plateau, &str)> = (0..state.len())
            .filter_map(|axis| {
                let plateau = self.plateau(speeds_by(&|u| u[axis].abs()))?;
                let mean = self.velocities.row(axis).mean();
                (mean.abs() < STEADY * plateau.speed).then(|| (plateau, state[axis].name.as_str()))
            })
            .collect();
        let names: Vec<&str> = axes.iter().map(|&(_, name)| name).collect();
        axes.first().map(|(plateau, _)| plateau.finding(&format!(" along {}", names.join(", "))))
    }

    /// The fastest speed that many samples share.
    fn plateau(&self, mut speeds: Vec<f64>) -> Option<Plateau> {
        speeds.sort_by(f64::total_cmp);
        let samples = speeds.len() as f64;
        let below = |speed: f64| speeds.partition_point(|&other| other < speed);
        let within = |low: f64, high: f64| (below(high) - below(low)) as f64;
        let first = speeds.len().saturating_sub(1 + (samples * (FASTER + self.share)) as usize);
        let crowd = |&speed: &f64| {
            let width = (self.equal * speed).max(DEVIATIONS * self.deviation);
            (within(speed - width, speed + width), speed, width)
        };
        let (count, speed, width) = speeds[first..].iter().map(crowd).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let slower = within(speed - 3.0 * width, speed - width);
        let faster = (speeds.len() - below(speed + width)) as f64;
        let is_limit = self.deviation <= LOUD * speed
            && speed > 0.0
            && count >= self.share * samples
            && faster <= FASTER * samples
            && count >= CROWDED * slower;
        let median = below(speed - width) + (count / 2.0) as usize;
        is_limit.then(|| Plateau { speed: speeds[median], share: count / samples })
    }
}

struct Plateau {
    speed: f64,
    /// Share of all samples.
    share: f64,
}

impl Plateau {
    fn finding(&self, along: &str) -> Finding {
        let (share, speed) = (percent(self.share), short(self.speed));
        Finding::doubt(
            format!("{share} of the samples have the same largest speed{along}, {speed}: a speed limit?"),
            "at the limit only the policy's direction is observed: raise the limit, teach more slowly, or record the velocities that were commanded",
        )
    }
}
