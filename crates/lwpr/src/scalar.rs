//! Plain numbers to calculate with.

use crate::exponential::exp;
use crate::number::{Element, Number};

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
    fn exp(self) -> f64 {
        exp(self)
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

impl Element<f64> for f64 {
    #[inline(always)]
    fn spread((): (), value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn spread_mask((): (), mask: bool) -> bool {
        mask
    }

    /// Rows are 1, 2, 4 or a multiple of 8 long. The halving order is what vector instructions do.
    #[inline(always)]
    fn dot((): (), a: &[f64], b: &[f64]) -> f64 {
        match a.len() {
            1 => a[0] * b[0],
            2 => a[0] * b[0] + a[1] * b[1],
            4 => (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3]),
            _ => {
                let (a, b) = (a.as_chunks::<8>().0, b.as_chunks::<8>().0);
                let mut sums: [f64; 8] = std::array::from_fn(|lane| a[0][lane] * b[0][lane]);
                for (a, b) in a.iter().zip(b).skip(1) {
                    for lane in 0..8 {
                        sums[lane] += a[lane] * b[lane];
                    }
                }
                let [a, b, c, d, e, f, g, h] = sums;
                ((a + e) + (c + g)) + ((b + f) + (d + h))
            }
        }
    }

    #[inline(always)]
    fn largest((): (), a: &[f64]) -> f64 {
        a.iter().fold(0.0, |max, a| Number::larger(a.abs(), max))
    }
}
