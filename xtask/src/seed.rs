//! Random numbers: one independent stream for each system and data set.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// The generator of one data set of one system.
///
/// The stream depends on nothing else, so that rows which differ only in a learner's parameters see the same
/// demonstrations, and one row alone equals that row of a full run.
pub(crate) fn generator(seed: u64, system: u32, data_set: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(system) << 32 | u64::from(data_set));
    rng
}
