//! Channels that are no state: velocities of others, and time.

use motion::{Channel, Demonstrations, Finding, Trajectory, Verdict};
use nalgebra::DMatrix;

/// Share of a channel's steps that its velocity explains, at least.
const EXPLAINED: f64 = 0.97;
/// Velocities are in one unit: factors of their steps differ by this share at most.
const ALIKE: f64 = 0.1;
/// Stretches that are compared, at most, and samples in one.
const STRETCHES: usize = 2000;
const SAMPLES: usize = 10;
/// More channels are not compared.
const MOST: usize = 256;
/// Steps of a clock differ by this share of a step at most.
const EVEN: f64 = 1e-3;

/// Says which channels are velocities of others, or time, and the flags that read them as such.
///
/// A block of velocities follows a block of positions, at least two of them with one unit. A clock has no name of its own, begins at one
/// value in each of several movements and rises as time does. O(n² stretches + n samples) for n channels.
pub(crate) fn no_state(demonstrations: &Demonstrations, channels: &[Channel]) -> Option<Finding> {
    let n = channels.len();
    if n > MOST {
        return None;
    }
    let names: Vec<&str> = channels.iter().map(|channel| &channel.name[..]).collect();
    let clock = (0..n).find(|&axis| n > 1 && is_counted(names[axis]) && is_clock(demonstrations, axis));
    let recorded = demonstrations.trajectories().iter().any(|movement| movement.velocities().is_some());
    let pairs = if recorded { Vec::new() } else { velocities(demonstrations, clock) };
    let of = |pick: &dyn Fn(&(usize, usize)) -> usize| pairs.iter().map(|pair| names[pick(pair)]).collect::<Vec<_>>();
    let (states, rates) = (listed(&of(&|pair| pair.0)), listed(&of(&|pair| pair.1)));
    let (mut what, mut next) = (Vec::new(), Vec::new());
    if let Some(clock) = clock {
        what.push(format!("{} rises as time does", names[clock]));
        next.push(format!("--time {}", names[clock]));
    }
    if !pairs.is_empty() {
        what.push(format!("{rates} are the velocities of {states}"));
        next.push(format!("--state {states} --velocity {rates}"));
    }
    (!what.is_empty()).then(|| Finding {
        verdict: Verdict::DoNotUse,
        what: format!("{}: not a part of the state", what.join(", ")),
        next: next.join(" "),
    })
}

/// Whether a name is only a number behind a stem, as readers make them.
fn is_counted(name: &str) -> bool {
    name.trim_end_matches(|letter: char| letter.is_ascii_digit()).len() < name.len()
}

fn is_clock(demonstrations: &Demonstrations, axis: usize) -> bool {
    let movements = demonstrations.trajectories();
    let value = |movement: &Trajectory, sample: usize| movement.state(sample)[axis];
    let first = &movements[0];
    let last = first.n_samples() - 1;
    let rate = (value(first, last) - value(first, 0)) / first.seconds(0, last);
    let runs = |movement: &Trajectory| {
        (value(movement, 0) - value(first, 0)).abs() <= EVEN * rate * movement.seconds(0, 1)
            && (1..movement.n_samples()).all(|sample| {
                let due = rate * movement.seconds(sample - 1, sample);
                (value(movement, sample) - value(movement, sample - 1) - due).abs() <= EVEN * due
            })
    };
    movements.len() > 1 && rate > 0.0 && movements.iter().all(runs)
}

/// Pairs of a channel and its velocity, in the order of the channels; none but for a block of each.
fn velocities(demonstrations: &Demonstrations, clock: Option<usize>) -> Vec<(usize, usize)> {
    let (steps, integrals) = stretches(demonstrations);
    let n = steps.nrows();
    let product = &steps * integrals.transpose();
    let [of_steps, of_integrals] =
        [&steps, &integrals].map(|of| of.row_iter().map(|row| row.norm_squared()).collect::<Vec<f64>>());
    // Factor by which steps are the integral of the other, where it explains them.
    let factor = |i: usize, j: usize| {
        let explained = product[(i, j)].powi(2) / (of_steps[i] * of_integrals[j]);
        (product[(i, j)] > 0.0 && explained >= EXPLAINED).then(|| (product[(i, j)] / of_integrals[j], explained))
    };
    let candidates: Vec<(usize, usize, f64, f64)> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
        .filter(|&(i, j)| clock != Some(i) && clock != Some(j))
        .filter_map(|(i, j)| factor(i, j).map(|(times, explained)| (i, j, times, explained)))
        .collect();
    let block = |&(_, _, unit, _): &(usize, usize, f64, f64)| {
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        for i in 0..n {
            let own = candidates.iter().filter(|of| of.0 == i && (of.2 / unit - 1.0).abs() <= ALIKE);
            let after = own.filter(|of| pairs.last().is_none_or(|&(_, before)| of.1 > before));
            pairs.extend(after.max_by(|a, b| a.3.total_cmp(&b.3)).map(|of| (of.0, of.1)));
        }
        let apart = pairs.last().zip(pairs.first()).is_some_and(|(last, first)| last.0 < first.1);
        if apart && pairs.len() > 1 { pairs } else { Vec::new() }
    };
    candidates.iter().map(block).max_by_key(Vec::len).unwrap_or_default()
}

/// How far channels move in stretches of the movements, and their integrals over time there; both (n, stretches).
fn stretches(demonstrations: &Demonstrations) -> (DMatrix<f64>, DMatrix<f64>) {
    let places = || {
        demonstrations.trajectories().iter().flat_map(|movement| {
            let last = movement.n_samples() - 1;
            let length = SAMPLES.min((last / 2).max(1));
            (0..last / length).map(move |stretch| (movement, stretch * length, (stretch + 1) * length))
        })
    };
    let every = places().count().div_ceil(STRETCHES).max(1);
    let chosen: Vec<(&Trajectory, usize, usize)> = places().step_by(every).collect();
    let n = demonstrations.dim();
    let mut steps = DMatrix::zeros(n, chosen.len());
    let mut integrals = DMatrix::zeros(n, chosen.len());
    for (at, &(movement, from, to)) in chosen.iter().enumerate() {
        steps.set_column(at, &(movement.state(to) - movement.state(from)));
        let mut integral = integrals.column_mut(at);
        for sample in from..to {
            let half = 0.5 * movement.seconds(sample, sample + 1);
            integral.axpy(half, &movement.state(sample), 1.0);
            integral.axpy(half, &movement.state(sample + 1), 1.0);
        }
    }
    (steps, integrals)
}

/// A name, or several that end in numbers which follow each other.
struct Run {
    stem: String,
    /// First and last number, if the name has one.
    numbers: Option<(usize, usize)>,
}

impl Run {
    fn of(name: &str) -> Self {
        let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        // "x07" is another name than "x7".
        match name[stem.len()..].parse() {
            Ok(number) if !stem.is_empty() && format!("{stem}{number}") == name => {
                Run { stem: stem.to_owned(), numbers: Some((number, number)) }
            }
            _ => Run { stem: name.to_owned(), numbers: None },
        }
    }

    /// Takes up the next name, if it follows.
    fn continues_with(&mut self, next: &Run) -> bool {
        match (&mut self.numbers, next.numbers) {
            (Some((_, last)), Some((number, _))) if self.stem == next.stem && number == *last + 1 => {
                *last = number;
                true
            }
            _ => false,
        }
    }
}

/// `x0-3` for `x0`, `x1`, `x2`, `x3`; other names with commas between.
fn listed(names: &[&str]) -> String {
    let mut runs: Vec<Run> = Vec::new();
    for run in names.iter().map(|name| Run::of(name)) {
        if !runs.last_mut().is_some_and(|last| last.continues_with(&run)) {
            runs.push(run);
        }
    }
    let text = |Run { stem, numbers }: Run| match numbers {
        Some((first, last)) if last > first => format!("{stem}{first}-{last}"),
        Some((number, _)) => format!("{stem}{number}"),
        None => stem,
    };
    runs.into_iter().map(text).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;
    use proptest::prelude::*;

    use super::*;

    fn channels(names: &[&str]) -> Vec<Channel> {
        names.iter().map(|&name| Channel { name: name.to_owned(), unit: None }).collect()
    }

    /// Movements of which `sample(movement, time)` are the channels.
    fn movements(count: usize, dt: f64, sample: impl Fn(usize, f64) -> Vec<f64>) -> Demonstrations {
        let one = |k: usize| {
            let columns: Vec<DVector<f64>> = (0..60).map(|i| DVector::from_vec(sample(k, dt * f64::from(i)))).collect();
            Trajectory::new(DMatrix::from_columns(&columns), dt).unwrap()
        };
        Demonstrations::new((0..count).map(one).collect()).unwrap()
    }

    #[test]
    fn names_are_put_together() {
        assert_eq!(listed(&["x0", "x1", "x2", "x4", "a", "s_9", "s_10"]), "x0-2,x4,a,s_9-10");
        assert_eq!(listed(&["x07", "x08", "7", "8"]), "x07,x08,7,8");
        assert_eq!(listed(&[]), "");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Whatever the movements, the unit of velocities and the noise of some per mille.
        #[test]
        fn a_block_of_velocities_is_found(
            n in 2usize..6,
            unit in prop_oneof![Just(1.0), Just(1000.0), 0.05..20.0f64],
            rates in proptest::collection::vec(0.5..3.0f64, 6),
            seed in 0.0..10.0f64,
            clock in any::<bool>(),
        ) {
            let start = |k: usize, axis: usize| 1.5 * (seed + 1.7 * k as f64 + 2.3 * axis as f64).sin();
            let turn = |k: usize, axis: usize| (3.1 * k as f64 + 1.3 * axis as f64 + seed).cos();
            let noise = |k: usize, t: f64| 1e-3 * (977.0 * t + 31.0 * k as f64).sin();
            let place = |k: usize, axis: usize, t: f64| {
                start(k, axis) * (-rates[axis] * t).exp() + turn(k, axis) * (2.0 * t).sin() + noise(k + axis, t)
            };
            let rate = |k: usize, axis: usize, t: f64| {
                unit * (2.0 * turn(k, axis) * (2.0 * t).cos() - rates[axis] * start(k, axis) * (-rates[axis] * t).exp())
            };
            let sample = |k: usize, t: f64| -> Vec<f64> {
                let own = (0..n).map(|axis| place(k, axis, t)).chain((0..n).map(|axis| rate(k, axis, t)));
                std::iter::once(t).filter(|_| clock).chain(own).collect()
            };
            let first = usize::from(clock);
            let found = no_state(&movements(8, 0.05, sample), &channels(
                &["s_0", "s_1", "s_2", "s_3", "s_4", "s_5", "s_6", "s_7", "s_8", "s_9", "s_10"][..2 * n + first],
            ));
            let (end, last) = (first + n - 1, first + 2 * n - 1);
            let flags = format!("--state s_{first}-{end} --velocity s_{}-{last}", end + 1);
            let expected = if clock { format!("--time s_0 {flags}") } else { flags };
            prop_assert_eq!(found.map(|finding| finding.next), Some(expected));
            // Positions alone are a state.
            let places = |k: usize, t: f64| (0..n).map(|axis| place(k, axis, t)).collect();
            let alone = no_state(&movements(8, 0.05, places), &channels(&["x0", "x1", "x2", "x3", "x4", "x5"][..n]));
            prop_assert_eq!(alone, None);
        }
    }

    /// What only looks so: one turning pair, a clock with a name, one that starts anywhere, a belt at constant speed.
    #[test]
    fn states_are_left_alone() {
        let turning = movements(6, 0.05, |k, t| vec![(t + k as f64).sin(), (t + k as f64).cos()]);
        assert_eq!(no_state(&turning, &channels(&["x0", "x1"])), None);
        let rising = |start: f64| movements(6, 0.05, move |k, t| vec![(t * k as f64).sin(), t + start * k as f64]);
        assert_eq!(no_state(&rising(0.0), &channels(&["x0", "belt"])), None);
        assert_eq!(no_state(&rising(0.1), &channels(&["x0", "x1"])), None);
        assert_eq!(no_state(&rising(0.0), &channels(&["x0", "x1"])).unwrap().next, "--time x1");
    }
}
