//! More data never increase the error, and the expected error matches the actual one.

#![allow(clippy::print_stdout, reason = "the slow test prints what it measures")]

use crate::drawn;
use crate::drawn::many::{Gradient, new_movements, set, sinusoid, wells};
use crate::drawn::nupe;
use gp::{AutoGp, SlopeFit, SlopeGp};
use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};

/// Number of groups of twenty new movements on which a policy is evaluated.
const GROUPS: usize = 20;

/// Performance of a fit on new movements: typical nUPE of twenty (the geometric mean over groups, because one movement in hundreds may
/// have nearly all of the error), the expected error divided by it, and z², the mean square of errors divided by error bars.
struct Judged {
    nupe: f64,
    expected: f64,
    z_squared: f64,
}

fn judged(fit: &SlopeFit, groups: &[(DMatrix<f64>, DMatrix<f64>)]) -> Judged {
    let logarithms: f64 = groups.iter().map(|group| nupe(fit.policy(), group).ln()).sum();
    let nupe = (logarithms / groups.len() as f64).exp();
    let (mut sum, mut count) = (0.0, 0.0);
    let mut bars = DVector::zeros(groups[0].0.nrows());
    for (states, truth) in groups {
        for at in (0..states.ncols()).step_by(67) {
            assert!(fit.action_sd_into(states.column(at), bars.as_view_mut()));
            let off = fit.action(states.column(at)) - truth.column(at);
            sum += off.component_div(&bars).norm_squared();
            count += bars.len() as f64;
        }
    }
    Judged { nupe, expected: fit.report().expected_nupe / nupe, z_squared: sum / count }
}

/// Movements of 500 samples, and five and fifty times as many: a table of medians over five data sets, or over `SETS`, and the least and
/// greatest expected errors. Learner and settings are the program's, without the search for pushing constraints.
#[test]
#[ignore = "ten minutes of a release build; prints"]
fn more_movements_are_never_worse() {
    let systems: [(&str, Gradient, usize); 3] = [("sinusoid", sinusoid, 2), ("wells", wells, 3), ("wells", wells, 6)];
    let sets = std::env::var("SETS").map_or(5_u64, |sets| sets.parse().expect("a number of data sets"));
    let (mut worse, mut all) = (Vec::new(), [Vec::new(), Vec::new()]);
    println!(
        "| | noise | movements | nUPE | expected over true | within ten times | z² at new states | left out: 1 − R², z² |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, gradient, dim) in systems {
        for noise in [0.0, 0.05, 0.2] {
            let (mut before, percent) = (f64::INFINITY, 100.0 * noise);
            for movements in [40, 200, 2000] {
                let fit = |seed: u64| {
                    let set = set(gradient, dim, (movements, 500), noise, 11 + seed);
                    let slope = SlopeGp { max_rows: 400, hyper_rows: 200, inducing_rows: 500, ..SlopeGp::default() };
                    let learner = AutoGp { slope, ..AutoGp::default() };
                    let fit = learner.fit(&set.rows, &mut drawn::rng(3)).expect("a fit");
                    let report = fit.slope().report();
                    let judged = judged(fit.slope(), &new_movements(gradient, dim, GROUPS, 900 + seed));
                    (judged, 1.0 - report.r_squared, report.z_squared)
                };
                let fits: Vec<_> = (0..sets).map(fit).collect();
                let median = |of: &dyn Fn(&(Judged, f64, f64)) -> f64| {
                    motion::upper_median(fits.iter().map(of).collect()).expect("fits")
                };
                let range = |of: &dyn Fn(&Judged) -> f64| {
                    let each = || fits.iter().map(|(judged, ..)| of(judged));
                    format!("{:.2} … {:.2}", each().fold(f64::INFINITY, f64::min), each().fold(0.0, f64::max))
                };
                let (error, left, z) = (median(&|fit| fit.0.nupe), median(&|fit| fit.1), median(&|fit| fit.2));
                let (expected, bars) = (range(&|judged| judged.expected), range(&|judged| judged.z_squared));
                let within = fits.iter().filter(|fit| within_ten_times(&fit.0)).count();
                println!(
                    "| {name}, {dim}-D | {percent} % | {movements} | {error:.1e} | {expected} | {within} of {sets} | {bars} | {left:.1e}, {z:.2e} |"
                );
                if error > 1.1 * before {
                    worse.push(format!("{name}, {dim}-D, {percent} %: {before:.1e}, {error:.1e} of {movements}"));
                }
                before = error;
                all[usize::from(noise > 0.0)].extend(fits.into_iter().map(|(judged, ..)| judged));
            }
        }
    }
    assert!(worse.is_empty(), "{worse:#?}");
    let near = all.each_ref().map(|fits| fits.iter().filter(|fit| within_ten_times(fit)).count());
    let share = (near[0] + near[1]) as f64 / (all[0].len() + all[1].len()) as f64;
    println!("within ten times: {near:?} of {} clean and {} noisy", all[0].len(), all[1].len());
    assert!(share >= 0.9, "{share}");
    // For noisy velocities, the expected error is never far too small. For clean ones it is once, in a corner of the space that none of
    // forty movements visited.
    let least = all[1].iter().map(|fit| fit.expected).fold(f64::INFINITY, f64::min);
    let widest = all.iter().flatten().map(|fit| fit.z_squared).fold(0.0, f64::max);
    assert!(least >= 0.1 && widest <= 30.0, "{least} {widest}");
}

fn within_ten_times(judged: &Judged) -> bool {
    (0.1..=10.0).contains(&judged.expected)
}
