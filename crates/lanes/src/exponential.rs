//! An exponential without calls or branches.
//!
//! With n = round(x/ln 2) and r = x − n ln 2, |r| ≤ ln 2 / 2, it is 2ⁿ times the Taylor polynomial of degree 13, whose
//! first omitted term is below 5e-18. There are two orders of evaluation for two uses.

use crate::Number;

/// The number just below −708, the least x whose exponential is normal and accurate.
const BELOW_SMALLEST: f64 = -708.000_000_000_000_1;

/// 1.5 · 2⁵²: adding it rounds to an integer, which is then in the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// ln 2 in two parts; the first has so few bits that its multiples are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// 1/k! for k from 2 on.
const INVERSE_FACTORIALS: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5040.0,
    1.0 / 40320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// e^x to about one unit in the last place, 0 below −708 (or for NaN); `x` must be below 709.
///
/// For a few numbers whose latency matters: terms are summed in pairs, with fused multiply-add, so that few operations
/// depend on each other.
#[inline(always)]
pub fn exp<T: Number>(x: T) -> T {
    let (r, power) = reduced(x);
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let (low, middle, high) = (four_terms(r, r2, 0), four_terms(r, r2, 4), four_terms(r, r2, 8));
    let tail = high.mul_add(r4, middle).mul_add(r4, low);
    or_zero(x, (tail.mul_add(r2, r) + 1.0) * power)
}

/// Four terms of the polynomial, from coefficient `k` on, divided by their lowest power of r.
#[inline(always)]
fn four_terms<T: Number>(r: T, r2: T, k: usize) -> T {
    let f = &INVERSE_FACTORIALS[k..k + 4];
    r.mul_add(r.like(f[3]), r.like(f[2])).mul_add(r2, r.mul_add(r.like(f[1]), r.like(f[0])))
}

/// The exponential for long rows of numbers, which the compiler vectorizes: fewer operations, each dependent on the
/// previous one, without fused multiply-add. The last bit may differ from [`exp`]'s.
#[inline(always)]
pub fn exp_in_bulk(x: f64) -> f64 {
    let (r, power) = reduced(x);
    let mut tail = INVERSE_FACTORIALS[11];
    for k in (0..11).rev() {
        tail = tail * r + INVERSE_FACTORIALS[k];
    }
    or_zero(x, (1.0 + (r + r * r * tail)) * power)
}

/// The reduced argument r, and 2ⁿ.
#[inline(always)]
fn reduced<T: Number>(x: T) -> (T, T) {
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    ((x - n * LN_2[0]) - n * LN_2[1], shifted.power_of_two())
}

#[inline(always)]
fn or_zero<T: Number>(x: T, value: T) -> T {
    value.or_else(x.above(x.like(BELOW_SMALLEST)), x.like(0.0))
}

#[cfg(test)]
mod tests {
    use super::{BELOW_SMALLEST, exp, exp_in_bulk};
    use proptest::prelude::*;

    fn ulps(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn exponentials_are_within_one_ulp(
            x in prop_oneof![-1.0..1.0, -50.0..50.0, -708.0..709.0, (-300.0..0.0_f64).prop_map(f64::exp2)],
        ) {
            prop_assert!(ulps(exp(x), x.exp()) <= 1, "{x}: {} {}", exp(x), x.exp());
            prop_assert!(ulps(exp_in_bulk(x), x.exp()) <= 1, "{x}: {} {}", exp_in_bulk(x), x.exp());
        }
    }

    #[test]
    fn exponentials_handle_zero_and_underflow() {
        assert_eq!(BELOW_SMALLEST, (-708.0_f64).next_down());
        for f in [exp::<f64> as fn(f64) -> f64, exp_in_bulk] {
            assert_eq!(f(0.0).to_bits(), 1.0_f64.to_bits());
            assert_eq!(f(-0.0).to_bits(), 1.0_f64.to_bits());
            assert!(f(-708.0) > 0.0);
            for x in [BELOW_SMALLEST, -1e9, -1e300, f64::NEG_INFINITY, f64::NAN] {
                assert_eq!(f(x).to_bits(), 0, "{x}");
            }
        }
    }
}
