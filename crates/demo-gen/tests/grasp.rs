//! Grasping: random draws, the wall's constraint at every step, consistency of truth and scene, and refused input.

use crate::robots::upper_body;
use constraints::PfaffianConstraint;
use demo_gen::{DemoGenError, Grasp, GraspScene, RollOut};
use kinematics::Workspace;
use motion::Potential;
use nalgebra::{DVector, Point3, dvector};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// A scene with ball, wall and obstacle anywhere in front of the robot.
fn scene() -> impl Strategy<Value = GraspScene> {
    (0.5..0.9f64, -0.1..0.1f64, 0.5..0.8f64, 0.05..0.3f64, 0.3..0.45f64, 0.01..0.12f64, 0.01..0.3f64).prop_map(
        |(x, y, z, ball_diameter, wall, wall_influence, obstacle_half_width)| GraspScene {
            ball: Point3::new(x, y, z),
            ball_diameter,
            wall,
            wall_influence,
            obstacle_half_width,
            ..GraspScene::default()
        },
    )
}

fn grasp() -> impl Strategy<Value = Grasp> {
    let roll_out = (0.05..0.5f64, 2..60usize, 1..4usize).prop_map(|(time_step, n_samples, sub_steps)| RollOut {
        time_step,
        n_samples,
        sub_steps,
    });
    let gaps = (0.0..0.5f64, 0.0..0.3f64, 0.0..0.3f64);
    (scene(), roll_out, 1..5usize, gaps, 0.0..0.15f64, (0.25..0.4f64, 0.0..0.1f64)).prop_map(
        |(scene, roll_out, n_trajectories, gaps, start_variance, (start_depth, start_side))| Grasp {
            scene,
            roll_out,
            n_trajectories,
            gap_mean: gaps.0,
            gap_deviation: gaps.1,
            gap_least: gaps.2,
            start_variance,
            start_depth: start_depth.max(0.27),
            start_side,
            ..Grasp::new(upper_body())
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn starts_are_natural_postures_of_the_robot(grasp in grasp(), seed in any::<u64>()) {
        let body = &grasp.body;
        let mut generator = rng(seed);
        for _ in 0..grasp.n_trajectories {
            let start = grasp.start(&mut generator).unwrap();
            prop_assert_eq!(body.robot().n_beyond_limits(start.posture.as_view()).unwrap(), 0);
            let mut workspace = Workspace::new();
            let poses = body.robot().forward_kinematics(start.posture.as_view(), &mut workspace).unwrap();
            prop_assert!(!body.collision().collides(&poses));
            for (at, name) in [(0, "l_palm"), (3, "r_palm")] {
                let palm = poses.position(body.robot().link(name).unwrap());
                prop_assert!((palm.coords - start.palms.fixed_rows::<3>(at)).norm() < 1e-14);
                prop_assert!(palm.x < grasp.start_depth && !grasp.scene.is_below_the_table(&palm));
            }
            prop_assert!(start.palms[1] > grasp.start_side && start.palms[4] < -grasp.start_side);
            prop_assert!(start.gap >= grasp.gap_least);
        }
    }

    /// A u = 0, rank and N at every sample, recomputed from the scene's dimensions; movements cross the wall only in
    /// the gap.
    #[test]
    fn the_wall_is_obeyed_at_every_step(grasp in grasp(), seed in any::<u64>()) {
        let recordings = grasp.record(&mut rng(seed)).unwrap();
        prop_assert_eq!(&recordings, &grasp.record(&mut rng(seed)).unwrap());
        let mut generator = rng(seed);
        for recording in &recordings {
            let start = grasp.start(&mut generator).unwrap();
            prop_assert_eq!(recording.truth.states.column(0), start.palms.column(0));
            let velocities = recording.observed.velocities().unwrap();
            let wall = grasp.scene.wall_with_gap(start.gap).unwrap();
            for sample in 0..grasp.roll_out.n_samples {
                let (x, u) = (recording.truth.states.column(sample), velocities.column(sample));
                let action = recording.truth.actions.column(sample);
                let blocked = |hand: usize| {
                    (x[3 * hand] - grasp.scene.wall).abs() < grasp.scene.wall_influence && x[3 * hand + 1].abs() > start.gap / 2.0
                };
                let mut expected = action.clone_owned();
                for hand in (0..2).filter(|&hand| blocked(hand)) {
                    expected[3 * hand] = 0.0;
                }
                prop_assert_eq!(u, expected.column(0));
                let rank = (0..2).filter(|&hand| blocked(hand)).count();
                prop_assert_eq!(recording.truth.projectors[sample].rank(), rank);
                let forbidden = wall.matrix(x, 0.0).unwrap() * u;
                prop_assert!(forbidden.iter().all(|&value| value == 0.0));
                prop_assert_eq!(action.clone_owned(), -grasp.scene.potential().gradient(x));
            }
        }
    }

    /// Rule (9), without its factor 1/(1 − wδt), recovers the true potential along every plain Euler movement.
    #[test]
    fn rule_9_finds_the_potential(grasp in grasp(), seed in any::<u64>()) {
        let grasp = Grasp { roll_out: RollOut { sub_steps: 1, ..grasp.roll_out }, ..grasp };
        let time_step = grasp.roll_out.time_step;
        for recording in grasp.record(&mut rng(seed)).unwrap() {
            let (x, phi) = (&recording.truth.states, &recording.truth.potential);
            for sample in 1..x.ncols() {
                let by_rule = -(x.column(sample) - x.column(sample - 1)).norm_squared() / time_step;
                prop_assert!((by_rule * (1.0 - 0.05 * time_step) - (phi[sample] - phi[sample - 1])).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn scene_matches_its_parameters(scene in scene(), gap in 0.0..0.5f64, state in proptest::collection::vec(-1.0..1.0f64, 6)) {
        let (target, state) = (scene.target(), DVector::from_vec(state));
        let side = scene.ball_diameter / 2.0;
        let ball = scene.ball;
        prop_assert_eq!(&target, &dvector![ball.x, ball.y + side, ball.z, ball.x, ball.y - side, ball.z]);
        prop_assert!((scene.potential().value(state.as_view()) - 0.05 * (&state - target).norm_squared()).abs() < 1e-14);
        let near = |hand: usize| (state[3 * hand] - scene.wall).abs() < scene.wall_influence;
        let rank = |blocked: &dyn Fn(usize) -> bool| (0..2).filter(|&hand| near(hand) && blocked(hand)).count();
        let of = |barrier: constraints::Barrier| barrier.null_space_projector(state.as_view(), 0.0).unwrap().rank();
        let beside = rank(&|hand| state[3 * hand + 1].abs() > gap / 2.0);
        prop_assert_eq!(of(scene.wall_with_gap(gap).unwrap()), beside);
        let before = rank(&|hand| state[3 * hand + 1].abs() < scene.obstacle_half_width);
        prop_assert_eq!(of(scene.central_obstacle().unwrap()), before);
    }
}

/// The wall stops nearly all movements for a while, but none until the end; narrower gaps would.
#[test]
fn every_movement_gets_through() {
    let held_up = |grasp: &Grasp| {
        let recordings = grasp.record(&mut rng(1)).unwrap();
        let stopped = recordings.iter().filter(|r| r.truth.projectors.iter().any(|n| n.rank() > 0)).count();
        assert!(stopped > 80 && recordings.len() == 100, "{stopped} of 100");
        recordings.iter().filter(|r| r.truth.projectors[99].rank() > 0).count()
    };
    let grasp = Grasp::new(upper_body());
    assert_eq!(held_up(&grasp), 0);
    assert!((5..30).contains(&held_up(&Grasp { gap_least: 0.0, ..grasp })));
}

#[test]
fn table_and_points() {
    let scene = GraspScene::default();
    for (point, below) in [
        ([0.5, 0.0, 0.57], true),
        ([0.5, 0.0, 0.58], false),
        ([0.44, 0.0, 0.3], false),
        ([1.06, 0.0, 0.3], false),
        ([0.5, 0.61, 0.3], false),
        ([0.5, -0.6, 0.0], true),
    ] {
        assert_eq!(scene.is_below_the_table(&Point3::from(point)), below, "{point:?}");
    }
}

#[test]
fn unsuitable_scenes_are_refused() {
    let good = || Grasp { n_trajectories: 2, ..Grasp::new(upper_body()) };
    let refused = |grasp: Grasp| grasp.record(&mut rng(1)).unwrap_err();
    let first = |source| DemoGenError::InTrajectory { trajectory: 0, source: Box::new(source) };
    assert_eq!(refused(Grasp { n_trajectories: 0, ..good() }), DemoGenError::NoTrajectory);
    for (mean, deviation, least) in
        [(f64::INFINITY, 0.1, 0.1), (0.2, -0.1, 0.1), (0.2, f64::INFINITY, 0.1), (0.2, 0.1, -0.1)]
    {
        let grasp = Grasp { gap_mean: mean, gap_deviation: deviation, gap_least: least, ..good() };
        assert_eq!(refused(grasp), first(DemoGenError::Gap { mean, deviation, least }));
    }
    assert_eq!(refused(Grasp { start_depth: -1.0, ..good() }), first(DemoGenError::NoNaturalStart { draws: 10_000 }));
    let variance = -1.0;
    assert_eq!(refused(Grasp { start_variance: variance, ..good() }), first(DemoGenError::StartVariance { variance }));
    let scene = GraspScene { wall_influence: 0.0, ..GraspScene::default() };
    let source = constraints::ConstraintError::Influence { influence: 0.0 };
    assert_eq!(refused(Grasp { scene, ..good() }), first(DemoGenError::Constraint { sample: 0, source }));
    let roll_out = RollOut { n_samples: 1, ..good().roll_out };
    assert_eq!(refused(Grasp { roll_out, ..good() }), first(DemoGenError::TooFewSamples { n_samples: 1 }));
}
