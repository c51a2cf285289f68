//! Converts squared distances to weights.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::exp_in_bulk;
use pulp::{Arch, Simd, WithSimd};

/// Replaces each squared distance d by exp(−d / 2σ²), or by 0 where d > `squared_radius`.
pub(crate) fn to_weights(squared_distances: &mut [f64], sigma_squared: f64, squared_radius: f64) {
    Arch::new().dispatch(ToWeights { squared_distances, sigma_squared, squared_radius });
}

struct ToWeights<'a> {
    squared_distances: &'a mut [f64],
    sigma_squared: f64,
    squared_radius: f64,
}

impl WithSimd for ToWeights<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        for value in self.squared_distances {
            // Halved last, because 2σ² may overflow.
            let weight = exp_in_bulk(-0.5 * (*value / self.sigma_squared));
            *value = if *value <= self.squared_radius { weight } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn weights_are_cut_at_the_radius(
            d in proptest::collection::vec(0.0..100.0, 0..40), sigma_squared in 0.01..10.0, radius in 0.0..100.0,
        ) {
            let mut weights = d.clone();
            to_weights(&mut weights, sigma_squared, radius);
            for (d, w) in d.into_iter().zip(weights) {
                let expected = if d <= radius { exp_in_bulk(-d / (2.0 * sigma_squared)) } else { 0.0 };
                prop_assert_eq!(w.to_bits(), expected.to_bits());
            }
        }
    }

    #[test]
    fn the_widest_bandwidth_gives_weight_to_samples_only() {
        let mut weights = [0.0, 1e308, f64::MAX, f64::INFINITY];
        to_weights(&mut weights, f64::MAX, f64::INFINITY);
        assert_eq!(weights, [1.0, exp_in_bulk(-0.5 * (1e308 / f64::MAX)), exp_in_bulk(-0.5), 0.0]);
    }
}
