//! Demonstrations that cannot be aligned give an error with place and reason; unusual but valid ones give finite numbers.

use crate::literal::Literal;
#[allow(dead_code, reason = "H is all that is compared")]
use align::{AlignError, Aligned, Bandwidth, DirectPolicyLearning, Integration, LwprRegressor, PolicyAlign, Warning};
use lwpr::{LwprError, LwprParams};
use motion::{Demonstrations, Policy, Potential, Trajectory};
use nalgebra::{DMatrix, DVector};
use rand::{SeedableRng, rngs::StdRng};

fn line(from: [f64; 2], to: [f64; 2], samples: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2, samples, |c, i| from[c] + (to[c] - from[c]) * i as f64 / (samples - 1) as f64)
}

/// Three lines side by side.
fn sound() -> Vec<DMatrix<f64>> {
    (0..3).map(|k| line([0.0, f64::from(k)], [1.0, f64::from(k) + 0.2], 10)).collect()
}

fn observed(positions: Vec<DMatrix<f64>>) -> Demonstrations {
    Demonstrations::from_states(positions, 0.1).unwrap()
}

fn with(change: impl Fn(&mut PolicyAlign)) -> PolicyAlign {
    let mut learner = PolicyAlign::default();
    change(&mut learner);
    learner
}

#[test]
#[allow(clippy::too_many_lines, reason = "a table, one case a row")]
fn invalid_input_is_refused() {
    let touching =
        || vec![line([0.0, 0.0], [1.0, 1.0], 5), line([0.0, 0.0], [1.0, 1.0], 5), line([9.0, 0.0], [8.0, 0.0], 5)];
    let half_recorded = {
        let velocities = DMatrix::from_element(2, 10, 0.5);
        let mut trajectories: Vec<_> = sound().into_iter().map(|x| Trajectory::new(x, 0.1).unwrap()).collect();
        trajectories[0] = trajectories[0].clone().with_velocities(velocities).unwrap();
        Demonstrations::new(trajectories).unwrap()
    };
    let steep = || Demonstrations::from_states([line([0.0, 0.0], [1e5, 0.0], 4)], 1e-300).unwrap();
    let single = || observed(vec![line([0.0, 0.0], [1.0, 1.0], 5)]);
    let goals = || {
        let goal = |k: usize| DVector::from_element(1, if k < 2 { 0.5 } else { 0.75 });
        let movement = |(k, x)| Trajectory::new(x, 0.1).unwrap().with_context(goal(k)).unwrap();
        Demonstrations::new(sound().into_iter().enumerate().map(movement).collect()).unwrap()
    };
    let duplicates = |pairs, usable| AlignError::ZeroBandwidth { pairs, usable };
    let parameter = |name, value, requirement| AlignError::Parameter { name, value, requirement };
    let sigma = "bandwidth Fixed(sigma_squared)";
    let positive = "be positive and finite";

    let cases: Vec<(&str, PolicyAlign, Demonstrations, AlignError)> = vec![
        ("two goals", with(|_| {}), goals(), AlignError::Context { trajectory: 2 }),
        ("one trajectory, narrow", with(|_| {}), single(), AlignError::SingleTrajectory),
        ("one trajectory, medium", with(|p| p.bandwidth = Bandwidth::Medium), single(), AlignError::SingleTrajectory),
        ("one trajectory, wide", with(|p| p.bandwidth = Bandwidth::Wide), single(), AlignError::SingleTrajectory),
        ("duplicates, narrow", with(|_| {}), observed(touching()), duplicates(vec![(0, 1)], Some(50.0))),
        (
            "duplicates, medium",
            with(|p| p.bandwidth = Bandwidth::Medium),
            observed(touching()),
            duplicates(vec![(0, 1)], Some(50.0_f64.sqrt() * 50.0_f64.sqrt())),
        ),
        (
            "all points equal",
            with(|p| p.bandwidth = Bandwidth::Wide),
            observed(vec![line([1.0, 2.0], [1.0, 2.0], 4); 3]),
            duplicates(vec![(0, 1), (0, 2), (1, 2)], None),
        ),
        (
            "bandwidth 0",
            with(|p| p.bandwidth = Bandwidth::Fixed(0.0)),
            observed(sound()),
            parameter(sigma, 0.0, positive),
        ),
        (
            "bandwidth −1",
            with(|p| p.bandwidth = Bandwidth::Fixed(-1.0)),
            observed(sound()),
            parameter(sigma, -1.0, positive),
        ),
        (
            "bandwidth ∞",
            with(|p| p.bandwidth = Bandwidth::Fixed(f64::INFINITY)),
            observed(sound()),
            parameter(sigma, f64::INFINITY, positive),
        ),
        (
            "threshold 0",
            with(|p| p.eigenvalue_threshold = 0.0),
            observed(sound()),
            parameter("eigenvalue_threshold", 0.0, positive),
        ),
        (
            "floor 1",
            with(|p| p.responsibility_floor = 1.0),
            observed(sound()),
            parameter("responsibility_floor", 1.0, "be at least 0 and less than 1"),
        ),
        (
            "floor −1e-20",
            with(|p| p.responsibility_floor = -1e-20),
            observed(sound()),
            parameter("responsibility_floor", -1e-20, "be at least 0 and less than 1"),
        ),
        (
            "no velocities",
            with(|p| p.integration = Integration::Velocity),
            half_recorded.clone(),
            AlignError::NoVelocities { trajectory: 1 },
        ),
        (
            "no velocities for the work",
            with(|p| p.integration = Integration::Work),
            half_recorded,
            AlignError::NoVelocities { trajectory: 1 },
        ),
        (
            "steps too small",
            with(|_| {}),
            observed(sound().into_iter().map(|x| x * 1e-170).collect()),
            AlignError::PotentialUnderflow { trajectory: 0, lowest: 0.0 },
        ),
        (
            "steps too slow",
            with(|_| {}),
            Demonstrations::from_states(sound().into_iter().map(|x| x * 1e-10), 4e307).unwrap(),
            AlignError::PotentialUnderflow { trajectory: 0, lowest: 0.0 },
        ),
        (
            "more than the memory holds",
            with(|p| p.memory_limit = 3759),
            observed(sound()),
            // Three by three trajectories, each of ten samples in two groups of eight.
            AlignError::Memory { needed: 28 * 12 * 16 + 112 * 9, limit: 3759 },
        ),
        ("steps too fast", with(|_| {}), steep(), AlignError::PotentialOverflow { trajectory: 0, sample: 1 }),
        (
            "too far apart",
            with(|_| {}),
            Demonstrations::from_states(
                [line([0.0, -1e200], [1.0, -1e200], 3), line([0.0, 1e200], [1.0, 1e200], 3)],
                1.0,
            )
            .unwrap(),
            AlignError::SpanOverflow { dimension: 1, span: 2e200 },
        ),
        (
            "potentials too different",
            with(|p| {
                p.integration = Integration::Work;
                p.bandwidth = Bandwidth::Fixed(1.0);
            }),
            {
                let x = || line([0.0, 0.0], [3.0, 0.0], 4);
                let u = |sign: f64| DMatrix::from_element(2, 4, sign * 5e307);
                let recorded = |sign| Trajectory::new(x(), 1.0).unwrap().with_velocities(u(sign)).unwrap();
                Demonstrations::new(vec![recorded(1.0), recorded(-1.0)]).unwrap()
            },
            AlignError::OffsetOverflow { trajectory: 0 },
        ),
        (
            "as far apart as can be",
            with(|_| {}),
            Demonstrations::from_states(
                [line([0.0, -1e308], [1.0, -1e308], 3), line([0.0, 1e308], [1.0, 1e308], 3)],
                1.0,
            )
            .unwrap(),
            AlignError::SpanOverflow { dimension: 1, span: f64::INFINITY },
        ),
    ];
    for (name, learner, demonstrations, expected) in cases {
        assert_eq!(learner.align(&demonstrations).unwrap_err(), expected, "{name}");
    }
    // The remaining value has lost most of its digits.
    let slow = Demonstrations::from_states(sound(), 4e307).unwrap();
    let error = PolicyAlign::default().align(&slow).unwrap_err();
    assert!(matches!(error, AlignError::PotentialUnderflow { trajectory: 0, lowest } if lowest > 0.0), "{error}");
    for learner in [
        with(|p| p.bandwidth = Bandwidth::Fixed(f64::NAN)),
        with(|p| p.eigenvalue_threshold = f64::NAN),
        with(|p| p.responsibility_floor = f64::NAN),
    ] {
        let error = learner.align(&observed(sound())).unwrap_err();
        assert!(matches!(error, AlignError::Parameter { value, .. } if value.is_nan()), "{error}");
    }
}

#[test]
fn invalid_regression_input_is_refused() {
    let aligned = PolicyAlign::default().align(&observed(sound())).unwrap();
    let mut rng = StdRng::seed_from_u64(1);
    let parameter = |name, value, range| AlignError::Lwpr(LwprError::Parameter { name, value, range });
    let cutoff = |value| parameter("cutoff", value, "at least 0 and less than 1");
    let passes = parameter("passes", 0.0, "at least 1");
    let norm_out = LwprParams { norm_out: Some(DVector::repeat(1, 0.0)), ..Default::default() };
    let bad_metric = LwprParams { init_d: -1.0, ..Default::default() };

    let cases = [
        ("cutoff −1", LwprRegressor { cutoff: -1.0, ..Default::default() }, Some(cutoff(-1.0))),
        ("cutoff 1", LwprRegressor { cutoff: 1.0, ..Default::default() }, Some(cutoff(1.0))),
        ("norm_out", LwprRegressor { params: norm_out, ..Default::default() }, None),
        ("no pass", LwprRegressor { passes: 0, ..Default::default() }, Some(passes)),
        ("metric", LwprRegressor { params: bad_metric, ..Default::default() }, None),
    ];
    for (name, regressor, expected) in cases {
        let naive = DirectPolicyLearning { regressor: regressor.clone() };
        let errors = [
            aligned.regress(&regressor, &aligned.samples(), &mut rng).unwrap_err(),
            naive.learn_policy(aligned.demonstrations(), &[], &mut rng).unwrap_err(),
        ];
        for error in errors {
            match &expected {
                Some(expected) => assert_eq!(&error, expected, "{name}"),
                None => assert!(matches!(error, AlignError::Lwpr(_)), "{name}: {error}"),
            }
        }
    }
    let everything = aligned.samples();
    let nothing = everything.without(everything.indices());
    assert!(nothing.is_empty());
    assert_eq!(aligned.regress(&LwprRegressor::default(), &nothing, &mut rng).unwrap_err(), AlignError::NoSamples);
    let learnt = aligned.learn_without(everything.indices(), &LwprRegressor::default(), &mut rng);
    assert_eq!(learnt.unwrap_err(), AlignError::NoSamples);
    let policy = aligned.learn(&LwprRegressor::default(), &mut rng).unwrap();
    assert_eq!(policy.with_cutoff(2.0).unwrap_err(), cutoff(2.0));
}

/// Checks that no output of a learner is NaN.
fn assert_finite(name: &str, aligned: &Aligned) {
    let size = aligned.samples().states().amax().max(f64::MIN_POSITIVE);
    let norm_in = Some(DVector::from_element(aligned.demonstrations().dim(), size));
    let params = LwprParams { norm_in, ..Default::default() };
    let regressor = LwprRegressor { params, ..Default::default() };
    let learnt = aligned.learn(&regressor, &mut StdRng::seed_from_u64(1)).unwrap();
    assert!(aligned.offsets().iter().all(|offset| offset.is_finite()), "{name}");
    assert!(aligned.sigma_squared().is_finite() && aligned.lambda_2().is_none_or(f64::is_finite), "{name}");
    assert!(aligned.objective().unwrap().laplacian.iter().all(|entry| entry.is_finite()), "{name}");
    assert!(!aligned.objective().unwrap().constant.is_nan(), "{name}");
    for (x, value) in aligned.samples() {
        assert!(value.is_finite() && aligned.responsibilities(x).iter().all(|q| q.is_finite()), "{name}");
        assert!(learnt.global_potential().value(x).is_finite(), "{name}");
        assert!(learnt.action(x).iter().all(|u| u.is_finite()), "{name}");
    }
}

#[test]
fn unusual_valid_input_is_aligned() {
    let still = || line([0.5, 0.5], [0.5, 0.5], 6);
    let fixed = |sigma_squared| with(move |p| p.bandwidth = Bandwidth::Fixed(sigma_squared));
    let one_still = {
        let mut all = sound();
        all.push(still());
        all
    };
    let one_duplicate = {
        let mut all = sound();
        all.push(all[0].clone());
        all
    };
    let tiny: Vec<_> = sound().into_iter().map(|x| x * 1e-150).collect();
    let huge: Vec<_> = sound().into_iter().map(|x| x * 1e150).collect();
    // 2σ² overflows, σ² does not.
    let at_the_limit = || [0.0, 1.2e154].map(|y| line([0.0, y], [1e153, y], 10)).to_vec();
    let far: Vec<_> = sound().into_iter().map(|x| x.add_scalar(1e9)).collect();
    let lengths = (2..6).map(|n| line([0.0, n as f64], [1.0, n as f64], n)).collect();

    let cases: Vec<(&str, PolicyAlign, Vec<DMatrix<f64>>, usize)> = vec![
        ("one trajectory, fixed bandwidth", fixed(0.1), vec![sound().remove(0)], 1),
        ("a trajectory that never moves", with(|_| {}), one_still, 4),
        ("all points equal, fixed bandwidth", fixed(0.1), vec![still(); 3], 3),
        ("one duplicate, wide", with(|p| p.bandwidth = Bandwidth::Wide), one_duplicate, 4),
        ("a bandwidth that underflows", fixed(5e-324), sound(), 1),
        ("a bandwidth beyond all bounds", fixed(f64::MAX), sound(), 3),
        ("tiny coordinates", with(|_| {}), tiny, 3),
        ("huge coordinates", with(|_| {}), huge, 3),
        ("as far apart as squares allow", with(|_| {}), at_the_limit(), 2),
        ("far from the origin", with(|_| {}), far, 3),
        ("different lengths", with(|_| {}), lengths, 4),
        ("nothing dropped", with(|p| p.responsibility_floor = 0.0), sound(), 3),
        ("a threshold that nothing reaches", with(|p| p.eigenvalue_threshold = 1e300), sound(), 1),
    ];
    for (name, learner, positions, kept) in cases {
        let demonstrations = observed(positions);
        let aligned = learner.align(&demonstrations).unwrap();
        assert_eq!(aligned.kept().len(), kept, "{name}");
        let PolicyAlign { integration, bandwidth, responsibility_floor: floor, .. } = learner;
        let (laplacian, _) = Literal::new(&demonstrations, integration, bandwidth, floor).laplacian_and_linear();
        let miss = (&aligned.objective().unwrap().laplacian - laplacian).amax();
        assert!(miss <= 1e-14 * demonstrations.n_samples() as f64, "{name}: {miss:e}");
        assert_eq!(
            aligned.kept().len() + aligned.discarded().len(),
            aligned.demonstrations().n_trajectories(),
            "{name}"
        );
        assert!(aligned.offsets().sum().abs() <= 1e-12 * (1.0 + aligned.offsets().amax()), "{name}");
        assert_finite(name, &aligned);
    }
}

#[test]
fn doubtful_alignments_give_warnings() {
    let apart: Vec<_> = (0..4).map(|k| line([0.0, 10.0_f64.powi(k)], [1.0, 10.0_f64.powi(k)], 5)).collect();
    let aligned = with(|p| p.bandwidth = Bandwidth::Fixed(0.1)).align(&observed(apart)).unwrap();
    assert_eq!(aligned.warnings(), [Warning::ManyDiscarded { discarded: 3, of: 4 }]);
    assert_eq!((aligned.kept(), aligned.discarded()), (&[0][..], &[1, 2, 3][..]));
    assert_eq!((aligned.offset(0), aligned.offset(1), aligned.lambda_2()), (Some(0.0), None, None));

    let aligned = PolicyAlign::default().align(&observed(sound())).unwrap();
    assert_eq!(aligned.warnings(), []);
    // Half of the trajectories is not more than half.
    for (count, warned) in [(4, vec![]), (5, vec![Warning::ManyDiscarded { discarded: 3, of: 5 }])] {
        let near_or_apart = |k: i32| if k < 2 { 0.1 * f64::from(k) } else { 10.0_f64.powi(k) };
        let movements = (0..count).map(|k| line([0.0, near_or_apart(k)], [1.0, near_or_apart(k)], 5)).collect();
        let aligned = with(|p| p.bandwidth = Bandwidth::Fixed(0.1)).align(&observed(movements)).unwrap();
        assert_eq!((aligned.kept(), aligned.warnings()), (&[0, 1][..], &warned[..]));
    }
    let lambda_2 = aligned.lambda_2().unwrap();
    let strict = with(|p| p.eigenvalue_threshold = lambda_2 / 2.0).align(&observed(sound())).unwrap();
    assert_eq!(strict.warnings(), [Warning::BarelyConnected { lambda_2, threshold: lambda_2 / 2.0 }]);
    assert!(strict.warnings()[0].to_string().contains("barely connected"));
}

#[test]
fn errors_suggest_a_remedy() {
    let pairs = (0..7).map(|k| (k, k + 1)).collect();
    let message = AlignError::ZeroBandwidth { pairs, usable: Some(0.01234) }.to_string();
    assert!(
        message.contains("0 and 1, 1 and 2")
            && message.contains("2 more")
            && message.contains("Bandwidth::Fixed(1.234e-2)")
    );
    assert!(AlignError::SingleTrajectory.to_string().contains("Bandwidth::Fixed"));
    assert!(AlignError::NoVelocities { trajectory: 3 }.to_string().contains("trajectory 3"));
}

#[test]
#[should_panic(expected = "as many dimensions as the potential")]
fn a_state_of_wrong_dimension_panics() {
    let aligned = PolicyAlign::default().align(&observed(sound())).unwrap();
    let learnt = aligned.learn(&LwprRegressor::default(), &mut StdRng::seed_from_u64(1)).unwrap();
    learnt.global_potential().value(DVector::zeros(3).as_view());
}

#[test]
#[should_panic(expected = "as many dimensions as the trajectory")]
fn responsibilities_panic_for_a_state_of_wrong_dimension() {
    let aligned = PolicyAlign::default().align(&observed(sound())).unwrap();
    aligned.responsibilities(DVector::zeros(3).as_view());
}

#[test]
#[should_panic(expected = "an action has as many dimensions as the policy")]
fn an_action_of_wrong_dimension_panics() {
    let policy = DirectPolicyLearning::default();
    let policy = policy.learn_policy(&observed(sound()), &[], &mut StdRng::seed_from_u64(1)).unwrap();
    policy.action_into(DVector::zeros(2).as_view(), DVector::zeros(3).as_view_mut());
}

#[test]
fn overflow_in_discarded_trajectories_is_harmless() {
    // Three trajectories that agree; far away, two that meet, with potentials too different for f64.
    let still = |y| (line([0.0, y], [3.0, y], 4), DMatrix::from_element(2, 4, 0.1));
    let steep = |sign: f64| (line([100.0, 0.0], [103.0, 0.0], 4), DMatrix::from_element(2, 4, sign * 5e307));
    let movements = [still(0.0), still(1.0), still(2.0), steep(1.0), steep(-1.0)];
    let recorded = |(x, u)| Trajectory::new(x, 1.0).unwrap().with_velocities(u).unwrap();
    let demonstrations = Demonstrations::new(movements.into_iter().map(recorded).collect()).unwrap();
    let learner =
        PolicyAlign { integration: Integration::Work, bandwidth: Bandwidth::Fixed(1.0), ..Default::default() };
    let aligned = learner.align(&demonstrations).unwrap();
    assert_eq!((aligned.kept(), aligned.discarded()), (&[0, 1, 2][..], &[3, 4][..]));
    assert!(aligned.offsets().amax() < 1e-14);
    assert!(!aligned.objective().unwrap().linear[3].is_finite());
    assert_eq!(aligned.objective().unwrap().constant, f64::INFINITY);
}
