//! Learnt policies and potentials do not allocate when they are evaluated.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.

#[allow(dead_code, reason = "made for more than this")]
mod drawn;

use drawn::{descent, rng, rows, vector};
use gp::{AutoGp, CurlTest, SlopeGp};
use motion::{LearntPolicy, Policy, Potential as _};
use nalgebra::DVector;

/// Number of allocations of this thread in `work`.
fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

#[test]
fn actions_and_potentials_allocate_nothing() {
    for dim in [1, 2, 6] {
        // More rows than fit in one chunk.
        let given = rows(dim, (6, 15), descent, &mut rng(1));
        let slope = SlopeGp { curl_test: CurlTest::AssumePotential, ..SlopeGp::default() };
        let learner = AutoGp { slope, ..AutoGp::default() };
        let both = learner.fit(&given, &mut rng(2)).unwrap();
        let (x, mut action) = (vector(dim, &mut rng(3)), DVector::zeros(dim));
        let policies: [&dyn LearntPolicy; 3] = [both.slope(), both.direct(), &both];
        for policy in policies {
            assert_eq!(allocations(|| policy.action_into(x.as_view(), action.as_view_mut())), 0, "{dim}");
        }
        let potential = both.slope().potential().unwrap();
        let mut value = 0.0;
        let count = allocations(|| {
            value = potential.value(x.as_view());
            potential.gradient_into(x.as_view(), action.as_view_mut());
        });
        assert_eq!((count, value.is_finite()), (0, true), "{dim}");
        assert_ne!(allocations(|| drop(both.action(x.as_view()))), 0, "what allocates is counted");
    }
}
