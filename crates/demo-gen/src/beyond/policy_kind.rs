use motion::{Policy, Potential};
use rand::Rng;
use serde::Serialize;

use super::{Handwriting, LimitCycle, Planes, Swirl, Wells};
use crate::{DemoGenError, Sinusoidal};

/// The kind of the demonstrated policy, from which each data set draws one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum PolicyKind {
    /// The paper's sinusoidal potential on the plane, the same in every data set.
    Sinusoidal,
    /// Three wells ([`Wells::draw`]).
    Wells {
        /// Dimension n ≥ 1.
        dim: usize,
    },
    /// Three planes ([`Planes::draw`]).
    Planes {
        /// Dimension n ≥ 1.
        dim: usize,
        /// Width of the edges, in units of the state; 0 for kinks.
        edge: f64,
    },
    /// No potential: a swirl ([`Swirl::draw`]).
    Swirl {
        /// Dimension n ≥ 2.
        dim: usize,
    },
    /// No potential: round the unit circle on the plane, the same in every data set.
    LimitCycle,
    /// No potential: a line written on the plane ([`Handwriting::draw`]).
    Handwriting,
}

/// A policy given by its potential, or one without a potential.
pub(super) enum Field {
    OfPotential(Box<dyn Potential>),
    OfPolicy(Box<dyn Policy>),
}

/// The policy of one data set, and the region of its starts.
pub(super) struct Scene {
    pub(super) field: Field,
    /// Centre of the cube of starts, (n).
    pub(super) middle: Vec<f64>,
    /// Half its edge, in units of the state.
    pub(super) half_width: f64,
}

impl PolicyKind {
    /// Dimension n of the state.
    pub fn dim(self) -> usize {
        match self {
            PolicyKind::Wells { dim } | PolicyKind::Planes { dim, .. } | PolicyKind::Swirl { dim } => dim,
            PolicyKind::Sinusoidal | PolicyKind::LimitCycle | PolicyKind::Handwriting => 2,
        }
    }

    /// Whether its policy has a potential.
    pub fn has_potential(self) -> bool {
        matches!(self, PolicyKind::Sinusoidal | PolicyKind::Wells { .. } | PolicyKind::Planes { .. })
    }

    pub(super) fn check(self) -> Result<(), DemoGenError> {
        let least = if matches!(self, PolicyKind::Swirl { .. }) { 2 } else { 1 };
        match self {
            PolicyKind::Planes { edge, .. } if !(edge.is_finite() && edge >= 0.0) => Err(DemoGenError::Edge { edge }),
            _ if self.dim() < least => Err(DemoGenError::TooFewDimensions { found: self.dim(), least }),
            _ => Ok(()),
        }
    }

    pub(super) fn draw<R: Rng + ?Sized>(self, rng: &mut R) -> Scene {
        let middle = vec![0.0; self.dim()];
        let potential =
            |potential| Scene { field: Field::OfPotential(potential), middle: middle.clone(), half_width: 2.0 };
        let policy = |policy, half_width| Scene { field: Field::OfPolicy(policy), middle: middle.clone(), half_width };
        match self {
            PolicyKind::Sinusoidal => potential(Box::new(Sinusoidal { amplitude: 0.1 })),
            PolicyKind::Wells { dim } => potential(Box::new(Wells::draw(dim, rng))),
            PolicyKind::Planes { dim, edge } => potential(Box::new(Planes::draw(dim, edge, rng))),
            PolicyKind::Swirl { dim } => policy(Box::new(Swirl::draw(dim, rng)), 2.0),
            PolicyKind::LimitCycle => policy(Box::new(LimitCycle { speed: 0.15 }), 1.5),
            PolicyKind::Handwriting => {
                let line = Handwriting::draw(rng);
                let middle = line.start().iter().copied().collect();
                Scene { field: Field::OfPolicy(Box::new(line)), middle, half_width: 0.25 }
            }
        }
    }
}
