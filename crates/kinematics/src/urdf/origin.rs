use nalgebra::{IsometryMatrix3, Quaternion, Rotation3, Translation3, UnitQuaternion};

use super::{Element, UrdfProblem, UrdfWarning, tag::Tag, version::Version};
use crate::KinematicsError;

/// Reads `<origin>`: metres, and either roll, pitch, yaw about the fixed axes x, y, z or, from version 1.1 on, a
/// quaternion, which takes precedence. Missing values are zero.
pub(super) fn read(
    parent: Tag<'_>,
    version: Version,
    warnings: &mut Vec<UrdfWarning>,
) -> Result<IsometryMatrix3<f64>, KinematicsError> {
    let Some(origin) = parent.child("origin") else { return Ok(IsometryMatrix3::identity()) };
    let translation = origin.bounded::<3>("origin.xyz")?.map_or_else(Translation3::identity, Translation3::from);
    let [roll, pitch, yaw] = origin.bounded::<3>("origin.rpy")?.unwrap_or_default();
    let mut rotation = fixed_axes(roll, pitch, yaw);
    if version.has_quaternions() {
        if let Some(xyzw) = origin.numbers::<4>("origin.quat_xyzw")? {
            rotation = from_quaternion(xyzw).ok_or_else(|| origin.error(UrdfProblem::ZeroQuaternion))?;
        }
    } else if origin.node.has_attribute("quat_xyzw") {
        warnings.push(UrdfWarning::QuaternionIgnored { element: Element::clone(origin.owner) });
    }
    Ok(IsometryMatrix3::from_parts(translation, rotation))
}

/// Rz(yaw) Ry(pitch) Rx(roll); exactly the identity for zero angles.
pub(super) fn fixed_axes(roll: f64, pitch: f64, yaw: f64) -> Rotation3<f64> {
    if roll == 0.0 && pitch == 0.0 && yaw == 0.0 {
        Rotation3::identity()
    } else {
        Rotation3::from_euler_angles(roll, pitch, yaw)
    }
}

fn from_quaternion([x, y, z, w]: [f64; 4]) -> Option<Rotation3<f64>> {
    let largest = [x, y, z, w].into_iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
    let scaled = Quaternion::new(w / largest, x / largest, y / largest, z / largest);
    (largest > 0.0).then(|| UnitQuaternion::from_quaternion(scaled).to_rotation_matrix())
}
