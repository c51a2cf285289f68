//! (S22), (S23), (S41): rows of stretches.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector, DVectorView};
use rayon::prelude::*;

use crate::Rows;
use crate::rows::kept::{Kept, OfStretches, RowLimits, RowsDropped};
use crate::rows::noise_weights::relative;
use crate::rows::thinning::{MIDDLE, thinned};
use crate::stretches::pushes::Pushes;
use crate::stretches::view::{Free, Through};
use crate::stretches::{Stretch, Stretches};
use motion::{SampleIndex, upper_median};

/// Rows are used if their squared length exceeds this share of the mean square of all.
const LEAST: f64 = 1e-12;
/// (S24): minimum mean square of pushes, relative to that of noise alone, for a push to be detected.
const LEAST_SIGNIFICANCE: f64 = 4.0;
/// Maximum contribution of one stretch, per normal: a straight movement looks pushed, and a single one must not decide.
const MOST_OF_ONE: f64 = 40.0;
/// Minimum number of movements that have stretches.
const LEAST_MOVEMENTS: usize = 3;

/// One equation vᵀπ(x) = vᵀu.
struct Equation<'a> {
    /// Row index of the sample.
    row: usize,
    /// v, (n).
    direction: DVectorView<'a, f64>,
    /// vᵀu.
    part: f64,
    /// Variance of vᵀu in units of s².
    noise: f64,
    /// ℓ_k of its direction.
    direction_length: f64,
    /// Noise factor of its stretch.
    doubt: f64,
}

/// At most `most` of the equations that belong to these rows, as indices.
fn thinned_equations(of_rows: &[usize], rows: &Rows, most: usize) -> Vec<usize> {
    let trajectory = |&at: &usize| rows.indices()[of_rows[at]].trajectory;
    let all: Vec<usize> = (0..of_rows.len()).collect();
    thinned(all.chunk_by(|a, b| trajectory(a) == trajectory(b)), most, || MIDDLE)
}

/// Share of the movements of `samples` that have `own` rows, those of stretches; models of fewer movements have to predict correspondingly
/// better.
pub(crate) fn covered(rows: &Rows, own: &Kept, samples: &Kept) -> f64 {
    // Further trajectories have no samples that could be searched for stretches.
    let last = rows.indices().iter().map(|index| index.trajectory).max();
    let count =
        |kept: &Kept| kept.trajectories().into_iter().filter(|&trajectory| Some(trajectory) <= last).count() as f64;
    (count(own) / count(samples)).min(1.0)
}

impl Stretches {
    /// Rows of all samples in stretches, with their noise weights (S23), (S44), evenly thinned to the `limits`. `None` if
    /// they come from too few movements.
    ///
    /// In a task space each sample has several rows, whose directions do not depend on the velocity, so `rows` may be means (S33).
    pub(crate) fn rows(&self, rows: &Rows, kept: &Kept, limits: &RowLimits) -> Option<Kept> {
        let found = self.rows_with(rows, kept, limits.max_rows, &[])?;
        let count = found.rows.len();
        let hyper = (0..count).step_by(count.div_ceil(limits.hyper_rows).max(1)).collect();
        Some(Kept { hyper, ..found })
    }

    /// `some`, rows of these stretches, and about `most` of all their rows, as if no stretch were contradicted, without hyper rows.
    pub(crate) fn of_any(&self, rows: &Rows, some: &Kept, most: usize) -> Option<Kept> {
        let mut all = self.clone();
        all.all.iter_mut().for_each(|stretch| stretch.doubt = 1.0);
        all.rows_with(rows, some, most, &some.rows)
    }

    /// `some`, rows of these stretches, and about `most` of all their rows, without hyper rows; `None` if none were thinned.
    pub(crate) fn more_rows(&self, rows: &Rows, some: &Kept, most: usize) -> Option<Kept> {
        if some.dropped.thinned == 0 {
            return None;
        }
        self.rows_with(rows, some, most, &some.rows)
    }

    /// About `most` of all rows, and those in `also`, without hyper rows.
    fn rows_with(&self, rows: &Rows, kept: &Kept, most: usize, also: &[usize]) -> Option<Kept> {
        let free = self.through.as_ref().map(|through| self.free(through, rows));
        let all = || (0..rows.len()).flat_map(|row| self.equations(rows, free.as_deref(), row));
        let (mut sum, mut count) = (0.0, 0_usize);
        all().for_each(|equation| {
            sum += equation.part.powi(2);
            count += 1;
        });
        let mean_square = sum / count as f64;
        let moving = || all().filter(|equation| equation.part.powi(2) > LEAST * mean_square);
        let of_rows: Vec<usize> = moving().map(|equation| equation.row).collect();
        let mut taken: BTreeSet<usize> = thinned_equations(&of_rows, rows, most).into_iter().collect();
        taken.extend(also);
        let found = of_rows.len();
        let samples = of_rows.chunk_by(|a, b| a == b).count();
        let chosen = moving().enumerate().filter(|(at, _)| taken.contains(at));
        let equations: Vec<Equation<'_>> = chosen.map(|(_, equation)| equation).collect();
        let lengths: Vec<f64> = equations.iter().map(|of| of.part.abs()).collect();
        let policy_squared = 2.0 * upper_median(lengths.clone())?.powi(2);
        let variance =
            |of: &Equation<'_>| of.doubt * self.noise * (of.noise + policy_squared / of.direction_length.powi(2));
        let all: Vec<usize> = (0..equations.len()).collect();
        let index = |at: usize| rows.indices()[equations[at].row];
        let same = |&a: &usize, &b: &usize| index(a).trajectory == index(b).trajectory;
        let groups: Vec<Vec<usize>> = all.chunk_by(same).map(<[usize]>::to_vec).collect();
        if groups.len() < LEAST_MOVEMENTS {
            return None;
        }
        let columns: Vec<DVector<f64>> = equations.iter().map(|of| of.direction * of.part).collect();
        let used: Vec<usize> = equations.iter().map(|of| of.row).collect();
        Some(Kept {
            states: rows.states().select_columns(&used),
            velocities: DMatrix::from_columns(&columns),
            speeds: lengths,
            whole: Some(rows.velocities().select_columns(&used)),
            variances: None,
            of_stretches: Some(OfStretches {
                weights: relative(equations.iter().map(variance).collect()),
                pushes: self.pushed.then(|| self.pushes()),
                space: self.through.as_ref().map(|through| through.space),
                of_sample: found as f64 / samples as f64,
            }),
            indices: used.iter().map(|&row| rows.indices()[row]).collect(),
            groups,
            hyper: Vec::new(),
            grouping: kept.grouping,
            dropped: self.dropped(rows, found - equations.len()),
            rows: taken.into_iter().collect(),
        })
    }

    fn dropped(&self, rows: &Rows, thinned: usize) -> RowsDropped {
        let count = |dropped: RowsDropped, &index: &SampleIndex| {
            let stretch = self.stretch_of(index);
            RowsDropped {
                in_no_stretch: dropped.in_no_stretch + usize::from(stretch.is_none()),
                contradicted: dropped.contradicted + usize::from(stretch.is_some_and(Stretch::is_contradicted)),
                ..dropped
            }
        };
        rows.indices().iter().fold(RowsDropped { thinned, ..RowsDropped::default() }, count)
    }

    /// The directions (S41) of each sample.
    fn free(&self, through: &Through, rows: &Rows) -> Vec<Vec<Free>> {
        let directions = |row: usize| {
            let stretch = self.stretch_of(rows.indices()[row]);
            stretch.map_or_else(Vec::new, |of| through.free(rows, row, &of.directions, &of.lengths))
        };
        (0..rows.len()).into_par_iter().map(directions).collect()
    }

    /// The equations of one sample: (S22), or (S41) for each of its `free` directions.
    fn equations<'a>(
        &'a self,
        rows: &'a Rows,
        free: Option<&'a [Vec<Free>]>,
        row: usize,
    ) -> impl Iterator<Item = Equation<'a>> {
        let stretch = self.stretch_of(rows.indices()[row]);
        let recorded = if free.is_none() { stretch } else { None };
        let recorded = recorded.into_iter().flat_map(|of| of.directions.column_iter().zip(of.lengths.iter().copied()));
        let free =
            free.into_iter().flat_map(move |free| free[row].iter().map(|of| (of.direction.as_view(), of.length)));
        let noise = match (&self.through, rows.variances()) {
            (Some(_), Some(variances)) => variances[row] / self.noise,
            _ => 1.0,
        };
        let doubt = stretch.map_or(1.0, |stretch| stretch.doubt);
        recorded.chain(free).map(move |(direction, direction_length)| {
            let part = direction.dot(&rows.velocities().column(row));
            Equation { row, direction, part, noise, direction_length, doubt }
        })
    }

    /// The stretch that contains a sample.
    fn stretch_of(&self, index: SampleIndex) -> Option<&Stretch> {
        Some(&self.all[self.position_of(index)?])
    }

    /// Index of the stretch that contains a sample.
    pub(crate) fn position_of(&self, index: SampleIndex) -> Option<usize> {
        let before = |stretch: &Stretch| (stretch.trajectory, stretch.samples.1) < (index.trajectory, index.sample);
        let place = self.all.partition_point(before);
        let next = self.all.get(place)?;
        (next.trajectory == index.trajectory && next.samples.0 <= index.sample).then_some(place)
    }

    /// Root mean square of the pushes A⁺b, in units of the state per second.
    pub(crate) fn push(&self) -> f64 {
        let (squares, count) = self
            .uncontradicted()
            .fold((0.0, 0), |(sum, count), stretch| (sum + stretch.push.norm_squared(), count + 1));
        (squares / f64::from(count)).sqrt()
    }

    fn pushes(&self) -> Pushes {
        let columns = |of: fn(&Stretch) -> &DVector<f64>| {
            DMatrix::from_columns(&self.uncontradicted().map(of).cloned().collect::<Vec<_>>())
        };
        Pushes { states: columns(|stretch| &stretch.middle), velocities: columns(|stretch| &stretch.push) }
    }

    /// The stretches that are not contradicted.
    fn uncontradicted(&self) -> impl Iterator<Item = &Stretch> {
        self.all.iter().filter(|stretch| !stretch.is_contradicted())
    }

    /// (S24).
    pub(crate) fn push_is_significant(&self) -> bool {
        self.significance() >= LEAST_SIGNIFICANCE
    }

    /// Mean square of the pushes along normals, relative to that of noise: about 1 if nothing pushes.
    fn significance(&self) -> f64 {
        let all = self.uncontradicted().map(|stretch| stretch.significance);
        let (squares, normals) = all.fold((0.0, 0.0), |(squares, normals), (square, count)| {
            let count = count as f64;
            (squares + square.min(MOST_OF_ONE * count), normals + count)
        });
        squares / normals
    }
}

#[cfg(test)]
mod tests {
    use demo_gen::demonstrations;
    use demo_gen::tasks::CyclesWithTask;
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::FrontEnd;
    use crate::rows::kept::positions;
    use crate::stretches::Switches;
    use crate::stretches::view::View;

    fn stretch((square, normals): (f64, usize)) -> Stretch {
        Stretch {
            trajectory: 0,
            samples: (0, 0),
            directions: DMatrix::zeros(3, 0),
            lengths: Vec::new(),
            push: DVector::zeros(3),
            middle: DVector::zeros(3),
            significance: (square, normals),
            rank: 3 - normals,
            whole: None,
            doubt: 1.0,
        }
    }

    proptest! {
        /// (S24): if nothing pushes, one stretch, however pushed it seems, does not decide; a tenth of all stretches do.
        #[test]
        fn one_stretch_is_no_significant_push(
            normals in 1usize..3,
            count in 20usize..100,
            noise in 0.0f64..1.9,
            apparent in 41.0f64..1e9,
        ) {
            let is_significant = |pushed: usize| {
                let square = |at: usize| normals as f64 * if at < pushed { apparent } else { noise };
                let all = (0..count).map(|at| stretch((square(at), normals))).collect();
                Stretches { all, noise: 1.0, pushed: true, through: None }.push_is_significant()
            };
            prop_assert!(!is_significant(0) && !is_significant(1) && is_significant(count.div_ceil(10)) && is_significant(count));
        }
    }
    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        /// The result has about the requested number of rows and contains the previous ones unchanged; `None` beyond all.
        #[test]
        fn larger_selections_contain_the_smaller(seed in any::<u64>(), few in 20usize..60, most in 60usize..400) {
            let system = CyclesWithTask { n_trajectories: 6, ..CyclesWithTask::default() };
            let shown = demonstrations(&system.record(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap()).unwrap();
            let rows = FrontEnd::Velocities.rows(&shown).unwrap();
            let limits = |max_rows| RowLimits { max_rows, hyper_rows: 10, least_snr: 1.5, least_speed: 1e-6 };
            let samples = limits(few).keep(&rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
            let stretches = Stretches::of(&rows, &View::recorded(&rows), Switches::Sought).unwrap();
            let fewer = stretches.rows(&rows, &samples, &limits(few)).unwrap();
            let more = stretches.more_rows(&rows, &fewer, most).unwrap();
            prop_assert!((most..=most + few).contains(&more.rows.len()), "{} of {most}", more.rows.len());
            for (at, place) in positions(&more.rows, &fewer.rows).into_iter().enumerate() {
                prop_assert_eq!(more.states.column(place), fewer.states.column(at));
                prop_assert_eq!(more.velocities.column(place), fewer.velocities.column(at));
                prop_assert_eq!(more.indices[place], fewer.indices[at]);
            }
            let all = stretches.rows(&rows, &samples, &limits(10_000)).unwrap();
            prop_assert!(stretches.more_rows(&rows, &all, most).is_none());
        }
    }
}
