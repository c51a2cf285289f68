//! Compares the projector with its defining identities (3) and the literal I − A⁺A, also for ill-conditioned matrices.

use constraints::{ConstraintError, NullSpaceProjector};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use proptest::collection::vec;
use proptest::prelude::*;

/// A (k, n) with a chosen rank and singular values between 0.1 and 10, an orthonormal basis of its row space (n, rank), and a
/// vector (n).
#[derive(Debug)]
struct Case {
    matrix: DMatrix<f64>,
    row_space: DMatrix<f64>,
    vector: DVector<f64>,
}

impl Case {
    fn projector(&self) -> NullSpaceProjector {
        NullSpaceProjector::new(&self.matrix).expect("every entry is finite")
    }

    fn rank(&self) -> usize {
        self.row_space.ncols()
    }
}

fn orthonormal(size: usize) -> impl Strategy<Value = DMatrix<f64>> {
    vec(-1.0..1.0, size * size).prop_map(move |entries| DMatrix::from_vec(size, size, entries).qr().q())
}

/// Any k from 0 to n + 2 and any possible rank.
fn case() -> impl Strategy<Value = Case> {
    let shape = (1..8usize).prop_flat_map(|n| (Just(n), 0..=n + 2));
    let shape = shape.prop_flat_map(|(n, k)| (Just(n), Just(k), 0..=n.min(k)));
    shape.prop_flat_map(|(n, k, rank)| {
        (orthonormal(k), vec(-1.0..1.0, rank), orthonormal(n), vec(-10.0..10.0, n)).prop_map(
            move |(left, exponents, right, vector)| {
                let singular = DVector::from_iterator(rank, exponents.iter().map(|e: &f64| 10f64.powf(*e)));
                let row_space = right.columns(0, rank).into_owned();
                let matrix = left.columns(0, rank) * DMatrix::from_diagonal(&singular) * row_space.transpose();
                Case { matrix, row_space, vector: DVector::from_vec(vector) }
            },
        )
    })
}

fn assert_close(found: &DMatrix<f64>, expected: &DMatrix<f64>) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.shape(), expected.shape());
    prop_assert!((found - expected).amax() < 1e-12, "found {}, expected {}", found, expected);
    Ok(())
}

proptest! {
    #[test]
    fn is_the_orthogonal_projector_onto_the_null_space(case in case()) {
        let (projector, n) = (case.projector(), case.vector.len());
        let matrix = projector.matrix();
        prop_assert_eq!(projector.rank(), case.rank());
        prop_assert_eq!(projector.dim(), n);
        assert_close(&matrix, &matrix.transpose())?;
        assert_close(&(&matrix * &matrix), &matrix)?;
        assert_close(&(&case.matrix * &matrix), &DMatrix::zeros(case.matrix.nrows(), n))?;
        prop_assert!((matrix.trace() - (n - case.rank()) as f64).abs() < 1e-12);
        assert_close(&matrix, &(DMatrix::identity(n, n) - &case.row_space * case.row_space.transpose()))?;
    }

    #[test]
    fn equals_the_literal_formula(case in case()) {
        let n = case.vector.len();
        let mut literal = DMatrix::identity(n, n);
        if !case.matrix.is_empty() {
            let svd = case.matrix.clone().svd(true, true);
            // nalgebra's decomposition is wrong for about one rank-deficient matrix in a hundred; then the product of its
            // factors is not A. An error of 1e-13 there corresponds to one of 1e-11 in N, as no singular value is below 0.1,
            // and to 3e-10 in the projection of a vector of length 26.
            prop_assume!((svd.clone().recompose().unwrap() - &case.matrix).amax() < 1e-13);
            literal -= svd.pseudo_inverse(1e-6).unwrap() * &case.matrix;
        }
        let projected = case.projector().project(case.vector.as_view());
        prop_assert!((projected - literal * &case.vector).amax() < 3e-10);
    }

    #[test]
    fn projecting_is_multiplying_and_keeps_the_null_space(case in case()) {
        let projector = case.projector();
        let projected = projector.project(case.vector.as_view());
        prop_assert!((&projected - projector.matrix() * &case.vector).amax() < 1e-12);
        prop_assert!((projector.project(projected.as_view()) - &projected).amax() < 1e-12);
        prop_assert!((&case.matrix * &projected).amax() < 1e-12);
        let mut in_place = case.vector.clone();
        projector.project_into(in_place.as_view_mut());
        prop_assert_eq!(in_place, projected);
    }

    #[test]
    fn only_the_row_space_counts(
        case in case(),
        exponent in -150.0..150.0f64,
        negative in any::<bool>(),
        units in vec(-4.0..4.0f64, 10),
        (left, right) in (0..=9usize).prop_flat_map(|k| (orthonormal(k), orthonormal(k))),
        stretches in vec(0.2..5.0f64, 9),
    ) {
        let expected = case.projector().matrix();
        let same = |matrix: DMatrix<f64>| {
            let projector = NullSpaceProjector::new(&matrix).unwrap();
            prop_assert_eq!(projector.rank(), case.rank());
            assert_close(&projector.matrix(), &expected)
        };
        same(&case.matrix * (if negative { -1.0 } else { 1.0 } * 10f64.powf(exponent)))?;

        let mut in_other_units = case.matrix.clone();
        for (mut row, unit) in in_other_units.row_iter_mut().zip(&units) {
            row *= 10f64.powf(*unit);
        }
        same(in_other_units)?;

        // M A with an invertible M; rows of A or of zeros are appended to match the drawn size of M.
        let k = left.nrows();
        let rows = case.matrix.nrows();
        let stretch = DMatrix::from_diagonal(&DVector::from_column_slice(&stretches[..k]));
        let mixing = left * stretch * right;
        if k >= rows {
            same(mixing * case.matrix.clone().resize_vertically(k, 0.0))?;
        }
        // Each row repeated three times.
        same(DMatrix::from_fn(3 * rows, case.vector.len(), |row, column| case.matrix[(row / 3, column)]))?;
    }

    #[test]
    fn nearly_dependent_rows_still_give_an_orthogonal_projector(
        left in orthonormal(5), right in orthonormal(6), exponents in vec(-10.0..0.0f64, 5),
    ) {
        let singular = DVector::from_iterator(5, exponents.iter().map(|e| 10f64.powf(*e)));
        let matrix = left * DMatrix::from_diagonal(&singular) * right.columns(0, 5).transpose();
        let projector = NullSpaceProjector::new(&matrix).unwrap().matrix();
        prop_assert!((&projector * &projector - &projector).amax() < 1e-14);
        prop_assert!((&projector - projector.transpose()).amax() < 1e-14);
        prop_assert!((&matrix * &projector).amax() < 1e-14);
    }

    #[test]
    fn one_row_is_the_formula_of_one_row(row in vec(-5.0..5.0f64, 1..9), exponent in -300.0..300.0f64) {
        let n = row.len();
        let a = DVector::from_vec(row);
        prop_assume!(a.norm() > 1e-3);
        let matrix = a.transpose() * 10f64.powf(exponent);
        let projector = NullSpaceProjector::new(&DMatrix::from_row_slice(1, n, matrix.as_slice())).unwrap();
        let expected = DMatrix::identity(n, n) - &a * a.transpose() / a.norm_squared();
        assert_close(&projector.matrix(), &expected)?;
    }

    #[test]
    fn a_row_at_a_small_angle_counts_down_to_the_tolerance(
        angle in -11.0..-1.0f64, exponent in -14.0..-2.0f64, turn in orthonormal(3), lengths in vec(0.1..1.0f64, 2),
    ) {
        prop_assume!((angle - exponent).abs() > 0.02);
        let (sine, tolerance) = (10f64.powf(angle), 10f64.powf(exponent));
        let rows = dmatrix![1.0, 0.0, 0.0; (1.0 - sine * sine).sqrt(), sine, 0.0] * turn.transpose();
        let matrix = DMatrix::from_diagonal(&DVector::from_vec(lengths)) * rows;
        let projector = NullSpaceProjector::with_tolerance(&matrix, tolerance).unwrap();
        prop_assert_eq!(projector.rank(), if angle > exponent { 2 } else { 1 });
        // The plane of two rows is as exact as their rounding allows; if two rows count as one, either may be used.
        let (free, exact_to) = if angle > exponent { (0.0, 1e-14 / sine) } else { (1.0, 1e-14 + sine) };
        let expected = &turn * DMatrix::from_diagonal(&dvector![0.0, free, 1.0]) * turn.transpose();
        prop_assert!((projector.matrix() - expected).amax() <= exact_to);
    }
}

#[test]
fn empty_and_zero_constraints_give_the_identity() {
    for matrix in [DMatrix::zeros(0, 3), DMatrix::zeros(1, 3), DMatrix::zeros(5, 3)] {
        let projector = NullSpaceProjector::new(&matrix).unwrap();
        assert_eq!(projector, NullSpaceProjector::identity(3));
        assert_eq!(projector.matrix(), DMatrix::identity(3, 3));
    }
}

#[test]
fn full_rank_constraints_project_to_exact_zero() {
    let matrix = dmatrix![0.3, 0.1, 0.7; -0.4, 0.9, 0.2; 0.5, 0.5, -0.6];
    let projector = NullSpaceProjector::new(&matrix).unwrap();
    assert_eq!(projector.rank(), 3);
    assert_eq!(projector.project(dvector![1.0, 2.0, 3.0].as_view()), DVector::zeros(3));
}

#[test]
fn badly_scaled_matrices() {
    let smallest = f64::from_bits(1);
    let cases = [
        ("near the largest number", dmatrix![1e308, 1e308; 1e308, 1e308], 1),
        ("the smallest number", dmatrix![smallest, smallest], 1),
        ("rows in millimetres and megametres", dmatrix![1e3, 1e3; 2e-6, 2e-6], 1),
        ("a row of rounding beside a true one", dmatrix![1.0, 1.0; 6e-17, -6e-17], 1),
        ("a true row of ten orders less", dmatrix![1.0, 1.0; 1e-10, -1e-10], 2),
        ("a row that differs by rounding", dmatrix![0.1, 0.1; 0.1 * 3.0, 0.3], 1),
    ];
    for (name, matrix, rank) in cases {
        let projector = NullSpaceProjector::new(&matrix).unwrap();
        assert_eq!(projector.rank(), rank, "{name}");
        let expected = if rank == 1 { dmatrix![0.5, -0.5; -0.5, 0.5] } else { DMatrix::zeros(2, 2) };
        assert!((projector.matrix() - expected).amax() < 1e-15, "{name}");
    }
}

#[test]
fn a_small_row_is_obeyed_as_exactly_as_a_large_one() {
    // Rows in this order are harder: a pseudo-inverse by singular values leaves up to 1e-6 of the first.
    let matrix = dmatrix![3e-9, 1e-9, -2e-9, 5e-9; 1.0, 2.0, 3.0, 4.0];
    let projected = NullSpaceProjector::new(&matrix).unwrap().project(dvector![0.3, -0.8, 0.5, 0.2].as_view());
    assert!((matrix.row(0) * 1e9 * projected).amax() < 1e-14);
}

#[test]
fn errors_locate_the_invalid_value() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut matrix = DMatrix::from_element(2, 3, 1.0);
        matrix[(1, 2)] = value;
        match NullSpaceProjector::new(&matrix).unwrap_err() {
            ConstraintError::NotFinite { row: 1, column: 2, value: found } => {
                assert_eq!(found.to_bits(), value.to_bits());
            }
            other => panic!("{other}"),
        }
    }
    for tolerance in [0.0, -1e-3, 1e-17, 1.0, f64::INFINITY] {
        let error = NullSpaceProjector::with_tolerance(&DMatrix::zeros(1, 1), tolerance).unwrap_err();
        assert_eq!(error, ConstraintError::Tolerance { tolerance });
    }
    assert!(NullSpaceProjector::with_tolerance(&DMatrix::zeros(1, 1), f64::NAN).is_err());
}

#[test]
#[should_panic(expected = "vectors of length n")]
fn a_vector_of_wrong_length_panics() {
    NullSpaceProjector::identity(3).project(dvector![1.0, 2.0].as_view());
}
