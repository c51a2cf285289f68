//! How free, constrained and other movements are read, and what each policy is worth there.

use std::collections::BTreeMap;

use demo_gen::beyond::{BeyondSystem, ConstraintKind, Shown};
use demo_gen::demonstrations;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::contest::{Contest, Contestant, row_id};
use crate::evaluation::exam::errors;
use crate::evaluation::gaussians::{Gaussians, own_expectations, reading_of};
use crate::evaluation::judge::Judge;
use crate::evaluation::observation_model::{ObservationModel, samples_of};
use crate::measure::{Measure, RowOf};
use crate::seed::beside;
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The first of the systems; the kinds follow.
const FIRST_SYSTEM: u32 = 600;

/// What its rows test on.
const TESTED_ON: &str = "the true states of all samples; handwriting: of two movements that were not learnt from";

/// Who learns.
const CONTESTANTS: [Contestant; 3] = [Contestant::SlopeGp, Contestant::DirectGp, Contestant::AutoGp];

/// Movements of one kind.
struct Kind {
    name: &'static str,
    shown: Shown,
    n_trajectories: usize,
    hindrance: ConstraintKind,
    /// Trajectories at the end that are not learnt from but tested on.
    held_out: usize,
    data_sets: Option<u32>,
}

/// In the order of the table; new ones last, since each has its own random numbers.
fn kinds() -> Vec<Kind> {
    use ConstraintKind::{Free, HalfFree, OneForAll, Varying};
    use Shown::{LimitCycle, Planes, Sinusoidal, Swirl, Wells};
    let (wells, swirl) = (Wells { dim: 3 }, Swirl { dim: 3 });
    let (kinks, far_kinks, softplus) =
        (Planes { dim: 2, edge: 0.0 }, Planes { dim: 6, edge: 0.0 }, Planes { dim: 6, edge: 0.1 });
    let rows = [
        ("free/sinus-2d", Sinusoidal, 20, Free),
        ("free/sinus-2d-5-demonstrations", Sinusoidal, 5, Free),
        ("free/wells-3d", wells, 20, Free),
        ("free/wells-3d-5-demonstrations", wells, 5, Free),
        ("free/swirl-3d", swirl, 20, Free),
        ("free/limit-cycle-2d", LimitCycle, 20, Free),
        ("free/relu-2d", kinks, 20, Free),
        ("free/softplus-6d", softplus, 20, Free),
        ("varying/sinus-2d", Sinusoidal, 20, Varying),
        ("varying/sinus-2d-5-demonstrations", Sinusoidal, 5, Varying),
        ("varying/wells-3d", wells, 20, Varying),
        ("varying/wells-3d-5-demonstrations", wells, 5, Varying),
        ("varying/swirl-3d", swirl, 20, Varying),
        ("varying/relu-2d", kinks, 20, Varying),
        ("varying/relu-6d", far_kinks, 40, Varying),
        ("varying/softplus-6d", softplus, 40, Varying),
        ("half-free/sinus-2d", Sinusoidal, 20, HalfFree),
        ("half-free/wells-3d", wells, 20, HalfFree),
        ("half-free/relu-2d", kinks, 20, HalfFree),
        ("one-for-all/sinus-2d", Sinusoidal, 20, OneForAll),
        ("one-for-all/wells-3d", wells, 20, OneForAll),
        ("one-for-all/relu-2d", kinks, 20, OneForAll),
        ("one-for-all/softplus-6d", softplus, 20, OneForAll),
    ];
    let kind = |(name, shown, n_trajectories, hindrance)| Kind {
        name,
        shown,
        n_trajectories,
        hindrance,
        held_out: 0,
        data_sets: None,
    };
    let handwriting = Kind {
        held_out: 2,
        data_sets: Some(30),
        ..kind(("handwriting/7-demonstrations", Shown::Handwriting, 7, Free))
    };
    rows.map(kind).into_iter().chain([handwriting]).collect()
}

/// The experiment.
pub(crate) fn readings() -> Experiment {
    let contests = kinds().iter().map(|kind| Contest::of(kind.name, Measure::Nupe, &CONTESTANTS)).collect();
    let (paper, explanations) = Default::default();
    Experiment {
        id: "readings",
        section: "none",
        title: "How movements are read: free, constrained, or ambiguous",
        data_sets: 5,
        remark: "Movements as in the experiment beyond, with exact velocities: free, each under constraints of its own, every other one free, \
                 all under the same constraint. Handwriting is free movement in a corridor, learnt from five demonstrations and tested on \
                 two others. The Gaussian processes learn from at most 400 rows.",
        reservations: &[],
        decisions: "beyond.md",
        contests_remark: None,
        another_reading_of: None,
        contests,
        setups: (FIRST_SYSTEM..).zip(kinds()).map(setup).collect(),
        paper,
        explanations,
    }
}

fn setup((system_number, kind): (u32, Kind)) -> Setup {
    let Kind { name, shown, n_trajectories, hindrance, held_out, data_sets } = kind;
    let row = |contestant| Row { id: row_id(name, contestant), of: RowOf::Contestant, tested_on: TESTED_ON };
    let system = BeyondSystem { shown, n_trajectories, hindrance, ..BeyondSystem::default() };
    let gaussians = Gaussians::new(ObservationModel::Velocities.front_end(), 400);
    Setup {
        id: name.to_owned(),
        rows: CONTESTANTS.map(row).into(),
        system: system_number,
        data_sets,
        cost: 8_000_000,
        trial: Box::new(ReadingTrial { system, held_out, gaussians }),
    }
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
        let both = self.gaussians.both(&demonstrations(&recordings[..learnt_from])?, &[], &mut beside(rng))?;
        let expects = |nupe| BTreeMap::from([(Measure::ExpectedNupe, nupe)]);
        let mut rows = vec![errors(&judge, both.slope())?, errors(&judge, both.direct())?, errors(&judge, &both)?];
        rows[0].extend(own_expectations(both.slope()));
        rows[1].extend(expects(1.0 - both.direct().r_squared()));
        rows[2].extend(expects(both.expected_nupe()));
        rows[2].extend(reading_of(&both));
        Ok(rows)
    }
}
