//! Random models and data for the property tests.

use lwpr::{Kernel, Lwpr, LwprParams, Metric, MetricAdaptation, Pruning};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A model's size and parameters, and data for training.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub n_in: usize,
    pub n_out: usize,
    pub params: LwprParams,
    pub xs: DMatrix<f64>,
    pub ys: DMatrix<f64>,
    pub seed: u64,
}

impl Case {
    pub(crate) fn model(&self) -> Lwpr {
        self.params.clone().build(self.n_in, self.n_out).unwrap()
    }

    pub(crate) fn trained(&self, passes: usize) -> Lwpr {
        let mut model = self.model();
        model.fit_in_order(self.xs.as_view(), self.ys.as_view(), passes).unwrap();
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

/// Usually few inputs, sometimes more than any vector register holds.
fn n_in() -> impl Strategy<Value = usize> {
    prop_oneof![6 => 1_usize..=9, 1 => 10_usize..=34]
}

/// Pruning, minimum variance of a projection, final forgetting factor, limit on fields, and whether the metric is given
/// as a matrix.
fn rest() -> impl Strategy<Value = (Pruning, f64, f64, Option<usize>, bool)> {
    let pruning = prop_oneof![Just(Pruning::Wider), Just(Pruning::Narrower)];
    // The limit exceeds the number of samples; the limit itself is tested in `bad_input`.
    let limit = prop_oneof![Just(None), (400_usize..1000).prop_map(Some)];
    (pruning, -12.0..-6.0, 0.999..=1.0, limit, any::<bool>())
        .prop_map(|(pruning, exponent, last, limit, matrix)| (pruning, 10_f64.powf(exponent), last, limit, matrix))
}

/// A metric (n, n) that is not a multiple of the unit matrix.
fn metric_matrix(metric: Metric, n: usize, width: f64, rng: &mut ChaCha8Rng) -> DMatrix<f64> {
    let mut diagonal = DMatrix::from_fn(n, n, |i, j| if i == j { width * rng.random_range(0.5..1.5) } else { 0.0 });
    if metric == Metric::Full {
        let turn = DMatrix::from_fn(n, n, |_, _| rng.random_range(-0.3..0.3) * (width / n as f64).sqrt());
        diagonal += &turn * turn.transpose();
    }
    diagonal
}

/// A case with every parameter random. The targets are smooth functions with noise.
pub(crate) fn case(samples: usize) -> impl Strategy<Value = Case> {
    let sizes = (n_in(), 1_usize..=3, any::<u64>());
    let speeds = (1.0..200.0, 1e-8..1e-3, 0.002..0.4, 0.2..0.99, 0.98..0.9995, 0.9..0.9999);
    (sizes, shape(), speeds, rest(), 0.5..4.0, 0.3..3.0).prop_map(
        move |((n_in, n_out, seed), (metric, kernel, adaptation, w_prune), speeds, rest, width, norm)| {
            let (init_alpha, penalty, w_gen, add_threshold, init_lambda, tau_lambda) = speeds;
            let (pruning, init_s2, final_lambda, max_receptive_fields, matrix) = rest;
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let xs = DMatrix::from_fn(n_in, samples, |_, _| rng.random_range(-1.0..1.0));
            let waves = DMatrix::from_fn(n_out, n_in, |_, _| rng.random_range(-2.0..2.0));
            let ys = (&waves * &xs).map(|z: f64| z.sin() + rng.random_range(-0.05..0.05));
            let init_metric = matrix.then(|| metric_matrix(metric, n_in, width / n_in as f64, &mut rng));
            let params = LwprParams {
                init_metric,
                init_d: width / n_in as f64,
                init_alpha,
                metric,
                adaptation,
                kernel,
                penalty,
                w_gen,
                w_prune,
                init_lambda,
                final_lambda,
                pruning,
                init_s2,
                max_receptive_fields,
                tau_lambda,
                add_threshold,
                norm_in: Some(DVector::from_fn(n_in, |i, _| norm + 0.1 * i as f64)),
                norm_out: Some(DVector::from_element(n_out, norm)),
            };
            Case { n_in, n_out, params, xs, ys, seed }
        },
    )
}
