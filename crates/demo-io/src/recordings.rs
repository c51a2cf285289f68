use nalgebra::DMatrix;

use crate::Note;
use crate::draft::Drafts;
use crate::error::in_one_line;
use crate::statistics::median;

/// What was read: n channels of state, and episodes of any length.
///
/// A reader checks it once: every episode has n rows, at least two samples, ascending times, and finite numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Recordings {
    /// Dimensions of the state, n of them.
    pub state: Vec<Channel>,
    /// One entry a movement, in the order of the file.
    pub episodes: Vec<Episode>,
    /// What was noticed; nothing of it prevented reading.
    pub notes: Vec<Note>,
}

/// A dimension of the state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// As in the file.
    pub name: String,
    /// If the file or the user says.
    pub unit: Option<String>,
}

/// One recorded movement of N samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Episode {
    /// As in the file: "3", "take 3", "demo_3".
    pub name: String,
    /// Where it stands, for messages.
    pub source: Source,
    /// Seconds from the episode's start, (N), strictly ascending.
    pub times: Vec<f64>,
    /// One column a sample, (n, N).
    pub positions: DMatrix<f64>,
    /// Units of the state per second, (n, N).
    pub velocities: Option<DMatrix<f64>>,
    /// Label of the constraint or task it was recorded under.
    pub constraint: Option<String>,
}

/// Where an episode stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Name of the file, without folders.
    pub file: String,
    /// First and last line, row or message, counted from 1 as the format does; none where that says nothing.
    pub rows: Option<(u64, u64)>,
}

impl Recordings {
    /// The usual time between samples in seconds: the median over all episodes, put on the nearest whole rate (in Hz) or
    /// whole number of milliseconds if that is within 0.1 %. A step that was given rather than measured (all stamps are
    /// multiples of it) is taken as it is.
    pub fn time_step(&self) -> f64 {
        time_step(self.episodes.iter().map(|episode| &episode.times[..]))
    }

    pub(crate) fn from_drafts(drafts: Drafts) -> Self {
        let n = drafts.channels.len();
        let matrix = |numbers: Vec<f64>| DMatrix::from_vec(n, numbers.len().checked_div(n).unwrap_or(0), numbers);
        let episodes = drafts.episodes.into_iter().map(|draft| Episode {
            source: Source { file: draft.file, rows: draft.rows.ends() },
            name: draft.name,
            times: draft.times,
            velocities: (!draft.velocities.is_empty()).then(|| matrix(draft.velocities)),
            positions: matrix(draft.positions),
            constraint: draft.constraint,
        });
        let notes = drafts.notes.into_iter().map(|note| Note { text: in_one_line(note.text), ..note });
        Self { state: drafts.channels, episodes: episodes.collect(), notes: notes.collect() }
    }
}

/// See [`Recordings::time_step`]; 0 without a step.
pub(crate) fn time_step<'a>(times: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let mut given = times.clone().filter(|times| times.len() > 1).map(|times| {
        let step = times[1] - times[0];
        times.iter().enumerate().all(|(sample, &time)| time - times[0] == sample as f64 * step).then_some(step)
    });
    if let Some(Some(first)) = given.next()
        && given.all(|step| step == Some(first))
    {
        return first;
    }
    let total: usize = times.clone().map(|times| times.len().saturating_sub(1)).sum();
    let stride = total.div_ceil(MOST_STEPS).max(1);
    let mut steps: Vec<f64> =
        times.flat_map(|times| times.windows(2).map(|pair| pair[1] - pair[0])).step_by(stride).collect();
    on_grid(median(&mut steps).unwrap_or(0.0))
}

/// The median is taken over at most so many steps.
const MOST_STEPS: usize = 1_000_000;

fn on_grid(step: f64) -> f64 {
    let rate = 1.0 / (1.0 / step).round();
    let milliseconds = (step * 1e3).round() * 1e-3;
    let near = |candidate: f64| (candidate - step).abs() <= 1e-3 * step;
    [rate, milliseconds].into_iter().find(|&candidate| near(candidate)).unwrap_or(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step_of(times: &[f64]) -> f64 {
        time_step(std::iter::once(times))
    }

    #[test]
    fn measured_steps_are_put_on_a_grid_and_given_ones_are_not() {
        let given = f64::from(0.05f32);
        let multiples: Vec<f64> = (0..20).map(|sample| f64::from(sample) * given).collect();
        assert_eq!(step_of(&multiples), given);
        let single_precision: Vec<f64> = (0..20u8).map(|sample| f64::from(f32::from(sample) / 50.0)).collect();
        assert_eq!(step_of(&single_precision), 0.02);
        assert_eq!(step_of(&[0.0, 0.017, 0.034, 0.05]), 0.017);
        assert_eq!(step_of(&[0.0, 0.0166, 0.03333, 0.05]), 1.0 / 60.0);
        assert_eq!(step_of(&[0.0, 0.3, 0.59, 0.89]), 0.3);
        assert_eq!(step_of(&[0.0]), 0.0);
    }
}
