use align::{Aligned, PolicyAlign};
use anyhow::Context as _;
use demo_gen::{Recording, ToySystem, demonstrations};
use experiments::seed::generator;
use experiments::{HELD_OUT, Judge, PARABOLA_SYSTEM, TestSamples, toy_regressor};
use motion::{LearntPolicy, Potential};
use nalgebra::DVector;
use plot::Field;
use rand_chacha::ChaCha8Rng;

use super::{Levels, Movement};
use crate::rounded;

/// Number of movements that alignment leaves out in the paper's picture.
const LEFT_OUT: usize = 3;

/// Number of data sets that are searched for one like the paper's.
const CANDIDATES: u32 = 1000;

/// The surfaces are shown on [−2, 2]², the region of the starts, at this many places per side.
const EXTENT: f64 = 2.0;
const PLACES: u32 = 41;

/// A data set, the result of its alignment, and the generator's state afterwards.
struct Found {
    data_set: u32,
    recordings: Vec<Recording>,
    aligned: Aligned,
    rng: ChaCha8Rng,
}

pub(crate) fn levels(seed: u64) -> anyhow::Result<Levels> {
    let system = ToySystem::default();
    let Found { data_set, recordings, aligned, mut rng } = like_the_paper(&system, seed)?;
    let test = TestSamples::draw(&aligned, HELD_OUT, &mut rng)?;
    let learnt = aligned.learn_without(&test.of_kept, &toy_regressor(), &mut rng)?;
    let potential = learnt.global_potential();
    let judge = Judge::new(&recordings, &test.of_kept);
    let kept = aligned.samples().states();
    let height = |potential: &dyn Potential| kept.column_iter().map(|state| potential.value(state)).sum::<f64>();
    let raise = (height(&system.potential) - height(potential)) / kept.ncols() as f64;
    Ok(Levels {
        data_set,
        movements: movements(&recordings, &aligned),
        truth: Field::new(side(), side(), surface(|x| rounded(system.potential.value(x.as_view()), 5)))?,
        learnt: surface(|x| {
            (learnt.support(x.as_view()) > 0.0).then(|| rounded(potential.value(x.as_view()) + raise, 5))
        }),
        alignment_nmse: judge.alignment(&aligned)?,
        potential_nmse: judge.potential(potential)?,
    })
}

/// The first data set of Table 1's parabola with narrow bandwidth from which alignment leaves out as many movements as in the paper's
/// picture.
fn like_the_paper(system: &ToySystem, seed: u64) -> anyhow::Result<Found> {
    for data_set in 0..CANDIDATES {
        let mut rng = generator(seed, PARABOLA_SYSTEM, data_set);
        let recordings = system.record(&mut rng)?;
        let aligned = PolicyAlign::default().align(&demonstrations(&recordings)?)?;
        if aligned.discarded().len() == LEFT_OUT {
            return Ok(Found { data_set, recordings, aligned, rng });
        }
    }
    None.with_context(|| format!("no data set of {CANDIDATES} leaves out {LEFT_OUT} movements; try another --seed"))
}

fn movements(recordings: &[Recording], aligned: &Aligned) -> Vec<Movement> {
    let before: Vec<&[f64]> = aligned.local_potentials().map(|local| local.values()).collect();
    let raised = |values: &[f64], by: f64| values.iter().map(|value| rounded(value + by, 4)).collect::<Vec<_>>();
    let deepest = before.concat().into_iter().fold(f64::INFINITY, f64::min);
    // Valid because the offsets sum to 0 and all movements are equally long.
    let kept = aligned.kept().iter();
    let level = mean(kept.map(|&k| recordings[k].truth.potential.mean() - mean(before[k].iter().copied())));
    let movement = |(trajectory, recording): (usize, &Recording)| {
        let values = before[trajectory];
        Movement {
            points: recording.truth.states.column_iter().map(|x| (rounded(x[0], 4), rounded(x[1], 4))).collect(),
            truth: raised(recording.truth.potential.as_slice(), 0.0),
            before: raised(values, -deepest),
            after: aligned.offset(trajectory).map(|offset| raised(values, offset + level)),
        }
    };
    recordings.iter().enumerate().map(movement).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Coordinates along one side of the square.
fn side() -> Vec<f64> {
    let place = |i| EXTENT * (2.0 * f64::from(i) / f64::from(PLACES - 1) - 1.0);
    (0..PLACES).map(|i| rounded(place(i), 4)).collect()
}

fn surface<T>(value: impl Fn(DVector<f64>) -> T) -> Vec<Vec<T>> {
    let row = |&y: &f64| side().iter().map(|&x| value(DVector::from_vec(vec![x, y]))).collect();
    side().iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use metrics::potential_nmse;

    use super::*;

    #[test]
    fn alignment_recovers_the_common_potential() {
        let levels = levels(1).unwrap();
        assert_eq!(levels.movements.iter().filter(|movement| movement.after.is_none()).count(), LEFT_OUT);
        assert!(levels.movements.iter().all(|movement| movement.before[0] == levels.movements[0].before[0]));

        let kept: Vec<_> = levels.movements.iter().filter(|movement| movement.after.is_some()).collect();
        let all = |of: fn(&Movement) -> &[f64]| DVector::from_vec(kept.iter().flat_map(|m| of(m).to_vec()).collect());
        let (truth, before) = (all(|movement| &movement.truth), all(|movement| &movement.before));
        let after = all(|movement| movement.after.as_deref().unwrap());
        assert!(potential_nmse(&truth, &before).unwrap() > 0.5);
        assert!(potential_nmse(&truth, &after).unwrap() < 0.01);
        assert!((truth.mean() - after.mean()).abs() < 1e-4);
    }

    #[test]
    fn the_learnt_surface_is_near_the_truth_where_movements_are() {
        let levels = levels(1).unwrap();
        let middle = 10..31;
        for (truth, learnt) in levels.truth.values()[middle.clone()].iter().zip(&levels.learnt[middle.clone()]) {
            for (truth, learnt) in truth[middle.clone()].iter().zip(&learnt[middle.clone()]) {
                assert!((truth - learnt.unwrap()).abs() < 0.03, "{truth} {learnt:?}");
            }
        }
    }
}
