use demo_io::{ReadError, ReadOptions, read_further};
use motion::{LeftOut, Recordings, Subject};
use serde::{Deserialize, Serialize};

use crate::fit::{made_beside, rows};
use crate::large::{DigestError, FurtherPiece, PartError};
use crate::stored::sha256;
use crate::{
    ContextUse, DataSummary, Digest, FileSummary, PrepareError, PrepareOptions, Prepared, StateChannel, VelocitySource,
    prepare, trim_still,
};

/// Makes digests of further files and pieces, which it reads and prepares like the recordings at hand. It is small, so that it can be sent
/// to other machines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Digester {
    reading: ReadOptions,
    /// Whether samples at rest at either end are removed.
    trim: bool,
    preparing: PrepareOptions,
    /// Channels of the recordings at hand: the state, then the context.
    channels: Vec<StateChannel>,
    velocities: VelocitySource,
    averaged: usize,
    /// Source of the velocities, in words.
    decision: String,
    made_for: String,
}

impl Digester {
    /// A digester for files like those of the recordings at hand. These were read with `reading`, `trim`med of samples at rest at either
    /// end or not, and prepared with `preparing`.
    pub fn new(prepared: &Prepared, preparing: &PrepareOptions, (reading, trim): (&ReadOptions, bool)) -> Digester {
        let channels: Vec<StateChannel> = prepared.state.iter().chain(&prepared.context).cloned().collect();
        let (scale, context) = (StateChannel::factors(&channels), ContextUse::of(&prepared.context));
        let preparing = PrepareOptions { scale, context, ..preparing.clone() };
        let options = format!("{} {reading:?} {trim} {preparing:?}", env!("CARGO_PKG_VERSION"));
        Digester {
            reading: reading.clone(),
            trim,
            preparing,
            channels,
            velocities: prepared.velocities,
            averaged: prepared.averaged,
            decision: how(prepared),
            made_for: format!("{} {}", made_beside(prepared), sha256(options.as_bytes())),
        }
    }

    /// The identifier that digests for the same fit share.
    pub(super) fn made_for(&self) -> &str {
        &self.made_for
    }

    /// Reads a file or piece, which is held in memory alone, and makes its digest. Calls `progress` with the number of bytes read since the
    /// last call. The result depends bit for bit only on this piece, its share of rows and the recordings at hand.
    ///
    /// # Errors
    /// [`PartError`], which names the file.
    pub fn digest_piece(&self, further: &FurtherPiece, progress: &mut dyn FnMut(u64)) -> Result<Digest, PartError> {
        let (piece, name) = (&further.piece, further.piece.name());
        let channels = StateChannel::names(&self.channels);
        let mut digest = match read_further(piece, &channels, &self.reading, progress) {
            Ok(recordings) => self
                .digest(recordings, further.rows)
                .map_err(|source| PartError::Digest { file: name.clone(), source: Box::new(source) })?,
            Err(ReadError::Empty(fault)) => self.empty(vec![LeftOut { episode: name.clone(), why: fault.what }]),
            Err(error) => return Err(error.into()),
        };
        // A file with several pieces is listed once.
        if piece.is_first() && piece.path.is_file() {
            let summary = FileSummary::of(&piece.path);
            let summary = summary.map_err(|error| PartError::File { file: name, reason: error.to_string() })?;
            digest.data.files = vec![summary];
        }
        Ok(digest)
    }

    /// A digest of at most `most` rows.
    fn digest(&self, mut recordings: Recordings, most: usize) -> Result<Digest, DigestError> {
        if self.trim {
            trim_still(&mut recordings);
        }
        let findings = recordings.findings.clone();
        let names: Vec<String> = recordings.episodes.iter().map(|episode| episode.name.clone()).collect();
        let prepared = match prepare(recordings, &self.preparing) {
            Err(PrepareError::NothingLeft { why, .. }) => {
                let left_out = |episode| LeftOut { episode, why: why.clone() };
                return Ok(Digest { findings, ..self.empty(names.into_iter().map(left_out).collect()) });
            }
            prepared => prepared?,
        };
        let channels: Vec<StateChannel> = prepared.state.iter().chain(&prepared.context).cloned().collect();
        self.require_alike(&channels, how(&prepared))?;
        // Assumes the noise of the recordings at hand: few movements do not determine it well.
        let prepared = Prepared { velocities: self.velocities, averaged: self.averaged, ..prepared };
        let rows = rows(&prepared)?;
        let means = rows.averaged();
        let few = means.at_most(most);
        Ok(Digest {
            made_for: self.made_for.clone(),
            data: DataSummary::of(&prepared, rows.velocities()),
            findings,
            channels,
            rows: rows.len(),
            thinned: means.len() - few.len(),
            indices: few.indices().iter().map(|index| (index.trajectory, index.sample)).collect(),
            states: few.states().as_slice().to_vec(),
            velocities: few.velocities().as_slice().to_vec(),
            variances: few.variances().map(<[f64]>::to_vec),
        })
    }

    /// The digest of recordings without usable data.
    fn empty(&self, left_out: Vec<LeftOut>) -> Digest {
        let data = DataSummary { files: vec![], episodes: 0, samples: 0, longest: 0.0, speed: 0.0, left_out };
        Digest {
            made_for: self.made_for.clone(),
            data,
            findings: vec![],
            channels: self.channels.clone(),
            rows: 0,
            thinned: 0,
            indices: vec![],
            states: vec![],
            velocities: vec![],
            variances: None,
        }
    }

    fn require_alike(&self, channels: &[StateChannel], decision: String) -> Result<(), DigestError> {
        let differ = |what: &str, here: String, before: String| {
            Err(DigestError::Differs { what: what.to_owned(), here, before })
        };
        let names = |channels: &[StateChannel]| StateChannel::names(channels).join(", ");
        if names(channels) != names(&self.channels) {
            return differ("channels", names(channels), names(&self.channels));
        }
        if decision != self.decision {
            return differ("velocities", decision, self.decision.clone());
        }
        // A goal that is the same in all files at hand looks like a constant channel of the state.
        let range = |of: &StateChannel| {
            if of.low == of.high { of.low.to_string() } else { format!("{} … {}", of.low, of.high) }
        };
        let moves = |(own, found): &(&StateChannel, &StateChannel)| own.low == own.high && range(own) != range(found);
        match self.channels.iter().zip(channels).find(moves) {
            Some((own, found)) => differ(&format!("values of '{}'", own.name), range(found), range(own)),
            None => Ok(()),
        }
    }
}

/// The source of the velocities, in words.
fn how(prepared: &Prepared) -> String {
    let decision = prepared.decisions.iter().find(|decision| decision.what == Subject::Velocities);
    decision.map_or_else(String::new, |decision| decision.value.clone())
}
