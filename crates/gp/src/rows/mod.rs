//! Training data: states, velocities, their variances, and the selection of rows.

pub(crate) mod averages;
pub(crate) mod front_end;
mod further;
pub(crate) mod kept;
pub(crate) mod noise_weights;
pub(crate) mod scaling;
mod subset;
pub(crate) mod task_space;
pub(crate) mod thinning;

use std::borrow::Cow;
use std::collections::BTreeMap;

use motion::{SampleIndex, upper_median};
use nalgebra::DMatrix;

use crate::GpError;
use further::Further;
use task_space::TaskSpace;

/// Maximum number of rows of a model, fitted or read: the Cholesky factor for its error bars takes 0.8 GB.
pub const MOST_ROWS: usize = 10_000;

/// Observed motion, one row per sample: state with context, velocity, and variance of the velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    states: DMatrix<f64>,
    velocities: DMatrix<f64>,
    variances: Option<Vec<f64>>,
    indices: Vec<SampleIndex>,
    /// Mu, (n, M), if constraints are orthogonal in another metric.
    momenta: Option<DMatrix<f64>>,
    noise: Option<f64>,
    switches: Option<Vec<Vec<f64>>>,
    labels: Option<Vec<usize>>,
    /// Whether the rows are already means (S33).
    means: bool,
    task_spaces: Vec<TaskSpace>,
    further: Option<Further>,
}

impl Rows {
    /// Rows with exact velocities: `states` and `velocities` (n, M), one column per row, velocities in units of the state per second;
    /// `indices` (M) holds the trajectory and sample of each row.
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::Value`] for numbers that are not finite, or [`GpError::Overflow`] for speeds whose squares are
    /// not.
    pub fn new(states: DMatrix<f64>, velocities: DMatrix<f64>, indices: Vec<SampleIndex>) -> Result<Self, GpError> {
        let expected = states.ncols();
        let same =
            |what, found| if found == expected { Ok(()) } else { Err(GpError::Lengths { what, found, expected }) };
        same("velocities", velocities.ncols())?;
        same("indices", indices.len())?;
        if states.nrows() == 0 || velocities.nrows() != states.nrows() {
            let (found, expected) = (velocities.nrows(), states.nrows());
            return Err(GpError::Lengths {
                what: "dimensions of velocities (states need at least 1)",
                found,
                expected,
            });
        }
        for (what, matrix) in [("state", &states), ("velocity", &velocities)] {
            if let Some(at) = matrix.iter().position(|value| !value.is_finite()) {
                return Err(GpError::Value { what, row: at / matrix.nrows(), value: matrix[at] });
            }
            // Leaves room for sums over rows and dimensions.
            if !(0.0..1e300).contains(&matrix.norm_squared()) {
                return Err(GpError::Overflow { what: if what == "state" { "distance" } else { "speed" } });
            }
        }
        Ok(Rows {
            states,
            velocities,
            variances: None,
            indices,
            momenta: None,
            noise: None,
            switches: None,
            labels: None,
            means: false,
            task_spaces: Vec::new(),
            further: None,
        })
    }

    /// Adds the context c of every row, (p, M): quantities on which the motion depends and that are constant during a movement, such as a
    /// goal. They count as further coordinates of the state along which nothing moves, so that they should spread about as much as the
    /// state ([`SlopeGp::context_factors`](crate::SlopeGp::context_factors)).
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::Value`] for numbers that are not finite, or [`GpError::Overflow`].
    pub fn with_context(self, context: &DMatrix<f64>) -> Result<Self, GpError> {
        let (found, expected) = (context.ncols(), self.len());
        if found != expected {
            return Err(GpError::Lengths { what: "contexts", found, expected });
        }
        if let Some(at) = context.iter().position(|value| !value.is_finite()) {
            return Err(GpError::Value { what: "context", row: at / context.nrows(), value: context[at] });
        }
        if !(0.0..1e300).contains(&context.norm_squared()) {
            return Err(GpError::Overflow { what: "distance" });
        }
        let dim = self.dim();
        let mut states = self.states.resize_vertically(dim + context.nrows(), 0.0);
        states.rows_mut(dim, context.nrows()).copy_from(context);
        Ok(Rows { states, ..self })
    }

    /// Adds uncertainty of the velocities: `variances` (M) of each row's velocity along each axis.
    ///
    /// # Errors
    /// [`GpError::Lengths`], or [`GpError::Value`] for numbers that are negative or not finite.
    pub fn with_variances(self, variances: Vec<f64>) -> Result<Self, GpError> {
        let (found, expected) = (variances.len(), self.len());
        if found != expected {
            return Err(GpError::Lengths { what: "variances", found, expected });
        }
        match variances.iter().position(|&variance| !(0.0..1e300).contains(&variance)) {
            Some(row) => Err(GpError::Value { what: "variance", row, value: variances[row] }),
            None => Ok(Rows { variances: Some(variances), ..self }),
        }
    }

    /// The same rows with velocities that are treated as exact.
    #[must_use]
    pub fn with_certain_velocities(self) -> Self {
        Rows { variances: None, ..self }
    }

    /// Declares that constraints are orthogonal projections in the metric M(x): u = π − M⁻¹Aᵀ(AM⁻¹Aᵀ)⁻¹(Aπ), for example if a robot's
    /// mass matrix weights its joints. `momenta` (n, M) holds M(x)u of each row; (S31) then replaces (S1).
    ///
    /// # Errors
    /// [`GpError::Lengths`], or [`GpError::Value`] for numbers that are not finite, or if uᵀMu is not positive though u ≠ 0.
    pub fn with_momenta(self, momenta: DMatrix<f64>) -> Result<Self, GpError> {
        let found = if momenta.nrows() == self.dim() { momenta.ncols() } else { 0 };
        if found != self.len() {
            return Err(GpError::Lengths { what: "momenta", found, expected: self.len() });
        }
        let power = |row: usize| momenta.column(row).dot(&self.velocities.column(row));
        let sound = |&row: &usize| {
            let power = power(row);
            momenta.column(row).iter().all(|value| value.is_finite())
                && (power > 0.0 && power.is_finite() || self.velocities.column(row).amax() == 0.0)
        };
        match (0..self.len()).find(|row| !sound(row)) {
            Some(row) => Err(GpError::Value { what: "momentum along the velocity", row, value: power(row) }),
            None => Ok(Rows { momenta: Some(momenta), ..self }),
        }
    }

    /// Adds the front end's estimates: the standard deviation of its noise, in units of the state, and for every sample of every
    /// trajectory the probability that a constraint switched before it.
    #[must_use]
    pub fn with_findings(self, noise: f64, switches: Option<Vec<Vec<f64>>>) -> Self {
        Rows { noise: Some(noise), switches, ..self }
    }

    /// Adds the label of the constraint on each row, as any number, (M). Constraints switch where the label of a row differs from that of
    /// the previous row of the movement, and nowhere else. Stretches (S22) then lie between switches.
    ///
    /// # Errors
    /// [`GpError::Lengths`].
    pub fn with_labels(self, labels: Vec<usize>) -> Result<Self, GpError> {
        let (found, expected) = (labels.len(), self.len());
        if found != expected {
            return Err(GpError::Lengths { what: "labels of constraints", found, expected });
        }
        Ok(Rows { labels: Some(labels), ..self })
    }

    /// Adds spaces in which constraints may be constant besides the recorded coordinates, such as positions of a robot's links. Each is
    /// searched for stretches (S40).
    ///
    /// # Errors
    /// [`GpError::Lengths`] for a space without a finite Jacobian (m, n) of each row; m is the same for all.
    pub fn with_task_spaces(self, task_spaces: Vec<TaskSpace>) -> Result<Self, GpError> {
        let wrong = |space: &&TaskSpace| space.jacobians.is_none() || !space.fits(self.len(), self.dim());
        if let Some(space) = task_spaces.iter().find(wrong) {
            let found = space.jacobians.as_ref().map_or(0, Vec::len);
            return Err(GpError::Lengths { what: "Jacobians of a task space", found, expected: self.len() });
        }
        Ok(Rows { task_spaces, ..self })
    }

    /// States x, each followed by its context c, (n + p, M).
    pub fn states(&self) -> &DMatrix<f64> {
        &self.states
    }

    /// Velocities u, (n, M).
    pub fn velocities(&self) -> &DMatrix<f64> {
        &self.velocities
    }

    /// Variance of each row's velocity along each axis, (M); `None` if velocities are certain.
    pub fn variances(&self) -> Option<&[f64]> {
        self.variances.as_deref()
    }

    /// M(x)u of each row, (n, M); `None` in the metric of the coordinates themselves.
    pub fn momenta(&self) -> Option<&DMatrix<f64>> {
        self.momenta.as_ref()
    }

    /// The rows of each trajectory, which need not be contiguous.
    pub(crate) fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups = BTreeMap::<usize, Vec<usize>>::new();
        for (row, index) in self.indices.iter().enumerate() {
            groups.entry(index.trajectory).or_default().push(row);
        }
        groups.into_values().collect()
    }

    /// The component of each velocity along the direction of its equation, (n, M): along M(x)u (S31), or the whole velocity (S1).
    pub(crate) fn parts(&self) -> Cow<'_, DMatrix<f64>> {
        match &self.momenta {
            Some(momenta) => Cow::Owned(parts_along(&self.velocities, momenta)),
            None => Cow::Borrowed(&self.velocities),
        }
    }

    /// Trajectory and sample of each row.
    pub fn indices(&self) -> &[SampleIndex] {
        &self.indices
    }

    /// Standard deviation of the noise on recorded positions estimated by the front end, in units of the state.
    pub fn noise(&self) -> Option<f64> {
        self.noise
    }

    /// For each sample of each trajectory, the probability that a constraint switched before it, if the front end estimates it.
    pub fn switches(&self) -> Option<&[Vec<f64>]> {
        self.switches.as_deref()
    }

    /// The label of the constraint on each row, (M); `None` if switches are not known.
    pub fn labels(&self) -> Option<&[usize]> {
        self.labels.as_deref()
    }

    /// Spaces in which constraints may be constant besides the recorded coordinates.
    pub fn task_spaces(&self) -> &[TaskSpace] {
        &self.task_spaces
    }

    /// Relative squared difference between a step from one sample to the next and the velocity there, if velocities were computed from
    /// positions: the median of ‖û_{i+1} − û_i‖²/4‖û_i‖² over successive samples. Positions alone do not show whether the motion was
    /// steady or in steps of that size.
    pub fn step_change(&self) -> Option<f64> {
        self.switches.as_ref()?;
        let next_to_each_other = |at: &usize| {
            self.indices[*at + 1] == SampleIndex { sample: self.indices[*at].sample + 1, ..self.indices[*at] }
        };
        let change = |at: usize| {
            let (here, next) = (self.velocities.column(at), self.velocities.column(at + 1));
            (next - here).norm_squared() / (4.0 * here.norm_squared())
        };
        let changes = (0..self.len().saturating_sub(1)).filter(next_to_each_other).map(change);
        let changes: Vec<f64> = changes.filter(|change| change.is_finite()).collect();
        upper_median(changes)
    }

    /// Number of rows M.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Dimension p of the context; 0 without one.
    pub fn context_dim(&self) -> usize {
        self.states.nrows() - self.dim()
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.velocities.nrows()
    }
}

/// The component of each velocity along a direction of any length; zero if the direction is zero. All (n, M).
pub(crate) fn parts_along(velocities: &DMatrix<f64>, directions: &DMatrix<f64>) -> DMatrix<f64> {
    let mut parts = directions.clone();
    for (mut part, velocity) in parts.column_iter_mut().zip(velocities.column_iter()) {
        let unit = part.try_normalize(0.0).unwrap_or_else(|| part.clone_owned());
        part.copy_from(&(&unit * unit.dot(&velocity)));
    }
    parts
}
