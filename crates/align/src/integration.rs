use motion::{Demonstrations, Trajectory};
use nalgebra::DMatrix;

use crate::AlignError;

/// How the potential along one trajectory is found from what was recorded (5)–(9).
///
/// Wherever a constraint lets the system move, dφ = ∇φᵀdx = −uᵀdx, so that the potential falls by the work of the
/// policy along the path. Values start at φ̂₁ = 0 and have units of the state squared per second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Integration {
    /// φ̂_{i+1} = φ̂_i − ‖x_{i+1} − x_i‖² / δt (9): positions alone. Noise of variance s² on the positions looks
    /// like a steady descent of 2ns²/δt a step; with noisy states, record velocities.
    #[default]
    Displacement,
    /// φ̂_{i+1} = φ̂_i − ‖u_i‖² δt: recorded velocities or commands alone.
    Velocity,
    /// φ̂_{i+1} = φ̂_i − u_iᵀ(x_{i+1} − x_i): recorded velocities and positions.
    Work,
}

impl Integration {
    /// The values φ̂_k of every trajectory at its own samples, N_k of them.
    ///
    /// # Errors
    /// [`AlignError::NoVelocities`] or [`AlignError::PotentialOverflow`].
    pub fn potentials(self, demonstrations: &Demonstrations) -> Result<Vec<Vec<f64>>, AlignError> {
        let trajectories = demonstrations.trajectories().iter().enumerate();
        trajectories.map(|(index, trajectory)| self.along(index, trajectory)).collect()
    }

    fn along(self, index: usize, trajectory: &Trajectory) -> Result<Vec<f64>, AlignError> {
        let x = trajectory.states();
        let time_step = trajectory.time_step();
        let velocities = || trajectory.velocities().ok_or(AlignError::NoVelocities { trajectory: index });
        let values = match self {
            Integration::Displacement => descend(x, |i| squared_step(x, i) / time_step),
            Integration::Velocity => {
                let u = velocities()?;
                descend(x, |i| u.column(i).norm_squared() * time_step)
            }
            Integration::Work => {
                let u = velocities()?;
                descend(x, |i| work(x, u, i))
            }
        };
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(sample) => Err(AlignError::PotentialOverflow { trajectory: index, sample }),
        }
    }
}

/// Values that start at 0 and fall by `descent(i)` between samples i and i + 1.
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
