use nalgebra::{DMatrix, DVector};

/// Wished changes of quantities that depend on the configuration: `jacobian` (m, n) times the step should be `rates` (m).
#[derive(Debug, Clone)]
pub(crate) struct Wishes {
    pub(crate) jacobian: DMatrix<f64>,
    pub(crate) rates: DVector<f64>,
}

impl Wishes {
    /// Takes a joint out that has moved by `way` and moves no more.
    pub(crate) fn settle(&mut self, joint: usize, way: f64) {
        self.rates.axpy(-way, &self.jacobian.column(joint), 1.0);
        self.jacobian.column_mut(joint).fill(0.0);
    }

    /// These wishes, and some `rows` of others below.
    pub(crate) fn and(&self, others: &Wishes, rows: &[usize]) -> Wishes {
        let (own, n) = self.jacobian.shape();
        let jacobian = self.jacobian.clone().resize_vertically(own + rows.len(), 0.0);
        let rates = self.rates.clone().resize_vertically(own + rows.len(), 0.0);
        let mut both = Wishes { jacobian, rates };
        both.jacobian.view_mut((own, 0), (rows.len(), n)).copy_from(&others.jacobian.select_rows(rows));
        both.rates.rows_mut(own, rows.len()).copy_from(&others.rates.select_rows(rows));
        both
    }
}
