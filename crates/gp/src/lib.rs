//! Gaussian processes that learn policies and say how sure they are.
//!
//! | | |
//! |---|---|
//! | [`SlopeGp`] | a potential seen only through slopes along the observed motion: right under hidden constraints that vary |
//! | [`DirectGp`] | velocities: right where nothing was constrained |
//! | [`ReadingLearner`] | both, and which of them the data support |
//! | [`FrontEnd`] | how recordings become [`Rows`] of states and velocities |
//! | [`TrustReport`] | how far a [`SlopeFit`] can be trusted |
//!
//! A fit reads as: keep rows that move ([`Rows`]); weigh their noise; for every [`Family`] choose amplitudes by evidence
//! and noise by prediction of trajectories left out, in closed form; keep the family that predicts best; see whether
//! there is a potential at all; report. Equations are cited as "(Sn)", the slope GP's, and "(Rn)", those of the direct GP
//! and of the choice between the two.

mod dimension;
mod direct;
mod error;
mod evidence;
mod kernel;
mod left_out;
mod reading;
mod report;
mod rows;
mod slope;
mod stored;

pub use direct::data::DirectData;
pub use direct::direct_gp::{DirectFit, DirectGp};
pub use direct::learner::DirectLearner;
pub use direct::model::DirectModel;
pub use error::GpError;
pub use evidence::Evidence;
pub use kernel::block::Block;
pub use kernel::direct_block::DirectBlock;
pub use kernel::family::{Family, Trend};
pub use kernel::shape::Shape;
pub use left_out::LeftOut;
pub use left_out::curl_test::CurlTest;
pub use reading::Reading;
pub use reading::both_readings::{BothReadings, ReadingLearner};
pub use reading::near_passes::NearPasses;
pub use reading::numbers::{ReadingNumbers, TrajectoryErrors};
pub use report::identifiability::{Identifiability, LeastSeen};
pub use report::trust_report::{FamilyNumbers, FamilyReport, ModelKind, TrustReport};
pub use rows::Rows;
pub use rows::front_end::FrontEnd;
pub use rows::kept::{Grouping, RowsDropped};
pub use slope::data::SlopeData;
pub use slope::fit::SlopeFit;
pub use slope::learner::SlopeLearner;
pub use slope::model::SlopeModel;
pub use slope::policy::{SlopePolicy, SlopePotential};
pub use slope::slope_gp::SlopeGp;
