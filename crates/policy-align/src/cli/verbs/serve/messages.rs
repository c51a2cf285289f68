//! Messages of ROS 2; the fields are in the order of the wire format.

use ros2_client::builtin_interfaces::Time;
use serde::{Deserialize, Serialize};

/// std_msgs/Header.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Header {
    pub(super) stamp: Time,
    pub(super) frame_id: String,
}

/// sensor_msgs/JointState: rad or m, rad/s or m/s. Each array holds one number per name or is empty.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct JointState {
    pub(super) header: Header,
    pub(super) name: Vec<String>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) effort: Vec<f64>,
}

/// std_msgs/Float64MultiArray.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Float64MultiArray {
    layout: Layout,
    data: Vec<f64>,
}

/// std_msgs/MultiArrayLayout.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Layout {
    dim: Vec<Dimension>,
    data_offset: u32,
}

/// std_msgs/MultiArrayDimension.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Dimension {
    label: String,
    size: u32,
    stride: u32,
}

impl JointState {
    /// Velocities of joints, stamped with the current time.
    pub(super) fn of_velocities(joints: &[String], velocities: &[f64]) -> Self {
        JointState {
            header: Header { stamp: Time::now(), frame_id: String::new() },
            name: joints.to_vec(),
            position: vec![],
            velocity: velocities.to_vec(),
            effort: vec![],
        }
    }
}

impl Float64MultiArray {
    /// Numbers without a layout, as controllers expect them.
    pub(super) fn of(data: &[f64]) -> Self {
        Float64MultiArray { layout: Layout::default(), data: data.to_vec() }
    }
}
