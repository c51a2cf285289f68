//! Estimates the constraints of movements, once the policy is known: (S26) to (S29).
//!
//! If u = Nπ + A⁺b, the disagreement π̂ − u lies in the span of Aᵀ, and the velocity along the rows of A is constant, or 0, while A and b
//! are. Only both properties together identify the rows of A: the policy may have no component along a velocity that does not vary, and a
//! component of the disagreement may be the policy's error.

mod locked;
mod noise;
mod parts;
mod policy_at_rows;
mod projected_samples;
mod spaces;
mod stretch_estimate;
mod stretch_kind;

pub use stretch_estimate::{Acting, StretchEstimate};

use motion::{LearntPolicy, upper_median};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::rows::task_space::TaskSpace;
use crate::stretches::cut::MOST_SAMPLES;
use crate::stretches::partition::{Part, cheapest_parts, known_part};
use crate::stretches::segmentation::PARAMETER;
use crate::stretches::{MOST_DIMENSIONS, centred, evenly, parts};
use crate::{GpError, Rows};
use locked::held_channels;
use noise::noise;
use parts::{Parts, rarity_of};
use policy_at_rows::PolicyAtRows;
use projected_samples::{Disagreement, ProjectedSamples, SHARED};
use stretch_estimate::canonical;
use stretch_kind::{Movement, StretchKind};

/// Standard deviation of the policy in the first round, as a share of its root mean square. In the second round it is the one that the
/// first leaves.
const FIRST: f64 = 0.05;
/// Squared standard deviations above which something counts as seen.
const SEEN: f64 = 9.0;

/// Scatter assigned to a direction that is already a row of A, as a multiple of the total scatter, so that it exceeds that of any other
/// direction.
const VARIES: f64 = 4.0;

/// The constraints of all movements.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstraintEstimates {
    /// In the order of movements and time. Samples in no stretch are too few to decide.
    pub stretches: Vec<StretchEstimate>,
    /// s², the variance of a velocity along an axis.
    pub noise: f64,
    /// Variance of a component of the policy in regions that movements cover.
    pub policy_variance: f64,
}

impl ConstraintEstimates {
    /// Estimates the constraints of movements in given rows, with a policy learnt from these or other rows. Time grows with the number of
    /// movements, the square of their samples (up to 60) and the cube of a space's dimension. Spaces of more than twelve dimensions are not
    /// searched.
    ///
    /// # Errors
    /// [`GpError::Lengths`] if the policy or Jacobians do not match the rows, [`GpError::ShortMovements`] if no movement has four samples.
    pub fn of(rows: &Rows, policy: &dyn LearntPolicy, spaces: &[TaskSpace]) -> Result<Self, GpError> {
        let lengths = |what, found, expected| Err(GpError::Lengths { what, found, expected });
        if policy.dim() != rows.states().nrows() {
            return lengths("dimensions of the policy", policy.dim(), rows.states().nrows());
        }
        if let Some(at) = spaces.iter().position(|space| !space.fits(rows.len(), rows.dim())) {
            return lengths("Jacobians of a task space", spaces[at].jacobians.as_ref().map_or(0, Vec::len), rows.len());
        }
        let at: Vec<usize> = (0..rows.len()).collect();
        let movements = parts(rows, &at);
        let bases: Vec<Option<DMatrix<f64>>> = spaces.iter().map(|space| basis(space, rows.dim())).collect();
        let Some(noise) = noise(rows, &movements, spaces) else {
            let longest = movements.iter().map(|movement| movement.len()).max().unwrap_or(0);
            return Err(GpError::ShortMovements { longest, needed: 4 });
        };
        let policy = PolicyAtRows::of(rows, policy);
        let rarity = vec![0.0; spaces.len()];
        let mut search = Search { rows, movements, spaces, bases, noise, policy, rarity, still: false };
        let first = FIRST.powi(2) * search.policy.mean_square();
        let policy_variance = search.left(&search.parts(first)).unwrap_or(first);
        let pushing = search.parts_in_likely_spaces(policy_variance);
        let (cost, rarity) = (search.cost(&pushing), search.rarity.clone());
        // Noise makes fixed constraints appear to move, so either all move or none do.
        search.still = true;
        let mut parts = search.parts_in_likely_spaces(policy_variance);
        if search.cost(&parts) > cost {
            (search.rarity, search.still, parts) = (rarity, false, pushing);
        }
        let stretches = search.stretches(&parts, policy_variance);
        Ok(ConstraintEstimates { stretches, noise, policy_variance })
    }
}

/// Directions in which a space moves; `None` if it is not searched.
fn basis(space: &TaskSpace, dim: usize) -> Option<DMatrix<f64>> {
    space.moved(dim).map(|(basis, _)| basis).filter(|basis| basis.ncols() <= MOST_DIMENSIONS)
}

struct Search<'a> {
    rows: &'a Rows,
    movements: Vec<&'a [usize]>,
    spaces: &'a [TaskSpace],
    bases: Vec<Option<DMatrix<f64>>>,
    noise: f64,
    policy: PolicyAtRows<'a>,
    /// Costs of (S38).
    rarity: Vec<f64>,
    /// Whether b = 0 in all stretches.
    still: bool,
}

impl Search<'_> {
    /// [`Search::parts`], after estimating in which spaces most constraints are.
    fn parts_in_likely_spaces(&mut self, least: f64) -> Vec<Parts> {
        self.rarity.fill(0.0);
        let parts = self.parts(least);
        if self.spaces.len() == 1 {
            return parts;
        }
        self.rarity = rarity_of(&parts, self.spaces.len());
        drop(parts);
        self.parts(least)
    }

    /// Sum of (S28) and (S38) over all movements.
    fn cost(&self, parts: &[Parts]) -> f64 {
        let alone = PARAMETER * self.rows.dim() as f64;
        let movement_cost = |parts: &Parts| {
            let within: usize = parts.found.iter().map(|part| part.end - part.begin).sum();
            let costs = parts.found.iter().map(|part| parts.movement.cheapest(part.begin, part.end).0.0);
            costs.sum::<f64>() + alone * (parts.rows.len() - within) as f64
        };
        parts.iter().map(movement_cost).sum()
    }

    /// The parts of each movement, or of each section between known switches; `least` is the minimum variance of the policy.
    fn parts(&self, least: f64) -> Vec<Parts> {
        let parts = |movement: &&[usize]| {
            let known = self.rows.labels().is_some();
            let rows = if known { movement.to_vec() } else { evenly(movement, MOST_SAMPLES) };
            let movement = self.movement(&rows, least, SHARED);
            let alone = PARAMETER * self.rows.dim() as f64;
            let found = if known {
                known_part(rows.len(), alone, movement.costs()).into_iter().collect()
            } else {
                cheapest_parts(rows.len(), alone, movement.costs())
            };
            Parts { rows, movement, found }
        };
        self.movements.par_iter().map(parts).collect()
    }

    /// The row at which the part after a switch begins: the best of all rows between the two that were searched.
    fn switch(&self, parts: &Parts, (left, right): (&Part<StretchKind>, &Part<StretchKind>), least: f64) -> usize {
        let (last, first) = (parts.rows[left.end - 1], parts.rows[right.begin]);
        let between = last + 1..first;
        let mut rows = parts.rows[left.begin..left.end].to_vec();
        rows.extend(between.clone());
        rows.extend(&parts.rows[right.begin..right.end]);
        let movement = self.movement(&rows, least, SHARED);
        let cost = |cut: usize| movement.cheapest(0, cut).0.0 + movement.cheapest(cut, rows.len()).0.0;
        let cuts = left.end - left.begin..=left.end - left.begin + between.len();
        let best = cuts.map(|cut| (cost(cut), cut)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or(first, |(_, cut)| rows[cut])
    }

    /// Some rows of one movement, if this number of samples share one error of the policy.
    fn movement(&self, rows: &[usize], least: f64, sharing: f64) -> Movement {
        let velocities = self.rows.velocities().select_columns(rows);
        let disagreement = self.policy.actions.select_columns(rows) - &velocities;
        let weight = |variance: f64| 1.0 / (self.noise + sharing * variance.max(least));
        let weights = self.policy.variances(rows).into_iter().map(weight).collect();
        let disagreement = Disagreement::new(disagreement, weights, self.noise);
        let projected = |(space, basis): (&TaskSpace, &Option<DMatrix<f64>>)| {
            basis.as_ref().map(|basis| ProjectedSamples::of(space, basis, rows, &velocities, &disagreement, self.still))
        };
        let projected = self.spaces.iter().zip(&self.bases).map(projected).collect();
        Movement { disagreement, projected, rarity: self.rarity.clone(), still: self.still }
    }

    /// The policy's variance that all parts leave, as the median over them; `None` if there are none.
    fn left(&self, parts: &[Parts]) -> Option<f64> {
        let medians = |of: &Parts| -> Vec<f64> {
            of.found.iter().filter_map(|part| upper_median(of.movement.left(part))).collect()
        };
        upper_median(parts.iter().flat_map(medians).collect()).map(|square| (square - self.noise).max(0.0))
    }

    fn stretches(&self, parts: &[Parts], least: f64) -> Vec<StretchEstimate> {
        parts.par_iter().flat_map_iter(|of| self.of_movement(of, least)).collect()
    }

    fn of_movement(&self, of: &Parts, least: f64) -> Vec<StretchEstimate> {
        let with_gaps = of.with_gaps();
        let mut stretches: Vec<StretchEstimate> =
            with_gaps.iter().map(|(part, found)| self.stretch(of, part, *found, least)).collect();
        for (at, pair) in with_gaps.windows(2).enumerate() {
            let (left, right) = (&pair[0].0, &pair[1].0);
            if left.end == right.begin && of.rows[left.end - 1] + 1 < of.rows[right.begin] {
                let begin = self.switch(of, (left, right), least);
                stretches[at].samples.1 = self.rows.indices()[begin - 1].sample;
                stretches[at + 1].samples.0 = self.rows.indices()[begin].sample;
            }
        }
        stretches
    }

    fn stretch(&self, parts: &Parts, part: &Part<StretchKind>, found: bool, least: f64) -> StretchEstimate {
        let Parts { rows, movement, .. } = parts;
        let index = |at: usize| self.rows.indices()[rows[at]];
        // Known switches are used as given, even if a few samples beside them do not fit.
        let ends = if self.rows.labels().is_some() { (0, rows.len() - 1) } else { (part.begin, part.end - 1) };
        let dim = self.rows.dim();
        let mut stretch = StretchEstimate {
            trajectory: index(part.begin).trajectory,
            samples: (index(ends.0).sample, index(ends.1).sample),
            acting: if found { self.without(parts, part) } else { Acting::Changing },
            space: 0,
            matrix: DMatrix::zeros(0, dim),
            bound: DVector::zeros(0),
            bound_deviation: 0.0,
            speed: 0.0,
            angle: 0.0,
            evidence: 0.0,
            hidden: DMatrix::zeros(dim, 0),
        };
        let inside = &rows[part.begin..part.end];
        if let (Some((samples, directions, rank)), StretchKind::Constrained { space, .. }) =
            (movement.constraint(part), part.kind)
        {
            let change = samples.change((part.begin, part.end), &directions, rank, &movement.disagreement);
            stretch.acting = Acting::Constraint;
            stretch.space = space;
            stretch.matrix = canonical(&(&samples.basis * directions.first(rank)));
            stretch.angle = self.angle(inside, (space, rank), least);
            if samples.is_recorded() {
                let velocities = self.rows.velocities().select_columns(inside);
                if let Some(held) = held_channels(&stretch.matrix, &velocities, self.noise) {
                    (stretch.matrix, stretch.angle) = held;
                }
            }
            self.find_bound(&mut stretch, inside);
            stretch.evidence = -0.5 * change;
        }
        if found && self.spaces[stretch.space].jacobians.is_none() {
            stretch.hidden = self.hidden(&stretch.matrix, inside);
        }
        stretch
    }

    /// (S29) of a constraint on all of some rows. The policy's error counts once on a stretch, since errors along it are alike.
    fn angle(&self, rows: &[usize], (space, rank): (usize, usize), least: f64) -> f64 {
        let movement = self.movement(rows, least, SHARED.max(rows.len() as f64));
        let samples = movement.projected[space].as_ref();
        samples.map_or(0.0, |samples| samples.directions(0, rows.len(), self.noise).angle(rank))
    }

    /// Directions (n, r) other than the rows of A (k, n) along which velocities do not vary.
    fn hidden(&self, matrix: &DMatrix<f64>, rows: &[usize]) -> DMatrix<f64> {
        let velocities = self.rows.velocities().select_columns(rows);
        let varying = if self.still { velocities } else { centred(&velocities).1 };
        let scatter = &varying * varying.transpose() / self.noise;
        let varies = VARIES * (scatter.trace() + rows.len() as f64);
        let eigen = (scatter + matrix.tr_mul(matrix) * varies).symmetric_eigen();
        let least = 2.0 * rows.len() as f64 + SEEN;
        let hidden: Vec<usize> = (0..self.rows.dim()).filter(|&k| eigen.eigenvalues[k] < least).collect();
        eigen.eigenvectors.select_columns(&hidden)
    }

    /// Classifies a stretch without a constraint: it follows the policy, or the policy does not move there either.
    fn without(&self, parts: &Parts, part: &Part<StretchKind>) -> Acting {
        let seen = |at: usize| {
            let square = self.policy.actions.column(parts.rows[at]).norm_squared();
            square * parts.movement.disagreement.weights[at] > SEEN * self.rows.dim() as f64
        };
        let count = (part.begin..part.end).filter(|&at| seen(at)).count();
        if 2 * count >= part.end - part.begin { Acting::Nothing } else { Acting::Unseen }
    }

    /// Computes b, the standard deviation of its components, and the speed.
    fn find_bound(&self, stretch: &mut StretchEstimate, rows: &[usize]) {
        let (rank, count) = (stretch.matrix.nrows(), rows.len() as f64);
        let (mut sum, mut gain, mut square) = (DVector::zeros(rank), 0.0, 0.0);
        for &row in rows {
            let velocity = self.rows.velocities().column(row);
            let jacobian = self.spaces[stretch.space].jacobians.as_ref().map(|jacobians| &jacobians[row]);
            square += jacobian.map_or(velocity.norm_squared(), |jacobian| (jacobian * velocity).norm_squared());
            let through = jacobian.map_or_else(|| stretch.matrix.clone(), |jacobian| &stretch.matrix * jacobian);
            gain += through.norm_squared();
            sum += through * velocity;
        }
        stretch.bound = if self.still { DVector::zeros(rank) } else { sum / count };
        stretch.bound_deviation = (self.noise * gain / rank as f64).sqrt() / count;
        stretch.speed = (square / count).sqrt();
    }
}
