//! The model with given parameters: compares means, marginal likelihood and left-out predictions with their definitions.

use crate::drawn::{descent, rng, rows, vector};
use gp::{DirectData, Evidence, Family, Rows, SlopeData, Trend};
use motion::{Policy as _, Potential as _};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn families() -> impl Strategy<Value = Family> {
    prop_oneof![Just(Family::Smooth), Just(Family::Medium), Just(Family::Rough)]
}

fn theta<R: rand::Rng>(blocks: usize, rng: &mut R) -> Vec<f64> {
    (0..=blocks).map(|_| rng.random_range(-4.0..0.5)).collect()
}

fn noise_weights<R: rand::Rng>(count: usize, rng: &mut R) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(0.2..3.0)).collect()
}

/// Checks the gradient of a marginal likelihood at θ by differences of its values.
fn agrees_with_differences(theta: &[f64], evidence: impl Fn(&[f64]) -> Evidence) -> Result<(), TestCaseError> {
    let gradient = evidence(theta).gradient;
    for k in 0..theta.len() {
        let at = |step: f64| {
            let mut theta = theta.to_vec();
            theta[k] += step;
            evidence(&theta).value
        };
        let expected = (at(1e-4) - at(-1e-4)) / 2e-4;
        prop_assert!((gradient[k] - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{k}: {} {expected}", gradient[k]);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// (S9) by differences of (S8), also with rotation.
    #[test]
    fn evidence_has_its_gradient(family in families(), dim in 2_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 5), descent, rng);
        let blocks = family.helmholtz_blocks(Trend::Quadratic);
        let data = SlopeData::new(&rows, noise_weights(20, rng)).expect("rows");
        let theta = theta(blocks.len(), rng);
        agrees_with_differences(&theta, |theta| data.evidence(&blocks, theta).expect("a factor"))?;
    }

    /// (R2) likewise.
    #[test]
    fn direct_evidence_has_its_gradient(family in families(), dim in 1_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 5), descent, rng);
        let blocks = family.direct_blocks();
        let data = DirectData::new(&rows, noise_weights(20, rng)).expect("rows");
        let theta = theta(blocks.len(), rng);
        agrees_with_differences(&theta, |theta| data.evidence(&blocks, theta).expect("a factor"))?;
    }

    /// π̂ = −∇φ̂, by differences.
    #[test]
    fn the_policy_descends_the_potential(family in families(), dim in 1_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 20), descent, rng);
        let blocks = family.blocks(Trend::Quadratic);
        let data = SlopeData::new(&rows, noise_weights(80, rng)).expect("rows");
        let (model, _) = data.condition(&blocks, &theta(blocks.len(), rng), 1.0).expect("a factor");
        let potential = model.potential().expect("no rotation");
        let x = vector(dim, rng);
        let action = model.policy().action(x.as_view());
        for k in 0..dim {
            let at = |step: f64| {
                let mut x = x.clone();
                x[k] += step;
                potential.value(x.as_view())
            };
            let expected = -(at(1e-5) - at(-1e-5)) / 2e-5;
            prop_assert!((action[k] - expected).abs() < 1e-4 * (1.0 + action.norm()), "{} {expected}", action[k]);
        }
        prop_assert_eq!(-potential.gradient(x.as_view()), action);
    }

    /// (S10): the closed form equals a model without the trajectory. Rows are in the units of all rows.
    #[test]
    fn left_out_predictions_equal_a_model_without_them(family in families(), dim in 2_usize..4, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 6), descent, rng);
        let blocks = family.helmholtz_blocks(Trend::Quadratic);
        let theta = theta(blocks.len(), rng);
        let weights = noise_weights(24, rng);
        let data = SlopeData::new(&rows, weights.clone()).expect("rows");
        let (_, left_out) = data.condition(&blocks, &theta, 1.0).expect("a factor");
        let literal = Literal::new(&rows, &data, &blocks, &theta, &weights);
        for trajectory in 0..4 {
            let (prediction, variance) = literal.without(6 * trajectory..6 * trajectory + 6);
            for (at, row) in (6 * trajectory..6 * trajectory + 6).enumerate() {
                let error = literal.targets[row] - prediction[at];
                prop_assert!((left_out.residuals[(row, 0)] - error).abs() < 1e-7 * (1.0 + error.abs()));
                prop_assert!((left_out.variances[row] - variance[at]).abs() < 1e-7 * (1.0 + variance[at]));
            }
        }
    }

    /// (S13), evaluated literally.
    #[test]
    fn uncertainty_is_the_conditional_covariance(family in families(), dim in 2_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 9), descent, rng);
        let blocks = family.helmholtz_blocks(Trend::Quadratic);
        let theta = theta(blocks.len(), rng);
        let weights = noise_weights(36, rng);
        let data = SlopeData::new(&rows, weights.clone()).expect("rows");
        let (model, _) = data.condition(&blocks, &theta, 1.0).expect("a factor");
        let literal = Literal::new(&rows, &data, &blocks, &theta, &weights);
        let x = vector(dim, rng);
        let (prior, posterior) = literal.covariances(&rows, &data, &blocks, &theta, &x);
        let scale = prior.amax();
        prop_assert!((model.prior_covariance(x.as_view()) - &prior).amax() <= 1e-13 * scale);
        let found = model.covariance(x.as_view());
        // A Matérn 3/2 turns a rounding error of 1e-16 in a squared distance into 1e-8, on the diagonal of the rows'
        // covariance.
        let tolerance = if family == Family::Rough { 1e-6 } else { 1e-9 };
        prop_assert!((&found - &posterior).amax() <= tolerance * scale, "{found} {posterior}");
    }

    /// (S13) is the covariance of samples from the prior, conditioned on the rows: never above the prior, and nearly 0 at
    /// a row along its direction if there is no noise.
    #[test]
    fn rows_determine_their_own_states(family in families(), dim in 2_usize..5, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let rows = rows(dim, (4, 10), descent, rng);
        let blocks = family.blocks(Trend::Quadratic);
        let mut theta = theta(blocks.len(), rng);
        theta[blocks.len()] = -25.0;
        let data = SlopeData::new(&rows, vec![1.0; 40]).expect("rows");
        let (model, _) = data.condition(&blocks, &theta, 1.0).expect("a factor");
        let row = rng.random_range(0..40);
        let (x, n) = (rows.states().column(row), rows.velocities().column(row).normalize());
        let (posterior, prior) = (model.covariance(x), model.prior_covariance(x));
        let share = (n.transpose() * &posterior * &n).x / (n.transpose() * &prior * &n).x;
        prop_assert!(share.abs() < 1e-6, "{share}");
        prop_assert!((prior - posterior).symmetric_eigenvalues().min() > -1e-9);
    }
}

/// (S3), (S6), evaluated literally.
struct Literal {
    k: DMatrix<f64>,
    targets: DVector<f64>,
}

impl Literal {
    fn new(rows: &Rows, data: &SlopeData, blocks: &[gp::Block], theta: &[f64], weights: &[f64]) -> Self {
        let (mean, scale) = data.scaling();
        let mean = DVector::from_column_slice(mean);
        let z: Vec<DVector<f64>> = rows.states().column_iter().map(|x| (x - &mean) / scale).collect();
        let n: Vec<DVector<f64>> = rows.velocities().column_iter().map(|u| u.normalize()).collect();
        let entry = |i: usize, j: usize| -> f64 {
            let each = blocks.iter().zip(theta);
            each.map(|(b, t)| t.exp() * b.slope_slope(z[i].as_view(), n[i].as_view(), z[j].as_view(), n[j].as_view()))
                .sum()
        };
        let mut k = DMatrix::from_fn(rows.len(), rows.len(), entry);
        for i in 0..rows.len() {
            k[(i, i)] += (theta[blocks.len()].exp() + 1e-10) * weights[i];
        }
        let targets = rows.velocities().column_iter().map(|u| u.norm() / data.unit());
        Literal { k, targets: DVector::from_iterator(rows.len(), targets) }
    }

    /// Prior and posterior covariance of the policy at `x`.
    fn covariances(
        &self,
        rows: &Rows,
        data: &SlopeData,
        blocks: &[gp::Block],
        theta: &[f64],
        x: &DVector<f64>,
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let (mean, scale) = data.scaling();
        let scaled = |x: DVector<f64>| (x - DVector::from_column_slice(mean)) / scale;
        let (z, dim) = (scaled(x.clone()), x.len());
        let axis = |k: usize| DVector::from_fn(dim, |i, _| f64::from(u8::from(i == k)));
        let among = |z2: &DVector<f64>, n: &DVector<f64>, n2: &DVector<f64>| -> f64 {
            let each = blocks.iter().zip(theta);
            each.map(|(b, t)| t.exp() * b.slope_slope(z.as_view(), n.as_view(), z2.as_view(), n2.as_view())).sum()
        };
        let prior = DMatrix::from_fn(dim, dim, |i, j| among(&z, &axis(i), &axis(j)));
        let with_rows = DMatrix::from_fn(rows.len(), dim, |row, k| {
            let (state, velocity) = (rows.states().column(row), rows.velocities().column(row));
            among(&scaled(state.into_owned()), &axis(k), &velocity.normalize())
        });
        let solved = self.k.clone().cholesky().expect("positive definite").solve(&with_rows);
        let posterior = &prior - with_rows.tr_mul(&solved);
        (prior * data.unit().powi(2), posterior * data.unit().powi(2))
    }

    /// Prediction of some rows from the others, and its variance including noise.
    fn without(&self, out: std::ops::Range<usize>) -> (DVector<f64>, DVector<f64>) {
        let rest: Vec<usize> = (0..self.targets.len()).filter(|row| !out.contains(row)).collect();
        let out: Vec<usize> = out.collect();
        let among = self.k.select_rows(&rest).select_columns(&rest).cholesky().expect("positive definite");
        let cross = self.k.select_rows(&rest).select_columns(&out);
        let own = self.k.select_rows(&out).select_columns(&out);
        let prediction = cross.tr_mul(&among.solve(&self.targets.select_rows(&rest)));
        (prediction, (own - cross.tr_mul(&among.solve(&cross))).diagonal())
    }
}
