//! Topics of a bag, with the information that viewers need to decode messages.

/// A topic: its name, the type of its messages, and the type's definition including all types that
/// it uses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Topic {
    pub(super) name: &'static str,
    pub(super) kind: &'static str,
    pub(super) definition: &'static str,
}

/// The definition of the header with which most messages begin.
macro_rules! header {
    () => {
        "\
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"
    };
}

pub(super) const JOINT_STATES: Topic = Topic {
    name: "/joint_states",
    kind: "sensor_msgs/msg/JointState",
    definition: concat!(
        "\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
",
        header!()
    ),
};

/// The text of a URDF.
pub(super) const ROBOT_DESCRIPTION: Topic =
    Topic { name: "/robot_description", kind: "std_msgs/msg/String", definition: "string data\n" };

pub(super) const TRANSFORMS: Topic = Topic {
    name: "/tf",
    kind: "tf2_msgs/msg/TFMessage",
    definition: concat!(
        "\
geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
",
        header!(),
        "\
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"
    ),
};
