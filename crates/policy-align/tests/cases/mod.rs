//! Recordings with their truth, good and bad, typical of laboratories.

mod faulty_sensors;
mod in_the_way;
mod unseen;

use constraints::{LinearConstraint, PfaffianConstraint, Switching, Unconstrained};
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind as Shown};
use demo_gen::{Parabola, Recording, RollOut, Sinusoidal, ThreeLinkArm, with_position_noise};
use motion::{Channel, Episode, Recordings, Source};
use motion::{LearntPolicy, Policy, Potential};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut, dvector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Number of test movements of the same kind, which no learner sees.
const FRESH: usize = 20;
/// A policy is right below this error (nUPE).
const RIGHT: f64 = 0.15;

/// Recordings with their truth.
pub(crate) struct Case {
    pub(crate) recordings: Recordings,
    /// States of the test movements, (n, M), in true units.
    pub(crate) states: DMatrix<f64>,
    /// The true policy at these states, (n, M), in true units per second.
    pub(crate) actions: DMatrix<f64>,
    /// Factors from the truth to the recordings, (n).
    pub(crate) units: DVector<f64>,
    /// Recorded seconds in one true second.
    pub(crate) seconds: f64,
}

/// Whether the file contains velocities.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Has {
    Velocities,
    Positions,
}

impl Case {
    /// The first `count` movements are for learning, the rest for testing.
    pub(crate) fn of(recordings: &[Recording], count: usize, has: Has) -> Self {
        let dim = recordings[0].truth.states.nrows();
        let episode = |(at, recording): (usize, &Recording)| Episode {
            name: (at + 1).to_string(),
            source: Source { file: "case".to_owned(), records: None },
            times: (0..recording.observed.n_samples()).map(|i| i as f64 * recording.observed.time_step()).collect(),
            positions: recording.observed.states().clone(),
            velocities: recording.observed.velocities().filter(|_| has == Has::Velocities).cloned(),
            constraint: None,
            context: nalgebra::DVector::zeros(0),
        };
        let names = if dim <= 3 { vec!["x", "y", "z"] } else { Vec::new() };
        let name = |axis: usize| names.get(axis).map_or_else(|| format!("q{}", axis + 1), ToString::to_string);
        let fresh = &recordings[count..];
        let columns = |of: &dyn Fn(&Recording) -> DMatrix<f64>| {
            let parts: Vec<_> = fresh.iter().map(of).collect();
            let all: Vec<f64> = parts.iter().flat_map(|part| part.iter().copied()).collect();
            DMatrix::from_vec(dim, all.len() / dim, all)
        };
        Case {
            recordings: Recordings {
                state: (0..dim).map(|axis| Channel { name: name(axis), unit: None }).collect(),
                episodes: recordings[..count].iter().enumerate().map(episode).collect(),
                findings: Vec::new(),
            },
            states: columns(&|recording| recording.truth.states.clone()),
            actions: columns(&|recording| recording.truth.actions.clone()),
            units: DVector::repeat(dim, 1.0),
            seconds: 1.0,
        }
    }

    pub(crate) fn dim(&self) -> usize {
        self.states.nrows()
    }

    /// nUPE at the test states, in true units. `scales`: factors by which the learner multiplied states.
    pub(crate) fn error(&self, policy: &dyn LearntPolicy, scales: &DVector<f64>) -> f64 {
        let factor = self.units.component_mul(scales);
        let mut learnt = self.states.clone();
        for mut column in learnt.column_iter_mut() {
            let x = column.component_mul(&factor);
            column.copy_from(&(policy.action(x.as_view()).component_div(&factor) * self.seconds));
        }
        metrics::nupe(&self.actions, &learnt).expect("learnt policies are finite")
    }

    /// The case in other units.
    pub(crate) fn in_units(mut self, units: &[f64]) -> Self {
        self.units = DVector::from_column_slice(units);
        for episode in &mut self.recordings.episodes {
            for values in [Some(&mut episode.positions), episode.velocities.as_mut()].into_iter().flatten() {
                values.column_iter_mut().for_each(|mut column| column.component_mul_assign(&self.units));
            }
        }
        self
    }

    pub(crate) fn each(mut self, change: impl FnMut(&mut Episode)) -> Self {
        self.recordings.episodes.iter_mut().for_each(change);
        self
    }

    /// White noise on recorded velocities, as a share of their root mean square.
    pub(crate) fn velocity_noise(self, share: f64, seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x4d);
        let all: Vec<f64> = self
            .recordings
            .episodes
            .iter()
            .flat_map(|episode| episode.velocities.iter().flat_map(|u| u.iter().copied().collect::<Vec<_>>()))
            .collect();
        let sd = share * (all.iter().map(|u| u * u).sum::<f64>() / all.len() as f64).sqrt();
        self.each(|episode| {
            if let Some(u) = &mut episode.velocities {
                u.iter_mut().for_each(|u| *u += sd * rng.sample::<f64, _>(StandardNormal));
            }
        })
    }
}

/// A policy given by a function.
pub(crate) struct Own<F>(pub usize, pub F);

impl<F: Fn(&[f64]) -> Vec<f64> + Send + Sync> Policy for Own<F> {
    fn dim(&self) -> usize {
        self.0
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        action.copy_from_slice(&(self.1)(state.as_slice()));
    }
}

/// The active constraints.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Under {
    Nothing,
    /// A random direction is blocked, and another one after this number of seconds.
    Changing(f64),
    /// The same direction is always blocked.
    Fixed,
}

/// Movements on the plane from starts in a square.
pub(crate) struct Plane {
    pub(crate) count: usize,
    pub(crate) roll_out: RollOut,
    pub(crate) under: Under,
    pub(crate) reach: f64,
}

impl Default for Plane {
    fn default() -> Self {
        Plane { count: 40, roll_out: RollOut::default(), under: Under::Changing(20.0), reach: 2.0 }
    }
}

impl Plane {
    pub(crate) fn potential(&self, potential: &(dyn Potential + Sync), seed: u64) -> Vec<Recording> {
        self.each(seed, |constraint, start| self.roll_out.record(potential, constraint, start.as_view()).unwrap())
    }

    /// Applies several policies, one after the other.
    pub(crate) fn policies(&self, policies: &[&dyn Policy], seed: u64) -> Vec<Recording> {
        let mut at = 0;
        self.each(seed, |constraint, start| {
            let policy = policies[at % policies.len()];
            at += 1;
            let observed = self.roll_out.follow(policy, constraint, start.as_view()).unwrap();
            let states = observed.states().clone();
            let actions = DMatrix::from_columns(&states.column_iter().map(|x| policy.action(x)).collect::<Vec<_>>());
            let truth = demo_gen::Truth { states, potential: DVector::zeros(0), actions, projectors: Vec::new() };
            Recording { observed, truth }
        })
    }

    fn each(
        &self,
        seed: u64,
        mut record: impl FnMut(&dyn PfaffianConstraint, &DVector<f64>) -> Recording,
    ) -> Vec<Recording> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let linear = |rng: &mut ChaCha8Rng| {
            LinearConstraint::new(DMatrix::from_fn(1, 2, |_, _| rng.sample(StandardNormal))).unwrap()
        };
        let fixed = linear(&mut rng);
        (0..self.count + FRESH)
            .map(|_| {
                let start = DVector::from_fn(2, |_, _| self.reach * rng.random_range(-1.0..1.0));
                match self.under {
                    Under::Nothing => record(&Unconstrained { dim: 2 }, &start),
                    Under::Fixed => record(&fixed, &start),
                    Under::Changing(seconds) => {
                        let length = self.roll_out.time_step * self.roll_out.n_samples as f64;
                        let phases = (0..(length / seconds).ceil() as usize)
                            .map(|phase| (seconds * phase as f64, linear(&mut rng)));
                        let constraint = Switching::new(phases.collect()).unwrap();
                        record(&constraint, &start)
                    }
                }
            })
            .collect()
    }
}

pub(crate) fn parabola() -> Parabola {
    Parabola { weight: 0.05, centre: DVector::zeros(2) }
}

pub(crate) fn sinusoid() -> Sinusoidal {
    Sinusoidal { amplitude: 0.1 }
}

/// `seconds` of movement at `hertz` samples per second.
pub(crate) fn at_rate(hertz: f64, seconds: f64) -> RollOut {
    RollOut { time_step: 1.0 / hertz, n_samples: (seconds * hertz) as usize, sub_steps: 1 }
}

pub(crate) fn beyond(policy: Shown, constraint: ConstraintKind, count: usize, seed: u64) -> Vec<Recording> {
    let system = BeyondSystem { policy, constraint, n_trajectories: count + FRESH, ..BeyondSystem::default() };
    system.record(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

pub(crate) fn noisy(recordings: &[Recording], share: f64, seed: u64) -> Vec<Recording> {
    with_position_noise(recordings, share, &mut ChaCha8Rng::seed_from_u64(seed ^ 0x63)).unwrap()
}

pub(crate) fn arm(count: usize, seed: u64) -> Vec<Recording> {
    let urdf = include_str!("../../../../robots/planar_three_link.urdf");
    let arm = ThreeLinkArm { n_trajectories: count + FRESH, ..ThreeLinkArm::new(urdf).unwrap() };
    arm.record(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

type Make = Box<dyn Fn(u64) -> Case + Send + Sync>;

/// A case by its name.
pub(crate) struct Named {
    pub(crate) name: &'static str,
    pub(crate) make: Make,
    /// A policy is right below this error (nUPE).
    pub(crate) right: f64,
}

fn case(name: &'static str, make: impl Fn(u64) -> Case + Send + Sync + 'static) -> Named {
    Named { name, make: Box::new(make), right: RIGHT }
}

/// All cases.
#[allow(clippy::too_many_lines, reason = "a list")]
pub(crate) fn all() -> Vec<Named> {
    use Has::{Positions, Velocities};
    let plane = |count: usize| Plane { count, ..Plane::default() };
    let of_parabola = move |count: usize, seed: u64| plane(count).potential(&parabola(), seed);
    let of_sinusoid = move |count: usize, seed: u64| plane(count).potential(&sinusoid(), seed);
    let fast = |hertz: f64, seed: u64| {
        Plane { count: 30, roll_out: at_rate(hertz, 20.0), under: Under::Changing(10.0), ..Plane::default() }
            .potential(&sinusoid(), seed)
    };
    let free = |roll_out| Plane { roll_out, under: Under::Nothing, ..Plane::default() };
    let fine = || RollOut { time_step: 0.5, n_samples: 60, sub_steps: 20 };
    let mut all = vec![
        case("clean parabola", move |s| Case::of(&of_parabola(40, s), 40, Velocities)),
        case("clean sinusoid", move |s| Case::of(&of_sinusoid(40, s), 40, Velocities)),
        case("clean parabola, positions only", move |s| Case::of(&of_parabola(40, s), 40, Positions)),
        case("clean sinusoid, positions only", move |s| Case::of(&of_sinusoid(40, s), 40, Positions)),
        case("1 % noise, positions only", move |s| Case::of(&noisy(&of_sinusoid(40, s), 0.01, s), 40, Positions)),
        case("5 % noise, positions only", move |s| Case::of(&noisy(&of_sinusoid(40, s), 0.05, s), 40, Positions)),
        case("20 % noise, positions only", move |s| Case::of(&noisy(&of_sinusoid(40, s), 0.2, s), 40, Positions)),
        case("0.1 % noise at 50 Hz, positions only", move |s| {
            Case::of(&noisy(&fast(50.0, s), 0.001, s), 30, Positions)
        }),
        case("1 % noise at 50 Hz, positions only", move |s| Case::of(&noisy(&fast(50.0, s), 0.01, s), 30, Positions)),
        case("5 % noise at 50 Hz, positions only", move |s| Case::of(&noisy(&fast(50.0, s), 0.05, s), 30, Positions)),
        case("1 % noise at 50 Hz, clean velocities", move |s| {
            Case::of(&noisy(&fast(50.0, s), 0.01, s), 30, Velocities)
        }),
        case("1 % noise at 50 Hz, velocities by differences", move |s| {
            Case::of(&noisy(&fast(50.0, s), 0.01, s), 30, Velocities).each(|episode| {
                let (dt, n) = (episode.times.seconds(0, 1), episode.times.len());
                let x = episode.positions.clone();
                episode.velocities = Some(DMatrix::from_fn(2, n, |axis, i| {
                    let i = i.min(n - 2);
                    (x[(axis, i + 1)] - x[(axis, i)]) / dt
                }));
            })
        }),
        case("20 % noise, clean velocities", move |s| Case::of(&noisy(&of_sinusoid(40, s), 0.2, s), 40, Velocities)),
        case("velocities with 5 % noise", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).velocity_noise(0.05, s)
        }),
        case("velocities with 20 % noise", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).velocity_noise(0.2, s)
        }),
        case("velocities with 50 % noise", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).velocity_noise(0.5, s)
        }),
        case("millimetres", move |s| Case::of(&of_sinusoid(40, s), 40, Velocities).in_units(&[1000.0, 1000.0])),
        case("millimetres, positions only", move |s| {
            Case::of(&of_parabola(40, s), 40, Positions).in_units(&[1000.0, 1000.0])
        }),
        case("micro-units", move |s| Case::of(&of_parabola(40, s), 40, Velocities).in_units(&[1e-3, 1e-3])),
        case("one dimension in degrees", move |s| {
            Case::of(&of_parabola(40, s), 40, Velocities).in_units(&[1.0, 57.29577951308232])
        }),
        case("one dimension in degrees, sinusoid", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).in_units(&[57.29577951308232, 1.0])
        }),
        case("one dimension doubled", move |s| Case::of(&of_sinusoid(40, s), 40, Velocities).in_units(&[1.0, 2.0])),
        case("one dimension times 5", move |s| Case::of(&of_sinusoid(40, s), 40, Velocities).in_units(&[1.0, 5.0])),
        case("stamps in milliseconds, positions only", move |s| {
            let mut case = Case::of(&fast(20.0, s), 30, Positions)
                .each(|episode| episode.times.stamps_mut().iter_mut().for_each(|t| *t *= 1000.0));
            case.seconds = 1000.0;
            case
        }),
        case("stamps in milliseconds", move |s| {
            Case::of(&fast(20.0, s), 30, Velocities)
                .each(|episode| episode.times.stamps_mut().iter_mut().for_each(|t| *t *= 1000.0))
        }),
        case("velocities in mm/s", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).each(|e| e.velocities.iter_mut().for_each(|u| *u *= 1000.0))
        }),
        case("velocities with the wrong sign", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities).each(|e| e.velocities.iter_mut().for_each(|u| *u *= -1.0))
        }),
        case("velocities are steps", move |s| {
            Case::of(&fast(20.0, s), 30, Velocities).each(|e| e.velocities.iter_mut().for_each(|u| *u *= 0.05))
        }),
        case("velocities shuffled among channels", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities)
                .each(|e| e.velocities.iter_mut().for_each(|u| u.swap_rows(0, 1)))
        }),
        case("reversed in time", move |s| {
            Case::of(&of_parabola(40, s), 40, Positions).each(|e| {
                let n = e.times.len();
                e.positions = DMatrix::from_fn(2, n, |axis, i| e.positions[(axis, n - 1 - i)]);
            })
        }),
        case("transposed", move |s| {
            let case = Case::of(&of_parabola(40, s), 40, Velocities).each(|e| {
                e.positions = e.positions.transpose();
                e.velocities = None;
                e.times.stamps_mut().truncate(2);
            });
            let mut recordings = case.recordings.clone();
            recordings.state = (0..40).map(|i| Channel { name: format!("c{i}"), unit: None }).collect();
            Case { recordings, ..case }
        }),
        case("every movement twice", move |s| {
            let mut case = Case::of(&of_sinusoid(40, s), 40, Velocities);
            let again = case.recordings.episodes.clone();
            case.recordings.episodes.extend(again);
            case
        }),
        case("quantised to 0.05, positions only", move |s| {
            Case::of(&of_parabola(40, s), 40, Positions)
                .each(|e| e.positions.apply(|x| *x = (*x * 20.0).round() / 20.0))
        }),
        case("quantised to 0.01 at 50 Hz, positions only", move |s| {
            Case::of(&fast(50.0, s), 30, Positions).each(|e| e.positions.apply(|x| *x = (*x * 100.0).round() / 100.0))
        }),
        case("quantised to 0.05, velocities", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Velocities)
                .each(|e| e.positions.apply(|x| *x = (*x * 20.0).round() / 20.0))
        }),
        case("angles that wrap", move |s| {
            let wrap = |x: f64| x - std::f64::consts::TAU * (x / std::f64::consts::TAU).round();
            let wide = Plane { reach: 4.5, ..Plane::default() }.potential(&parabola(), s);
            let mut case = Case::of(&wide, 40, Positions).each(|e| e.positions.apply(|x| *x = wrap(*x)));
            case.units = dvector![1.0, 1.0];
            case
        }),
        case("jumps", move |s| {
            let mut rng = ChaCha8Rng::seed_from_u64(s ^ 5);
            Case::of(&of_sinusoid(40, s), 40, Positions).each(move |e| {
                if rng.random_bool(0.3) {
                    let at = rng.random_range(8..32);
                    e.positions.column_mut(at).add_scalar_mut(3.0);
                }
            })
        }),
        case("five samples missing, stamps closed up", move |s| {
            Case::of(&of_sinusoid(40, s), 40, Positions).each(|e| {
                e.positions = e.positions.clone().remove_columns(10, 5);
                e.times.stamps_mut().truncate(35);
            })
        }),
        case("uneven stamps", move |s| {
            // Every movement is sampled at different times, from a fine simulation.
            let mut rng = ChaCha8Rng::seed_from_u64(s ^ 6);
            let fine = Plane { roll_out: at_rate(50.0, 40.0), ..Plane::default() }.potential(&sinusoid(), s);
            Case::of(&fine, 40, Positions).each(move |e| {
                let at: Vec<usize> = (0..40).map(|i| 50 * i + rng.random_range(0..25)).collect();
                e.positions = e.positions.select_columns(&at);
                e.times = at.iter().map(|&i| e.times.seconds(at[0], i)).collect();
            })
        }),
        case("standing ends", move |s| {
            Case::of(&of_parabola(40, s), 40, Positions).each(|e| {
                let last = e.positions.column(39).into_owned();
                e.positions = e.positions.clone().resize_horizontally(80, 0.0);
                for i in 40..80 {
                    e.positions.set_column(i, &last);
                }
                e.times = (0..80).map(f64::from).collect();
            })
        }),
        case("rotation, free", move |s| {
            let whirl = Own(2, |x: &[f64]| vec![-0.1 * x[1] - 0.01 * x[0], 0.1 * x[0] - 0.01 * x[1]]);
            Case::of(&free(fine()).policies(&[&whirl], s), 40, Velocities)
        }),
        case("closed loops, free", move |s| {
            let whirl = Own(2, |x: &[f64]| vec![-0.1 * x[1], 0.1 * x[0]]);
            let roll_out = RollOut { time_step: 1.0, n_samples: 63, sub_steps: 50 };
            Case::of(&free(roll_out).policies(&[&whirl], s), 40, Positions)
        }),
        case("rotation, constrained", move |s| {
            let whirl = Own(2, |x: &[f64]| vec![-0.1 * x[1] - 0.01 * x[0], 0.1 * x[0] - 0.01 * x[1]]);
            Case::of(&Plane { roll_out: fine(), ..Plane::default() }.policies(&[&whirl], s), 40, Velocities)
        }),
        case("limit cycle, constrained", |s| {
            Case::of(&beyond(Shown::LimitCycle, ConstraintKind::Varying, 40, s), 40, Velocities)
        }),
        case("limit cycle, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::LimitCycle, ConstraintKind::Varying, 40, s), 0.01, s), 40, Positions)
        }),
        case("limit cycle, free", |s| {
            Case::of(&beyond(Shown::LimitCycle, ConstraintKind::Free, 40, s), 40, Velocities)
        }),
        case("swirl 3-D, constrained", |s| {
            Case::of(&beyond(Shown::Swirl { dim: 3 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("handwriting, free, 5", |s| {
            Case::of(&beyond(Shown::Handwriting, ConstraintKind::Free, 5, s), 5, Positions)
        }),
        case("handwriting, free, 10", |s| {
            Case::of(&beyond(Shown::Handwriting, ConstraintKind::Free, 10, s), 10, Velocities)
        }),
        case("handwriting, free, 10, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Handwriting, ConstraintKind::Free, 10, s), 0.01, s), 10, Positions)
        }),
        case("handwriting, constrained, 40", |s| {
            Case::of(&beyond(Shown::Handwriting, ConstraintKind::Varying, 40, s), 40, Velocities)
        }),
        case("one fixed constraint, parabola", move |s| {
            Case::of(&Plane { under: Under::Fixed, ..Plane::default() }.potential(&parabola(), s), 40, Velocities)
        }),
        case("one fixed constraint, sinusoid", move |s| {
            Case::of(&Plane { under: Under::Fixed, ..Plane::default() }.potential(&sinusoid(), s), 40, Velocities)
        }),
        case("one fixed constraint, 1 % noise", move |s| {
            Case::of(
                &noisy(&Plane { under: Under::Fixed, ..Plane::default() }.potential(&sinusoid(), s), 0.01, s),
                40,
                Positions,
            )
        }),
        case("one turning constraint for all, 2-D", |s| {
            Case::of(&beyond(Shown::Sinusoidal, ConstraintKind::OneForAll, 40, s), 40, Velocities)
        }),
        case("one turning constraint for all, 2-D, 5", |s| {
            Case::of(&beyond(Shown::Sinusoidal, ConstraintKind::OneForAll, 5, s), 5, Velocities)
        }),
        case("one turning constraint for all, 3-D", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::OneForAll, 60, s), 60, Velocities)
        }),
        case("one turning constraint for all, 3-D, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::OneForAll, 60, s), 0.01, s), 60, Positions)
        }),
        case("one turning constraint for all, 6-D", |s| {
            Case::of(&beyond(Shown::Planes { dim: 6, edge: 0.1 }, ConstraintKind::OneForAll, 60, s), 60, Velocities)
        }),
        case("parabola, 10 movements", move |s| Case::of(&of_parabola(10, s), 10, Velocities)),
        case("sinusoid, 10 movements", move |s| Case::of(&of_sinusoid(10, s), 10, Velocities)),
        case("sinusoid, 10 movements, 1 % noise", move |s| {
            Case::of(&noisy(&of_sinusoid(10, s), 0.01, s), 10, Positions)
        }),
        case("sinusoid, 1 movement", move |s| Case::of(&of_sinusoid(1, s), 1, Velocities)),
        case("sinusoid, 2 movements", move |s| Case::of(&of_sinusoid(2, s), 2, Velocities)),
        case("sinusoid, 3 movements", move |s| Case::of(&of_sinusoid(3, s), 3, Velocities)),
        case("sinusoid, 5 movements", move |s| Case::of(&of_sinusoid(5, s), 5, Velocities)),
        case("sinusoid, 5 movements, 1 % noise", move |s| Case::of(&noisy(&of_sinusoid(5, s), 0.01, s), 5, Positions)),
        case("wells 3-D, 5 movements", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Varying, 5, s), 5, Velocities)
        }),
        case("wells 3-D", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("wells 3-D, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Varying, 60, s), 0.01, s), 60, Positions)
        }),
        case("wells 3-D, 5 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Varying, 60, s), 0.05, s), 60, Positions)
        }),
        case("wells 3-D, half free", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::HalfFree, 40, s), 40, Velocities)
        }),
        case("wells 3-D, free", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Free, 20, s), 20, Velocities)
        }),
        case("wells 3-D, free, 5", |s| {
            Case::of(&beyond(Shown::Wells { dim: 3 }, ConstraintKind::Free, 5, s), 5, Velocities)
        }),
        case("sinusoid, free, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Sinusoidal, ConstraintKind::Free, 20, s), 0.01, s), 20, Positions)
        }),
        case("three-link arm", |s| Case::of(&arm(40, s), 40, Positions)),
        case("seven joints, wells", |s| {
            Case::of(&beyond(Shown::Wells { dim: 7 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("seven joints, planes", |s| {
            Case::of(&beyond(Shown::Planes { dim: 7, edge: 0.1 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("seven joints, 1 % noise", |s| {
            Case::of(&noisy(&beyond(Shown::Wells { dim: 7 }, ConstraintKind::Varying, 60, s), 0.01, s), 60, Positions)
        }),
        case("seven joints, 12 movements", |s| {
            Case::of(&beyond(Shown::Wells { dim: 7 }, ConstraintKind::Varying, 12, s), 12, Velocities)
        }),
        case("kinks 2-D", |s| {
            Case::of(&beyond(Shown::Planes { dim: 2, edge: 0.0 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("kinks 3-D", |s| {
            Case::of(&beyond(Shown::Planes { dim: 3, edge: 0.0 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("kinks 6-D", |s| {
            Case::of(&beyond(Shown::Planes { dim: 6, edge: 0.0 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("kinks 6-D, half free", |s| {
            Case::of(&beyond(Shown::Planes { dim: 6, edge: 0.0 }, ConstraintKind::HalfFree, 60, s), 60, Velocities)
        }),
        case("kinks 2-D, free", |s| {
            Case::of(&beyond(Shown::Planes { dim: 2, edge: 0.0 }, ConstraintKind::Free, 20, s), 20, Velocities)
        }),
        case("22 joints", |s| {
            Case::of(&beyond(Shown::Wells { dim: 22 }, ConstraintKind::Varying, 60, s), 60, Velocities)
        }),
        case("two goals", move |s| {
            let to = |at: f64| Own(2, move |x: &[f64]| vec![-0.1 * (x[0] - at), -0.1 * x[1]]);
            Case::of(&Plane::default().policies(&[&to(1.0), &to(-1.0)], s), 40, Velocities)
        }),
        case("two goals, free", move |s| {
            let to = |at: f64| Own(2, move |x: &[f64]| vec![-0.1 * (x[0] - at), -0.1 * x[1]]);
            Case::of(&free(fine()).policies(&[&to(1.0), &to(-1.0)], s), 40, Velocities)
        }),
        case("nothing but noise", move |s| {
            let mut rng = ChaCha8Rng::seed_from_u64(s);
            Case::of(&of_parabola(40, s), 40, Positions)
                .each(|e| e.positions.apply(|x| *x = rng.sample(StandardNormal)))
        }),
    ];
    all.extend(unseen::all());
    all.extend(in_the_way::all());
    all.extend(faulty_sensors::all());
    all
}
