//! Learns from docs/examples/toy.csv, or the file given, prints the verdict, and follows the policy under a constraint that no
//! demonstration had.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::sync::atomic::AtomicBool;

use policy_align::demo_io::{self, ReadOptions};
use policy_align::motion::{LearntPolicy as _, Policy as _};
use policy_align::nalgebra::{DMatrix, DVector};
use policy_align::{ConstraintSet, FitOptions, PrepareOptions, Progress, RollOut, fit, prepare, spread_starts};

fn main() -> Result<(), Box<dyn Error>> {
    let toy = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/examples/toy.csv");
    let file = std::env::args().nth(1).unwrap_or_else(|| toy.to_owned());
    let recordings = demo_io::read(file.as_ref(), &ReadOptions::default(), &mut |_bytes| ())?;
    let prepared = prepare(&recordings, &PrepareOptions::default())?;
    println!("{} movements, velocities: {:?}", prepared.episodes.len(), prepared.velocities);

    let options = FitOptions { max_rows: 150, ..FitOptions::default() };
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_step| () };
    let model = fit(&prepared, &options, &mut progress)?;
    println!("verdict: {:?}; constraints: {:?}", model.trust.verdict, model.trust.numbers.reading);
    println!("error on movements left out of learning: {:.0e}", model.trust.numbers.held_out_error);
    for finding in &model.trust.findings {
        println!("finding: {}; next: {}", finding.what, finding.next);
    }

    let policy = model.policy();
    let start = spread_starts(&model, 1).pop().unwrap_or_else(|| DVector::zeros(policy.dim()));
    let (action, mut deviation) = (policy.action(start.as_view()), start.clone());
    if policy.action_sd_into(start.as_view(), deviation.as_view_mut()) {
        println!("at {:.2?}: action {:.3?} ± {:.0e}", start.as_slice(), action.as_slice(), deviation.amax());
    }

    // The sum of all coordinates stays constant.
    let constraints = ConstraintSet::normal(DMatrix::from_element(1, policy.dim(), 1.0), policy.dim())?;
    let path = RollOut { constraints, ..RollOut::default() }.follow(&model, &start)?;
    let end = path.states.column(path.states.ncols() - 1);
    println!("under the constraint: from {:.2?} to {:.2?}, {:?}", start.as_slice(), end.as_slice(), path.stop);
    if let Some((by, _)) = path.broken_by {
        println!("the sum of the coordinates changed by {by:.0e}");
    }
    Ok(())
}
