//! Anomalies of movements: steps that stand out, movements that stand still or occur twice.

use std::collections::HashMap;

use nalgebra::DMatrix;

use crate::median::upper_median;

/// A step longer than so many usual ones stands out.
const LONG: f64 = 10.0;
/// So many steps about a step tell what is usual there, itself included.
const ABOUT: usize = 7;

/// Whether all states (n, N) are the same.
pub fn stands_still(states: &DMatrix<f64>) -> bool {
    states.column_iter().all(|state| state == states.column(0))
}

/// A step that stands out from all about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongStep {
    /// The sample before it.
    pub sample: usize,
    /// Its length in median steps.
    pub times: f64,
}

/// The steps of a movement (n, N) that are over ten times the median of those that move, and over ten times most of the
/// seven about them, in order.
///
/// Speeds may well differ more than that from start to end, and where a constraint gives way; a single step that stands
/// out from its neighbours does not come about so.
pub fn long_steps(states: &DMatrix<f64>) -> Vec<LongStep> {
    let squared = |i: usize| {
        let (here, next) = (states.column(i), states.column(i + 1));
        here.iter().zip(next.iter()).map(|(a, b)| (b - a).powi(2)).sum::<f64>()
    };
    let steps: Vec<f64> = (0..states.ncols().saturating_sub(1)).map(|i| squared(i).sqrt()).collect();
    let Some(usual) = upper_median(steps.iter().copied().filter(|&step| step > 0.0).collect()) else {
        return Vec::new();
    };
    let stands_out = |&i: &usize| {
        let first = i.saturating_sub(ABOUT / 2).min(steps.len().saturating_sub(ABOUT));
        let about = &steps[first..(first + ABOUT).min(steps.len())];
        let shorter = about.iter().filter(|&&other| LONG * other < steps[i]).count();
        steps[i] > LONG * usual && 2 * shorter > about.len()
    };
    let long = (0..steps.len()).filter(stands_out);
    long.map(|sample| LongStep { sample, times: steps[sample] / usual }).collect()
}

/// For each movement (n, N_k) the first before it that has the same states, if there is one. O(M) for M samples.
pub fn duplicates<'a>(movements: impl IntoIterator<Item = &'a DMatrix<f64>>) -> Vec<Option<usize>> {
    let mut first = HashMap::<(usize, Vec<u64>), usize>::new();
    let duplicate = |(index, states): (usize, &DMatrix<f64>)| {
        // Adding 0 makes −0 a 0.
        let bits = states.iter().map(|x| (x + 0.0).to_bits()).collect();
        let found = *first.entry((states.nrows(), bits)).or_insert(index);
        (found < index).then_some(found)
    };
    movements.into_iter().enumerate().map(duplicate).collect()
}

/// Whether one movement (n, N) is the other, run backwards.
pub fn mirrored(a: &DMatrix<f64>, b: &DMatrix<f64>) -> bool {
    a.shape() == b.shape() && a.column_iter().rev().zip(b.column_iter()).all(|(a, b)| a == b)
}
