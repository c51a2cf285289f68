//! (S22), (S23), (S41): rows of stretches.

use std::borrow::Cow;
use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector, DVectorView};
use rayon::prelude::*;

use crate::Rows;
use crate::rows::kept::{Kept, OfStretches, RowsDropped, Selection};
use crate::rows::noise_weights::relative;
use crate::rows::thinning::{MIDDLE, thinned};
use crate::stretches::{Stretch, Stretches};
use motion::{SampleIndex, upper_median};

/// Rows are used whose squared length exceeds this share of the mean square of all.
const LEAST: f64 = 1e-12;
/// (S24): mean square of pushes, in units of what noise alone gives, below which nothing pushes.
const LEAST_SIGNIFICANCE: f64 = 4.0;
/// Share of the movements that must have stretches: models of different movements are not compared.
const COVERED: f64 = 0.5;
/// One equation vᵀπ(x) = vᵀu.
struct Equation {
    /// The sample's row.
    row: usize,
    /// v (vᵀu), the part of the velocity along v.
    velocity: DVector<f64>,
    /// |vᵀu|.
    length: f64,
    /// Variance of vᵀu in units of s².
    noise: f64,
    /// ℓ_k of its direction.
    direction_length: f64,
}

/// At most `most` of the equations, in their order.
fn few(equations: Vec<Equation>, rows: &Rows, most: usize) -> Vec<Equation> {
    let trajectory = |&at: &usize| rows.indices()[equations[at].row].trajectory;
    let all: Vec<usize> = (0..equations.len()).collect();
    let taken: BTreeSet<usize> =
        thinned(all.chunk_by(|a, b| trajectory(a) == trajectory(b)), most, || MIDDLE).into_iter().collect();
    equations.into_iter().enumerate().filter(|(at, _)| taken.contains(at)).map(|(_, equation)| equation).collect()
}

impl Stretches {
    /// Rows of all samples that lie in stretches, with their noise weights (S23); evenly many of them, where they are more
    /// than `selection` allows. None if they are of far fewer movements than `kept` ones.
    ///
    /// In a task space there are several for each sample, whose directions do not depend on the velocity: samples are averaged (S33).
    pub(crate) fn rows(&self, rows: &Rows, kept: &Kept, selection: &Selection) -> Option<Kept> {
        let rows = &*if self.through.is_some() { rows.averaged() } else { Cow::Borrowed(rows) };
        let of = |row: usize| self.equations(rows, row);
        let mut equations: Vec<Equation> = (0..rows.len()).into_par_iter().flat_map_iter(of).collect();
        let mean_square = equations.iter().map(|of| of.length.powi(2)).sum::<f64>() / equations.len() as f64;
        equations.retain(|of| of.length.powi(2) > LEAST * mean_square);
        let found = equations.len();
        let equations = few(equations, rows, selection.max_rows);
        let lengths: Vec<f64> = equations.iter().map(|of| of.length).collect();
        let policy_squared = 2.0 * upper_median(lengths.clone())?.powi(2);
        let variance = |of: &Equation| self.noise * (of.noise + policy_squared / of.direction_length.powi(2));
        let all: Vec<usize> = (0..equations.len()).collect();
        let index = |at: usize| rows.indices()[equations[at].row];
        let same = |&a: &usize, &b: &usize| index(a).trajectory == index(b).trajectory;
        let groups: Vec<Vec<usize>> = all.chunk_by(same).map(<[usize]>::to_vec).collect();
        if groups.len() < 3 || (groups.len() as f64) < COVERED * kept.groups.len() as f64 {
            return None;
        }
        let columns: Vec<DVector<f64>> = equations.iter().map(|of| of.velocity.clone()).collect();
        let used: Vec<usize> = equations.iter().map(|of| of.row).collect();
        Some(Kept {
            states: rows.states().select_columns(&used),
            velocities: DMatrix::from_columns(&columns),
            speeds: lengths,
            whole: Some(rows.velocities().select_columns(&used)),
            variances: None,
            of_stretches: Some(OfStretches {
                weights: relative(equations.iter().map(variance).collect()),
                push: self.pushed.then(|| self.push()),
                space: self.through.as_ref().map(|through| through.space),
            }),
            trajectories: groups.iter().map(|rows_of| index(rows_of[0]).trajectory).collect(),
            groups,
            hyper: all.iter().copied().step_by(all.len().div_ceil(selection.hyper_rows).max(1)).collect(),
            grouping: kept.grouping,
            dropped: RowsDropped { thinned: found - equations.len(), ..RowsDropped::default() },
            rows: used,
        })
    }

    /// (S22) or (S41) of one sample, a direction each.
    fn equations(&self, rows: &Rows, row: usize) -> Vec<Equation> {
        let Some(stretch) = self.at(rows.indices()[row]) else { return Vec::new() };
        let velocity = rows.velocities().column(row);
        let along = |direction: DVectorView<'_, f64>, noise: f64, direction_length: f64| {
            let part = direction.dot(&velocity);
            Equation { row, velocity: direction * part, length: part.abs(), noise, direction_length }
        };
        let Stretch { directions, lengths, .. } = stretch;
        match &self.through {
            None => {
                let each = directions.column_iter().zip(lengths);
                each.map(|(direction, &length)| along(direction, 1.0, length)).collect()
            }
            Some(through) => {
                let noise = rows.variances().map_or(1.0, |variances| variances[row] / self.noise);
                let free = through.free(rows, row, directions, lengths);
                free.iter().map(|free| along(free.direction.as_view(), noise, free.length)).collect()
            }
        }
    }

    /// The stretch that holds a sample.
    fn at(&self, index: SampleIndex) -> Option<&Stretch> {
        let before = |stretch: &Stretch| (stretch.trajectory, stretch.samples.1) < (index.trajectory, index.sample);
        let next = self.all.get(self.all.partition_point(before))?;
        (next.trajectory == index.trajectory && next.samples.0 <= index.sample).then_some(next)
    }

    /// Root mean square of the pushes A⁺b, in units of the state per second.
    fn push(&self) -> f64 {
        let squares: f64 = self.all.iter().map(|stretch| stretch.push.norm_squared()).sum();
        (squares / self.all.len() as f64).sqrt()
    }

    /// (S24).
    pub(crate) fn push_is_significant(&self) -> bool {
        self.significance() >= LEAST_SIGNIFICANCE
    }

    /// Mean square of the pushes along normals, in units of what noise would give: about 1 where nothing pushes.
    fn significance(&self) -> f64 {
        let all = self.all.iter().map(|stretch| stretch.significance);
        let (squares, normals) =
            all.fold((0.0, 0), |(squares, normals), (square, count)| (squares + square, normals + count));
        squares / normals as f64
    }
}
