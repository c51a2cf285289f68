use nalgebra::DMatrix;
use proptest::prelude::*;

use super::*;
use motion::Channel;
use motion::Source;

fn recordings(times: Vec<f64>, value: impl Fn(f64) -> f64) -> Recordings {
    let positions = DMatrix::from_iterator(1, times.len(), times.iter().map(|&t| value(t)));
    let source = Source { file: "made".to_owned(), records: None };
    let velocities = Some(positions.clone());
    let episode = Episode {
        name: "a".to_owned(),
        source,
        times: Times::Stamped(times),
        positions,
        velocities,
        constraint: None,
        context: nalgebra::DVector::zeros(0),
    };
    let state = vec![Channel { name: "x".to_owned(), unit: None }];
    Recordings { state, episodes: vec![episode], findings: vec![] }
}

#[test]
fn interpolation_matches_hand_computed_values() {
    // Slopes 46/15, 0, 0, 0 and 20/3: the series turns, stands still, and ends steeply.
    let expected = [0.0, 1.0 + 23.0 / 60.0, 2.0, 47.0 / 27.0, 34.0 / 27.0, 1.0, 1.0, 13.0 / 6.0, 5.0];
    let stamps = [0.0, 1.0, 2.5, 3.0, 4.0];
    let values = DMatrix::from_row_slice(1, 5, &[0.0, 2.0, 1.0, 1.0, 5.0]);
    let times: Vec<f64> = (0..9).map(|i| 0.5 * f64::from(i)).collect();
    let found = interpolated(&stamps, values.as_view(), &times);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

proptest! {
    #[test]
    fn interpolation_is_monotone_and_meets_the_samples(
        steps in prop::collection::vec(0.01..1.0f64, 1..30),
        values in prop::collection::vec(-5.0..5.0f64, 31),
        rate in 3.0..200.0f64,
    ) {
        let mut times = vec![0.0];
        for step in &steps {
            times.push(times[times.len() - 1] + step);
        }
        let at = |t: f64| values[times.iter().rposition(|&stamp| stamp <= t).unwrap()];
        let made = recordings(times.clone(), at);
        let duration = times[times.len() - 1];
        let found = match resampled(&made, rate) {
            Err(ResampleError::Short { .. }) => {
                prop_assert!(duration * rate < 1.0 + 1e-6);
                return Ok(());
            }
            found => found.unwrap(),
        };
        let found = &found.episodes[0];
        prop_assert_eq!(found.velocities.as_ref(), Some(&found.positions));
        let last = found.times.duration();
        prop_assert!(times[times.len() - 1] - last < 1.0 / rate && last <= times[times.len() - 1] + 1e-6);
        for (&time, x) in found.times.stamps().iter().zip(found.positions.iter()) {
            let before = times[..times.len() - 1].iter().rposition(|&stamp| stamp <= time + 1e-9).unwrap();
            let ends = [values[before], values[before + 1]];
            prop_assert!(*x >= ends[0].min(ends[1]) - 1e-9 && *x <= ends[0].max(ends[1]) + 1e-9);
        }
        let again = interpolated(&times, made.episodes[0].positions.as_view(), &times);
        prop_assert!((again - &made.episodes[0].positions).amax() < 1e-12);
    }

    #[test]
    fn straight_lines_stay(rate in 2.0..100.0f64, slope in -3.0..3.0f64, start in 0.0..9.0f64) {
        let times = [0.0, 0.1, 0.35, 0.4, 1.0].map(|t| start + t).to_vec();
        let found = resampled(&recordings(times, |t| slope * (t - start)), rate).unwrap();
        for (time, x) in found.episodes[0].times.stamps().iter().zip(found.episodes[0].positions.iter()) {
            prop_assert!((x - slope * time).abs() < 1e-12);
        }
    }
}

#[test]
fn rates_that_make_no_movement_are_refused() {
    let made = recordings(vec![0.0, 0.5, 1.0], |t| t);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(resampled(&made, rate), Err(ResampleError::Rate { .. })), "{rate}");
    }
    assert!(matches!(resampled(&made, 0.9), Err(ResampleError::Short { .. })));
    assert!(matches!(resampled(&made, 1e12), Err(ResampleError::Many { .. })));
    assert_eq!(resampled(&made, 1.0).unwrap().episodes[0].times.stamps()[..], [0.0, 1.0]);
    // 30 steps of a tenth of a second with rounded stamps.
    let tenths = recordings((0..=30).map(|i| f64::from(i) * 0.1).collect(), |t| t);
    assert_eq!(resampled(&tenths, 10.0).unwrap().episodes[0].times.len(), 31);
}
