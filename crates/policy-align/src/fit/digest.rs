//! What a fit keeps of recordings that are too large to be held together.

use motion::{Finding, Recordings, SampleIndex};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::recorded_rows::rows;
use crate::stored::sha256;
use crate::{
    ContextUse, DataSummary, DigestError, FitError, PrepareOptions, Prepared, StateChannel, VelocitySource, prepare,
};

/// What is left of some recordings: means of their samples where velocities are noisy (S33), samples themselves where they are not, of these
/// an evenly spread part if there are many. [`fit_with`](crate::fit_with) learns from it as from whole recordings, but judges recordings by
/// those at hand alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Digest {
    /// Of the [`Digester`] that made it.
    pub made_for: String,
    /// What it is of.
    pub data: DataSummary,
    /// What the reader found.
    pub findings: Vec<Finding>,
    /// Factors that channels of the state, then of the context, were multiplied by, (n + p).
    pub scale: Vec<f64>,
    /// Rows that were left out.
    pub thinned: usize,
    /// Of each row, (M): its episode, counted among those used, and its sample.
    pub indices: Vec<(usize, usize)>,
    /// States with their contexts, (n + p, M), column after column.
    pub states: Vec<f64>,
    /// Velocities, (n, M), in scaled units of the state per second.
    pub velocities: Vec<f64>,
    /// Of velocities along each axis, (M); none if they are certain.
    pub variances: Option<Vec<f64>>,
}

/// Makes digests of further recordings, prepared like those at hand. It is small, so that other machines can have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Digester {
    options: PrepareOptions,
    own: Settings,
    made_for: String,
}

/// What decides on the rows of recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Settings {
    /// State, then context.
    channels: Vec<StateChannel>,
    velocities: VelocitySource,
    averaged: usize,
    /// How velocities came about, in words.
    decision: String,
}

impl Settings {
    fn of(prepared: &Prepared) -> Settings {
        let decision = prepared.decisions.iter().find(|decision| decision.what == "velocities");
        Settings {
            channels: prepared.state.iter().chain(&prepared.context).cloned().collect(),
            velocities: prepared.velocities,
            averaged: prepared.averaged,
            decision: decision.map_or_else(String::new, |decision| decision.value.clone()),
        }
    }

    fn scale(&self) -> Vec<f64> {
        self.channels.iter().map(|channel| channel.scale).collect()
    }

    fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|channel| channel.name.as_str()).collect()
    }
}

impl Digester {
    /// For recordings like these, which were prepared with `options`.
    pub fn new(prepared: &Prepared, options: &PrepareOptions) -> Digester {
        let own = Settings::of(prepared);
        let scaled = own.channels.iter().filter(|channel| channel.scale != 1.0);
        let scale = scaled.map(|channel| (channel.name.clone(), channel.scale)).collect();
        let context: Vec<String> = prepared.context.iter().map(|channel| channel.name.clone()).collect();
        let context = if context.is_empty() { ContextUse::Ignored } else { ContextUse::Named(context) };
        let options = PrepareOptions { scale, context, ..options.clone() };
        let (names, samples) = (&prepared.episodes, prepared.demonstrations.n_samples());
        let version = env!("CARGO_PKG_VERSION");
        let made_for = format!("{version} {own:?} {options:?} {names:?} {samples}");
        Digester { options, own, made_for: sha256(made_for.as_bytes()) }
    }

    /// What digests for the same fit have in common.
    pub fn made_for(&self) -> &str {
        &self.made_for
    }

    /// A digest of at most so many rows. The bits depend on nothing but these recordings and those of the digester.
    ///
    /// # Errors
    /// [`DigestError`]; [`DigestError::Differs`] for what is not like the recordings at hand.
    pub fn digest(&self, recordings: Recordings, most: usize) -> Result<Digest, DigestError> {
        let findings = recordings.findings.clone();
        let prepared = prepare(recordings, &self.options)?;
        let found = Settings::of(&prepared);
        let differ = |what: &str, here: String, before: String| {
            Err(DigestError::Differs { what: what.to_owned(), here, before })
        };
        if found.names() != self.own.names() {
            return differ("channels", found.names().join(", "), self.own.names().join(", "));
        }
        if found.decision != self.own.decision {
            return differ("velocities", found.decision, self.own.decision.clone());
        }
        // As noisy as those at hand: few movements tell less of noise.
        let prepared = Prepared { velocities: self.own.velocities, averaged: self.own.averaged, ..prepared };
        let rows = rows(&prepared)?;
        let means = rows.averaged();
        let few = means.at_most(most);
        Ok(Digest {
            made_for: self.made_for.clone(),
            data: DataSummary::of(&prepared, rows.velocities()),
            findings,
            scale: self.own.scale(),
            thinned: means.len() - few.len(),
            indices: few.indices().iter().map(|index| (index.trajectory, index.sample)).collect(),
            states: few.states().as_slice().to_vec(),
            velocities: few.velocities().as_slice().to_vec(),
            variances: few.variances().map(<[f64]>::to_vec),
        })
    }
}

impl Digest {
    /// The rows of all of these, with as many factors, (n + p), on what their channels were multiplied by before; trajectories count on.
    fn joined(digests: &[Digest], prepared: &Prepared) -> Result<gp::Rows, FitError> {
        let scale: Vec<f64> = prepared.state.iter().chain(&prepared.context).map(|channel| channel.scale).collect();
        let (width, dim) = (scale.len(), prepared.state.len());
        let wrong = |reason: String| FitError::Digest { reason };
        let (mut states, mut velocities, mut variances, mut indices) = (vec![], vec![], vec![], vec![]);
        let mut episodes = 0;
        for digest in digests {
            let count = digest.indices.len();
            if digest.made_for != digests[0].made_for {
                return Err(wrong("digests were made for different recordings or options".to_owned()));
            }
            let lengths = [digest.scale.len(), digest.states.len(), digest.velocities.len()];
            let certain = digest.variances.as_ref().is_some_and(|variances| variances.len() != count);
            if lengths != [width, width * count, dim * count] || certain {
                return Err(wrong(format!("a digest of {count} rows in {width} dimensions is damaged")));
            }
            let factors: Vec<f64> = scale.iter().zip(&digest.scale).map(|(now, then)| now / then).collect();
            let scaled = |of: &[f64], dim: usize| -> Vec<f64> {
                of.iter().enumerate().map(|(at, number)| number * factors[at % dim]).collect()
            };
            states.extend(scaled(&digest.states, width));
            velocities.extend(scaled(&digest.velocities, dim));
            // Noise along an axis, on average over axes.
            let factor = factors[..dim].iter().map(|factor| factor * factor).sum::<f64>() / dim as f64;
            variances.extend(digest.variances.iter().flatten().map(|variance| variance * factor));
            let index = |&(episode, sample): &(usize, usize)| SampleIndex { trajectory: episodes + episode, sample };
            indices.extend(digest.indices.iter().map(index));
            episodes += digest.data.episodes;
        }
        let count = indices.len();
        let matrix = |numbers: Vec<f64>, rows: usize| DMatrix::from_vec(rows, count, numbers);
        let (states, velocities) = (matrix(states, width), matrix(velocities, dim));
        let context = states.rows(dim, width - dim).into_owned();
        let rows = gp::Rows::new(states.rows(0, dim).into_owned(), velocities, indices)?;
        let rows = if width > dim { rows.with_context(&context)? } else { rows };
        Ok(if variances.len() == count { rows.with_variances(variances)? } else { rows })
    }
}

/// Rows at hand, and those of digests after them.
pub(super) fn with_digests(rows: gp::Rows, prepared: &Prepared, digests: &[Digest]) -> Result<gp::Rows, FitError> {
    if digests.is_empty() {
        return Ok(rows);
    }
    let further = Digest::joined(digests, prepared)?;
    let further = match (rows.variances(), further.variances()) {
        (Some(_), Some(_)) | (None, None) => further,
        // Other units decided otherwise on the noise.
        (None, Some(_)) => further.with_certain_velocities(),
        (Some(own), None) => {
            let usual = motion::upper_median(own.to_vec()).unwrap_or(0.0);
            let count = further.len();
            further.with_variances(vec![usual; count])?
        }
    };
    let (samples, thinned) = digests
        .iter()
        .fold((0, 0), |(samples, thinned), digest| (samples + digest.data.samples, thinned + digest.thinned));
    Ok(rows.with_further(further, samples, thinned)?)
}
