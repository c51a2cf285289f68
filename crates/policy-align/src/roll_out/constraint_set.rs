use std::collections::BTreeSet;
use std::sync::Arc;

use constraints::NullSpaceProjector;
use nalgebra::{DMatrix, DVector, DVectorView};

use super::constraint_part::{Evaluated, Function, Kind, Part, fitting};
use super::holding::Holding;

/// Distances from a ball, in radii, at which it begins to slow the approach and at which it stops it. The margin keeps integration
/// errors outside the ball.
const BAND: f64 = 0.05;
const MARGIN: f64 = 0.01;
/// Largest number of passes that remove velocity components towards balls.
const ROUNDS: usize = 20;

/// Constraints on a roll-out, each with the times at which it holds.
#[derive(Debug, Clone, Default)]
pub struct ConstraintSet {
    pub(crate) parts: Vec<Part>,
}

/// The number of a constraint that could not be computed, counted from 1, and the reason.
pub(crate) type Fault = (usize, String);

impl ConstraintSet {
    /// The state (n) keeps its value along each row of A, (k, n), during the whole roll-out.
    ///
    /// # Errors
    /// A sentence: rows whose length differs from the state's, without a direction, or not finite.
    pub fn normal(rows: DMatrix<f64>, n: usize) -> Result<ConstraintSet, String> {
        let rows = fitting(rows, n)?;
        if rows.nrows() == 0 || rows.row_iter().any(|row| row.norm() == 0.0) {
            return Err("a constraint has no direction: give numbers that are not all 0".to_owned());
        }
        Ok(ConstraintSet::always(Kind::Normal(rows)))
    }

    /// A(x, t) u = 0 during the whole roll-out, with A as a function of state (n) and seconds. The function returns (k, n), where k
    /// may change, or a sentence why A has no value there, which becomes
    /// [`RollOutError::Constraint`](crate::RollOutError::Constraint).
    ///
    /// Varying rows forbid directions of movement. Only the author of the function knows whether they keep any quantity, so they do
    /// not contribute to [`Path::broken_by`].
    ///
    /// [`Path::broken_by`]: crate::Path::broken_by
    pub fn function(
        rows: impl Fn(DVectorView<'_, f64>, f64) -> Result<DMatrix<f64>, String> + Send + Sync + 'static,
    ) -> ConstraintSet {
        ConstraintSet::always(Kind::Function(Function(Arc::new(rows))))
    }

    fn always(kind: Kind) -> ConstraintSet {
        ConstraintSet { parts: vec![Part { kind, from: f64::NEG_INFINITY, until: f64::INFINITY }] }
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Time from which on no constraint acts, in seconds. `None` if one acts without end, or the set is empty.
    pub fn ends(&self) -> Option<f64> {
        self.parts.iter().map(|part| part.until).reduce(f64::max).filter(|end| end.is_finite())
    }

    /// Whether a constraint is a function, which may change at any time.
    pub(crate) fn changes(&self) -> bool {
        self.parts.iter().any(|part| matches!(part.kind, Kind::Function(_)))
    }

    /// The least radius of a ball, in its unit.
    pub(crate) fn least_radius(&self) -> f64 {
        let radius = |part: &Part| match part.kind {
            Kind::Ball { radius, .. } | Kind::LinkBall { radius, .. } => radius,
            Kind::Normal(_) | Kind::Function(_) | Kind::Plane(..) => f64::INFINITY,
        };
        self.parts.iter().map(radius).fold(f64::INFINITY, f64::min)
    }

    /// Times at which a constraint begins or ends.
    pub(crate) fn switches(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().flat_map(|part| [part.from, part.until])
    }

    /// Projects `wanted`, (n), onto the motions that the constraints allow at a state and a time. `scale` converts states to units
    /// in which constraints project orthogonally: N = I − A⁺A (3) of A S⁻¹. Near a ball, the speed towards it decreases to 0 with
    /// the distance.
    pub(crate) fn leave(
        &self,
        holding: &BTreeSet<usize>,
        (state, time): (DVectorView<'_, f64>, f64),
        scale: &DVector<f64>,
        wanted: &mut DVector<f64>,
    ) -> Result<(), Fault> {
        if self.parts.is_empty() {
            return Ok(());
        }
        let (mut rows, mut balls) = (Vec::new(), Vec::new());
        for &at in holding {
            match self.parts[at].kind.at(state, time).map_err(|reason| (at + 1, reason))? {
                Evaluated::Rows(matrix) => rows.extend(matrix.row_iter().map(nalgebra::Matrix::into_owned)),
                Evaluated::Distance { clearance, radius, gradient } => {
                    let bands = (clearance / radius - MARGIN) / (BAND - MARGIN);
                    balls.push((bands.max(-1.0), gradient.component_div(scale)));
                }
            }
        }
        wanted.component_mul_assign(scale);
        let mut matrix = DMatrix::from_fn(rows.len(), state.len(), |row, column| rows[row][column]);
        matrix.row_iter_mut().for_each(|mut row| row.component_div_assign(&scale.transpose()));
        let free = NullSpaceProjector::new(&matrix).map_err(|error| (1, error.to_string()))?;
        free.project_into(wanted.as_view_mut());
        keep_off(&balls, &free, wanted);
        wanted.component_div_assign(scale);
        Ok(())
    }
}

/// Removes velocity components towards balls within the free directions; a state that is too near is moved away. Each ball has its
/// distance in bands and the gradient of its distance.
fn keep_off(balls: &[(f64, DVector<f64>)], free: &NullSpaceProjector, wanted: &mut DVector<f64>) {
    let speed = wanted.norm();
    for _ in 0..ROUNDS {
        let mut changed = false;
        for (bands, gradient) in balls.iter().filter(|(bands, _)| *bands < 1.0) {
            let along = free.project(gradient.as_view());
            let allowed = bands * gradient.norm() * speed;
            let excess = -gradient.dot(wanted) - allowed;
            if excess <= 1e-14 * gradient.norm() * speed {
                continue;
            }
            changed = true;
            let turn = along.norm_squared();
            if turn <= 1e-20 * gradient.norm_squared() {
                // No free direction leads away from it.
                wanted.fill(0.0);
                return;
            }
            wanted.axpy(excess / turn, &along, 1.0);
        }
        if !changed {
            return;
        }
    }
    // With several balls, no allowed motion was found.
    wanted.fill(0.0);
}

/// Monitors the violation of constraints.
#[derive(Debug, Clone)]
pub(crate) struct Watch<'a> {
    set: &'a ConstraintSet,
    holding: Holding<'a>,
    /// The value of each part when it began to hold.
    begun: Vec<Option<DVector<f64>>>,
    /// The largest violation so far: change, or depth within a ball, in units of the state or metres.
    pub(crate) broken_by: f64,
    /// Number of the part with this violation, counted from 1.
    pub(crate) worst: usize,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(set: &'a ConstraintSet) -> Self {
        // A constraint is also checked at its end time.
        let holding = Holding::new(&set.parts, |part, time| time > part.until);
        Watch { set, holding, begun: vec![None; set.parts.len()], broken_by: 0.0, worst: 0 }
    }

    /// Checks the constraints at a state; times must not decrease.
    pub(crate) fn update(&mut self, state: DVectorView<'_, f64>, time: f64) -> Result<(), Fault> {
        for &at in self.holding.at(time) {
            let begun = &mut self.begun[at];
            let (kept, is_distance) = self.set.parts[at].kind.kept(state, time).map_err(|reason| (at + 1, reason))?;
            let broken =
                if is_distance { -kept[0] } else { (&kept - &*begun.get_or_insert_with(|| kept.clone())).amax() };
            if broken > self.broken_by {
                (self.broken_by, self.worst) = (broken, at + 1);
            }
        }
        Ok(())
    }
}
