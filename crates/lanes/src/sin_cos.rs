//! Sine and cosine of many angles at once, to one unit in the last place.
//!
//! Reduction by multiples of π/2 in four parts (Cody and Waite), then the minimax polynomials of FDLIBM on [−π/4,
//! π/4]. There are no branches and no tables, so that the compiler vectorizes the loop over lanes; and no fused
//! multiply-add, so that every processor gives the same bits. Beyond [`FAR`] the products with the parts of π/2 are no
//! longer exact, and the platform's function is used, whose bits may differ.

use pulp::{Simd, WithSimd};

use crate::Lanes;

/// Largest angle for which the polynomials are used, in radians.
const FAR: f64 = 1e5;

/// π/2 = `PI_2_A` + `PI_2_B` + `PI_2_C` + `PI_2_D` to 151 bits; the first three have 33 bits, so that their products
/// with a whole number below 2²⁰ are exact.
const PI_2_A: f64 = f64::from_bits(0x3FF9_21FB_5440_0000);
const PI_2_B: f64 = f64::from_bits(0x3DD0_B461_1A60_0000);
const PI_2_C: f64 = f64::from_bits(0x3BA3_198A_2E00_0000);
const PI_2_D: f64 = f64::from_bits(0x397B_839A_2520_49C1);

/// Adding this rounds to a whole number and leaves it in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Coefficients of `sin x = x + Σ SIN[i] x^(2i+3)`.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// Coefficients of `cos x = 1 − x²/2 + Σ COS[i] x^(2i+4)`.
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// sin and cos of every angle, in radians; all angles must be finite, and the three slices of equal length.
#[inline(always)]
pub fn sin_cos_all(angles: &[Lanes], sines: &mut [Lanes], cosines: &mut [Lanes]) {
    let lanes = angles.as_flattened().iter().zip(sines.as_flattened_mut()).zip(cosines.as_flattened_mut());
    for ((angle, sine), cosine) in lanes {
        (*sine, *cosine) = near(*angle);
    }
    let far = angles.as_flattened().iter().fold(false, |far, angle| far | (angle.abs() > FAR));
    if far {
        far_ones(angles.as_flattened(), sines.as_flattened_mut(), cosines.as_flattened_mut());
    }
}

/// [`sin_cos_all`] in the widest registers of the processor at hand, for callers compiled for narrower ones.
#[inline]
pub fn sin_cos_all_dispatched(angles: &[Lanes], sines: &mut [Lanes], cosines: &mut [Lanes]) {
    pulp::Arch::new().dispatch(SinCosAll { angles, sines, cosines });
}

struct SinCosAll<'a> {
    angles: &'a [Lanes],
    sines: &'a mut [Lanes],
    cosines: &'a mut [Lanes],
}

impl WithSimd for SinCosAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        sin_cos_all(self.angles, self.sines, self.cosines);
    }
}

/// Recomputes the angles that are too large for [`sin_cos_all`].
#[cold]
fn far_ones(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
        if angle.abs() > FAR {
            (*sine, *cosine) = angle.sin_cos();
        }
    }
}

/// (sin, cos) of one angle of at most [`FAR`].
#[inline(always)]
fn near(angle: f64) -> (f64, f64) {
    let rounded = angle * std::f64::consts::FRAC_2_PI + ROUND;
    let quadrant = rounded.to_bits();
    let (x, tail) = reduced(angle, rounded - ROUND);
    let (sine, cosine) = (sine(x, tail).to_bits(), cosine(x, tail).to_bits());
    // In odd quadrants sine and cosine are swapped; by masks, because a conditional would become a branch.
    let swap = (sine ^ cosine) & (quadrant & 1).wrapping_neg();
    let sine_sign = (quadrant & 2) << 62;
    let cosine_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (f64::from_bits(sine ^ swap ^ sine_sign), f64::from_bits(cosine ^ swap ^ cosine_sign))
}

/// angle − turns · π/2 as the sum of a value and its rounding error.
#[inline(always)]
fn reduced(angle: f64, turns: f64) -> (f64, f64) {
    let first = angle - turns * PI_2_A;
    let (second, error_b) = difference(first, turns * PI_2_B);
    let (third, error_c) = difference(second, turns * PI_2_C);
    let rest = turns * PI_2_D - (error_b + error_c);
    let x = third - rest; // a difference, so that −0 stays −0
    (x, (third - x) - rest)
}

/// a − b and its rounding error, exactly (Dekker), if a is a multiple of b's last place. This holds in [`reduced`]: if
/// `turns` is not 0, the angle and turns · A are multiples of 2⁻⁵³ and turns · B of 2⁻⁶⁶, while the last places of
/// turns · B and turns · C are below 2⁻⁶⁹ and 2⁻¹⁰⁴.
#[inline(always)]
fn difference(a: f64, b: f64) -> (f64, f64) {
    let difference = a - b;
    (difference, (a - difference) - b)
}

#[inline(always)]
fn sine(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let cube = z * x;
    let rest = SIN[1] + z * (SIN[2] + z * (SIN[3] + z * (SIN[4] + z * SIN[5])));
    x - ((z * (0.5 * tail - cube * rest) - tail) - cube * SIN[0])
}

#[inline(always)]
fn cosine(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let square = z * z;
    let rest = z * (COS[0] + z * (COS[1] + z * COS[2])) + square * square * (COS[3] + z * (COS[4] + z * COS[5]));
    let half = 0.5 * z;
    let lead = 1.0 - half;
    lead + (((1.0 - lead) - half) + (z * rest - x * tail))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{LANES, dispatch_avx2};

    /// Distance in units in the last place, also across zero.
    fn ulps(a: f64, b: f64) -> u64 {
        let line =
            |x: f64| if x.is_sign_negative() { -x.abs().to_bits().cast_signed() } else { x.to_bits().cast_signed() };
        line(a).abs_diff(line(b))
    }

    /// Every other lane contains the angle, the rest its negative.
    fn in_lanes(angle: f64) -> [(f64, f64); LANES] {
        let angles = [std::array::from_fn(|lane| if lane % 2 == 0 { angle } else { -angle })];
        let (mut sines, mut cosines) = ([[0.0; LANES]], [[0.0; LANES]]);
        dispatch_avx2(SinCosAll { angles: &angles, sines: &mut sines, cosines: &mut cosines });
        let (mut wide_sines, mut wide_cosines) = ([[1.0; LANES]], [[1.0; LANES]]);
        sin_cos_all_dispatched(&angles, &mut wide_sines, &mut wide_cosines);
        assert_eq!((wide_sines, wide_cosines), (sines, cosines), "in the widest registers: other bits");
        std::array::from_fn(|lane| (if lane % 2 == 0 { sines[0][lane] } else { -sines[0][lane] }, cosines[0][lane]))
    }

    fn check(angle: f64) {
        let (sine, cosine) = angle.sin_cos();
        for (s, c) in in_lanes(angle) {
            assert!(ulps(s, sine) <= 1, "sin {angle:e}: {s:e}, library {sine:e}");
            assert!(ulps(c, cosine) <= 1, "cos {angle:e}: {c:e}, library {cosine:e}");
            if angle.abs() <= FAR {
                assert_eq!((s.to_bits(), c.to_bits()), (near(angle).0.to_bits(), near(angle).1.to_bits()), "{angle:e}");
            }
        }
    }

    #[test]
    fn special_angles() {
        for angle in [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, 1e-300, 1e-9, FAR, -FAR, FAR.next_up(), 1e22, f64::MAX] {
            check(angle);
        }
        assert_eq!(near(-0.0).0.to_bits(), (-0.0_f64).to_bits());
    }

    /// Where the sine or cosine nearly vanishes, every bit of π/2 matters.
    #[test]
    fn next_to_every_multiple_of_half_a_right_angle() {
        for k in 0..127_323 {
            let middle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            for angle in [middle.next_down(), middle, middle.next_up()] {
                let ((sine, cosine), (s, c)) = (angle.sin_cos(), near(angle));
                assert!(ulps(s, sine) <= 1 && ulps(c, cosine) <= 1, "{angle:e}: {s:e} {sine:e} {c:e} {cosine:e}");
            }
        }
    }

    proptest! {
        #[test]
        fn within_one_unit_of_the_library(angle in prop_oneof![-4.0..4.0_f64, -FAR..FAR, -1e9..1e9_f64]) {
            check(angle);
        }

        #[test]
        fn small_angles_too(exponent in -300..0_i32, mantissa in 1.0..10.0_f64) {
            check(mantissa * 10.0_f64.powi(exponent));
        }
    }
}
