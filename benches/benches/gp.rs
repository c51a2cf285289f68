//! Gaussian processes: fits as in Table 1 and of 1,500 rows, and predictions from 400 and 1,500 rows in 2 and 22 dimensions,
//! singly and in batches. About five minutes.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use demo_gen::beyond::{BeyondSystem, PolicyKind};
use demo_gen::{ToyPotential, ToySystem, demonstrations};
use gp::{CurlTest, DirectFit, DirectGp, Family, FrontEnd, Rows, SlopeFit, SlopeGp};
use motion::{LearntPolicy, Potential};
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

/// 60 movements of 40 samples in a potential with three wells.
fn wells(dim: usize) -> Rows {
    let system = BeyondSystem { policy: PolicyKind::Wells { dim }, ..BeyondSystem::default() };
    let recordings = system.record(&mut rng()).expect("the system is sound");
    FrontEnd::Velocities.rows(&demonstrations(&recordings).expect("recordings")).expect("rows")
}

fn fits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("gp fit");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(20));
    let toy = toy();
    group.bench_function("slope GP, 40 x 40", |bencher| {
        bencher.iter(|| SlopeGp::default().fit(&toy, &mut rng()).expect("a fit"));
    });
    group.bench_function("direct GP, 40 x 40", |bencher| {
        bencher.iter(|| DirectGp::default().fit(&toy, &mut rng()).expect("a fit"));
    });
    for dim in [3, 22] {
        let wells = wells(dim);
        group.bench_function(format!("slope GP, 1500 rows, d={dim}"), |bencher| {
            bencher.iter(|| SlopeGp::default().fit(&wells, &mut rng()).expect("a fit"));
        });
    }
}

/// A slope GP and a direct GP, each with one family, because the cost of predictions does not depend on the family.
fn fitted(max_rows: usize, dim: usize) -> (SlopeFit, DirectFit) {
    let (families, hyper_rows, rows) = (vec![Family::Smooth], 200, wells(dim));
    let curl_test = CurlTest::AssumePotential;
    let slope = SlopeGp { families: families.clone(), curl_test, hyper_rows, max_rows, ..SlopeGp::default() };
    let direct = DirectGp { families, hyper_rows, max_rows, ..DirectGp::default() };
    (slope.fit(&rows, &mut rng()).expect("a fit"), direct.fit(&rows, &mut rng()).expect("a fit"))
}

fn predictions(criterion: &mut Criterion) {
    for (rows, dim) in [(400, 2), (400, 22), (1500, 2), (1500, 22)] {
        let (slope, direct) = fitted(rows, dim);
        let states: Vec<DVector<f64>> =
            (0..256).map(|at| DVector::from_fn(dim, |k, _| ((at * (k + 3)) as f64 * 0.37).sin())).collect();
        let mut group = criterion.benchmark_group(format!("gp predict, {rows} rows, d={dim}"));
        group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
        let mut out = DVector::zeros(dim);
        let potential = slope.potential().expect("a potential was assumed");
        group.bench_function("potential", |bencher| bencher.iter(|| potential.value(black_box(states[7].as_view()))));
        group.bench_function("slope GP, error bars", |bencher| {
            bencher.iter(|| slope.action_sd_into(black_box(states[7].as_view()), out.as_view_mut()));
        });
        let many = DMatrix::from_columns(&states);
        for (name, fit) in [("slope GP", &slope as &dyn LearntPolicy), ("direct GP", &direct)] {
            group.throughput(Throughput::Elements(1));
            group.bench_function(format!("{name}, action"), |bencher| {
                bencher.iter(|| fit.action_into(black_box(states[7].as_view()), out.as_view_mut()));
            });
            group.throughput(Throughput::Elements(many.ncols() as u64));
            group.bench_function(format!("{name}, actions of 256 states"), |bencher| {
                bencher.iter(|| fit.actions(black_box(many.as_view())));
            });
            group.bench_function(format!("{name}, error bars and support of 256 states"), |bencher| {
                bencher.iter(|| fit.certainty(black_box(many.as_view())));
            });
        }
    }
}

criterion_group!(benches, fits, predictions);
criterion_main!(benches);
