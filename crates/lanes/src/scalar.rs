//! Plain numbers as operands.

use crate::Number;

impl Number for f64 {
    type Raw = f64;
    type Mask = bool;
    type Token = ();

    #[inline(always)]
    fn token(self) {}

    #[inline(always)]
    fn splat((): (), value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn of((): (), raw: f64) -> f64 {
        raw
    }

    #[inline(always)]
    fn raw(self) -> f64 {
        self
    }

    #[inline(always)]
    fn elements(row: &[f64]) -> &[f64] {
        row
    }

    #[inline(always)]
    fn elements_mut(row: &mut [f64]) -> &mut [f64] {
        row
    }

    #[inline(always)]
    fn mul_add(self, factor: f64, term: f64) -> f64 {
        f64::mul_add(self, factor, term)
    }

    #[inline(always)]
    fn recip(self) -> f64 {
        1.0 / self
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn power_of_two(self) -> f64 {
        f64::from_bits(self.to_bits().wrapping_add(1023) << 52)
    }

    #[inline(always)]
    fn above(self, other: f64) -> bool {
        self > other
    }

    #[inline(always)]
    fn or_else(self, mask: bool, other: f64) -> f64 {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn both((): (), a: bool, b: bool) -> bool {
        a & b
    }

    #[inline(always)]
    fn any((): (), mask: bool) -> bool {
        mask
    }
}
