//! The Gaussian processes as implementations of [`Learner`].

use std::fmt::Debug;

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, SampleIndex};
use rand::Rng;
use serde::Serialize;

use crate::direct::direct_gp::DirectGp;
use crate::reading::auto_gp::AutoGp;
use crate::slope::slope_gp::SlopeGp;
use crate::{FrontEnd, GpError, Rows};

/// A Gaussian process that learns a policy from rows.
pub trait LearnsFromRows: Debug + Send + Sync {
    /// Learns from rows, as `fit` of the same type.
    ///
    /// # Errors
    /// As `fit`.
    fn learn_from_rows(&self, rows: &Rows, rng: &mut dyn Rng) -> Result<Box<dyn LearntPolicy>, GpError>;
}

impl LearnsFromRows for SlopeGp {
    fn learn_from_rows(&self, rows: &Rows, rng: &mut dyn Rng) -> Result<Box<dyn LearntPolicy>, GpError> {
        Ok(Box::new(self.fit(rows, rng)?))
    }
}

impl LearnsFromRows for DirectGp {
    fn learn_from_rows(&self, rows: &Rows, rng: &mut dyn Rng) -> Result<Box<dyn LearntPolicy>, GpError> {
        Ok(Box::new(self.fit(rows, rng)?))
    }
}

impl LearnsFromRows for AutoGp {
    fn learn_from_rows(&self, rows: &Rows, rng: &mut dyn Rng) -> Result<Box<dyn LearntPolicy>, GpError> {
        Ok(Box::new(self.fit(rows, rng)?))
    }
}

/// A Gaussian process as a learner, with the front end that produces its rows.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct GpLearner<G> {
    /// The front end, which turns recordings into rows.
    pub front_end: FrontEnd,
    /// The Gaussian process that is fitted to the rows.
    pub gp: G,
}

impl<G: LearnsFromRows> Learner for GpLearner<G> {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(self.gp.learn_from_rows(&self.front_end.rows_without(demonstrations, held_out)?, rng)?)
    }
}
