//! The constraints on recordings, described by name for each stretch of an episode.

mod constraint_stretch;
mod file;
mod task_links;

pub use constraint_stretch::{ConstraintOn, ConstraintStretch};
pub use file::constraint_file;
pub use task_links::TaskLinks;

use gp::{Acting, ConstraintEstimates, StretchEstimate, TaskSpace};
use motion::Demonstrations;
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::channel_joints::{scales_of_joints, unscaled};
use crate::fit::{averaged, least_noisy_rows};
use crate::leave_out::in_units_of;
use crate::{EvaluateError, Model, Prepared, StateChannel};

/// Estimates the constraints on movements of a model's channels by comparing them with the model's policy (S26). Labels in the recordings
/// determine the switches, if they are present. Besides the channels, the `links` of a robot, if given, are candidates for the constrained
/// quantity.
///
/// The movements may be those from which the model was learnt.
///
/// # Errors
/// [`EvaluateError::Dimension`] or [`EvaluateError::Gp`] if the movements do not fit, [`EvaluateError::Robot`] for a state that the robot
/// refuses.
pub fn estimate_constraints(
    model: &Model,
    prepared: &Prepared,
    links: Option<&TaskLinks>,
) -> Result<Vec<ConstraintStretch>, EvaluateError> {
    let (policy, dim) = (model.learnt.policy(), prepared.demonstrations.dim());
    let movements = dim + prepared.demonstrations.context_dim();
    if policy.dim() != movements {
        return Err(EvaluateError::Dimension { policy: policy.dim(), movements });
    }
    let prepared = &in_units_of(model, prepared)?;
    let rows = least_noisy_rows(prepared)?;
    let scales = StateChannel::scales(&prepared.state);
    let of_joints = scales_of_joints(&prepared.state);
    let robot = |reason| EvaluateError::Robot { reason };
    let spaces = |links: &TaskLinks| links.spaces(&unscaled(&rows.states().rows(0, dim).into_owned(), &of_joints));
    let of_links = links.map(spaces).transpose().map_err(robot)?.unwrap_or_default();
    let (mut on, mut spaces) = (vec![ConstraintOn::Channels], vec![TaskSpace::recorded()]);
    for (of_link, space) in of_links {
        on.push(of_link);
        spaces.push(space.scaled(&of_joints));
    }
    let estimates = ConstraintEstimates::of(&rows, policy, &spaces)?;
    let movements = averaged(prepared)?;
    let naming = Naming { prepared, movements: &movements, links, on: &on, scales: &scales, of_joints: &of_joints };
    estimates.stretches.iter().map(|stretch| naming.name(stretch).map_err(robot)).collect()
}

/// The data needed to name a stretch.
struct Naming<'a> {
    prepared: &'a Prepared,
    movements: &'a Demonstrations,
    links: Option<&'a TaskLinks>,
    /// The quantity of each task space.
    on: &'a [ConstraintOn],
    scales: &'a DVector<f64>,
    of_joints: &'a DVector<f64>,
}

impl Naming<'_> {
    fn name(&self, stretch: &StretchEstimate) -> Result<ConstraintStretch, String> {
        let movement = &self.movements.trajectories()[stretch.trajectory];
        let (first, last) = stretch.samples;
        let on = self.on[stretch.space].clone();
        let units = if on == ConstraintOn::Channels { Some(self.scales) } else { None };
        let normals: Vec<DVector<f64>> =
            stretch.matrix.row_iter().map(|row| in_units(&row.transpose(), units)).collect();
        let lengths: Vec<f64> = normals.iter().map(nalgebra::Matrix::norm).collect();
        let normals: Vec<DVector<f64>> = normals.into_iter().map(|normal| normal.normalize()).collect();
        let pushed = |row: usize| if stretch.pushes(row) { stretch.bound[row] / lengths[row] } else { 0.0 };
        let speeds: Vec<f64> = (0..normals.len()).map(pushed).collect();
        let places =
            self.places(stretch.acting, &on, &movement.states().columns(first, last + 1 - first).into_owned())?;
        let level = |(normal, speed): (&DVector<f64>, &f64)| {
            let places = places.as_ref().filter(|_| *speed == 0.0)?;
            Some(normal.dot(&places.column_mean()))
        };
        let every = self.prepared.averaged;
        Ok(ConstraintStretch {
            episode: self.prepared.episodes[stretch.trajectory].clone(),
            samples: (first * every, last * every + every - 1),
            seconds: (movement.seconds(0, first), movement.seconds(0, last)),
            label: movement.labels().map(|labels| labels.at(first).to_owned()).filter(|label| !label.is_empty()),
            acting: stretch.acting,
            on,
            levels: normals.iter().zip(&speeds).map(level).collect(),
            speeds,
            normals: normals.iter().map(|normal| normal.as_slice().to_vec()).collect(),
            angle: stretch.angle.to_degrees(),
            evidence: stretch.evidence,
            hidden: stretch.hidden.column_iter().map(|column| self.hidden(column)).collect(),
        })
    }

    /// The constrained quantity's value at each of these states (n, N); `None` for orientations and without a constraint.
    fn places(&self, acting: Acting, on: &ConstraintOn, states: &DMatrix<f64>) -> Result<Option<DMatrix<f64>>, String> {
        match (acting, on, self.links) {
            (Acting::Constraint, ConstraintOn::Channels, _) => Ok(Some(unscaled(states, self.scales))),
            (Acting::Constraint, ConstraintOn::Position(link), Some(links)) => {
                links.places(link, &unscaled(states, self.of_joints))
            }
            _ => Ok(None),
        }
    }

    fn hidden(&self, direction: DVectorView<'_, f64>) -> Vec<f64> {
        in_units(&direction.into_owned(), Some(self.scales)).normalize().as_slice().to_vec()
    }
}

/// A row of A in the units of the recording: A S u, where S u is the learner's velocity.
fn in_units(row: &DVector<f64>, scales: Option<&DVector<f64>>) -> DVector<f64> {
    scales.map_or_else(|| row.clone(), |scales| row.component_mul(scales))
}
