//! Constraints that change with state and time, and refused input.

use constraints::{
    ConstraintError, LinearConstraint, NullSpaceProjector, PfaffianConstraint, Switching, Unconstrained,
};
use nalgebra::{DMatrix, DVector, DVectorView, dmatrix, dvector};
use proptest::collection::vec;
use proptest::prelude::*;

/// A wall at x₁ = 1 that acts on contact. The number of columns of A can be wrong.
struct Wall {
    columns: usize,
}

impl PfaffianConstraint for Wall {
    fn dim(&self) -> usize {
        2
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        let rows = usize::from(state[0] >= 1.0 && time >= 0.0);
        Ok(DMatrix::from_fn(rows, self.columns, |_, column| if column == 0 { 1.0 } else { 0.0 }))
    }
}

fn row(entries: &[f64]) -> LinearConstraint {
    LinearConstraint::new(DMatrix::from_row_slice(1, entries.len(), entries)).expect("every entry is finite")
}

fn projector_of(constraint: impl PfaffianConstraint, state: &DVector<f64>, time: f64) -> NullSpaceProjector {
    constraint.null_space_projector(state.as_view(), time).expect("every entry is finite")
}

proptest! {
    #[test]
    fn the_last_constraint_that_started_holds(
        mut starts in vec(-20..20i32, 1..7),
        time in -25..25i32,
        step in 0.01..3.0f64,
        state in vec(-1.0..1.0f64, 2),
    ) {
        starts.sort_unstable();
        starts.dedup();
        let angle = |start: i32| [f64::from(start).cos(), f64::from(start).sin()];
        let phases = starts.iter().map(|&start| (f64::from(start) * step, row(&angle(start)))).collect();
        let switching = Switching::new(phases).unwrap();
        let (state, now) = (DVector::from_vec(state), f64::from(time) * step);

        // The literal definition: search all of them.
        let holds = starts.iter().rfind(|&&start| start <= time).map(|&start| row(&angle(start)));
        prop_assert_eq!(switching.at(now), holds.as_ref());
        let expected = match &holds {
            Some(constraint) => constraint.matrix(state.as_view(), now).unwrap(),
            None => DMatrix::zeros(0, 2),
        };
        prop_assert_eq!(switching.matrix(state.as_view(), now).unwrap(), expected.clone());
        let projector = switching.null_space_projector(state.as_view(), now).unwrap();
        prop_assert_eq!(projector, NullSpaceProjector::new(&expected).unwrap());
        prop_assert_eq!(switching.dim(), 2);
    }

    #[test]
    fn a_linear_constraint_is_the_same_everywhere(entries in vec(-1.0..1.0f64, 6), state in vec(-9.0..9.0f64, 3), time in -9.0..9.0f64) {
        let matrix = DMatrix::from_vec(2, 3, entries);
        let constraint = LinearConstraint::new(matrix.clone()).unwrap();
        let state = DVector::from_vec(state);
        prop_assert_eq!(constraint.dim(), 3);
        prop_assert_eq!(constraint.matrix(state.as_view(), time).unwrap(), matrix.clone());
        let projector = constraint.null_space_projector(state.as_view(), time).unwrap();
        prop_assert_eq!(projector, NullSpaceProjector::new(&matrix).unwrap());
    }
}

#[test]
fn the_number_of_rows_may_change_with_the_state() {
    let wall = Wall { columns: 2 };
    for (state, free) in
        [(dvector![0.9, 0.0], dmatrix![1.0, 0.0; 0.0, 1.0]), (dvector![1.0, 5.0], dmatrix![0.0, 0.0; 0.0, 1.0])]
    {
        assert_eq!(wall.null_space_projector(state.as_view(), 0.0).unwrap().matrix(), free);
    }
}

#[test]
fn phases_may_hold_constraints_of_different_kinds() {
    let phases: Vec<(f64, Box<dyn PfaffianConstraint>)> = vec![
        (0.0, Box::new(Unconstrained { dim: 2 })),
        (1.0, Box::new(row(&[0.0, 1.0]))),
        (2.0, Box::new(Wall { columns: 2 })),
    ];
    let switching = Switching::new(phases).unwrap();
    let state = dvector![1.5, 0.0];
    let free = [(0.5, 2.0), (1.0, 1.0), (1.999, 1.0), (2.0, 1.0)];
    for (time, trace) in free {
        let projector = projector_of(&switching, &state, time);
        assert!((projector.matrix().trace() - trace).abs() < 1e-15);
        assert_eq!(switching.matrix(state.as_view(), time).unwrap().nrows(), projector.rank());
    }
    assert_eq!(
        Unconstrained { dim: 4 }.null_space_projector(state.as_view(), 0.0).unwrap(),
        NullSpaceProjector::identity(4)
    );
}

#[test]
fn bad_constraints_are_refused() {
    let none: Vec<(f64, LinearConstraint)> = vec![];
    let plane = || row(&[1.0, 0.0]);
    let cases = [
        (Switching::new(none).unwrap_err(), ConstraintError::NoPhase),
        (
            Switching::new(vec![(0.0, plane()), (2.0, plane()), (2.0, plane())]).unwrap_err(),
            ConstraintError::StartTime { phase: 2, start: 2.0 },
        ),
        (
            Switching::new(vec![(0.0, plane()), (-1.0, plane())]).unwrap_err(),
            ConstraintError::StartTime { phase: 1, start: -1.0 },
        ),
        (
            Switching::new(vec![(f64::NEG_INFINITY, plane())]).unwrap_err(),
            ConstraintError::StartTime { phase: 0, start: f64::NEG_INFINITY },
        ),
        (
            Switching::new(vec![(0.0, plane()), (1.0, row(&[1.0, 0.0, 0.0]))]).unwrap_err(),
            ConstraintError::PhaseDimension { phase: 1, found: 3, expected: 2 },
        ),
        (
            Wall { columns: 3 }.null_space_projector(dvector![2.0, 0.0].as_view(), 0.0).unwrap_err(),
            ConstraintError::Columns { found: 3, expected: 2 },
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
    let nan = Switching::new(vec![(f64::NAN, plane())]).unwrap_err();
    assert!(matches!(nan, ConstraintError::StartTime { phase: 0, start } if start.is_nan()));
    let nan = LinearConstraint::new(dmatrix![1.0, f64::NAN]).unwrap_err();
    assert!(matches!(nan, ConstraintError::NotFinite { row: 0, column: 1, value } if value.is_nan()));
}
