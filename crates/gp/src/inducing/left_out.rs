//! Leave-one-trajectory-out prediction of a model conditioned on all rows through inducing rows, in closed form (S36).

use linalg::{Factor, subtract_gram, subtract_outer};
use nalgebra::{DMatrix, DMatrixView};
use rayon::prelude::*;

use crate::inducing::features::Features;
use crate::inducing::spectrum::Spectrum;
use crate::kernel::covariance::Covariance;
use crate::left_out::LeftOutPredictions;

/// Number of rows whose features are in memory together.
const TOGETHER: usize = 2048;

/// A spectrum at a noise level, including floors.
pub(crate) struct Leaving<'a, C> {
    pub(crate) features: &'a Features<'a, C>,
    pub(crate) spectrum: &'a Spectrum,
    /// κσ², with which the policy is conditioned.
    pub(crate) noise: f64,
    /// σ², the noise of the rows.
    pub(crate) own: f64,
    /// From [`Spectrum::coefficients`].
    pub(crate) coefficients: &'a DMatrix<f64>,
}

/// Groups of rows, with ΦV of each if it is computed once for several noise levels.
pub(crate) struct Groups<'a> {
    pub(crate) rows: Vec<&'a [usize]>,
    products: Option<Vec<DMatrix<f64>>>,
}

impl<'a> Groups<'a> {
    pub(crate) fn new(rows: Vec<&'a [usize]>) -> Self {
        Groups { rows, products: None }
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.rows.iter().map(|rows| rows.len()).sum()
    }

    /// Stores ΦV of every row: m numbers each.
    pub(crate) fn with_products<C: Covariance>(self, features: &Features<'_, C>, spectrum: &Spectrum) -> Self {
        let products = self.rows.par_iter().map(|rows| features.times(rows, &spectrum.w)).collect();
        Groups { products: Some(products), ..self }
    }
}

/// Residuals and variances of one group, in the units of its rows.
type Group = (DMatrix<f64>, Vec<f64>);
/// ΦV of the rows of a group, if stored.
type Products<'a> = Option<&'a DMatrix<f64>>;

impl<C: Covariance> Leaving<'_, C> {
    /// Predicts each of these groups without itself; results are in the order of their rows. `spread` is Σ w|y|² of these rows,
    /// about the prediction without a model. Costs min(m, n_t) n_t m per group, with all features computed once, or twice for long
    /// groups.
    pub(crate) fn each(&self, groups: &Groups<'_>, spread: f64) -> Option<LeftOutPredictions> {
        let products = |at: usize| groups.products.as_ref().map(|products| &products[at]);
        let group = |(at, rows): (usize, &&[usize])| self.group(rows, products(at));
        let each: Vec<Group> = groups.rows.par_iter().enumerate().map(group).collect::<Option<_>>()?;
        let rows: Vec<usize> = groups.rows.concat();
        let targets = self.features.targets.values.ncols();
        let (mut residuals, mut variances) = (DMatrix::zeros(rows.len(), targets), Vec::with_capacity(rows.len()));
        for (errors, of) in each {
            residuals.rows_mut(variances.len(), of.len()).copy_from(&errors);
            variances.extend(of);
        }
        let weights: Vec<f64> = rows.iter().map(|&row| self.features.targets.noise_weights[row]).collect();
        LeftOutPredictions::of(residuals, variances, &weights, spread)
    }

    fn group(&self, rows: &[usize], products: Products<'_>) -> Option<Group> {
        let few = rows.len() <= self.spectrum.singular.len().min(TOGETHER);
        let (mut residuals, mut variances) = if few { self.few(rows, products) } else { self.many(rows, products) }?;
        for (at, &row) in rows.iter().enumerate() {
            let weight = self.features.targets.noise_weights[row];
            residuals.row_mut(at).scale_mut(weight.sqrt());
            variances[at] *= weight;
        }
        Some((residuals, variances))
    }

    /// By I − H_tt, (n_t, n_t).
    fn few(&self, rows: &[usize], products: Products<'_>) -> Option<Group> {
        let (mut errors, known, b) = self.own(rows, products.map(DMatrix::as_view));
        let mut rest = DMatrix::identity(rows.len(), rows.len());
        subtract_outer(&mut rest, &b);
        let factor = Factor::new(rest)?;
        factor.solve(&mut errors);
        let inverse = factor.inverse_triangle();
        let squares = inverse.column_iter().map(|column| column.norm_squared());
        let biases = self.biases(b, |b| factor.solve(b));
        let each = squares.zip(biases).enumerate();
        let variances = each.map(|(at, of)| self.variance(of) + self.unknown(rows[at], known[at])).collect();
        Some((errors, variances))
    }

    /// By I − BᵀB, (m, m), with Woodbury's identity: (I − BBᵀ)⁻¹ = I + B (I − BᵀB)⁻¹ Bᵀ.
    fn many(&self, rows: &[usize], products: Products<'_>) -> Option<Group> {
        let products_of = |begin, count| products.map(|products| products.rows(begin, count));
        let own = |begin: usize, part: &[usize]| self.own(part, products_of(begin, part.len()));
        let count = self.spectrum.singular.len();
        let mut rest = DMatrix::identity(count, count);
        let mut along = DMatrix::zeros(count, self.coefficients.ncols());
        for (at, part) in rows.chunks(TOGETHER).enumerate() {
            let (errors, _, b) = own(at * TOGETHER, part);
            subtract_gram(&mut rest, &b);
            along += b.tr_mul(&errors);
        }
        let factor = Factor::new(rest)?;
        factor.solve(&mut along);
        let mut residuals = DMatrix::zeros(rows.len(), self.coefficients.ncols());
        let mut variances = Vec::with_capacity(rows.len());
        for part in rows.chunks(TOGETHER) {
            let (errors, known, b) = own(variances.len(), part);
            residuals.rows_mut(variances.len(), part.len()).copy_from(&(errors + &b * &along));
            let mut whitened = b.transpose();
            factor.whiten(&mut whitened);
            let squares = whitened.column_iter().map(|column| 1.0 + column.norm_squared());
            let biases = self.biases(b, |b| {
                let mut transposed = b.transpose();
                factor.solve(&mut transposed);
                b.tr_copy_from(&transposed);
            });
            let each = squares.zip(biases).enumerate();
            variances.extend(each.map(|(at, of)| self.variance(of) + self.unknown(part[at], known[at])));
        }
        Some((residuals, variances))
    }

    /// |(I − BBᵀ)⁻¹ B diag(s² + κσ²)^{-1/2}|² for every row of B, where `leave` applies the first factor; not computed if κ = 1.
    fn biases(&self, mut b: DMatrix<f64>, leave: impl Fn(&mut DMatrix<f64>)) -> Vec<f64> {
        if self.noise == self.own {
            return vec![0.0; b.nrows()];
        }
        leave(&mut b);
        self.scale(&mut b);
        b.row_iter().map(|row| row.norm_squared()).collect()
    }

    /// (V_T)_ii (S36) from the diagonal of (I − BBᵀ)⁻¹ and the bias.
    fn variance(&self, (square, bias): (f64, f64)) -> f64 {
        self.own * square + self.noise * (self.noise - self.own) * bias
    }

    /// Divides the columns by √(s² + κσ²).
    fn scale(&self, b: &mut DMatrix<f64>) {
        for (mut column, s) in b.column_iter_mut().zip(&self.spectrum.singular) {
            column /= (s * s + self.noise).sqrt();
        }
    }

    /// z − Φŵ, the squares of the rows of Φ, and B with H = BBᵀ.
    fn own(&self, rows: &[usize], products: Option<DMatrixView<'_, f64>>) -> (DMatrix<f64>, Vec<f64>, DMatrix<f64>) {
        let product = || self.features.times(rows, &self.spectrum.w);
        let mut b = products.map_or_else(product, DMatrixView::into_owned);
        let errors = self.features.whitened_targets(rows) - &b * self.coefficients;
        let known = b.row_iter().map(|row| row.norm_squared()).collect();
        self.scale(&mut b);
        (errors, known, b)
    }

    /// Prior variance that the inducing rows do not explain, in the scale of D^{-1/2} K_nm.
    fn unknown(&self, row: usize, known: f64) -> f64 {
        let Features { covariance, amplitudes, targets, .. } = self.features;
        (covariance.variance(row, amplitudes) / targets.noise_weights[row] - known).max(0.0)
    }
}
