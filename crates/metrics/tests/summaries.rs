//! Mean, standard deviation and median of errors over data sets.

use metrics::Summary;
use proptest::collection::vec;
use proptest::prelude::*;

proptest! {
    #[test]
    fn is_the_direct_formulas(values in vec(-5.0..5.0f64, 2..30)) {
        let summary = Summary::of(&values).unwrap();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        // The variance computed from pairs, without a mean: Σ_{i<j} (x_i − x_j)² / (n (n − 1)).
        let pairs = values.iter().flat_map(|x| values.iter().map(move |y| (x - y).powi(2)));
        let variance = pairs.sum::<f64>() / 2.0 / (n * (n - 1.0));
        prop_assert_eq!(summary.n, values.len());
        prop_assert!((summary.mean - mean).abs() < 1e-13);
        prop_assert!((summary.sd.unwrap() - variance.sqrt()).abs() < 1e-12);
        // At most half of the values are below the median, and at most half above.
        let below = values.iter().filter(|&&value| value < summary.median).count();
        let above = values.iter().filter(|&&value| value > summary.median).count();
        prop_assert!(below <= values.len() / 2 && above <= values.len() / 2);
        if values.len() % 2 == 1 {
            prop_assert!(values.contains(&summary.median));
        } else {
            prop_assert_eq!(below, above);
        }
    }

    #[test]
    fn order_does_not_change_a_bit(
        (values, shuffled) in vec(-1e3..1e3f64, 1..20).prop_flat_map(|values| (Just(values.clone()), Just(values).prop_shuffle())),
    ) {
        prop_assert_eq!(Summary::of(&values).unwrap(), Summary::of(&shuffled).unwrap());
    }

    #[test]
    fn moves_and_stretches_with_the_values(values in vec(-1.0..1.0f64, 2..20), shift in -9.0..9.0f64, stretch in -9.0..9.0f64) {
        let (plain, moved) = (Summary::of(&values).unwrap(), values.iter().map(|value| shift + stretch * value).collect::<Vec<_>>());
        let moved = Summary::of(&moved).unwrap();
        prop_assert!((moved.mean - (shift + stretch * plain.mean)).abs() < 1e-12);
        prop_assert!((moved.median - (shift + stretch * plain.median)).abs() < 1e-12);
        prop_assert!((moved.sd.unwrap() - stretch.abs() * plain.sd.unwrap()).abs() < 1e-12);
    }
}

#[test]
fn known_summaries() {
    let cases: [(&[f64], Summary); 4] = [
        (&[3.0], Summary { n: 1, mean: 3.0, sd: None, median: 3.0 }),
        (&[2.0, 2.0, 2.0], Summary { n: 3, mean: 2.0, sd: Some(0.0), median: 2.0 }),
        (&[4.0, 1.0, 2.0, 5.0], Summary { n: 4, mean: 3.0, sd: Some((10.0f64 / 3.0).sqrt()), median: 3.0 }),
        (&[0.0, 0.0, 9.0], Summary { n: 3, mean: 3.0, sd: Some(27f64.sqrt()), median: 0.0 }),
    ];
    for (values, expected) in cases {
        assert_eq!(Summary::of(values).unwrap(), expected);
    }
}
