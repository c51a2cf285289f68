//! An exponential that vectorises: the library's is a call per number.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use pulp::{Arch, Simd, WithSimd};

/// exp of anything below −`LARGEST` is not worth its bits, and above it is a normal number.
const LARGEST: f64 = 708.0;
/// 1.5 · 2^52: adding it rounds to an integer, which then stands in the low bits.
const ROUNDING: f64 = 6755399441055744.0;
/// ln 2 in two parts; the first has so few bits that its multiples are exact.
const LN_2: [f64; 2] = [6.931471803691238e-1, 1.9082149292705877e-10];

/// Replaces each squared distance d by exp(−d / 2σ²), or by 0 where d > `reach`.
pub(crate) fn to_weights(squared_distances: &mut [f64], sigma_squared: f64, reach: f64) {
    Arch::new().dispatch(ToWeights { squared_distances, sigma_squared, reach });
}

struct ToWeights<'a> {
    squared_distances: &'a mut [f64],
    sigma_squared: f64,
    reach: f64,
}

impl WithSimd for ToWeights<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        for value in self.squared_distances {
            // Halved last: 2σ² may overflow.
            let weight = exp_negative(0.5 * (*value / self.sigma_squared));
            *value = if *value <= self.reach { weight } else { 0.0 };
        }
    }
}

/// exp(−t) for t ≥ 0 to within one unit in the last place; 0 where t > 708 or not a number.
#[inline(always)]
fn exp_negative(t: f64) -> f64 {
    let x = -(if t < LARGEST { t } else { LARGEST });
    let shifted = x * std::f64::consts::LOG2_E + ROUNDING;
    let power = shifted - ROUNDING;
    let r = (x - power * LN_2[0]) - power * LN_2[1];
    // Taylor about 0; |r| ≤ ln 2 / 2, so that the first term left out is below 5e-18.
    let mut tail = 1.0 / 6227020800.0;
    for factorial in [479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0] {
        tail = tail * r + 1.0 / factorial;
    }
    let two_to_the_power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    let value = (1.0 + (r + r * r * tail)) * two_to_the_power;
    if t <= LARGEST { value } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ulps(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    proptest! {
        #[test]
        fn is_the_exponential(t in prop_oneof![0.0..1.0, 0.0..50.0, 0.0..LARGEST, (-300.0..0.0_f64).prop_map(f64::exp2)]) {
            prop_assert!(ulps(exp_negative(t), (-t).exp()) <= 1, "{t}");
        }

        #[test]
        fn weights_are_cut_at_the_reach(
            d in proptest::collection::vec(0.0..100.0, 0..40), sigma_squared in 0.01..10.0, reach in 0.0..100.0,
        ) {
            let mut weights = d.clone();
            to_weights(&mut weights, sigma_squared, reach);
            for (d, w) in d.into_iter().zip(weights) {
                let expected = if d <= reach { exp_negative(d / (2.0 * sigma_squared)) } else { 0.0 };
                prop_assert_eq!(w.to_bits(), expected.to_bits());
            }
        }
    }

    #[test]
    fn the_widest_bandwidth_gives_weight_to_samples_only() {
        let mut weights = [0.0, 1e308, f64::MAX, f64::INFINITY];
        to_weights(&mut weights, f64::MAX, f64::INFINITY);
        assert_eq!(weights, [1.0, exp_negative(0.5 * (1e308 / f64::MAX)), exp_negative(0.5), 0.0]);
    }

    #[test]
    fn ends_are_exact() {
        assert_eq!(exp_negative(0.0), 1.0);
        assert_eq!(exp_negative(f64::INFINITY), 0.0);
        assert_eq!(exp_negative(f64::NAN), 0.0);
        assert!(exp_negative(LARGEST) > 0.0);
    }
}
