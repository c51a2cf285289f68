use super::{Element, UrdfProblem};
use crate::KinematicsError;

/// The URDF version, on which the meaning of two tags depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Version {
    V1_0,
    V1_1,
    V1_2,
}

impl Version {
    /// The version given by `<robot>`, 1.0 by default.
    pub(super) fn of(given: Option<&str>) -> Result<Self, KinematicsError> {
        match given.map(str::trim) {
            None | Some("1" | "1.0") => Ok(Version::V1_0),
            Some("1.1") => Ok(Version::V1_1),
            Some("1.2") => Ok(Version::V1_2),
            Some(found) => Err(KinematicsError::urdf(Element::Robot, UrdfProblem::Version { found: found.to_owned() })),
        }
    }

    pub(super) fn has_quaternions(self) -> bool {
        self >= Version::V1_1
    }

    pub(super) fn has_optional_bounds(self) -> bool {
        self < Version::V1_2
    }
}
