#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::exp_in_bulk as exp;
use serde::{Deserialize, Serialize};

use crate::kernel::chunks::{CHUNK, Chunk};

/// Decay of a covariance with distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// e^{−ρ²/2ℓ²}: for policies without kinks.
    SquaredExponential,
    /// Matérn 5/2: for policies whose slope may change quickly.
    Matern52,
    /// Matérn 3/2: for policies that may jump, that is, potentials with kinks.
    Matern32,
}

/// A shape with a length ℓ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radial {
    pub(crate) shape: Shape,
    pub(crate) length: f64,
}

/// g and h of (S3) for every pair: the slope–slope covariance is g ν − h β_i β_j.
pub(crate) trait Slopes: Copy {
    /// g and h at one squared distance.
    fn at(self, squared_distance: f64) -> (f64, f64);
}

#[derive(Clone, Copy)]
struct SquaredExponential(f64);
#[derive(Clone, Copy)]
struct Matern52(f64);
#[derive(Clone, Copy)]
struct Matern32(f64);
#[derive(Clone, Copy)]
struct DivergenceFree(f64, f64);

impl Slopes for SquaredExponential {
    #[inline(always)]
    fn at(self, squared_distance: f64) -> (f64, f64) {
        let inverse = 1.0 / (self.0 * self.0);
        let g = exp(-0.5 * squared_distance * inverse);
        (g, g * inverse)
    }
}

impl Slopes for Matern52 {
    #[inline(always)]
    fn at(self, squared_distance: f64) -> (f64, f64) {
        let a = (5.0 * squared_distance).sqrt() / self.0;
        let e = exp(-a);
        ((1.0 + a) * e, 5.0 / (self.0 * self.0) * e)
    }
}

impl Slopes for Matern32 {
    #[inline(always)]
    fn at(self, squared_distance: f64) -> (f64, f64) {
        let distance = squared_distance.sqrt();
        let rate = 3.0_f64.sqrt() / self.0;
        let g = exp(-rate * distance);
        // At distance 0 the product h β_i β_j is 0 for any h.
        (g, rate * g / if distance > 1e-12 { distance } else { 1e-12 })
    }
}

impl DivergenceFree {
    /// g and h at one squared distance; `moving` is its part along the state, the rest lies along the context.
    #[inline(always)]
    fn at(self, squared_distance: f64, moving: f64) -> (f64, f64) {
        let DivergenceFree(length, dim) = self;
        let inverse = 1.0 / (length * length);
        let e = exp(-0.5 * (squared_distance * inverse)) / (dim - 1.0).max(1.0);
        (e * ((dim - 1.0) - moving * inverse), -e * inverse)
    }
}

/// Adds `amplitude` times g and h for a chunk of squared distances.
#[inline(always)]
fn add<S: Slopes>(slopes: S, amplitude: f64, squared_distances: &Chunk, g: &mut Chunk, h: &mut Chunk) {
    for lane in 0..CHUNK {
        let (own_g, own_h) = slopes.at(squared_distances[lane]);
        g[lane] += amplitude * own_g;
        h[lane] += amplitude * own_h;
    }
}

impl Radial {
    /// g and h of (S3) at one squared distance.
    pub(crate) fn slopes_at(self, squared_distance: f64) -> (f64, f64) {
        match self.shape {
            Shape::SquaredExponential => SquaredExponential(self.length).at(squared_distance),
            Shape::Matern52 => Matern52(self.length).at(squared_distance),
            Shape::Matern32 => Matern32(self.length).at(squared_distance),
        }
    }

    #[inline(always)]
    pub(crate) fn add_slopes(self, amplitude: f64, squared_distances: &Chunk, g: &mut Chunk, h: &mut Chunk) {
        match self.shape {
            Shape::SquaredExponential => add(SquaredExponential(self.length), amplitude, squared_distances, g, h),
            Shape::Matern52 => add(Matern52(self.length), amplitude, squared_distances, g, h),
            Shape::Matern32 => add(Matern32(self.length), amplitude, squared_distances, g, h),
        }
    }

    /// The covariance of the function values themselves, 1 at distance 0.
    #[inline(always)]
    pub(crate) fn value_at(self, squared_distance: f64) -> f64 {
        match self.shape {
            Shape::SquaredExponential => exp(-0.5 * squared_distance / (self.length * self.length)),
            Shape::Matern52 => {
                let a = (5.0 * squared_distance).sqrt() / self.length;
                (1.0 + a + a * a / 3.0) * exp(-a)
            }
            Shape::Matern32 => {
                let a = (3.0 * squared_distance).sqrt() / self.length;
                (1.0 + a) * exp(-a)
            }
        }
    }

    /// Variance of the potential if its slopes have variance 1: (S5) at distance 0.
    pub(crate) fn potential_variance(self) -> f64 {
        let squared = self.length * self.length;
        match self.shape {
            Shape::SquaredExponential => squared,
            Shape::Matern52 => 0.6 * squared,
            Shape::Matern32 => squared / 3.0,
        }
    }

    #[inline(always)]
    pub(crate) fn add_values(self, amplitude: f64, squared_distances: &Chunk, values: &mut Chunk) {
        // One loop per shape, because a branch inside would prevent vectorisation.
        match self.shape {
            Shape::SquaredExponential => add_each(amplitude, squared_distances, values, |squared| {
                Radial { shape: Shape::SquaredExponential, ..self }.value_at(squared)
            }),
            Shape::Matern52 => add_each(amplitude, squared_distances, values, |squared| {
                Radial { shape: Shape::Matern52, ..self }.value_at(squared)
            }),
            Shape::Matern32 => add_each(amplitude, squared_distances, values, |squared| {
                Radial { shape: Shape::Matern32, ..self }.value_at(squared)
            }),
        }
    }
}

#[inline(always)]
fn add_each(amplitude: f64, squared_distances: &Chunk, values: &mut Chunk, value_at: impl Fn(f64) -> f64) {
    for lane in 0..CHUNK {
        values[lane] += amplitude * value_at(squared_distances[lane]);
    }
}

/// g and h of the divergence-free block in `dim` dimensions, at a squared distance whose part along the state is
/// `moving`.
pub(crate) fn divergence_free_at((length, dim): (f64, usize), squared_distance: f64, moving: f64) -> (f64, f64) {
    DivergenceFree(length, dim as f64).at(squared_distance, moving)
}

#[inline(always)]
pub(crate) fn add_divergence_free(
    (length, dim): (f64, usize),
    amplitude: f64,
    (squared_distances, moving): (&Chunk, &Chunk),
    g: &mut Chunk,
    h: &mut Chunk,
) {
    let slopes = DivergenceFree(length, dim as f64);
    for lane in 0..CHUNK {
        let (own_g, own_h) = slopes.at(squared_distances[lane], moving[lane]);
        g[lane] += amplitude * own_g;
        h[lane] += amplitude * own_h;
    }
}
