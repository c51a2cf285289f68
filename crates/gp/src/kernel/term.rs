use crate::kernel::block::{Block, length};
use crate::kernel::direct_block::DirectBlock;
use crate::kernel::shape::Shape;

/// A term that falls with distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// How it falls.
    pub fall: Fall,
    /// ℓ, in scaled coordinates.
    pub length: f64,
    /// Of the block.
    pub amplitude: f64,
}

/// How a term falls with distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fall {
    /// As a potential or velocity of this shape.
    Shape(Shape),
    /// As [`Block::DivergenceFree`].
    DivergenceFree,
}

/// A term of a sum, and how its exponential follows from that of the term before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    pub(crate) term: Term,
    /// The exponential of the term before, squared so many times, is this one's; none where it must be computed.
    pub(crate) squarings: Option<u32>,
}

/// Squarings after one exponential: each doubles its relative error, 64 times 1e-16 in all.
const MOST_SQUARINGS: u32 = 6;

/// The exponential in a term.
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
    /// The exponential in it.
    pub(crate) fn exponential(self) -> Exponential {
        match self {
            Fall::Shape(Shape::SquaredExponential) | Fall::DivergenceFree => Exponential::Gaussian,
            Fall::Shape(Shape::Matern52) => Exponential::Matern52,
            Fall::Shape(Shape::Matern32) => Exponential::Matern32,
        }
    }
}

impl Term {
    /// The terms of the slope GP with an amplitude above 0, in `dim` dimensions of state and context.
    pub(crate) fn of_slopes(blocks: &[Block], amplitudes: &[f64], dim: usize) -> Vec<Term> {
        terms(blocks, amplitudes, dim, |block| match block {
            Block::Potential(shape, scale) => Some((Fall::Shape(shape), scale)),
            Block::DivergenceFree(scale) => Some((Fall::DivergenceFree, scale)),
            Block::Linear | Block::Quadratic | Block::Skew => None,
        })
    }

    /// Those of the direct GP.
    pub(crate) fn of_velocities(blocks: &[DirectBlock], amplitudes: &[f64], dim: usize) -> Vec<Term> {
        terms(blocks, amplitudes, dim, |block| match block {
            DirectBlock::Shape(shape, scale) => Some((Fall::Shape(shape), scale)),
            DirectBlock::Constant | DirectBlock::Linear | DirectBlock::Quadratic => None,
        })
    }

    /// Squarings that turn the exponential of a `longer` term into that of this one; none if their lengths are no power of
    /// two apart or they have not the same exponential.
    fn squarings_after(self, longer: Term) -> Option<u32> {
        let exponential = self.fall.exponential();
        let ratio = longer.length / self.length;
        let halvings = (0..=MOST_SQUARINGS).find(|&halvings| ratio == f64::from(1_u32 << halvings))?;
        let squarings = if exponential == Exponential::Gaussian { 2 * halvings } else { halvings };
        (longer.fall.exponential() == exponential).then_some(squarings)
    }
}

/// Terms from the longest to the shortest of each exponential, with few exponentials: one and squarings where lengths are
/// powers of two apart.
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
