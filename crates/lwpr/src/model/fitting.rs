//! Passes over a whole data set.

use nalgebra::DMatrixView;
use rand::Rng;
use rand::seq::SliceRandom;

use crate::error::Side;
use crate::learning::memory::Memory;
use crate::learning::passes::{BatchFit, SHORTEST};
use crate::{Lwpr, LwprError};

impl Lwpr {
    /// Learns from all columns of `xs` (`n_in`, N) and `ys` (`n_out`, N) in the given order, `passes` times. Bit for bit
    /// the same as that many calls of [`update`](Self::update).
    ///
    /// # Errors
    /// [`LwprError::EmptyBatch`], [`LwprError::SampleCount`], [`LwprError::Dimension`], [`LwprError::BadValue`] or
    /// [`LwprError::TooManyReceptiveFields`]; the model is then unchanged.
    pub fn fit_in_order(
        &mut self,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        passes: usize,
    ) -> Result<(), LwprError> {
        self.fit(xs, ys, passes, &mut |_| ())
    }

    /// Learns from all columns of `xs` (`n_in`, N) and `ys` (`n_out`, N) in a new random order in each pass.
    ///
    /// # Errors
    /// As [`fit_in_order`](Self::fit_in_order).
    pub fn fit_batch<R: Rng + ?Sized>(
        &mut self,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        passes: usize,
        rng: &mut R,
    ) -> Result<(), LwprError> {
        self.fit(xs, ys, passes, &mut |order| order.shuffle(rng))
    }

    /// Performs `passes` passes; `arrange` orders the samples before each. Proceeds field by field if that gives the
    /// same result as sample by sample and is faster: many dimensions or a full metric fill vector registers anyway, and
    /// few samples do not justify the preparation.
    ///
    /// Independent of the caller's types, so that it is compiled once.
    fn fit(
        &mut self,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        passes: usize,
        arrange: &mut dyn FnMut(&mut [usize]),
    ) -> Result<(), LwprError> {
        self.check_batch(xs, ys)?;
        let mut order: Vec<usize> = (0..xs.ncols()).collect();
        let before = self.settings.params.max_receptive_fields.map(|_| self.clone());
        let mut fit = (self.settings.side_by_side() && xs.ncols() >= SHORTEST).then(|| BatchFit::new(self));
        let mut memory = Memory::new(&self.settings, xs.ncols(), passes);
        for _ in 0..passes {
            arrange(&mut order);
            let result = match &mut fit {
                Some(fit) => fit.pass(self, xs, ys, &order),
                None => self.update_in_order(xs, ys, &order, memory.as_mut()),
            };
            if let Err(refused) = result {
                if let Some(before) = before {
                    *self = before;
                }
                return Err(refused);
            }
        }
        Ok(())
    }

    fn check_batch(&self, xs: DMatrixView<'_, f64>, ys: DMatrixView<'_, f64>) -> Result<(), LwprError> {
        if xs.ncols() != ys.ncols() {
            return Err(LwprError::SampleCount { inputs: xs.ncols(), outputs: ys.ncols() });
        }
        if xs.ncols() == 0 {
            return Err(LwprError::EmptyBatch);
        }
        for (sample, (x, y)) in xs.column_iter().zip(ys.column_iter()).enumerate() {
            self.settings.check(x.as_slice(), Side::Input, sample)?;
            self.settings.check(y.as_slice(), Side::Output, sample)?;
        }
        Ok(())
    }
}
