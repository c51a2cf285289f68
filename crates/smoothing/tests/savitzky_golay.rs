//! Compares Savitzky–Golay with least squares and printed coefficients.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;
use smoothing::SavitzkyGolay;

/// The value at `at` of the polynomial that best fits all columns of `around`.
fn fitted(around: &DMatrix<f64>, at: usize, degree: usize) -> DVector<f64> {
    let n = around.ncols();
    let power = |i: usize, k: usize| ((i as f64 - at as f64) / n as f64).powf(k as f64);
    let powers = DMatrix::from_fn(n, degree.min(n - 1) + 1, power);
    let factors = powers.svd(true, true).solve(&around.transpose(), 1e-14).unwrap();
    factors.row(0).transpose()
}

fn settings() -> impl Strategy<Value = SavitzkyGolay> {
    (0..4usize, 0..5usize)
        .prop_map(|(degree, more)| SavitzkyGolay { window: 2 * (degree / 2 + more) + 1, degree })
        .prop_filter("a window beyond its degree", |filter| filter.window > filter.degree)
}

proptest! {
    #[test]
    fn every_sample_is_the_least_squares_fit_around_it(
        filter in settings(), dim in 1..4usize, n in 2..30usize, numbers in vec(-1.0..1.0f64, 90),
    ) {
        let states = DMatrix::from_fn(dim, n, |j, i| numbers[3 * i + j]);
        let smoothed = filter.smooth(&Demonstrations::from_states([states.clone()], 0.1).unwrap()).unwrap();
        let window = filter.window.min(n);
        for i in 0..n {
            let first = i.max(window / 2).min(n - window + window / 2) - window / 2;
            let expected = fitted(&states.columns(first, window).into(), i - first, filter.degree);
            prop_assert!((smoothed.trajectories()[0].state(i) - expected).amax() < 1e-9, "sample {i}");
        }
    }

    /// Polynomials of the filter's degree are unchanged, up to both ends; velocities and time step are kept.
    #[test]
    fn polynomials_pass(filter in settings(), n in 2..40usize, factors in vec(-1.0..1.0f64, 4), step in 0.01..2.0f64) {
        let value = |i: usize| (0..=filter.degree).map(|k| factors[k] * (i as f64 / 10.0).powf(k as f64)).sum::<f64>();
        let states = DMatrix::from_fn(1, n, |_, i| value(i));
        let velocities = DMatrix::from_fn(1, n, |_, i| factors[i % 4]);
        let trajectory = Trajectory::new(states.clone(), step).unwrap().with_velocities(velocities.clone()).unwrap();
        let smoothed = filter.smooth(&Demonstrations::new(vec![trajectory]).unwrap()).unwrap();
        let smoothed = &smoothed.trajectories()[0];
        prop_assert!((smoothed.states() - &states).amax() < 1e-9 * (1.0 + states.amax()));
        prop_assert_eq!(smoothed.velocities(), Some(&velocities));
        prop_assert_eq!(smoothed.time_step(), step);
    }
}

/// The weights for nine samples and degree 2 from printed tables: (−21 14 39 54 59 54 39 14 −21)/231.
#[test]
fn printed_weights() {
    let weights = [-21.0, 14.0, 39.0, 54.0, 59.0, 54.0, 39.0, 14.0, -21.0];
    for (at, weight) in weights.iter().enumerate() {
        let mut states = DMatrix::zeros(1, 17);
        states[4 + at] = 1.0;
        let smoothed = SavitzkyGolay::default().smooth(&Demonstrations::from_states([states], 1.0).unwrap()).unwrap();
        assert!((smoothed.trajectories()[0].states()[8] - weight / 231.0).abs() < 1e-14);
    }
}

/// Nearly all windows contain the whole movement; the weights of all its samples at once would take 3 GB.
#[test]
fn a_window_may_be_as_long_as_a_long_movement() {
    let n = 20_001;
    let parabola = DMatrix::from_fn(1, n, |_, i| (i as f64 / n as f64 - 0.3).powi(2));
    let recorded = Demonstrations::from_states([parabola.clone()], 1.0).unwrap();
    let smoothed = SavitzkyGolay { window: n, degree: 2 }.smooth(&recorded).unwrap();
    assert!((smoothed.trajectories()[0].states() - parabola).amax() < 1e-9);
}

proptest! {
    /// Polynomials of the filter's degree are unchanged with any stamps; even stamps have no effect.
    #[test]
    fn polynomials_pass_at_uneven_stamps(
        filter in settings(), gaps in vec(0.2..2.0f64, 1..39), factors in vec(-1.0..1.0f64, 4),
    ) {
        let times: Vec<f64> = std::iter::once(0.0).chain(gaps).scan(0.0, |at, gap| { *at += gap; Some(*at) }).collect();
        let value = |t: f64| (0..=filter.degree).map(|k| factors[k] * (t / 10.0).powf(k as f64)).sum::<f64>();
        let states = DMatrix::from_fn(1, times.len(), |_, i| value(times[i]));
        let trajectory = Trajectory::new(states.clone(), 1.0).unwrap().with_times(times).unwrap();
        let smoothed = filter.smooth(&Demonstrations::new(vec![trajectory.clone()]).unwrap()).unwrap();
        let smoothed = &smoothed.trajectories()[0];
        prop_assert!((smoothed.states() - &states).amax() < 1e-8 * (1.0 + states.amax()));
        let seconds = |of: &Trajectory| (1..of.n_samples()).map(|i| of.seconds(i - 1, i)).collect::<Vec<_>>();
        prop_assert_eq!(seconds(smoothed), seconds(&trajectory));
    }
}
