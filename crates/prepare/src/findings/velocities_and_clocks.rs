//! Detects channels that are no state: velocities of others, and time.

use motion::{Channel, Demonstrations, Finding, Trajectory, Verdict};

use super::integrals::Integrals;

/// Above this number, channels are not compared.
const MOST: usize = 256;
/// Maximum difference between steps of a clock, as a share of a step.
const EVEN: f64 = 1e-3;

/// Reports channels that are velocities of others, or time, and the flags that assign these roles.
///
/// A block of velocities follows a block of positions, with at least two of them in the same unit, or each channel is followed by its
/// velocity. A clock has no specific name, begins at one value in each of several movements, and increases like time. O(n² stretches + n
/// samples) for n channels.
pub(crate) fn velocities_and_clocks(demonstrations: &Demonstrations, channels: &[Channel]) -> Option<Finding> {
    let n = channels.len();
    if n > MOST {
        return None;
    }
    let names: Vec<&str> = channels.iter().map(|channel| &channel.name[..]).collect();
    let clock = (0..n).find(|&axis| n > 1 && is_counted(names[axis]) && is_clock(demonstrations, axis));
    let recorded = demonstrations.trajectories().iter().any(|movement| movement.velocities().is_some());
    let (mut pairs, mut steps) = (Vec::new(), "");
    if !recorded {
        let integrals = Integrals::of(demonstrations);
        pairs = integrals.velocities(clock);
        if pairs.is_empty() {
            pairs = integrals.velocities_by_movement(clock);
            steps = ", at another time step in each movement";
        }
    }
    let names_by =
        |pick: &dyn Fn(&(usize, usize)) -> usize| pairs.iter().map(|pair| names[pick(pair)]).collect::<Vec<_>>();
    let (states, rates) = (listed(&names_by(&|pair| pair.0)), listed(&names_by(&|pair| pair.1)));
    let (mut what, mut next) = (Vec::new(), Vec::new());
    if let Some(clock) = clock {
        what.push(format!("{} rises as time does", names[clock]));
        next.push(format!("--time {}", names[clock]));
    }
    if !pairs.is_empty() {
        what.push(format!("{rates} are the velocities of {states}{steps}"));
        next.push(format!("--state {states} --velocity {rates}"));
    }
    (!what.is_empty()).then(|| {
        Finding::new(Verdict::DoNotUse, format!("{}: not a part of the state", what.join(", ")), next.join(" "))
    })
}

/// Whether a name is only a stem and a number, as readers generate them.
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

/// A name, or several with the same stem and consecutive numbers.
struct Run {
    stem: String,
    /// First and last number, if the name has one.
    numbers: Option<(usize, usize)>,
}

impl Run {
    fn of(name: &str) -> Self {
        let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        // "x07" and "x7" are different names.
        match name[stem.len()..].parse() {
            Ok(number) if !stem.is_empty() && format!("{stem}{number}") == name => {
                Run { stem: stem.to_owned(), numbers: Some((number, number)) }
            }
            _ => Run { stem: name.to_owned(), numbers: None },
        }
    }

    /// Appends the next name if it continues the run.
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

/// `x0-3` for `x0`, `x1`, `x2`, `x3`; other names separated by commas.
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
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;

    fn channels(names: &[&str]) -> Vec<Channel> {
        names.iter().map(|&name| Channel { name: name.to_owned(), unit: None }).collect()
    }

    /// Movements whose channels are `sample(movement, time)`.
    fn movements(count: usize, dt: f64, sample: impl Fn(usize, f64) -> Vec<f64>) -> Demonstrations {
        let one = |k: usize| {
            let columns: Vec<DVector<f64>> = (0..60).map(|i| DVector::from_vec(sample(k, dt * f64::from(i)))).collect();
            Trajectory::new(DMatrix::from_columns(&columns), dt).unwrap()
        };
        Demonstrations::new((0..count).map(one).collect()).unwrap()
    }

    #[test]
    fn numbered_names_are_abbreviated() {
        assert_eq!(listed(&["x0", "x1", "x2", "x4", "a", "s_9", "s_10"]), "x0-2,x4,a,s_9-10");
        assert_eq!(listed(&["x07", "x08", "7", "8"]), "x07,x08,7,8");
        assert_eq!(listed(&[]), "");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// For any movements, unit of velocities, and noise of a few per mille.
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
            let found = velocities_and_clocks(&movements(8, 0.05, sample), &channels(
                &["s_0", "s_1", "s_2", "s_3", "s_4", "s_5", "s_6", "s_7", "s_8", "s_9", "s_10"][..2 * n + first],
            ));
            let (end, last) = (first + n - 1, first + 2 * n - 1);
            let flags = format!("--state s_{first}-{end} --velocity s_{}-{last}", end + 1);
            let expected = if clock { format!("--time s_0 {flags}") } else { flags };
            prop_assert_eq!(found.map(|finding| finding.next), Some(expected));
            // Each channel followed by its velocity; then all channels are such pairs.
            let alternating = |k: usize, t: f64| -> Vec<f64> {
                let own = (0..n).flat_map(|axis| [place(k, axis, t), rate(k, axis, t)]);
                std::iter::once(t).filter(|_| clock).chain(own).collect()
            };
            let names: Vec<String> = (0..2 * n + first).map(|at| format!("c{at}")).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let every_second = |from: usize| (0..n).map(|at| names[first + 2 * at + from]).collect::<Vec<_>>().join(",");
            let flags = format!("--state {} --velocity {}", every_second(0), every_second(1));
            let expected = if clock { format!("--time c0 {flags}") } else { flags };
            let found = velocities_and_clocks(&movements(8, 0.05, alternating), &channels(&names));
            prop_assert_eq!(found.map(|finding| finding.next), Some(expected));
            // Positions alone are a state.
            let places = |k: usize, t: f64| (0..n).map(|axis| place(k, axis, t)).collect();
            let alone = velocities_and_clocks(&movements(8, 0.05, places), &channels(&["x0", "x1", "x2", "x3", "x4", "x5"][..n]));
            prop_assert_eq!(alone, None);
        }
    }

    /// Recordings whose movements have different time steps than assumed: one factor for all would not fit.
    #[test]
    fn velocities_at_other_time_steps_are_found() {
        let sample = |spread: f64| {
            move |k: usize, t: f64| {
                let (unit, phase) = (1.0 + spread * k as f64, k as f64);
                let places = [(2.0 * t + phase).sin(), (1.3 * t - phase).cos()];
                let rates = [2.0 * (2.0 * t + phase).cos(), -1.3 * (1.3 * t - phase).sin()];
                // A constant explains a uniform increase, but is no velocity.
                vec![0.7 * t + phase, places[0], places[1], 1.0, unit * rates[0], unit * rates[1]]
            }
        };
        let channels = channels(&["s_0", "s_1", "s_2", "s_3", "s_4", "s_5"]);
        for (spread, how) in [(0.0, ""), (0.8, ", at another time step in each movement")] {
            let long = |k: usize, t: f64| sample(spread)(k, 2.0 * t);
            let found = velocities_and_clocks(&movements(5, 0.1, long), &channels).unwrap();
            assert_eq!(found.next, "--state s_1-2 --velocity s_4-5");
            assert_eq!(found.what, format!("s_4-5 are the velocities of s_1-2{how}: not a part of the state"));
        }
    }

    /// Channels that only resemble velocities or time: one rotating pair, a clock with a name, one that starts anywhere, a belt at constant
    /// speed.
    #[test]
    fn states_resembling_velocities_or_time_are_kept() {
        let turning = movements(6, 0.05, |k, t| vec![(t + k as f64).sin(), (t + k as f64).cos()]);
        assert_eq!(velocities_and_clocks(&turning, &channels(&["x0", "x1"])), None);
        let rising = |start: f64| movements(6, 0.05, move |k, t| vec![(t * k as f64).sin(), t + start * k as f64]);
        assert_eq!(velocities_and_clocks(&rising(0.0), &channels(&["x0", "belt"])), None);
        assert_eq!(velocities_and_clocks(&rising(0.1), &channels(&["x0", "x1"])), None);
        assert_eq!(velocities_and_clocks(&rising(0.0), &channels(&["x0", "x1"])).unwrap().next, "--time x1");
    }
}
