//! From a laboratory's recordings to a policy that one can trust, or to the reason why not.

mod decision;
mod learnt;
mod model;
mod trust;

pub use decision::Decision;
pub use learnt::Learnt;
pub use model::{DataSummary, FileSummary, LeftOutEpisode, MadeBy, Model, StateChannel};
pub use trust::{Finding, Trust, Verdict};
