use motion::{Demonstrations, Trajectory};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::AlignError;

/// The rule that integrates the potential along one trajectory (5)–(9).
///
/// If u = Nπ with an orthogonal projection N, then dφ = ∇φᵀdx = −uᵀdx: the potential decreases by the work of the
/// policy along the path. Values start at φ̂₁ = 0 and have units of the state squared per second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Integration {
    /// φ̂_{i+1} = φ̂_i − ‖x_{i+1} − x_i‖² / δt_i (9): positions alone. Noise of variance s² on the positions has the
    /// effect of a steady descent of 2ns²/δt per step; with noisy states, record velocities.
    #[default]
    Displacement,
    /// φ̂_{i+1} = φ̂_i − ‖u_i‖² δt_i: recorded velocities or commands alone.
    Velocity,
    /// φ̂_{i+1} = φ̂_i − u_iᵀ(x_{i+1} − x_i): recorded velocities and positions.
    Work,
}

impl Integration {
    /// The values φ̂_k of each trajectory at its own samples, N_k of them.
    ///
    /// # Errors
    /// [`AlignError::NoVelocities`], [`AlignError::PotentialOverflow`] or [`AlignError::PotentialUnderflow`].
    pub fn potentials(self, demonstrations: &Demonstrations) -> Result<Vec<Vec<f64>>, AlignError> {
        let trajectories = demonstrations.trajectories().iter().enumerate();
        trajectories.map(|(index, trajectory)| self.along(index, trajectory)).collect()
    }

    fn along(self, index: usize, trajectory: &Trajectory) -> Result<Vec<f64>, AlignError> {
        let x = trajectory.states();
        let time_step = |i: usize| trajectory.seconds(i, i + 1);
        let velocities = || trajectory.velocities().ok_or(AlignError::NoVelocities { trajectory: index });
        let values = match self {
            Integration::Displacement => descend(x, |i| squared_step(x, i) / time_step(i)),
            Integration::Velocity => {
                let u = velocities()?;
                descend(x, |i| u.column(i).norm_squared() * time_step(i))
            }
            Integration::Work => {
                let u = velocities()?;
                descend(x, |i| work(x, u, i))
            }
        };
        if let Some(sample) = values.iter().position(|value| !value.is_finite()) {
            return Err(AlignError::PotentialOverflow { trajectory: index, sample });
        }
        let lowest = values.iter().fold(0.0_f64, |lowest, value| lowest.max(value.abs()));
        if lowest < f64::MIN_POSITIVE && self.moves(trajectory) {
            return Err(AlignError::PotentialUnderflow { trajectory: index, lowest });
        }
        Ok(values)
    }

    /// Whether the sum contains anything but 0, apart from rounding.
    fn moves(self, trajectory: &Trajectory) -> bool {
        let x = trajectory.states();
        let mut steps = (0..x.ncols() - 1).flat_map(|i| (0..x.nrows()).map(move |c| (i, c)));
        let stepped = |i, c| x[(c, i + 1)] != x[(c, i)];
        let wanted = |i, c| trajectory.velocities().is_some_and(|u| u[(c, i)] != 0.0);
        match self {
            Integration::Displacement => steps.any(|(i, c)| stepped(i, c)),
            Integration::Velocity => steps.any(|(i, c)| wanted(i, c)),
            // Orthogonal terms sum to 0.
            Integration::Work => {
                let product = |i, c| trajectory.velocities().map_or(0.0, |u| u[(c, i)] * (x[(c, i + 1)] - x[(c, i)]));
                steps.any(|(i, c)| stepped(i, c) && wanted(i, c) && product(i, c).abs() < f64::MIN_POSITIVE)
            }
        }
    }
}

/// Values that start at 0 and decrease by `descent(i)` between samples i and i + 1.
fn descend(positions: &DMatrix<f64>, descent: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut value = 0.0;
    let falls = (0..positions.ncols() - 1).map(|i| {
        value -= descent(i);
        value
    });
    std::iter::once(0.0).chain(falls).collect()
}

fn squared_step(x: &DMatrix<f64>, i: usize) -> f64 {
    x.column(i).iter().zip(x.column(i + 1).iter()).map(|(from, to)| (to - from) * (to - from)).sum()
}

fn work(x: &DMatrix<f64>, u: &DMatrix<f64>, i: usize) -> f64 {
    let (from, to) = (x.column(i), x.column(i + 1));
    from.iter().zip(to.iter()).zip(u.column(i).iter()).map(|((from, to), u)| u * (to - from)).sum()
}
