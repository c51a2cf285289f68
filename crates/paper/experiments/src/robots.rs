//! The robots of the experiments, from the files of this project.

use anyhow::Context as _;
use demo_gen::UpperBody;
use demo_gen::tasks::{Contact, Wiping};

/// The upper body of Sections 4.2 and 4.3.
///
/// # Errors
/// If its files are damaged.
pub fn upper_body() -> anyhow::Result<UpperBody> {
    let urdf = include_str!("../../../../robots/asimo_upper_body.urdf");
    let srdf = include_str!("../../../../robots/asimo_upper_body.srdf");
    UpperBody::new(urdf, srdf).context("robots/asimo_upper_body cannot be used")
}

/// The arm with seven joints for wiping.
pub(crate) fn seven_joint_arm(contact: Contact) -> anyhow::Result<Wiping> {
    let urdf = include_str!("../../../../robots/seven_joint_arm.urdf");
    Wiping::new(urdf, contact).context("robots/seven_joint_arm.urdf cannot be used")
}
