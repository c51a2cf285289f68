//! Anomalies of movements: outlying steps, and movements that stand still or occur twice.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use nalgebra::DMatrix;

use crate::statistics::upper_median;

/// A step longer than this many typical steps is an outlier.
const LONG: f64 = 10.0;
/// Number of steps, including the step itself, that determine the typical length around a step.
const ABOUT: usize = 7;

/// Whether all states (n, N) are the same.
pub fn stands_still(states: &DMatrix<f64>) -> bool {
    states.column_iter().all(|state| state == states.column(0))
}

/// A step that is much longer than its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongStep {
    /// The sample before the step.
    pub sample: usize,
    /// Its length in median steps.
    pub times: f64,
}

/// The steps of a movement (n, N) that are over ten times the median of its nonzero steps, and over ten times most of
/// the seven steps around them, in order. If samples are unevenly spaced, at `times` (N), the length of a step that takes more than the
/// median time is divided by their quotient, because samples are missing there.
///
/// Speeds may differ by more than that between start and end, and where a constraint gives way; but these do not make a
/// single step longer than all its neighbours.
pub fn long_steps(states: &DMatrix<f64>, times: Option<&[f64]>) -> Vec<LongStep> {
    let seconds = times.map(|times| times.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>());
    let usual = seconds.as_ref().and_then(|seconds| upper_median(seconds.clone()));
    let times_as_long =
        |i: usize| seconds.as_ref().zip(usual).map_or(1.0, |(seconds, usual)| (seconds[i] / usual).max(1.0));
    let squared = |i: usize| {
        let (here, next) = (states.column(i), states.column(i + 1));
        here.iter().zip(next.iter()).map(|(a, b)| (b - a).powi(2)).sum::<f64>()
    };
    let steps: Vec<f64> = (0..states.ncols().saturating_sub(1)).map(|i| squared(i).sqrt() / times_as_long(i)).collect();
    let Some(usual) = upper_median(steps.iter().copied().filter(|&step| step > 0.0).collect()) else {
        return Vec::new();
    };
    let long = (0..steps.len()).filter(|&i| stands_out(&steps, i, usual));
    long.map(|sample| LongStep { sample, times: steps[sample] / usual }).collect()
}

/// Whether a value is over ten times the `usual` one, and over ten times most of the seven values around it.
pub fn stands_out(values: &[f64], at: usize, usual: f64) -> bool {
    let first = at.saturating_sub(ABOUT / 2).min(values.len().saturating_sub(ABOUT));
    let about = &values[first..(first + ABOUT).min(values.len())];
    let smaller = about.iter().filter(|&&other| LONG * other < values[at]).count();
    values[at] > LONG * usual && 2 * smaller > about.len()
}

/// For each movement (n, N_k), the first earlier one with the same states, if any. O(M) for M samples.
pub fn duplicates<'a>(movements: impl IntoIterator<Item = &'a DMatrix<f64>>) -> Vec<Option<usize>> {
    first_before(&movements.into_iter().collect::<Vec<_>>(), |states| states.as_slice().chunks(states.nrows().max(1)))
}

/// For each movement (n, N_k), the first earlier one with the same states in reverse order, if any. O(M) for M samples.
pub fn mirror_images<'a>(movements: impl IntoIterator<Item = &'a DMatrix<f64>>) -> Vec<Option<usize>> {
    let movements: Vec<_> = movements.into_iter().collect();
    first_before(&movements, |states| states.as_slice().chunks(states.nrows().max(1)).rev())
}

/// For each movement, the first earlier one whose states equal this movement's states in the given order. Hashes find
/// candidates, which are then compared.
fn first_before<'a, S: Iterator<Item = &'a [f64]>>(
    movements: &[&'a DMatrix<f64>],
    order: impl Fn(&'a DMatrix<f64>) -> S,
) -> Vec<Option<usize>> {
    let forwards = |states: &'a DMatrix<f64>| states.as_slice().chunks(states.nrows().max(1));
    let mut known = HashMap::<u64, Vec<usize>>::new();
    let find = |(index, &states): (usize, &&'a DMatrix<f64>)| {
        let shape = states.shape();
        let candidates = known.get(&hash(shape, bits(order(states)))).map_or(&[][..], Vec::as_slice);
        let same = |&k: &usize| movements[k].shape() == shape && bits(forwards(movements[k])).eq(bits(order(states)));
        let found = candidates.iter().copied().find(same);
        known.entry(hash(shape, bits(forwards(states)))).or_default().push(index);
        found
    };
    movements.iter().enumerate().map(find).collect()
}

/// The bits of the states' numbers, one state after the other.
fn bits<'a>(states: impl Iterator<Item = &'a [f64]>) -> impl Iterator<Item = u64> {
    // Adding 0 converts −0 to 0.
    states.flatten().map(|x| (x + 0.0).to_bits())
}

fn hash(shape: (usize, usize), bits: impl Iterator<Item = u64>) -> u64 {
    let mut hasher = DefaultHasher::new();
    shape.hash(&mut hasher);
    bits.for_each(|bits| bits.hash(&mut hasher));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn duplicates_and_mirror_images_name_the_first_match(
            movements in vec((1usize..3, 1usize..4, vec(prop_oneof![Just(0.0), Just(-0.0), Just(1.0)], 6)), 1..20),
        ) {
            let movements = movements.into_iter().map(|(dim, n, x)| DMatrix::from_column_slice(dim, n, &x[..dim * n]));
            let movements: Vec<DMatrix<f64>> = movements.collect();
            let first = |alike: &dyn Fn(&DMatrix<f64>, &DMatrix<f64>) -> bool| -> Vec<Option<usize>> {
                (0..movements.len()).map(|j| (0..j).find(|&k| alike(&movements[k], &movements[j]))).collect()
            };
            prop_assert_eq!(duplicates(&movements), first(&|a, b| a == b));
            let backwards = |a: &DMatrix<f64>, b: &DMatrix<f64>| {
                a.shape() == b.shape() && a.column_iter().rev().zip(b.column_iter()).all(|(a, b)| a == b)
            };
            prop_assert_eq!(mirror_images(&movements), first(&backwards));
        }
    }
}
