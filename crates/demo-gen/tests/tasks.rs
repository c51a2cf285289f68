//! Constraints A u = b: movements obey them, the remaining velocity comes from the policy, and formulas match the
//! publications.

use constraints::{LinearConstraint, PfaffianConstraint};
use demo_gen::tasks::{Contact, CyclesWithTask, LinearTask, TaskConstraint, Wiping};
use demo_gen::{DemoGenError, Recording, RollOut, with_velocity_noise};
use kinematics::Workspace;
use motion::Policy;
use nalgebra::{DMatrix, DVector, Matrix6xX, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const ARM: &str = include_str!("../../../robots/seven_joint_arm.urdf");

fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn arm(contact: Contact, n_trajectories: usize, n_samples: usize) -> Wiping {
    let mut arm = Wiping::new(ARM, contact).unwrap();
    arm.n_trajectories = n_trajectories;
    arm.roll_out.n_samples = n_samples;
    arm
}

/// u − Nπ, which is A⁺b, at a sample.
fn pushed(recording: &Recording, sample: usize) -> DVector<f64> {
    let (truth, u) = (&recording.truth, recording.observed.velocities().unwrap());
    u.column(sample) - truth.projectors[sample].project(truth.actions.column(sample))
}

fn tool(arm: &Wiping, recording: &Recording, sample: usize) -> (Vector3<f64>, Vector3<f64>, Matrix6xX<f64>) {
    let mut jacobian = Matrix6xX::zeros(7);
    let state = recording.truth.states.column(sample);
    let pose = arm.tool().jacobian(state.as_view(), &mut Workspace::new(), &mut jacobian).unwrap();
    (pose.translation.vector, pose.rotation * Vector3::z(), jacobian)
}

proptest! {
    /// A⁺b satisfies A u = b and has no component in the null space of A.
    #[test]
    fn task_velocity_has_minimum_norm(rows in 1..4usize, entries in vec(-1.0..1.0f64, 15), b in vec(-1.0..1.0f64, 3)) {
        let matrix = DMatrix::from_row_slice(rows, 5, &entries[..5 * rows]);
        let singular = matrix.singular_values();
        prop_assume!(singular.min() > 0.1 * singular.max());
        let task = DVector::from_row_slice(&b[..rows]);
        let constraint = LinearTask::new(matrix.clone(), task.clone()).unwrap();
        let state = DVector::zeros(5);
        let velocity = constraint.task_velocity(state.as_view(), 0.0).unwrap();
        prop_assert!((&matrix * &velocity - task).amax() < 1e-12);
        let across = LinearConstraint::new(matrix).unwrap().null_space_projector(state.as_view(), 0.0).unwrap();
        prop_assert!(across.project(velocity.as_view()).amax() < 1e-12);
    }

    /// On the plane A and b are constant: u is Nπ plus one push along the normal, the same in all samples of a
    /// movement.
    #[test]
    fn cycles_keep_their_task(seed in any::<u64>(), largest_task in 0.0..1.0f64, range in 0.1..1.5f64, k in 1..4usize) {
        let roll_out = RollOut { n_samples: 12, ..CyclesWithTask::default().roll_out };
        let system = CyclesWithTask { largest_task, n_trajectories: k, start_range: range, roll_out };
        let recordings = system.record(&mut generator(seed)).unwrap();
        prop_assert_eq!(recordings.len(), k);
        for recording in &recordings {
            let first = pushed(recording, 0);
            prop_assert!(first.norm() <= largest_task * (1.0 + 1e-12));
            prop_assert!(recording.truth.states.column(0).amax() <= range);
            for sample in 0..12 {
                prop_assert!((pushed(recording, sample) - &first).amax() < 1e-12);
                prop_assert!(recording.truth.projectors[sample].project(first.as_view()).amax() < 1e-12);
                let action = CyclesWithTask::POLICY.action(recording.truth.states.column(sample).as_view());
                prop_assert_eq!(recording.truth.actions.column(sample), action);
            }
        }
        // The task affects neither starts nor normals, and a longer data set begins like a shorter one.
        let other = CyclesWithTask { largest_task: 0.0, n_trajectories: k + 1, ..system }.record(&mut generator(seed)).unwrap();
        for (one, other) in recordings.iter().zip(&other) {
            prop_assert_eq!(one.truth.states.column(0), other.truth.states.column(0));
            prop_assert_eq!(&one.truth.projectors[0], &other.truth.projectors[0]);
            prop_assert!(pushed(other, 3).amax() < 1e-15);
        }
    }

    /// The power ratio is as requested, and only velocities change.
    #[test]
    fn noise_has_its_ratio(seed in any::<u64>(), decibels in 5.0..50.0f64) {
        let recordings = CyclesWithTask { n_trajectories: 30, ..CyclesWithTask::default() }.record(&mut generator(seed)).unwrap();
        let noisy = with_velocity_noise(&recordings, decibels, &mut generator(seed)).unwrap();
        let (mut power, mut noise) = (0.0, 0.0);
        for (clean, noisy) in recordings.iter().zip(&noisy) {
            prop_assert_eq!(&clean.truth, &noisy.truth);
            prop_assert_eq!(clean.observed.states(), noisy.observed.states());
            let (u, with) = (clean.observed.velocities().unwrap(), noisy.observed.velocities().unwrap());
            power += u.norm_squared();
            noise += (with - u).norm_squared();
        }
        prop_assert!((10.0 * (power / noise).log10() - decibels).abs() < 0.5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// A tool with constrained height stays in one plane through its start, whose tilt is within bounds.
    #[test]
    fn wiping_keeps_its_height(seed in any::<u64>()) {
        let arm = arm(Contact::Height, 2, 20);
        for recording in arm.record(&mut generator(seed)).unwrap() {
            let (first, _, jacobian) = tool(&arm, &recording, 0);
            // The forbidden direction is J_vᵀn, which determines n.
            let transposed = jacobian.fixed_rows::<3>(0).transpose().svd(true, true);
            let normal = transposed.solve(&forbidden_row(&recording), 1e-12).unwrap();
            let normal = Vector3::new(normal[0], normal[1], normal[2]).normalize();
            prop_assert!(normal.z.abs() > (30f64.to_radians().cos()).powi(2) - 1e-9);
            for sample in 0..20 {
                prop_assert!(pushed(&recording, sample).amax() < 1e-15);
                let (position, _, _) = tool(&arm, &recording, sample);
                // Euler steps deviate from the plane by their square.
                prop_assert!(normal.dot(&(position - first)).abs() < 0.01);
            }
        }
    }

    /// Flat contact brings the tool to its surface: distances decay as e^(−κt).
    #[test]
    fn flat_contact_is_restored(seed in any::<u64>(), rate in 1.0..3.0f64) {
        let mut arm = arm(Contact::Flat, 2, 30);
        (arm.task_rate, arm.off_surface) = (rate, 0.05);
        for recording in arm.record(&mut generator(seed)).unwrap() {
            let ranks: Vec<usize> = recording.truth.projectors.iter().map(constraints::NullSpaceProjector::rank).collect();
            prop_assert_eq!(ranks, vec![3; 30]);
            let size = |sample: usize| {
                let (_, _, jacobian) = tool(&arm, &recording, sample);
                (jacobian * pushed(&recording, sample)).norm()
            };
            let expected = (1.0 - rate * arm.roll_out.time_step).powi(29);
            prop_assert!(size(29) < 3.0 * expected * size(0) + 1e-3, "{} after {}", size(29), size(0));
        }
    }

    /// The policy moves the tool according to its formula, wherever the arm is not singular.
    #[test]
    fn the_wiping_policy_moves_the_tool(seed in any::<u64>()) {
        let arm = arm(Contact::Height, 1, 3);
        let recording = arm.record(&mut generator(seed)).unwrap().swap_remove(0);
        for sample in 0..3 {
            let (position, _, jacobian) = tool(&arm, &recording, sample);
            let r = position - Vector3::new(0.55, 0.0, 0.4);
            let squared = r.x * r.x + r.y * r.y;
            let literal = Vector3::z().cross(&r) + (0.0225 - squared) / (0.0225 + squared) * Vector3::new(r.x, r.y, 0.0) - r.z * Vector3::z();
            let moved = jacobian.fixed_rows::<3>(0) * recording.truth.actions.column(sample);
            prop_assert!((moved - literal).amax() < 1e-10);
        }
    }
}

/// The only forbidden direction, (n).
fn forbidden_row(recording: &Recording) -> DVector<f64> {
    let forbidden = DMatrix::identity(7, 7) - recording.truth.projectors[0].matrix();
    forbidden.svd(true, false).u.unwrap().column(0).into_owned()
}

#[test]
fn bad_input() {
    let cycles = |system: CyclesWithTask| system.record(&mut generator(1)).unwrap_err();
    let good = CyclesWithTask::default;
    assert_eq!(cycles(CyclesWithTask { largest_task: -0.1, ..good() }), DemoGenError::Task { largest: -0.1 });
    assert_eq!(cycles(CyclesWithTask { start_range: -1.0, ..good() }), DemoGenError::StartRange { range: -1.0 });
    assert_eq!(cycles(CyclesWithTask { n_trajectories: 0, ..good() }), DemoGenError::NoTrajectory);
    let tilted = |set: fn(&mut Wiping)| {
        let mut wiping = arm(Contact::Flat, 1, 3);
        set(&mut wiping);
        wiping.record(&mut generator(1)).unwrap_err()
    };
    assert_eq!(tilted(|arm| arm.largest_tilt = 2.0), DemoGenError::Tilt { largest: 2.0 });
    assert_eq!(
        tilted(|arm| arm.off_surface = -1.0),
        DemoGenError::Deviation { name: "deviation off the surface", value: -1.0 }
    );
    assert_eq!(tilted(|arm| arm.task_rate = 0.0), DemoGenError::TaskRate { rate: 0.0 });
    let three = include_str!("../../../robots/planar_three_link.urdf");
    assert!(matches!(Wiping::new(three, Contact::Flat), Err(DemoGenError::Joints { found: 3, expected: 7 })));
    let recordings = CyclesWithTask { n_trajectories: 1, ..good() }.record(&mut generator(1)).unwrap();
    let infinite = with_velocity_noise(&recordings, f64::INFINITY, &mut generator(1)).unwrap_err();
    assert_eq!(infinite, DemoGenError::SignalToNoise { decibels: f64::INFINITY });
    assert_eq!(with_velocity_noise(&[], 20.0, &mut generator(1)).unwrap_err(), DemoGenError::NoTrajectory);
    assert!(LinearTask::new(DMatrix::identity(1, 2), DVector::from_element(1, f64::NAN)).is_err());
}
