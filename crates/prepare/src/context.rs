//! Separates the context from the state.

use motion::{Channel, Demonstrations, Episode, Subject, Verdict, is_called_context};
use nalgebra::DVector;

use crate::notes::Notes;
use crate::numbers::counted;
use crate::options::ContextUse;
use crate::{PrepareError, StateChannel};

/// With fewer different contexts than this, predictions between them are a guess.
const FEW: usize = 8;

/// Removes the context from the state of every episode; returns the remaining channels and those of the context.
pub(crate) fn split(
    episodes: &mut [Episode],
    channels: &[Channel],
    wanted: &ContextUse,
    notes: &mut Notes,
) -> Result<(Vec<usize>, Vec<usize>), PrepareError> {
    let (context, why) = match wanted {
        ContextUse::Ignored => (Vec::new(), ""),
        ContextUse::Named(names) => (named(names, channels, episodes)?, "given"),
        ContextUse::Auto => (found(channels, episodes, notes), "constant in every episode, differs between them"),
    };
    let state: Vec<usize> = (0..channels.len()).filter(|at| !context.contains(at)).collect();
    if context.is_empty() {
        return Ok((state, context));
    }
    let names: Vec<&str> = context.iter().map(|&at| channels[at].name.as_str()).collect();
    if state.is_empty() {
        return Err(PrepareError::Context {
            name: names[0].to_owned(),
            why: "no channel is left that moves; --context with fewer names".to_owned(),
        });
    }
    notes.decided(Subject::Context, names.join(", "), why);
    for episode in episodes {
        episode.context = DVector::from_iterator(context.len(), context.iter().map(|&at| episode.positions[(at, 0)]));
        episode.positions = episode.positions.select_rows(&state);
        episode.velocities = episode.velocities.take().map(|velocities| velocities.select_rows(&state));
    }
    Ok((state, context))
}

fn named(names: &[String], channels: &[Channel], episodes: &[Episode]) -> Result<Vec<usize>, PrepareError> {
    let place = |name: &String| {
        let refused = |why: String| PrepareError::Context { name: name.clone(), why };
        let at = channels.iter().position(|channel| channel.name == *name).ok_or_else(|| {
            let known: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
            refused(format!("the recordings have {}; use one of these names", known.join(", ")))
        })?;
        match episodes.iter().find(|episode| !is_constant(episode, at)) {
            None => Ok(at),
            Some(episode) => Err(refused(format!(
                "it changes within episode '{}', so that it belongs to the state; --context with channels that stay as they are, or none",
                episode.name
            ))),
        }
    };
    names.iter().map(place).collect()
}

/// Channels that are context by name and behaviour. Other constant channels may be an axis that every constraint blocked,
/// so they remain state.
fn found(channels: &[Channel], episodes: &[Episode], notes: &mut Notes) -> Vec<usize> {
    let behaves = |&at: &usize| {
        let differs = episodes.iter().any(|of| of.positions[(at, 0)] != episodes[0].positions[(at, 0)]);
        differs && episodes.iter().all(|episode| is_constant(episode, at))
    };
    let (context, unsure): (Vec<usize>, Vec<usize>) =
        (0..channels.len()).filter(behaves).partition(|&at| is_called_context(&channels[at].name));
    let moves = |at: usize| !context.contains(&at) && episodes.iter().any(|episode| !is_constant(episode, at));
    if !(0..channels.len()).any(moves) {
        return Vec::new();
    }
    if !unsure.is_empty() {
        let names: Vec<&str> = unsure.iter().map(|&at| channels[at].name.as_str()).collect();
        let names = names.join(",");
        notes.found(
            Verdict::Good,
            format!("never changes within an episode, but between them: {names}"),
            format!("if movements depend on it, as on a goal or a load: --context {names}"),
        );
    }
    context
}

fn is_constant(episode: &Episode, channel: usize) -> bool {
    episode.positions.row(channel).iter().all(|&x| x == episode.positions[(channel, 0)])
}

/// Reports the number of contexts, and whether leaving out a movement leaves out its context.
pub(crate) fn remark(demonstrations: &Demonstrations, context: &[StateChannel], notes: &mut Notes) {
    if context.is_empty() {
        return;
    }
    let movements = demonstrations.trajectories();
    let first = |k: &usize| movements[..*k].iter().all(|before| before.context() != movements[*k].context());
    let different = (0..movements.len()).filter(first).count();
    let (shown, episodes) = (counted(different, "different context"), counted(movements.len(), "movement"));
    if different < FEW {
        notes.found(
            Verdict::Doubtful,
            format!("{shown} in {episodes}: the policy at any other is a guess"),
            format!("record movements with at least {FEW} different values of the context"),
        );
    } else if different < movements.len() {
        notes.found(
            Verdict::Good,
            format!(
                "{shown} in {episodes}: errors on left-out movements are those at contexts that other movements had"
            ),
            "hold out all movements of some contexts: --hold-out",
        );
    } else {
        notes.found(
            Verdict::Good,
            format!(
                "{shown} in {episodes}: errors on left-out movements, along their motion, are those at new contexts"
            ),
            "nothing to do",
        );
    }
}
