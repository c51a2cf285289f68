use linalg::symmetric_eigen;
use nalgebra::DMatrix;

use super::conjugate_gradients::{add, dot};
use super::group::{Group, Parts};
use super::preconditioner::Preconditioner;
use crate::AlignError;

/// The second eigenvalue has converged when a round changes it by less than this share.
const SETTLED: f64 = 1e-6;
/// Minimum number of rounds, which reveal low eigenvectors other than the starting vectors.
const FEWEST_ROUNDS: usize = 3;
/// Maximum number of rounds. Rayleigh quotients are upper bounds after any number of rounds.
const MOST_ROUNDS: usize = 24;
/// If orthogonalisation leaves less than this share of a vector, the rest is rounding.
const DEPENDENT: f64 = 1e-8;

/// The lowest eigenvalues of the sub-matrix of H for a group, ascending, and their vectors, (K) each.
#[derive(Debug)]
pub(crate) struct Modes {
    pub(crate) values: Vec<f64>,
    pub(crate) vectors: Vec<Vec<f64>>,
}

/// Rayleigh–Ritz on the vectors of the last round, their preconditioned residuals and their last steps (Knyazev's
/// LOBPCG), starting from the constant vector and `others`, until the second eigenvalue converges.
pub(crate) fn weak_modes(
    group: &Group<'_>,
    preconditioner: &Preconditioner,
    starts: Vec<Vec<f64>>,
) -> Result<Modes, AlignError> {
    let constant = group.contains.iter().map(|&member| f64::from(u8::from(member))).collect();
    let mut basis = Vec::new();
    let wanted = starts.len() + 1;
    extend(&mut basis, [constant].into_iter().chain(starts));
    let mut scratch = Vec::new();
    let mut modes = ritz(group, &basis, wanted)?;
    for round in 1..=MOST_ROUNDS {
        let Ritz { values, vectors, images, .. } = &modes;
        let residuals: Vec<Vec<f64>> = values.iter().zip(vectors.iter().zip(images)).map(residual).collect();
        let before = values.get(1).copied();
        let corrections: Vec<Vec<f64>> = residuals
            .into_iter()
            .map(|mut residual| {
                preconditioner.apply(&mut residual, &mut scratch);
                residual
            })
            .collect();
        let mut basis = vectors.clone();
        extend(&mut basis, corrections.into_iter().chain(modes.steps));
        modes = ritz(group, &basis, wanted)?;
        let after = modes.values.get(1).copied();
        let settled = before.zip(after).is_none_or(|(before, after)| before - after <= SETTLED * after);
        if settled && round >= FEWEST_ROUNDS {
            break;
        }
    }
    Ok(Modes { values: modes.values, vectors: modes.vectors })
}

/// Ritz values and vectors, their images under the sub-matrix of H, and their parts outside the span of the first basis
/// vectors.
struct Ritz {
    values: Vec<f64>,
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    steps: Vec<Vec<f64>>,
}

fn ritz(group: &Group<'_>, basis: &[Vec<f64>], wanted: usize) -> Result<Ritz, AlignError> {
    let mut parts = Parts::default();
    let images: Vec<Vec<f64>> = basis.iter().map(|vector| image(group, vector, &mut parts)).collect();
    let projected = DMatrix::from_fn(basis.len(), basis.len(), |i, j| dot(&basis[i.max(j)], &images[i.min(j)]));
    let (values, coordinates) = symmetric_eigen(&projected).ok_or(AlignError::NoConvergence)?;
    let wanted = wanted.min(basis.len());
    let combined = |of: &[Vec<f64>], column: usize, first: usize| {
        let mut sum = vec![0.0; of[0].len()];
        (first..of.len()).for_each(|at| add(&mut sum, coordinates[(at, column)], &of[at]));
        sum
    };
    let all = |of: &[Vec<f64>], first: usize| (0..wanted).map(|column| combined(of, column, first)).collect();
    let steps = if basis.len() > wanted { all(basis, wanted) } else { Vec::new() };
    Ok(Ritz { values: values[..wanted].to_vec(), vectors: all(basis, 0), images: all(&images, 0), steps })
}

/// The sub-matrix of H times a vector: L plus the weights to the outside.
fn image(group: &Group<'_>, vector: &[f64], parts: &mut Parts) -> Vec<f64> {
    let mut image = vec![0.0; vector.len()];
    group.laplacian_times(vector, parts, &mut image);
    image.iter_mut().zip(&group.outside).zip(vector).for_each(|((image, outside), value)| *image += outside * value);
    image
}

fn residual((&value, (vector, image)): (&f64, (&Vec<f64>, &Vec<f64>))) -> Vec<f64> {
    let mut residual = image.clone();
    add(&mut residual, -value, vector);
    residual
}

/// Adds vectors to an orthonormal basis, unless they depend linearly on it.
fn extend(basis: &mut Vec<Vec<f64>>, vectors: impl Iterator<Item = Vec<f64>>) {
    for mut vector in vectors {
        let before = dot(&vector, &vector).sqrt();
        // Two passes suffice (Kahan, Parlett).
        for _ in 0..2 {
            for known in basis.iter() {
                let part = dot(known, &vector);
                add(&mut vector, -part, known);
            }
        }
        let length = dot(&vector, &vector).sqrt();
        if length > DEPENDENT * before {
            for value in &mut vector {
                *value /= length;
            }
            basis.push(vector);
        }
    }
}
