use nalgebra::{DMatrix, DVector};

/// Desired rates of quantities that depend on the configuration: `jacobian` (m, n) times a step (n) should equal
/// `rates` (m).
#[derive(Debug, Clone)]
pub(crate) struct Task {
    pub(crate) jacobian: DMatrix<f64>,
    pub(crate) rates: DVector<f64>,
}

impl Task {
    /// Removes a joint that has moved by `displacement`, radians or metres, and stays there.
    pub(crate) fn hold(&mut self, joint: usize, displacement: f64) {
        self.rates.axpy(-displacement, &self.jacobian.column(joint), 1.0);
        self.jacobian.column_mut(joint).fill(0.0);
    }

    /// This task, with some `rows` of another appended.
    pub(crate) fn stacked(&self, other: &Task, rows: &[usize]) -> Task {
        let (own, n) = self.jacobian.shape();
        let jacobian = self.jacobian.clone().resize_vertically(own + rows.len(), 0.0);
        let rates = self.rates.clone().resize_vertically(own + rows.len(), 0.0);
        let mut both = Task { jacobian, rates };
        both.jacobian.view_mut((own, 0), (rows.len(), n)).copy_from(&other.jacobian.select_rows(rows));
        both.rates.rows_mut(own, rows.len()).copy_from(&other.rates.select_rows(rows));
        both
    }
}
