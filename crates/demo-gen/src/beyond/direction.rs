use nalgebra::DVector;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// A unit vector (dim), uniformly distributed on the sphere.
pub(super) fn direction<R: Rng + ?Sized>(dim: usize, rng: &mut R) -> DVector<f64> {
    DVector::from_fn(dim, |_, _| rng.sample::<f64, _>(StandardNormal)).normalize()
}
