/// The mean of values, and its standard error sd/√K, sd with K − 1: not finite of fewer than two values. O(K).
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn of_three_values() {
        let (mean, error) = mean_and_error(&[1.0, 2.0, 6.0]);
        assert_eq!(mean, 3.0);
        assert!((error - (7.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!(!mean_and_error(&[1.0]).1.is_finite() && mean_and_error(&[]).0.is_nan());
    }

    proptest! {
        /// Values that are moved and stretched move the mean and stretch both.
        #[test]
        fn they_follow_the_values(values in prop::collection::vec(-5.0..5.0_f64, 2..40), by in -5.0..5.0_f64, times in 0.1..10.0_f64) {
            let (mean, error) = mean_and_error(&values);
            let others: Vec<f64> = values.iter().map(|value| times * (value + by)).collect();
            let (other_mean, other_error) = mean_and_error(&others);
            prop_assert!((other_mean - times * (mean + by)).abs() < 1e-11 && (other_error - times * error).abs() < 1e-11);
        }
    }
}
