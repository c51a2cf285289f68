//! Gaussian processes: fits as in Table 1, and predictions of the slope GP in 2 and 22 dimensions, one by one and many
//! at once. About three minutes.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use demo_gen::beyond::{BeyondSystem, PolicyKind};
use demo_gen::{ToyPotential, ToySystem, demonstrations};
use gp::{CurlTest, DirectGp, Family, FrontEnd, Rows, SlopeFit, SlopeGp};
use motion::{LearntPolicy, Policy, Potential};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(1)
}

/// 40 movements of 40 samples on the sinusoidal potential.
fn toy() -> Rows {
    let system = ToySystem { potential: ToyPotential::sinusoidal(), ..ToySystem::default() };
    let recordings = system.record(&mut rng()).expect("the system is sound");
    FrontEnd::FiniteDifferences.rows(&demonstrations(&recordings).expect("recordings")).expect("rows")
}

/// 60 movements of 40 samples down a potential with three wells.
fn wells(dim: usize) -> Rows {
    let system = BeyondSystem { policy: PolicyKind::Wells { dim }, ..BeyondSystem::default() };
    let recordings = system.record(&mut rng()).expect("the system is sound");
    FrontEnd::Velocities.rows(&demonstrations(&recordings).expect("recordings")).expect("rows")
}

fn fits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("gp fit");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(20));
    let (toy, wells) = (toy(), wells(6));
    for (name, rows) in [("40 x 40", &toy), ("1500 rows, d=6", &wells)] {
        group.bench_function(format!("slope GP, {name}"), |bencher| {
            bencher.iter(|| SlopeGp::default().fit(rows, &mut rng()).expect("a fit"));
        });
        group.bench_function(format!("direct GP, {name}"), |bencher| {
            bencher.iter(|| DirectGp::default().fit(rows, &mut rng()).expect("a fit"));
        });
    }
}

/// A slope GP of 1500 rows, of one family: predictions cost the same whichever it is.
fn fitted(dim: usize) -> SlopeFit {
    let (families, curl_test) = (vec![Family::Smooth], CurlTest::AssumePotential);
    let learner = SlopeGp { families, curl_test, hyper_rows: 200, ..SlopeGp::default() };
    learner.fit(&wells(dim), &mut rng()).expect("a fit")
}

fn predictions(criterion: &mut Criterion) {
    for dim in [2, 22] {
        let fit = fitted(dim);
        let states: Vec<DVector<f64>> =
            (0..256).map(|at| DVector::from_fn(dim, |k, _| ((at * (k + 3)) as f64 * 0.37).sin())).collect();
        let mut group = criterion.benchmark_group(format!("gp predict, 1500 rows, d={dim}"));
        group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
        let mut action = DVector::zeros(dim);
        group.bench_function("policy", |bencher| {
            bencher.iter(|| fit.action_into(black_box(states[7].as_view()), action.as_view_mut()));
        });
        let potential = fit.potential().expect("a potential was assumed");
        group.bench_function("potential", |bencher| bencher.iter(|| potential.value(black_box(states[7].as_view()))));
        let mut deviation = DVector::zeros(dim);
        group.bench_function("error bars", |bencher| {
            bencher.iter(|| fit.action_sd_into(black_box(states[7].as_view()), deviation.as_view_mut()));
        });
        let states = DMatrix::from_columns(&states);
        group.throughput(Throughput::Elements(states.ncols() as u64));
        group.bench_function("policy, 256 states", |bencher| bencher.iter(|| fit.actions(black_box(states.as_view()))));
        group.bench_function("error bars and support, 256 states", |bencher| {
            bencher.iter(|| fit.certainty(black_box(states.as_view())));
        });
    }
}

criterion_group!(benches, fits, predictions);
criterion_main!(benches);
