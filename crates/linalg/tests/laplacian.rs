use linalg::LaplacianFactor;
use proptest::collection::vec;
use proptest::prelude::*;

proptest! {
    /// Elimination on a path has no fill-in, so that the factor is exact.
    #[test]
    fn a_path_is_solved_exactly(weights in vec(0.1..10.0, 1..40), seed in -1.0..1.0f64) {
        let nodes = weights.len() + 1;
        let (ones, others): (Vec<u32>, Vec<u32>) = (0..weights.len() as u32).map(|k| (k, k + 1)).unzip();
        let factor = LaplacianFactor::new(nodes, &ones, &others, &weights).expect("a path");
        let mut x: Vec<f64> = (0..nodes).map(|k| (seed + 2.3 * k as f64).sin()).collect();
        let mean = x.iter().sum::<f64>() / nodes as f64;
        for x in &mut x {
            *x -= mean;
        }
        let right = x.clone();
        factor.solve(&mut x, &mut Vec::new());
        let flow = |k: usize| weights[k] * (x[k] - x[k + 1]);
        for (k, right) in right.iter().enumerate() {
            let out = if k + 1 < nodes { flow(k) } else { 0.0 } - if k > 0 { flow(k - 1) } else { 0.0 };
            prop_assert!((out - right).abs() < 1e-10, "{out} {right}");
        }
    }
}

#[test]
fn weights_that_are_no_numbers_have_no_factor() {
    assert!(LaplacianFactor::new(2, &[0], &[1], &[f64::NAN]).is_none());
}
