use motion::Trajectory;
use nalgebra::DVectorView;

/// The potential of one trajectory, known up to a constant along its path; elsewhere it is that of the nearest sample
/// (10).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalPotential<'a> {
    trajectory: &'a Trajectory,
    values: &'a [f64],
}

impl<'a> LocalPotential<'a> {
    pub(crate) fn new(trajectory: &'a Trajectory, values: &'a [f64]) -> Self {
        LocalPotential { trajectory, values }
    }

    /// The trajectory.
    pub fn trajectory(&self) -> &'a Trajectory {
        self.trajectory
    }

    /// φ̂ at the trajectory's samples, N of them, in units of the state squared per second; the first is 0.
    pub fn values(&self) -> &'a [f64] {
        self.values
    }

    /// f(x) = φ̂ at the nearest sample (10), in units of the state squared per second.
    ///
    /// # Panics
    /// If the dimension of the state differs from that of the trajectory.
    pub fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        self.values[self.nearest(state).0]
    }

    /// Index and squared distance of the nearest sample; the lowest index among equally near ones.
    ///
    /// # Panics
    /// If the dimension of the state differs from that of the trajectory.
    pub fn nearest(&self, state: DVectorView<'_, f64>) -> (usize, f64) {
        assert_eq!(state.len(), self.trajectory.dim(), "a state has as many dimensions as the trajectory");
        let distance = |sample| {
            let other = self.trajectory.state(sample);
            state.iter().zip(other.iter()).map(|(x, y)| (x - y) * (x - y)).sum::<f64>()
        };
        let nearer = |best: (usize, f64), sample| {
            let distance = distance(sample);
            if distance < best.1 { (sample, distance) } else { best }
        };
        (1..self.values.len()).fold((0, distance(0)), nearer)
    }
}
