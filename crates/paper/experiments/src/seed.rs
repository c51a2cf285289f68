//! Random numbers: one independent stream for each system and data set.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// The generator of one data set of one system.
///
/// The stream depends on nothing else. Hence rows that differ only in a learner's parameters use the same demonstrations, and a
/// single row equals that row of a full run.
pub fn generator(seed: u64, system: u32, data_set: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(system) << 32 | u64::from(data_set));
    rng
}

/// A generator with a separate stream, which no data set uses. Drawing from it does not affect the generator of the
/// data set, and its stream does not depend on that generator's position.
pub fn separate_stream(rng: &ChaCha8Rng) -> ChaCha8Rng {
    apart(rng, 1 << 63)
}

/// A generator of test movements, with a stream that neither data sets nor [`separate_stream`] use.
pub(crate) fn fresh(rng: &ChaCha8Rng) -> ChaCha8Rng {
    apart(rng, 1 << 62)
}

/// The beginning of the data set's stream with one more bit set, above the bits of a data set's number.
fn apart(rng: &ChaCha8Rng, bit: u64) -> ChaCha8Rng {
    let mut apart = rng.clone();
    apart.set_stream(rng.get_stream() | bit);
    apart.set_word_pos(0);
    apart
}
