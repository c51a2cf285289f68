//! Quadratic functions, and how movements cross their level sets: (S46).

use gp::Rows;
use motion::upper_median;
use nalgebra::{Cholesky, DMatrix, DVector, DVectorView};

use super::some_of;

/// Largest number of rows.
const ROWS: usize = 3000;
/// Number of parts for cross-validation over movements.
pub(super) const PARTS: usize = 5;

/// Functions s(z) = bᵀz + ½ zᵀCz of states z = (x − mean)/spread, with statistics of how movements cross their level sets.
pub(super) struct Quadratics {
    pub(super) mean: DVector<f64>,
    pub(super) spread: f64,
    /// For each movement, Σ w(∇s·û)² and Σ w|∇s|²/n as quadratic forms of the coefficients.
    movements: Vec<[DMatrix<f64>; 2]>,
}

/// One of these functions.
pub(super) struct Quadratic {
    /// b, (n).
    pub(super) slope: DVector<f64>,
    /// C, (n, n).
    pub(super) curvature: DMatrix<f64>,
}

impl Quadratics {
    /// Statistics of the moving rows; `None` without any.
    pub(super) fn of(rows: &Rows, n: usize) -> Option<Quadratics> {
        let chosen = some_of(rows.len(), ROWS);
        let states = rows.states().rows(0, n).select_columns(&chosen);
        let mean = states.column_mean();
        let squares: f64 = states.column_iter().map(|x| (x - &mean).norm_squared()).sum();
        let spread = (squares / (n * chosen.len()) as f64).sqrt();
        let speed = |&row: &usize| rows.velocities().column(row).norm();
        let usual = upper_median(chosen.iter().map(speed).filter(|&speed| speed > 0.0).collect())?;
        let count = rows.indices().iter().map(|index| index.trajectory).max()? + 1;
        let coefficients = n + n * (n + 1) / 2;
        let zero = || [DMatrix::zeros(coefficients, coefficients), DMatrix::zeros(coefficients, coefficients)];
        let mut movements: Vec<_> = (0..count).map(|_| zero()).collect();
        for (row, x) in chosen.iter().zip(states.column_iter()) {
            let velocity = rows.velocities().column(*row);
            let Some(direction) = velocity.try_normalize(0.0) else { continue };
            // Noise changes the directions of slow velocities.
            let weight = (velocity.norm() / usual).min(1.0).powi(2);
            let gradients = gradients(((x - &mean) / spread).as_view());
            let [across, all] = &mut movements[rows.indices()[*row].trajectory];
            across.syger(weight, &(&gradients * &direction), &(&gradients * direction), 1.0);
            all.gemm(weight / n as f64, &gradients, &gradients.transpose(), 1.0);
        }
        for [across, _] in &mut movements {
            across.fill_upper_triangle_with_lower_triangle();
        }
        movements.retain(|[_, all]| all.trace() > 0.0);
        Some(Quadratics { mean, spread, movements })
    }

    /// (S46): Σ w(∇s·û)²/(Σ w|∇s|²/n) of left-out movements, for the function that the others cross least; 1 if they go in all directions
    /// equally. `None` with fewer movements than parts.
    pub(super) fn coverage(&self) -> Option<f64> {
        if self.movements.len() < PARTS {
            return None;
        }
        let [mut across, mut all] = [0.0, 0.0];
        for part in 0..PARTS {
            let is_out = |&(at, _): &(usize, _)| at % PARTS == part;
            let others = self.movements.iter().enumerate().filter(|movement| !is_out(movement));
            let function = least_crossed(others.map(|(_, movement)| movement))?;
            for (_, [crossed, gradients]) in self.movements.iter().enumerate().filter(is_out) {
                across += function.dot(&(crossed * &function));
                all += function.dot(&(gradients * &function));
            }
        }
        Some(across / all)
    }

    /// The function that all movements together cross least.
    pub(super) fn least_crossed(&self) -> Option<Quadratic> {
        let (n, function) = (self.mean.len(), least_crossed(self.movements.iter())?);
        let mut curvature = DMatrix::zeros(n, n);
        for (k, (i, j)) in pairs(n).enumerate() {
            let second = function[n + k] * if i == j { 2.0 } else { 1.0 };
            curvature[(i, j)] = second;
            curvature[(j, i)] = second;
        }
        Some(Quadratic { slope: function.rows(0, n).into_owned(), curvature })
    }
}

/// Index pairs i ≤ j of the products of coordinates, in order.
fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)))
}

/// Gradients of z_i, then of z_i z_j, i ≤ j, at a state z (n): one per row, (n + n(n+1)/2, n).
fn gradients(z: DVectorView<'_, f64>) -> DMatrix<f64> {
    let n = z.len();
    let mut gradients = DMatrix::zeros(n + n * (n + 1) / 2, n);
    gradients.view_mut((0, 0), (n, n)).fill_with_identity();
    for (k, (i, j)) in pairs(n).enumerate() {
        gradients[(n + k, i)] += z[j];
        gradients[(n + k, j)] += z[i];
    }
    gradients
}

/// Coefficients of the function with the least Σ w(∇s·û)² over Σ w|∇s|²; its gradient has mean square n.
fn least_crossed<'a>(movements: impl Iterator<Item = &'a [DMatrix<f64>; 2]>) -> Option<DVector<f64>> {
    let [across, all] = movements.fold(None, |sums: Option<[DMatrix<f64>; 2]>, [across, all]| {
        Some(sums.map_or_else(|| [across.clone(), all.clone()], |[a, b]| [a + across, b + all]))
    })?;
    let size = all.nrows();
    let jitter = 1e-9 * all.trace() / size as f64;
    let factor = Cholesky::new(all + DMatrix::identity(size, size) * jitter)?;
    let lower = factor.l();
    let left = lower.solve_lower_triangular(&across)?;
    let whitened = lower.solve_lower_triangular(&left.transpose())?;
    // Velocities may overflow when squared, and the eigenvalue search does not end on non-finite values.
    if whitened.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let eigen = ((&whitened + whitened.transpose()) / 2.0).symmetric_eigen();
    lower.tr_solve_lower_triangular(&eigen.eigenvectors.column(eigen.eigenvalues.imin()))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Compares ∇s with finite differences, and the coverage of a function with its definition.
    #[test]
    fn gradients_are_those_of_the_function() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let value = |z: &DVector<f64>, c: &DVector<f64>| {
            let squares = pairs(3).map(|(i, j)| z[i] * z[j]);
            z.iter().copied().chain(squares).zip(c.iter()).map(|(term, c)| term * c).sum::<f64>()
        };
        let mut any_vector = |n: usize| DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0f64));
        let (z, c) = (any_vector(3), any_vector(9));
        let gradient = gradients(z.as_view()).transpose() * &c;
        for k in 0..3 {
            let mut step = DVector::zeros(3);
            step[k] = 1e-6;
            let slope = (value(&(&z + &step), &c) - value(&(&z - &step), &c)) / 2e-6;
            assert!((slope - gradient[k]).abs() < 1e-8);
        }
    }
}
