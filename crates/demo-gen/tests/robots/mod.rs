//! The robots of the paper's experiments, from the project's files.
use demo_gen::{ThreeLinkArm, UpperBody};

pub(crate) const UPPER_BODY: &str = include_str!("../../../../robots/asimo_upper_body.urdf");
pub(crate) const UPPER_BODY_SRDF: &str = include_str!("../../../../robots/asimo_upper_body.srdf");
pub(crate) const THREE_LINK: &str = include_str!("../../../../robots/planar_three_link.urdf");

pub(crate) fn upper_body() -> UpperBody {
    UpperBody::new(UPPER_BODY, UPPER_BODY_SRDF).expect("the project's own robot")
}

pub(crate) fn arm() -> ThreeLinkArm {
    ThreeLinkArm::new(THREE_LINK).expect("the project's own robot")
}
