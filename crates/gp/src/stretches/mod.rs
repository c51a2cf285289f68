//! Stretches of a movement along which one constraint A u = b acted: (S20) to (S23).
//!
//! While A and b stay constant, u = Nπ + A⁺b. The second part, the push, cancels in differences of velocities, which lie in
//! the null space of A. Every direction v in which they lie gives a linear equation vᵀπ(x_i) = vᵀu_i for all samples of the
//! stretch: rows like those of (S1), but free of the push.

pub(crate) mod noise;
pub(crate) mod rows;
pub(crate) mod segmentation;
mod whole;

use nalgebra::{DMatrix, DVector, Dyn, SVD};
use rayon::prelude::*;

use crate::Rows;
use noise::velocity_noise;
use segmentation::{Segment, segments};
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
        let movements = movements(rows, &at);
        let noise = velocity_noise(rows.velocities(), rows.variances(), &movements)?;
        let of_movement = |movement: &&[usize]| {
            let few = evenly(movement, MOST_SAMPLES);
            let found = segments(&rows.velocities().select_columns(&few), noise);
            let most = found.iter().map(|segment| segment.kind).max().unwrap_or(0);
            let (_, about_mean) = centred(&rows.velocities().select_columns(*movement));
            if let Some(rank) = whole(&about_mean, most, noise) {
                let least = least_length(movement.len(), noise);
                let found = stretch(rows, movement, (rank, least), noise);
                return found.map(|found| Stretch { whole: Some(rank), ..found }).into_iter().collect::<Vec<_>>();
            }
            let of_segment = |segment: &Segment| {
                let span = few[segment.begin]..=few[segment.end - 1];
                let inside: Vec<usize> = movement.iter().copied().filter(|row| span.contains(row)).collect();
                let least = STANDS_OUT * noise.sqrt() * (inside.len() as f64).powf(0.25);
                stretch(rows, &inside, (segment.kind, least), noise)
            };
            found.iter().filter_map(of_segment).collect()
        };
        let stretches: Vec<Stretch> = movements.par_iter().flat_map_iter(of_movement).collect();
        (!stretches.is_empty()).then_some(Stretches { all: stretches, noise, pushed: true })
    }

    /// Those that are whole movements, with directions from the velocities themselves, not from their differences: more
    /// certain, and right where b = 0.
    pub(crate) fn without_push(&self, rows: &Rows) -> Stretches {
        let noise = self.noise;
        let of = |stretch: &Stretch| {
            let rank = stretch.whole?;
            let inside: Vec<usize> =
                (0..rows.len()).filter(|&row| rows.indices()[row].trajectory == stretch.trajectory).collect();
            let velocities = rows.velocities().select_columns(&inside);
            whole(&velocities, rank, noise)?;
            let (_, span) = Span::of(velocities, (rank, least_length(inside.len(), noise)), noise)?;
            let push = DVector::zeros(rows.dim());
            Some(Stretch { directions: span.directions, lengths: span.lengths, push, ..stretch.clone() })
        };
        Stretches { all: self.all.iter().filter_map(of).collect(), noise, pushed: false }
    }
}

/// `at`, all rows in their order, by movement.
pub(crate) fn movements<'a>(rows: &Rows, at: &'a [usize]) -> Vec<&'a [usize]> {
    let trajectory = |row: usize| rows.indices()[row].trajectory;
    at.chunk_by(|&a, &b| trajectory(a) == trajectory(b)).collect()
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
