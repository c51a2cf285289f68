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

use motion::{SampleIndex, upper_median};
use nalgebra::DMatrix;

use crate::GpError;
use further::Further;
use task_space::TaskSpace;

/// Most rows of a model, fitted or read: the Cholesky factor of so many, which its error bars need, takes 0.8 GB.
pub const MOST_ROWS: usize = 10_000;

/// Observed motion, one row a sample: state with its context, velocity, and the variance of the velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    states: DMatrix<f64>,
    velocities: DMatrix<f64>,
    variances: Option<Vec<f64>>,
    indices: Vec<SampleIndex>,
    /// Mu, (n, M), where constraints are at right angles in another metric.
    momenta: Option<DMatrix<f64>>,
    noise: Option<f64>,
    switches: Option<Vec<Vec<f64>>>,
    labels: Option<Vec<usize>>,
    /// Whether they are means (S33) already.
    means: bool,
    task_spaces: Vec<TaskSpace>,
    further: Option<Further>,
}

impl Rows {
    /// Rows with exact velocities: `states` and `velocities` (n, M), one column a row, velocities in units of the
    /// state per second; `indices` (M) holds the trajectory and sample of each.
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::Value`] for what is not finite, or [`GpError::Overflow`] for speeds whose squares
    /// are not.
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
            // Room for sums over rows and dimensions.
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

    /// Adds the context c of every row, (p, M): what the motion depends on and what is constant during a movement, such as a
    /// goal. It counts as further coordinates of the state along which nothing moves, so that it should spread about as much as the
    /// state ([`SlopeGp::context_factors`](crate::SlopeGp::context_factors)).
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::Value`] for what is not finite, or [`GpError::Overflow`].
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

    /// Adds uncertainty of the velocities: `variances` (M), of each row's velocity along every axis.
    ///
    /// # Errors
    /// [`GpError::Lengths`], or [`GpError::Value`] for what is negative or not finite.
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

    /// The same rows with velocities that are taken as exact.
    #[must_use]
    pub fn with_certain_velocities(self) -> Self {
        Rows { variances: None, ..self }
    }

    /// Constraints are at right angles in the metric M(x): u = π − M⁻¹Aᵀ(AM⁻¹Aᵀ)⁻¹(Aπ), as where a robot's mass matrix weighs its joints.
    /// `momenta` (n, M) holds M(x)u of each row, from which (S31) follows in place of (S1).
    ///
    /// # Errors
    /// [`GpError::Lengths`], or [`GpError::Value`] for what is not finite or where uᵀMu is not positive though u ≠ 0.
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

    /// Adds the front end's estimates: the standard deviation of its noise, in units of the state, and for
    /// every sample of every trajectory the probability that a constraint switched before it.
    #[must_use]
    pub fn with_findings(self, noise: f64, switches: Option<Vec<Vec<f64>>>) -> Self {
        Rows { noise: Some(noise), switches, ..self }
    }

    /// Adds which constraint acted on each row, as any number for each, (M): constraints switch where the label of one row of a movement
    /// differs from that of the row before, and nowhere else. Stretches (S22) are then those between switches.
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

    /// Adds spaces in which constraints may be constant beside the recorded coordinates, such as where a robot's links are: stretches are
    /// looked for in each (S40).
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

    /// Variance of every row's velocity along each axis, (M); none if they are certain.
    pub fn variances(&self) -> Option<&[f64]> {
        self.variances.as_deref()
    }

    /// M(x)u of each row, (n, M); none in the metric of the coordinates themselves.
    pub fn momenta(&self) -> Option<&DMatrix<f64>> {
        self.momenta.as_ref()
    }

    /// The part of each velocity along the direction of its equation, (n, M): along M(x)u (S31), or all of it (S1).
    pub(crate) fn parts(&self) -> Cow<'_, DMatrix<f64>> {
        match &self.momenta {
            Some(momenta) => Cow::Owned(parts_along(&self.velocities, momenta)),
            None => Cow::Borrowed(&self.velocities),
        }
    }

    /// Which sample of which trajectory every row is.
    pub fn indices(&self) -> &[SampleIndex] {
        &self.indices
    }

    /// Standard deviation of the noise on recorded positions that the front end found, in units of the state.
    pub fn noise(&self) -> Option<f64> {
        self.noise
    }

    /// For every trajectory and sample the probability that a constraint switched before it, where the front end finds
    /// such.
    pub fn switches(&self) -> Option<&[Vec<f64>]> {
        self.switches.as_deref()
    }

    /// The label of the constraint on every row, (M); none where switches are not known.
    pub fn labels(&self) -> Option<&[usize]> {
        self.labels.as_deref()
    }

    /// Spaces in which constraints may be constant beside the recorded coordinates.
    pub fn task_spaces(&self) -> &[TaskSpace] {
        &self.task_spaces
    }

    /// Share of squares by which a step between two samples differs from the velocity there, where velocities were found
    /// from positions: the median of ‖û_{i+1} − û_i‖²/4‖û_i‖² over samples next to each other. Positions alone do not
    /// show whether the motion was steady or in steps of that size.
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

/// The part of each velocity along a direction of any length; zero along none. All (n, M).
pub(crate) fn parts_along(velocities: &DMatrix<f64>, directions: &DMatrix<f64>) -> DMatrix<f64> {
    let mut parts = directions.clone();
    for (mut part, velocity) in parts.column_iter_mut().zip(velocities.column_iter()) {
        let unit = part.try_normalize(0.0).unwrap_or_else(|| part.clone_owned());
        part.copy_from(&(&unit * unit.dot(&velocity)));
    }
    parts
}
