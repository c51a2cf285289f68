//! Test samples, which no learner sees, so that all can be tested on them.

use align::Aligned;
use demo_gen::Recording;
use motion::SampleIndex;
use rand_chacha::ChaCha8Rng;

use crate::evaluation::judge::Judge;
use crate::seed::separate_stream;

/// The held-out samples of one data set, ascending.
pub struct TestSamples {
    /// Of the trajectories that alignment keeps.
    pub of_kept: Vec<SampleIndex>,
    /// Of all trajectories: the same samples, and the same share of samples of the discarded trajectories.
    pub of_all: Vec<SampleIndex>,
}

impl TestSamples {
    /// The judges on samples of kept movements, and of all movements.
    pub(crate) fn judges<'a>(&self, recordings: &'a [Recording]) -> [Judge<'a>; 2] {
        [&self.of_kept, &self.of_all].map(|samples| Judge::new(recordings, samples))
    }

    /// Draws a share of the samples, in (0, 1). Those of discarded trajectories come from a separate random stream, so that they do
    /// not change the random numbers that learning uses afterwards.
    ///
    /// # Errors
    /// If there are no samples to draw from.
    pub fn draw(aligned: &Aligned, share: f64, rng: &mut ChaCha8Rng) -> anyhow::Result<TestSamples> {
        let demonstrations = aligned.demonstrations();
        let of_kept = demonstrations.hold_out_samples(aligned.kept(), share, rng)?;
        let mut of_all = of_kept.clone();
        if !aligned.discarded().is_empty() {
            of_all.extend(demonstrations.hold_out_samples(aligned.discarded(), share, &mut separate_stream(rng))?);
            of_all.sort_unstable();
        }
        Ok(TestSamples { of_kept, of_all })
    }
}

#[cfg(test)]
mod tests {
    use align::PolicyAlign;
    use demo_gen::{ToySystem, demonstrations};
    use rand::Rng as _;

    use super::*;
    use crate::seed::generator;

    #[test]
    fn a_tenth_is_held_out_of_the_kept_and_of_the_discarded() {
        let recordings = ToySystem::default().record(&mut generator(1, 0, 3)).unwrap();
        let aligned = PolicyAlign::default().align(&demonstrations(&recordings).unwrap()).unwrap();
        let (kept, discarded) = (aligned.kept().len(), aligned.discarded().len());
        assert!(kept > 20 && discarded > 1, "{kept} {discarded}");
        let mut rng = generator(1, 0, 3);
        let TestSamples { of_kept, of_all } = TestSamples::draw(&aligned, 0.1, &mut rng).unwrap();
        assert_eq!((of_kept.len(), of_all.len()), (kept * 40 / 10, kept * 40 / 10 + discarded * 40 / 10));
        let is_kept = |at: &&SampleIndex| aligned.kept().contains(&at.trajectory);
        assert!(of_all.is_sorted() && of_all.iter().filter(is_kept).eq(&of_kept));

        // Drawing only the samples of kept trajectories leaves the generator in the same state.
        let mut other = generator(1, 0, 3);
        assert_eq!(aligned.demonstrations().hold_out_samples(aligned.kept(), 0.1, &mut other).unwrap(), of_kept);
        assert_eq!(rng.next_u64(), other.next_u64());
    }
}
