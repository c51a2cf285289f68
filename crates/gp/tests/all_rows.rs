//! Models of all rows through inducing rows (S34)–(S37): the gain from more data.

use crate::drawn;
use crate::drawn::many::{Set, set, sinusoid, wells};
use crate::drawn::nupe;
use gp::{AutoGp, SlopeFit, SlopeGp};
use motion::{LearntPolicy, Policy as _};
use nalgebra::{DMatrix, DVector};

fn gp(inducing_rows: usize) -> SlopeGp {
    SlopeGp { max_rows: 200, hyper_rows: 150, inducing_rows, ..SlopeGp::default() }
}

/// Without noise a hundred rows contain nearly all information. With noise, more rows improve the model, and all rows improve it
/// most.
#[test]
fn more_rows_are_never_worse() {
    let learnt = |samples: usize, inducing: usize| {
        let errors = (0..3).map(|seed| {
            let set = set(sinusoid, 2, (40, samples), 0.1, 20 + seed);
            nupe(gp(inducing).fit(&set.rows, &mut drawn::rng(3)).unwrap().policy(), &set.fresh)
        });
        errors.sum::<f64>() / 3.0
    };
    let (few, many, all) = (learnt(20, 0), learnt(320, 0), learnt(320, 150));
    assert!(many < 0.7 * few, "{many} {few}");
    assert!(all < 1.1 * many, "{all} {many}");
}

/// A data set with noise and so many movements that all rows are used through inducing rows.
fn noisy() -> Set {
    set(wells, 3, (200, 60), 0.05, 5)
}

/// The report states what a policy was learnt from; if nothing is thinned, inducing rows change nothing.
#[test]
fn inducing_rows_are_reported_and_only_used_when_thinning() {
    let many = noisy();
    let [fit, thinned] = [300, 0].map(|inducing| gp(inducing).fit(&many.rows, &mut drawn::rng(1)).unwrap());
    let found = |fit: &SlopeFit| fit.report().rows + fit.report().rows_dropped.thinned;
    assert_eq!((fit.report().inducing, fit.report().rows_dropped.thinned), (Some(300), 0));
    assert_eq!((thinned.report().rows, thinned.report().inducing), (200, None));
    assert!(found(&fit) > 1700 && found(&fit) == found(&thinned));
    assert!(nupe(fit.policy(), &many.fresh) < nupe(thinned.policy(), &many.fresh));
    let few = set(wells, 3, (20, 10), 0.0, 5);
    let [with, without] = [300, 0].map(|inducing| gp(inducing).fit(&few.rows, &mut drawn::rng(1)).unwrap());
    assert_eq!(with.report(), without.report());
    assert_eq!(with.action(few.rows.states().column(3)), without.action(few.rows.states().column(3)));
}

/// For a few movements without noise, more exact rows predict better than all rows through inducing rows; a few noisy rows are all
/// exact.
#[test]
fn exact_rows_replace_inducing_rows_that_predict_worse() {
    let clean = set(wells, 3, (30, 60), 0.0, 5);
    let [fit, thinned] = [300, 0].map(|inducing| gp(inducing).fit(&clean.rows, &mut drawn::rng(1)).unwrap());
    let report = fit.report();
    assert!(report.inducing.is_none() && report.rows >= 1500, "{} {:?}", report.rows, report.inducing);
    assert!(nupe(fit.policy(), &clean.fresh) < 0.5 * nupe(thinned.policy(), &clean.fresh));
    let noisy = set(wells, 3, (40, 60), 0.05, 5);
    let [fit, thinned] = [300, 0].map(|inducing| gp(inducing).fit(&noisy.rows, &mut drawn::rng(1)).unwrap());
    assert_eq!((fit.report().inducing, fit.report().rows_dropped.thinned), (None, 0));
    assert!(nupe(fit.policy(), &noisy.fresh) < nupe(thinned.policy(), &noisy.fresh));
}

/// A stored model is read back with the same policy and uncertainty to the last bit. A triangle of another size is refused.
#[test]
fn a_model_of_inducing_rows_is_stored() {
    let set = noisy();
    let fit = AutoGp { slope: gp(300), ..AutoGp::default() }.fit(&set.rows, &mut drawn::rng(1)).unwrap();
    assert!(fit.slope().report().inducing.is_some());
    let text = serde_json::to_string(&fit).unwrap();
    let read: gp::AutoFit = serde_json::from_str(&text).unwrap();
    let x = set.fresh.0.column(7);
    assert_eq!(fit.action(x), read.action(x));
    assert_eq!(fit.slope().uncertainty(x), read.slope().uncertainty(x));
    assert_eq!(fit.direct().support(x), read.direct().support(x));
    let mut record = serde_json::to_value(fit.slope()).unwrap();
    let triangle = record["slope_gp"]["shrinkage"].as_array_mut().expect("a triangle");
    triangle.pop();
    let refused = serde_json::from_value::<SlopeFit>(record).unwrap_err().to_string();
    assert!(refused.contains("triangle"), "{refused}");
}

/// For most states a subset of the rows decides whether all rows support them, with the same answer, with and without noise and
/// inducing rows.
#[test]
fn support_decisions_match_the_variances() {
    let (mut induced, mut answers) = (0, [0; 2]);
    for (most, noise, movements) in [(300, 0.0, 30), (300, 0.05, 200), (0, 0.0, 30), (0, 0.2, 30)] {
        let set = set(wells, 3, (movements, 60), noise, 8);
        let fit = AutoGp { slope: gp(most), ..AutoGp::default() }.fit(&set.rows, &mut drawn::rng(1)).unwrap();
        induced += usize::from(fit.slope().report().inducing.is_some());
        let near = &set.fresh.0;
        let states = DMatrix::from_fn(3, 3 * near.ncols(), |k, at| near[(k, at / 3)] * [1.0, 2.0, 5.0][at % 3]);
        for policy in [fit.slope() as &dyn LearntPolicy, fit.direct()] {
            let support = policy.certainty(states.as_view()).support;
            for least in [0.2, 0.5, 0.8] {
                let expected: Vec<bool> = support.iter().map(|support| *support >= least).collect();
                assert_eq!(policy.supported(states.as_view(), least), expected, "{most} {noise} {least}");
                for supported in expected {
                    answers[usize::from(supported)] += 1;
                }
            }
        }
    }
    assert!((1..=2).contains(&induced), "{induced} of four have inducing rows");
    assert!(answers.iter().all(|&count| count > 1000), "{answers:?}");
}

/// Uncertainty is small near the movements, grows to the prior's away from them, and is never negative.
#[test]
fn uncertainty_of_inducing_rows_grows_away_from_them() {
    let set = noisy();
    let fit = gp(300).fit(&set.rows, &mut drawn::rng(1)).unwrap();
    assert_eq!(fit.report().inducing, Some(300));
    let trace = |x: &DVector<f64>| fit.uncertainty(x.as_view()).trace();
    let here = set.rows.states().column(40).into_owned();
    let traces: Vec<f64> = [1.0, 2.0, 4.0, 8.0].iter().map(|by| trace(&(&here * *by))).collect();
    assert!(traces.is_sorted() && traces[0] >= 0.0 && traces[0] < 0.1 * traces[3], "{traces:?}");
}
