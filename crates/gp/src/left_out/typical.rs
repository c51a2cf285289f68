//! Expected mean of a few values with a heavy-tailed distribution (S43).

/// Number of new movements whose error is predicted.
const MOVEMENTS: i32 = 30;
/// Smallest value, relative to the mean, that is distinguished from 0.
const LEAST: f64 = 1e-12;
/// Range of log t over which (S43) is summed, and the step between values: the integrand and its derivatives vanish at both ends.
const RANGE: (f64, f64) = (-20.0, 34.0);
const STEP: f64 = 0.1;

/// (S43): exp of the expected logarithm of the mean of thirty values drawn from these with their weights. Never above the mean of all,
/// and far below it if that is dominated by one value in hundreds. 0 if all are 0.
///
/// With X that mean, E log X = ∫ (e^{−t} − E e^{−tX}) dt/t. E e^{−tX} is the thirtieth power of the expectation for one value divided
/// by thirty.
pub(crate) fn typical_mean(values: &[f64], weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    let mean = values.iter().zip(weights).map(|(value, weight)| value * weight).sum::<f64>() / sum;
    if mean == 0.0 {
        return 0.0;
    }
    let steps = ((RANGE.1 - RANGE.0) / STEP).round() as usize;
    let part = |step: usize| {
        let t = (RANGE.0 + STEP * step as f64).exp();
        let of_one = t / (mean * f64::from(MOVEMENTS));
        let transformed: f64 =
            values.iter().zip(weights).map(|(value, weight)| weight * (-of_one * value.max(LEAST * mean)).exp()).sum();
        (-t).exp() - (transformed / sum).powi(MOVEMENTS)
    };
    mean * (STEP * (0..=steps).map(part).sum::<f64>()).exp().min(1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Binomial probabilities of k of thirty.
    fn binomial(share: f64) -> impl Iterator<Item = f64> {
        let ways = |k: i32| (1..=k).map(|j| f64::from(MOVEMENTS - k + j) / f64::from(j)).product::<f64>();
        (0..=MOVEMENTS).map(move |k| ways(k) * share.powi(k) * (1.0 - share).powi(MOVEMENTS - k))
    }

    proptest! {
        /// For two values: compares with the sum over the number of the thirty that are the larger one.
        #[test]
        fn typical_mean_of_two_values_is_the_binomial_sum(share in 0.001f64..0.999, ratio in 0.0f64..9.0, scale in -9.0f64..9.0) {
            let (few, many) = (10f64.powf(scale + ratio), 10f64.powf(scale));
            let mean = |k: usize| (k as f64 * few + (f64::from(MOVEMENTS) - k as f64) * many) / f64::from(MOVEMENTS);
            let expected: f64 = binomial(share).enumerate().map(|(k, p)| p * mean(k).ln()).sum();
            let found = typical_mean(&[few, many], &[share, 1.0 - share]);
            prop_assert!((found.ln() - expected).abs() <= 1e-6, "{} {expected}", found.ln());
        }

        /// The result scales with the values, equals them if they are equal, and is at most their mean.
        #[test]
        fn typical_mean_scales_and_is_bounded(values in prop::collection::vec(1e-6f64..1.0, 1..60), scale in -9.0f64..9.0, equal in 1e-9f64..1e9) {
            let ones = vec![1.0; values.len()];
            let factor = 10f64.powf(scale);
            let scaled: Vec<f64> = values.iter().map(|value| factor * value).collect();
            let (one, other) = (typical_mean(&values, &ones), typical_mean(&scaled, &ones));
            prop_assert!((other / (factor * one) - 1.0).abs() < 1e-9);
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let least = values.iter().copied().fold(1.0, f64::min);
            prop_assert!(one <= mean * (1.0 + 1e-9) && one >= least * (1.0 - 1e-6));
            let same = typical_mean(&vec![equal; values.len()], &values);
            prop_assert!((same / equal - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn typical_mean_of_zeros_is_zero() {
        assert_eq!(typical_mean(&[0.0, 0.0], &[1.0, 2.0]), 0.0);
    }
}
