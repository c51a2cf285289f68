//! LWPR: training sample by sample and in batch, prediction, and both alternately; d = 2, 6, 22 with a diagonal metric, 2
//! and 6 with a full one. About two minutes.
#![allow(missing_docs, reason = "a benchmark")]

use std::hint::black_box;
use std::time::Duration;

use benches::lwpr_data::{PotentialSamples, potential_samples};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use lwpr::{Lwpr, LwprParams, Metric, Prediction};
use nalgebra::DVector;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Samples in random order, as training requires.
fn shuffled(d: usize) -> PotentialSamples {
    let mut rng = ChaCha8Rng::seed_from_u64(d as u64);
    let samples = potential_samples(d, &mut rng);
    let mut order: Vec<usize> = (0..samples.xs.ncols()).collect();
    order.shuffle(&mut rng);
    PotentialSamples {
        xs: samples.xs.select_columns(&order),
        ys: samples.ys.select_columns(&order),
        init_d: samples.init_d,
    }
}

/// A model that has seen all samples once, so that it has all its receptive fields.
fn model(samples: &PotentialSamples, metric: Metric) -> Lwpr {
    let params = LwprParams {
        metric,
        init_d: samples.init_d,
        norm_out: Some(DVector::from_element(1, samples.spread())),
        ..LwprParams::default()
    };
    let mut model = params.build(samples.xs.nrows(), 1).expect("the parameters are in range");
    model.fit_in_order(samples.xs.as_view(), samples.ys.as_view(), 1).expect("the samples are finite");
    model
}

fn bench(criterion: &mut Criterion) {
    let shapes = [2, 6, 22].map(|d| (d, Metric::Diagonal)).into_iter().chain([2, 6].map(|d| (d, Metric::Full)));
    for (d, metric) in shapes {
        let samples = shuffled(d);
        let model = model(&samples, metric);
        let mut group = criterion.benchmark_group(format!("lwpr d={d} {metric:?}"));
        group.sample_size(10).throughput(Throughput::Elements(samples.xs.ncols() as u64));
        group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
        group.bench_function("train online", |bencher| {
            let train = |mut model: Lwpr| {
                for (x, y) in samples.xs.column_iter().zip(samples.ys.column_iter()) {
                    model.update(x, y).expect("the samples are finite");
                }
                model
            };
            bencher.iter_batched(|| model.clone(), train, BatchSize::LargeInput);
        });
        group.bench_function("train batch", |bencher| {
            let train = |mut model: Lwpr| {
                model.fit_in_order(samples.xs.as_view(), samples.ys.as_view(), 1).expect("the samples are finite");
                model
            };
            bencher.iter_batched(|| model.clone(), train, BatchSize::LargeInput);
        });
        let predictor = model.predictor(0.001);
        let mut gradient = DVector::zeros(d);
        group.bench_function("predict with gradient", |bencher| {
            bencher.iter(|| {
                for x in samples.xs.column_iter() {
                    black_box(predictor.value_and_gradient_into(x, 0, gradient.as_view_mut()));
                }
            });
        });
        let mut prediction = Prediction::zeros(d, 1);
        group.bench_function("predict everything", |bencher| {
            bencher.iter(|| {
                for x in samples.xs.column_iter() {
                    black_box(predictor.predict_into(x, &mut prediction));
                }
            });
        });
        group.bench_function("update, then predict with gradient", |bencher| {
            let mut learn = |mut model: Lwpr| {
                for (x, y) in samples.xs.column_iter().zip(samples.ys.column_iter()) {
                    model.update(x, y).expect("the samples are finite");
                    black_box(model.value_and_gradient_into(x, 0, 0.001, gradient.as_view_mut()));
                }
                model
            };
            bencher.iter_batched(|| model.clone(), &mut learn, BatchSize::LargeInput);
        });
        group.finish();
    }
}

criterion_group!(lwpr_benches, bench);
criterion_main!(lwpr_benches);
