//! A Gaussian process conditioned on all rows through some of them, the inducing rows (S34)–(S37), (S39).

mod features;
mod left_out;
pub(crate) mod pivots;
mod spectrum;
mod tree;

use linalg::Factor;
use nalgebra::DMatrix;

use crate::inducing::features::Features;
use crate::inducing::left_out::{Groups, Leaving};
use crate::inducing::pivots::pivots;
use crate::inducing::spectrum::Spectrum;
use crate::kernel::covariance::{Covariance, NOISE_FLOOR, among, jittered};
use crate::left_out::LeftOutPredictions;
use crate::left_out::level::{Targets, climb, kappas, raised};
use crate::rows::thinning::every_so_many;

/// Approximate number of rows on which noise levels are compared; whole groups of them, at least three.
const COMPARED: usize = 8000;
/// Maximum number of rows whose features stay in memory for all noise levels.
const AT_HAND: usize = 20_000;

/// A model of all rows.
#[derive(Debug)]
pub(crate) struct Induced {
    /// The inducing rows, (m).
    pub(crate) rows: Vec<usize>,
    /// κ, the factor on σ² that predicts best, and σ² (S39), without the floor.
    pub(crate) kappa: f64,
    pub(crate) noise: f64,
    /// α of the inducing rows, (m, c).
    pub(crate) weights: DMatrix<f64>,
    /// L of K_mm.
    pub(crate) factor: Factor,
    /// The triangle of (S37).
    pub(crate) shrinkage: DMatrix<f64>,
    /// Predictions of all rows.
    pub(crate) left_out: LeftOutPredictions,
}

impl Induced {
    /// At these amplitudes, σ² with the highest marginal likelihood, and the κ that best predicts left-out groups. `None` without a
    /// Cholesky factor.
    ///
    /// Costs 4 n m² operations and n m covariances for n rows and m inducing rows, and memory for the features of the rows on which noise
    /// levels are compared.
    pub(crate) fn new(
        covariance: &impl Covariance,
        amplitudes: &[f64],
        targets: &Targets,
        most: usize,
    ) -> Option<Induced> {
        let inducing = pivots(covariance, amplitudes, &targets.groups, most);
        let features = Features { covariance, amplitudes, inducing, targets };
        let factor = Factor::new(jittered(among(covariance, &features.inducing, amplitudes)))?;
        let spectrum = Spectrum::of(&features, &factor)?;
        let found = spectrum.noise();
        let own = found + NOISE_FLOOR;
        let level = |noise, own, groups: &Groups<'_>, spread| {
            let coefficients = &spectrum.coefficients(noise);
            Leaving { features: &features, spectrum: &spectrum, noise, own, coefficients }.each(groups, spread)
        };
        let with_kappa = |kappa| raised(found, kappa) + NOISE_FLOOR;
        let count = targets.noise_weights.len();
        let all: Vec<&[usize]> = targets.groups.iter().map(Vec::as_slice).collect();
        let some = Groups::new(evenly(&all, COMPARED));
        let some = if some.len() <= AT_HAND { some.with_products(&features, &spectrum) } else { some };
        let share = some.len() as f64 / count as f64;
        let at = |kappa| {
            let noise = with_kappa(kappa);
            Some((kappa, level(noise, noise, &some, share * targets.spread)?))
        };
        // If a group is the only one that determines some direction nearly exactly, rounding leaves no prediction without it.
        let mut levels = kappas().map(at).skip_while(Option::is_none).peekable();
        let least = levels.peek()?.as_ref()?.0;
        let (best, compared) = climb(|_| levels.next().flatten(), |(_, left_out)| left_out)?;
        let known = with_kappa(best) == own && some.len() == count;
        let every = if some.len() == count { some } else { Groups::new(all) };
        let left_out = if known { compared } else { level(with_kappa(best), own, &every, targets.spread)? };
        let left_out = left_out.at(&every.rows.concat());
        // If the least noise at which groups can be left out is the best, less noise would be as good.
        let kappa = if best == least { 1.0 } else { best };
        let weights = &spectrum.w * spectrum.coefficients(with_kappa(kappa));
        let shrinkage = spectrum.shrinkage(with_kappa(kappa), own);
        Some(Induced { rows: features.inducing, kappa, noise: found, weights, factor, shrinkage, left_out })
    }
}

/// Evenly spaced groups with about so many rows in total, at least three; all groups if they have no more.
fn evenly<'a>(groups: &[&'a [usize]], rows: usize) -> Vec<&'a [usize]> {
    let count: usize = groups.iter().map(|rows| rows.len()).sum();
    let most = if count <= rows { groups.len() } else { (rows * groups.len() / count).max(3) };
    every_so_many(groups.len(), most).into_iter().map(|at| groups[at]).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::kernel::block::Block;
    use crate::kernel::shape::Shape;
    use crate::kernel::slope_covariance::SlopeCovariance;
    use crate::left_out::level::Level;

    /// For σ² below this, few rows may determine everything exactly, which no reference matches to 1e-6.
    const NOISY: f64 = 1e-3;
    const BLOCKS: [Block; 3] = [Block::Linear, Block::Quadratic, Block::Potential(Shape::SquaredExponential, 0.5)];

    /// Random rows in groups, as in a fit.
    struct Drawn {
        z: DMatrix<f64>,
        n: DMatrix<f64>,
        targets: DMatrix<f64>,
        noise_weights: Vec<f64>,
        groups: Vec<Vec<usize>>,
    }

    impl Drawn {
        fn new(groups: &[usize], seed: u64) -> Drawn {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let count = groups.iter().sum();
            let mut n = DMatrix::from_fn(2, count, |_, _| rng.random_range(-1.0..1.0));
            n.column_iter_mut().for_each(|mut n| {
                n.normalize_mut();
            });
            let begins = groups.iter().scan(0, |end, length| {
                *end += length;
                Some((*end - length..*end).collect())
            });
            Drawn {
                z: DMatrix::from_fn(2, count, |_, _| rng.random_range(-1.5..1.5)),
                n,
                targets: DMatrix::from_fn(count, 2, |_, _| rng.random_range(-1.0..1.0)),
                noise_weights: (0..count).map(|_| rng.random_range(0.3..3.0)).collect(),
                groups: begins.collect(),
            }
        }

        fn covariance(&self) -> SlopeCovariance<'_> {
            SlopeCovariance { blocks: &BLOCKS, z: &self.z, n: &self.n }
        }

        /// κσ² and σ² for every row.
        fn noises(&self, induced: &Induced) -> (Vec<f64>, Vec<f64>) {
            let of_rows = |noise: f64| self.noise_weights.iter().map(|weight| weight * (noise + NOISE_FLOOR)).collect();
            (of_rows(raised(induced.noise, induced.kappa)), of_rows(induced.noise))
        }

        fn targets(&self) -> Targets {
            let Drawn { targets, noise_weights, groups, .. } = self;
            let (values, noise_weights, groups) = (targets.clone(), noise_weights.clone(), groups.clone());
            Targets { values, noise_weights, groups, spread: 1.0 }
        }
    }

    fn full(lower: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(lower.nrows(), lower.ncols(), |i, j| lower[(i.max(j), i.min(j))])
    }

    fn select(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        matrix.select_rows(rows).select_columns(columns)
    }

    /// Mean, and covariance of its error, at rows with this prior and these covariances with other rows, which are conditioned with another
    /// noise than they have.
    fn predicted(
        prior: &DMatrix<f64>,
        across: &DMatrix<f64>,
        others: &DMatrix<f64>,
        (targets, noise, own): (&DMatrix<f64>, &[f64], &[f64]),
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let with = |noise: &[f64]| others + DMatrix::from_diagonal(&DVector::from_column_slice(noise));
        let gain = across * with(noise).try_inverse().expect("an inverse");
        let taken = &gain * across.transpose();
        (&gain * targets, prior - &taken - taken.transpose() + &gain * with(own) * gain.transpose())
    }

    fn differ(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
        (a - b).amax() / b.amax()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// If every row is an inducing row, the model equals that of all rows: mean, left-out predictions, explained variance.
        #[test]
        fn all_rows_as_inducing_rows_change_nothing(
            groups in prop::collection::vec(2usize..6, 4..7),
            amplitudes in prop::array::uniform3(0.05..3.0f64),
            seed in any::<u64>(),
        ) {
            let drawn = Drawn::new(&groups, seed);
            let (covariance, targets) = (drawn.covariance(), drawn.targets());
            let count = drawn.noise_weights.len();
            let induced = Induced::new(&covariance, &amplitudes, &targets, count).expect("a factor");
            prop_assume!(induced.noise > NOISY);
            let matrix = covariance.sum(&amplitudes);
            let exact = Level::at(&matrix, induced.noise, induced.kappa, &targets).expect("a factor");
            let with_all = select(&full(&matrix), &(0..count).collect::<Vec<_>>(), &induced.rows);
            let (mean, literal) = (&with_all * &induced.weights, full(&matrix) * &exact.weights);
            prop_assert!(differ(&mean, &literal) < 1e-6, "{}", differ(&mean, &literal));
            prop_assert!(differ(&induced.left_out.residuals, &exact.left_out.residuals) < 1e-6);
            let mut explained = with_all.transpose();
            induced.factor.whiten(&mut explained);
            let explained = &induced.shrinkage * explained;
            let prior = full(&matrix);
            let (noise, own) = drawn.noises(&induced);
            let (_, error) = predicted(&prior, &prior, &prior, (&drawn.targets, &noise, &own));
            prop_assert!(differ(&explained.tr_mul(&explained), &(&prior - error)) < 1e-6);
        }

        /// With few inducing rows: compares with (S34), (S36) evaluated literally, with one model of the other groups for each group, for
        /// groups with fewer and with more rows than there are inducing rows.
        #[test]
        fn left_out_groups_are_those_of_a_model_without_them(
            groups in prop::collection::vec(1usize..14, 4..6),
            amplitudes in prop::array::uniform3(0.05..3.0f64),
            most in 2usize..8,
            seed in any::<u64>(),
        ) {
            let drawn = Drawn::new(&groups, seed);
            let (covariance, targets) = (drawn.covariance(), drawn.targets());
            let count = drawn.noise_weights.len();
            let induced = Induced::new(&covariance, &amplitudes, &targets, most).expect("a factor");
            prop_assume!(induced.noise > NOISY);
            let all: Vec<usize> = (0..count).collect();
            let prior = full(&covariance.sum(&amplitudes));
            let with = select(&prior, &all, &induced.rows);
            let inverse = jittered(select(&prior, &induced.rows, &induced.rows)).try_inverse().expect("an inverse");
            let approximate = &with * inverse * with.transpose();
            let (noise, own) = drawn.noises(&induced);
            for rows in &drawn.groups {
                let others: Vec<usize> = all.iter().copied().filter(|row| !rows.contains(row)).collect();
                let (across, of_others) = (select(&approximate, rows, &others), select(&approximate, &others, &others));
                let take_others = |of: &[f64]| others.iter().map(|&row| of[row]).collect::<Vec<_>>();
                let conditions = (&drawn.targets.select_rows(&others), &*take_others(&noise), &*take_others(&own));
                let (mean, error) = predicted(&select(&approximate, rows, rows), &across, &of_others, conditions);
                let residuals = drawn.targets.select_rows(rows) - mean;
                prop_assert!((residuals - induced.left_out.residuals.select_rows(rows)).amax() < 1e-6);
                for (at, &row) in rows.iter().enumerate() {
                    let unknown = prior[(row, row)] - approximate[(row, row)];
                    let variance = error[(at, at)] + own[row] + unknown;
                    let found = induced.left_out.variances[row];
                    prop_assert!((variance - found).abs() <= 1e-6 * variance, "{variance} {found}");
                }
            }
        }

        /// (S39): compares with the literal determinant and quadratic form, up to terms independent of σ².
        #[test]
        fn the_marginal_likelihood_is_that_of_all_rows(
            groups in prop::collection::vec(1usize..9, 3..6),
            amplitudes in prop::array::uniform3(0.05..3.0f64),
            most in 2usize..8,
            noises in prop::array::uniform2(1e-2..1.0f64),
            seed in any::<u64>(),
        ) {
            let drawn = Drawn::new(&groups, seed);
            let (covariance, targets) = (drawn.covariance(), drawn.targets());
            let inducing = pivots(&covariance, &amplitudes, &drawn.groups, most);
            let features = Features { covariance: &covariance, amplitudes: &amplitudes, inducing, targets: &targets };
            let factor = Factor::new(jittered(among(&covariance, &features.inducing, &amplitudes))).expect("a factor");
            let spectrum = Spectrum::of(&features, &factor).expect("a decomposition");
            let prior = full(&covariance.sum(&amplitudes));
            let all: Vec<usize> = (0..prior.nrows()).collect();
            let with = select(&prior, &all, &features.inducing);
            let among = jittered(select(&prior, &features.inducing, &features.inducing));
            let approximate = &with * among.try_inverse().expect("an inverse") * with.transpose();
            let literal = |noise: f64| {
                let weights = DVector::from_column_slice(&drawn.noise_weights) * noise;
                let matrix = &approximate + DMatrix::from_diagonal(&weights);
                let inverse = matrix.clone().try_inverse().expect("an inverse");
                let outputs = drawn.targets.ncols() as f64;
                outputs * matrix.determinant().ln() + (drawn.targets.tr_mul(&(inverse * &drawn.targets))).trace()
            };
            let (own, expected) = (noises.map(|noise| spectrum.evidence(noise)), noises.map(literal));
            let (own, expected) = (own[0] - own[1], expected[0] - expected[1]);
            prop_assert!((own - expected).abs() <= 1e-6 * (1.0 + expected.abs()), "{own} {expected}");
            let best = spectrum.noise();
            prop_assert!(noises.iter().all(|&noise| spectrum.evidence(best) <= spectrum.evidence(noise) + 1e-2));
        }
    }
}
