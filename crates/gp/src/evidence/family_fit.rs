use nalgebra::DVector;
use rayon::prelude::*;

use crate::evidence::lbfgs::{Bounds, Curvature, Limits, minimise};
use crate::evidence::{Task, Workspace};
use crate::kernel::covariance::Covariance;
use crate::kernel::family::Family;
use crate::left_out::LeftOutPredictions;
use crate::left_out::level::{Level, Targets};

/// A family with amplitudes from the marginal likelihood and noise increased by held-out prediction.
#[derive(Debug)]
pub(crate) struct FamilyFit {
    /// a_b, (B).
    pub(crate) amplitudes: Vec<f64>,
    pub(crate) level: Level,
}

impl FamilyFit {
    /// The fit at a given θ = (log a_1 .. log a_B, log σ²) and κ; `None` if the covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub(crate) fn at(covariance: &impl Covariance, theta: &[f64], kappa: f64, targets: &Targets) -> Option<FamilyFit> {
        let blocks = covariance.n_blocks();
        assert_eq!(theta.len(), blocks + 1, "one log amplitude a block, and the noise");
        let amplitudes: Vec<f64> = theta[..blocks].iter().map(|log| log.exp()).collect();
        let level = Level::at(&covariance.sum(&amplitudes), theta[blocks].exp(), kappa, targets)?;
        Some(FamilyFit { amplitudes, level })
    }
}

/// Start of the first search: all a_b, and σ² for every search.
const AMPLITUDE: f64 = 0.3;
const NOISE: f64 = 1e-2;
/// From this number of hyper rows on, half of them are searched first. That takes an eighth of the work and leads most of the
/// way.
const WORTH_TWO_SEARCHES: usize = 200;
/// Limits on half of the rows, and then (or directly) on all of them.
const ON_HALF: Limits = Limits { iterations: 40, tolerance: 1e-4 };
const AFTER_HALF: Limits = Limits { iterations: 12, tolerance: 1e-5 };
const AT_ONCE: Limits = Limits { iterations: 40, tolerance: 1e-5 };

/// Minimises (S8) on the hyper rows from equal amplitudes, then increases κ on all rows. If the result does not predict nearly
/// exactly, also searches from a second start, amplitudes (B): (S8) may have several minima, which left-out movements
/// distinguish. `None` if there is no Cholesky factor even at κ = 1.
pub(crate) fn fit_family(
    covariance: &impl Covariance,
    hyper: &[usize],
    targets: &Targets,
    second_start: Option<&[f64]>,
) -> Option<FamilyFit> {
    let search = Search::new(covariance, hyper, targets);
    let first = search.from(&vec![AMPLITUDE; covariance.n_blocks()]);
    let settled = first.as_ref().is_some_and(|fit| fit.level.left_out.is_nearly_exact());
    let Some(second_start) = second_start.filter(|_| !settled) else { return first };
    let r_squared = |fit: &FamilyFit| fit.level.left_out.r_squared;
    match (first, search.from(second_start)) {
        (Some(first), Some(second)) if r_squared(&second) <= r_squared(&first) => Some(first),
        (first, second) => second.or(first),
    }
}

/// The search of a family, from any start.
struct Search<'a, C> {
    covariance: &'a C,
    targets: &'a Targets,
    /// The objectives of successive searches, each with its limits.
    tasks: Vec<(Task, Limits)>,
}

impl<'a, C: Covariance> Search<'a, C> {
    fn new(covariance: &'a C, hyper: &[usize], targets: &'a Targets) -> Self {
        let among = |rows: &[usize]| Task::of(covariance, rows, targets);
        let tasks = if hyper.len() < WORTH_TWO_SEARCHES {
            vec![(among(hyper), AT_ONCE)]
        } else {
            let half: Vec<usize> = hyper.iter().step_by(2).copied().collect();
            vec![(among(&half), ON_HALF), (among(hyper), AFTER_HALF)]
        };
        Search { covariance, targets, tasks }
    }

    /// The fit found by a search from these amplitudes, (B); `None` without a Cholesky factor.
    fn from(&self, amplitudes: &[f64]) -> Option<FamilyFit> {
        let blocks = amplitudes.len();
        let with_noise = |amplitude: f64, noise: f64| {
            DVector::from_fn(blocks + 1, |k, _| if k < blocks { amplitude } else { noise })
        };
        let bounds = Bounds { lower: with_noise(-23.0, 1e-12_f64.ln()), upper: with_noise(12.0, 2.0) };
        let start = amplitudes.iter().copied().chain([NOISE]).map(f64::ln);
        let (mut theta, mut curvature) = (DVector::from_iterator(blocks + 1, start), Curvature::default());
        for (task, limits) in &self.tasks {
            let mut workspace = Workspace::default();
            theta = minimise(|theta| task.evidence(theta, &mut workspace), &theta, &bounds, *limits, &mut curvature);
            // J of twice as many rows has about twice the curvature.
            curvature.scale(2.0);
        }
        let amplitudes: Vec<f64> = theta.iter().take(blocks).map(|log| log.exp()).collect();
        let level = Level::best(&self.covariance.sum(&amplitudes), theta[blocks].exp(), self.targets)?;
        Some(FamilyFit { amplitudes, level })
    }
}

/// Fits one family, and if it does not predict exactly, all others in parallel. Results are in the order of the families.
pub(crate) fn each_until_exact<T: Send>(
    families: &[Family],
    attempt: impl Fn(Family) -> Option<T> + Sync,
    left_out: impl Fn(&T) -> &LeftOutPredictions,
) -> Vec<(Family, Option<T>)> {
    let Some((&first, others)) = families.split_first() else { return Vec::new() };
    let mut tried = vec![(first, attempt(first))];
    if !tried[0].1.as_ref().is_some_and(|first| left_out(first).is_exact()) {
        tried.par_extend(others.par_iter().map(|&family| (family, attempt(family))));
    }
    tried
}
