//! The plane of a toy system's states, with the learners' policies.

use motion::Policy;
use nalgebra::{DVector, dvector};
use plot::{Field, Layer, Plane, PlotError};

use crate::agent::TRUTH;
use crate::{Agent, rounded};

/// (x₁, x₂, u₁, u₂).
pub(super) type Arrow = (f64, f64, f64, f64);

/// A plane with both state dimensions from −`extent` to `extent`; `size` in pixels.
pub(super) fn state_plane(title: &str, extent: f64, layers: Vec<Layer>, size: (f64, f64)) -> Plane {
    let range = [-extent, extent];
    Plane {
        title: title.to_owned(),
        x_label: "x₁".to_owned(),
        y_label: "x₂".to_owned(),
        x: range,
        y: range,
        layers,
        size,
    }
}

/// A function of the state from −`extent` to `extent`, with `steps` steps to either side of 0.
pub(super) fn on_grid(extent: f64, steps: i32, value: impl Fn(&DVector<f64>) -> f64) -> Result<Field, PlotError> {
    let grid: Vec<f64> = (-steps..=steps).map(|i| extent * f64::from(i) / f64::from(steps)).collect();
    let values = grid.iter().map(|&y| grid.iter().map(|&x| value(&dvector![x, y])).collect()).collect();
    Field::new(grid.clone(), grid, values)
}

/// Number of arrows per row of the grid, and their spacing.
const ACROSS: usize = 9;
const APART: f64 = 0.45;

/// The unconstrained actions of a policy on a grid, row by row; longer ones than `longest` are shortened.
pub(super) fn actions(policy: &dyn Policy, longest: f64) -> Vec<Arrow> {
    let place = |at: usize| APART * (at as f64 - (ACROSS / 2) as f64);
    let grid = (0..ACROSS * ACROSS).map(|at| (place(at % ACROSS), place(at / ACROSS)));
    let arrow = |(x, y): (f64, f64)| {
        let action = policy.action(dvector![x, y].as_view()).cap_magnitude(longest);
        (rounded(x, 4), rounded(y, 4), rounded(action[0], 5), rounded(action[1], 5))
    };
    grid.map(arrow).collect()
}

/// Every second arrow of every second row; includes the corners of the grid and its centre.
pub(super) fn every_second(arrows: &[Arrow]) -> Vec<Arrow> {
    arrows.chunks(ACROSS).step_by(2).flat_map(|row| row.iter().step_by(2).copied()).collect()
}

/// Widths of arrows, pixels: wide and grey for the truth, and over it the learnt policy.
pub(super) const WIDTHS: [f64; 2] = [5.5, 2.0];

/// The true actions, and over them a learner's; their length corresponds to `seconds` of movement.
pub(super) fn compared(truth: &[Arrow], learnt: &[Arrow], agent: Agent, seconds: f64) -> Vec<Layer> {
    let layer = |arrows: &[Arrow], color, width| Layer::Arrows {
        arrows: every_second(arrows),
        color,
        scale: seconds,
        width,
        label: None,
    };
    vec![layer(truth, TRUTH, WIDTHS[0]), layer(learnt, agent.color(), WIDTHS[1])]
}

#[cfg(test)]
mod tests {
    use demo_gen::ToySystem;
    use motion::NegativeGradient;

    use super::*;

    #[test]
    fn every_second_arrow_keeps_the_corners_and_the_middle() {
        let all = actions(&NegativeGradient(&ToySystem::default().potential), 0.05);
        assert!(all.iter().all(|arrow| arrow.2.hypot(arrow.3) < 0.0501), "cut to the longest");
        let shown: Vec<(f64, f64)> = every_second(&all).iter().map(|arrow| (arrow.0, arrow.1)).collect();
        assert_eq!(shown.len(), 25);
        for place in [(-1.8, -1.8), (1.8, -1.8), (0.0, 0.0), (-1.8, 1.8), (1.8, 1.8)] {
            assert!(shown.contains(&place), "{place:?} is not among {shown:?}");
        }
    }
}
