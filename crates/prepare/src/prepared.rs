use gp::FrontEnd;
use motion::Demonstrations;
use smoothing::Smoother;

use crate::episodes::Take;
use crate::noise::Noise;
use crate::options::Smoothing;
use crate::{Decision, Finding, LeftOutEpisode, StateChannel, Verdict};

/// Demonstrations ready for learning, with all decisions and findings.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Movements, states and velocities times the channels' scales.
    pub demonstrations: Demonstrations,
    /// Name of each movement, (K).
    pub episodes: Vec<String>,
    /// Label of the constraint of each movement, (K), where the file has one.
    pub constraints: Vec<Option<String>>,
    /// Dimensions of the state, n of them.
    pub state: Vec<StateChannel>,
    /// Median time step in seconds.
    pub time_step: f64,
    /// Noise of positions and velocities.
    pub noise: Noise,
    /// How the learners should read the recordings.
    pub recorded: Recorded,
    /// Requested smoothing, already applied to the demonstrations unless it is automatic.
    pub smoothing: Smoothing,
    /// Number of consecutive samples averaged to one before learning; 1: none.
    pub averaged: usize,
    /// All automatic decisions, in order.
    pub decisions: Vec<Decision>,
    /// Reasons to doubt the data.
    pub findings: Vec<Finding>,
    /// Episodes that are not used.
    pub left_out: Vec<LeftOutEpisode>,
}

/// The kind of recording, for the learners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recorded {
    /// Exact positions and velocities.
    Velocities,
    /// Exact velocities, noisy positions.
    FusedVelocities,
    /// Velocities with noise of this variance along each axis.
    NoisyVelocities(f64),
    /// Positions alone.
    Positions,
    /// Positions alone, taken as they stand: smoothed as the user said, or not at all.
    PositionsAsRequested,
}

impl Recorded {
    /// The front end that makes rows of a Gaussian process from it.
    pub fn front_end(self) -> FrontEnd {
        match self {
            Recorded::Velocities | Recorded::NoisyVelocities(_) | Recorded::PositionsAsRequested => {
                FrontEnd::Velocities
            }
            Recorded::FusedVelocities => FrontEnd::Fused(smoothing::Fusion::default()),
            Recorded::Positions => FrontEnd::Smoothed(Smoother::default()),
        }
    }
}

/// Decisions and findings collected while preparing.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    pub(crate) decisions: Vec<Decision>,
    pub(crate) findings: Vec<Finding>,
    pub(crate) left_out: Vec<LeftOutEpisode>,
}

impl Notes {
    pub(crate) fn decided(&mut self, what: &str, value: impl Into<String>, why: impl Into<String>, flag: &str) {
        let (what, flag) = (what.to_owned(), flag.to_owned());
        self.decisions.push(Decision { what, value: value.into(), why: why.into(), flag });
    }

    pub(crate) fn found(&mut self, verdict: Verdict, what: impl Into<String>, next: impl Into<String>) {
        self.findings.push(Finding { verdict, what: what.into(), next: next.into() });
    }

    pub(crate) fn left_out(&mut self, episode: &str, why: impl Into<String>) {
        self.left_out.push(LeftOutEpisode { episode: episode.to_owned(), why: why.into() });
    }
}

impl Prepared {
    pub(crate) fn new(
        demonstrations: Demonstrations,
        takes: &[Take],
        state: Vec<StateChannel>,
        noise: Noise,
        (recorded, smoothing, averaged): (Recorded, Smoothing, usize),
        notes: Notes,
    ) -> Self {
        let mut steps: Vec<f64> = demonstrations.trajectories().iter().map(motion::Trajectory::time_step).collect();
        let middle = steps.len() / 2;
        let time_step = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let Notes { decisions, findings, left_out } = notes;
        Prepared {
            demonstrations,
            episodes: takes.iter().map(|take| take.name.clone()).collect(),
            constraints: takes.iter().map(|take| take.constraint.clone()).collect(),
            state,
            time_step,
            noise,
            recorded,
            smoothing,
            averaged,
            decisions,
            findings,
            left_out,
        }
    }
}
