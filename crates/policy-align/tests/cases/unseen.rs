//! Faults that recordings do not show, or only under special checks: presses, limits, lags, orientations, goals.

use std::f64::consts::TAU;

use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::{DMatrix, DVector, Quaternion, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::{Case, FRESH, Named};

pub(super) const COUNT: usize = 40;
const SAMPLES: usize = 50;
const STEP: f64 = 0.05;
/// Euler steps between two samples.
const SUB_STEPS: usize = 10;
/// Number of samples after which constraints change.
const PHASE: usize = 25;

type Vector = DVector<f64>;
type Random = ChaCha8Rng;
/// The policy of a movement as a function of time and state, and the velocity with which the robot executes it.
pub(super) type Taught = (Box<dyn Fn(f64, &Vector) -> Vector>, Box<dyn Fn(f64, &Vector) -> Vector>);

/// A bumpy bowl: −∇(½|x|² + 0.4 Σ sin aₖᵀx).
fn bowl(x: &Vector) -> Vector {
    let waves = [[1.2, 0.9, 0.3], [-0.8, 1.1, 0.7], [0.3, -0.6, 1.3]];
    let mut policy = -x;
    for wave in &waves[..x.len()] {
        let wave = Vector::from_column_slice(&wave[..x.len()]);
        policy -= &wave * (0.4 * wave.dot(x).cos());
    }
    policy
}

/// Typical magnitude of the bowl's policy where movements begin.
const USUAL: f64 = 1.7;

pub(super) fn normal(dim: usize, rng: &mut Random) -> Vector {
    DVector::from_fn(dim, |_, _| rng.sample::<f64, _>(StandardNormal)).normalize()
}

/// `n` rotated by up to `most` radians.
fn tilted(n: &Vector, most: f64, rng: &mut Random) -> Vector {
    let across = normal(n.len(), rng);
    let across = (&across - n * n.dot(&across)).normalize();
    let angle = most * rng.random_range(-1.0..1.0);
    n * f64::cos(angle) + across * angle.sin()
}

/// Blocks `n`, along which the robot moves with `push` instead.
pub(super) fn pressed(n: &Vector, push: f64, policy: &Vector) -> Vector {
    policy + n * (push - n.dot(policy))
}

/// Random normals, one per phase.
fn normals(dim: usize, rng: &mut Random) -> impl Fn(f64) -> Vector + use<> {
    let normals: Vec<Vector> = (0..SAMPLES.div_ceil(PHASE)).map(|_| normal(dim, rng)).collect();
    move |time| normals[((time / STEP + 1e-6) as usize / PHASE).min(normals.len() - 1)].clone()
}

/// A movement: states, the robot's velocities and the policy's, each (n, N).
pub(super) fn movement(start: Vector, (policy, robot): &Taught) -> [DMatrix<f64>; 3] {
    let (mut x, mut columns) = (start, [Vec::new(), Vec::new(), Vec::new()]);
    for i in 0..SAMPLES {
        let time = |sub: usize| STEP * (i as f64 + sub as f64 / SUB_STEPS as f64);
        for (column, value) in columns.iter_mut().zip([x.clone(), robot(time(0), &x), policy(time(0), &x)]) {
            column.push(value);
        }
        for sub in 0..SUB_STEPS {
            x += robot(time(sub), &x) * (STEP / SUB_STEPS as f64);
        }
    }
    columns.map(|columns| DMatrix::from_columns(&columns))
}

/// Movements of `dim` channels from starts in a cube; `teach` may return another policy for each movement.
fn taught(dim: usize, seed: u64, mut teach: impl FnMut(usize, &mut Random) -> Taught) -> Case {
    let mut rng = Random::seed_from_u64(seed);
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|at| {
            let start = DVector::from_fn(dim, |_, _| rng.random_range(-1.8..1.8));
            movement(start, &teach(at, &mut rng))
        })
        .collect();
    of_movements(&["x", "y", "z"][..dim], &movements)
}

pub(super) fn of_movements(names: &[&str], movements: &[[DMatrix<f64>; 3]]) -> Case {
    let (shown, fresh) = movements.split_at(COUNT);
    let episode = |(at, [states, velocities, _]): (usize, &[DMatrix<f64>; 3])| Episode {
        name: (at + 1).to_string(),
        source: Source { file: "case".to_owned(), records: None },
        times: Times::Even { step: STEP, len: SAMPLES },
        positions: states.clone(),
        velocities: Some(velocities.clone()),
        constraint: None,
        context: DVector::zeros(0),
    };
    let all = |of: usize| DMatrix::from_columns(&fresh.iter().flat_map(|m| m[of].column_iter()).collect::<Vec<_>>());
    let state = names.iter().map(|&name| Channel { name: name.to_owned(), unit: None }).collect();
    let episodes = shown.iter().enumerate().map(episode).collect();
    Case {
        recordings: Recordings { state, episodes, findings: Vec::new() },
        states: all(0),
        actions: all(2),
        units: DVector::repeat(names.len(), 1.0),
        seconds: 1.0,
    }
}

/// The bowl, under changing constraints; `robot` computes its velocity from the constrained one.
fn executed(dim: usize, seed: u64, robot: impl Fn(&Vector, &Vector) -> Vector + Clone + 'static) -> Case {
    taught(dim, seed, |_, rng| {
        let (normals, robot) = (normals(dim, rng), robot.clone());
        (
            Box::new(|_, x| bowl(x)),
            Box::new(move |t, x| {
                let (n, policy) = (normals(t), bowl(x));
                robot(&n, &policy)
            }),
        )
    })
}

/// Movements pressed along normals within `tilt` radians of a common one.
fn wiping(dim: usize, tilt: f64, seed: u64) -> Case {
    let mut about = None;
    taught(dim, seed, |_, rng| {
        let about = about.get_or_insert_with(|| normal(dim, rng));
        let n = tilted(about, tilt, rng);
        (Box::new(|_, x| bowl(x)), Box::new(move |_, x| pressed(&n, 0.3 * USUAL, &bowl(x))))
    })
}

fn limited(policy: Vector, limit: f64) -> Vector {
    let speed = policy.norm();
    if speed > limit { policy * (limit / speed) } else { policy }
}

/// Velocities recorded `samples` later, or earlier, than the states.
fn late(case: Case, samples: isize) -> Case {
    case.each(|episode| {
        let written = episode.velocities.clone().expect("recorded");
        let at = |i: usize| i.saturating_add_signed(-samples).min(SAMPLES - 1);
        episode.velocities = Some(DMatrix::from_fn(written.nrows(), SAMPLES, |axis, i| written[(axis, at(i))]));
    })
}

/// Goals on a circle, in turn.
fn goals(dim: usize, count: usize, seed: u64, constrained: bool) -> Case {
    taught(dim, seed, |at, rng| {
        let angle = TAU * (at % count) as f64 / count as f64;
        let goal = DVector::from_fn(dim, |axis, _| 0.8 * [angle.cos(), angle.sin(), 0.0][axis]);
        let normals = normals(dim, rng);
        let policy = move |x: &Vector| bowl(&(x - &goal)) * 2.0;
        let robot = policy.clone();
        let blocked = move |t: f64, u: Vector| if constrained { pressed(&normals(t), 0.0, &u) } else { u };
        (Box::new(move |_, x| policy(x)), Box::new(move |t, x| blocked(t, robot(x))))
    })
}

/// Policy and constraint of a movement whose gain rises and falls with time.
fn gain(dim: usize, by: f64, seed: u64, constrained: bool) -> Case {
    taught(dim, seed, |_, rng| {
        let normals = normals(dim, rng);
        let policy = move |t: f64, x: &Vector| bowl(x) * (1.0 + by * (TAU * t / (SAMPLES as f64 * STEP)).sin());
        let blocked = move |t: f64, u: Vector| if constrained { pressed(&normals(t), 0.0, &u) } else { u };
        (Box::new(policy), Box::new(move |t, x| blocked(t, policy(t, x))))
    })
}

/// Policy and constraint of a movement towards an oscillating goal, or with a speed that falls with time.
fn timed(dim: usize, swings: bool, seed: u64) -> Case {
    taught(dim, seed, |_, rng| {
        let normals = normals(dim, rng);
        let duration = SAMPLES as f64 * STEP;
        let policy = move |t: f64, x: &Vector| {
            if swings {
                let goal = DVector::from_fn(dim, |axis, _| if axis == 0 { (3.0 * t / duration).sin() } else { 0.0 });
                bowl(&(x - goal))
            } else {
                bowl(x) * (-1.5 * t / duration).exp()
            }
        };
        (Box::new(policy), Box::new(move |t, x| pressed(&normals(t), 0.0, &policy(t, x))))
    })
}

/// A gripper rotates towards one orientation; constraints block rotation about some axis.
fn orientations(seed: u64, constrained: bool, flips: bool) -> Case {
    let mut rng = Random::seed_from_u64(seed);
    let rate = |q: &UnitQuaternion<f64>| -> Vector3<f64> { q.scaled_axis() * -1.2 };
    let dot = |q: &UnitQuaternion<f64>, w: Vector3<f64>| {
        let dot = q.into_inner() * Quaternion::from_imag(w) * 0.5;
        DVector::from_column_slice(dot.coords.as_slice())
    };
    let mut movements = Vec::new();
    for at in 0..COUNT + FRESH {
        let mut q = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| rng.random_range(-0.9..0.9)));
        let normals = normals(3, &mut rng);
        let blocked = |t: f64, w: Vector3<f64>| {
            let n = Vector3::from_column_slice(normals(t).as_slice());
            if constrained { w - n * n.dot(&w) } else { w }
        };
        let mut columns = [Vec::new(), Vec::new(), Vec::new()];
        let mut sign = 1.0;
        for i in 0..SAMPLES {
            let time = STEP * i as f64;
            // The first sample has the sign of the truth.
            if flips && at < COUNT && (at, i) != (0, 0) && (i == 0 || rng.random_bool(0.03)) {
                sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
            }
            let states = DVector::from_column_slice(q.coords.as_slice());
            for (column, value) in columns.iter_mut().zip([states, dot(&q, blocked(time, rate(&q))), dot(&q, rate(&q))])
            {
                column.push(value * sign);
            }
            for _ in 0..SUB_STEPS {
                let step = blocked(time, rate(&q)) * (STEP / SUB_STEPS as f64);
                q *= UnitQuaternion::from_scaled_axis(step);
            }
        }
        movements.push(columns.map(|columns| DMatrix::from_columns(&columns)));
    }
    of_movements(&["qx", "qy", "qz", "qw"], &movements)
}

/// The bowl on spheres about 0, with radius 1 or a different one for each movement, or on cylinders; half of the movements are also
/// under changing constraints.
fn on_surfaces(round: bool, one: bool, seed: u64) -> Case {
    let mut rng = Random::seed_from_u64(seed);
    let across = move |x: &Vector| DVector::from_vec(vec![x[0], x[1], if round { x[2] } else { 0.0 }]);
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|at| {
            let start = DVector::from_fn(3, |_, _| rng.random_range(-1.8..1.8));
            let off = if one { 1.0 / across(&start).norm() - 1.0 } else { 0.0 };
            let (start, normals) = (&start + across(&start) * off, normals(3, &mut rng));
            let robot = move |time: f64, x: &Vector| {
                let n = across(x).normalize();
                let own = normals(time);
                let own = (&own - &n * n.dot(&own)).normalize();
                let left = pressed(&n, 0.0, &bowl(x));
                if at % 2 == 0 { pressed(&own, 0.0, &left) } else { left }
            };
            movement(start, &(Box::new(|_, x| bowl(x)), Box::new(robot)))
        })
        .collect();
    of_movements(&["x", "y", "z"], &movements)
}

/// A policy is right below this error (nUPE). It is smaller than elsewhere, because these cases test whether a fault is named.
const RIGHT: f64 = 0.1;

pub(super) fn case(name: &'static str, make: impl Fn(u64) -> Case + Send + Sync + 'static) -> Named {
    Named { right: RIGHT, ..super::case(name, make) }
}

/// Removes recorded velocities.
fn positions_only(case: Case) -> Case {
    case.each(|episode| episode.velocities = None)
}

/// All cases.
pub(crate) fn all() -> Vec<Named> {
    let saturated = |share: f64| move |n: &Vector, u: &Vector| limited(pressed(n, 0.0, u), share * USUAL);
    let each_limited = |n: &Vector, u: &Vector| pressed(n, 0.0, u).map(|u| u.clamp(-0.5 * USUAL, 0.5 * USUAL));
    let plain = |n: &Vector, u: &Vector| pressed(n, 0.0, u);
    let rubbing = |n: &Vector, u: &Vector| {
        let u = pressed(n, 0.0, u);
        let speed = u.norm();
        &u * ((speed - 0.3).max(0.0) / speed.max(1e-12))
    };
    let leaking = |share: f64| move |n: &Vector, u: &Vector| pressed(n, share * n.dot(u), u);
    vec![
        case("pressed along one normal, 2-D", |s| wiping(2, 0.0, s)),
        case("pressed along one normal, 3-D", |s| wiping(3, 0.0, s)),
        case("pressed along one normal, 3-D, 5 % noise", |s| wiping(3, 0.0, s).velocity_noise(0.05, s)),
        case("pressed along one normal, 3-D, positions only", |s| positions_only(wiping(3, 0.0, s))),
        case("pressed, normals within 10 degrees, 2-D", |s| wiping(2, 10f64.to_radians(), s)),
        case("pressed, normals within 10 degrees, 3-D", |s| wiping(3, 10f64.to_radians(), s)),
        case("pressed, normals within 10 degrees, 3-D, 5 % noise", |s| {
            wiping(3, 10f64.to_radians(), s).velocity_noise(0.05, s)
        }),
        case("speed limit, 2-D", move |s| executed(2, s, saturated(0.5))),
        case("speed limit, 3-D", move |s| executed(3, s, saturated(0.8))),
        case("low speed limit, 3-D", move |s| executed(3, s, saturated(0.5))),
        case("speed limit, 3-D, positions only", move |s| positions_only(executed(3, s, saturated(0.7)))),
        case("speed limit, 3-D, 5 % noise", move |s| executed(3, s, saturated(0.6)).velocity_noise(0.05, s)),
        case("speed limit of each axis, 3-D", move |s| executed(3, s, each_limited)),
        case("velocities 100 ms late, 2-D", move |s| late(executed(2, s, plain), 2)),
        case("velocities 100 ms late, 3-D", move |s| late(executed(3, s, plain), 2)),
        case("velocities 300 ms late, 3-D", move |s| late(executed(3, s, plain), 6)),
        case("velocities 200 ms early, 3-D", move |s| late(executed(3, s, plain), -4)),
        case("quaternions, constrained", |s| orientations(s, true, false)),
        case("quaternions, constrained, signs mixed", |s| orientations(s, true, true)),
        case("quaternions, free, signs mixed", |s| orientations(s, false, true)),
        case("two goals, 3-D, constrained", |s| goals(3, 2, s, true)),
        case("two goals, 3-D, free", |s| goals(3, 2, s, false)),
        case("twenty goals, 2-D, constrained", |s| goals(2, 20, s, true)),
        case("twenty goals, 3-D, free", |s| goals(3, 20, s, false)),
        case("gain changes with time, 3-D, free", |s| gain(3, 0.6, s, false)),
        case("gain changes with time, 3-D, constrained", |s| gain(3, 0.6, s, true)),
        case("Coulomb friction, 2-D", move |s| executed(2, s, rubbing)),
        case("Coulomb friction, 3-D", move |s| executed(3, s, rubbing)),
        case("constraints that leak a tenth, 3-D", move |s| executed(3, s, leaking(0.1))),
        case("constraints that leak a third, 3-D", move |s| executed(3, s, leaking(0.3))),
        case("all on one sphere, 3-D", |s| on_surfaces(true, true, s)),
        case("all on one sphere, 3-D, 5 % noise", |s| on_surfaces(true, true, s).velocity_noise(0.05, s)),
        case("all on one cylinder, 3-D", |s| on_surfaces(false, true, s)),
        case("all on spheres about one centre, 3-D", |s| on_surfaces(true, false, s)),
        case("all on spheres about one centre, 3-D, positions only", |s| positions_only(on_surfaces(true, false, s))),
        case("a goal that swings, 2-D", |s| timed(2, true, s)),
        case("a goal that swings, 3-D", |s| timed(3, true, s)),
        case("speed falls with time, 2-D", |s| timed(2, false, s)),
        case("speed falls with time, 3-D", |s| timed(3, false, s)),
    ]
}
