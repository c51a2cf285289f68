//! Movements towards goals that differ: the goal is a context, and what is learnt holds at goals that were not shown.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.

mod goals;

use gp::{AutoFit, AutoGp, FrontEnd, Rows, SlopeGp};
use goals::{Attraction, Goals};
use motion::{Demonstrations, Policy as _, Trajectory};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn learner() -> AutoGp {
    AutoGp { front_end: FrontEnd::Velocities, slope: SlopeGp { max_rows: 400, hyper_rows: 200, ..SlopeGp::default() }, ..AutoGp::default() }
}

/// Rows with their goals as context, each times its factor, and the factors.
fn rows(demonstrations: &Demonstrations) -> (Rows, DVector<f64>) {
    let rows = FrontEnd::Velocities.rows(demonstrations).unwrap();
    let factors = learner().slope.context_factors(&rows, &mut rng(1)).unwrap();
    let scaled = |of: &Trajectory| of.clone().with_context(of.context().component_mul(&factors)).unwrap();
    let scaled = Demonstrations::new(demonstrations.trajectories().iter().map(scaled).collect()).unwrap();
    (FrontEnd::Velocities.rows(&scaled).unwrap(), factors)
}

/// nUPE at states of movements towards goals that were not shown.
fn error(fit: &AutoFit, goals: &Goals, factors: &DVector<f64>, seed: u64) -> f64 {
    let fresh = goals.movements(20, 1000 + seed);
    let (mut learnt, mut truth) = (Vec::new(), Vec::new());
    for movement in fresh.trajectories() {
        for x in movement.states().column_iter().step_by(5) {
            let x = x.into_owned();
            let context = movement.context().component_mul(factors);
            let seen = fit.dim() > x.len();
            let state = DVector::from_iterator(fit.dim(), x.iter().chain(context.iter().filter(|_| seen)).copied());
            learnt.push(fit.action(state.as_view()).rows(0, x.len()).into_owned());
            truth.push(goals.policy(&x, movement.context()));
        }
    }
    metrics::nupe(&DMatrix::from_columns(&truth), &DMatrix::from_columns(&learnt)).unwrap()
}

#[test]
#[ignore = "measures"]
fn measure() {
    for dim in [2, 3] {
        for attraction in [Attraction::Quadratic, Attraction::Well] {
            for count in [20, 40] {
                let goals = Goals { dim, attraction };
                for seed in 1..=3 {
                    let demonstrations = goals.movements(count, seed);
                    let (rows, factors) = rows(&demonstrations);
                    let fit = learner().fit(&rows, &mut rng(seed)).unwrap();
                    let report = fit.slope().report();
                    eprintln!("{dim}-D {attraction:?} {count} goals: error {:.1e} factors {:.2} {:?} family {:?} {:?} R2 {:.1e} expected {:.1e} coverage {:.2} {:?}", error(&fit, &goals, &factors, seed), factors[0], fit.reading(), report.family, report.model, 1.0 - report.r_squared, fit.expected_nupe(), fit.numbers().least_seen.share * dim as f64, fit.takes_slope());
                }
            }
        }
    }
}
