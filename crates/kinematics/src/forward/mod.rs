//! Where links are and how they move: all of a robot's ([`LinkPoses`]), or one by the joints that lead to it ([`Chain`]), in
//! one configuration or several at once (`group`); the mass matrix and momenta; columns of Jacobians (`jacobian`); the memory
//! for it ([`Workspace`]).

mod chain;
mod chain_batch;
mod group;
mod jacobian;
mod link_poses;
mod link_poses_batch;
mod mass_matrix;
mod momenta;
mod workspace;

pub use chain::Chain;
pub use link_poses::LinkPoses;
pub use link_poses_batch::LinkPosesBatch;
pub use workspace::Workspace;

/// A robot of many joints, to try registers on.
#[cfg(test)]
fn upper_body() -> crate::RobotModel {
    crate::RobotModel::from_urdf(include_str!("../../../../robots/asimo_upper_body.urdf"))
        .expect("the robot of this project loads")
}
