//! Determines the spaces in which constraints are constant (S38). Usually all constraints of a recording are in one space, which a few
//! noisy samples do not reveal.

/// Number of rounds of expectation maximisation.
const ROUNDS: usize = 500;

/// Cost of a constraint in each space, 0 for the most frequent one, from the costs (S28) in every space of all stretches that have a
/// constraint.
pub(super) fn rarity(costs: &[Vec<f64>], spaces: usize) -> Vec<f64> {
    let mut shares = vec![1.0 / spaces as f64; spaces];
    for _ in 0..ROUNDS {
        let mut counts = vec![1.0; spaces];
        for costs in costs {
            let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
            let likelihood = |(cost, share): (&f64, &f64)| share * (0.5 * (least - cost)).exp();
            let likelihoods: Vec<f64> = costs.iter().zip(&shares).map(likelihood).collect();
            let all: f64 = likelihoods.iter().sum();
            counts.iter_mut().zip(&likelihoods).for_each(|(count, likelihood)| *count += likelihood / all);
        }
        let all: f64 = counts.iter().sum();
        shares = counts.into_iter().map(|count| count / all).collect();
    }
    let most = shares.iter().copied().fold(0.0, f64::max);
    shares.into_iter().map(|share| -2.0 * (share / most).ln()).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Stretches with equal costs in two spaces count for the more frequent one. The order of the spaces does not matter, and the
        /// shares are those of the unambiguous stretches.
        #[test]
        fn rare_spaces_cost_more(clear in 1usize..30, rare in 0usize..30, alike in 0usize..30, cost in -50.0..50.0f64) {
            let stretches = |first: f64, second: f64, count: usize| vec![vec![cost + first, cost + second]; count];
            let all = [stretches(0.0, 200.0, clear), stretches(200.0, 0.0, rare), stretches(0.0, 0.0, alike)].concat();
            let found = rarity(&all, 2);
            let swapped = rarity(&all.iter().map(|costs| vec![costs[1], costs[0]]).collect::<Vec<_>>(), 2);
            prop_assert!((found[0] - swapped[1]).abs() < 1e-9 && (found[1] - swapped[0]).abs() < 1e-9);
            let (more, less) = if clear > rare { (found[0], found[1]) } else { (found[1], found[0]) };
            prop_assert!(more.abs() < 1e-6);
            let certain = 2.0 * ((1 + clear.max(rare)) as f64 / (1 + clear.min(rare)) as f64).ln();
            prop_assert!((less - certain).abs() < 1e-6, "{less} {certain}");
        }
    }

    /// A single space costs nothing, and without stretches no space does.
    #[test]
    fn a_single_space_costs_nothing() {
        assert_eq!(rarity(&[vec![3.0], vec![-1.0]], 1), [0.0]);
        assert_eq!(rarity(&[], 3), [0.0; 3]);
    }
}
