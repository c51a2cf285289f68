//! Readings of free, constrained and other movements, and the error of each policy.

use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
use demo_gen::demonstrations;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::comparison::{Comparison, Method, row_id};
use crate::evaluation::gaussians::{Gaussians, rows};
use crate::evaluation::judge::Judge;
use crate::evaluation::observation_model::{ObservationModel, samples_of};
use crate::measure::{Measure, RowOf};
use crate::seed::separate_stream;
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The system of the first kind; the others follow.
const FIRST_SYSTEM: u32 = 600;

/// Description of the test samples.
const TESTED_ON: &str = "the true states of all samples; handwriting: of two movements that were not learnt from";

/// The learners.
const METHODS: [Method; 3] = [Method::SlopeGp, Method::DirectGp, Method::AutoGp];

/// A kind of movements.
struct Kind {
    name: &'static str,
    system: BeyondSystem,
    /// Number of trajectories at the end that are held out for testing.
    held_out: usize,
    data_sets: Option<u32>,
}

/// The kinds in the order of the table. New ones must be last, because the position determines the random numbers.
fn kinds() -> Vec<Kind> {
    use ConstraintKind::{Free, HalfFree, OneForAll, Varying};
    use PolicyKind::{Handwriting, LimitCycle, Planes, Sinusoidal, Swirl, Wells};
    let (wells, swirl) = (Wells { dim: 3 }, Swirl { dim: 3 });
    let (kinks, far_kinks, softplus) =
        (Planes { dim: 2, edge: 0.0 }, Planes { dim: 6, edge: 0.0 }, Planes { dim: 6, edge: 0.1 });
    let kind = |name, policy, n_trajectories, constraint| {
        let system = BeyondSystem { policy, n_trajectories, constraint, ..BeyondSystem::default() };
        Kind { name, system, held_out: 0, data_sets: None }
    };
    let handwriting = kind("handwriting/7-demonstrations", Handwriting, 7, Free);
    vec![
        kind("free/sinus-2d", Sinusoidal, 20, Free),
        kind("free/sinus-2d-5-demonstrations", Sinusoidal, 5, Free),
        kind("free/wells-3d", wells, 20, Free),
        kind("free/wells-3d-5-demonstrations", wells, 5, Free),
        kind("free/swirl-3d", swirl, 20, Free),
        kind("free/limit-cycle-2d", LimitCycle, 20, Free),
        kind("free/relu-2d", kinks, 20, Free),
        kind("free/softplus-6d", softplus, 20, Free),
        kind("varying/sinus-2d", Sinusoidal, 20, Varying),
        kind("varying/sinus-2d-5-demonstrations", Sinusoidal, 5, Varying),
        kind("varying/wells-3d", wells, 20, Varying),
        kind("varying/wells-3d-5-demonstrations", wells, 5, Varying),
        kind("varying/swirl-3d", swirl, 20, Varying),
        kind("varying/relu-2d", kinks, 20, Varying),
        kind("varying/relu-6d", far_kinks, 40, Varying),
        kind("varying/softplus-6d", softplus, 40, Varying),
        kind("half-free/sinus-2d", Sinusoidal, 20, HalfFree),
        kind("half-free/wells-3d", wells, 20, HalfFree),
        kind("half-free/relu-2d", kinks, 20, HalfFree),
        kind("one-for-all/sinus-2d", Sinusoidal, 20, OneForAll),
        kind("one-for-all/wells-3d", wells, 20, OneForAll),
        kind("one-for-all/relu-2d", kinks, 20, OneForAll),
        kind("one-for-all/softplus-6d", softplus, 20, OneForAll),
        Kind { held_out: 2, data_sets: Some(30), ..handwriting },
    ]
}

/// The experiment.
pub(crate) fn readings() -> Experiment {
    let comparisons = kinds().iter().map(|kind| Comparison::of(kind.name, Measure::Nupe, &METHODS)).collect();
    Experiment {
        id: "readings",
        section: "none",
        title: "How movements are read: free, constrained, or ambiguous",
        data_sets: 5,
        remark: "Movements as in the experiment beyond, with exact velocities: free, each under constraints of its own, every other one free, \
                 all under the same constraint. Handwriting is free movement in a corridor, learnt from five demonstrations and tested on \
                 two others. The Gaussian processes learn from at most 400 rows.",
        decisions: "beyond.md",
        comparisons,
        setups: (FIRST_SYSTEM..).zip(kinds()).map(setup).collect(),
        ..Experiment::default()
    }
}

fn setup((number, kind): (u32, Kind)) -> Setup {
    let Kind { name, system, held_out, data_sets } = kind;
    let row = |method| Row { id: row_id(name, method), of: RowOf::Additional, tested_on: TESTED_ON };
    let gaussians = Gaussians::new(ObservationModel::Velocities.front_end(), 400);
    let trial = ReadingTrial { system, held_out, gaussians };
    Setup { data_sets, ..Setup::new(name, number, 14_000_000, METHODS.map(row).into(), trial) }
}

#[derive(Serialize)]
struct ReadingTrial {
    system: BeyondSystem,
    held_out: usize,
    gaussians: Gaussians,
}

impl Trial for ReadingTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.system.record(rng)?;
        let learnt_from = recordings.len() - self.held_out;
        let tested_on = if self.held_out == 0 { 0..learnt_from } else { learnt_from..recordings.len() };
        let judge = Judge::new(&recordings, &samples_of(&recordings, tested_on));
        let both = self.gaussians.both(&demonstrations(&recordings[..learnt_from])?, &[], &mut separate_stream(rng))?;
        Ok(rows(&judge, &both)?.into())
    }
}
