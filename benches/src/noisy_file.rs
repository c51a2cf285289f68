use std::io::{self, Write};

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Three Gaussian wells in a bowl, in d dimensions: the policy is the negative gradient of 0.15‖x‖² − Σ_k h_k e^{−‖x − c_k‖²/2w²}.
#[derive(Debug)]
pub struct Wells {
    centres: Vec<DVector<f64>>,
    depths: Vec<f64>,
}

/// w², and twice the height of the bowl at distance 1.
const WIDTH: f64 = 0.64;
const BOWL: f64 = 0.3;

const STATES: usize = 500;

impl Wells {
    /// Wells within [−1, 1)ⁿ.
    pub fn new(seed: u64, dim: usize) -> Wells {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let centres = (0..3).map(|_| DVector::from_fn(dim, |_, _| rng.random_range(-1.0..1.0))).collect();
        Wells { centres, depths: (0..3).map(|_| rng.random_range(0.5..1.5)).collect() }
    }

    /// π(x), (n), in units of the state per second.
    pub fn action(&self, x: &DVector<f64>) -> DVector<f64> {
        let wells = self.centres.iter().zip(&self.depths).map(|(centre, depth)| {
            let apart = x - centre;
            let slope = depth / WIDTH * (-0.5 * apart.norm_squared() / WIDTH).exp();
            apart * -slope
        });
        wells.fold(x * -BOWL, |sum, well| sum + well)
    }

    /// Test states, uniform in [−1.5, 1.5)ⁿ, and π(x) there: (n, 500) each.
    pub fn truth(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let states = DMatrix::from_fn(self.centres[0].len(), STATES, |_, _| rng.random_range(-1.5..1.5));
        let actions: Vec<_> = states.column_iter().map(|state| self.action(&state.into_owned())).collect();
        (states, DMatrix::from_columns(&actions))
    }
}

/// Writes movements of `samples` samples, 50 per second, as CSV with velocities. Starts are uniform in [−2, 2)ⁿ; each movement is
/// constrained to a random plane through its start. Velocities have normal noise with this share of their root mean square.
///
/// # Errors
/// Those of the file.
pub fn write_noisy(
    out: &mut dyn Write,
    wells: &Wells,
    (movements, samples): (usize, usize),
    noise: f64,
    seed: u64,
) -> io::Result<()> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let dim = wells.centres[0].len();
    let names = |letter: char| (1..=dim).map(|k| format!("{letter}{k}")).collect::<Vec<_>>().join(",");
    writeln!(out, "episode,t,{},{}", names('x'), names('v'))?;
    for movement in 0..movements {
        let mut x = DVector::from_fn(dim, |_, _| rng.random_range(-2.0..2.0));
        let normal = DVector::from_fn(dim, |_, _| rng.sample::<f64, _>(StandardNormal)).normalize();
        let mut rows = Vec::with_capacity(samples);
        for _ in 0..samples {
            let wanted = wells.action(&x);
            let velocity = &wanted - &normal * normal.dot(&wanted);
            rows.push((x.clone(), velocity.clone()));
            x += velocity * 0.02;
        }
        let power: f64 = rows.iter().map(|(_, velocity)| velocity.norm_squared()).sum();
        let deviation = noise * (power / (samples * dim) as f64).sqrt();
        for (sample, (x, velocity)) in rows.iter().enumerate() {
            write!(out, "{movement},{:.2}", sample as f64 * 0.02)?;
            x.iter().try_for_each(|x| write!(out, ",{x:.9}"))?;
            velocity
                .iter()
                .try_for_each(|v| write!(out, ",{:.9}", v + deviation * rng.sample::<f64, _>(StandardNormal)))?;
            writeln!(out)?;
        }
    }
    Ok(())
}
