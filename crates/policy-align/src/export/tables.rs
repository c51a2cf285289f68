use gp::{DirectFit, DirectFormula, SlopeFit, SlopeFormula};
use nalgebra::DVector;

use super::error::ExportError;
use super::lwpr_tables::LwprTables;
use super::support_radius::squared_radius;
use crate::{Learnt, Model};

/// A policy as tables of numbers, with the parts that all learners share.
pub(super) struct Tables<'a> {
    /// Factors by which state and context are multiplied before the learner's policy is evaluated, and by which the action
    /// is divided, (n + p).
    pub(super) scale: DVector<f64>,
    /// Limits of the supported inputs, (n + p).
    pub(super) bounds: Vec<[f64; 2]>,
    /// Dimension n of the state.
    pub(super) dim: usize,
    /// Factor of the potential.
    pub(super) per_unit: f64,
    pub(super) learner: LearnerTables<'a>,
}

/// Parameters of each learner's policy. A Gaussian process supports a state within this squared distance of a learnt one,
/// in scaled coordinates.
pub(super) enum LearnerTables<'a> {
    Lwpr(LwprTables<'a>),
    Slope(SlopeFormula<'a>, f64),
    Direct(DirectFormula<'a>, f64),
}

impl Tables<'_> {
    pub(super) fn of(model: &Model) -> Result<Tables<'_>, ExportError> {
        let learner = match &model.learnt {
            Learnt::PolicyAlign(policy) => {
                LearnerTables::Lwpr(LwprTables::new(policy.global_potential().regression())?)
            }
            Learnt::Slope(fit) => LearnerTables::slope(model, fit),
            Learnt::Direct(fit) => LearnerTables::direct(model, fit),
            Learnt::Auto(both) if both.takes_slope() => LearnerTables::slope(model, both.slope()),
            Learnt::Auto(both) => LearnerTables::direct(model, both.direct_of_free_rows()),
        };
        let scale = model.input_scales();
        let (bounds, per_unit) = (model.bounds(), model.potential_factor());
        Ok(Tables { scale, bounds, dim: model.state.len(), per_unit, learner })
    }

    /// Dimension p of the context.
    pub(super) fn context_dim(&self) -> usize {
        self.scale.len() - self.dim
    }
}

impl<'a> LearnerTables<'a> {
    fn slope(model: &Model, fit: &'a SlopeFit) -> Self {
        let formula = fit.formula();
        let squared_radius = squared_radius(model, &formula.scaled);
        LearnerTables::Slope(formula, squared_radius)
    }

    fn direct(model: &Model, fit: &'a DirectFit) -> Self {
        let formula = fit.formula();
        let squared_radius = squared_radius(model, &formula.scaled);
        LearnerTables::Direct(formula, squared_radius)
    }
}
