//! The stored form of policies.

use lwpr::StandardisedModel;
use serde::{Deserialize, Serialize};

use crate::{AlignError, Origin};

/// The version that is written; a program reads this and all previous ones.
const VERSION: u32 = 1;

/// A learnt policy. The format comes first, so that text in another format is refused for that reason.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PolicyRecord {
    format: Format,
    version: Version,
    dim: usize,
    origin: Origin,
    regression: StandardisedModel,
}

/// The kind of policy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Format {
    #[serde(rename = "potential policy")]
    Potential,
    #[serde(rename = "direct policy")]
    Direct,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
struct Version;

impl TryFrom<u32> for Version {
    type Error = AlignError;

    fn try_from(version: u32) -> Result<Self, AlignError> {
        if version == VERSION { Ok(Version) } else { Err(AlignError::PolicyVersion { found: version, known: VERSION }) }
    }
}

impl From<Version> for u32 {
    fn from(_: Version) -> u32 {
        VERSION
    }
}

impl PolicyRecord {
    pub(super) fn new(format: Format, origin: &Origin, regression: &StandardisedModel) -> Self {
        let (origin, regression) = (origin.clone(), regression.clone());
        PolicyRecord { format, version: Version, dim: regression.n_in(), origin, regression }
    }

    /// Checks the format and returns origin and regression of a policy, with `n_out(n)` outputs for n inputs.
    pub(super) fn check(
        self,
        format: Format,
        n_out: impl Fn(usize) -> usize,
    ) -> Result<(Origin, StandardisedModel), AlignError> {
        let PolicyRecord { format: found, dim, origin, regression, .. } = self;
        let checks = [
            (found == format, "it is a policy of the other kind: potential or direct"),
            (regression.n_in() == dim, "its regression has another dimension"),
            (regression.n_out() == n_out(dim), "its regression has another number of outputs"),
        ];
        let reason = checks.into_iter().find(|(fine, _)| !fine).map(|(_, reason)| reason);
        match reason.map_or_else(|| origin.check(dim), Err) {
            Ok(()) => Ok((origin, regression)),
            Err(reason) => Err(AlignError::CorruptPolicy { reason }),
        }
    }
}
