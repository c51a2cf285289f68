//! Triangles in tiles of eight rows, column by column, as applied to the columns of a [`Panel`].
//!
//! A panel's columns are in lanes, so that the sums over a row of the triangle have the same order for every register width and
//! number of columns: a single column gets the same bits as among others.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::{LANES, Lanes, Number, Register, groups_of};
use linalg::Factor;
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::kernel::panel::{Panel, PanelRow};

/// L⁻¹ of a lower triangle L: −L below the diagonal, 1/L_ii on it.
#[derive(Debug, Clone)]
pub(crate) struct InverseOfLower {
    tiles: Vec<Lanes>,
}

/// An upper triangle.
#[derive(Debug, Clone)]
pub(crate) struct Upper {
    tiles: Vec<Lanes>,
    len: usize,
}

impl From<Factor> for InverseOfLower {
    fn from(factor: Factor) -> Self {
        InverseOfLower::new(&factor.into_matrix())
    }
}

impl InverseOfLower {
    /// From a square matrix, whose lower triangle is read.
    pub(crate) fn new(lower: &DMatrix<f64>) -> Self {
        let len = lower.nrows();
        let entry = |row: usize, column: usize| match () {
            () if row >= len => f64::from(u8::from(row == column)),
            () if row == column => 1.0 / lower[(row, row)],
            () if row > column => -lower[(row, column)],
            () => 0.0,
        };
        let tile = |tile: usize| (0..(tile + 1) * LANES).map(move |column| (tile, column));
        let lanes = |(tile, column)| std::array::from_fn(|lane| entry(tile * LANES + lane, column));
        InverseOfLower { tiles: (0..groups_of(len)).flat_map(tile).map(lanes).collect() }
    }

    /// Replaces B, (M, k), by L⁻¹B, by forward substitution.
    pub(crate) fn apply(&self, panel: &mut Panel) {
        let mut rest = &self.tiles[..];
        for first in (0..panel.rows()).step_by(LANES) {
            let (tile, next) = rest.split_at(first + LANES);
            for (rows, groups) in panel.abreast() {
                Arch::new().dispatch(Substitute { tile, rows: &mut rows[..first + LANES], groups });
            }
            rest = next;
        }
    }
}

impl Upper {
    /// From a square matrix, whose upper triangle is read.
    pub(crate) fn new(upper: &DMatrix<f64>) -> Self {
        let len = upper.nrows();
        let entry = |row: usize, column: usize| if row <= column && column < len { upper[(row, column)] } else { 0.0 };
        let tile = |tile: usize| (tile * LANES..groups_of(len) * LANES).map(move |column| (tile, column));
        let lanes = |(tile, column)| std::array::from_fn(|lane| entry(tile * LANES + lane, column));
        Upper { tiles: (0..groups_of(len)).flat_map(tile).map(lanes).collect(), len }
    }

    /// Entries column by column, each down to the diagonal.
    pub(crate) fn entries(&self) -> impl Iterator<Item = f64> {
        let height = self.len.next_multiple_of(LANES);
        let entry = move |row: usize, column: usize| {
            let (tile, first) = (row / LANES, row / LANES * LANES);
            // The previous tiles have height, height − 8, … columns.
            let before = tile * height - LANES * tile * tile.saturating_sub(1) / 2;
            self.tiles[before + column - first][row % LANES]
        };
        (0..self.len).flat_map(move |column| (0..=column).map(move |row| entry(row, column)))
    }

    /// Tᵀ, zero above the diagonal.
    pub(crate) fn transposed(&self) -> DMatrix<f64> {
        let mut entries = self.entries();
        let mut transposed = DMatrix::zeros(self.len, self.len);
        for row in 0..self.len {
            for column in 0..=row {
                transposed[(row, column)] = entries.next().unwrap_or_default();
            }
        }
        transposed
    }

    /// Replaces B, (M, k), by TB.
    pub(crate) fn apply(&self, panel: &mut Panel) {
        let mut rest = &self.tiles[..];
        for first in (0..panel.rows()).step_by(LANES) {
            let (tile, next) = rest.split_at(panel.rows().next_multiple_of(LANES) - first);
            for (rows, groups) in panel.abreast() {
                Arch::new().dispatch(Multiply { tile, rows: &mut rows[first..], groups });
            }
            rest = next;
        }
    }
}

/// Solves for the last eight of some rows of a panel: subtracts the contribution of the previous rows, then applies the diagonal
/// block.
struct Substitute<'a> {
    tile: &'a [Lanes],
    rows: &'a mut [PanelRow],
    groups: usize,
}

/// Replaces the first eight of some rows of a panel by a tile times the rows.
struct Multiply<'a> {
    tile: &'a [Lanes],
    rows: &'a mut [PanelRow],
    groups: usize,
}

impl WithSimd for Substitute<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Substitute { tile, rows, groups } = self;
        let (solved, rows) = rows.split_at_mut(rows.len() - LANES);
        let (beside, diagonal) = tile.split_at(solved.len());
        if const { S::REGISTER_COUNT >= 32 } && groups == 2 {
            for part in 0..Register::<S>::parts() {
                substitute::<S, 2>(simd, (beside, diagonal), (solved, rows), (0, part));
            }
        } else {
            for at in (0..groups).flat_map(|group| (0..Register::<S>::parts()).map(move |part| (group, part))) {
                substitute::<S, 1>(simd, (beside, diagonal), (solved, rows), at);
            }
        }
    }
}

/// One register of V groups, from `first` on.
#[inline(always)]
fn substitute<S: Simd, const V: usize>(
    simd: S,
    (beside, diagonal): (&[Lanes], &[Lanes]),
    (solved, rows): (&[PanelRow], &mut [PanelRow]),
    (first, part): (usize, usize),
) {
    let mut sums: [[Register<S>; V]; LANES] = std::array::from_fn(|lane| load(simd, &rows[lane], first, part));
    for (entries, solved) in beside.iter().zip(solved) {
        add_row(simd, entries, load(simd, solved, first, part), &mut sums);
    }
    for (k, entries) in diagonal.iter().enumerate().take(LANES) {
        let solved = sums[k].map(|sum| sum * entries[k]);
        sums[k] = solved;
        for lane in k + 1..LANES {
            for v in 0..V {
                sums[lane][v] = Register::splat(simd, entries[lane]).mul_add(solved[v], sums[lane][v]);
            }
        }
    }
    store(sums, rows, first, part);
}

impl WithSimd for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Multiply { tile, rows, groups } = self;
        if const { S::REGISTER_COUNT >= 32 } && groups == 2 {
            for part in 0..Register::<S>::parts() {
                multiply::<S, 2>(simd, tile, rows, (0, part));
            }
        } else {
            for at in (0..groups).flat_map(|group| (0..Register::<S>::parts()).map(move |part| (group, part))) {
                multiply::<S, 1>(simd, tile, rows, at);
            }
        }
    }
}

#[inline(always)]
fn multiply<S: Simd, const V: usize>(simd: S, tile: &[Lanes], rows: &mut [PanelRow], (first, part): (usize, usize)) {
    let mut sums = [[Register::splat(simd, 0.0); V]; LANES];
    for (entries, row) in tile.iter().zip(&*rows) {
        add_row(simd, entries, load(simd, row, first, part), &mut sums);
    }
    store(sums, rows, first, part);
}

/// Adds a row of the panel times its entry in each row of the tile.
#[inline(always)]
fn add_row<S: Simd, const V: usize>(
    simd: S,
    entries: &Lanes,
    row: [Register<S>; V],
    sums: &mut [[Register<S>; V]; LANES],
) {
    for lane in 0..LANES {
        for v in 0..V {
            sums[lane][v] = Register::splat(simd, entries[lane]).mul_add(row[v], sums[lane][v]);
        }
    }
}

#[inline(always)]
fn load<S: Simd, const V: usize>(simd: S, row: &PanelRow, first: usize, part: usize) -> [Register<S>; V] {
    std::array::from_fn(|v| Register::load(simd, &row.0[first + v], part))
}

#[inline(always)]
fn store<S: Simd, const V: usize>(sums: [[Register<S>; V]; LANES], rows: &mut [PanelRow], first: usize, part: usize) {
    for (sums, row) in sums.into_iter().zip(rows) {
        for (v, sum) in sums.into_iter().enumerate() {
            sum.store(&mut row.0[first + v], part);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drawn(rows: usize, columns: usize, seed: f64) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |i, j| (seed + (i * 37 + j * j) as f64).sin())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn triangles_are_applied(len in 1_usize..70, columns in 1_usize..40, seed in -9.0..9.0) {
            let b = drawn(len, columns, seed);
            let lower = drawn(len, len, seed + 0.5) + DMatrix::identity(len, len) * (4.0 + len as f64);
            let mut panel = Panel::of(&b);
            InverseOfLower::new(&lower).apply(&mut panel);
            prop_assert!((lower.lower_triangle() * panel.into_matrix() - &b).amax() < 1e-13);

            let (upper, mut panel) = (Upper::new(&lower), Panel::of(&b));
            upper.apply(&mut panel);
            let expected = lower.upper_triangle() * &b;
            prop_assert!((panel.into_matrix() - &expected).amax() <= 1e-13 * expected.amax());
            let column = |k: usize| lower.column(k).as_slice()[..=k].to_vec();
            prop_assert_eq!(upper.entries().collect::<Vec<_>>(), (0..len).flat_map(column).collect::<Vec<_>>());
        }

        /// The result for a column does not depend on its position or on its neighbours.
        #[test]
        fn a_column_alone_has_the_same_bits(len in 1_usize..70, columns in 1_usize..40, at in 0_usize..40, seed in -9.0..9.0) {
            let (b, at) = (drawn(len, columns, seed), at % columns);
            let matrix = drawn(len, len, seed + 0.5) + DMatrix::identity(len, len) * 3.0;
            let (lower, upper) = (InverseOfLower::new(&matrix), Upper::new(&matrix));
            let apply = |mut panel: Panel| {
                lower.apply(&mut panel);
                upper.apply(&mut panel);
                (panel.squared_norms(), panel.into_matrix())
            };
            let (norms, together) = apply(Panel::of(&b));
            let (norm, alone) = apply(Panel::of(&b.columns(at, 1).into_owned()));
            prop_assert_eq!(alone.column(0), together.column(at));
            prop_assert_eq!(norm[0].to_bits(), norms[at].to_bits());
        }
    }
}
