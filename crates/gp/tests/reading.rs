//! The rule that selects a reading.

use crate::drawn::{descent, rng, rows};
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
use demo_gen::{demonstrations, with_velocity_noise};
use gp::{AutoFit, AutoGp, FrontEnd, Grouping, Hypothesis, LeastSeen, PushTest, ReadingNumbers, SlopeGp};
use motion::Policy as _;
use proptest::prelude::*;

proptest! {
    /// One dimension has no direction across: whatever the numbers, they show no hidden part and do not suggest one.
    #[test]
    fn one_dimension_has_no_hidden_part(
        (a_s, a_d) in (0.0..2.0, 0.0..2.0),
        (q, t) in (0.0..3.0, -5.0..9.0),
        (lambda, t_lambda) in (-3.0..9.0, -5.0..9.0),
        (p_d, gap, hidden) in (0.0..2.0, 0.0..2.0, 0.0..1.0),
        trajectories in 3_usize..50,
    ) {
        let least_seen = LeastSeen { share: 1.0, direction: vec![1.0] };
        let grouping = Grouping::Trajectories;
        let n = ReadingNumbers { a_s, a_d, q, t, lambda, t_lambda, p_d, gap, least_seen, hidden, trajectories, grouping, free: None };
        prop_assert_eq!(n.reading(), if p_d > 0.5 && gap > 0.01 { Hypothesis::Unexplained } else { Hypothesis::Free });
        prop_assert!(!n.takes_slope(Hypothesis::Free) && !n.direction_tells());
    }
}

/// Numbers that pass every step of the rule but the last.
fn numbers() -> ReadingNumbers {
    ReadingNumbers {
        a_s: 0.02,
        a_d: 0.03,
        q: 0.67,
        t: 1.0,
        lambda: 0.1,
        t_lambda: 0.5,
        p_d: 0.2,
        gap: 0.4,
        least_seen: LeastSeen { share: 0.4, direction: vec![1.0, 0.0] },
        hidden: 0.3,
        trajectories: 6,
        grouping: Grouping::Trajectories,
        free: None,
    }
}

#[test]
fn reading_rule_decides_every_case() {
    let seen = |share: f64| LeastSeen { share: 0.5 * share, direction: vec![1.0, 0.0] };
    let constrained = || ReadingNumbers { q: 0.4, t: 2.6, ..numbers() };
    let cases = [
        (numbers(), Hypothesis::Ambiguous),
        (ReadingNumbers { gap: 0.01, ..constrained() }, Hypothesis::Free),
        (ReadingNumbers { gap: 0.01, least_seen: seen(0.1), ..constrained() }, Hypothesis::Free),
        (ReadingNumbers { gap: 0.01, least_seen: seen(0.09), ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { gap: 0.011, p_d: 0.01, ..constrained() }, Hypothesis::Constrained),
        (constrained(), Hypothesis::Constrained),
        (ReadingNumbers { a_s: 0.9, a_d: 2.4, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { t: 2.58, ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { t: 2.12, trajectories: 20, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { t: 2.11, trajectories: 20, ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { t: 2.82, trajectories: 5, ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { t: 2.83, trajectories: 5, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { q: 0.41, ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { trajectories: 4, t: 9.0, ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { trajectories: 4, p_d: 0.51, ..constrained() }, Hypothesis::Unexplained),
        (ReadingNumbers { lambda: 0.75, t_lambda: 2.6, ..numbers() }, Hypothesis::Constrained),
        (ReadingNumbers { lambda: 0.74, t_lambda: 2.6, ..numbers() }, Hypothesis::Ambiguous),
        (ReadingNumbers { lambda: 0.75, t_lambda: 2.58, ..numbers() }, Hypothesis::Ambiguous),
        (ReadingNumbers { lambda: 0.5, t_lambda: 2.6, p_d: 0.51, ..numbers() }, Hypothesis::Constrained),
        (ReadingNumbers { lambda: 0.49, t_lambda: 2.6, p_d: 0.51, ..numbers() }, Hypothesis::Unexplained),
        (ReadingNumbers { hidden: 0.07, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { hidden: 0.08, p_d: 0.41, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { hidden: 0.07, p_d: 0.41, ..constrained() }, Hypothesis::Free),
        (ReadingNumbers { hidden: 0.07, p_d: 0.51, ..constrained() }, Hypothesis::Free),
        (ReadingNumbers { hidden: 0.1, gap: 0.1, ..constrained() }, Hypothesis::Free),
        (ReadingNumbers { hidden: 0.1, gap: 0.11, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { hidden: 0.1, gap: 0.1, p_d: 0.09, ..constrained() }, Hypothesis::Constrained),
        (ReadingNumbers { hidden: 0.07, p_d: 0.41, least_seen: seen(0.24), ..constrained() }, Hypothesis::Ambiguous),
        (ReadingNumbers { p_d: 0.51, ..numbers() }, Hypothesis::Unexplained),
        (ReadingNumbers { gap: 0.1, least_seen: seen(0.25), ..numbers() }, Hypothesis::Free),
        (ReadingNumbers { gap: 0.1, least_seen: seen(0.24), ..numbers() }, Hypothesis::Ambiguous),
        (ReadingNumbers { grouping: Grouping::BlocksOfTime, ..constrained() }, Hypothesis::TooFew),
    ];
    for (numbers, reading) in cases {
        assert_eq!(numbers.reading(), reading, "{numbers:?}");
    }
}

#[test]
fn the_policy_follows_the_reading() {
    let n = numbers();
    assert!(n.takes_slope(Hypothesis::Constrained));
    assert!(
        !n.takes_slope(Hypothesis::Free) && !n.takes_slope(Hypothesis::Ambiguous) && !n.takes_slope(Hypothesis::TooFew)
    );
    assert!(n.takes_slope(Hypothesis::Unexplained));
    assert!(!ReadingNumbers { a_s: 0.04, ..n.clone() }.takes_slope(Hypothesis::Unexplained));
    // Free, and far better explained by a potential.
    let potential = ReadingNumbers { q: 0.4, t: 2.6, hidden: 0.07, p_d: 0.41, ..n };
    assert!(potential.takes_slope(potential.reading()));
    let same = ReadingNumbers { gap: 0.01, ..potential };
    assert!(!same.takes_slope(same.reading()));
}

#[test]
fn four_demonstrations_only_lean_towards_constraints() {
    let numbers = ReadingNumbers { trajectories: 4, q: 0.1, t: 3.5, ..numbers() };
    assert!(numbers.direction_tells() && numbers.hides());
    assert_eq!(numbers.reading(), Hypothesis::Ambiguous);
}

#[test]
fn a_given_reading_overrides_the_estimate() {
    let given = rows(2, (6, 10), descent, &mut rng(1));
    let own = AutoGp { reading: Some(Hypothesis::Free), ..AutoGp::default() };
    let fit = own.fit(&given, &mut rng(2)).expect("a fit");
    let x = given.states().column(3);
    assert_eq!(fit.reading(), Hypothesis::Constrained);
    assert_eq!(fit.action(x), fit.direct().action(x));
    assert!(fit.expected_nupe() >= fit.numbers().gap);
    assert_eq!(fit.overridden(), Some(Hypothesis::Free));
}

/// The fit of movements whose velocities may have noise, given in decibels.
fn learnt(policy: PolicyKind, constraint: ConstraintKind, n_trajectories: usize, decibels: Option<f64>) -> AutoFit {
    let system = BeyondSystem { policy, constraint, n_trajectories, ..BeyondSystem::default() };
    let rng = &mut rng(1);
    let recordings = system.record(rng).expect("movements");
    let recordings = match decibels {
        Some(decibels) => with_velocity_noise(&recordings, decibels, rng).expect("velocities"),
        None => recordings,
    };
    let slope = SlopeGp { max_rows: 400, hyper_rows: 200, push_test: PushTest::Fit, ..SlopeGp::default() };
    let learner = AutoGp { slope, ..AutoGp::default() };
    let rows = FrontEnd::Velocities.rows(&demonstrations(&recordings).expect("movements")).expect("rows");
    learner.fit(&rows, &mut self::rng(1)).expect("a fit")
}

/// Regression: with five movements on the plane, stretches once seemed informative though nothing pushed.
#[test]
fn five_free_movements_push_nothing() {
    let fit = learnt(PolicyKind::Sinusoidal, ConstraintKind::Free, 5, None);
    assert_ne!(fit.reading(), Hypothesis::Constrained, "{:?}", fit.numbers());
    assert_eq!(fit.slope().report().push, None);
}

/// Noise causes motion across a constraint common to all movements, but little.
#[test]
fn noise_across_a_common_constraint_stays_ambiguous() {
    let fit = learnt(PolicyKind::Wells { dim: 3 }, ConstraintKind::OneForAll, 20, Some(30.0));
    assert!(fit.numbers().gap <= 0.1 && fit.numbers().p_d < 0.1, "{:?}", fit.numbers());
    assert_eq!(fit.reading(), Hypothesis::Ambiguous, "{:?}", fit.numbers());
}

/// If all velocities are certain and weigh the same, the errors of a movement are those of its rows.
#[test]
fn errors_of_movements_are_those_of_their_rows() {
    let fit = learnt(PolicyKind::Sinusoidal, ConstraintKind::Free, 8, None);
    assert_eq!(fit.left_out().len(), 8);
    for errors in fit.left_out() {
        let own = fit.left_out_rows().iter().filter(|row| row.index.trajectory == errors.trajectory);
        let [mut seen, mut slope, mut direct, mut sample] = [0.0, 0.0, 0.0, -1.0];
        for row in own {
            seen += row.seen.powi(2);
            slope += (row.seen - row.slope.expect("no stretches")).powi(2);
            direct += (row.seen - row.direct).powi(2);
            assert!(row.index.sample as f64 > sample, "rows in time");
            sample = row.index.sample as f64;
        }
        for (own, of_movement) in [(seen, errors.seen), (slope, errors.slope), (direct, errors.direct)] {
            assert!((own - of_movement).abs() <= 1e-9 * of_movement, "{own} {of_movement}");
        }
    }
    let stored = serde_json::to_string(&fit).expect("JSON");
    let read: AutoFit = serde_json::from_str(&stored).expect("a fit");
    assert!(read.left_out_rows().is_empty());
}
