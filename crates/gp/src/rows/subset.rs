//! Subsets of the rows.

use std::collections::HashSet;

use crate::Rows;
use crate::rows::thinning::{MIDDLE, thinned};

impl Rows {
    /// The rows whose samples are not held out by `held_out(trajectory, sample)`.
    #[must_use]
    pub fn without(&self, held_out: impl Fn(usize, usize) -> bool) -> Self {
        let stays = |row: usize| !held_out(self.indices[row].trajectory, self.indices[row].sample);
        let further = self.further.as_ref().map(|further| further.without(&held_out));
        Rows { further, ..self.chosen(&stays) }
    }

    /// The chosen rows, without further ones.
    pub(crate) fn chosen(&self, is_chosen: &dyn Fn(usize) -> bool) -> Self {
        let rows: Vec<usize> = (0..self.len()).filter(|&row| is_chosen(row)).collect();
        Rows {
            states: self.states.select_columns(&rows),
            velocities: self.velocities.select_columns(&rows),
            variances: self.variances.as_ref().map(|variances| rows.iter().map(|&row| variances[row]).collect()),
            indices: rows.iter().map(|&row| self.indices[row]).collect(),
            momenta: self.momenta.as_ref().map(|momenta| momenta.select_columns(&rows)),
            noise: self.noise,
            switches: self.switches.clone(),
            labels: self.labels.as_ref().map(|labels| rows.iter().map(|&row| labels[row]).collect()),
            means: self.means,
            task_spaces: self
                .task_spaces
                .iter()
                .map(|space| space.with_rows(|of| rows.iter().map(|&row| of[row].clone()).collect()))
                .collect(),
            further: None,
        }
    }

    /// At most `most` of the rows: the first of every trajectory, and evenly spaced others.
    #[must_use]
    pub fn at_most(&self, most: usize) -> Rows {
        let all: Vec<usize> = (0..self.len()).collect();
        let trajectories = all.chunk_by(|&a, &b| self.indices[a].trajectory == self.indices[b].trajectory);
        let taken: HashSet<usize> = thinned(trajectories, most, || MIDDLE).into_iter().collect();
        self.chosen(&|row| taken.contains(&row))
    }
}
