//! Poses and velocities of links: of all links of a robot ([`LinkPoses`]), or of one by the joints that lead to it
//! ([`Chain`]), in one configuration or several at once (`group`); the mass matrix and momenta; columns of Jacobians
//! (`jacobian`); the memory that they use ([`Workspace`]).

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

/// A robot with many joints, for tests of vector registers.
#[cfg(test)]
fn upper_body() -> crate::RobotModel {
    crate::RobotModel::from_urdf(include_str!("../../../../robots/asimo_upper_body.urdf"))
        .expect("the robot of this project loads")
}
