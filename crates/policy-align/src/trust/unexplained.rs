//! Noise-free velocities that the state does not explain: they depend on another quantity.

use nalgebra::Vector2;
use prepare::numbers::percent_of_all;

use crate::Finding;
use crate::along::{LEAST_T, MotionSample, Regression};

/// Share of the squared velocities above which a policy is doubtful.
const MUCH: f64 = 0.05;
/// The same share if the residuals change with time; the policy has absorbed most of them.
const SOME: f64 = 0.005;
/// Least share of the residuals explained by a speed that grows or falls with time.
const TIMED: f64 = 0.25;
/// Correlation of neighbouring samples above which the residuals are not noise.
const PERSISTENT: f64 = 0.8;
/// Share of the root mean square speed below which rounding and rest determine the direction n, and with it r − nᵀπ̂.
const SLOW: f64 = 0.2;

/// Residuals r − nᵀπ̂ of velocities that are not slow.
struct Unexplained {
    /// Their share of the squares.
    share: f64,
    /// Correlation of consecutive residuals.
    persistence: f64,
    /// Regression on the time since the start of the movement.
    timed: Option<Regression>,
}

impl Unexplained {
    fn of(movements: Vec<Vec<MotionSample>>) -> Self {
        let powers: Vec<f64> = movements.iter().flatten().map(|sample| sample.speed * sample.speed).collect();
        let slow = SLOW * (powers.iter().sum::<f64>() / powers.len() as f64).sqrt();
        let fast = |samples: Vec<MotionSample>| samples.into_iter().filter(|sample| sample.speed > slow).collect();
        let movements: Vec<Vec<MotionSample>> = movements.into_iter().map(fast).collect();
        let error = |sample: &MotionSample| sample.speed - sample.predicted;
        let over = |of: &dyn Fn(&MotionSample) -> f64| movements.iter().flatten().map(of).sum::<f64>();
        let squares = over(&|sample| error(sample).powi(2));
        let pairs = movements.iter().flat_map(|samples| samples.windows(2));
        let pairs = pairs.filter(|pair| pair[0].index.sample + 1 == pair[1].index.sample);
        let products: f64 = pairs.map(|pair| error(&pair[0]) * error(&pair[1])).sum();
        Unexplained {
            share: squares / over(&|sample| sample.speed.powi(2)),
            persistence: products / squares,
            timed: Regression::of(&movements, |sample| {
                sample.predicted * Vector2::new(sample.index.sample as f64, 1.0)
            }),
        }
    }
}

/// A finding if noise-free velocities depend on more than the state. If left-out movements are not `predicted` either, it is only made
/// if time is the cause.
pub(crate) fn unexplained(movements: Vec<Vec<MotionSample>>, predicted: bool) -> Option<Finding> {
    let Unexplained { share, persistence, timed } = Unexplained::of(movements);
    let timed = timed.filter(|timed| timed.share > TIMED && timed.t.abs() > LEAST_T);
    let (cause, bound) = match &timed {
        Some(Regression { coefficient, .. }) if *coefficient < 0.0 => ("speed falls with time", SOME),
        Some(_) => ("speed grows with time", SOME),
        None if predicted => ("time, a moving target, a delay, a load or the operator may", MUCH),
        None => return None,
    };
    (persistence > PERSISTENT && share > bound).then(|| {
        Finding::doubt(
            format!("the state does not explain {} of the squared velocities ({cause})", percent_of_all(share)),
            "record what else the motion depends on; what is constant during a movement can be given as --context",
        )
    })
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;
    use crate::along::{Bowl, along_movements};

    /// Twelve movements of 40 samples in the bowl, with velocities times `gain` of the movement and the time, 0 to 1.
    fn movements(seed: u32, gain: impl Fn(usize, f64) -> f64) -> Vec<Vec<MotionSample>> {
        let indices: Vec<SampleIndex> = (0..480).map(|i| SampleIndex { trajectory: i / 40, sample: i % 40 }).collect();
        let time = |index: &SampleIndex| index.sample as f64 / 40.0;
        let state = |index: &SampleIndex| {
            let angle = f64::from(seed) + 2.4 * index.trajectory as f64;
            DVector::from_vec(vec![angle.cos(), angle.sin()]) * (1.5 - time(index))
        };
        let states: Vec<DVector<f64>> = indices.iter().map(state).collect();
        let velocity = |(index, x): (&SampleIndex, &DVector<f64>)| x * -gain(index.trajectory, time(index));
        let velocities: Vec<DVector<f64>> = indices.iter().zip(&states).map(velocity).collect();
        let rows = gp::Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap();
        along_movements(&Bowl, &rows)
    }

    proptest! {
        /// Speeds that fall or grow with time are found and named, even if the policy has absorbed their mean. Differences between
        /// movements are found from 5 % of the squares; noise is not.
        #[test]
        fn time_and_movement_dependence_is_found(seed in 0..1000u32, by in 0.3..0.9f64, growing: bool, little in 0.001..0.1f64) {
            let sign = if growing { 1.0 } else { -1.0 };
            let found = unexplained(movements(seed, |_, time| 1.0 + sign * by * (time - 0.4)), growing).unwrap();
            let word = if growing { "grows" } else { "falls" };
            prop_assert!(found.what.contains(word), "{}", found.what);
            let operators = |by: f64| movements(seed, move |at, _| 1.0 + by * if at % 2 == 0 { 1.0 } else { -1.0 });
            let found = unexplained(operators(by), true).unwrap();
            prop_assert!(found.what.contains("operator"), "{}", found.what);
            prop_assert!(unexplained(operators(by), false).is_none());
            prop_assert!(unexplained(operators(little), true).is_none());
            let resting = |time: f64| if time < 0.7 { 1.0 } else { 0.0 };
            let held = movements(seed, move |_, time| resting(time) + 0.1 * little);
            prop_assert!(unexplained(held, true).is_none(), "samples at rest");
            let noise = movements(seed, |at, time| 1.0 + by * (7919.0 * (at as f64 + 1.7 * time)).sin());
            prop_assert!(unexplained(noise, true).is_none());
        }
    }
}
