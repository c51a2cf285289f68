//! Posterior means as explicit formulas, for programs that evaluate them without this crate.

use nalgebra::{DMatrix, DVector};

use crate::kernel::direct_block;
use crate::kernel::falling::Falling;
use crate::kernel::term::Term;
use crate::rows::scaling::Scaling;
use crate::{DirectFit, SlopeFit};

/// Scaled coordinates z = (x − mean) / spread, and the learnt states in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaledStates<'a> {
    /// Mean of the states, (n).
    pub mean: &'a [f64],
    /// One scale for all axes.
    pub spread: f64,
    /// Unit of speed, in units of the state per second.
    pub speed: f64,
    /// z', (n, M).
    pub z: &'a DMatrix<f64>,
}

/// (S7): π̂ = speed (Σ g v − h (vᵀa) a + c + Qz) with a = z − z', and g and h of (S3) summed over terms.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeFormula<'a> {
    /// Coordinates and learnt states.
    pub scaled: ScaledStates<'a>,
    /// v = α n, (n, M).
    pub directions: DMatrix<f64>,
    /// Terms with positive amplitudes.
    pub terms: Vec<Term>,
    /// g and h of the same terms, evaluated with few exponentials.
    pub falling: &'a Falling,
    /// c, (n).
    pub constant: DVector<f64>,
    /// Q, (n, n).
    pub matrix: DMatrix<f64>,
    /// Whether π̂ is the negative gradient of φ̂ = −speed · spread (Σ g vᵀa + zᵀ(c + Qz/2)).
    pub has_potential: bool,
}

/// (R4): û = speed Σ k(z, z') A, where k is the sum of the terms and of the trend's covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectFormula<'a> {
    /// Coordinates and learnt states.
    pub scaled: ScaledStates<'a>,
    /// A, (n, M).
    pub weights: &'a DMatrix<f64>,
    /// Terms with positive amplitudes.
    pub terms: Vec<Term>,
    /// The sum of the terms, evaluated with few exponentials.
    pub falling: &'a Falling,
    /// Factors of 1, of zᵀz' and of its square.
    pub trend: [f64; 3],
}

impl SlopeFit {
    /// The policy as an explicit formula.
    pub fn formula(&self) -> SlopeFormula<'_> {
        let expansion = self.model.expansion();
        SlopeFormula {
            scaled: ScaledStates::of(&expansion.scaling, expansion.speed, &expansion.z),
            directions: expansion.weighted(),
            terms: Term::of_slopes(&expansion.blocks, &expansion.amplitudes, expansion.dim()),
            falling: &expansion.falling,
            // Converts −0 to 0: without a trend nothing is added.
            constant: expansion.constant.add_scalar(0.0),
            matrix: expansion.matrix.add_scalar(0.0),
            has_potential: self.potential().is_some(),
        }
    }
}

impl DirectFit {
    /// The policy as an explicit formula.
    pub fn formula(&self) -> DirectFormula<'_> {
        let (model, dim) = (&self.model, self.model.z.nrows());
        DirectFormula {
            scaled: ScaledStates::of(&model.scaling, model.unit, &model.z),
            weights: &model.weights,
            terms: Term::of_velocities(&model.blocks, &model.amplitudes, dim),
            falling: &model.falling,
            trend: direct_block::trend(&model.blocks, &model.amplitudes, dim),
        }
    }
}

impl<'a> ScaledStates<'a> {
    fn of(scaling: &'a Scaling, speed: f64, z: &'a DMatrix<f64>) -> Self {
        ScaledStates { mean: &scaling.mean, spread: scaling.scale, speed, z }
    }
}
