//! Errors under pushes, with noise and in mixed units, compared with upper bounds: a table of medians and worst cases.

#![allow(clippy::print_stdout, reason = "it prints what it measures")]

use crate::fresh::{DataSet, Disturbed, beyond, judge};
use crate::systems::{ANGLES, CHAIN, HIMMELBLAU, System, UNEVEN_WELLS, WELLS, error};
use demo_gen::beyond::PolicyKind;
use gp::{AutoFit, AutoGp, Family, FrontEnd, PushTest, Rows, SlopeGp};
use motion::{Demonstrations, Policy, Trajectory, scaled};
use nalgebra::{DVector, DVectorView, DVectorViewMut};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const SEEDS: std::ops::RangeInclusive<u64> = 1..=5;
/// Number of rows learnt from.
const ROWS: usize = 600;

fn slope(push_test: PushTest) -> SlopeGp {
    SlopeGp { max_rows: ROWS, hyper_rows: ROWS / 2, push_test, ..SlopeGp::default() }
}

fn fit(rows: &Rows, push_test: PushTest, seed: u64) -> AutoFit {
    let learner = AutoGp { slope: slope(push_test), ..AutoGp::default() };
    learner.fit(rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

fn rows_of(movements: &Demonstrations) -> Rows {
    FrontEnd::of_velocities(movements).rows(movements).unwrap()
}

/// nUPE of a policy learnt under a push and with noise, both as shares of the policy's size.
fn learnt(system: &System, (push, noise): (f64, f64), push_test: PushTest, seed: u64) -> f64 {
    error(system, &fit(&rows_of(&system.movements(push, noise, seed)), push_test, seed), seed)
}

/// Converts a policy in units that are a multiple of the right ones to the right ones.
struct InRightUnits {
    fit: AutoFit,
    factors: DVector<f64>,
}

impl Policy for InRightUnits {
    fn dim(&self) -> usize {
        self.factors.len()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        self.fit.action_into(state.component_mul(&self.factors).as_view(), action.as_view_mut());
        action.component_div_assign(&self.factors);
    }
}

/// nUPE, in the right units, of a policy learnt with units to be found: axis 1 was recorded in a unit too small by `factor`.
fn in_units(system: &System, factor: f64, noise: f64, seed: u64) -> f64 {
    let right = system.movements(0.0, noise, seed);
    let with = |factors: &DVector<f64>| {
        let of = |movement: &Trajectory| {
            let velocities = scaled(movement.velocities().unwrap(), factors);
            Trajectory::new(scaled(movement.states(), factors), movement.time_step())
                .unwrap()
                .with_velocities(velocities)
        };
        let movements = right.trajectories().iter().map(|movement| of(movement).unwrap()).collect();
        rows_of(&Demonstrations::new(movements).unwrap())
    };
    let recorded = DVector::from_fn(system.dim, |axis, _| if axis == 1 { factor } else { 1.0 });
    let gp = SlopeGp { families: vec![Family::Smooth], ..slope(PushTest::AssumeNone) };
    let learnt = gp.learn_scales(&with(&recorded), &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
    let factors = match learnt {
        Some(learnt) => recorded.component_mul(&DVector::from_vec(learnt.factors)),
        None => recorded,
    };
    let fit = fit(&with(&factors), PushTest::AssumeNone, seed);
    error(system, &InRightUnits { fit, factors }, seed)
}

/// The table, which is filled line by line.
struct Table {
    /// Lines that exceed their bounds.
    over: Vec<String>,
}

impl Table {
    fn new() -> Self {
        println!("| nUPE at new states | bound | median | worst | within |\n| --- | --- | --- | --- | --- |");
        Table { over: Vec::new() }
    }

    /// Adds a line with a value for each seed, and an upper bound on their median.
    fn line(&mut self, name: &str, most: f64, of: impl Fn(u64) -> f64) -> Vec<f64> {
        let values: Vec<f64> = SEEDS.map(of).collect();
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let (median, worst) = (sorted[sorted.len() / 2], sorted[sorted.len() - 1]);
        let within = median <= most;
        println!("| {name} | {most} | {median:.2e} | {worst:.2e} | {} |", if within { "yes" } else { "no" });
        if !within {
            self.over.push(name.to_owned());
        }
        values
    }

    /// Adds a line of values as shares of other values, one for each seed.
    fn shares(&mut self, name: &str, most: f64, others: &[f64], of: impl Fn(u64) -> f64) {
        self.line(name, most, |seed| of(seed) / others[(seed - SEEDS.start()) as usize]);
    }
}

#[test]
#[ignore = "a measurement of many minutes; prints a table"]
fn measured() {
    let (none, tried) = (PushTest::AssumeNone, PushTest::Fit);
    let mut table = Table::new();
    table.line("himmelblau, push .03, rows of samples", 0.03, |seed| learnt(&HIMMELBLAU, (0.03, 0.0), none, seed));
    for (name, told) in [("not told", false), ("told", true)] {
        let noisy = Disturbed { noise: 0.05 / 6.0_f64.sqrt(), told, ..Disturbed::default() };
        let of = |seed| {
            let DataSet { rows, fresh } = beyond(PolicyKind::Wells { dim: 6 }, noisy, seed);
            judge(fit(&rows, none, seed).slope(), &fresh).nupe
        };
        table.line(&format!("wells of `demo_gen` 6-D, noise .05 {name}"), 0.004, of);
    }
    for (name, system, clean, noisy) in [("angles 3-D", ANGLES, 5e-3, 0.05), ("wells 6-D", WELLS, 1e-3, 0.04)] {
        for (noise, most) in [(0.0, clean), (0.05, noisy)] {
            let of = |seed| learnt(&system, (0.3, noise), tried, seed);
            table.line(&format!("{name}, push .3, noise {noise}"), most, of);
        }
    }
    for (name, system) in [("himmelblau", HIMMELBLAU), ("angles 3-D", ANGLES), ("wells 6-D", WELLS)] {
        for noise in [0.0, 0.02, 0.05] {
            let of = |test| move |seed| learnt(&system, (0.0, noise), test, seed);
            let samples =
                table.line(&format!("{name}, no push, noise {noise}, rows of samples"), f64::INFINITY, of(none));
            table.shares("the same where stretches are tried, times", 1.3, &samples, of(tried));
        }
    }
    let systems = [("angles 3-D", ANGLES), ("chain 4-D", CHAIN), ("wells 5-D", UNEVEN_WELLS), ("wells 6-D", WELLS)];
    for (name, system) in systems {
        for noise in [0.0, 0.05] {
            let of = |seed| learnt(&system, (0.0, noise), none, seed);
            let known = table.line(&format!("{name}, noise {noise}, units known"), f64::INFINITY, of);
            table.shares("the same, units right but not known, times", 1.1, &known, |seed| {
                in_units(&system, 1.0, noise, seed)
            });
            for factor in [2.0, 5.0, 57.0] {
                let of = |seed| in_units(&system, factor, noise, seed);
                if noise == 0.0 {
                    table.line(&format!("{name}, an axis times {factor}"), 0.01, of);
                } else {
                    table.shares(&format!("an axis times {factor}, times"), 2.0, &known, of);
                }
            }
        }
    }
    assert_eq!(table.over, Vec::<String>::new());
}
