//! Channels in which only noise changes.

use motion::{Channel, Demonstrations, Finding, Verdict};

/// Movements of fewer samples do not tell noise from motion.
const SAMPLES: usize = 8;
/// Σ(step)² over Σ(value − mean of its movement)², from which a channel is noise: that of white noise is 2, that of ten samples of an even motion
/// .1, of more less.
const NOISE: f64 = 1.5;

/// Names channels that are held while noise remains, as that of an encoder: fits would take the noise for motion in a direction of its own.
/// None if all channels are so.
pub(crate) fn held(demonstrations: &Demonstrations, channels: &[Channel]) -> Option<Finding> {
    let long = || demonstrations.trajectories().iter().filter(|movement| movement.n_samples() >= SAMPLES);
    let is_held = |axis: &usize| {
        let (mut steps, mut squares) = (0.0, 0.0);
        for movement in long() {
            let values = movement.states().row(*axis);
            let mean = values.mean();
            squares += values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
            steps += (1..values.len()).map(|i| (values[i] - values[i - 1]).powi(2)).sum::<f64>();
        }
        squares > 0.0 && steps >= NOISE * squares
    };
    let held: Vec<usize> = (0..channels.len()).filter(is_held).collect();
    if held.is_empty() || held.len() == channels.len() {
        return None;
    }
    let names: Vec<&str> = held.iter().map(|&axis| &*channels[axis].name).collect();
    let verb = if held.len() == 1 { "is" } else { "are" };
    Some(Finding {
        verdict: Verdict::Doubtful,
        what: format!("{} {verb} held: only noise changes there, and would be mistaken for motion", names.join(", ")),
        next: format!("leave out what does not move: --ignore {}", names.join(",")),
    })
}
