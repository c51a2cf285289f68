use nalgebra::{DMatrix, DVector};

/// Largest rounding error between equal values and their mean, relative to the mean.
const ROUNDING: f64 = 1e-13;

/// The mean of values and its standard error sd/√K, with sd divided by K − 1; not finite for fewer than two values. O(K).
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// Σ‖u − mean u‖² over the columns u of (n, N).
pub fn spread(columns: &DMatrix<f64>) -> f64 {
    let mean = columns.column_mean();
    columns.column_iter().map(|column| (column - &mean).norm_squared()).sum()
}

/// Standard deviation about the mean, divided by N; 0 if values differ by rounding alone. Sums and squares of finite values do
/// not overflow.
pub fn standard_deviation(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean: f64 = values.clone().map(|value| value / count).sum();
    let largest = values.clone().fold(0.0_f64, |largest, value| largest.max((value - mean).abs()));
    if largest <= ROUNDING * mean.abs() {
        return 0.0;
    }
    largest * values.map(|value| ((value - mean) / largest).powi(2) / count).sum::<f64>().sqrt()
}

/// The middle value, the upper of two; `None` without values. O(N).
pub fn upper_median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The middle value, or the mean of the middle two; `None` without values. O(N).
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    let (middle, even) = (values.len() / 2, values.len().is_multiple_of(2));
    if values.is_empty() {
        return None;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(if even { 0.5 * below.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 0.5 * upper } else { upper })
}

/// Every row of `values`, (n, N), times its factor, (n).
pub fn scaled(values: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let mut values = values.clone();
    values.column_iter_mut().for_each(|mut column| column.component_mul_assign(factors));
    values
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn equal_values_do_not_vary() {
        // Their computed mean is not .1.
        assert_eq!(standard_deviation(std::iter::repeat_n(0.1, 400)), 0.0);
        assert!((standard_deviation([1.0, 3.0].into_iter()) - 1.0).abs() < 1e-15);
        assert!((standard_deviation([-1e300, 1e300].into_iter()) / 1e300 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn of_three_values() {
        let (mean, error) = mean_and_error(&[1.0, 2.0, 6.0]);
        assert_eq!(mean, 3.0);
        assert!((error - (7.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!(!mean_and_error(&[1.0]).1.is_finite() && mean_and_error(&[]).0.is_nan());
    }

    proptest! {
        /// Shifting and scaling the values shifts the mean and scales both.
        #[test]
        fn mean_and_error_follow_shifts_and_scales(values in prop::collection::vec(-5.0..5.0_f64, 2..40), by in -5.0..5.0_f64, times in 0.1..10.0_f64) {
            let (mean, error) = mean_and_error(&values);
            let others: Vec<f64> = values.iter().map(|value| times * (value + by)).collect();
            let (other_mean, other_error) = mean_and_error(&others);
            prop_assert!((other_mean - times * (mean + by)).abs() < 1e-11 && (other_error - times * error).abs() < 1e-11);
        }
    }

    #[test]
    fn even_counts_give_the_upper_median() {
        assert_eq!(upper_median(vec![]), None);
        assert_eq!(upper_median(vec![7.0]), Some(7.0));
        assert_eq!(upper_median(vec![3.0, 1.0]), Some(3.0));
        assert_eq!(upper_median(vec![f64::INFINITY, 2.0, -1.0]), Some(2.0));
    }

    proptest! {
        #[test]
        fn median_is_the_middle_of_the_sorted_values(mut values in prop::collection::vec(-5.0..5.0_f64, 1..40)) {
            let found = upper_median(values.clone());
            values.sort_by(f64::total_cmp);
            prop_assert_eq!(found, Some(values[values.len() / 2]));
        }
    }
}
