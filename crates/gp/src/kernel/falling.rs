#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::{Number, exp};

use crate::kernel::shape::Shape;
use crate::kernel::term::{Exponential, Fall, Step, Term, steps};

/// A sum of terms that decay with distance, in the form in which predictions evaluate it: one exponential, and squarings for lengths
/// that differ by powers of two, instead of one exponential per term.
///
/// The fit computes each term separately; both results agree to 1e-13 of the sum of the terms' magnitudes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Falling {
    series: Vec<Series>,
}

/// The terms that share an exponential e^{rate x}, from the longest to the shortest; x is the distance ρ, or its square for
/// [`Exponential::Gaussian`].
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The exponential.
    pub exponential: Exponential,
    /// Its terms.
    pub summands: Vec<Summand>,
    has_linear: bool,
}

/// A term e (`one` + `linear` t + `quadratic` t²), and e `bend`, where e is its exponential. t is the distance, or for
/// [`Exponential::Gaussian`] the squared distance along the state, without the context.
///
/// In a slope covariance the sum of the first is g of (S3), the sum of the second h, multiplied by the distance for
/// [`Exponential::Matern32`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summand {
    /// The rate, if the exponential is computed; `None` if it is the previous one, squared.
    pub rate: Option<f64>,
    /// Number of times that the exponential is squared.
    pub squarings: u32,
    /// Constant factor, in scaled units like all factors.
    pub one: f64,
    /// Factor of t.
    pub linear: f64,
    /// Factor of t²; 0 in slope covariances.
    pub quadratic: f64,
    /// Factor of e in h; 0 in other covariances.
    pub bend: f64,
}

impl Falling {
    /// g and h of (S3); the state has `moving_dim` dimensions.
    pub(crate) fn of_slopes(terms: &[Term], moving_dim: usize) -> Self {
        Falling::new(terms, |Term { fall, length, amplitude }| match fall {
            Fall::Shape(Shape::SquaredExponential) => [amplitude, 0.0, 0.0, amplitude / (length * length)],
            Fall::Shape(Shape::Matern52) => {
                let rate = 5.0_f64.sqrt() / length;
                [amplitude, amplitude * rate, 0.0, amplitude * 5.0 / (length * length)]
            }
            Fall::Shape(Shape::Matern32) => [amplitude, 0.0, 0.0, amplitude * 3.0_f64.sqrt() / length],
            Fall::DivergenceFree => {
                let (others, inverse) = (moving_dim as f64 - 1.0, 1.0 / (length * length));
                let amplitude = amplitude / others.max(1.0);
                [amplitude * others, -amplitude * inverse, 0.0, -amplitude * inverse]
            }
        })
    }

    /// The covariance of the function values themselves.
    pub(crate) fn of_values(terms: &[Term]) -> Self {
        Falling::new(terms, |Term { fall, length, amplitude }| match fall {
            Fall::Shape(Shape::SquaredExponential) | Fall::DivergenceFree => [amplitude, 0.0, 0.0, 0.0],
            Fall::Shape(Shape::Matern52) => {
                let rate = 5.0_f64.sqrt() / length;
                [amplitude, amplitude * rate, amplitude * rate * rate / 3.0, 0.0]
            }
            Fall::Shape(Shape::Matern32) => [amplitude, amplitude * 3.0_f64.sqrt() / length, 0.0, 0.0],
        })
    }

    fn new(terms: &[Term], factors: impl Fn(Term) -> [f64; 4]) -> Self {
        let mut series: Vec<Series> = Vec::new();
        for Step { term, squarings } in steps(terms) {
            let exponential = term.fall.exponential();
            let rate = match exponential {
                Exponential::Gaussian => -0.5 / (term.length * term.length),
                Exponential::Matern52 => -(5.0_f64.sqrt() / term.length),
                Exponential::Matern32 => -(3.0_f64.sqrt() / term.length),
            };
            let rate = squarings.is_none().then_some(rate);
            let [one, linear, quadratic, bend] = factors(term);
            let summand = Summand { rate, squarings: squarings.unwrap_or(0), one, linear, quadratic, bend };
            match series.last_mut().filter(|series| series.exponential == exponential) {
                Some(series) => {
                    series.has_linear |= linear != 0.0;
                    series.summands.push(summand);
                }
                None => series.push(Series { exponential, has_linear: linear != 0.0, summands: vec![summand] }),
            }
        }
        Falling { series }
    }

    /// The series, one for each distinct exponential.
    pub fn series(&self) -> &[Series] {
        &self.series
    }

    /// g and h of (S3) at squared distances, whose part along the state is `moving`.
    #[inline(always)]
    pub(crate) fn slopes<T: Number, const U: usize>(&self, squared: [T; U], moving: [T; U]) -> ([T; U], [T; U]) {
        let zero = squared[0].like(0.0);
        let [mut g, mut h] = [[zero; U]; 2];
        for series in &self.series {
            let (x, t) = series.arguments(squared, moving);
            let (mut e, mut bends) = (x, [zero; U]);
            for summand in &series.summands {
                summand.next(&mut e, x);
                for u in 0..U {
                    let factor = if series.has_linear {
                        t[u].mul_add(zero.like(summand.linear), zero.like(summand.one))
                    } else {
                        zero.like(summand.one)
                    };
                    g[u] = e[u].mul_add(factor, g[u]);
                    bends[u] = e[u].mul_add(zero.like(summand.bend), bends[u]);
                }
            }
            for u in 0..U {
                h[u] += if series.exponential == Exponential::Matern32 {
                    // At distance 0 the product h β_i β_j is 0 for any h.
                    bends[u] * x[u].larger(zero.like(1e-12)).recip()
                } else {
                    bends[u]
                };
            }
        }
        (g, h)
    }

    /// Covariances at squared distances.
    #[inline(always)]
    pub(crate) fn values<T: Number, const U: usize>(&self, squared: [T; U]) -> [T; U] {
        let zero = squared[0].like(0.0);
        let mut values = [zero; U];
        for series in &self.series {
            let (x, t) = series.arguments(squared, squared);
            let mut e = x;
            for summand in &series.summands {
                summand.next(&mut e, x);
                for u in 0..U {
                    let factor = if series.has_linear {
                        let slope = t[u].mul_add(zero.like(summand.quadratic), zero.like(summand.linear));
                        t[u].mul_add(slope, zero.like(summand.one))
                    } else {
                        zero.like(summand.one)
                    };
                    values[u] = e[u].mul_add(factor, values[u]);
                }
            }
        }
        values
    }
}

impl Series {
    /// The argument of the exponential, and t.
    #[inline(always)]
    fn arguments<T: Number, const U: usize>(&self, squared: [T; U], moving: [T; U]) -> ([T; U], [T; U]) {
        if self.exponential == Exponential::Gaussian {
            return (squared, moving);
        }
        let distance = squared.map(T::sqrt);
        (distance, distance)
    }
}

impl Summand {
    /// Replaces the exponentials of the previous summand by those of this one, at `x`.
    #[inline(always)]
    fn next<T: Number, const U: usize>(&self, e: &mut [T; U], x: [T; U]) {
        match self.rate {
            Some(rate) => {
                for u in 0..U {
                    e[u] = exp(x[u] * rate);
                }
            }
            None => {
                for _ in 0..self.squarings {
                    for e in &mut *e {
                        *e = *e * *e;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::shape::{Radial, divergence_free_at};
    use proptest::prelude::*;

    fn falls() -> impl Strategy<Value = Fall> {
        let shapes = [Shape::SquaredExponential, Shape::Matern52, Shape::Matern32];
        prop::sample::select([Fall::DivergenceFree].into_iter().chain(shapes.map(Fall::Shape)).collect::<Vec<_>>())
    }

    /// Terms with lengths that differ by powers of two, and others.
    fn terms() -> impl Strategy<Value = Vec<Term>> {
        let lengths = prop_oneof![(-4..4_i32).prop_map(|k| 1.7 * 2.0_f64.powi(k)), 0.1..10.0];
        let term = (falls(), lengths, 1e-3..10.0);
        let term = term.prop_map(|(fall, length, amplitude)| Term { fall, length, amplitude });
        prop::collection::vec(term, 0..9)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5_000))]

        /// Each term computed separately, as in the fit.
        #[test]
        fn kernel_is_the_sum_of_its_terms(
            terms in terms(), dim in 1_usize..8, squared in prop_oneof![Just(0.0), 0.0..1e-6, 0.0..50.0, 0.0..1e6],
            along in 0.0..1.0,
        ) {
            let moving = squared * along;
            let (mut g, mut h, mut value, mut scale) = (0.0, 0.0, 0.0, [0.0_f64; 3]);
            for term in &terms {
                let (own_g, own_h, own_value) = match term.fall {
                    Fall::Shape(shape) => {
                        let radial = Radial { shape, length: term.length };
                        let (g, h) = radial.slopes_at(squared);
                        (g, h, radial.value_at(squared))
                    }
                    Fall::DivergenceFree => {
                        let (g, h) = divergence_free_at((term.length, dim), squared, moving);
                        (g, h, Radial { shape: Shape::SquaredExponential, length: term.length }.value_at(squared))
                    }
                };
                g += term.amplitude * own_g;
                h += term.amplitude * own_h;
                value += term.amplitude * own_value;
                // An exponent has a rounding error in proportion to its size.
                let rounding = 1.0 - 0.01 * own_value.clamp(f64::MIN_POSITIVE, 1.0).ln();
                scale[0] += rounding * (term.amplitude * own_g).abs() + if term.fall == Fall::DivergenceFree {
                    rounding * term.amplitude * own_value * (1.0 + moving / term.length.powi(2))
                } else {
                    0.0
                };
                scale[1] += rounding * (term.amplitude * own_h).abs();
                scale[2] += rounding * term.amplitude * own_value;
            }
            let ([fast_g], [fast_h]) = Falling::of_slopes(&terms, dim).slopes([squared], [moving]);
            let [fast_value] = Falling::of_values(&terms).values([squared]);
            for ((fast, literal), scale) in [(fast_g, g), (fast_h, h), (fast_value, value)].into_iter().zip(scale) {
                prop_assert!((fast - literal).abs() <= 1e-13 * scale + 1e-150, "{fast} {literal}");
            }
        }

        /// One exponential per kind and at most six squarings, for any number of terms.
        #[test]
        fn steps_are_all_terms_and_few_exponentials(count in 1..9_i32, fall in falls(), base in 0.1..10.0) {
            let term = |k: i32| Term { fall, length: base * 2.0_f64.powi(k), amplitude: 1.0 + f64::from(k) };
            let steps = steps(&(0..count).map(term).collect::<Vec<_>>());
            prop_assert_eq!(steps.iter().map(|step| step.term).collect::<Vec<_>>(), (0..count).rev().map(term).collect::<Vec<_>>());
            let each = if fall.exponential() == Exponential::Gaussian { 2 } else { 1 };
            let computed = steps.iter().filter(|step| step.squarings.is_none()).count();
            prop_assert_eq!(computed, (count as usize).div_ceil(1 + (MOST / each) as usize));
            prop_assert!(steps.iter().all(|step| step.squarings.is_none_or(|squarings| squarings == each)));
        }
    }

    const MOST: u32 = 6;
}
