use motion::{Decision, Demonstrations, Finding, LeftOut, MotionError, Trajectory};
use nalgebra::DVector;

use crate::notes::{PIECE, name_of_whole};
use crate::options::Smoothing;
use crate::samples::noise::{self, Noise};
use crate::{StateChannel, VelocitySource, findings};

/// Demonstrations ready for learning, with all decisions and findings.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Movements; states and velocities are multiplied by the channels' scales.
    pub demonstrations: Demonstrations,
    /// Name of each movement, (K).
    pub episodes: Vec<String>,
    /// Constraint label of each movement, (K), if the file has one label for all of its samples.
    pub constraints: Vec<Option<String>>,
    /// The n dimensions of the state.
    pub state: Vec<StateChannel>,
    /// The p dimensions of the context; empty if movements depend on the state alone.
    pub context: Vec<StateChannel>,
    /// Names of the channels whose scale the user gave.
    pub given_scales: Vec<String>,
    /// Median time step in seconds.
    pub time_step: f64,
    /// Noise of positions and velocities.
    pub noise: Noise,
    /// Source of the velocities.
    pub velocities: VelocitySource,
    /// Requested smoothing, already applied to the demonstrations unless it is automatic.
    pub smoothing: Smoothing,
    /// Number of consecutive samples averaged to one before learning; 1: none.
    pub averaged: usize,
    /// All automatic decisions, in order.
    pub decisions: Vec<Decision>,
    /// Reasons to doubt the data.
    pub findings: Vec<Finding>,
    /// Episodes that are not used.
    pub left_out: Vec<LeftOut>,
}

impl Prepared {
    /// For each movement, (K), the number of the recording that it is a part of: episodes that were split at jumps have several. If there is
    /// only one recording, its parts count as recordings.
    pub fn recordings(&self) -> Vec<usize> {
        let names = &self.episodes;
        let continues =
            |at: usize| names[at].contains(PIECE) && name_of_whole(&names[at]) == name_of_whole(&names[at - 1]);
        let mut count = 0;
        let number = |at: usize| {
            count += usize::from(at > 0 && !continues(at));
            count
        };
        let recordings: Vec<usize> = (0..names.len()).map(number).collect();
        if recordings.last() == Some(&0) { (0..names.len()).collect() } else { recordings }
    }

    /// The same movements with each context channel multiplied by a further factor, (p).
    ///
    /// # Errors
    /// [`MotionError`] if a product is not finite.
    pub fn with_context_scaled(&self, factors: &DVector<f64>) -> Result<Self, MotionError> {
        let scaled = |movement: &Trajectory| movement.clone().with_context(movement.context().component_mul(factors));
        let movements = self.demonstrations.trajectories().iter().map(scaled);
        let channel = |(of, factor): (&StateChannel, &f64)| StateChannel { scale: of.scale * factor, ..of.clone() };
        Ok(Prepared {
            demonstrations: Demonstrations::new(movements.collect::<Result<_, _>>()?)?,
            context: self.context.iter().zip(factors).map(channel).collect(),
            ..self.clone()
        })
    }

    /// The same movements with each state channel multiplied by a further factor, (n); adjusts the noise and the findings on units.
    /// The context is unchanged.
    ///
    /// # Errors
    /// [`MotionError`] if a product is not finite.
    ///
    /// # Panics
    /// If the number of factors differs from that of the channels.
    pub fn rescaled(&self, factors: &DVector<f64>) -> Result<Self, MotionError> {
        let movements = self.demonstrations.trajectories().iter().map(|movement| movement.scaled(factors));
        let demonstrations = Demonstrations::new(movements.collect::<Result<_, _>>()?)?;
        let scaled = |(of, factor): (&StateChannel, &f64)| StateChannel { scale: of.scale * factor, ..of.clone() };
        let state: Vec<StateChannel> = self.state.iter().zip(factors).map(scaled).collect();
        let others = self.findings.iter().filter(|finding| !finding.topic.depends_on_scale()).cloned();
        let anew = noise::of(&demonstrations);
        let noise = match self.smoothing {
            Smoothing::Auto | Smoothing::Off => {
                Noise { velocity_share: anew.velocity_share.or(self.noise.velocity_share), ..anew }
            }
            // Positions are already smooth: their noise is that of the recording, its share of the steps is that before scaling.
            Smoothing::Samples(_) | Smoothing::Seconds(_) => {
                let scaled =
                    |of: &Vec<f64>| of.iter().zip(factors).map(|(deviation, factor)| deviation * factor).collect();
                Noise {
                    positions: self.noise.positions.as_ref().map(scaled),
                    velocity_share: anew.velocity_share.or(self.noise.velocity_share),
                    step_share: self.noise.step_share,
                }
            }
        };
        // If smoothing was requested, velocities that count as exact may be differences.
        let velocities = match self.velocities {
            VelocitySource::Recorded if self.smoothing == Smoothing::Auto => noise::of_recorded(&demonstrations),
            VelocitySource::Noisy(_) => noise::of_recorded(&demonstrations),
            other => other,
        };
        Ok(Prepared {
            velocities,
            findings: others.chain(findings::depending_on_scale(&demonstrations, &state, &noise)).collect(),
            noise,
            state,
            demonstrations,
            ..self.clone()
        })
    }
}
