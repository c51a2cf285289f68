//! Stretches of a movement along which one constraint A u = b acted: (S20) to (S23).
//!
//! While A and b stay constant, u = Nπ + A⁺b. The second part, the push, cancels in differences of velocities, which lie in
//! the null space of A. Every direction v in which they lie gives a linear equation vᵀπ(x_i) = vᵀu_i for all samples of the
//! stretch: rows like those of (S1), but free of the push.

pub(crate) mod noise;
pub(crate) mod partition;
pub(crate) mod rows;
pub(crate) mod segmentation;
mod whole;

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector, Dyn, SVD};
use rayon::prelude::*;

use crate::Rows;
use noise::velocity_noise;
use segmentation::{Segment, known_segment, segments};
use whole::{least_length, whole};

/// Most samples of a movement among which switches are looked for; of longer ones, evenly many.
pub(crate) const MOST_SAMPLES: usize = 60;
/// Most dimensions; the search takes time with the cube of them.
pub(crate) const MOST_DIMENSIONS: usize = 12;
/// Standard deviations of the noise that a direction must stand out by, for a stretch of one sample.
const STANDS_OUT: f64 = 8.0;

/// Samples of one movement during which A and b did not change, and what their velocities show of A and b.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    pub(crate) trajectory: usize,
    /// First and last sample.
    pub(crate) samples: (usize, usize),
    /// Orthonormal directions in the null space of A, (n, m) with m < n.
    pub(crate) directions: DMatrix<f64>,
    /// ℓ_k of (S23), (m): the noise over the standard deviation of each direction's angle.
    pub(crate) lengths: Vec<f64>,
    /// The push A⁺b: the mean velocity along the normals of the plane that the velocities lie in, (n).
    pub(crate) push: DVector<f64>,
    /// Its square in units of the variance that noise gives it, and how many normals there are.
    pub(crate) significance: (f64, usize),
    /// The rank of the plane, of a whole movement.
    whole: Option<usize>,
}

/// All stretches of some movements.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    pub(crate) all: Vec<Stretch>,
    /// s², the variance of a velocity along an axis.
    pub(crate) noise: f64,
    /// Whether the constraints may push.
    pub(crate) pushed: bool,
}

impl Stretches {
    /// Looks for stretches in all movements; none in another metric, in so many dimensions, or in so few samples, that
    /// nothing can be found.
    /// Takes time with the number of movements and the cube of the dimension.
    pub(crate) fn of(rows: &Rows) -> Option<Stretches> {
        if rows.dim() < 2 || rows.dim() > MOST_DIMENSIONS || rows.momenta().is_some() {
            return None;
        }
        let at: Vec<usize> = (0..rows.len()).collect();
        let parts = parts(rows, &at);
        let noise = velocity_noise(rows.velocities(), rows.variances(), &parts)?;
        let of_part = |part: &&[usize]| {
            let of_segment = |few: &[usize], segment: &Segment| {
                let span = few[segment.begin]..=few[segment.end - 1];
                let inside: Vec<usize> = part.iter().copied().filter(|row| span.contains(row)).collect();
                let least = STANDS_OUT * noise.sqrt() * (inside.len() as f64).powf(0.25);
                stretch(rows, &inside, (segment.kind, least), noise)
            };
            if rows.labels().is_some() {
                let known = known_segment(&rows.velocities().select_columns(*part), noise);
                return known.iter().filter_map(|segment| of_segment(part, segment)).collect::<Vec<_>>();
            }
            let few = evenly(part, MOST_SAMPLES);
            let found = segments(&rows.velocities().select_columns(&few), noise);
            let most = found.iter().map(|segment| segment.kind).max().unwrap_or(0);
            let (_, about_mean) = centred(&rows.velocities().select_columns(*part));
            if let Some(rank) = whole(&about_mean, most, noise) {
                let found = stretch(rows, part, (rank, least_length(part.len(), noise)), noise);
                return found.map(|found| Stretch { whole: Some(rank), ..found }).into_iter().collect();
            }
            found.iter().filter_map(|segment| of_segment(&few, segment)).collect()
        };
        let stretches: Vec<Stretch> = parts.par_iter().flat_map_iter(of_part).collect();
        (!stretches.is_empty()).then_some(Stretches { all: stretches, noise, pushed: true })
    }

    /// Those that are whole movements, with directions from the velocities themselves, not from their differences: more
    /// certain, and right where b = 0.
    pub(crate) fn without_push(&self, rows: &Rows) -> Stretches {
        let noise = self.noise;
        let mut of_trajectories: HashMap<usize, Vec<usize>> = HashMap::new();
        for (row, index) in rows.indices().iter().enumerate() {
            of_trajectories.entry(index.trajectory).or_default().push(row);
        }
        let of = |stretch: &Stretch| {
            let rank = stretch.whole?;
            let inside = &of_trajectories[&stretch.trajectory];
            let velocities = rows.velocities().select_columns(inside);
            whole(&velocities, rank, noise)?;
            let (_, span) = Span::of(velocities, (rank, least_length(inside.len(), noise)), noise)?;
            let push = DVector::zeros(rows.dim());
            Some(Stretch { directions: span.directions, lengths: span.lengths, push, ..stretch.clone() })
        };
        Stretches { all: self.all.iter().filter_map(of).collect(), noise, pushed: false }
    }
}

/// `at`, all rows in their order, by movement, and where labels tell switches, by the parts between them.
pub(crate) fn parts<'a>(rows: &Rows, at: &'a [usize]) -> Vec<&'a [usize]> {
    let of = |row: usize| (rows.indices()[row].trajectory, rows.labels().map(|labels| labels[row]));
    at.chunk_by(|&a, &b| of(a) == of(b)).collect()
}

/// The mean of the columns, and the columns about it.
pub(crate) fn centred(columns: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let mean = columns.column_mean();
    let mut centred = columns.clone();
    centred.column_iter_mut().for_each(|mut column| column -= &mean);
    (mean, centred)
}

/// At most so many of the rows, evenly far from each other, with the first and the last.
pub(crate) fn evenly(rows: &[usize], most: usize) -> Vec<usize> {
    if rows.len() <= most {
        return rows.to_vec();
    }
    (0..most).map(|at| rows[at * (rows.len() - 1) / (most - 1)]).collect()
}

/// Directions in which some velocities lie.
struct Span {
    directions: DMatrix<f64>,
    lengths: Vec<f64>,
}

impl Span {
    /// Those of the first `rank` directions whose singular value is at least `least`, none if there is none; and the whole
    /// decomposition.
    fn of(velocities: DMatrix<f64>, (rank, least): (usize, f64), noise: f64) -> Option<(SVD<f64, Dyn, Dyn>, Span)> {
        let count = velocities.ncols() as f64;
        let svd = velocities.svd(true, false);
        let long = |&&length: &&f64| length >= least && length > 0.0;
        let lengths: Vec<f64> = svd.singular_values.iter().take(rank).take_while(long).copied().collect();
        let directions = svd.u.as_ref()?.columns(0, lengths.len()).into_owned();
        let lengths: Vec<f64> = lengths.iter().map(|length| length - count * noise / length).collect();
        (!lengths.is_empty()).then_some((svd, Span { directions, lengths }))
    }
}

/// The samples `inside`, whose velocities lie in a plane of this rank, with directions along which these are at least `least`
/// long; none if no direction is.
fn stretch(rows: &Rows, inside: &[usize], (rank, least): (usize, f64), noise: f64) -> Option<Stretch> {
    let (mean, centred) = centred(&rows.velocities().select_columns(inside));
    let (svd, Span { directions, lengths }) = Span::of(centred, (rank, least), noise)?;
    let plane = svd.u?.columns(0, rank).into_owned();
    let along = plane.tr_mul(&mean);
    let push = &mean - &plane * &along;
    // Noise moves the mean, and it tilts the plane.
    let tilt: f64 = along.iter().zip(&svd.singular_values).map(|(u, s)| (u / s).powi(2)).sum();
    let variance = noise * (1.0 / inside.len() as f64 + tilt);
    let index = |row: usize| rows.indices()[row];
    let (first, last) = (index(inside[0]), index(inside[inside.len() - 1]));
    Some(Stretch {
        trajectory: first.trajectory,
        samples: (first.sample, last.sample),
        significance: (push.norm_squared() / variance, rows.dim() - rank),
        push,
        lengths,
        directions,
        whole: None,
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
        /// Under constraints that push, with noise: a stretch between any two switches that are known, whatever they are called, and
        /// one where none is.
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
            // Few windows tell too little of the noise.
            let rows = rows.with_variances(vec![1e-6 / 3.0; count]).unwrap();
            let found = |labels: Vec<usize>| Stretches::of(&rows.clone().with_labels(labels).unwrap());
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
