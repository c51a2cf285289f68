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

mod block;
mod both_readings;
mod chunks;
mod covariance;
mod curl_test;
mod direct_block;
mod direct_data;
mod direct_gp;
mod direct_model;
mod error;
mod evidence;
mod expansion;
mod factor;
mod family;
mod family_fit;
mod front_end;
mod kept;
mod lbfgs;
mod learnt;
mod left_out;
mod near_passes;
mod noise_factor;
mod noise_weights;
mod reading;
mod reading_numbers;
mod rows;
mod scaling;
mod shape;
mod slope_covariance;
mod slope_data;
mod slope_fit;
mod slope_gp;
mod slope_model;
mod slope_policy;
mod slope_report;
mod stored;
mod trust_report;

pub use block::Block;
pub use both_readings::{BothReadings, ReadingLearner};
pub use curl_test::CurlTest;
pub use direct_block::DirectBlock;
pub use direct_data::DirectData;
pub use direct_gp::{DirectFit, DirectGp};
pub use direct_model::DirectModel;
pub use error::GpError;
pub use evidence::Evidence;
pub use family::{Family, Trend};
pub use front_end::FrontEnd;
pub use kept::{Grouping, RowsDropped};
pub use learnt::{DirectLearner, SlopeLearner};
pub use left_out::LeftOut;
pub use near_passes::NearPasses;
pub use reading::Reading;
pub use reading_numbers::{ReadingNumbers, TrajectoryErrors};
pub use rows::Rows;
pub use shape::Shape;
pub use slope_data::SlopeData;
pub use slope_fit::SlopeFit;
pub use slope_gp::SlopeGp;
pub use slope_model::SlopeModel;
pub use slope_policy::{SlopePolicy, SlopePotential};
pub use trust_report::{FamilyNumbers, FamilyReport, Identifiability, LeastSeen, ModelKind, TrustReport};
