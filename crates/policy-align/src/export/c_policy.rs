use std::fmt::Write as _;

use nalgebra::DMatrix;

use super::c::CSource;
use super::error::ExportError;
use super::tables::{LearnerTables, Tables};
use super::{c_gp, c_lwpr};
use crate::Model;

impl CSource {
    /// The text of the C file for a model.
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn of(&self, model: &Model) -> Result<String, ExportError> {
        self.check_name()?;
        let tables = Tables::of(model)?;
        let mut text = self.head(model);
        let (n, all) = (tables.dim, tables.scale.len());
        let _ = match tables.context_dim() {
            0 => writeln!(text, "enum {{ N = {n} }};\n"),
            _ => writeln!(text, "enum {{ N = {n}, D = {all} }}; /* of the state, and with the context */\n"),
        };
        self.vector("SCALE", tables.scale.as_slice(), &mut text);
        let bounds = DMatrix::from_fn(2, all, |end, k| tables.bounds[k][end]);
        self.columns("BOUNDS", &bounds, &mut text);
        match &tables.learner {
            LearnerTables::Lwpr(lwpr) => c_lwpr::write(self, lwpr, tables.per_unit, &mut text),
            LearnerTables::Slope(slope, radius) => {
                c_gp::write_slope(self, slope, (*radius, tables.per_unit), n, &mut text);
            }
            LearnerTables::Direct(direct, radius) => c_gp::write_direct(self, direct, *radius, n, &mut text),
        }
        Ok(text)
    }
}
