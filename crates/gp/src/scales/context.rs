//! Weight of a context relative to the state.

use nalgebra::DVector;
use rand::Rng;

use crate::kernel::family::Family;
use crate::rows::kept::{Kept, spreads};
use crate::slope::data::SlopeData;
use crate::slope::slope_gp::SlopeGp;
use crate::{GpError, Rows};

/// Maximum number of rows, and number of rows that determine the amplitudes.
const ROWS: usize = 300;
const HYPER_ROWS: usize = 150;
/// Spread of a context in units of the state's spread: the values to try, in this order.
const WORTH: [f64; 4] = [1.0, 0.5, 0.25, 2.0];

impl SlopeGp {
    /// A factor for each context, (p). It gives the context the spread of the state, times one common factor: the one that best
    /// predicts left-out movements. Constant contexts keep their unit. At most four fits to 300 rows.
    ///
    /// # Errors
    /// As [`SlopeGp::fit`].
    pub fn context_factors<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<DVector<f64>, GpError> {
        let (dim, context_dim) = (rows.dim(), rows.context_dim());
        let spread = spreads(rows.states());
        let of_state = spread.rows(0, dim).norm() / (dim as f64).sqrt();
        let alike = |spread: f64| if spread > 0.0 && of_state > 0.0 { of_state / spread } else { 1.0 };
        let alike = spread.rows(dim, context_dim).map(alike);
        if context_dim == 0 {
            return Ok(alike);
        }
        let kept = self.row_limits()?.at_most(ROWS, HYPER_ROWS).keep(rows, rng)?;
        let mut best = (1.0, f64::NEG_INFINITY);
        for worth in WORTH {
            let r_squared = self.left_out_in(&kept, &(&alike * worth)).unwrap_or(f64::NEG_INFINITY);
            if r_squared > best.1 {
                best = (worth, r_squared);
            }
        }
        Ok(alike * best.0)
    }

    /// R² with contexts multiplied by their factors; `None` without a Cholesky factor.
    fn left_out_in(&self, kept: &Kept, factors: &DVector<f64>) -> Option<f64> {
        let mut kept = Kept { variances: None, ..kept.clone() };
        let dim = kept.velocities.nrows();
        for mut state in kept.states.column_iter_mut() {
            state.rows_mut(dim, factors.len()).component_mul_assign(factors);
        }
        let data = SlopeData::from_kept(&kept, vec![1.0; kept.speeds.len()]).ok()?;
        let fit = data.fit(&Family::Smooth.blocks(self.trend), &kept.hyper, None)?;
        Some(fit.level.left_out.r_squared)
    }
}
