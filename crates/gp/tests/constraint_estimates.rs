//! Constraints that are found once the policy is known.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.
#![allow(clippy::print_stdout, reason = "the slow test prints what it measures")]

mod systems;

use gp::{Acting, AutoFit, AutoGp, ConstraintEstimates, DirectGp, FrontEnd, PushTest, SlopeGp, StretchEstimate, TaskSpace};
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use systems::{ANGLES, HIMMELBLAU, Switched, System, WELLS};

/// How many true stretches there are, and how many of them were found.
#[derive(Debug, Default)]
struct Found {
    all: usize,
    /// Of the right rank, over most of the stretch.
    covered: usize,
    /// With all normals within so many degrees.
    within: [usize; 3],
    /// Switches, and those found within two samples.
    switches: (usize, usize),
    /// Angle errors over expected ones, squared: mean about 1.
    angles: Vec<f64>,
    expected: Vec<f64>,
    sure: usize,
    sure_within: [usize; 3],
    free: std::collections::BTreeMap<String, usize>,
    ranks: std::collections::BTreeMap<String, usize>,
}

const DEGREES: [f64; 3] = [1.0, 5.0, 15.0];

/// The largest angle between rows found and the span of true ones, in degrees.
fn off(found: &StretchEstimate, basis: &DMatrix<f64>) -> f64 {
    let outside = found.matrix.transpose() - basis * (basis.tr_mul(&found.matrix.transpose()));
    outside.singular_values().max().min(1.0).asin().to_degrees()
}

fn learnt(system: &System, (push, noise): (f64, f64), seed: u64) -> (ConstraintEstimates, Vec<Switched>, AutoFit) {
    let (movements, truth) = system.with_truth(push, noise, seed);
    let rows = FrontEnd::Velocities.rows(&movements).unwrap();
    let learner = AutoGp {
        slope: SlopeGp { max_rows: 400, hyper_rows: 200, push_test: PushTest::Fit, ..SlopeGp::default() },
        direct: DirectGp { max_rows: 400, hyper_rows: 200, ..DirectGp::default() },
        ..AutoGp::default()
    };
    let fit = learner.fit(&rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
    (ConstraintEstimates::of(&rows, fit.slope(), &[TaskSpace::recorded()]).unwrap(), truth, fit)
}

fn count(estimates: &ConstraintEstimates, truth: &[Switched], samples: usize, found: &mut Found) {
    for (trajectory, of) in truth.iter().enumerate() {
        let own: Vec<&StretchEstimate> =
            estimates.stretches.iter().filter(|stretch| stretch.trajectory == trajectory).collect();
        found.switches.0 += 1;
        found.switches.1 += usize::from(own.iter().any(|stretch| stretch.samples.0.abs_diff(of.switch) <= 2));
        for (basis, (first, end)) in of.bases.iter().zip([(0, of.switch), (of.switch, samples)]) {
            found.all += 1;
            let overlap = |stretch: &StretchEstimate| {
                (stretch.samples.1 + 1).min(end).saturating_sub(stretch.samples.0.max(first))
            };
            let best = own.iter().max_by_key(|stretch| overlap(stretch));
            let Some(best) = best.filter(|best| best.acting == Acting::Constraint && 2 * overlap(best) > end - first)
            else {
                *found.ranks.entry(format!("{:?}", best.map(|b| b.acting))).or_default() += 1;
                continue;
            };
            *found.ranks.entry(format!("{}", best.matrix.nrows())).or_default() += 1;
            if best.matrix.nrows() > basis.ncols() {
                continue;
            }
            found.covered += 1;
            let off = off(best, basis);
            for (within, most) in found.within.iter_mut().zip(DEGREES) {
                *within += usize::from(off <= most);
            }
            if best.angle.to_degrees() <= 2.5 {
                found.sure += 1;
                for (within, most) in found.sure_within.iter_mut().zip(DEGREES) {
                    *within += usize::from(off <= most);
                }
            }
            found.angles.push(off);
            found.expected.push(best.angle.to_degrees());
        }
    }
}

/// Prints what is found of what there is.
#[test]
#[ignore = "a measurement of minutes; prints"]
fn measured() {
    for (name, system) in [("2-D", HIMMELBLAU), ("3-D", ANGLES), ("6-D", WELLS)].into_iter().skip(std::env::var("SKIP").map_or(0, |skip| skip.parse().unwrap())) {
        for (push, noise) in [(0.0, 0.0), (0.3, 0.0), (0.0, 0.05), (0.3, 0.05)] {
            let mut found = Found::default();
            for seed in 1..=std::env::var("SEEDS").map_or(5, |seeds| seeds.parse().unwrap()) {
                let (estimates, truth, fit) = learnt(&system, (push, noise), seed);
                count(&estimates, &truth, 40, &mut found);
                let free = FrontEnd::Velocities.rows(&system.free().movements(0.0, noise, 500 + seed)).unwrap();
                let of_free = ConstraintEstimates::of(&free, fit.slope(), &[TaskSpace::recorded()]).unwrap();
                for stretch in &of_free.stretches {
                    if std::env::var("SHOW").is_ok() && stretch.acting == Acting::Constraint {
                        let at = |sample| stretch.trajectory * 40 + sample;
                        let (a, b) = (at(stretch.samples.0), at(stretch.samples.1));
                        let (ua, ub) = (free.velocities().column(a), free.velocities().column(b));
                        let p = motion::Policy::action(fit.slope(), free.states().column(a));
                        let pb = motion::Policy::action(fit.slope(), free.states().column(b));
                        println!("{:?} rank {} angle {:.2} evidence {:.1} |u| {:.1e} {:.1e} d {:.1e} {:.1e} b {:.1e}", stretch.samples, stretch.matrix.nrows(), stretch.angle.to_degrees(), stretch.evidence, ua.norm(), ub.norm(), (p-ua).norm(), (pb-ub).norm(), stretch.bound.norm());
                    }
                    *found.free.entry(format!("{:?}", stretch.acting)).or_default() += 1;
                }
                if seed == 1 {
                    println!("noise {:.2e} policy {:.2e}", estimates.noise.sqrt(), estimates.policy_variance.sqrt());
                }
            }
            let share = |part: usize| (100.0 * part as f64 / found.all as f64).round();
            let median = |of: &[f64]| motion::upper_median(of.to_vec()).unwrap_or(f64::NAN);
            println!(
                "{name} push {push} noise {noise}: found {} %, within 1/5/15 degrees {:?} %, switches {:.0} %; median {:.2}, expected {:.2}; sure (2.5 degrees expected at most) {:.0} %, of them within 1/5/15 {:?} %; {:?} free {:?}",
                share(found.covered),
                found.within.map(share),
                100.0 * found.switches.1 as f64 / found.switches.0 as f64,
                median(&found.angles),
                median(&found.expected),
                100.0 * found.sure as f64 / found.all as f64,
                found.sure_within.map(|of| (100.0 * of as f64 / found.sure as f64).round()),
                found.ranks,
                found.free,
            );
        }
    }
}
