#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::{LANES, Lanes, Register};
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

/// Number of groups of rows stored together.
pub(crate) const GROUPS: usize = 4;
/// Number of rows stored together.
pub(crate) const TOGETHER: usize = GROUPS * LANES;

/// One number for each of [`TOGETHER`] rows, aligned to cache lines: loading a register across the end of a line takes twice as
/// long.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Abreast([Lanes; GROUPS]);

/// The data of the rows that a prediction reads, in the order in which it reads them: all numbers of [`TOGETHER`] rows, then
/// those of the next. The end is padded with zeros.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RowTable {
    numbers: Vec<Abreast>,
    /// Number of values per row.
    width: usize,
}

impl RowTable {
    /// A row consists of one column of each part, (n, M).
    pub(crate) fn new(parts: &[&DMatrix<f64>]) -> Self {
        let (count, width) = (parts[0].ncols(), parts.iter().map(|part| part.nrows()).sum());
        let mut numbers = vec![Abreast([[0.0; LANES]; GROUPS]); count.div_ceil(TOGETHER) * width];
        for row in 0..count {
            let numbers = &mut numbers[row / TOGETHER * width..][..width];
            let values = parts.iter().flat_map(|part| part.column(row).into_iter());
            for (numbers, value) in numbers.iter_mut().zip(values) {
                numbers.0[row % TOGETHER / LANES][row % LANES] = *value;
            }
        }
        RowTable { numbers, width }
    }

    /// All rows, [`TOGETHER`] at a time.
    #[inline(always)]
    pub(crate) fn together(&self) -> impl Iterator<Item = &[Abreast]> {
        self.numbers.chunks_exact(self.width)
    }
}

impl Abreast {
    /// Loads register `part` of U groups, from `first` on.
    #[inline(always)]
    pub(crate) fn load<S: Simd, const U: usize>(&self, simd: S, first: usize, part: usize) -> [Register<S>; U] {
        std::array::from_fn(|u| Register::load(simd, &self.0[first + u], part))
    }
}

/// First groups of the registers of U groups that together hold [`TOGETHER`] rows.
#[inline(always)]
pub(crate) fn firsts<const U: usize>() -> impl Iterator<Item = usize> {
    (0..GROUPS).step_by(U)
}

/// A sum over rows in vector registers, U groups of rows at a time.
pub(crate) trait OverRows {
    type Output;

    /// Must always be inlined, because functions that are called are compiled for the oldest processor.
    fn run<S: Simd, const U: usize>(self, simd: S) -> Self::Output;
}

/// Runs the sum with the widest registers, and with as many groups at a time as they hold.
pub(crate) fn over_rows<T: OverRows>(sum: T) -> T::Output {
    Arch::new().dispatch(InRegisters(sum))
}

struct InRegisters<T>(T);

impl<T: OverRows> WithSimd for InRegisters<T> {
    type Output = T::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> T::Output {
        if const { S::REGISTER_COUNT >= 32 } { self.0.run::<S, 4>(simd) } else { self.0.run::<S, 2>(simd) }
    }
}
