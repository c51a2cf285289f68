use crate::kernel::block::{Block, length};
use crate::kernel::direct_block::DirectBlock;
use crate::kernel::shape::Shape;

/// A term that decays with distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// The kind of decay.
    pub fall: Fall,
    /// ℓ, in scaled coordinates.
    pub length: f64,
    /// Amplitude of its block.
    pub amplitude: f64,
}

/// Decay of a term with distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fall {
    /// Like a potential or velocity of this shape.
    Shape(Shape),
    /// Like [`Block::DivergenceFree`].
    DivergenceFree,
}

/// A term of a sum, and the relation of its exponential to the previous term's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    pub(crate) term: Term,
    /// Number of squarings of the previous exponential that give this one; `None` if it must be computed.
    pub(crate) squarings: Option<u32>,
}

/// Maximum number of squarings after one exponential. Each doubles the relative error, to 64 times 1e-16 in all.
const MOST_SQUARINGS: u32 = 6;

/// The exponential of a term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exponential {
    /// e^{−ρ²/2ℓ²}.
    Gaussian,
    /// e^{−√5 ρ/ℓ}.
    Matern52,
    /// e^{−√3 ρ/ℓ}.
    Matern32,
}

impl Fall {
    /// The exponential of this decay.
    pub(crate) fn exponential(self) -> Exponential {
        match self {
            Fall::Shape(Shape::SquaredExponential) | Fall::DivergenceFree => Exponential::Gaussian,
            Fall::Shape(Shape::Matern52) => Exponential::Matern52,
            Fall::Shape(Shape::Matern32) => Exponential::Matern32,
        }
    }
}

impl Term {
    /// The terms of the slope GP with positive amplitudes, in `dim` dimensions of state and context.
    pub(crate) fn of_slopes(blocks: &[Block], amplitudes: &[f64], dim: usize) -> Vec<Term> {
        terms(blocks, amplitudes, dim, |block| match block {
            Block::Potential(shape, scale) => Some((Fall::Shape(shape), scale)),
            Block::DivergenceFree(scale) => Some((Fall::DivergenceFree, scale)),
            Block::Linear | Block::Quadratic | Block::Skew => None,
        })
    }

    /// The terms of the direct GP.
    pub(crate) fn of_velocities(blocks: &[DirectBlock], amplitudes: &[f64], dim: usize) -> Vec<Term> {
        terms(blocks, amplitudes, dim, |block| match block {
            DirectBlock::Shape(shape, scale) => Some((Fall::Shape(shape), scale)),
            DirectBlock::Constant | DirectBlock::Linear | DirectBlock::Quadratic => None,
        })
    }

    /// Number of squarings that turn the exponential of a `longer` term into that of this one; `None` if their lengths do
    /// not differ by a power of two, or their exponentials are of different kinds.
    fn squarings_after(self, longer: Term) -> Option<u32> {
        let exponential = self.fall.exponential();
        let ratio = longer.length / self.length;
        let halvings = (0..=MOST_SQUARINGS).find(|&halvings| ratio == f64::from(1_u32 << halvings))?;
        let squarings = if exponential == Exponential::Gaussian { 2 * halvings } else { halvings };
        (longer.fall.exponential() == exponential).then_some(squarings)
    }
}

/// Orders the terms of each exponential from the longest to the shortest, with few exponentials: one, and squarings for
/// lengths that differ by powers of two.
pub(crate) fn steps(terms: &[Term]) -> Vec<Step> {
    let mut ordered = Vec::with_capacity(terms.len());
    for exponential in [Exponential::Gaussian, Exponential::Matern52, Exponential::Matern32] {
        let mut alike: Vec<Term> =
            terms.iter().copied().filter(|term| term.fall.exponential() == exponential).collect();
        alike.sort_by(|a, b| b.length.total_cmp(&a.length));
        ordered.extend(alike);
    }
    let (mut before, mut so_far) = (None, 0);
    let mut step = |term: Term| {
        let squarings = before.and_then(|longer| term.squarings_after(longer));
        let squarings = squarings.filter(|squarings| so_far + squarings <= MOST_SQUARINGS);
        so_far = squarings.map_or(0, |squarings| so_far + squarings);
        before = Some(term);
        Step { term, squarings }
    };
    ordered.into_iter().map(&mut step).collect()
}

fn terms<B: Copy>(blocks: &[B], amplitudes: &[f64], dim: usize, fall: impl Fn(B) -> Option<(Fall, f64)>) -> Vec<Term> {
    let each = blocks.iter().zip(amplitudes).filter(|(_, amplitude)| **amplitude > 0.0);
    let term =
        |(&block, &amplitude)| fall(block).map(|(fall, scale)| Term { fall, length: length(scale, dim), amplitude });
    each.filter_map(term).collect()
}
