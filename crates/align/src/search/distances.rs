#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use pulp::Simd;

use super::tiles::ROWS;

/// Squared distances of each of `ROWS` rows to each sample of a tile, in `N` dimensions.
#[inline(always)]
pub(crate) fn fixed<S: Simd, const N: usize>(simd: S, rows: &[[f64; ROWS]], tile: &[S::f64s]) -> [S::f64s; ROWS] {
    let rows: &[[f64; ROWS]; N] = rows.try_into().expect("N is the number of dimensions");
    let tile: &[S::f64s; N] = tile.try_into().expect("N is the number of dimensions");
    any(simd, rows, tile)
}

/// Squared distances of each of `ROWS` rows to each sample of a tile.
#[inline(always)]
pub(crate) fn any<S: Simd>(simd: S, rows: &[[f64; ROWS]], tile: &[S::f64s]) -> [S::f64s; ROWS] {
    let mut sum = [simd.splat_f64s(0.0); ROWS];
    for (row, &other) in rows.iter().zip(tile) {
        for r in 0..ROWS {
            let difference = simd.sub_f64s(simd.splat_f64s(row[r]), other);
            sum[r] = simd.add_f64s(sum[r], simd.mul_f64s(difference, difference));
        }
    }
    sum
}
