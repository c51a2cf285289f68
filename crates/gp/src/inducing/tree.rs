//! The triangle of a QR factorisation of very many rows (S35), computed from leaves of rows, then from pairs of triangles.

use std::ops::Range;

use linalg::qr_triangle;
use nalgebra::DMatrix;

/// Minimum number of rows of a leaf, absolute and as a multiple of the columns, so that most work is done in leaves.
const LEAF: usize = 2048;
const COLUMNS: usize = 4;

/// R, (c, c), with RᵀR = AᵀA for a matrix A with `rows` rows and c `columns`, whose rows `part` returns. Takes 2 rows c² operations
/// and, on each thread, memory for a leaf and for one triangle per level of the tree.
///
/// The shape of the tree, and therefore the bits of R, depend only on the numbers of rows and columns.
pub(crate) fn triangle(
    rows: usize,
    columns: usize,
    part: &(impl Fn(Range<usize>) -> DMatrix<f64> + Sync),
) -> DMatrix<f64> {
    let leaf = LEAF.max(COLUMNS * columns);
    of_leaves(0..rows.div_ceil(leaf), &|at| part(at * leaf..rows.min((at + 1) * leaf)))
}

fn of_leaves(leaves: Range<usize>, leaf: &(impl Fn(usize) -> DMatrix<f64> + Sync)) -> DMatrix<f64> {
    if leaves.len() <= 1 {
        return qr_triangle(leaf(leaves.start));
    }
    let middle = leaves.start + leaves.len().next_power_of_two() / 2;
    let (first, second) = rayon::join(|| of_leaves(leaves.start..middle, leaf), || of_leaves(middle..leaves.end, leaf));
    let columns = first.ncols();
    let mut stacked = DMatrix::zeros(2 * columns, columns);
    stacked.rows_mut(0, columns).copy_from(&first);
    stacked.rows_mut(columns, columns).copy_from(&second);
    qr_triangle(stacked)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// RᵀR = AᵀA for any number of rows, from fewer than columns to several leaves; the same bits on one thread and on three.
        #[test]
        fn the_triangle_has_the_products_of_the_matrix(rows in 1usize..9000, columns in 1usize..12, seed in any::<u64>()) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let matrix = DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0));
            let part = |range: Range<usize>| matrix.rows_range(range).into_owned();
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                pool.install(|| triangle(rows, columns, &part))
            };
            let (r, elsewhere) = (on(1), on(3));
            prop_assert_eq!(r.as_slice(), elsewhere.as_slice());
            prop_assert_eq!(r.clone(), r.upper_triangle());
            let (own, literal) = (r.tr_mul(&r), matrix.tr_mul(&matrix));
            prop_assert!((own - &literal).amax() <= 1e-12 * literal.amax());
        }
    }
}
