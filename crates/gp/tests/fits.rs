//! Whole fits: invariances, exact results, and refused input.

use crate::drawn::{descent, matrix, rng, rows, vector};
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind as Shown};
use demo_gen::demonstrations;
use gp::{AutoFit, AutoGp, CurlTest, DirectFit, DirectGp, Doubt, Family, GpError, ModelKind, Rows, SlopeFit, SlopeGp};
use motion::{LearntPolicy, Policy, SampleIndex};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn quick() -> SlopeGp {
    SlopeGp { families: vec![Family::Smooth], curl_test: CurlTest::AssumePotential, ..SlopeGp::default() }
}

fn mapped(rows: &Rows, x: impl Fn(&DMatrix<f64>) -> DMatrix<f64>, u: impl Fn(&DMatrix<f64>) -> DMatrix<f64>) -> Rows {
    Rows::new(x(rows.states()), u(rows.velocities()), rows.indices().to_vec()).expect("finite rows")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// A quadratic potential is found exactly from (n+1)(n+2)/2 generic rows and a few more.
    #[test]
    fn quadratic_potentials_are_found(dim in 1_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let root = matrix(dim, dim, rng);
        let (hessian, centre) = (&root * root.transpose() + DMatrix::identity(dim, dim) * 0.1, vector(dim, rng));
        let policy = |x: &DVector<f64>| -(&hessian * (x - &centre));
        let rows = rows(dim, (4, (dim + 1) * (dim + 2) / 2), policy, rng);
        let fit = quick().fit(&rows, rng).expect("a fit");
        let x = vector(dim, rng);
        let error = (fit.action(x.as_view()) - policy(&x)).norm() / policy(&x).norm();
        prop_assert!(error < 1e-3, "{error}");
    }

    /// Rotated, translated and scaled recordings give the rotated, untranslated and scaled policy.
    #[test]
    fn coordinates_do_not_matter(dim in 2_usize..4, seed in any::<u64>(), s in 0.1..10.0_f64, t in 0.1..10.0_f64) {
        let rng = &mut rng(seed);
        let given = rows(dim, (4, 8), descent, rng);
        let turn = matrix(dim, dim, rng).qr().q();
        let shift = vector(dim, rng);
        let moved = mapped(
            &given,
            |x| &turn * x * s + &shift * DMatrix::from_element(1, x.ncols(), 1.0),
            |u| &turn * u * (s / t),
        );
        let (a, b) = (quick().fit(&given, rng).expect("a fit"), quick().fit(&moved, rng).expect("a fit"));
        let x = vector(dim, rng);
        let there: DVector<f64> = &turn * &x * s + &shift;
        let (ours, theirs) = (a.action(x.as_view()), b.action(there.as_view()) * (t / s));
        let turned: DVector<f64> = &turn * &ours;
        let error = (turned - theirs).norm() / ours.norm();
        prop_assert!(error < 1e-4, "{error}");
    }

    /// The order of trajectories does not matter, nor does the generator if all rows are used.
    #[test]
    fn order_does_not_matter(seed in any::<u64>()) {
        let given = rows(2, (4, 8), descent, &mut rng(seed));
        let order: Vec<usize> = (0..32).map(|row| (row + 8) % 32).collect();
        let turned = Rows::new(
            given.states().select_columns(&order),
            given.velocities().select_columns(&order),
            given.indices().to_vec(),
        ).expect("finite rows");
        let fits = [quick().fit(&given, &mut rng(1)), quick().fit(&turned, &mut rng(2))].map(|fit| fit.expect("a fit"));
        let x = vector(2, &mut rng(seed));
        let [a, b] = fits.map(|fit| fit.action(x.as_view()));
        prop_assert!((&a - &b).norm() < 1e-5 * a.norm(), "{a} {b}");
    }

    /// The number of threads does not matter; stored fits are read back to the last bit.
    #[test]
    fn same_bits(seed in any::<u64>()) {
        let given = rows(2, (6, 10), |x| descent(x) + DVector::from_vec(vec![-x[1], x[0]]) * 0.3, &mut rng(seed));
        let learner = AutoGp { slope: SlopeGp { max_rows: 50, hyper_rows: 40, ..SlopeGp::default() }, ..AutoGp::default() };
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let fit = pool.install(|| learner.fit(&given, &mut rng(seed))).expect("a fit");
            serde_json::to_string(&fit).expect("numbers")
        };
        let one = with(1);
        prop_assert_eq!(&one, &with(2));
        prop_assert_eq!(&one, &with(8));
        let both: AutoFit = serde_json::from_str(&one).expect("what was written");
        prop_assert_eq!(&one, &serde_json::to_string(&both).expect("numbers"));
        let slope: SlopeFit = serde_json::from_str(&serde_json::to_string(both.slope()).expect("numbers")).expect("a fit");
        let direct: DirectFit = serde_json::from_str(&serde_json::to_string(both.direct()).expect("numbers")).expect("a fit");
        let rng = &mut rng(seed);
        for _ in 0..50 {
            let x = vector(2, rng);
            prop_assert_eq!(slope.action(x.as_view()), both.slope().action(x.as_view()));
            prop_assert_eq!(direct.action(x.as_view()), both.direct().action(x.as_view()));
            prop_assert_eq!(slope.uncertainty(x.as_view()), both.slope().uncertainty(x.as_view()));
        }
    }
}

#[test]
fn rotation_is_seen_and_a_potential_kept() {
    let swirl = |x: &DVector<f64>| DVector::from_vec(vec![-x[1] - 0.2 * x[0], x[0] - 0.2 * x[1]]);
    let turning = rows(2, (8, 12), swirl, &mut rng(3));
    let fit = SlopeGp::default().fit(&turning, &mut rng(4)).expect("a fit");
    assert_eq!(fit.report().model, ModelKind::Helmholtz);
    assert!(fit.potential().is_none() && fit.report().rotational_share > 0.5);
    let still = rows(2, (8, 12), descent, &mut rng(3));
    let fit = SlopeGp::default().fit(&still, &mut rng(4)).expect("a fit");
    assert_eq!(fit.report().model, ModelKind::Potential);
    assert_eq!(fit.report().rotational_share, 0.0);
    assert!(fit.report().curl_t.is_some_and(|t| t < 2.5));
}

#[test]
fn an_axis_that_never_moves_is_named() {
    let blocked = |x: &DVector<f64>| DVector::from_vec(vec![descent(x)[0], descent(x)[1], 0.0]);
    let given = rows(3, (6, 12), blocked, &mut rng(5));
    let flat = mapped(&given, Clone::clone, |u| {
        let mut u = u.clone();
        u.row_mut(2).fill(0.0);
        u
    });
    let fit = SlopeGp::default().fit(&flat, &mut rng(6)).expect("a fit");
    assert!(fit.report().least_seen.share < 1e-9 && fit.report().least_seen.direction[2].abs() > 0.99);
    let doubts = fit.report().doubts();
    assert!(doubts.iter().any(|doubt| matches!(doubt, Doubt::NeverMoved { .. })), "{doubts:?}");
}

#[test]
fn error_bars_are_wider_away_from_the_rows() {
    let given = rows(2, (5, 12), descent, &mut rng(7));
    let velocities: Vec<_> = given.states().column_iter().map(|x| descent(&x.into_owned())).collect();
    let free = mapped(&given, Clone::clone, |_| DMatrix::from_columns(&velocities));
    let fit = DirectGp::default().fit(&free, &mut rng(8)).expect("a fit");
    let (near, far) = (DVector::zeros(2), DVector::from_element(2, 9.0));
    assert!(fit.support(near.as_view()) > 0.99);
    let sd = |x: &DVector<f64>| {
        let mut sd = DVector::zeros(2);
        assert!(fit.action_sd_into(x.as_view(), sd.as_view_mut()));
        sd[0]
    };
    assert!(sd(&far) > 10.0 * sd(&near));
}

#[test]
fn bad_input_is_refused() {
    let given = rows(2, (4, 8), descent, &mut rng(9));
    let fit = |rows: &Rows| SlopeGp::default().fit(rows, &mut rng(0)).map(|_| ());
    let direct = |rows: &Rows| DirectGp::default().fit(rows, &mut rng(0)).map(|_| ());
    let still = mapped(&given, Clone::clone, |u| u * 0.0);
    let one_state = mapped(&given, |x| DMatrix::from_element(2, x.ncols(), 0.7), Clone::clone);
    let two_move = mapped(&given, Clone::clone, |u| {
        let mut u = u.clone();
        u.columns_mut(16, 16).fill(0.0);
        u
    });
    let few = given.clone().without(|_, sample| sample > 0).without(|trajectory, _| trajectory == 3);
    for (rows, error) in [
        (still, GpError::NoMotion),
        (one_state, GpError::OneState),
        (two_move, GpError::TooFewTrajectories { found: 2 }),
        (few, GpError::TooFewRows { found: 3, needed: 4 }),
        (mapped(&given, Clone::clone, |u| u * 1e-200), GpError::Overflow { what: "speed" }),
        (mapped(&given, |x| x * 1e-200, Clone::clone), GpError::Overflow { what: "distance" }),
    ] {
        assert_eq!(fit(&rows), Err(error.clone()));
        assert_eq!(direct(&rows), Err(error));
    }
    let rows = |u: f64| {
        Rows::new(DMatrix::zeros(1, 1), DMatrix::from_element(1, 1, u), vec![SampleIndex { trajectory: 0, sample: 0 }])
    };
    assert_eq!(rows(1e200).map(|_| ()), Err(GpError::Overflow { what: "speed" }));
    assert!(matches!(rows(f64::NAN), Err(GpError::Value { what: "velocity", row: 0, .. })));
    let no_family = SlopeGp { families: Vec::new(), ..SlopeGp::default() };
    assert!(matches!(no_family.fit(&given, &mut rng(0)), Err(GpError::Parameter { name: "families", .. })));
}

#[test]
fn one_dimension_has_no_rotation_and_two_movements_are_cut() {
    let line = rows(1, (4, 8), descent, &mut rng(10));
    let fit = SlopeGp::default().fit(&line, &mut rng(0)).expect("a fit");
    assert_eq!((fit.report().curl_t, fit.report().model), (None, ModelKind::Potential));
    let two = rows(2, (2, 16), descent, &mut rng(11));
    let both = AutoGp::default().fit(&two, &mut rng(0)).expect("a fit");
    assert_eq!(both.reading(), gp::Hypothesis::TooFew);
    assert_eq!(both.action(two.states().column(0)), both.direct().action(two.states().column(0)));
}

/// If the first family predicts exactly, no other is tried; otherwise all are.
#[test]
fn an_exact_family_ends_the_search() {
    let learner = SlopeGp { curl_test: CurlTest::AssumePotential, ..SlopeGp::default() };
    let families = |policy: fn(&DVector<f64>) -> DVector<f64>| {
        let given = rows(2, (8, 12), policy, &mut rng(3));
        let report = learner.fit(&given, &mut rng(4)).expect("a fit").report().clone();
        (report.families.len(), report.family, 1.0 - report.r_squared)
    };
    let (tried, family, left) = families(|x| -x);
    assert_eq!((tried, family), (1, Family::Smooth));
    assert!(left < 1e-8, "{left}");
    let (tried, _, left) = families(|x| x.map(f64::signum) * -1.0);
    assert_eq!(tried, 3);
    assert!(left > 1e-8, "{left}");
}

/// The fit of ten unconstrained movements with 200 rows, whose velocities are the policy, and its nUPE.
fn freely(policy: Shown, seed: u64) -> (SlopeFit, f64) {
    let rng = &mut rng(seed);
    let system =
        BeyondSystem { policy, n_trajectories: 10, constraint: ConstraintKind::Free, ..BeyondSystem::default() };
    let shown = demonstrations(&system.record(rng).expect("movements")).expect("demonstrations");
    let rows = gp::FrontEnd::Velocities.rows(&shown).expect("rows");
    let fit = SlopeGp { max_rows: 200, ..SlopeGp::default() }.fit(&rows, rng).expect("a fit");
    let columns: Vec<_> = rows.states().column_iter().map(|state| fit.action(state)).collect();
    let error = metrics::nupe(rows.velocities(), &DMatrix::from_columns(&columns)).expect("a score");
    (fit, error)
}

/// Along a corridor everything is predicted, across it nothing is tested. The learnt policy is little more than the
/// observed velocities, and the report is not much too optimistic.
#[test]
fn corridor_fits_are_accurate_and_report_their_error() {
    let fits: Vec<_> = (0..6).map(|seed| freely(Shown::Handwriting, seed)).collect();
    let right = fits.iter().filter(|(_, error)| *error <= 0.3).count();
    let warned = fits.iter().filter(|(fit, error)| fit.report().expected_nupe >= 0.5 * error).count();
    assert!(right >= 5 && warned >= 5, "{right} and {warned} of 6");
}

/// If there is no potential, the best family of potentials is uninformative about the family of the rotation.
#[test]
fn a_free_limit_cycle_is_learnt_with_rotation() {
    for seed in 0..6 {
        let (fit, error) = freely(Shown::LimitCycle, seed);
        assert!(fit.report().model == ModelKind::Helmholtz && error <= 0.01, "seed {seed}: {error}");
    }
}
