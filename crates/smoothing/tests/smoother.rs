//! Compares the smoother with its literal definition, and checks invariances.

use crate::literal;
use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;
use smoothing::{AxisScale, NoiseVariance, Smoothed, Smoother};

/// Two movements of `samples` samples in `dim` dimensions: a wave that jumps in the middle, with noise.
#[derive(Debug, Clone)]
struct Case {
    times: [Vec<f64>; 2],
    states: [DMatrix<f64>; 2],
    smoother: Smoother,
    noise_variance: f64,
}

impl Case {
    fn movements(&self) -> Demonstrations {
        let movement = |k: usize| Trajectory::stamped(self.times[k].clone(), self.states[k].clone()).unwrap();
        Demonstrations::new((0..2).map(movement).collect()).unwrap()
    }

    fn smooth(&self) -> Smoothed {
        self.smoother.smooth(&self.movements()).unwrap()
    }

    /// The case with other states and times.
    fn with(&self, states: impl Fn(&DMatrix<f64>) -> DMatrix<f64>, times: impl Fn(f64) -> f64) -> Case {
        Case {
            times: self.times.clone().map(|all| all.into_iter().map(&times).collect()),
            states: [states(&self.states[0]), states(&self.states[1])],
            ..self.clone()
        }
    }

    fn with_noise(&self, noise_variance: f64) -> Case {
        let smoother = Smoother { noise: NoiseVariance::Given(noise_variance), ..self.smoother.clone() };
        Case { smoother, noise_variance, ..self.clone() }
    }
}

fn cases(samples: std::ops::Range<usize>) -> impl Strategy<Value = Case> {
    (1..4usize, samples, -3.0..-0.5f64, 0.01..0.4f64, 3..10usize).prop_flat_map(
        |(dim, samples, log10_noise, switch_probability, longest_window)| {
            let degrees = prop_oneof![Just(vec![1, 2, 3, 5]), Just(vec![0, 1, 4]), Just(vec![1])];
            let gaps = vec(0.2..1.8f64, 2 * samples);
            let numbers = || vec(-1.0..1.0f64, 2 * samples * dim);
            (degrees, gaps, numbers(), vec(-1.0..1.0f64, 4 * dim)).prop_map(move |(degrees, gaps, noise, shape)| {
                let times = [&gaps[..samples], &gaps[samples..]].map(|gaps| {
                    gaps.iter()
                        .scan(-3.0, |t, gap| {
                            Some({
                                *t += gap;
                                *t
                            })
                        })
                        .collect::<Vec<_>>()
                });
                let states = [0, 1].map(|k| {
                    DMatrix::from_fn(dim, samples, |j, i| {
                        let jump = if 2 * i > samples { shape[3 * dim + j] } else { 0.0 };
                        let wave = (shape[2 * k + j % 2] * times[k][i]).sin() + shape[2 * dim + j] + 0.1 * i as f64;
                        wave + jump + 10f64.powf(log10_noise / 2.0) * noise[(k * samples + i) * dim + j]
                    })
                });
                let noise_variance = 10f64.powf(log10_noise);
                let smoother = Smoother {
                    degrees,
                    longest_window,
                    switch_probability,
                    axis_scale: AxisScale::Given(DVector::from_element(dim, 1.0)),
                    noise: NoiseVariance::Given(noise_variance),
                };
                Case { times, states, smoother, noise_variance }
            })
        },
    )
}

fn series(smoothed: &Smoothed) -> impl Iterator<Item = [Vec<f64>; 5]> + '_ {
    smoothed.movements.iter().map(|movement| {
        [
            movement.states.as_slice().to_vec(),
            movement.velocities.as_slice().to_vec(),
            movement.state_variance.as_slice().to_vec(),
            movement.velocity_variance.as_slice().to_vec(),
            movement.window_begins.as_slice().to_vec(),
        ]
    })
}

/// Checks that all series agree, each to `tolerance` of its largest number, after multiplying ours by `factors`.
fn same(ours: &Smoothed, theirs: &Smoothed, factors: [f64; 5], tolerance: f64) -> Result<(), TestCaseError> {
    for (ours, theirs) in series(ours).zip(series(theirs)) {
        for (which, ((ours, theirs), factor)) in ours.iter().zip(&theirs).zip(factors).enumerate() {
            let largest = theirs.iter().fold(0.0, |largest, x| f64::max(largest, x.abs()));
            for (a, b) in ours.iter().zip(theirs) {
                prop_assert!(
                    (a * factor - b).abs() <= tolerance * largest,
                    "series {which}: {} against {b}",
                    a * factor
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Forward–backward sums, shrunk coefficients and running variances equal the sums over all segmentations, each
    /// with a dense covariance.
    #[test]
    fn smoothing_sums_over_all_segmentations(case in cases(3..9)) {
        let smoothed = case.smooth();
        let all = DMatrix::from_fn(case.states[0].nrows(), 2 * case.states[0].ncols(), |j, i| {
            case.states[i % 2][(j, i / 2)]
        });
        let mean = all.column_mean();
        let c = all.column_iter().map(|x| (x - &mean).norm_squared()).sum::<f64>() / all.len() as f64;
        for (k, ours) in smoothed.movements.iter().enumerate() {
            let mean = case.states[k].column_mean();
            let mut centred = case.states[k].clone();
            centred.column_iter_mut().for_each(|mut x| x -= &mean);
            let theirs = literal::smooth(&case.smoother, &case.times[k], &centred, c, case.noise_variance);
            let scale = 1.0 + theirs.log_evidence.abs();
            let miss = (ours.log_evidence - theirs.log_evidence).abs() / scale;
            prop_assert!(miss < 1e-9, "log evidence: {miss:e}");
            let miss = (&ours.window_begins - &theirs.window_begins).amax();
            prop_assert!(miss < 1e-7, "window begins: {miss:e}");
            let mut states = ours.states.clone();
            states.column_iter_mut().for_each(|mut x| x -= &mean);
            prop_assert!((&states - &theirs.states).amax() < 1e-8);
            let miss = (&ours.velocities - &theirs.velocities).amax() / theirs.velocities.amax();
            prop_assert!(miss < 1e-7, "velocities: {miss:e}");
            let miss = (&ours.state_variance - &theirs.state_variance).amax() / theirs.state_variance.amax();
            prop_assert!(miss < 1e-8, "state variance: {miss:e}");
            let miss = (&ours.velocity_variance - &theirs.velocity_variance).amax() / theirs.velocity_variance.amax();
            prop_assert!(miss < 1e-7, "velocity variance: {miss:e}");
        }
    }

    /// In other units, states and velocities scale, and probabilities are unchanged.
    #[test]
    fn units_do_not_matter(case in cases(5..25), length in 0.01..100.0f64, time in 0.01..100.0f64, at in -5.0..5.0f64) {
        let other = case.with(|x| x * length, |t| (t + at) * time).with_noise(case.noise_variance * length * length);
        let speed = length / time;
        let factors = [length, speed, length * length, speed * speed, 1.0];
        same(&case.smooth(), &other.smooth(), factors, 1e-7)?;
    }

    /// A rotation and a shift of the state space rotate and shift the result, if axes are not scaled separately.
    #[test]
    fn turned_and_shifted(case in cases(5..25), turn in vec(-1.0..1.0f64, 9), shift in vec(-2.0..2.0f64, 3)) {
        let dim = case.states[0].nrows();
        let turn = DMatrix::from_fn(dim, dim, |i, j| turn[3 * i + j]).qr().q();
        let shift = DVector::from_fn(dim, |j, _| shift[j]);
        let moved = |x: &DMatrix<f64>| {
            let mut x = &turn * x;
            x.column_iter_mut().for_each(|mut x| x += &shift);
            x
        };
        let mut expected = case.smooth();
        for movement in &mut expected.movements {
            movement.states = moved(&movement.states);
            movement.velocities = &turn * &movement.velocities;
        }
        // The variance about the mean is not affected by the shift, and the prior's c does not change either.
        same(&case.with(moved, |t| t).smooth(), &expected, [1.0; 5], 1e-7)?;
    }

    /// Smoothing a reversed movement gives the reversed result.
    #[test]
    fn smoothing_is_invariant_to_time_reversal(case in cases(5..25)) {
        let backwards = |x: &DMatrix<f64>| DMatrix::from_columns(&x.column_iter().rev().collect::<Vec<_>>());
        let mut other = case.with(backwards, |t| -t);
        other.times.iter_mut().for_each(|times| times.reverse());
        for (ours, theirs) in case.smooth().movements.iter().zip(&other.smooth().movements) {
            prop_assert!((ours.log_evidence - theirs.log_evidence).abs() < 1e-9 * (1.0 + ours.log_evidence.abs()));
            prop_assert!((backwards(&ours.states) - &theirs.states).amax() < 1e-7);
            prop_assert!((backwards(&ours.velocities) + &theirs.velocities).amax() < 1e-6 * ours.velocities.amax());
        }
    }

    /// Evenly spaced samples are smoothed alike with and without stamps; every axis is divided by its deviation.
    #[test]
    fn stamps_of_even_samples_may_be_left_out(case in cases(5..25), step in 0.01..3.0f64) {
        let smoother = Smoother { axis_scale: AxisScale::StandardDeviation, ..case.smoother.clone() };
        let demonstrations = Demonstrations::from_states(case.states.clone(), step).unwrap();
        let samples = case.states[0].ncols();
        let times: Vec<f64> = (0..samples).map(|i| 7.0 + i as f64 * step).collect();
        let stamped = case.states.iter().map(|x| Trajectory::stamped(times.clone(), x.clone()).unwrap()).collect();
        let stamped = Demonstrations::new(stamped).unwrap();
        let (even, stamped) = (smoother.smooth(&demonstrations).unwrap(), smoother.smooth(&stamped).unwrap());
        same(&even, &stamped, [1.0; 5], 1e-6)?;
    }

    /// Axes in any unit give the same result if divided by their deviations; a dimension that never changes is left
    /// out.
    #[test]
    fn axes_of_other_units(case in cases(5..25), units in vec(0.01..100.0f64, 3), still in -2.0..2.0f64) {
        let dim = case.states[0].nrows();
        let smoother = Smoother { axis_scale: AxisScale::StandardDeviation, ..case.smoother.clone() };
        let plain = Case { smoother, ..case.clone() };
        let other = plain.with(
            |x| DMatrix::from_fn(dim + 1, x.ncols(), |j, i| if j < dim { units[j] * x[(j, i)] } else { still }),
            |t| t,
        );
        let (plain, other) = (plain.smooth(), other.smooth());
        for (plain, other) in plain.movements.iter().zip(&other.movements) {
            for (j, unit) in units.iter().enumerate().take(dim) {
                let (ours, theirs) = (plain.velocities.row(j) * *unit, other.velocities.row(j));
                prop_assert!((ours - theirs).amax() <= 1e-7 * theirs.amax());
            }
            prop_assert!(other.states.row(dim).iter().all(|&x| x == still));
            prop_assert!(other.velocities.row(dim).iter().all(|&u| u == 0.0));
        }
        prop_assert_eq!(other.noise[dim], 0.0);
    }
}
