//! Constraints that are orthogonal in a metric that depends on the state, as if a robot's inertia weights its joints.

use gp::{GpError, Rows, SlopeGp};
use motion::{Policy, SampleIndex};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The mass matrix of an arm of two rods with masses at their ends.
fn mass(q: &Vector2<f64>) -> Matrix2<f64> {
    let bent = q.y.cos();
    Matrix2::new(3.0 + 2.0 * bent, 1.0 + bent, 1.0 + bent, 1.0)
}

fn policy(q: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-q.x.sin() - 0.3 * (q.x - q.y).sin(), -0.5 * q.y + 0.3 * (q.x - q.y).sin())
}

/// Rows of 30 movements, each restricted to a line, and Mu of each row.
fn rows(seed: u64) -> (Rows, DMatrix<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut states, mut velocities, mut momenta, mut indices) = (vec![], vec![], vec![], vec![]);
    for trajectory in 0..30 {
        let mut q = Vector2::from_fn(|_, _| rng.random_range(-1.5..1.5f64));
        let angle = rng.random_range(0.0..std::f64::consts::PI);
        let along = Vector2::new(angle.cos(), angle.sin());
        for sample in 0..20 {
            let metric = mass(&q);
            let u = along * (along.dot(&(metric * policy(&q))) / along.dot(&(metric * along)));
            states.extend_from_slice(q.as_slice());
            velocities.extend_from_slice(u.as_slice());
            momenta.extend_from_slice((metric * u).as_slice());
            indices.push(SampleIndex { trajectory, sample });
            q += u * 0.05;
        }
    }
    let matrix = |numbers| DMatrix::from_vec(2, indices.len(), numbers);
    (Rows::new(matrix(states), matrix(velocities), indices.clone()).unwrap(), matrix(momenta))
}

fn error(rows: &Rows) -> f64 {
    let gp = SlopeGp { max_rows: 300, hyper_rows: 150, ..SlopeGp::default() };
    let fit = gp.fit(rows, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let states: Vec<Vector2<f64>> = (0..100).map(|_| Vector2::from_fn(|_, _| rng.random_range(-1.0..1.0f64))).collect();
    let apart = |q: &Vector2<f64>| {
        let learnt = fit.action(DVector::from_column_slice(q.as_slice()).as_view());
        (Vector2::new(learnt[0], learnt[1]) - policy(q)).norm_squared()
    };
    states.iter().map(apart).sum::<f64>() / states.iter().map(|q| policy(q).norm_squared()).sum::<f64>()
}

#[test]
fn policies_are_found_in_the_metric_of_inertia() {
    let (plain, momenta) = rows(1);
    let (with, without) = (error(&plain.clone().with_momenta(momenta).unwrap()), error(&plain));
    assert!(with < 1e-4 && without > 0.05, "{with:.1e} {without:.1e}");
}

/// With velocities as momenta the metric is the identity: nothing changes except rounding.
#[test]
fn the_plain_metric_is_the_identity() {
    let (plain, _) = rows(2);
    let velocities = plain.velocities().clone();
    let [same, plain] = [error(&plain.clone().with_momenta(velocities).unwrap()), error(&plain)];
    assert!((same / plain - 1.0).abs() < 1e-3, "{same:e} {plain:e}");
}

#[test]
fn a_metric_must_be_positive() {
    let (plain, momenta) = rows(3);
    let mut negative = momenta.clone();
    negative.column_mut(7).neg_mut();
    assert!(matches!(plain.clone().with_momenta(negative), Err(GpError::Value { row: 7, .. })));
    let mut missing = momenta.clone();
    missing[(1, 3)] = f64::NAN;
    assert!(matches!(plain.clone().with_momenta(missing), Err(GpError::Value { row: 3, .. })));
    let short = momenta.columns(0, 5).into_owned();
    assert!(matches!(plain.with_momenta(short), Err(GpError::Lengths { what: "momenta", found: 5, .. })));
}
