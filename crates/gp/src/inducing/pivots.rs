//! Selects the inducing rows by pivoted Cholesky (S34).

use std::mem;

use nalgebra::{DVectorView, Dyn, U1};
use rayon::prelude::*;

use crate::kernel::covariance::Covariance;
use crate::rows::thinning::scattered;

/// Number of candidates for each selected row.
const CANDIDATES: usize = 8;
/// Number of candidates that are updated together, and number of these that read a pivot's entries one after the other.
const TOGETHER: usize = 128;
const ABREAST: usize = 16;
/// A row is linearly dependent on the selected ones if its variance is below this share of the largest prior variance.
const DEPENDENT: f64 = 1e-13;

/// At most `most` rows that represent all, in the order of selection: each has the largest variance given the previous ones; ties go to the
/// earlier row.
///
/// Candidates are the first rows of trajectories, which lie at the rim of the recorded region (up to half of all candidates), and one row
/// from each of equally many stretches of the other rows. Costs at most most² times the number of candidates: variances only decrease, so
/// that a candidate is updated only if its variance given fewer pivots is among the largest.
pub(crate) fn pivots(
    covariance: &impl Covariance,
    amplitudes: &[f64],
    groups: &[Vec<usize>],
    most: usize,
) -> Vec<usize> {
    let rows = candidates(groups, CANDIDATES * most);
    let with = covariance.with(&rows, amplitudes);
    let prior = |&row: &usize| covariance.variance(row, amplitudes);
    let candidates: Vec<CandidateRow> =
        rows.iter().map(prior).map(|variance| CandidateRow::new(variance, most)).collect();
    let least = DEPENDENT * candidates.iter().map(|candidate| candidate.variance).fold(0.0, f64::max);
    let mut search = PivotedCholesky { chosen: Vec::new(), candidates };
    let mut covariances = vec![0.0; rows.len()];
    while search.chosen.len() < most {
        let Some(next) = search.largest().filter(|&at| search.candidates[at].variance > least) else { break };
        with(rows[next], &mut covariances);
        search.choose(next, &covariances);
    }
    search.chosen.iter().map(|&at| rows[at]).collect()
}

/// The factorisation of the covariance between candidates.
struct PivotedCholesky {
    /// The pivots.
    chosen: Vec<usize>,
    candidates: Vec<CandidateRow>,
}

/// A row that may be selected.
#[derive(Default)]
struct CandidateRow {
    /// Entries of the factor for the first `known` pivots, then covariances with the later ones.
    entries: Vec<f64>,
    known: usize,
    /// The variance given the first `known` pivots; −∞ for a pivot.
    variance: f64,
}

impl PivotedCholesky {
    /// The candidate with the largest variance given all pivots.
    fn largest(&mut self) -> Option<usize> {
        loop {
            let variance = |at: usize| self.candidates[at].variance;
            let order = |a: &usize, b: &usize| variance(*b).total_cmp(&variance(*a)).then(a.cmp(b));
            let largest = (0..self.candidates.len()).min_by(order)?;
            let is_open =
                |&at: &usize| self.candidates[at].known < self.chosen.len() && variance(at) > f64::NEG_INFINITY;
            if !is_open(&largest) {
                return Some(largest);
            }
            let mut open: Vec<usize> = (0..self.candidates.len()).filter(is_open).collect();
            if open.len() > TOGETHER {
                open.select_nth_unstable_by(TOGETHER, order);
                open.truncate(TOGETHER);
            }
            self.update(&open);
        }
    }

    /// Conditions these candidates on all pivots.
    fn update(&mut self, open: &[usize]) {
        let mut taken: Vec<CandidateRow> = open.iter().map(|&at| mem::take(&mut self.candidates[at])).collect();
        let pivots: Vec<&[f64]> = self.chosen.iter().map(|&at| &*self.candidates[at].entries).collect();
        taken.par_chunks_mut(ABREAST).for_each(|some| {
            for (count, pivot) in pivots.iter().enumerate() {
                some.iter_mut()
                    .filter(|candidate| candidate.known == count)
                    .for_each(|candidate| candidate.given(pivot));
            }
        });
        open.iter().zip(taken).for_each(|(&at, candidate)| self.candidates[at] = candidate);
    }

    /// Makes a candidate that is conditioned on all pivots the next one, given its covariances with all candidates.
    fn choose(&mut self, next: usize, covariances: &[f64]) {
        let pivot = &mut self.candidates[next];
        pivot.entries.push(pivot.variance.sqrt());
        pivot.variance = f64::NEG_INFINITY;
        self.chosen.push(next);
        let others =
            self.candidates.iter_mut().zip(covariances).filter(|(other, _)| other.variance > f64::NEG_INFINITY);
        others.for_each(|(other, &covariance)| other.entries.push(covariance));
    }
}

impl CandidateRow {
    fn new(variance: f64, most: usize) -> Self {
        CandidateRow { entries: Vec::with_capacity(most), known: 0, variance }
    }

    /// Conditions on one more pivot, given its entries.
    fn given(&mut self, pivot: &[f64]) {
        let first = |entries| DVectorView::from_slice_generic(entries, Dyn(self.known), U1);
        let explained = first(pivot).dot(&first(&self.entries));
        let entry = (self.entries[self.known] - explained) / pivot[self.known];
        self.entries[self.known] = entry;
        self.variance -= entry.powi(2);
        self.known += 1;
    }
}

/// At most `most` candidates, in the order of the rows.
fn candidates(groups: &[Vec<usize>], most: usize) -> Vec<usize> {
    let count: usize = groups.iter().map(Vec::len).sum();
    if count <= most {
        let mut all = groups.concat();
        all.sort_unstable();
        return all;
    }
    let starts: Vec<usize> = groups.iter().map(|rows| rows[0]).collect();
    let others: Vec<usize> = groups.iter().flat_map(|rows| &rows[1..]).copied().collect();
    let of_starts = starts.len().min(most / 2);
    let of_others = others.len().min(most - of_starts);
    let mut candidates: Vec<usize> = scattered(starts.len(), of_starts, 0.0)
        .map(|at| starts[at])
        .chain(scattered(others.len(), of_others, 0.0).map(|at| others[at]))
        .collect();
    candidates.sort_unstable();
    candidates
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::kernel::block::Block;
    use crate::kernel::covariance::among;
    use crate::kernel::shape::Shape;
    use crate::kernel::slope_covariance::SlopeCovariance;

    proptest! {
        /// Compares with the literal definition: each row has the largest diagonal entry of the Schur complement of the previous ones.
        #[test]
        fn each_pivot_has_the_largest_variance_given_the_previous_ones(
            count in 20usize..300, dim in 1usize..4, most in 1usize..40, rough in 0.2f64..2.0, seed in any::<u64>(),
        ) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let z = DMatrix::from_fn(dim, count, |_, _| rng.random_range(-1.5..1.5));
            let mut n = DMatrix::from_fn(dim, count, |_, _| rng.random_range(-1.0..1.0));
            n.column_iter_mut().for_each(|mut n| { n.normalize_mut(); });
            let blocks = [Block::Linear, Block::Potential(Shape::SquaredExponential, rough)];
            let covariance = SlopeCovariance { blocks: &blocks, z: &z, n: &n };
            let amplitudes = [0.3, 1.0];
            let groups: Vec<Vec<usize>> = (0..count).collect::<Vec<_>>().chunks(10).map(<[usize]>::to_vec).collect();
            let chosen = pivots(&covariance, &amplitudes, &groups, most);
            let rows = candidates(&groups, CANDIDATES * most);
            let mut left = among(&covariance, &rows, &amplitudes);
            let scale = left.diagonal().max();
            for &row in &chosen {
                let at = rows.binary_search(&row).unwrap();
                prop_assert!(left[(at, at)] >= left.diagonal().max() - 1e-9 * scale);
                let column = left.column(at) / left[(at, at)].sqrt();
                left -= &column * column.transpose();
            }
            // No more rows only if all the others depend on the chosen ones.
            prop_assert!(chosen.len() == most.min(rows.len()) || left.diagonal().max() <= 1e-9 * scale);
        }
    }
}
