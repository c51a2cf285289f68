use std::fmt;

use serde::{Deserialize, Serialize};

use crate::kernel::block::Block;
use crate::kernel::shape::Shape;

/// The smoothness of the policies in the prior. The marginal likelihood determines the amplitudes within a family; held-out
/// prediction selects the family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Squared exponential: for policies without kinks.
    Smooth,
    /// Matérn 5/2: for policies that change quickly, and for noisy ones.
    Medium,
    /// Matérn 3/2: for policies that may jump, that is, potentials with kinks.
    Rough,
}

/// Whether a potential may have a trend in addition to its shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// Every family contains a linear and a quadratic potential.
    #[default]
    Quadratic,
    /// Shapes alone, to measure the error if the family does not contain the truth.
    None,
}

impl Family {
    /// All families, in the order in which ties are decided.
    pub const ALL: [Family; 3] = [Family::Smooth, Family::Medium, Family::Rough];

    /// The family's shape.
    pub fn shape(self) -> Shape {
        match self {
            Family::Smooth => Shape::SquaredExponential,
            Family::Medium => Shape::Matern52,
            Family::Rough => Shape::Matern32,
        }
    }

    /// The family's blocks in the slope GP: the trend, then one shape at four scales.
    pub fn blocks(self, trend: Trend) -> Vec<Block> {
        let scales = match self {
            Family::Smooth => [0.25, 0.5, 1.0, 2.0],
            Family::Medium | Family::Rough => [0.5, 1.0, 2.0, 4.0],
        };
        let trend: &[Block] = match trend {
            Trend::Quadratic => &[Block::Linear, Block::Quadratic],
            Trend::None => &[],
        };
        trend.iter().copied().chain(scales.map(|scale| Block::Potential(self.shape(), scale))).collect()
    }

    /// Amplitudes of `blocks`, (B), for the second search of a family: long scales alone. Only (S8) of `smooth` has a
    /// minimum there that the first search misses.
    pub(crate) fn second_start(self, blocks: &[Block]) -> Option<Vec<f64>> {
        let amplitude = |block: &Block| match block {
            Block::Potential(_, scale) | Block::DivergenceFree(scale) if *scale >= 1.0 => 1.0,
            _ => 0.01,
        };
        (self == Family::Smooth).then(|| blocks.iter().map(amplitude).collect())
    }

    /// The same with blocks for rotation: a Helmholtz decomposition, which has no potential.
    pub fn helmholtz_blocks(self, trend: Trend) -> Vec<Block> {
        let rotation = [Block::Skew].into_iter().chain([0.25, 0.5, 1.0, 2.0].map(Block::DivergenceFree));
        self.blocks(trend).into_iter().chain(rotation).collect()
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Family::Smooth => "smooth",
            Family::Medium => "medium",
            Family::Rough => "rough",
        })
    }
}
