//! The ROS 2 node: it receives joint states, sends commands, and sends zero when it ends.

use std::io;
use std::thread::sleep;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use ros2_client::dds::rustdds::mio1::{Events, Interest, Poll, Token};
use ros2_client::dds::rustdds::{DomainParticipantBuilder, TopicDescription as _};
use ros2_client::qos::{History, WhenFull};
use ros2_client::{
    Context, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher, QosProfile, Subscription, WriteError,
};
use serde::Serialize;

use super::messages::{Float64MultiArray, JointState};
use crate::cli::failure::{Exit, Failure};

/// Largest number of messages queued for this node.
const DEPTH: usize = 16;
/// Number of zero commands at the end, and the time between them, which is needed to send them.
const LAST: usize = 3;
const BETWEEN: Duration = Duration::from_millis(40);
/// Largest domain that the addresses of DDS allow.
const LARGEST_DOMAIN: u16 = 232;

/// How velocities are sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CommandMessage {
    /// std_msgs/Float64MultiArray, as ros2_control takes it
    Array,
    /// sensor_msgs/JointState of velocities, on /joint_command
    JointState,
}

impl CommandMessage {
    /// The default topic for these messages.
    pub(super) fn usual_topic(self) -> &'static str {
        match self {
            CommandMessage::Array => "/velocity_controller/commands",
            CommandMessage::JointState => "/joint_command",
        }
    }
}

/// The publisher of commands.
enum Commands {
    Array(Publisher<Float64MultiArray>),
    JointState(Publisher<JointState>),
}

/// A node that is connected to the topics of one robot. When dropped, it commands zero, because controllers hold the last
/// command.
pub(super) struct RobotNode {
    commands: Commands,
    states: Subscription<JointState>,
    poll: Poll,
    joints: Vec<String>,
    /// Topic of the commands, by its name in DDS.
    command_topic: String,
    context: Context,
    _node: Node,
}

impl RobotNode {
    /// Joins the domain ROS_DOMAIN_ID; stays within this machine if ROS_LOCALHOST_ONLY or ROS_AUTOMATIC_DISCOVERY_RANGE
    /// requires it.
    pub(super) fn new(
        joints: Vec<String>,
        states: &str,
        commands: &str,
        message: CommandMessage,
    ) -> Result<Self, Failure> {
        let domain = domain()?;
        let at = || format!("ROS 2, domain {domain}");
        let failed = |error: &dyn std::fmt::Display| {
            Failure::new(Exit::File, format!("the node cannot start: {error}"), at(), "a network; `ip addr` lists it")
        };
        let mut builder = DomainParticipantBuilder::new(domain);
        if is_local() {
            builder = builder.with_only_networks([[127, 0, 0, 1]]);
        }
        let participant = builder.build().map_err(|error| failed(&error))?;
        let context = Context::from_domain_participant(participant).map_err(|error| failed(&error))?;
        let name = NodeName::new("/", "policy_align").map_err(|error| failed(&error))?;
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let mut node = context.new_node(name, options).map_err(|error| failed(&format!("{error:?}")))?;

        // A best-effort subscription accepts publishers of both kinds, and never delivers an old state after a new one.
        let newest = QosProfile::subscription_default().history(History::KeepLast { depth: DEPTH });
        let joint_state = || MessageTypeName::new("sensor_msgs", "JointState");
        let topic = node.create_topic(&topic_name(states, "--topic")?, joint_state(), &newest);
        let topic = topic.map_err(|error| failed(&error))?;
        let mut states = node.create_subscription(&topic, None).map_err(|error| failed(&error))?;
        let poll = Poll::new().map_err(|error| failed(&error))?;
        let registered = poll.registry().register(&mut states, Token(0), Interest::READABLE);
        registered.map_err(|error| failed(&error))?;

        // Controllers require reliable publishers. A full window must not block the loop: the next command is newer.
        let newest = QosProfile::publisher_default().reliability_reliable(WhenFull::Fail);
        let kind = match message {
            CommandMessage::Array => MessageTypeName::new("std_msgs", "Float64MultiArray"),
            CommandMessage::JointState => joint_state(),
        };
        let topic = node.create_topic(&topic_name(commands, "--command-topic")?, kind, &newest);
        let topic = topic.map_err(|error| failed(&error))?;
        let publisher = match message {
            CommandMessage::Array => node.create_publisher(&topic, None).map(Commands::Array),
            CommandMessage::JointState => node.create_publisher(&topic, None).map(Commands::JointState),
        };
        let commands = publisher.map_err(|error| failed(&error))?;
        let command_topic = topic.name();
        Ok(RobotNode { commands, states, poll, joints, command_topic, context, _node: node })
    }

    /// Passes joint states to `take` as they arrive, until `end`.
    pub(super) fn receive_until(
        &mut self,
        end: Instant,
        take: &mut dyn FnMut(&JointState, Instant),
    ) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| {
            let remedy = "start again; the robot was commanded to stand";
            Failure::new(Exit::File, format!("joint states cannot be received: {error}"), "ROS 2", remedy)
        };
        let mut events = Events::with_capacity(8);
        loop {
            while let Some((state, _)) = self.states.take().map_err(|error| failed(&error))? {
                take(&state, Instant::now());
            }
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(());
            }
            match self.poll.poll(&mut events, Some(left)) {
                Err(error) if error.kind() != io::ErrorKind::Interrupted => return Err(failed(&error)),
                _ => {}
            }
        }
    }

    /// Sends velocities of the joints, in their order. Returns false if they are lost because a subscriber has not
    /// confirmed earlier ones.
    pub(super) fn send(&self, velocities: &[f64]) -> Result<bool, Failure> {
        match &self.commands {
            Commands::Array(publisher) => sent(publisher.publish(Float64MultiArray::of(velocities))),
            Commands::JointState(publisher) => {
                sent(publisher.publish(JointState::of_velocities(&self.joints, velocities)))
            }
        }
    }

    /// Number of subscribers to the commands in the whole domain.
    pub(super) fn listeners(&self) -> usize {
        let readers = self.context.domain_participant().discovered_readers();
        readers.iter().filter(|reader| *reader.subscription_topic_data.topic_name() == self.command_topic).count()
    }
}

impl Drop for RobotNode {
    fn drop(&mut self) {
        for _ in 0..LAST {
            // An error here cannot be reported; the next command is sent anyway.
            let _ = self.send(&vec![0.0; self.joints.len()]);
            sleep(BETWEEN);
        }
    }
}

fn sent<M: Serialize>(result: Result<(), WriteError<M>>) -> Result<bool, Failure> {
    match result {
        Ok(()) => Ok(true),
        Err(WriteError::WouldBlock { .. }) => Ok(false),
        Err(error) => {
            let remedy = "start again; the robot may follow the last command";
            Err(Failure::new(Exit::File, format!("a command cannot be sent: {error}"), "ROS 2", remedy))
        }
    }
}

/// A topic's full name.
fn topic_name(text: &str, flag: &str) -> Result<Name, Failure> {
    let refused = |why: String| Failure::usage(why, format!("{flag} {text}"), format!("{flag} /arm/joint_states"));
    let is_part = |part: &str| {
        let letters = part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        letters && part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
    };
    if !text.strip_prefix('/').is_some_and(|rest| rest.split('/').all(is_part)) {
        let what = format!("'{text}' is not a full name of a topic: / and letters, digits and _ after each");
        return Err(refused(what));
    }
    Name::parse(text).map_err(|error| refused(error.to_string()))
}

/// ROS_DOMAIN_ID, or 0.
fn domain() -> Result<u16, Failure> {
    let Some(text) = std::env::var_os("ROS_DOMAIN_ID").filter(|text| !text.is_empty()) else { return Ok(0) };
    let text = text.to_string_lossy();
    text.trim().parse().ok().filter(|&domain| domain <= LARGEST_DOMAIN).ok_or_else(|| {
        let what = format!("'{text}' is not a domain of ROS 2: 0 to {LARGEST_DOMAIN}");
        Failure::usage(what, "the environment's ROS_DOMAIN_ID", "the number that the robot has")
    })
}

/// Whether discovery is limited to this machine.
fn is_local() -> bool {
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|text| text.eq_ignore_ascii_case(value));
    is("ROS_LOCALHOST_ONLY", "1") || is("ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost")
}
