//! A custom learner: the velocity of the nearest recorded state, tested on movements that it did not learn from.

#![allow(clippy::print_stdout, reason = "a program")]

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, SampleIndex, SampleSet};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng as _};

#[derive(Debug)]
struct NearestNeighbour;

/// States and their velocities.
#[derive(Debug)]
struct Memory(Vec<(DVector<f64>, DVector<f64>)>);

impl Learner for NearestNeighbour {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        _rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        let held_out = SampleSet::of(held_out);
        let mut samples = Vec::new();
        for (trajectory, movement) in demonstrations.trajectories().iter().enumerate() {
            for (sample, velocity) in movement.step_velocities().column_iter().enumerate() {
                if !held_out.contains(SampleIndex { trajectory, sample }) {
                    samples.push((movement.state(sample).into_owned(), velocity.into_owned()));
                }
            }
        }
        if samples.is_empty() { Err("no sample is left to learn from".into()) } else { Ok(Box::new(Memory(samples))) }
    }
}

impl Memory {
    fn nearest(&self, state: DVectorView<'_, f64>) -> (f64, &DVector<f64>) {
        let with_distance = self.0.iter().map(|(x, u)| ((x - state).norm(), u));
        with_distance.min_by(|(a, _), (b, _)| a.total_cmp(b)).expect("there is a sample")
    }
}

impl Policy for Memory {
    fn dim(&self) -> usize {
        self.0[0].0.len()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        action.copy_from(self.nearest(state).1);
    }
}

impl LearntPolicy for Memory {
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        (-self.nearest(state).0).exp()
    }
}

fn main() -> Result<(), LearnError> {
    // 24 movements towards the origin, π(x) = −x, at 20 Hz.
    let movements = (0..24).map(|k| {
        let angle = 0.25 * f64::from(k);
        DMatrix::from_fn(2, 40, |axis, i| [angle.cos(), angle.sin()][axis] * (-0.05 * i as f64).exp())
    });
    let demonstrations = Demonstrations::from_states(movements, 0.05)?;
    let mut rng = StdRng::seed_from_u64(1);
    let held_out = demonstrations.hold_out_trajectories(0.25, &mut rng)?;
    let learnt = NearestNeighbour.learn(&demonstrations, &held_out, &mut rng)?;
    println!("learnt from {} of {} samples", demonstrations.n_samples() - held_out.len(), demonstrations.n_samples());
    for index in held_out.iter().step_by(60) {
        let x = demonstrations.trajectories()[index.trajectory].state(index.sample);
        let (truth, action, support) = (-x, learnt.action(x), learnt.support(x));
        println!("action {:+.2?}, true {:+.2?}, support {support:.2}", action.as_slice(), truth.as_slice());
    }
    Ok(())
}
