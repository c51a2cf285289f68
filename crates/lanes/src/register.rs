//! Vector registers.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

use pulp::{Interleave, Simd};

use crate::{LANES, Lanes, Number};

/// The numbers in a vector register.
#[derive(Debug, Clone, Copy)]
pub struct Register<S: Simd> {
    value: S::f64s,
    simd: S,
}

impl<S: Simd> Register<S> {
    #[inline(always)]
    fn with(self, value: S::f64s) -> Self {
        Register { value, ..self }
    }

    #[inline(always)]
    fn numbers(&mut self) -> &mut [f64] {
        pulp::bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.value))
    }

    /// Number of registers that hold a group.
    #[inline(always)]
    pub fn parts() -> usize {
        Self::elements(&[0.0; LANES]).len()
    }

    /// Register number `part` of a group.
    #[inline(always)]
    pub fn load(simd: S, group: &Lanes, part: usize) -> Self {
        Self::of(simd, Self::elements(group)[part])
    }

    /// Stores the register in a group, as register number `part`.
    #[inline(always)]
    pub fn store(self, group: &mut Lanes, part: usize) {
        Self::elements_mut(group)[part] = self.value;
    }

    /// The sum over all lanes, computed by halving.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.simd.reduce_sum_f64s(self.value)
    }

    /// The largest lane.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.value)
    }

    /// The first lane from `start` on that is below `limit`; a number past the end if there is none.
    #[inline(always)]
    pub fn first_below(mut self, limit: Self, start: usize) -> usize {
        if const { size_of::<S::m64s>() == 1 } {
            // One bit per lane, the first lane lowest (`first_true_m64s` assumes that it is highest).
            let below = u32::from(pulp::bytemuck::cast::<S::m64s, u8>(limit.above(self)));
            return (below >> start << start).trailing_zeros() as usize;
        }
        if start > 0 {
            self.numbers()[..start].fill(f64::INFINITY);
        }
        self.simd.first_true_m64s(limit.above(self))
    }

    /// Calls `each` once for every lane with its number and the entries of `rows` in this lane, from the first row on. The order
    /// of the lanes is unspecified.
    #[inline(always)]
    pub fn each_lane<const N: usize>(rows: [Self; N], mut each: impl FnMut(usize, &[f64; N]))
    where
        [S::f64s; N]: Interleave,
    {
        let simd = rows[0].simd;
        // The order in which lanes leave the shuffle depends on the processor; shuffling their numbers likewise reveals it.
        let order =
            simd.interleave_shfl_f64s([Self::load(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], 0).value; N]);
        let mut columns = [rows[0].value; N];
        for (column, row) in columns.iter_mut().zip(rows) {
            *column = row.value;
        }
        let columns = simd.interleave_shfl_f64s(columns);
        let (order, _) = pulp::bytemuck::cast_slice::<S::f64s, f64>(&order).as_chunks::<N>();
        let (columns, _) = pulp::bytemuck::cast_slice::<S::f64s, f64>(&columns).as_chunks::<N>();
        for (lane, column) in order.iter().zip(columns) {
            each(lane[0] as usize, column);
        }
    }

    /// The number of lane `lane`.
    #[inline(always)]
    pub fn get(mut self, lane: usize) -> f64 {
        self.numbers()[lane]
    }

    /// Replaces the number of lane `lane`.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: f64) {
        self.numbers()[lane] = value;
    }
}

macro_rules! operators {
    ($($operator:ident, $function:ident, $instruction:ident;)*) => {$(
        impl<S: Simd> $operator for Register<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.with(self.simd.$instruction(self.value, other.value))
            }
        }

        impl<S: Simd> $operator<f64> for Register<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.$function(self.like(other))
            }
        }
    )*};
}

operators! {
    Add, add, add_f64s;
    Sub, sub, sub_f64s;
    Mul, mul, mul_f64s;
}

impl<S: Simd> AddAssign for Register<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Register<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Simd> Number for Register<S> {
    type Raw = S::f64s;
    type Mask = S::m64s;
    type Token = S;

    #[inline(always)]
    fn token(self) -> S {
        self.simd
    }

    #[inline(always)]
    fn splat(simd: S, value: f64) -> Self {
        Register { value: simd.splat_f64s(value), simd }
    }

    #[inline(always)]
    fn of(simd: S, value: S::f64s) -> Self {
        Register { value, simd }
    }

    #[inline(always)]
    fn raw(self) -> S::f64s {
        self.value
    }

    #[inline(always)]
    fn elements(row: &[f64]) -> &[S::f64s] {
        S::as_simd_f64s(row).0
    }

    #[inline(always)]
    fn elements_mut(row: &mut [f64]) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(row).0
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self.with(self.simd.mul_add_f64s(self.value, factor.value, term.value))
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.with(self.simd.div_f64s(self.simd.splat_f64s(1.0), self.value))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let magnitude = self.like(f64::from_bits(u64::MAX >> 1));
        self.with(self.simd.and_f64s(self.value, magnitude.value))
    }

    #[inline(always)]
    fn power_of_two(mut self) -> Self {
        for value in self.numbers() {
            *value = value.power_of_two();
        }
        self
    }

    #[inline(always)]
    fn above(self, other: Self) -> S::m64s {
        self.simd.greater_than_f64s(self.value, other.value)
    }

    #[inline(always)]
    fn or_else(self, mask: S::m64s, other: Self) -> Self {
        self.with(self.simd.select_f64s(mask, self.value, other.value))
    }

    #[inline(always)]
    fn both(simd: S, a: S::m64s, b: S::m64s) -> S::m64s {
        simd.and_m64s(a, b)
    }

    #[inline(always)]
    fn any(simd: S, mask: S::m64s) -> bool {
        simd.first_true_m64s(mask) < S::F64_LANES
    }
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, WithSimd};

    use super::*;
    use crate::dispatch_avx2;

    /// Checks the arguments of `each_lane` for four rows and for two: ten times the row plus the lane.
    struct Lanewise;

    impl WithSimd for Lanewise {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let row = |row: usize| -> Register<S> {
                Register::load(simd, &std::array::from_fn(|lane| (10 * row + lane) as f64), 0)
            };
            let mut seen = vec![0; S::F64_LANES];
            Register::each_lane([row(0), row(1), row(2), row(3)], |lane, &numbers| {
                assert_eq!(numbers, [0, 10, 20, 30].map(|ten| (ten + lane) as f64));
                seen[lane] += 1;
            });
            Register::each_lane([row(4), row(5)], |lane, &numbers| {
                assert_eq!(numbers, [40, 50].map(|ten| (ten + lane) as f64));
                seen[lane] += 1;
            });
            assert_eq!(seen, vec![2; S::F64_LANES]);
        }
    }

    #[test]
    fn each_lane_comes_once_with_its_own_numbers() {
        Arch::Scalar.dispatch(Lanewise);
        dispatch_avx2(Lanewise);
        Arch::new().dispatch(Lanewise);
    }
}
