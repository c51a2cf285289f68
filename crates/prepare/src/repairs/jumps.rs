use motion::anomalies::{LongStep, long_steps};
use motion::{Channel, Episode, Subject, Verdict};

use crate::findings::is_switch;
use crate::notes::{Notes, PIECE};
use crate::numbers::short;

/// Minimum length of a useful piece.
const LEAST: usize = 4;
/// If more than this share of the episodes jump, the jumps are no accidents.
const MANY: f64 = 0.2;

/// Cuts episodes where a single step stands out from its surroundings, because samples are missing there, or one is
/// wrong.
pub(crate) fn cut(episodes: &mut Vec<Episode>, channels: &[Channel], notes: &mut Notes) {
    let (count, mut cut, mut first) = (episodes.len(), 0, None);
    let switches: Vec<usize> = (0..channels.len()).filter(|&axis| is_switch(episodes, axis)).collect();
    *episodes = episodes
        .drain(..)
        .flat_map(|episode| {
            let jumps = long_steps(&episode.positions, episode.times.uneven());
            let Some(jump) = jumps.first() else { return vec![episode] };
            cut += 1;
            first.get_or_insert_with(|| described(&episode, jump, channels));
            pieces(&episode, &jumps, notes)
        })
        .collect();
    let Some((first, axis)) = first else { return };
    let some = if cut == 1 { "1 episode" } else { &format!("{cut} episodes") };
    notes.decided(Subject::Jumps, format!("{some} split"), "one step is far longer than its neighbours");
    let verdict = if f64::from(cut) > MANY * count as f64 { Verdict::Doubtful } else { Verdict::Good };
    let verb = if cut == 1 { "jumps and was split there" } else { "jump and were split there" };
    notes.found(
        verdict,
        format!("{cut} of {count} episodes {verb} ({first})"),
        if switches.contains(&axis) {
            format!("--ignore {}, which is a switch (--jumps keep)", channels[axis].name)
        } else {
            "check for missing samples, lost tracking or wrapped angles (--jumps keep)".to_owned()
        },
    );
}

/// Description of a jump, and the channel with the largest one.
fn described(episode: &Episode, jump: &LongStep, channels: &[Channel]) -> (String, usize) {
    let step = episode.step(jump.sample);
    let most = step.icamax();
    let text = format!(
        "{}: '{}' changes by {}, the step is {:.0} times the usual one",
        episode.place(jump.sample + 1),
        channels[most].name,
        short(step[most]),
        jump.times
    );
    (text, most)
}

fn pieces(episode: &Episode, jumps: &[LongStep], notes: &mut Notes) -> Vec<Episode> {
    let mut from = 0;
    let mut pieces = Vec::new();
    for to in jumps.iter().map(|jump| jump.sample + 1).chain([episode.n_samples()]) {
        let mut piece = episode.part(from, to);
        if from > 0 {
            piece.name = format!("{}{PIECE}{from}", episode.name);
        }
        if to - from >= LEAST {
            pieces.push(piece);
        } else {
            let samples = if to - from == 1 { "1 sample" } else { &format!("{} samples", to - from) };
            notes.left_out(&piece.name, format!("only {samples} beside a jump"));
        }
        from = to;
    }
    pieces
}
