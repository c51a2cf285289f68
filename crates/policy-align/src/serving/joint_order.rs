use super::ControllerError;
use crate::Model;
use crate::channel_joints::unit;

/// A commanded joint and its channel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CommandedJoint {
    pub(super) name: String,
    pub(super) channel: usize,
    /// Radians or metres per unit of the channel.
    pub(super) unit: f64,
}

/// The joints (n) in the order of a command, from (channel, joint) pairs. Without pairs, each channel is the joint of its
/// name.
pub(super) fn commanded(model: &Model, pairs: &[(String, String)]) -> Result<Vec<CommandedJoint>, ControllerError> {
    let channels = model.channels();
    let own: Vec<(String, String)> = channels.iter().map(|channel| (channel.clone(), channel.clone())).collect();
    let pairs = if pairs.is_empty() { &own } else { pairs };
    let mut joints: Vec<CommandedJoint> = Vec::with_capacity(channels.len());
    for (channel, name) in pairs {
        let Some(at) = channels.iter().position(|known| known == channel) else {
            return Err(ControllerError::UnknownChannel { channel: channel.clone(), channels });
        };
        for (twice, text) in [
            (joints.iter().any(|joint| joint.channel == at), channel),
            (joints.iter().any(|joint| joint.name == *name), name),
        ] {
            if twice {
                return Err(ControllerError::Twice { name: text.clone() });
            }
        }
        let unit = unit(model.state[at].unit.as_deref(), None);
        joints.push(CommandedJoint { name: name.clone(), channel: at, unit });
    }
    let is_left = |&at: &usize| joints.iter().all(|joint| joint.channel != at);
    let left: Vec<String> = (0..channels.len()).filter(is_left).map(|at| channels[at].clone()).collect();
    if left.is_empty() { Ok(joints) } else { Err(ControllerError::NoJoint { channels: left }) }
}
