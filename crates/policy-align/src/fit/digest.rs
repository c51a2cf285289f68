//! Digests: what a fit keeps of recordings that are too large to be held in memory together.

use motion::{Finding, SampleIndex};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::stored::sha256;
use crate::{DataSummary, FitError, Prepared, StateChannel};

/// A reduced form of some recordings. If velocities are noisy, it holds means of samples (S33), otherwise samples, evenly thinned if there
/// are many. [`fit_with`](crate::fit_with) learns from it as from whole recordings, but judges recordings only by those at hand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Digest {
    /// Checksum that identifies the recordings at hand and all options.
    pub made_for: String,
    /// Summary of the recordings it was made from.
    pub data: DataSummary,
    /// The reader's findings.
    pub findings: Vec<Finding>,
    /// Channels of the state, then of the context, (n + p), as the learner uses them.
    pub channels: Vec<StateChannel>,
    /// Rows before means were taken.
    pub rows: usize,
    /// Number of rows that were left out.
    pub thinned: usize,
    /// For each row, (M), in order: its episode, counted among those used, and its sample.
    pub indices: Vec<(usize, usize)>,
    /// Scaled states with their contexts, (n + p, M), column after column.
    pub states: Vec<f64>,
    /// Velocities, (n, M), in scaled units of the state per second.
    pub velocities: Vec<f64>,
    /// Variances of velocities along each axis, (M); `None` if velocities are certain.
    pub variances: Option<Vec<f64>>,
}

/// Checksum of the recordings at hand, with which [`Digest::made_for`] begins.
pub(crate) fn made_beside(prepared: &Prepared) -> String {
    let Prepared { episodes, state, context, velocities, averaged, .. } = prepared;
    let samples = prepared.demonstrations.n_samples();
    sha256(format!("{episodes:?} {samples} {state:?} {context:?} {velocities:?} {averaged}").as_bytes())
}

impl Digest {
    /// Whether the arrays have consistent lengths and the indices are in range and in order.
    fn is_sound(&self, dim: usize) -> bool {
        let count = self.indices.len();
        let variances = self.variances.as_ref().map_or(count, Vec::len);
        [self.states.len(), self.velocities.len(), variances] == [self.channels.len() * count, dim * count, count]
            && self.indices.iter().all(|&(episode, sample)| episode < self.data.episodes && sample < self.data.samples)
            && self.indices.is_sorted_by(|a, b| a < b)
            && self.rows <= self.data.samples
            && self.thinned.checked_add(count).is_some_and(|rows| rows <= self.rows)
    }

    /// The rows of all digests in the units of `prepared`; trajectories are numbered consecutively.
    fn joined(digests: &[Digest], prepared: &Prepared) -> Result<gp::Rows, FitError> {
        let channels: Vec<&StateChannel> = prepared.state.iter().chain(&prepared.context).collect();
        let (width, dim) = (channels.len(), prepared.state.len());
        let (mut states, mut velocities, mut variances, mut indices) = (vec![], vec![], vec![], vec![]);
        let mut episodes = 0;
        for digest in digests {
            let names = digest.channels.iter().map(|channel| &channel.name);
            if !digest.is_sound(dim) || !names.eq(channels.iter().map(|channel| &channel.name)) {
                let file = digest.data.files.first().map_or("a folder or a piece of a file", |file| &file.name);
                return Err(FitError::Digest { reason: format!("the digest of {file} is damaged") });
            }
            let factors = channels.iter().zip(&digest.channels).map(|(now, then)| now.scale / then.scale);
            let factors: Vec<f64> = factors.collect();
            let scaled = |of: &[f64], dim: usize| -> Vec<f64> {
                of.iter().enumerate().map(|(at, number)| number * factors[at % dim]).collect()
            };
            states.extend(scaled(&digest.states, width));
            velocities.extend(scaled(&digest.velocities, dim));
            // Noise along an axis, averaged over the axes.
            let factor = factors[..dim].iter().map(|factor| factor * factor).sum::<f64>() / dim as f64;
            variances.extend(digest.variances.iter().flatten().map(|variance| variance * factor));
            let index = |&(episode, sample): &(usize, usize)| SampleIndex { trajectory: episodes + episode, sample };
            indices.extend(digest.indices.iter().map(index));
            episodes += digest.data.episodes;
        }
        let count = indices.len();
        if !variances.is_empty() && variances.len() != count {
            return Err(FitError::Digest { reason: "only some digests have variances".to_owned() });
        }
        let matrix = |numbers: Vec<f64>, rows: usize| DMatrix::from_vec(rows, count, numbers);
        let (states, velocities) = (matrix(states, width), matrix(velocities, dim));
        let context = states.rows(dim, width - dim).into_owned();
        let rows = gp::Rows::new(states.rows(0, dim).into_owned(), velocities, indices)?;
        let rows = if width > dim { rows.with_context(&context)? } else { rows };
        Ok(if variances.is_empty() { rows } else { rows.with_variances(variances)? })
    }
}

/// The rows at hand, followed by those of the digests.
pub(super) fn with_digests(rows: gp::Rows, prepared: &Prepared, digests: &[Digest]) -> Result<gp::Rows, FitError> {
    if digests.is_empty() {
        return Ok(rows);
    }
    let further = Digest::joined(digests, prepared)?;
    let further = match (rows.variances(), further.variances()) {
        (Some(_), Some(_)) | (None, None) => further,
        // In other units, the decision on the noise was different.
        (None, Some(_)) => further.with_certain_velocities(),
        (Some(own), None) => {
            let usual = motion::upper_median(own.to_vec()).unwrap_or(0.0);
            let count = further.len();
            further.with_variances(vec![usual; count])?
        }
    };
    let (samples, thinned) =
        digests.iter().fold((0, 0), |(samples, thinned), digest| (samples + digest.rows, thinned + digest.thinned));
    Ok(rows.with_further(further, samples, thinned)?)
}

/// Channels with ranges widened to include the digests' data: those of the state, or those of the context after `before` others.
pub(super) fn widened(channels: &[StateChannel], before: usize, digests: &[Digest]) -> Vec<StateChannel> {
    let mut channels = channels.to_vec();
    for digest in digests.iter().filter(|digest| !digest.indices.is_empty()) {
        for (own, more) in channels.iter_mut().zip(&digest.channels[before..]) {
            own.low = own.low.min(more.low);
            own.high = own.high.max(more.high);
        }
    }
    channels
}
