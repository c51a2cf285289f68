//! Properties that rows report.

use gp::{FrontEnd, Rows};
use motion::{Demonstrations, SampleIndex, Trajectory};
use nalgebra::DMatrix;
use proptest::prelude::*;

proptest! {
    /// Euler steps u_{i+1} = (1 − w) u_i differ from a steady flow by w/2, whatever their direction, size and number.
    #[test]
    fn steps_differ_from_a_flow_by_half_their_change(
        w in 0.0..0.9f64,
        speed in -3.0..3.0f64,
        (dim, trajectories, samples) in (1usize..5, 1usize..4, 2usize..12),
        first in prop::collection::vec(0.1..1.0f64, 20),
    ) {
        let at = |column: usize| SampleIndex { trajectory: column / samples, sample: column % samples };
        let velocities = DMatrix::from_fn(dim, trajectories * samples, |row, column| {
            let SampleIndex { trajectory, sample } = at(column);
            10f64.powf(speed) * first[dim * trajectory + row] * (1.0 - w).powi(i32::try_from(sample).unwrap())
        });
        let states = velocities.map(|u| 2.0 * u);
        let indices: Vec<SampleIndex> = (0..velocities.ncols()).map(at).collect();
        let rows = Rows::new(states, velocities, indices).unwrap();
        prop_assert_eq!(rows.step_change(), None); // recorded velocities have no step change
        let change = rows.with_findings(0.1, Some(vec![vec![0.0; samples]; trajectories])).step_change().unwrap();
        prop_assert!((change - w * w / 4.0).abs() < 1e-12 * (1.0 + w), "{change} {w}");
    }
}

/// Smooth velocities are exact, alternating ones have the variance that third differences show. Positions alone also count as exact; the
/// absence of velocities is an error of [`FrontEnd::rows`].
#[test]
fn recorded_velocities_come_with_their_noise() {
    let of = |ripple: f64| {
        let velocities = DMatrix::from_fn(2, 100, |axis, at| {
            (0.01 * at as f64 + axis as f64).cos() + if at % 2 == 0 { ripple } else { -ripple }
        });
        let movement = Trajectory::new(DMatrix::zeros(2, 100), 0.1).unwrap().with_velocities(velocities).unwrap();
        FrontEnd::of_velocities(&Demonstrations::new(vec![movement]).unwrap())
    };
    assert_eq!(of(0.0), FrontEnd::Velocities);
    let FrontEnd::NoisyVelocities { variance } = of(0.1) else { panic!("noise was not seen") };
    // Third differences of an alternating signal are 8 times the signal.
    let deviation = 1.4826 * 0.8 / 20f64.sqrt();
    assert!((variance / (deviation * deviation) - 1.0).abs() < 1e-3, "{variance}");
    let bare = Demonstrations::new(vec![Trajectory::new(DMatrix::zeros(2, 100), 0.1).unwrap()]).unwrap();
    assert_eq!(FrontEnd::of_velocities(&bare), FrontEnd::Velocities);
    assert!(FrontEnd::Velocities.rows(&bare).is_err());
}
