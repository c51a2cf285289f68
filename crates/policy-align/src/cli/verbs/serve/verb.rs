use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use policy_align::{ControllerError, Model, VelocityController, Verdict};
use text::quoted;

use super::node::{CommandMessage, RobotNode};
use super::status::Status;
use crate::cli::context::in_context;
use crate::cli::describe::context_flag;
use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::interrupt::{await_interrupt, interrupted};
use crate::cli::session::{Output, Session, complain};
use crate::cli::trust_files::load;

/// Command a robot of ROS 2 by a policy
#[derive(Debug, Args)]
#[command(after_help = "\
Subscribes to joint states, finds the channels of the model among the joints by
name, and publishes velocities, in rad/s or m/s. It sends zero, and prints why,

  outside the data, like `predict`;
  while a joint is missing, not finite, or older than --stale;
  at its end, also after Ctrl-C. After a power cut or `kill -9` nothing sends
  zero: let the controller itself stop when no commands come.

The domain is that of ROS_DOMAIN_ID; with ROS_LOCALHOST_ONLY=1 only nodes of
this machine are seen. No ROS 2 needs to be installed.

Example:
  policy-align serve toy.json --ros2 --seconds 1")]
pub(crate) struct Serve {
    /// A model that `fit` has written
    model: PathBuf,
    /// Run as a node of ROS 2
    #[arg(long, required = true)]
    ros2: bool,
    /// Topic of joint states, sensor_msgs/JointState
    #[arg(long, value_name = "TOPIC", default_value = "/joint_states")]
    topic: String,
    /// Message of commands
    #[arg(long = "as", value_name = "MESSAGE", value_enum, default_value_t = CommandMessage::Array)]
    message: CommandMessage,
    /// Topic of commands [default: /velocity_controller/commands]
    #[arg(long, value_name = "TOPIC")]
    command_topic: Option<String>,
    /// Joints in the order of the command, as CHANNEL or CHANNEL=JOINT
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    joints: Vec<String>,
    /// Context of a model that has one, e.g. goal_x=0.4,goal_y=0.1
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', allow_hyphen_values = true)]
    context: Vec<String>,
    /// Commands per second
    #[arg(long, value_name = "HZ", default_value_t = 50.0)]
    rate: f64,
    /// Age of a joint state, in seconds, beyond which the robot is stopped
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2)]
    stale: f64,
    /// Slow all joints by one factor so that none is faster, in rad/s or m/s
    #[arg(long, value_name = "SPEED")]
    max_speed: Option<f64>,
    /// End after this time; otherwise at Ctrl-C
    #[arg(long, value_name = "SECONDS")]
    seconds: Option<f64>,
    /// Also if the verdict on the model is "do not use"
    #[arg(long)]
    force: bool,
}

impl Serve {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = in_context(load(session, &self.model)?, &self.context)?;
        self.refuse_untrusted(&model)?;
        let end = self.seconds.map(|seconds| duration("--seconds", seconds)).transpose()?;
        let mut controller = self.controller(&model)?;
        let period = self.period()?;
        let command_topic = self.command_topic.as_deref().unwrap_or(self.message.usual_topic());
        await_interrupt();
        let mut node = RobotNode::new(controller.joints(), &self.topic, command_topic, self.message)?;
        if !session.quiet && !session.json {
            let joints = controller.joints().join(", ");
            complain(&format!("{} → {command_topic}: {joints}", self.topic));
        }
        let (start, mut status) = (Instant::now(), Status::new(session));
        let mut next = start;
        while !interrupted() && end.is_none_or(|end| start.elapsed() < end) {
            let now = Instant::now();
            // Waits in short pieces, so that an interrupt is noticed at any rate. Queued states are read even if a command took longer
            // than a period.
            let piece = next.clamp(now, now + Duration::from_millis(50));
            node.receive_until(piece, &mut |state, came| {
                controller.observe(&state.name, &state.position, came - start);
            })?;
            if piece < next {
                continue;
            }
            let command = controller.command(start.elapsed());
            let sent = node.send(command.velocities.as_slice())?;
            status.tell(&command, sent, &|| node.listeners())?;
            // Missed ticks are skipped.
            next = (next + period).max(Instant::now());
        }
        Ok(status.finish())
    }

    fn controller<'a>(&self, model: &'a Model) -> Result<VelocityController<'a>, Failure> {
        let pair = |text: &String| {
            let (channel, joint) = text.split_once('=').unwrap_or((text, text));
            (channel.trim().to_owned(), joint.trim().to_owned())
        };
        let pairs: Vec<(String, String)> = self.joints.iter().map(pair).collect();
        let controller = VelocityController::new(model, &pairs, self.stale);
        let limited = controller.and_then(|controller| match self.max_speed {
            Some(max_speed) => controller.with_max_speed(max_speed),
            None => Ok(controller),
        });
        limited.map_err(|error| match &error {
            ControllerError::Context { names } => {
                let what = format!("the policy depends on {}", names.join(", "));
                Failure::usage(what, displayed(&self.model), context_flag(model).trim().to_owned())
            }
            ControllerError::NotPositive { name, .. } => {
                Failure::of_text(Exit::Usage, &error.to_string(), format!("--{name}"), "a positive number")
            }
            _ => Failure::of_text(
                Exit::Usage,
                &error.to_string(),
                format!("--joints {}", self.joints.join(",")),
                "a joint for each channel",
            ),
        })
    }

    fn refuse_untrusted(&self, model: &Model) -> Result<(), Failure> {
        if model.trust.verdict != Verdict::DoNotUse || self.force {
            return Ok(());
        }
        let remedy =
            format!("policy-align info {}, which says why; --force commands the robot anyway", quoted(&self.model));
        Err(Failure::new(Exit::Refused, "the verdict on the model is \"do not use\"", displayed(&self.model), remedy))
    }

    fn period(&self) -> Result<Duration, Failure> {
        // A robot cannot be stopped between two commands.
        let fits = self.rate <= 10_000.0 && self.rate * self.stale >= 1.0;
        let period = fits.then(|| Duration::try_from_secs_f64(self.rate.recip()).ok()).flatten();
        period.ok_or_else(|| {
            Failure::usage(
                "at most 10,000 Hz are possible, and at least one command within the seconds of --stale",
                format!("--rate {} --stale {}", self.rate, self.stale),
                "--rate 50",
            )
        })
    }
}

fn duration(flag: &str, seconds: f64) -> Result<Duration, Failure> {
    let positive = Duration::try_from_secs_f64(seconds).ok().filter(|duration| !duration.is_zero());
    positive.ok_or_else(|| {
        Failure::usage("a positive number of seconds is needed", format!("{flag} {seconds}"), format!("{flag} 10"))
    })
}
