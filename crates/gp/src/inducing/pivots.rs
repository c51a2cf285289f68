//! Selects the inducing rows by pivoted Cholesky (S34).

use linalg::transposed_product_of_rows;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::kernel::covariance::Covariance;
use crate::rows::thinning::scattered;

/// Number of candidates for each selected row.
const CANDIDATES: usize = 8;
/// Number of candidates whose variances are updated together.
const TOGETHER: usize = 256;
/// A row is linearly dependent on the selected ones if its variance is below this share of the largest prior variance.
const DEPENDENT: f64 = 1e-13;

/// At most `most` rows that represent all, in the order of selection: each has the largest variance given the previous ones; ties go to the
/// earlier row.
///
/// Candidates are the first rows of trajectories, which lie at the rim of the recorded region (up to half of all candidates), and one row
/// from each of equally many stretches of the other rows. Costs most² times the number of candidates.
pub(crate) fn pivots(
    covariance: &impl Covariance,
    amplitudes: &[f64],
    groups: &[Vec<usize>],
    most: usize,
) -> Vec<usize> {
    let candidates = candidates(groups, CANDIDATES * most);
    let with = covariance.with(&candidates, amplitudes);
    let mut remaining: Vec<f64> = candidates.iter().map(|&row| covariance.variance(row, amplitudes)).collect();
    let least = DEPENDENT * remaining.iter().copied().fold(0.0, f64::max);
    // The columns of the factor found so far, stored as rows; one column per candidate.
    let mut factor = DMatrix::zeros(most, candidates.len());
    let mut covariances = vec![0.0; candidates.len()];
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let largest = (0..candidates.len()).rev().max_by(|&a, &b| remaining[a].total_cmp(&remaining[b]));
        let Some(pivot) = largest.filter(|&pivot| remaining[pivot] > least) else { break };
        with(candidates[pivot], &mut covariances);
        let (done, root) = (chosen.len(), remaining[pivot].sqrt());
        let own = factor.view((0, pivot), (done, 1)).into_owned();
        let parts = factor.as_mut_slice().par_chunks_mut(most * TOGETHER);
        let each = parts.zip(remaining.par_chunks_mut(TOGETHER)).zip(covariances.par_chunks(TOGETHER));
        each.for_each(|((columns, remaining), covariances)| {
            let known = transposed_product_of_rows(columns, most, &own);
            for (at, remaining) in remaining.iter_mut().enumerate() {
                let next = (covariances[at] - known[at]) / root;
                columns[at * most + done] = next;
                *remaining -= next.powi(2);
            }
        });
        remaining[pivot] = f64::NEG_INFINITY;
        chosen.push(candidates[pivot]);
    }
    chosen
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
