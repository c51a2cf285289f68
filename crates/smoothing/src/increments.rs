use motion::Trajectory;
use nalgebra::{DMatrix, DMatrixView};
use serde::Serialize;

/// Rules that compute a step Δ_i from one sample to the next from the velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum StepRule {
    /// v_i δt: the simulator's own rule, exact for commands that are held until the next sample.
    Euler,
    /// The mean of the velocities at both ends, times δt.
    Trapezoid,
    /// A cubic through four velocities, (−v_{i−1} + 13v_i + 13v_{i+1} − v_{i+2})/24 · δt; at the ends a parabola through
    /// three, (5v_1 + 8v_2 − v_3)/12 · δt. Movements of two samples use the trapezoid.
    Cubic,
}

impl std::fmt::Display for StepRule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            StepRule::Euler => "Euler",
            StepRule::Trapezoid => "trapezoid",
            StepRule::Cubic => "cubic",
        })
    }
}

impl StepRule {
    /// Steps Δ_1 … Δ_{N−1}, (n, N − 1), of a movement with these velocities (n, N).
    pub(crate) fn steps(self, movement: &Trajectory, velocities: &DMatrix<f64>) -> DMatrix<f64> {
        let n = velocities.ncols();
        let mut steps = DMatrix::zeros(velocities.nrows(), n - 1);
        for (i, mut step) in steps.column_iter_mut().enumerate() {
            let (from, weights): (usize, &[f64]) = match self {
                StepRule::Euler => (i, &[1.0]),
                StepRule::Trapezoid => (i, &[0.5, 0.5]),
                StepRule::Cubic if n == 2 => (i, &[0.5, 0.5]),
                StepRule::Cubic if i == 0 => (0, &[5.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0]),
                StepRule::Cubic if i == n - 2 => (n - 3, &[-1.0 / 12.0, 8.0 / 12.0, 5.0 / 12.0]),
                StepRule::Cubic => (i - 1, &[-1.0 / 24.0, 13.0 / 24.0, 13.0 / 24.0, -1.0 / 24.0]),
            };
            let around: DMatrixView<'_, f64> = velocities.columns(from, weights.len());
            for (velocity, weight) in around.column_iter().zip(weights) {
                step.axpy(weight * movement.seconds(i, i + 1), &velocity, 1.0);
            }
        }
        steps
    }
}
