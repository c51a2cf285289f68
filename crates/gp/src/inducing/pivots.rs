//! Which rows stand for all: pivoted Cholesky (S34).

use rayon::prelude::*;

use crate::kernel::covariance::Covariance;

/// Rows that are candidates, for each that is chosen.
const CANDIDATES: usize = 8;
/// Share of the largest prior variance below which a row follows from those chosen.
const DEPENDENT: f64 = 1e-13;
/// (√5 − 1)/2: its multiples meet no period of a recording.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Rows that stand for others.
#[derive(Debug)]
pub(crate) struct Pivots {
    /// In the order of the choice.
    pub(crate) rows: Vec<usize>,
    /// Largest prior variance that is left, given them.
    pub(crate) remaining: f64,
}

/// At most `most` rows, the one with the largest variance given those before it first, ties to the earlier one.
///
/// Candidates are the first rows of trajectories, which are at the rim of what was recorded, as far as they are not more than
/// half of all candidates, and one row of each of equally many stretches of the others. Costs most² times as many candidates.
pub(crate) fn pivots(covariance: &impl Covariance, amplitudes: &[f64], groups: &[Vec<usize>], most: usize) -> Pivots {
    let candidates = candidates(groups, CANDIDATES * most);
    let with = covariance.with(&candidates, amplitudes);
    let mut remaining: Vec<f64> = candidates.iter().map(|&row| covariance.variance(row, amplitudes)).collect();
    let least = DEPENDENT * remaining.iter().copied().fold(0.0, f64::max);
    // Row by row the columns of the factor found so far.
    let mut factor = vec![0.0; candidates.len() * most];
    let mut covariances = vec![0.0; candidates.len()];
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let largest = (0..candidates.len()).rev().max_by(|&a, &b| remaining[a].total_cmp(&remaining[b]));
        let Some(pivot) = largest.filter(|&pivot| remaining[pivot] > least) else { break };
        with(candidates[pivot], &mut covariances);
        let (done, root) = (chosen.len(), remaining[pivot].sqrt());
        let own = factor[pivot * most..][..done].to_vec();
        let each = factor.par_chunks_mut(most).zip(remaining.par_iter_mut()).zip(&covariances);
        each.for_each(|((row, remaining), covariance)| {
            let known: f64 = row.iter().zip(&own).map(|(a, b)| a * b).sum();
            row[done] = (covariance - known) / root;
            *remaining -= row[done].powi(2);
        });
        remaining[pivot] = f64::NEG_INFINITY;
        chosen.push(candidates[pivot]);
    }
    Pivots { rows: chosen, remaining: remaining.into_iter().fold(0.0, f64::max) }
}

/// At most so many rows, in their order.
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
    let mut candidates: Vec<usize> = spread(&starts, of_starts).chain(spread(&others, of_others)).collect();
    candidates.sort_unstable();
    candidates
}

/// One of each of `count` equally long parts, at another place in each.
fn spread(rows: &[usize], count: usize) -> impl Iterator<Item = usize> {
    let apart = rows.len() as f64 / count as f64;
    (0..count).map(move |part| rows[((part as f64 + (GOLDEN * part as f64).fract()) * apart) as usize])
}
