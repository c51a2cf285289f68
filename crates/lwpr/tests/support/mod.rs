//! Random models and data for the property tests.

#![allow(dead_code, unreachable_pub)] // Each test file uses its part.

use lwpr::{Kernel, Lwpr, LwprParams, Metric, MetricAdaptation};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A model's size and parameters, and data to train it with.
#[derive(Debug, Clone)]
pub struct Case {
    pub n_in: usize,
    pub n_out: usize,
    pub params: LwprParams,
    pub xs: DMatrix<f64>,
    pub ys: DMatrix<f64>,
    pub seed: u64,
}

impl Case {
    pub fn model(&self) -> Lwpr {
        self.params.clone().build(self.n_in, self.n_out).unwrap()
    }

    pub fn trained(&self, passes: usize) -> Lwpr {
        let mut model = self.model();
        model.fit_in_order(&self.xs, &self.ys, passes).unwrap();
        model
    }
}

fn adaptation() -> impl Strategy<Value = MetricAdaptation> {
    prop_oneof![
        Just(MetricAdaptation::Fixed),
        Just(MetricAdaptation::Gradient),
        (1.0..500.0).prop_map(|rate| MetricAdaptation::Meta { rate }),
    ]
}

fn shape() -> impl Strategy<Value = (Metric, Kernel, MetricAdaptation, f64)> {
    let metric = prop_oneof![2 => Just(Metric::Diagonal), 1 => Just(Metric::Full)];
    let kernel = prop_oneof![Just(Kernel::Gaussian), Just(Kernel::BiSquare)];
    let w_prune = prop_oneof![2 => Just(1.0), 1 => 0.6..0.95];
    (metric, kernel, adaptation(), w_prune)
}

/// Every parameter is drawn. The targets are smooth functions with noise.
pub fn case(samples: usize) -> impl Strategy<Value = Case> {
    let sizes = (1_usize..=9, 1_usize..=3, any::<u64>());
    let speeds = (1.0..200.0, 1e-8..1e-3, 0.002..0.4, 0.2..0.99, 0.98..0.9995, 0.9..0.9999);
    (sizes, shape(), speeds, 0.5..4.0, 0.3..3.0).prop_map(
        move |((n_in, n_out, seed), (metric, kernel, adaptation, w_prune), speeds, width, norm)| {
            let (init_alpha, penalty, w_gen, add_threshold, init_lambda, tau_lambda) = speeds;
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let xs = DMatrix::from_fn(n_in, samples, |_, _| rng.random_range(-1.0..1.0));
            let waves = DMatrix::from_fn(n_out, n_in, |_, _| rng.random_range(-2.0..2.0));
            let ys = (&waves * &xs).map(|z: f64| z.sin() + rng.random_range(-0.05..0.05));
            let params = LwprParams {
                init_d: width / n_in as f64,
                init_alpha,
                metric,
                adaptation,
                kernel,
                penalty,
                w_gen,
                w_prune,
                init_lambda,
                final_lambda: 0.9999,
                tau_lambda,
                add_threshold,
                norm_in: Some(DVector::from_fn(n_in, |i, _| norm + 0.1 * i as f64)),
                norm_out: Some(DVector::from_element(n_out, norm)),
                ..LwprParams::default()
            };
            Case { n_in, n_out, params, xs, ys, seed }
        },
    )
}
