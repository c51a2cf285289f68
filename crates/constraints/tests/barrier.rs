//! Plates that stop points: the rows of A at each state, the motion that N removes, and refused input.
#![allow(clippy::unwrap_used, reason = "a barrier that cannot be made fails the test")]

use constraints::{Barrier, ConstraintError, NullSpaceProjector, PfaffianConstraint, Plate};
use nalgebra::{DVector, DVectorView, Point3, Unit, UnitVector3, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;

/// Plates in the plane x = `plane`, from y = ±`half_gap` outwards.
fn with_a_gap(plane: f64, half_gap: f64) -> Vec<Plate> {
    let plate = |edges| Plate { normal: Vector3::x_axis(), distance: plane, along: Vector3::y_axis(), edges };
    vec![plate([half_gap, f64::INFINITY]), plate([f64::NEG_INFINITY, -half_gap])]
}

fn direction() -> impl Strategy<Value = UnitVector3<f64>> {
    vec(-1.0..1.0f64, 3)
        .prop_filter_map("too short to have a direction", |v| Unit::try_new(Vector3::from_column_slice(&v), 0.1))
}

/// A plate with random position and orientation.
fn plate() -> impl Strategy<Value = Plate> {
    (direction(), direction(), -1.0..1.0f64, -1.0..1.0f64, 0.01..1.0f64, 0..4u8).prop_filter_map(
        "parallel directions",
        |(normal, other, distance, edge, width, endless)| {
            let along = Unit::try_new(normal.cross(&other), 0.1)?;
            let edges = match endless {
                0 => [f64::NEG_INFINITY, edge],
                1 => [edge, f64::INFINITY],
                _ => [edge, edge + width],
            };
            Some(Plate { normal, distance, along, edges })
        },
    )
}

fn point(state: &DVector<f64>, at: usize) -> Point3<f64> {
    Point3::from(state.fixed_rows::<3>(3 * at).into_owned())
}

fn projector(barrier: &Barrier, state: DVectorView<'_, f64>) -> NullSpaceProjector {
    barrier.null_space_projector(state, 0.0).unwrap()
}

proptest! {
    #[test]
    fn each_hand_is_blocked_beside_the_gap_and_near_the_plane_only(
        state in vec(-0.5..0.5f64, 6), plane in -0.3..0.3f64, half_gap in 0.0..0.4f64, influence in 0.05..0.5f64,
        velocity in vec(-1.0..1.0f64, 6), time in -5.0..5.0f64,
    ) {
        let barrier = Barrier::new(with_a_gap(plane, half_gap), influence, 2).unwrap();
        let (state, velocity) = (DVector::from_vec(state), DVector::from_vec(velocity));
        let blocked = |hand: usize| (state[3 * hand] - plane).abs() < influence && state[3 * hand + 1].abs() > half_gap;
        let projector = barrier.null_space_projector(state.as_view(), time).unwrap();
        prop_assert_eq!(projector.rank(), usize::from(blocked(0)) + usize::from(blocked(1)));
        let mut expected = velocity.clone();
        for hand in (0..2).filter(|&hand| blocked(hand)) {
            expected[3 * hand] = 0.0;
        }
        prop_assert_eq!(projector.project(velocity.as_view()), expected);
    }

    #[test]
    fn rows_hold_the_normals_of_blocking_plates(
        plates in vec(plate(), 0..4), influence in 0.01..1.0f64, (n_points, state) in (1..4usize)
            .prop_flat_map(|n| (Just(n), vec(-1.0..1.0f64, 3 * n))),
    ) {
        let barrier = Barrier::new(plates.clone(), influence, n_points).unwrap();
        let state = DVector::from_vec(state);
        let mut rows = Vec::new();
        for at in 0..n_points {
            for plate in &plates {
                let p = point(&state, at);
                let near = (plate.normal.dot(&p.coords) - plate.distance).abs() < influence;
                let y = plate.along.dot(&p.coords);
                prop_assert_eq!(plate.blocks(&p, influence), near && plate.edges[0] < y && y < plate.edges[1]);
                if plate.blocks(&p, influence) {
                    let mut row = DVector::<f64>::zeros(3 * n_points);
                    row.fixed_rows_mut::<3>(3 * at).copy_from(&*plate.normal);
                    rows.push(row);
                }
            }
        }
        let matrix = barrier.matrix(state.as_view(), 0.0).unwrap();
        prop_assert_eq!(matrix.shape(), (rows.len(), 3 * n_points));
        for (found, expected) in matrix.row_iter().zip(rows) {
            prop_assert_eq!(found.transpose(), expected);
        }
    }

    /// Euler steps of N π from any start: no step moves a blocked point along a normal, and all other points move freely.
    #[test]
    fn a_roll_out_obeys_at_every_step(
        plates in vec(plate(), 1..4), influence in 0.05..0.5f64, start in vec(-1.0..1.0f64, 6),
        goal in vec(-1.0..1.0f64, 6), time_step in 0.01..0.2f64,
    ) {
        let barrier = Barrier::new(plates.clone(), influence, 2).unwrap();
        let (mut state, goal) = (DVector::from_vec(start), DVector::from_vec(goal));
        for _ in 0..60 {
            let wish = &goal - &state;
            let velocity = projector(&barrier, state.as_view()).project(wish.as_view());
            let forbidden = barrier.matrix(state.as_view(), 0.0).unwrap() * &velocity;
            prop_assert!(forbidden.is_empty() || forbidden.amax() < 1e-13);
            for at in 0..2 {
                let p = point(&state, at);
                if !plates.iter().any(|plate| plate.blocks(&p, influence)) {
                    prop_assert_eq!(velocity.rows(3 * at, 3), wish.rows(3 * at, 3));
                }
            }
            state += time_step * velocity;
        }
    }
}

#[test]
fn rank_switches_as_two_hands_come_near_and_pass() {
    let barrier = Barrier::new(with_a_gap(0.4, 0.125), 0.05, 2).unwrap();
    let state =
        |left: [f64; 2], right: [f64; 2]| DVector::from_column_slice(&[left[0], left[1], 0.7, right[0], right[1], 0.7]);
    for (left, right, rank) in [
        ([0.30, 0.3], [0.30, -0.3], 0),
        ([0.36, 0.3], [0.30, -0.3], 1),
        ([0.36, 0.3], [0.36, -0.3], 2),
        ([0.44, 0.3], [0.36, -0.3], 2),
        ([0.46, 0.3], [0.36, -0.3], 1),
        ([0.36, 0.1], [0.36, -0.3], 1),
        ([0.36, 0.1], [0.36, -0.1], 0),
        ([0.36, 0.125], [0.36, -0.126], 1),
    ] {
        assert_eq!(projector(&barrier, state(left, right).as_view()).rank(), rank, "{left:?} {right:?}");
    }
    let no_plate = Barrier::new(vec![], 0.05, 2).unwrap();
    assert_eq!(projector(&no_plate, state([0.4, 0.3], [0.4, -0.3]).as_view()), NullSpaceProjector::identity(6));
}

#[test]
fn bad_barriers_are_refused() {
    let good = with_a_gap(0.4, 0.1)[0];
    let of = |plates, influence, n_points| Barrier::new(plates, influence, n_points).map(|_| ());
    let long = Unit::new_unchecked(Vector3::new(0.0, 2.0, 0.0));
    let nowhere = Unit::new_unchecked(Vector3::repeat(f64::NAN));
    let mut cases = vec![
        (of(vec![good], 0.05, 0), ConstraintError::NoPoint),
        (of(vec![good], 0.0, 1), ConstraintError::Influence { influence: 0.0 }),
        (of(vec![good], -0.1, 1), ConstraintError::Influence { influence: -0.1 }),
        (of(vec![good], f64::INFINITY, 1), ConstraintError::Influence { influence: f64::INFINITY }),
        (
            of(vec![good, Plate { edges: [0.2, 0.2], ..good }], 0.05, 1),
            ConstraintError::PlateEdges { plate: 1, from: 0.2, to: 0.2 },
        ),
        (
            of(vec![Plate { edges: [0.2, -0.2], ..good }], 0.05, 1),
            ConstraintError::PlateEdges { plate: 0, from: 0.2, to: -0.2 },
        ),
    ];
    for out_of_space in [
        Plate { distance: f64::NAN, ..good },
        Plate { distance: f64::INFINITY, ..good },
        Plate { along: long, ..good },
        Plate { normal: nowhere, ..good },
        Plate { along: good.normal, ..good },
    ] {
        cases.push((of(vec![good, good, out_of_space], 0.05, 1), ConstraintError::PlateInSpace { plate: 2 }));
    }
    for (found, expected) in cases {
        assert_eq!(found, Err(expected));
    }
    assert!(matches!(of(vec![good], f64::NAN, 1), Err(ConstraintError::Influence { influence }) if influence.is_nan()));
    let nan = of(vec![Plate { edges: [f64::NAN, 1.0], ..good }], 0.05, 1);
    assert!(matches!(nan, Err(ConstraintError::PlateEdges { plate: 0, from, to: 1.0 }) if from.is_nan()));
}

/// A point without a finite position is neither blocked nor free.
#[test]
fn invalid_states_are_refused() {
    let barrier = Barrier::new(with_a_gap(0.4, 0.1), 0.05, 2).unwrap();
    for coordinate in 0..6 {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut state = DVector::from_column_slice(&[0.4, 0.3, 0.7, 0.4, -0.3, 0.7]);
            state[coordinate] = value;
            let errors = [
                barrier.matrix(state.as_view(), 0.0).unwrap_err(),
                barrier.null_space_projector(state.as_view(), 0.0).unwrap_err(),
            ];
            for error in errors {
                assert!(
                    matches!(error, ConstraintError::StateNotFinite { coordinate: at, value: found }
                        if at == coordinate && found.to_bits() == value.to_bits()),
                    "{error:?}"
                );
            }
        }
    }
    let short = DVector::zeros(5);
    assert_eq!(barrier.matrix(short.as_view(), 0.0), Err(ConstraintError::State { found: 5, expected: 6 }));
}
