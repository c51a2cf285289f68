use crate::rows::packed::{Misfit, Reader};

/// Types of messages that hold a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    JointState,
    Pose,
    Twist,
    Numbers,
    Json,
}

/// Contents of a message.
#[derive(Debug, PartialEq)]
pub(super) struct Message<'a> {
    /// Nanoseconds since 1970, from the header.
    pub(super) stamp: Option<i64>,
    /// Empty if the message type determines the names.
    pub(super) names: Vec<&'a str>,
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
}

const POSE: [&str; 7] =
    ["position.x", "position.y", "position.z", "orientation.x", "orientation.y", "orientation.z", "orientation.w"];
const TWIST: [&str; 6] = ["linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"];

impl Type {
    /// Determines the type from the name of the schema, of ROS 1 or 2, and the encoding.
    pub(super) fn of(schema: &str, encoding: &str) -> Option<Self> {
        if encoding == "json" {
            return Some(Type::Json);
        }
        let (package, name) = (schema.split('/').next()?, schema.rsplit('/').next()?);
        match (encoding, package, name) {
            ("cdr", "sensor_msgs", "JointState") => Some(Type::JointState),
            ("cdr", "geometry_msgs", "PoseStamped") => Some(Type::Pose),
            ("cdr", "geometry_msgs", "TwistStamped") => Some(Type::Twist),
            ("cdr", "std_msgs", "Float64MultiArray") => Some(Type::Numbers),
            _ => None,
        }
    }

    pub(super) fn decode(self, bytes: &[u8]) -> Result<Message<'_>, Misfit> {
        let mut reader = Reader::of_message(bytes)?;
        let mut message = Message { stamp: None, names: Vec::new(), positions: Vec::new(), velocities: Vec::new() };
        if self != Type::Numbers {
            let (seconds, nanoseconds) = (reader.i32()?, reader.u32()?);
            message.stamp = Some(i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds));
            reader.closed_text()?;
        }
        match self {
            Type::JointState => {
                message.names = reader.texts()?;
                message.positions = reader.numbers()?;
                message.velocities = reader.numbers()?;
                reader.numbers()?;
            }
            Type::Pose => message.fixed(&mut reader, &POSE)?,
            Type::Twist => message.fixed(&mut reader, &TWIST)?,
            Type::Numbers => {
                for _ in 0..reader.u32()? {
                    reader.closed_text()?;
                    reader.u32()?;
                    reader.u32()?;
                }
                reader.u32()?;
                message.positions = reader.numbers()?;
            }
            Type::Json => return Err(Misfit),
        }
        Ok(message)
    }
}

impl Message<'_> {
    fn fixed(&mut self, reader: &mut Reader<'_>, names: &[&'static str]) -> Result<(), Misfit> {
        self.names = names.to_vec();
        self.positions = names.iter().map(|_| reader.f64()).collect::<Result<_, _>>()?;
        Ok(())
    }
}
