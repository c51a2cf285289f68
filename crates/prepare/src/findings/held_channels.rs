//! Channels in which only noise changes.

use motion::{Channel, Demonstrations, Finding};

/// In movements of fewer samples, noise cannot be distinguished from motion.
const SAMPLES: usize = 8;
/// Σ(step)² divided by Σ(value − mean of its movement)² above which a channel is noise. White noise has 2, ten samples of uniform motion
/// have .1, longer motion less.
const NOISE: f64 = 1.5;

/// Reports channels that are held still while noise remains, for example that of an encoder: a fit would mistake the noise for motion in a
/// separate direction. `None` if all channels are held.
pub(crate) fn held_channels(demonstrations: &Demonstrations, channels: &[Channel]) -> Option<Finding> {
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
    Some(Finding::doubt(
        format!("{} {verb} held: only noise changes there, and would be mistaken for motion", names.join(", ")),
        format!("leave out what does not move: --ignore {}", names.join(",")),
    ))
}
