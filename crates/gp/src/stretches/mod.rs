//! Stretches of a movement along which one constraint A u = b acted: (S20) to (S23).
//!
//! While A and b stay constant, u = Nπ + A⁺b. The second term, the push, cancels in differences of velocities, which lie in the null
//! space of A. Every direction v in their span gives a linear equation vᵀπ(x_i) = vᵀu_i for all samples of the stretch: rows like those
//! of (S1), but independent of the push.

pub(crate) mod cut;
pub(crate) mod noise;
pub(crate) mod partition;
pub(crate) mod pushes;
pub(crate) mod rows;
pub(crate) mod segmentation;
pub(crate) mod view;
mod whole;

use std::collections::HashMap;

use motion::SampleIndex;
use nalgebra::{DMatrix, DVector, Dyn, SVD};
use rayon::prelude::*;

use crate::Rows;
use cut::Cut;
use noise::{sharing, velocity_noise};
use segmentation::Segment;
use view::{Through, View};
use whole::{least_length, whole};

/// Maximum dimension; the time of the search grows with its cube.
pub(crate) const MOST_DIMENSIONS: usize = 12;
/// Minimum singular value of a direction, in standard deviations of the noise, for a stretch of one sample.
const STANDS_OUT: f64 = 8.0;

/// Samples of one movement during which A and b did not change, and the information about A and b in their velocities.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    pub(crate) trajectory: usize,
    /// First and last sample.
    pub(crate) samples: (usize, usize),
    /// Orthonormal directions in the null space of A, (n, m) with m < n; in a task space possibly none.
    pub(crate) directions: DMatrix<f64>,
    /// ℓ_k of (S23), (m): the noise divided by the standard deviation of each direction's angle.
    pub(crate) lengths: Vec<f64>,
    /// The push A⁺b: the mean velocity along the normals of the plane that contains the velocities, (n); in a task space, the push at the
    /// middle of the stretch.
    pub(crate) push: DVector<f64>,
    /// The state there, with its context, (n + p).
    pub(crate) middle: DVector<f64>,
    /// Squared push in units of its variance under noise, and the number of normals.
    pub(crate) significance: (f64, usize),
    /// The rank of the plane that contains the velocities.
    rank: usize,
    /// The same rank for a whole movement.
    whole: Option<usize>,
    /// Noise factor of its rows (S44): above 1 if other movements contradict the stretch.
    pub(crate) doubt: f64,
}

/// Whether constraints may switch within a movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Switches {
    /// Switches are searched for unless they are known.
    Sought,
    /// Every movement is one stretch, or none, because noise and curvature of a long one look like switches.
    None,
}

/// All stretches of some movements.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    pub(crate) all: Vec<Stretch>,
    /// s², the variance of a velocity along an axis.
    pub(crate) noise: f64,
    /// Whether the constraints may push.
    pub(crate) pushed: bool,
    /// The task space in which A and b are constant; `None`: the recorded coordinates.
    pub(crate) through: Option<Through>,
}

impl Stretches {
    /// Searches for stretches in all movements; `None` in another metric, or if the dimension is too large or the samples too few. Time
    /// grows with the number of movements and the cube of the dimension.
    pub(crate) fn of(rows: &Rows, view: &View<'_>, switches: Switches) -> Option<Stretches> {
        if rows.dim() < 2 || view.dim() > MOST_DIMENSIONS || rows.momenta().is_some() {
            return None;
        }
        let at: Vec<usize> = (0..rows.len()).collect();
        let parts = parts(rows, &at);
        let noise = sharing(rows, &parts) * velocity_noise(&view.velocities, rows.variances(), &parts)?;
        let cuts = Cut::each(rows, view, &parts, (switches, noise));
        let switching = Cut::switches(&cuts);
        let of_part = |(part, Cut { few, found, .. }): (&&[usize], &Cut)| {
            let of_segment = |segment: &Segment| {
                let span = few[segment.begin]..=few[segment.end - 1];
                let inside: Vec<usize> = part.iter().copied().filter(|row| span.contains(row)).collect();
                let least = STANDS_OUT * noise.sqrt() * (inside.len() as f64).powf(0.25);
                stretch(rows, view, &inside, (segment.kind, least), noise)
            };
            let most = match switches {
                Switches::Sought => found.iter().map(|segment| segment.kind).max().unwrap_or(0),
                Switches::None => view.dim() - 1,
            };
            let (_, about_mean) = centred(&view.velocities.select_columns(*part));
            let one = rows.labels().is_none() && (found.len() < 2 || !switching);
            if let Some(rank) = whole(&about_mean, most, noise).filter(|_| one) {
                let found = stretch(rows, view, part, (rank, least_length(part.len(), noise)), noise);
                return found.map(|found| Stretch { whole: Some(rank), ..found }).into_iter().collect::<Vec<_>>();
            }
            found.iter().filter_map(of_segment).collect()
        };
        let stretches: Vec<Stretch> = parts.par_iter().zip(&cuts).flat_map_iter(of_part).collect();
        let through = view.through.clone();
        (!stretches.is_empty()).then_some(Stretches { all: stretches, noise, pushed: true, through })
    }

    /// Whether all stretches are whole movements.
    pub(crate) fn are_whole(&self) -> bool {
        self.all.iter().all(|stretch| stretch.whole.is_some())
    }

    /// The stretches that are whole movements, with directions from the velocities themselves instead of their differences: more certain,
    /// and correct if b = 0. In a task space also all other stretches, unchanged. `view` is the one in which they were found.
    pub(crate) fn without_push(&self, rows: &Rows, view: &View<'_>) -> Stretches {
        let Stretches { noise, through, .. } = self;
        let mut of_trajectories: HashMap<usize, Vec<usize>> = HashMap::new();
        for (row, index) in rows.indices().iter().enumerate() {
            of_trajectories.entry(index.trajectory).or_default().push(row);
        }
        let unpushed = |stretch: &Stretch| {
            let rank = stretch.whole.or(through.as_ref().map(|_| stretch.rank))?;
            let own = of_trajectories[&stretch.trajectory].iter().copied();
            let inside: Vec<usize> = own.filter(|&row| stretch.holds(rows.indices()[row])).collect();
            let velocities = view.velocities.select_columns(&inside);
            whole(&velocities, rank, *noise)?;
            let (_, span) = Span::of(velocities, (rank, least_length(inside.len(), *noise)), *noise)?;
            let push = DVector::zeros(rows.dim());
            span.is_enough(view).then_some(Stretch {
                directions: span.directions,
                lengths: span.lengths,
                push,
                ..stretch.clone()
            })
        };
        let other = |stretch: &Stretch| through.as_ref().map(|_| stretch.clone());
        let all = self.all.iter().filter_map(|stretch| unpushed(stretch).or_else(|| other(stretch))).collect();
        Stretches { all, noise: *noise, pushed: false, through: through.clone() }
    }
}

impl Stretch {
    pub(crate) fn is_contradicted(&self) -> bool {
        self.doubt > 1.0
    }

    pub(crate) fn holds(&self, index: SampleIndex) -> bool {
        index.trajectory == self.trajectory && (self.samples.0..=self.samples.1).contains(&index.sample)
    }
}

/// Splits `at`, all rows in order, by movement, and, if labels mark switches, at these.
pub(crate) fn parts<'a>(rows: &Rows, at: &'a [usize]) -> Vec<&'a [usize]> {
    let section = |row: usize| (rows.indices()[row].trajectory, rows.labels().map(|labels| labels[row]));
    at.chunk_by(|&a, &b| section(a) == section(b)).collect()
}

/// The mean of the columns, and the columns minus the mean.
pub(crate) fn centred(columns: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let mean = columns.column_mean();
    let mut centred = columns.clone();
    centred.column_iter_mut().for_each(|mut column| column -= &mean);
    (mean, centred)
}

/// At most `most` of the rows, evenly spaced, including the first and the last.
pub(crate) fn evenly(rows: &[usize], most: usize) -> Vec<usize> {
    if rows.len() <= most {
        return rows.to_vec();
    }
    (0..most).map(|at| rows[at * (rows.len() - 1) / (most - 1)]).collect()
}

/// Directions that span some velocities.
struct Span {
    directions: DMatrix<f64>,
    lengths: Vec<f64>,
}

impl Span {
    /// Those of the first `rank` directions whose singular value is at least `least`; also returns the whole decomposition.
    fn of(velocities: DMatrix<f64>, (rank, least): (usize, f64), noise: f64) -> Option<(SVD<f64, Dyn, Dyn>, Span)> {
        let count = velocities.ncols() as f64;
        let svd = velocities.svd(true, false);
        let long = |&&length: &&f64| length >= least && length > 0.0;
        let lengths: Vec<f64> = svd.singular_values.iter().take(rank).take_while(long).copied().collect();
        let directions = svd.u.as_ref()?.columns(0, lengths.len()).into_owned();
        let lengths: Vec<f64> = lengths.iter().map(|length| length - count * noise / length).collect();
        Some((svd, Span { directions, lengths }))
    }

    /// Whether such a stretch has rows. Without a direction, the only free motion is that of joints while the hand is still.
    fn is_enough(&self, view: &View<'_>) -> bool {
        !self.lengths.is_empty() || view.through.is_some()
    }
}

/// The stretch of the samples `inside`, whose velocities lie in a plane of this rank, with the directions whose singular values are at
/// least `least`; `None` if it has no rows.
fn stretch(rows: &Rows, view: &View<'_>, inside: &[usize], (rank, least): (usize, f64), noise: f64) -> Option<Stretch> {
    let (mean, centred) = centred(&view.velocities.select_columns(inside));
    let (svd, span) = Span::of(centred, (rank, least), noise)?;
    if !span.is_enough(view) {
        return None;
    }
    let plane = svd.u?.columns(0, rank).into_owned();
    let along = plane.tr_mul(&mean);
    let push = &mean - &plane * &along;
    // Noise shifts the mean and tilts the plane.
    let tilt: f64 = along.iter().zip(&svd.singular_values).map(|(u, s)| (u / s).powi(2)).sum();
    let variance = noise * (1.0 / inside.len() as f64 + tilt);
    let index = |row: usize| rows.indices()[row];
    let middle = inside[inside.len() / 2];
    let (first, last) = (index(inside[0]), index(inside[inside.len() - 1]));
    Some(Stretch {
        trajectory: first.trajectory,
        samples: (first.sample, last.sample),
        rank,
        significance: (push.norm_squared() / variance, view.dim() - rank),
        push: view.recorded_push(rows, middle, &plane, push),
        middle: rows.states().column(middle).into_owned(),
        lengths: span.lengths,
        directions: span.directions,
        whole: None,
        doubt: 1.0,
    })
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        /// With pushing constraints and noise: one stretch between any two known switches, whatever the labels are, and one in a movement
        /// without a switch.
        #[test]
        fn stretches_lie_between_known_switches(
            dim in 2usize..4,
            lengths in prop::collection::vec(24usize..40, 1..5),
            names in any::<[u8; 2]>().prop_filter("two names", |names| names[0] != names[1]),
            seed in any::<u64>(),
        ) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut draw = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| 2.0 * rng.random::<f64>() - 1.0);
            let mut columns: Vec<DVector<f64>> = Vec::new();
            let mut labels = Vec::new();
            for (at, &length) in lengths.iter().enumerate() {
                let normal = draw(dim, 1).column(0).normalize();
                let push = &normal * draw(1, 1)[0];
                for _ in 0..length {
                    let velocity = draw(dim, 1).column(0).into_owned();
                    let along = velocity.dot(&normal);
                    columns.push(velocity - &normal * along + &push + draw(dim, 1).column(0) * 1e-3);
                    labels.push(usize::from(names[at % 2]));
                }
            }
            let count = columns.len();
            let indices = (0..count).map(|sample| SampleIndex { trajectory: 0, sample }).collect();
            let rows = Rows::new(draw(dim, count), DMatrix::from_columns(&columns), indices).unwrap();
            // A few windows do not determine the noise well enough.
            let rows = rows.with_variances(vec![1e-6 / 3.0; count]).unwrap();
            let found = |labels: Vec<usize>| {
                let rows = rows.clone().with_labels(labels).unwrap();
                Stretches::of(&rows, &View::recorded(&rows), Switches::Sought)
            };
            let between = found(labels).expect("stretches").all;
            let ends = lengths.iter().scan(0, |end, length| { *end += length; Some((*end - length, *end - 1)) });
            let near = |(stretch, end): (&Stretch, (usize, usize))| {
                stretch.samples.0.abs_diff(end.0) <= 2 && stretch.samples.1.abs_diff(end.1) <= 2
            };
            prop_assert_eq!(between.len(), lengths.len());
            prop_assert!(between.iter().zip(ends).all(near));
            prop_assert!(between.iter().all(|stretch| stretch.directions.ncols() == dim - 1));
            let one = found(vec![3; count]).map_or(0, |found| found.all.len());
            prop_assert!(one <= 1 && (one == 1 || lengths.len() > 1));
        }
    }
}
