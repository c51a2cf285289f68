//! The samples of one movement, projected onto a task space.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, DVector, DVectorView};

use crate::rows::task_space::TaskSpace;
use crate::stretches::segmentation::PrefixSums;

/// Number of samples that share one error of the policy, because the policy is smooth.
pub(super) const SHARED: f64 = 4.0;

/// Disagreement d = π̂ − u between the policy and a movement, weighted by its variance.
pub(super) struct Disagreement {
    /// (n, N).
    pub(super) of: DMatrix<f64>,
    /// Inverse variance of a component, (N).
    pub(super) weights: Vec<f64>,
    /// s², the variance of a component of u.
    pub(super) noise: f64,
    /// Σ w |d|² over the first samples, (N + 1).
    squares: Vec<f64>,
    /// Σ log 1/(w s²), likewise: the precision of velocities relative to the policy.
    accidents: Vec<f64>,
}

impl Disagreement {
    pub(super) fn new(of: DMatrix<f64>, weights: Vec<f64>, noise: f64) -> Self {
        let (mut squares, mut accidents) = (vec![0.0], vec![0.0]);
        for (at, (d, weight)) in of.column_iter().zip(&weights).enumerate() {
            squares.push(squares[at] + weight * d.norm_squared());
            accidents.push(accidents[at] - (weight * noise).ln());
        }
        Disagreement { of, weights, noise, squares, accidents }
    }

    /// Σ w |d|² over `begin..end`: minus twice the log likelihood of no constraint.
    pub(super) fn square(&self, begin: usize, end: usize) -> f64 {
        self.squares[end] - self.squares[begin]
    }

    /// Σ w |d|² of all samples.
    pub(super) fn total(&self) -> f64 {
        self.squares.last().copied().unwrap_or(0.0)
    }

    /// Twice the log likelihood ratio by which an exactly constant velocity is unlikely by chance, counted once for each
    /// independent error of the policy.
    pub(super) fn accident(&self, begin: usize, end: usize) -> f64 {
        (self.accidents[end] - self.accidents[begin]) / SHARED
    }
}

/// Velocities v = Ju and the solutions y of Jᵀy = d, in the directions in which the space moves.
pub(super) struct ProjectedSamples {
    /// Directions in which the space moves, (M, m).
    pub(super) basis: DMatrix<f64>,
    /// v, (m, N).
    velocities: DMatrix<f64>,
    /// Jd, (m, N).
    disagreements: DMatrix<f64>,
    /// JJᵀ of each sample, (m, m); `None` if it is I.
    grams: Option<Vec<DMatrix<f64>>>,
    scatters: PrefixSums,
    /// Cumulative sums over the samples.
    sums: Vec<Sums>,
}

#[derive(Clone)]
struct Sums {
    /// Σ w y yᵀ.
    multipliers: DMatrix<f64>,
    /// Σ tr JJᵀ / m.
    gain: f64,
    /// Anisotropic contribution of noise to Σ v vᵀ, in units of s², and to `multipliers`.
    noise: (DMatrix<f64>, DMatrix<f64>),
}

/// Directions (m, m) of a task space, sorted by their similarity to rows of A over some samples, with the eigenvalues that
/// measure it: (S26).
pub(super) struct Directions {
    pub(super) values: Vec<f64>,
    pub(super) vectors: DMatrix<f64>,
}

impl Directions {
    /// The first `rank` directions, (m, k).
    pub(super) fn first(&self, rank: usize) -> DMatrix<f64> {
        self.vectors.columns(0, rank).into_owned()
    }

    /// Standard deviation of the angle between a row among the first `rank` and their true span (S29), from the curvature of the
    /// cost as the row turns towards each other direction.
    pub(super) fn angle(&self, rank: usize) -> f64 {
        let of_row =
            |row: &f64| self.values[rank..].iter().map(|other| 1.0 / (other - row).max(f64::MIN_POSITIVE)).sum();
        self.values[..rank].iter().map(of_row).fold(0.0, f64::max).sqrt().min(FRAC_PI_2)
    }
}

impl ProjectedSamples {
    /// Some rows projected onto a space; if `still`, constraints have b = 0. `velocities` (n, N) belong to these rows.
    pub(super) fn of(
        space: &TaskSpace,
        basis: &DMatrix<f64>,
        rows: &[usize],
        velocities: &DMatrix<f64>,
        disagreement: &Disagreement,
        still: bool,
    ) -> ProjectedSamples {
        match &space.jacobians {
            None => ProjectedSamples::summed(
                basis.clone(),
                (velocities.clone(), disagreement.of.clone()),
                None,
                disagreement,
                still,
            ),
            Some(jacobians) => {
                let own: Vec<DMatrix<f64>> = rows.iter().map(|&row| basis.tr_mul(&jacobians[row])).collect();
                let through = |of: &DMatrix<f64>| {
                    let columns: Vec<DVector<f64>> =
                        own.iter().zip(of.column_iter()).map(|(j, column)| j * column).collect();
                    DMatrix::from_columns(&columns)
                };
                let grams = own.iter().map(|j| j * j.transpose()).collect();
                let (velocities, disagreements) = (through(velocities), through(&disagreement.of));
                ProjectedSamples::summed(basis.clone(), (velocities, disagreements), Some(grams), disagreement, still)
            }
        }
    }

    fn summed(
        basis: DMatrix<f64>,
        (velocities, disagreements): (DMatrix<f64>, DMatrix<f64>),
        grams: Option<Vec<DMatrix<f64>>>,
        disagreement: &Disagreement,
        still: bool,
    ) -> ProjectedSamples {
        let m = basis.ncols();
        let zero = DMatrix::zeros(m, m);
        let mut sums = vec![Sums { multipliers: zero.clone(), gain: 0.0, noise: (zero.clone(), zero) }];
        for at in 0..velocities.ncols() {
            let Sums { mut multipliers, mut gain, mut noise } = sums[at].clone();
            let gram = grams.as_ref().map(|grams| &grams[at]);
            let (multiplier, inverse) = multiplier(gram, disagreements.column(at));
            if let (Some(gram), Some(inverse)) = (gram, inverse) {
                noise.0 += gram;
                noise.1 += inverse * (disagreement.weights[at] * disagreement.noise);
            }
            multipliers.ger(disagreement.weights[at], &multiplier, &multiplier, 1.0);
            gain += gram.map_or(1.0, |gram| gram.trace() / m as f64);
            sums.push(Sums { multipliers, gain, noise });
        }
        let scatters = if still { PrefixSums::about_zero(&velocities) } else { PrefixSums::of(&velocities) };
        ProjectedSamples { basis, velocities, disagreements, grams, scatters, sums }
    }

    /// Whether v = u. Then the sum of [`ProjectedSamples::change`] and [`Disagreement::square`] is the minimum of a sum of squares.
    pub(super) fn is_recorded(&self) -> bool {
        self.grams.is_none()
    }

    /// Σ |v − mean v|² of all samples, or Σ |v|².
    pub(super) fn variation(&self) -> f64 {
        self.scatters.total()
    }

    /// Eigenvectors of C/gs² − gY (S26) over `begin..end`, the least eigenvalue first. Along a row of A the velocity is constant
    /// or 0, and much of the policy is blocked.
    pub(super) fn directions(&self, begin: usize, end: usize, noise: f64) -> Directions {
        let (from, to) = (&self.sums[begin], &self.sums[end]);
        let count = (end - begin) as f64;
        let gain = (to.gain - from.gain) / count;
        let mut matrix =
            self.scatters.scatter(begin, end) / (gain * noise) - (&to.multipliers - &from.multipliers) * gain;
        if self.grams.is_some() {
            let freedom = if self.scatters.is_about_zero() { count } else { count - 1.0 };
            matrix -= (&to.noise.0 - &from.noise.0) * (freedom / (count * gain));
            matrix += (&to.noise.1 - &from.noise.1) * gain;
        }
        let eigen = matrix.symmetric_eigen();
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        Directions {
            values: order.iter().map(|&k| eigen.eigenvalues[k]).collect(),
            vectors: eigen.eigenvectors.select_columns(&order),
        }
    }

    /// (S27): change of minus twice the log likelihood from no constraint to one of this rank along the first directions.
    pub(super) fn change(
        &self,
        (begin, end): (usize, usize),
        directions: &Directions,
        rank: usize,
        disagreement: &Disagreement,
    ) -> f64 {
        let Some(grams) = &self.grams else { return directions.values[..rank].iter().sum() };
        let rows = &directions.first(rank);
        let along = |of: &DMatrix<f64>| rows.tr_mul(&of.columns(begin, end - begin));
        let (velocities, wanted) = (along(&self.velocities), along(&self.disagreements));
        let mean = if self.scatters.is_about_zero() { DVector::zeros(rank) } else { velocities.column_mean() };
        let of_sample = |at: usize| {
            let gram = rows.tr_mul(&(&grams[begin + at] * rows));
            let Some(inverse) = gram.try_inverse() else { return 0.0 };
            let (varies, wants) = (velocities.column(at) - &mean, wanted.column(at));
            let noise = varies.dot(&(&inverse * &varies)) / disagreement.noise;
            noise - disagreement.weights[begin + at] * wants.dot(&(&inverse * wants))
        };
        (0..end - begin).map(of_sample).sum()
    }

    /// Remaining |Nd|² of a sample under a constraint with these rows of A, given as columns (m, k).
    pub(super) fn left(&self, at: usize, rows: &DMatrix<f64>, disagreement: &Disagreement) -> f64 {
        let wants = rows.tr_mul(&self.disagreements.column(at));
        let taken = match &self.grams {
            None => wants.norm_squared(),
            Some(grams) => {
                let gram = rows.tr_mul(&(&grams[at] * rows));
                gram.try_inverse().map_or(0.0, |inverse| wants.dot(&(inverse * &wants)))
            }
        };
        (disagreement.of.column(at).norm_squared() - taken).max(0.0)
    }
}

/// The shortest y with JJᵀ y = Jd, and (JJᵀ)⁺.
fn multiplier(gram: Option<&DMatrix<f64>>, wanted: DVectorView<'_, f64>) -> (DVector<f64>, Option<DMatrix<f64>>) {
    let inverse =
        gram.and_then(|gram| gram.clone().pseudo_inverse(SINGULAR * gram.trace().max(f64::MIN_POSITIVE)).ok());
    (inverse.as_ref().map_or_else(|| wanted.into_owned(), |inverse| inverse * wanted), inverse)
}

/// Share of the trace of JJᵀ below which an eigenvalue counts as 0.
const SINGULAR: f64 = 1e-9;
