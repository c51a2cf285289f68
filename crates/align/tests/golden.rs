//! Small alignments computed by another program; see `golden/README.md`.

use align::{Bandwidth, PolicyAlign};
use motion::Demonstrations;
use nalgebra::{DMatrix, DVector};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn matrix(columns: &Value) -> DMatrix<f64> {
    let columns: Vec<_> = columns.as_array().unwrap().iter().map(|column| DVector::from_vec(numbers(column))).collect();
    DMatrix::from_columns(&columns)
}

fn bandwidth(value: &Value) -> Bandwidth {
    match value.as_str() {
        Some("narrow") => Bandwidth::Narrow,
        Some("medium") => Bandwidth::Medium,
        Some("wide") => Bandwidth::Wide,
        _ => Bandwidth::Fixed(value.as_f64().unwrap()),
    }
}

fn check(text: &str) {
    let case: Value = serde_json::from_str(text).unwrap();
    let name = &case["name"];
    let positions = case["states"].as_array().unwrap().iter().map(matrix);
    let demonstrations = Demonstrations::from_states(positions, 1.0).unwrap();
    let learner = PolicyAlign { bandwidth: bandwidth(&case["bandwidth"]), ..Default::default() };
    let aligned = learner.align(&demonstrations).unwrap();

    let sigma_squared = case["sigma_squared"].as_f64().unwrap();
    assert!((aligned.sigma_squared() - sigma_squared).abs() <= 1e-15 * sigma_squared, "{name}");
    let kept: Vec<usize> = case["kept"].as_array().unwrap().iter().map(|k| k.as_u64().unwrap() as usize).collect();
    assert_eq!(aligned.kept(), kept, "{name}");
    let laplacian = matrix(&case["laplacian"]);
    assert!((&aligned.objective().unwrap().laplacian - &laplacian).amax() <= 1e-14 * laplacian.amax(), "{name}");
    let linear = DVector::from_vec(numbers(&case["linear"]));
    assert!((&aligned.objective().unwrap().linear - &linear).amax() <= 1e-14 * laplacian.amax(), "{name}");
    let lambda_2 = case["lambda_2"].as_f64().unwrap();
    assert!((aligned.lambda_2().unwrap() - lambda_2).abs() <= 1e-14 * laplacian.amax(), "{name}");

    // The other program is accurate to about 1e-16 / λ₂; this crate keeps nearly all digits.
    let miss = |offsets: &str| (aligned.offsets() - DVector::from_vec(numbers(&case[offsets]))).amax();
    assert!(miss("offsets") <= 1e-14 + 1e-15 / lambda_2, "{name}: {:e}", miss("offsets"));
    assert!(miss("extended_offsets") <= 1e-13, "{name}: {:e}", miss("extended_offsets"));
}

macro_rules! golden {
    ($($name:ident),*) => {$(
        #[test]
        fn $name() {
            check(include_str!(concat!("golden/", stringify!($name), ".json")));
        }
    )*};
}

golden!(narrow_1d, narrow_2d, narrow_3d, medium_2d, medium_7d, wide_2d, fixed_2d, weak_125, weak_148);
