//! Fig. 5: one data set of the parabola, from the observations to the learnt surface.

pub(crate) mod compute;
pub(crate) mod draw;

use plot::{Field, PlotError};
use serde::{Deserialize, Serialize};

use crate::sound::{Sound, as_many, field, grid, some};

/// Data of the figure.
#[derive(Serialize, Deserialize)]
pub(crate) struct Levels {
    /// Index of the data set.
    data_set: u32,
    movements: Vec<Movement>,
    truth: Field,
    /// At the places of `truth`; `None` where no receptive field is active.
    learnt: Vec<Vec<Option<f64>>>,
    /// Errors at held-out samples, (A4) and (A3).
    alignment_nmse: f64,
    potential_nmse: f64,
}

impl Sound for Levels {
    const LARGEST: f64 = 100.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.movements)?;
        for Movement { points, truth, before, after } in &self.movements {
            some("points", points)?;
            for values in [Some(truth), Some(before), after.as_ref()].into_iter().flatten() {
                as_many("heights of a movement", values, points.len())?;
            }
        }
        field("truth", &self.truth)?;
        grid("learnt", &self.learnt, self.truth.x().len(), self.truth.y().len())
    }
}

impl Levels {
    fn learnt(&self) -> Result<Field, PlotError> {
        let row = |row: &Vec<Option<f64>>| row.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
        let values = self.learnt.iter().map(row).collect();
        Field::new(self.truth.x().to_vec(), self.truth.y().to_vec(), values)
    }
}

/// One movement, sample by sample.
#[derive(Serialize, Deserialize)]
struct Movement {
    /// (x₁, x₂).
    points: Vec<(f64, f64)>,
    truth: Vec<f64>,
    /// The local potential, with the same constant for all movements.
    before: Vec<f64>,
    /// The aligned local potential; `None` if alignment leaves the movement out.
    after: Option<Vec<f64>>,
}
