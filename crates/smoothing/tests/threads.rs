//! The same bits at any number of threads.

use motion::{Demonstrations, Trajectory};
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smoothing::{Fused, Fusion, Smoothed, Smoother};

fn demonstrations() -> Demonstrations {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let movements = (0..15).map(|k| {
        let n = 20 + 3 * k;
        let velocities = DMatrix::from_fn(3, n, |j, i| (0.1 * i as f64 + j as f64 + k as f64).cos());
        let states = DMatrix::from_fn(3, n, |j, i| {
            let noise: f64 = StandardNormal.sample(&mut rng);
            10.0 * (0.1 * i as f64 + j as f64 + k as f64).sin() + 0.1 * noise
        });
        Trajectory::new(states, 1.0).unwrap().with_velocities(velocities).unwrap()
    });
    Demonstrations::new(movements.collect()).unwrap()
}

#[test]
fn results_are_equal_for_any_thread_count() {
    let demonstrations = demonstrations();
    let run = |threads: usize| -> (Smoothed, Fused) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            (Smoother::default().smooth(&demonstrations).unwrap(), Fusion::default().fuse(&demonstrations).unwrap())
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(8));
}
