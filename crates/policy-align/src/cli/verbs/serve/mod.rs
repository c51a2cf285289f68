//! A policy as a node of ROS 2, in builds that have the feature `ros2`.

#[cfg(any(test, not(feature = "ros2")))]
mod absent;
#[cfg(feature = "ros2")]
mod messages;
#[cfg(feature = "ros2")]
mod node;
#[cfg(feature = "ros2")]
mod status;
#[cfg(feature = "ros2")]
mod verb;

#[cfg(not(feature = "ros2"))]
pub(crate) use absent::Serve;
#[cfg(feature = "ros2")]
pub(crate) use verb::Serve;
