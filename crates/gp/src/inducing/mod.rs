//! A Gaussian process conditioned on all rows through some of them, the inducing rows (S34)–(S37).

mod features;
mod left_out;
mod pivots;
mod spectrum;
mod tree;

use nalgebra::DMatrix;

use crate::inducing::features::Features;
use crate::inducing::left_out::Leaving;
use crate::inducing::pivots::pivots;
use crate::inducing::spectrum::Spectrum;
use crate::kernel::covariance::{Covariance, NOISE_FLOOR, among, jittered};
use crate::kernel::factor::Factor;
use crate::left_out::LeftOut;
use crate::left_out::level::{Conditions, climb, kappas, raised};
use crate::rows::thinning::every_so_many;

/// Rows on which levels of noise are compared; whole groups of them.
const COMPARED: usize = 20_000;

/// A model of all rows.
#[derive(Debug)]
pub(crate) struct Induced {
    /// The inducing rows, (m).
    pub(crate) rows: Vec<usize>,
    /// κ: by how much σ² was raised, and σ² used, without the floor.
    pub(crate) kappa: f64,
    pub(crate) noise: f64,
    /// α of the inducing rows, (m, c).
    pub(crate) weights: DMatrix<f64>,
    /// L of K_mm.
    pub(crate) factor: Factor,
    /// Of (S37).
    pub(crate) shrinkage: DMatrix<f64>,
    /// Of all rows.
    pub(crate) left_out: LeftOut,
}

impl Induced {
    /// At these amplitudes, and at the κ on the σ² `found` that predicts left-out groups best. None if there is no factor.
    ///
    /// Costs 4 n m² operations and n m covariances for n rows and m inducing ones, and the memory of a few rows at a time.
    pub(crate) fn new(
        covariance: &impl Covariance,
        amplitudes: &[f64],
        found: f64,
        conditions: &Conditions<'_>,
        most: usize,
    ) -> Option<Induced> {
        let inducing = pivots(covariance, amplitudes, conditions.groups, most);
        let features = Features { covariance, amplitudes, inducing, conditions };
        let factor = Factor::new(jittered(among(covariance, &features.inducing, amplitudes)))?;
        let spectrum = Spectrum::of(&features, &factor)?;
        let level = |kappa, groups: &[&[usize]], spread| {
            let noise = raised(found, kappa);
            let coefficients = spectrum.coefficients(noise + NOISE_FLOOR);
            let leaving = Leaving {
                features: &features,
                spectrum: &spectrum,
                noise: noise + NOISE_FLOOR,
                coefficients: &coefficients,
            };
            leaving.each(groups, spread)
        };
        let all: Vec<&[usize]> = conditions.groups.iter().map(Vec::as_slice).collect();
        let some = evenly(&all, COMPARED);
        let share = some.concat().len() as f64 / conditions.noise_weights.len() as f64;
        let levels = kappas().map(|kappa| Some((kappa, level(kappa, &some, share * conditions.spread)?)));
        // Of a group that alone says something nearly exactly, rounding leaves no prediction without itself.
        let mut levels = levels.skip_while(Option::is_none).peekable();
        let least = levels.peek()?.as_ref()?.0;
        let (best, some_left_out) = climb(levels, |(_, left_out)| left_out)?;
        let left_out = if some.len() == all.len() { some_left_out } else { level(best, &all, conditions.spread)? };
        // Where the least noise at which groups can be left out is the best, so would less be.
        let kappa = if best == least { 1.0 } else { best };
        let noise = raised(found, kappa);
        let weights = &spectrum.w * spectrum.coefficients(noise + NOISE_FLOOR);
        let shrinkage = spectrum.shrinkage(noise + NOISE_FLOOR);
        let left_out = left_out.at(&all.concat());
        Some(Induced { rows: features.inducing, kappa, noise, weights, factor, shrinkage, left_out })
    }
}

/// Groups evenly spaced with about so many rows together, at least three; all if they have no more.
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
    use crate::kernel::covariance::add_noise;
    use crate::kernel::shape::Shape;
    use crate::kernel::slope_covariance::SlopeCovariance;
    use crate::left_out::level::Level;

    const BLOCKS: [Block; 3] = [Block::Linear, Block::Quadratic, Block::Potential(Shape::SquaredExponential, 0.5)];

    /// Rows of groups, as a fit has them.
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

        fn conditions(&self) -> Conditions<'_> {
            let Drawn { targets, noise_weights, groups, .. } = self;
            Conditions { targets, noise_weights, groups, spread: 1.0 }
        }
    }

    fn full(lower: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(lower.nrows(), lower.ncols(), |i, j| lower[(i.max(j), i.min(j))])
    }

    fn select(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        matrix.select_rows(rows).select_columns(columns)
    }

    fn differ(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
        (a - b).amax() / b.amax()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Where every row is an inducing row, the model is the one of all rows: mean, left-out predictions, what is explained.
        #[test]
        fn all_rows_as_inducing_rows_change_nothing(
            groups in prop::collection::vec(1usize..6, 3..7),
            amplitudes in prop::array::uniform3(0.05..3.0f64),
            found in 1e-3..0.5f64,
            seed in any::<u64>(),
        ) {
            let drawn = Drawn::new(&groups, seed);
            let (covariance, conditions) = (drawn.covariance(), drawn.conditions());
            let count = drawn.noise_weights.len();
            let induced = Induced::new(&covariance, &amplitudes, found, &conditions, count).expect("a factor");
            let matrix = covariance.sum(&amplitudes);
            let exact = Level::at(&matrix, found, induced.kappa, &conditions).expect("a factor");
            prop_assert!((induced.noise - exact.noise).abs() <= 1e-12 * exact.noise);
            let with_all = select(&full(&matrix), &(0..count).collect::<Vec<_>>(), &induced.rows);
            let (mean, literal) = (&with_all * &induced.weights, full(&matrix) * &exact.weights);
            prop_assert!(differ(&mean, &literal) < 1e-6, "{}", differ(&mean, &literal));
            prop_assert!(differ(&induced.left_out.residuals, &exact.left_out.residuals) < 1e-6);
            for (own, literal) in induced.left_out.variances.iter().zip(&exact.left_out.variances) {
                prop_assert!((own - literal).abs() <= 1e-6 * literal, "{own} {literal}");
            }
            let mut explained = with_all.transpose();
            induced.factor.whiten(&mut explained);
            let explained = &induced.shrinkage * explained;
            let mut known = full(&matrix);
            exact.factor.whiten(&mut known);
            prop_assert!(differ(&explained.tr_mul(&explained), &known.tr_mul(&known)) < 1e-6);
        }

        /// With few inducing rows: the formulas (S34), (S36) as they are written, one model of the other groups for each group,
        /// whether a group has fewer rows than there are inducing ones or more.
        #[test]
        fn left_out_groups_are_those_of_a_model_without_them(
            groups in prop::collection::vec(1usize..14, 3..6),
            amplitudes in prop::array::uniform3(0.05..3.0f64),
            found in 1e-2..0.5f64,
            most in 2usize..8,
            seed in any::<u64>(),
        ) {
            let drawn = Drawn::new(&groups, seed);
            let (covariance, conditions) = (drawn.covariance(), drawn.conditions());
            let count = drawn.noise_weights.len();
            let induced = Induced::new(&covariance, &amplitudes, found, &conditions, most).expect("a factor");
            let all: Vec<usize> = (0..count).collect();
            let prior = full(&covariance.sum(&amplitudes));
            let with = select(&prior, &all, &induced.rows);
            let inverse = jittered(select(&prior, &induced.rows, &induced.rows)).try_inverse().expect("an inverse");
            let approximate = &with * inverse * with.transpose();
            let mut noisy = approximate.clone();
            add_noise(&mut noisy, induced.noise, drawn.noise_weights.iter().copied());
            for rows in &drawn.groups {
                let others: Vec<usize> = all.iter().copied().filter(|row| !rows.contains(row)).collect();
                let gain = select(&approximate, rows, &others)
                    * select(&noisy, &others, &others).try_inverse().expect("an inverse");
                let errors = drawn.targets.select_rows(rows) - &gain * drawn.targets.select_rows(&others);
                prop_assert!((errors - induced.left_out.residuals.select_rows(rows)).amax() < 1e-6);
                let variance = DVector::from_fn(rows.len(), |at, _| {
                    let row = rows[at];
                    prior[(row, row)] + (induced.noise + NOISE_FLOOR) * drawn.noise_weights[row]
                        - (&gain * select(&approximate, &others, rows))[(at, at)]
                });
                for (at, &row) in rows.iter().enumerate() {
                    prop_assert!((variance[at] - induced.left_out.variances[row]).abs() <= 1e-6 * variance[at]);
                }
            }
        }
    }
}
