//! The kind of a part of a movement: free, or under a constraint of some rank in some space.

use super::projected_samples::{Directions, Disagreement, ProjectedSamples};
use crate::stretches::partition::{Costs, Growing, Part, SPARE};
use crate::stretches::segmentation::{DIMENSION, PARAMETER, SEGMENT};

/// Free, or under a constraint that is constant in a space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StretchKind {
    Free,
    Constrained { space: usize, rank: usize },
}

/// One movement, projected onto all spaces.
pub(super) struct Movement {
    pub(super) disagreement: Disagreement,
    /// `None` for a space that is not searched.
    pub(super) projected: Vec<Option<ProjectedSamples>>,
    /// Additional cost (S38) of a constraint in each space, for its rarity.
    pub(super) rarity: Vec<f64>,
    /// Whether b = 0.
    pub(super) still: bool,
}

impl Movement {
    /// (S28): the least cost of samples `begin..end` and its kind; also minus twice the log likelihood of each rank from 1 on, in the
    /// recorded coordinates.
    pub(super) fn cheapest(&self, begin: usize, end: usize) -> ((f64, StretchKind), Vec<f64>) {
        let none = self.disagreement.square(begin, end);
        let mut best = (none + SEGMENT, StretchKind::Free);
        let mut of_ranks = Vec::new();
        for (space, samples) in self.projected.iter().enumerate() {
            let Some(samples) = samples else { continue };
            let directions = samples.directions(begin, end, self.disagreement.noise);
            if samples.is_recorded() {
                let sums = directions.values.iter().scan(none, |sum, value| {
                    *sum += value;
                    Some(*sum)
                });
                of_ranks = sums.collect();
            }
            if let Some((cost, rank)) = self.best_rank(samples, &directions, (begin, end)) {
                let cost = cost + self.rarity[space];
                if cost < best.0 {
                    best = (cost, StretchKind::Constrained { space, rank });
                }
            }
        }
        (best, of_ranks)
    }

    /// Costs of all parts, for one search.
    pub(super) fn costs(&self) -> MovementCosts<'_> {
        let recorded = self.projected.iter().flatten().filter(|samples| samples.is_recorded());
        let varies = recorded.map(ProjectedSamples::variation).sum::<f64>() / self.disagreement.noise;
        let left = Growing::new(self.disagreement.weights.len(), self.disagreement.total() + varies);
        let bounded = self.projected.iter().flatten().all(ProjectedSamples::is_recorded);
        MovementCosts { movement: self, left, bounded }
    }

    /// The least cost of a constraint in one space, and its rank; `None` if no rank is possible.
    fn best_rank(
        &self,
        samples: &ProjectedSamples,
        directions: &Directions,
        (begin, end): (usize, usize),
    ) -> Option<(f64, usize)> {
        let (none, dim) = (self.disagreement.square(begin, end), directions.values.len());
        let mut best: Option<(f64, usize)> = None;
        for rank in 1..=dim {
            if directions.values[rank - 1] >= 0.0 {
                break;
            }
            if end - begin < dim - rank + SPARE || directions.angle(rank) > MOST_ANGLE {
                continue;
            }
            let change = samples.change((begin, end), directions, rank, &self.disagreement);
            let cost = none + change + self.price((begin, end), dim, rank) + SEGMENT;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rank));
            }
        }
        best
    }

    /// (S28) of a part in each space, without the cost of rarity; infinite if no rank is possible.
    pub(super) fn costs_in_spaces(&self, part: &Part<StretchKind>) -> Vec<f64> {
        let ends = (part.begin, part.end);
        let cost = |samples: &ProjectedSamples| {
            let directions = samples.directions(ends.0, ends.1, self.disagreement.noise);
            self.best_rank(samples, &directions, ends).map(|(cost, _)| cost)
        };
        self.projected.iter().map(|samples| samples.as_ref().and_then(cost).unwrap_or(f64::INFINITY)).collect()
    }

    /// Cost of the parameters of A with `rank` rows, and of b unless it is 0. It is less if velocities are known better than the policy,
    /// because a velocity that does not vary is then unlikely to do so by chance.
    fn price(&self, (begin, end): (usize, usize), dim: usize, rank: usize) -> f64 {
        let parameters = PARAMETER * (rank * (dim - rank + usize::from(!self.still))) as f64;
        let accident = self.disagreement.accident(begin, end);
        rank as f64 * (parameters / rank as f64 + DIMENSION - accident).max(ROW)
    }

    /// The samples and the directions of a part with a constraint, and its rank.
    pub(super) fn constraint(&self, part: &Part<StretchKind>) -> Option<(&ProjectedSamples, Directions, usize)> {
        let StretchKind::Constrained { space, rank } = part.kind else { return None };
        let samples = self.projected[space].as_ref()?;
        Some((samples, samples.directions(part.begin, part.end, self.disagreement.noise), rank))
    }

    /// |Nd|² of a part's samples, each divided by the number of dimensions that the constraint leaves free.
    pub(super) fn left(&self, part: &Part<StretchKind>) -> Vec<f64> {
        let of = &self.disagreement.of;
        let squares = |at: usize| of.column(at).norm_squared();
        let (rank, squares): (usize, Vec<f64>) = match self.constraint(part) {
            None => (0, (part.begin..part.end).map(squares).collect()),
            Some((samples, directions, rank)) => {
                let rows = directions.first(rank);
                (rank, (part.begin..part.end).map(|at| samples.left(at, &rows, &self.disagreement)).collect())
            }
        };
        let freedom = of.nrows() - rank;
        if freedom == 0 { Vec::new() } else { squares.into_iter().map(|square| square / freedom as f64).collect() }
    }
}

/// (S28) of all parts of a movement.
pub(super) struct MovementCosts<'a> {
    movement: &'a Movement,
    /// Minus twice the log likelihood of each rank in the recorded coordinates; each is the minimum of a sum of squares.
    left: Growing,
    /// Whether only the recorded coordinates are searched.
    bounded: bool,
}

impl Costs for MovementCosts<'_> {
    type Kind = StretchKind;

    fn cost(&mut self, begin: usize, end: usize) -> (f64, StretchKind) {
        let (cheapest, of_ranks) = self.movement.cheapest(begin, end);
        self.left.see(begin, &of_ranks);
        cheapest
    }

    fn at_least(&self, begin: usize, end: usize) -> f64 {
        if !self.bounded {
            return 0.0;
        }
        let dim = self.movement.disagreement.of.nrows();
        let least_cost =
            |rank| self.left.at_least(begin, rank - 1) + self.movement.price((begin, end), dim, rank) + SEGMENT;
        let possible = (1..=dim).filter(|rank| end - begin + rank >= dim + SPARE);
        possible.map(least_cost).fold(self.movement.disagreement.square(begin, end) + SEGMENT, f64::min)
    }
}

/// Minimum cost of a row of A: three standard deviations of the policy's blocked component, squared.
const ROW: f64 = 9.0;
/// Maximum uncertainty of a row, in radians. The angle of a direction that was merely not used is arbitrary.
const MOST_ANGLE: f64 = 0.25;
