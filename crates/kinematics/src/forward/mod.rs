//! Where links are and how they move: all of a robot's ([`LinkPoses`]), or one by the joints that lead to it
//! ([`Chain`]); the mass matrix; columns of Jacobians (`jacobian`); the memory for it ([`Workspace`]).

mod chain;
mod jacobian;
mod link_poses;
mod mass_matrix;
mod workspace;

pub use chain::Chain;
pub use link_poses::LinkPoses;
pub use workspace::Workspace;
