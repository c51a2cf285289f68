#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use pulp::{Simd, WithSimd};

use super::boxes::SEGMENT;
use super::distances;
use super::tiles::{ROWS, Tiles};

/// The smallest squared distance between samples of two trajectories, or `bound` if none is smaller.
///
/// Examines the pair of segments with the nearest boxes first, then only pairs whose boxes are nearer than the nearest
/// samples found so far.
pub(crate) fn closest(one: &Tiles, other: &Tiles, bound: f64) -> f64 {
    let pairs = || (0..one.boxes.len()).flat_map(|a| (0..other.boxes.len()).map(move |b| (a, b)));
    let gap = |(a, b)| one.boxes.squared_gap(a, &other.boxes, b);
    let mut first = (0, 0);
    let mut least = f64::INFINITY;
    for pair in pairs() {
        let gap = gap(pair);
        if gap < least {
            (first, least) = (pair, gap);
        }
    }
    let among = |(a, b), bound: f64| one.arch.dispatch(Segments { one, a, other, b }).min(bound);
    if least >= bound {
        return bound;
    }
    let found = among(first, bound);
    pairs().fold(found, |found, pair| if pair != first && gap(pair) < found { among(pair, found) } else { found })
}

/// One segment from each of two trajectories.
struct Segments<'a> {
    one: &'a Tiles,
    a: usize,
    other: &'a Tiles,
    b: usize,
}

impl WithSimd for Segments<'_> {
    type Output = f64;

    /// The smallest squared distance between their samples.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        match self.one.dim {
            1 => self.smallest(simd, |rows, tile| distances::fixed::<S, 1>(simd, rows, tile)),
            2 => self.smallest(simd, |rows, tile| distances::fixed::<S, 2>(simd, rows, tile)),
            3 => self.smallest(simd, |rows, tile| distances::fixed::<S, 3>(simd, rows, tile)),
            6 => self.smallest(simd, |rows, tile| distances::fixed::<S, 6>(simd, rows, tile)),
            _ => self.smallest(simd, |rows, tile| distances::any(simd, rows, tile)),
        }
    }
}

impl Segments<'_> {
    #[inline(always)]
    fn smallest<S: Simd>(
        self,
        simd: S,
        squared_distances: impl Fn(&[[f64; ROWS]], &[S::f64s]) -> [S::f64s; ROWS],
    ) -> f64 {
        let Segments { one, a, other, b } = self;
        let dim = one.dim;
        let rows = one.rows.chunks_exact(dim).skip(a * SEGMENT / ROWS).take(SEGMENT / ROWS);
        let tiles = S::as_simd_f64s(&other.columns).0.chunks_exact(dim);
        let tiles = tiles.skip(b * SEGMENT / S::F64_LANES).take(SEGMENT / S::F64_LANES);
        let mut smallest = [simd.splat_f64s(f64::INFINITY); ROWS];
        for rows in rows {
            for tile in tiles.clone() {
                let distance = squared_distances(rows, tile);
                for r in 0..ROWS {
                    smallest[r] = simd.min_f64s(distance[r], smallest[r]);
                }
            }
        }
        let [a, b, c, d] = smallest;
        simd.reduce_min_f64s(simd.min_f64s(simd.min_f64s(a, b), simd.min_f64s(c, d)))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use pulp::Arch;

    use super::*;

    fn walk(dim: usize) -> impl Strategy<Value = DMatrix<f64>> {
        (1usize..120).prop_flat_map(move |n| {
            vec(-1.0..1.0, n * dim).prop_map(move |mut values| {
                (dim..values.len()).for_each(|at| values[at] = values[at - dim] + 0.3 * values[at]);
                DMatrix::from_vec(dim, n, values)
            })
        })
    }

    fn two_walks() -> impl Strategy<Value = (DMatrix<f64>, DMatrix<f64>)> {
        (1usize..9).prop_flat_map(|dim| (walk(dim), walk(dim)))
    }

    proptest! {
        #[test]
        fn closest_is_the_smallest_distance((one, other) in two_walks(), bound in 0.0..3.0) {
            let squared = |x: usize, y: usize| {
                let (x, y) = (one.column(x), other.column(y));
                x.iter().zip(y.iter()).map(|(x, y)| (x - y) * (x - y)).sum::<f64>()
            };
            let all = (0..one.ncols()).flat_map(|x| (0..other.ncols()).map(move |y| (x, y)));
            let smallest = all.map(|(x, y)| squared(x, y)).fold(f64::INFINITY, f64::min);
            for arch in [Arch::Scalar, Arch::new()] {
                let [one, other] = [&one, &other].map(|states| Tiles::new(states, arch));
                prop_assert_eq!(closest(&one, &other, f64::INFINITY), smallest);
                prop_assert_eq!(closest(&one, &other, bound), smallest.min(bound));
            }
        }
    }
}
