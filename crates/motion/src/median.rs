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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

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
