//! Learnt policies and their trust reports, tested on new movements.

#![allow(clippy::print_stdout, reason = "the slow tests print what they measure")]

use crate::drawn;
use crate::fresh::{DataSet, Disturbed, Judged, SYSTEMS, System, beyond, data_set, judge};
use demo_gen::beyond::PolicyKind;
use gp::{AutoGp, CurlTest, Family, FrontEnd, Rows, SlopeFit, SlopeGp};
use motion::{Demonstrations, Policy as _, Trajectory};

const CLEAN: Disturbed = Disturbed { press: 0.0, noise: 0.0, told: false };
/// A push of 3 % of the policy's size.
const PRESSED: Disturbed = Disturbed { press: 0.03, ..CLEAN };
const NOISY: Disturbed = Disturbed { noise: 0.05, ..CLEAN };
const NOISE_TOLD: Disturbed = Disturbed { told: true, ..NOISY };

fn system(name: &str) -> &'static System {
    SYSTEMS.iter().find(|system| system.name == name).expect("a system of that name")
}

fn quick() -> SlopeGp {
    SlopeGp {
        families: vec![Family::Smooth],
        max_rows: 200,
        hyper_rows: 100,
        curl_test: CurlTest::AssumePotential,
        ..SlopeGp::default()
    }
}

/// The weights D of a fit.
fn noise_weights(fit: &SlopeFit) -> Vec<f64> {
    let stored = serde_json::to_value(fit).expect("numbers");
    serde_json::from_value(stored["slope_gp"]["noise_weights"].clone()).expect("numbers")
}

/// Slow rows, in which the push dominates, get less weight; without a push all weights are equal.
#[test]
fn slow_rows_weigh_less_where_something_presses() {
    let of = |disturbed| {
        let DataSet { rows, fresh } = data_set(system("saddle"), disturbed, 1);
        let fit = quick().fit(&rows, &mut drawn::rng(1)).expect("a fit");
        (noise_weights(&fit), judge(&fit, &fresh).nupe)
    };
    let (weights, error) = of(CLEAN);
    assert!(weights.iter().all(|&weight| weight == 1.0) && error < 1e-4, "{error}");
    let (weights, error) = of(PRESSED);
    assert!(weights.iter().any(|&weight| weight > 30.0) && error < 0.03, "{error}");
}

/// With a given variance, the front end makes the same rows as for certain velocities, plus that variance.
#[test]
fn a_variance_may_be_given() {
    let DataSet { rows, .. } = data_set(system("saddle"), NOISE_TOLD, 2);
    let movement = |k: usize| {
        let columns = |of: &nalgebra::DMatrix<f64>| of.columns(40 * k, 40).into_owned();
        Trajectory::new(columns(rows.states()), 0.1)?.with_velocities(columns(rows.velocities()))
    };
    let shown = Demonstrations::new((0..40).map(|k| movement(k).expect("a movement")).collect()).expect("movements");
    let variance = rows.variances().expect("a variance")[0];
    let noisy = FrontEnd::NoisyVelocities { variance };
    assert_eq!(noisy.rows(&shown).expect("rows"), rows);
    let certain = Rows::new(rows.states().clone(), rows.velocities().clone(), rows.indices().to_vec()).expect("rows");
    assert_eq!(FrontEnd::Velocities.rows(&shown).expect("rows"), certain);
    for variance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(FrontEnd::NoisyVelocities { variance }.rows(&shown).is_err(), "{variance}");
    }
    assert_eq!(serde_json::to_value(noisy).expect("numbers")["NoisyVelocities"]["variance"], variance);
    let fits = [&certain, &rows].map(|rows| quick().fit(rows, &mut drawn::rng(3)).expect("a fit"));
    let x = rows.states().column(5);
    assert_ne!(fits[0].action(x), fits[1].action(x));
}

/// Error bars and the expected error use the same factor.
#[test]
fn bars_and_expected_error_have_one_factor() {
    let DataSet { rows, .. } = data_set(system("quartic3"), CLEAN, 1);
    let learner = AutoGp { slope: quick(), direct_families: vec![Family::Smooth], ..AutoGp::default() };
    let both = learner.fit(&rows, &mut drawn::rng(1)).expect("a fit");
    let alone = quick().fit(&rows, &mut drawn::rng(1)).expect("a fit");
    let (fit, report) = (both.slope(), both.slope().report());
    assert_eq!(both.reading(), gp::Hypothesis::Constrained);
    // The directions alone show that constraints varied, as the reading does.
    assert!(report.variance_factor() < 1.0 && report.variance_factor() == alone.report().variance_factor());
    assert_eq!(report.expected_nupe, alone.report().expected_nupe);
    let x = rows.states().column(5);
    let mut bars = nalgebra::DVector::zeros(3);
    assert!(motion::LearntPolicy::action_sd_into(fit, x, bars.as_view_mut()));
    let expected = (fit.uncertainty(x)[(0, 0)] * report.variance_factor()).sqrt();
    assert!((bars[0] - expected).abs() <= 1e-12 * expected);
}

/// Both Gaussian processes with 500 rows.
fn learner() -> AutoGp {
    AutoGp { slope: SlopeGp { max_rows: 500, hyper_rows: 250, ..SlopeGp::default() }, ..AutoGp::default() }
}

/// Errors, sorted.
fn errors(set: impl Fn(u64) -> DataSet, gp: &SlopeGp, seeds: std::ops::RangeInclusive<u64>) -> Vec<f64> {
    let error = |seed| {
        let DataSet { rows, fresh } = set(seed);
        judge(&gp.fit(&rows, &mut drawn::rng(seed)).expect("a fit"), &fresh).nupe
    };
    let mut errors: Vec<f64> = seeds.map(error).collect();
    errors.sort_by(f64::total_cmp);
    println!("{errors:.4?}");
    errors
}

#[test]
#[ignore = "ten seconds of a release build"]
fn errors_stay_small_under_a_push_of_three_per_cent() {
    let errors = errors(|seed| data_set(system("himmelblau"), PRESSED, seed), &learner().slope, 1..=8);
    assert!(errors[6] <= 0.03 && errors[7] <= 0.06, "{errors:?}");
}

/// Noise of five per cent of the root mean square of a component, unknown to the learner.
#[test]
#[ignore = "ten seconds of a release build"]
fn noise_in_six_dimensions() {
    let noisy = Disturbed { noise: 0.05 / 6.0_f64.sqrt(), ..CLEAN };
    let gp = SlopeGp { max_rows: 600, hyper_rows: 300, ..SlopeGp::default() };
    let errors = errors(|seed| beyond(PolicyKind::Wells { dim: 6 }, noisy, seed), &gp, 1..=6);
    assert!(errors[4] <= 0.004 && errors[5] <= 0.006, "{errors:?}");
}

/// Rounded planes in six dimensions: more rows for the marginal likelihood do not increase the error.
#[test]
#[ignore = "ten seconds of a release build"]
fn more_hyper_rows_are_not_worse() {
    let of = |hyper_rows| {
        let gp = SlopeGp { max_rows: 700, hyper_rows, ..SlopeGp::default() };
        errors(|seed| beyond(PolicyKind::Planes { dim: 6, edge: 0.1 }, CLEAN, seed), &gp, 1..=5)
    };
    let [few, many] = [of(200), of(400)].map(|errors| errors.iter().sum::<f64>() / 5.0);
    assert!(many <= 1.05 * few && many <= 0.2, "{few} {many}");
}

/// The expected error is within a factor of ten of the true one in nine of ten fits with errors of .001, and error bars
/// have the right coverage.
#[test]
#[ignore = "two minutes of a release build"]
fn new_movements_are_as_expected() {
    for (name, disturbed) in [("clean", CLEAN), ("pressed", PRESSED), ("noisy", NOISY), ("noise told", NOISE_TOLD)] {
        let (mut ratios, mut covered) = (Vec::new(), [0.0; 2]);
        let sets = || SYSTEMS.iter().flat_map(|system| [(system, 1), (system, 2)]);
        for (system, seed) in sets() {
            let DataSet { rows, fresh } = data_set(system, disturbed, seed);
            let both = learner().fit(&rows, &mut drawn::rng(seed)).expect("a fit");
            let Judged { nupe, covered: each } = judge(both.slope(), &fresh);
            let expected = both.slope().report().expected_nupe;
            println!("{} {seed}: {nupe:.2e}, expected {expected:.2e}, covered {each:.2?}", system.name);
            for (sum, share) in covered.iter_mut().zip(each) {
                *sum += share / sets().count() as f64;
            }
            if nupe >= 1e-3 {
                ratios.push(expected / nupe);
            }
        }
        let near = ratios.iter().filter(|ratio| (0.1..=10.0).contains(*ratio)).count();
        println!("{name}: {near} of {} within 10, covered {covered:.2?}", ratios.len());
        assert!(10 * near >= 9 * ratios.len(), "{name}: {ratios:.2?}");
        assert!((0.65..=0.9).contains(&covered[0]) && (0.9..=0.99).contains(&covered[1]), "{name}: {covered:?}");
    }
}
