//! The two learners, their policies and potentials, and the stored forms of the policies.

mod direct_policy;
mod direct_policy_learning;
mod global_potential;
mod lwpr_regressor;
mod of_aligned;
mod origin;
mod policy_record;
mod potential_policy;
mod potential_policy_learning;
mod regression;
mod regressor;

pub use direct_policy::DirectPolicy;
pub use direct_policy_learning::DirectPolicyLearning;
pub use global_potential::GlobalPotential;
pub use lwpr_regressor::LwprRegressor;
pub use origin::Origin;
pub use potential_policy::PotentialPolicy;
pub use potential_policy_learning::PotentialPolicyLearning;
pub use regressor::Regressor;
