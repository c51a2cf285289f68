use std::collections::BTreeSet;
use std::sync::Arc;

use constraints::NullSpaceProjector;
use nalgebra::{DMatrix, DVector, DVectorView};

use super::constraint_part::{Evaluated, Function, Kind, Part, fitting};
use super::holding::Holding;

/// From which distance on a ball slows what approaches it, and at which it stops it, in radii: what steps err by stays
/// outside.
const BAND: f64 = 0.05;
const MARGIN: f64 = 0.01;
/// How often speeds towards balls are taken away in turn, until none is left.
const ROUNDS: usize = 20;

/// Constraints on a roll-out that hold at their times.
#[derive(Debug, Clone, Default)]
pub struct ConstraintSet {
    pub(crate) parts: Vec<Part>,
}

/// Which constraint could not be computed, counted from 1, and why.
pub(crate) type Fault = (usize, String);

impl ConstraintSet {
    /// The state (n) keeps its value along each row of A, (k, n), from beginning to end.
    ///
    /// # Errors
    /// In a sentence: rows of another length than the state, without a direction, or not finite.
    pub fn normal(rows: DMatrix<f64>, n: usize) -> Result<ConstraintSet, String> {
        let rows = fitting(rows, n)?;
        if rows.nrows() == 0 || rows.row_iter().any(|row| row.norm() == 0.0) {
            return Err("a constraint has no direction: give numbers that are not all 0".to_owned());
        }
        Ok(ConstraintSet::always(Kind::Normal(rows)))
    }

    /// A(x, t) u = 0, from beginning to end, with A as a function of state (n) and seconds. It gives (k, n), where k may
    /// change, or a sentence why it has no value there, which becomes [`RollOutError::Constraint`](crate::RollOutError::Constraint).
    ///
    /// Rows that change forbid directions of movement; whether they keep anything, and so [`Path::broken_by`], only its
    /// author knows: it is 0 here.
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

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Whether one is a function, which may change at any time.
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

    /// Times at which one begins or ends.
    pub(crate) fn switches(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().flat_map(|part| [part.from, part.until])
    }

    /// What the constraints that hold leave of `wanted`, (n), at a state and a time. `scale` takes states to where constraints act
    /// at right angles: N = I − A⁺A (3) of A S⁻¹. Near a ball the speed towards it fades to 0 with the distance.
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

/// Takes away what approaches balls, given as distance in bands and gradient of the distance, within what is free. What
/// is too near is led away.
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
                // Nothing that is free leads away from it.
                wanted.fill(0.0);
                return;
            }
            wanted.axpy(excess / turn, &along, 1.0);
        }
        if !changed {
            return;
        }
    }
    // Several balls leave no motion that this finds.
    wanted.fill(0.0);
}

/// Follows how well constraints are kept.
#[derive(Debug, Clone)]
pub(crate) struct Watch<'a> {
    set: &'a ConstraintSet,
    holding: Holding<'a>,
    /// The value of each part when it began to hold.
    begun: Vec<Option<DVector<f64>>>,
    /// The largest change so far, or depth within a ball, in units of the state or metres.
    pub(crate) broken_by: f64,
    /// Which part that was, counted from 1.
    pub(crate) worst: usize,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(set: &'a ConstraintSet) -> Self {
        // At its end a constraint has held until then.
        let holding = Holding::new(&set.parts, |part, time| time > part.until);
        Watch { set, holding, begun: vec![None; set.parts.len()], broken_by: 0.0, worst: 0 }
    }

    /// At a state, at times that do not go back.
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
