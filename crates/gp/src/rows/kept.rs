//! The rows that a fit learns from: its steps 1 and 2.

use std::collections::HashSet;

use motion::{SampleIndex, scaled};
use nalgebra::{DMatrix, DVector};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use crate::rows::thinning::{MIDDLE, thinned};
use crate::rows::{MOST_ROWS, parts_along};
use crate::stretches::pushes::Pushes;
use crate::{GpError, Rows};

/// Which rows a fit keeps, and how many.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RowLimits {
    pub(crate) max_rows: usize,
    pub(crate) hyper_rows: usize,
    pub(crate) least_snr: f64,
    pub(crate) least_speed: f64,
}

/// The unit of leave-one-out prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grouping {
    /// One trajectory after the other.
    Trajectories,
    /// Blocks of time, because there are only one or two trajectories: R² is then too high.
    BlocksOfTime,
}

/// Numbers of rows that were not used, by reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RowsDropped {
    /// Merged into means (S33), each of which counts as one row.
    #[serde(default, skip_serializing_if = "none")]
    pub averaged: usize,
    /// Practically at rest.
    pub still: usize,
    /// Slower than their noise.
    pub noisy: usize,
    /// Beyond `max_rows`: the first row of every movement is kept, and evenly spaced others.
    pub thinned: usize,
    /// For rows of stretches of one constraint each: samples, or means of them, in no stretch.
    #[serde(default, skip_serializing_if = "none")]
    pub in_no_stretch: usize,
    /// For rows of stretches: samples in stretches that other movements contradict, which count less (S44).
    #[serde(default, skip_serializing_if = "none")]
    pub contradicted: usize,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde wants it
fn none(count: &usize) -> bool {
    *count == 0
}

/// Additional data of rows of stretches (S22).
#[derive(Debug, Clone)]
pub(crate) struct OfStretches {
    /// D (S23), (M).
    pub(crate) weights: Vec<f64>,
    /// `None` if b = 0.
    pub(crate) pushes: Option<Pushes>,
    /// The task space of the stretches, as an index into those of the rows; `None`: the recorded coordinates.
    pub(crate) space: Option<usize>,
    /// Average number of rows per sample.
    pub(crate) of_sample: f64,
}

/// Rows kept, in the order of trajectories and samples.
#[derive(Debug, Clone)]
pub(crate) struct Kept {
    /// Index of each row, or of each among all rows of its stretches, (M); `indices` holds the recorded sample.
    pub(crate) rows: Vec<usize>,
    pub(crate) indices: Vec<SampleIndex>,
    /// States with their contexts, (n + p, M).
    pub(crate) states: DMatrix<f64>,
    /// The component of the velocity along the direction of each row, (n, M): the whole velocity except in rows of stretches
    /// and of momenta.
    pub(crate) velocities: DMatrix<f64>,
    /// r, the length of that component, (M).
    pub(crate) speeds: Vec<f64>,
    /// Whole velocities, (n, M), if rows hold components.
    pub(crate) whole: Option<DMatrix<f64>>,
    pub(crate) variances: Option<Vec<f64>>,
    /// `Some` for rows of stretches.
    pub(crate) of_stretches: Option<OfStretches>,
    pub(crate) groups: Vec<Vec<usize>>,
    /// Rows whose marginal likelihood determines the amplitudes. They are random, because with contiguous rows it would treat
    /// errors that are correlated along a trajectory as signal.
    pub(crate) hyper: Vec<usize>,
    pub(crate) grouping: Grouping,
    pub(crate) dropped: RowsDropped,
}

impl Kept {
    /// The trajectory of each group.
    pub(crate) fn trajectories(&self) -> Vec<usize> {
        self.groups.iter().map(|rows| self.indices[rows[0]].trajectory).collect()
    }

    /// Whole velocities u, (n, M).
    pub(crate) fn observed(&self) -> &DMatrix<f64> {
        self.whole.as_ref().unwrap_or(&self.velocities)
    }

    /// The same rows with each axis multiplied by its factor, and certain velocities. A direction v of a stretch becomes Cv.
    pub(crate) fn scaled(&self, factors: &DVector<f64>) -> Kept {
        let whole = self.whole.as_ref().map(|whole| scaled(whole, factors));
        let along = scaled(&self.velocities, factors);
        let velocities = match &whole {
            Some(whole) => parts_along(whole, &along),
            None => along,
        };
        let speeds = velocities.column_iter().map(|velocity| velocity.norm()).collect();
        Kept { states: rescaled(&self.states, factors), velocities, speeds, whole, variances: None, ..self.clone() }
    }
}

/// Standard deviation of each axis.
pub(crate) fn spreads(states: &DMatrix<f64>) -> DVector<f64> {
    DVector::from_iterator(states.nrows(), states.row_iter().map(|axis| axis.variance().sqrt()))
}

/// States (n + p, M) with a factor on each axis of the state, (n), and a common one on the context that preserves its share of
/// the spread.
pub(crate) fn rescaled(states: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let (dim, context_dim) = (factors.len(), states.nrows() - factors.len());
    let spread = spreads(&states.rows(0, dim).into_owned());
    let context = spread.component_mul(factors).norm() / spread.norm();
    scaled(states, &factors.clone().resize_vertically(dim + context_dim, context))
}

impl RowLimits {
    /// The same limits with smaller maxima.
    pub(crate) fn at_most(self, max_rows: usize, hyper_rows: usize) -> RowLimits {
        RowLimits { max_rows: self.max_rows.min(max_rows), hyper_rows: self.hyper_rows.min(hyper_rows), ..self }
    }

    pub(crate) fn check(&self) -> Result<(), GpError> {
        let wrong = |name, value, requirement| Err(GpError::Parameter { name, value, requirement });
        if self.max_rows == 0 {
            return wrong("max_rows", self.max_rows as f64, "be at least 1");
        }
        if self.max_rows > MOST_ROWS {
            return wrong("max_rows", self.max_rows as f64, "be at most 10000");
        }
        if self.hyper_rows == 0 {
            return wrong("hyper_rows", self.hyper_rows as f64, "be at least 1");
        }
        if !(self.least_snr >= 0.0 && self.least_snr.is_finite()) {
            return wrong("least_snr", self.least_snr, "be finite and not negative");
        }
        if !(0.0..1.0).contains(&self.least_speed) {
            return wrong("least_speed", self.least_speed, "be at least 0 and less than 1");
        }
        Ok(())
    }

    /// Keeps at most `max_rows` of the rows that move more than their noise. Draws one permutation, and before it the draws of
    /// [`thinned`].
    pub(crate) fn keep<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<Kept, GpError> {
        self.check()?;
        let (samples, before) = (rows.recorded(), rows.thinned_before());
        let rows = &*rows.averaged();
        let (mut usable, mut dropped) = self.usable(rows)?;
        let enough = grouped(rows, &usable)?;
        dropped.averaged = samples - rows.len() - before;
        dropped.thinned = before + usable.len().saturating_sub(self.max_rows);
        usable = thinned(movements(rows, &usable), self.max_rows, || rng.random());
        usable.shuffle(rng);
        let mut hyper = usable[..usable.len().min(self.hyper_rows)].to_vec();
        let in_time = |&row: &usize| (rows.indices()[row], row);
        usable.sort_by_key(in_time);
        hyper.sort_by_key(in_time);
        let hyper = positions(&usable, &hyper);
        let kept = kept(rows, usable, &enough);
        if kept.groups.len() < 3 {
            return Err(GpError::TooFewTrajectories { found: kept.groups.len() });
        }
        Ok(Kept { hyper, dropped, ..kept })
    }

    /// The same rows and about `most` of those that [`RowLimits::keep`] thinned; `None` if it kept all.
    pub(crate) fn keep_all(&self, rows: &Rows, some: &Kept, most: usize) -> Option<Kept> {
        if some.dropped.thinned == 0 {
            return None;
        }
        let before = rows.thinned_before();
        let rows = &*rows.averaged();
        let (mut usable, dropped) = self.usable(rows).ok()?;
        usable.sort_by_key(|&row| (rows.indices()[row], row));
        let enough = grouped(rows, &usable).ok()?;
        let found = usable.len();
        let many = thinned(movements(rows, &usable), most, || MIDDLE);
        let taken: HashSet<usize> = many.into_iter().chain(some.rows.iter().copied()).collect();
        usable.retain(|row| taken.contains(row));
        let thinned = before + found - usable.len();
        let dropped = RowsDropped { averaged: some.dropped.averaged, thinned, ..dropped };
        Some(Kept { dropped, ..kept(rows, usable, &enough) })
    }

    /// Rows that move more than their noise, in the order of trajectories and samples, and counts of the others.
    fn usable(&self, rows: &Rows) -> Result<(Vec<usize>, RowsDropped), GpError> {
        let speeds: Vec<f64> = rows.velocities().column_iter().map(|velocity| velocity.norm()).collect();
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        // Tests the velocities, because squares of small speeds may underflow to 0.
        if rows.velocities().amax() == 0.0 {
            return Err(GpError::NoMotion);
        }
        if fastest * fastest < 1e-290 {
            return Err(GpError::Overflow { what: "speed" });
        }
        let moving: Vec<usize> = (0..rows.len()).filter(|&row| speeds[row] > self.least_speed * fastest).collect();
        let least = |row: usize| rows.variances().map_or(0.0, |variances| variances[row]);
        let power = self.least_snr.powi(2) * rows.dim() as f64;
        let usable: Vec<usize> =
            moving.iter().copied().filter(|&row| speeds[row].powi(2) > power * least(row)).collect();
        let dropped = RowsDropped {
            still: rows.len() - moving.len(),
            noisy: moving.len() - usable.len(),
            ..RowsDropped::default()
        };
        Ok((usable, dropped))
    }
}

/// These rows by trajectory; the rows of a trajectory are contiguous.
fn movements<'a>(rows: &'a Rows, usable: &'a [usize]) -> impl Iterator<Item = &'a [usize]> + Clone {
    usable.chunk_by(|&a, &b| rows.indices()[a].trajectory == rows.indices()[b].trajectory)
}

/// These rows, in the order of trajectories and samples, without hyper rows.
fn kept(rows: &Rows, usable: Vec<usize>, grouped: &Grouped) -> Kept {
    let groups = grouped.among(rows, &usable);
    let velocities = rows.parts().select_columns(&usable);
    Kept {
        states: rows.states().select_columns(&usable),
        speeds: velocities.column_iter().map(|part| part.norm()).collect(),
        velocities,
        whole: rows.momenta().map(|_| rows.velocities().select_columns(&usable)),
        variances: rows.variances().map(|variances| usable.iter().map(|&row| variances[row]).collect()),
        of_stretches: None,
        hyper: Vec::new(),
        indices: usable.iter().map(|&row| rows.indices()[row]).collect(),
        groups,
        grouping: grouped.grouping,
        dropped: RowsDropped::default(),
        rows: usable,
    }
}

/// Grouping of rows: the number of parts into which a trajectory is cut.
struct Grouped {
    grouping: Grouping,
    parts: usize,
}

/// Refuses too few rows or trajectories; one or two trajectories are cut into blocks of time.
fn grouped(rows: &Rows, usable: &[usize]) -> Result<Grouped, GpError> {
    let trajectories = |of: &mut dyn Iterator<Item = usize>| {
        of.map(|row| rows.indices()[row].trajectory).collect::<std::collections::BTreeSet<_>>().len()
    };
    let recorded = trajectories(&mut (0..rows.len()));
    let with_rows = trajectories(&mut usable.iter().copied());
    if recorded > 2 && with_rows < 3 {
        return Err(GpError::TooFewTrajectories { found: with_rows });
    }
    let needed = rows.states().nrows() + 2;
    if usable.len() < needed {
        return Err(GpError::TooFewRows { found: usable.len(), needed });
    }
    Ok(match with_rows {
        1 => Grouped { grouping: Grouping::BlocksOfTime, parts: 3 },
        2 => Grouped { grouping: Grouping::BlocksOfTime, parts: 2 },
        _ => Grouped { grouping: Grouping::Trajectories, parts: 1 },
    })
}

impl Grouped {
    /// Positions among `kept`, ordered by trajectory and sample, in groups that are left out together.
    fn among(&self, rows: &Rows, kept: &[usize]) -> Vec<Vec<usize>> {
        let positions: Vec<usize> = (0..kept.len()).collect();
        let trajectory = |&at: &usize| rows.indices()[kept[at]].trajectory;
        let of_trajectories = positions.chunk_by(|a, b| trajectory(a) == trajectory(b));
        of_trajectories.flat_map(|rows| rows.chunks(rows.len().div_ceil(self.parts)).map(<[usize]>::to_vec)).collect()
    }
}

/// The position in `all` of each of `some`.
pub(crate) fn positions(all: &[usize], some: &[usize]) -> Vec<usize> {
    let place: std::collections::HashMap<usize, usize> = all.iter().enumerate().map(|(at, &row)| (row, at)).collect();
    some.iter().map(|row| place[row]).collect()
}
