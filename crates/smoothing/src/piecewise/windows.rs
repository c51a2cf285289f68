//! Statistics of every window that are independent of the noise.

use std::borrow::Cow;

use crate::piecewise::polynomials::OrthonormalPolynomials;
use crate::piecewise::scaled::ScaledMovement;

/// Upper bound (exclusive) of the degrees of a window.
pub(crate) const MAX_COLUMNS: usize = 8;

/// A window of 2 or more samples; neighbouring windows do not overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) first: usize,
    pub(crate) samples: usize,
}

/// Squares in (S15), summed over the axes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Energy {
    /// Σ y² over the window.
    pub(crate) total: f64,
    /// Σ_j c_kj² for every degree k.
    pub(crate) of_degree: [f64; MAX_COLUMNS],
}

/// Polynomials for evenly spaced windows, by number of samples; they are the same for every trajectory and time step.
#[derive(Debug)]
pub(crate) struct Bases {
    columns: usize,
    even: Vec<OrthonormalPolynomials>,
}

impl Bases {
    /// Polynomials for windows of up to `longest` samples and degrees below `columns`.
    pub(crate) fn new(longest: usize, columns: usize) -> Self {
        Bases { columns, even: (2..=longest).map(|samples| OrthonormalPolynomials::even(samples, columns)).collect() }
    }

    /// The polynomials for a window's times.
    pub(crate) fn of(&self, movement: &ScaledMovement<'_>, window: Window) -> Cow<'_, OrthonormalPolynomials> {
        match movement.recorded.times() {
            None => Cow::Borrowed(&self.even[window.samples - 2]),
            Some(times) => {
                Cow::Owned(OrthonormalPolynomials::at(&times[window.first..][..window.samples], self.columns))
            }
        }
    }
}

/// The energies of all windows of a movement, in the order of [`windows`].
pub(crate) fn energies(movement: &ScaledMovement<'_>, bases: &Bases, longest: usize) -> Vec<Energy> {
    let dim = movement.dim;
    let squares: Vec<f64> = movement.rows.chunks_exact(dim).map(|y| y.iter().map(|y| y * y).sum()).collect();
    let mut coefficients = Vec::new();
    windows(movement.n_samples(), longest)
        .map(|window| {
            bases.of(movement, window).project(movement.window(window.first, window.samples), dim, &mut coefficients);
            let mut energy =
                Energy { total: squares[window.first..][..window.samples].iter().sum(), ..Energy::default() };
            for (energy, c) in energy.of_degree.iter_mut().zip(coefficients.chunks_exact(dim)) {
                *energy = c.iter().map(|c| c * c).sum();
            }
            energy
        })
        .collect()
}

/// All windows of 2 to `longest` samples among `n_samples`: by first sample, then by length.
pub(crate) fn windows(n_samples: usize, longest: usize) -> impl Iterator<Item = Window> {
    (0..n_samples)
        .flat_map(move |first| (2..=longest.min(n_samples - first)).map(move |samples| Window { first, samples }))
}
