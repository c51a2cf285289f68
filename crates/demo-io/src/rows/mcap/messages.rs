use crate::rows::cdr::{Cdr, Short};

/// Types of messages that hold a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    JointState,
    Pose,
    Twist,
    Numbers,
    Json,
}

/// What a message says.
#[derive(Debug, PartialEq)]
pub(super) struct Message<'a> {
    /// Nanoseconds since 1970, from the header.
    pub(super) stamp: Option<i64>,
    /// Empty where the type gives the names.
    pub(super) names: Vec<&'a str>,
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
}

const POSE: [&str; 7] =
    ["position.x", "position.y", "position.z", "orientation.x", "orientation.y", "orientation.z", "orientation.w"];
const TWIST: [&str; 6] = ["linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"];

impl Type {
    /// From the name of the schema, of ROS 1 or 2, and the encoding.
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

    pub(super) fn decode(self, bytes: &[u8]) -> Result<Message<'_>, Short> {
        let mut cdr = Cdr::new(bytes)?;
        let mut message = Message { stamp: None, names: Vec::new(), positions: Vec::new(), velocities: Vec::new() };
        if self != Type::Numbers {
            let (seconds, nanoseconds) = (cdr.i32()?, cdr.u32()?);
            message.stamp = Some(i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds));
            cdr.text()?;
        }
        match self {
            Type::JointState => {
                message.names = cdr.texts()?;
                message.positions = cdr.numbers()?;
                message.velocities = cdr.numbers()?;
                cdr.numbers()?;
            }
            Type::Pose => message.fixed(&mut cdr, &POSE)?,
            Type::Twist => message.fixed(&mut cdr, &TWIST)?,
            Type::Numbers => {
                for _ in 0..cdr.u32()? {
                    cdr.text()?;
                    cdr.u32()?;
                    cdr.u32()?;
                }
                cdr.u32()?;
                message.positions = cdr.numbers()?;
            }
            Type::Json => return Err(Short),
        }
        Ok(message)
    }
}

impl Message<'_> {
    fn fixed(&mut self, cdr: &mut Cdr<'_>, names: &[&'static str]) -> Result<(), Short> {
        self.names = names.to_vec();
        self.positions = names.iter().map(|_| cdr.f64()).collect::<Result<_, _>>()?;
        Ok(())
    }
}
