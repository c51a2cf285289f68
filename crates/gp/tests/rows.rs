//! What rows say of themselves.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gp::Rows;
use motion::SampleIndex;
use nalgebra::DMatrix;
use proptest::prelude::*;

proptest! {
    /// Euler's steps u_{i+1} = (1 − w) u_i differ from a steady flow by w/2, whatever their direction, size and number.
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
        prop_assert_eq!(rows.step_change(), None); // recorded velocities are what they are
        let change = rows.with_findings(0.1, Some(vec![vec![0.0; samples]; trajectories])).step_change().unwrap();
        prop_assert!((change - w * w / 4.0).abs() < 1e-12 * (1.0 + w), "{change} {w}");
    }
}
