//! Policies and potentials that were learnt allocate nothing when they are asked.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.
#![allow(unsafe_code, reason = "counting allocations needs an allocator")]

mod drawn;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use drawn::{descent, rng, rows, vector};
use gp::{CurlTest, DirectGp, ReadingLearner, SlopeGp};
use motion::{LearntPolicy, Policy, Potential as _};
use nalgebra::DVector;

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: everything is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How often this thread allocates in `work`.
fn allocations(work: impl FnOnce()) -> usize {
    let before = COUNT.get();
    work();
    COUNT.get() - before
}

#[test]
fn actions_and_potentials_allocate_nothing() {
    for dim in [1, 2, 6] {
        // More rows than one chunk of them.
        let given = rows(dim, (6, 15), descent, &mut rng(1));
        let slope = SlopeGp { curl_test: CurlTest::AssumePotential, ..SlopeGp::default() };
        let learner = ReadingLearner { slope, direct: DirectGp::default(), ..ReadingLearner::default() };
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
