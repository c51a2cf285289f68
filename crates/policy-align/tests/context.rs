//! Goals that differ between episodes: detected, learnt, required as input, and exported.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../../gp/tests/goals/mod.rs"]
mod goals;
mod running;

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use goals::{Attraction, Goals};
use motion::{Channel, Episode, Policy as _, Recordings, Source, Times, Trajectory, Verdict};
use nalgebra::{DMatrix, DVector, dvector};
use policy_align::{
    ContextError, ContextUse, FitOptions, Model, PrepareError, PrepareOptions, Progress, RollOut, RollOutError,
    Subject, fit, prepare, to_onnx,
};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use running::{examples, run_in};

/// A folder with `goals.csv` and, learnt once, `goals.json`.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::copy(examples().join("goals.csv"), folder.path().join("goals.csv")).unwrap();
        let ran = run_in(folder.path(), "fit goals.csv -o goals.json");
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.contains("good: all checks passed"), "{}", ran.out);
        folder
    });
    folder.path()
}

fn model() -> Model {
    Model::load(&folder().join("goals.json")).unwrap()
}

/// The policy of `goals.csv`.
fn truth(x: &DVector<f64>, goal: &DVector<f64>) -> DVector<f64> {
    let from = x - dvector![0.2, -0.3];
    goal - x + &from * (0.8 / 0.7 * (-from.norm_squared() / (2.0 * 0.49)).exp())
}

#[test]
fn goals_are_found_and_new_ones_reached() {
    let model = model();
    assert_eq!(model.context_names(), ["goal_x", "goal_y"]);
    assert_eq!(model.channels(), ["x", "y"]);
    let decision = model.decisions.iter().find(|decision| decision.what == Subject::Context).unwrap();
    assert_eq!((decision.value.as_str(), decision.flag.as_str()), ("goal_x, goal_y", "--context"));
    for goal in [dvector![0.5, -0.5], dvector![-0.7, 0.3]] {
        let there = model.in_context(&goal).unwrap();
        for x in [dvector![1.0, 0.2], dvector![-0.5, 0.9], dvector![0.1, -0.8]] {
            let error = (there.policy().action(x.as_view()) - truth(&x, &goal)).norm();
            assert!(error < 0.02, "{x} {goal} {error}");
            assert!(there.policy().is_supported(x.as_view()));
        }
    }
    let far = model.in_context(&dvector![9.0, 0.0]).unwrap();
    assert!(!far.policy().is_supported(dvector![0.1, 0.1].as_view()));
    // With an open context, the context follows the state.
    let [whole, there] = [model.clone(), model.in_context(&dvector![0.4, 0.1]).unwrap()];
    let action = whole.policy().action(dvector![0.3, 0.2, 0.4, 0.1].as_view());
    assert_eq!(action.rows(0, 2), there.policy().action(dvector![0.3, 0.2].as_view()));
    assert_eq!(action.rows(2, 2).norm(), 0.0);
}

#[test]
fn the_program_takes_a_context() {
    let ran = run_in(folder(), "predict goals.json --at 1.0,0.2 --context goal_x=0.5,goal_y=-0.5");
    assert!(ran.out.contains("within the data"), "{} {}", ran.out, ran.err);
    let ran = run_in(folder(), "predict goals.json --at 1.0,0.2 --context goal_x=50,goal_y=-0.5");
    assert!(ran.out.contains("outside the data"), "{} {}", ran.out, ran.err);
    let ran = run_in(folder(), "predict goals.json --at 1.0,0.2");
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("depends on goal_x, goal_y") && ran.err.contains("--context"), "{}", ran.err);
    for (context, what) in
        [("goal_x=1", "goal_y"), ("goal_x=1,goal_y=2,z=1", "no 'z'"), ("goal_x=nan,goal_y=1", "finite")]
    {
        let ran = run_in(folder(), &format!("predict goals.json --at 1.0,0.2 --context {context}"));
        assert_eq!(ran.code, Some(2), "{}", ran.out);
        assert!(ran.err.contains(what), "{}", ran.err);
    }
    std::fs::write(folder().join("states.csv"), "goal_y,x,y,goal_x\n-0.5,1.0,0.2,0.5\n").unwrap();
    let ran = run_in(folder(), "predict goals.json states.csv");
    assert!(
        ran.out.starts_with("x,y,goal_x,goal_y,u_x,u_y,potential,sd_x,sd_y,support,known\n1,0.2,0.5,-0.5,"),
        "{}",
        ran.out
    );
    let ran = run_in(folder(), "rollout goals.json --from 1.2,-1 --context goal_x=-0.6,goal_y=0.6 -o path.csv");
    assert!(ran.out.contains("at rest"), "{} {}", ran.out, ran.err);
    let ran = run_in(folder(), "rollout goals.json --from 1.2,-1");
    assert!(ran.code == Some(2) && ran.err.contains("--context"), "{}", ran.err);
    let ran = run_in(folder(), "plot goals.json -o goals.svg --context goal_x=0.5,goal_y=0.5");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let picture = std::fs::read_to_string(folder().join("goals.svg")).unwrap();
    assert!(picture.contains("Policy at goal_x 0.5, goal_y 0.5"));
    let ran = run_in(folder(), "info goals.json");
    assert!(ran.out.contains("context") && ran.out.contains("goal_x"), "{}", ran.out);
    let ran = run_in(folder(), "evaluate goals.json goals.csv --require 0.01");
    assert_eq!(ran.code, Some(0), "{} {}", ran.out, ran.err);
    let ran = run_in(folder(), "fit goals.csv -o aligned.json --learner policy-align");
    assert!(ran.code == Some(1) && ran.err.contains("goal_x, goal_y"), "{}", ran.err);
    let ran = run_in(folder(), "check goals.csv --context none --ignore goal_x,goal_y");
    assert!(!ran.out.lines().any(|line| line.starts_with("context")), "{}", ran.out);
}

#[test]
fn a_model_without_its_context_is_not_followed() {
    let names = vec!["goal_x".to_owned(), "goal_y".to_owned()];
    let start = dvector![0.5, 0.5];
    let refused = RollOut::default().follow(&model(), &start).unwrap_err();
    assert_eq!(refused, RollOutError::Context { names: names.clone() });
    let there = model().in_named_context(&[("goal_y".to_owned(), 0.3), ("goal_x".to_owned(), -0.4)]).unwrap();
    assert_eq!(there.open_context(), []);
    assert!(RollOut::default().follow(&there, &start).is_ok());
    let far = model().in_named_context(&[("goal_y".to_owned(), 0.3), ("goal_x".to_owned(), -40.0)]).unwrap();
    let refused = RollOut::default().follow(&far, &start).unwrap_err();
    assert!(
        matches!(&refused, RollOutError::ContextUnsupported { name, value: -40.0, .. } if name == "goal_x"),
        "{refused}"
    );
    let missing = model().in_named_context(&[("goal_y".to_owned(), 0.3)]).unwrap_err();
    assert_eq!(missing, ContextError::Missing { names });
}

/// Models with context are stored as version 2, so that programs without support for context refuse
/// them; the fixed context is not stored.
#[test]
fn models_in_context_are_stored() {
    let text = model().to_json().unwrap();
    assert!(text.contains("\"version\":2"));
    let there = model().in_context(&dvector![0.1, 0.2]).unwrap();
    assert_eq!(there.to_json().unwrap(), text);
}

/// Reads states with contexts; writes actions, the potential, and whether the states are supported.
const CALLER: &str = r#"
#include <stdio.h>
int policy(const double *x, const double *c, double *u, double *phi);
int main(void) {
    double x[2], c[2], u[2], phi; int known;
    while (scanf("%lf %lf %lf %lf", x, x + 1, c, c + 1) == 4) {
        known = policy(x, c, u, &phi);
        printf("%.17g %.17g %.17g %d\n", u[0], u[1], phi, known);
    }
    return 0;
}
"#;

#[test]
fn c_takes_the_context() {
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let (folder, model) = (tempfile::tempdir().unwrap(), model());
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("policy.c"), policy_align::CSource::default().of(&model).unwrap()).unwrap();
    std::fs::write(path("caller.c"), CALLER).unwrap();
    let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O1", "-o"];
    let sources = [path("policy.c"), path("caller.c")];
    let made = Command::new("cc").args(strict).arg(path("act")).args(sources).arg("-lm").output().unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    std::fs::write(path("states"), "0.3 -0.2 0.4 0.1\n1 1 -0.5 -0.5\n0.3 -0.2 40 0.1\n").unwrap();
    let stdin = std::fs::File::open(path("states")).unwrap();
    let ran = Command::new(path("act")).stdin(stdin).output().unwrap();
    let lines = String::from_utf8(ran.stdout).unwrap();
    let numbers: Vec<Vec<f64>> =
        lines.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    let policy = model.policy();
    for (state, numbers) in [dvector![0.3, -0.2, 0.4, 0.1], dvector![1.0, 1.0, -0.5, -0.5]].iter().zip(&numbers) {
        let action = policy.action(state.as_view());
        assert_eq!(numbers[3], 1.0);
        assert!((action[0] - numbers[0]).abs() < 1e-9 && (action[1] - numbers[1]).abs() < 1e-9, "{action} {numbers:?}");
        let potential = motion::LearntPolicy::potential(&policy).map(|potential| potential.value(state.as_view()));
        assert!(potential.is_none_or(|value| (value - numbers[2]).abs() < 1e-9), "{potential:?} {numbers:?}");
    }
    assert_eq!(numbers[2][..2], [0.0, 0.0]);
    assert_eq!(numbers[2][3], 0.0);
}

#[test]
fn onnx_has_a_second_input() {
    let bytes = to_onnx(&model()).unwrap();
    let has = |text: &[u8]| bytes.windows(text.len()).any(|part| part == text);
    assert!(has(b"Concat") && has(b"goal_x,goal_y"));
}

/// Twelve movements of `x` towards `goal`, with a channel of this name that contains the goal.
fn recordings(name: &str, goals: impl Fn(usize, usize) -> f64) -> Recordings {
    let episode = |k: usize| Episode {
        name: k.to_string(),
        source: Source::default(),
        times: Times::Even { step: 0.1, len: 20 },
        positions: DMatrix::from_fn(2, 20, |axis, i| match axis {
            0 => (k as f64).cos() * (-0.1 * i as f64).exp(),
            _ => goals(k, i),
        }),
        velocities: None,
        constraint: None,
        context: DVector::zeros(0),
    };
    let state = ["x", name].map(|name| Channel { name: name.to_owned(), unit: None });
    Recordings { state: state.to_vec(), episodes: (0..12).map(episode).collect(), findings: vec![] }
}

fn with(context: ContextUse) -> PrepareOptions {
    PrepareOptions { context, ..PrepareOptions::default() }
}

#[test]
fn only_channels_named_like_contexts_are_detected() {
    let of_episode = |k: usize, _: usize| k as f64;
    let names = |context: &[policy_align::StateChannel]| context.iter().map(|of| of.name.clone()).collect::<Vec<_>>();
    let found = prepare(recordings("load", of_episode), &PrepareOptions::default()).unwrap();
    assert_eq!((names(&found.state), names(&found.context)), (vec!["x".to_owned()], vec!["load".to_owned()]));
    assert_eq!((found.context[0].low, found.context[0].high), (0.0, 11.0));
    assert_eq!(found.demonstrations.trajectories()[3].context(), &dvector![3.0]);
    assert_eq!(found.demonstrations.dim(), 1);
    // An axis blocked by every constraint looks the same: it remains part of the state, and a remark
    // names the flag.
    let kept = prepare(recordings("y", of_episode), &PrepareOptions::default()).unwrap();
    assert_eq!((kept.demonstrations.dim(), kept.context.len()), (2, 0));
    assert!(kept.findings.iter().any(|of| of.next.contains("--context y") && of.verdict == Verdict::Good));
    let given = prepare(recordings("y", of_episode), &with(ContextUse::Named(vec!["y".to_owned()]))).unwrap();
    assert_eq!(names(&given.context), ["y"]);
    // A channel that moves, or is the same everywhere, is not context, whatever its name.
    for goals in [(|k, i| (k + i) as f64) as fn(usize, usize) -> f64, |_, _| 1.0] {
        assert!(prepare(recordings("goal", goals), &PrepareOptions::default()).unwrap().context.is_empty());
    }
    assert!(prepare(recordings("goal", of_episode), &with(ContextUse::Ignored)).unwrap().context.is_empty());
}

#[test]
fn few_contexts_are_doubted() {
    let doubted = |goals: usize| {
        let prepared = prepare(recordings("goal", |k, _| (k % goals) as f64), &PrepareOptions::default()).unwrap();
        let of = prepared.findings.iter().find(|of| of.what.contains("different context")).unwrap();
        (of.verdict, of.what.clone())
    };
    assert_eq!(doubted(3).0, Verdict::Doubtful);
    assert!(doubted(10).1.contains("that other movements had") && doubted(12).1.contains("new contexts"));
}

#[test]
fn invalid_contexts_are_refused() {
    let refused = |name: &str, goals: fn(usize, usize) -> f64| {
        let error = prepare(recordings("y", goals), &with(ContextUse::Named(vec![name.to_owned()]))).unwrap_err();
        assert!(matches!(error, PrepareError::Context { .. }), "{error}");
        error.to_string()
    };
    assert!(refused("z", |k, _| k as f64).contains("x, y"));
    assert!(refused("y", |k, i| (k + i) as f64).contains("episode '0'"));
}

/// These movements are unconstrained, although their goals differ.
#[test]
fn no_constraint_is_found_where_only_goals_differ() {
    let ran = run_in(folder(), "constraints goals.json goals.csv --json");
    assert_eq!(ran.code, Some(0), "{} {}", ran.out, ran.err);
}

/// Properties of the recordings of goals.
#[derive(Debug, Clone, Copy, Default)]
struct Recorded {
    /// Noise of velocities, as a share of their root mean square.
    speed_noise: f64,
    /// Noise of positions, as a share of their standard deviation.
    position_noise: f64,
    /// Whether velocities are omitted.
    positions_only: bool,
    /// Unit of x, with its velocity and goal.
    unit: f64,
}

/// Recordings of movements towards goals; the last channels are the goals.
fn recorded(goals: &Goals, movements: usize, seed: u64, how: Recorded) -> Recordings {
    let shown = goals.movements(movements, seed);
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x7e);
    let rms = |of: &dyn Fn(&Trajectory) -> f64| {
        let trajectories = shown.trajectories();
        (trajectories.iter().map(of).sum::<f64>() / (shown.n_samples() * goals.dim) as f64).sqrt()
    };
    let speed = rms(&|of| of.velocities().unwrap().norm_squared());
    let spread = rms(&|of| of.states().norm_squared());
    let mut noisy =
        |of: &DMatrix<f64>, deviation: f64| of.map(|x| x + deviation * rng.sample::<f64, _>(StandardNormal));
    let units = |mut of: DMatrix<f64>| {
        of.row_mut(0).scale_mut(how.unit);
        of
    };
    let episode = |(at, of): (usize, &Trajectory)| {
        let states = units(noisy(of.states(), how.position_noise * spread));
        let velocities = units(noisy(of.velocities().unwrap(), how.speed_noise * speed));
        let goal = units(DMatrix::from_fn(goals.dim, of.n_samples(), |axis, _| of.context()[axis]));
        let both = |upper: &DMatrix<f64>, lower: &DMatrix<f64>| {
            DMatrix::from_fn(2 * goals.dim, of.n_samples(), |row, i| match row.checked_sub(goals.dim) {
                None => upper[(row, i)],
                Some(row) => lower[(row, i)],
            })
        };
        Episode {
            name: at.to_string(),
            source: Source::default(),
            times: Times::Even { step: of.time_step(), len: of.n_samples() },
            positions: both(&states, &goal),
            velocities: (!how.positions_only).then(|| both(&velocities, &(goal * 0.0))),
            constraint: None,
            context: DVector::zeros(0),
        }
    };
    let names = ["x", "y", "z"].iter().take(goals.dim).map(ToString::to_string);
    let goal_names = ["x", "y", "z"].iter().take(goals.dim).map(|name| format!("goal_{name}"));
    let state = names.chain(goal_names).map(|name| Channel { name, unit: None }).collect();
    Recordings { state, episodes: shown.trajectories().iter().enumerate().map(episode).collect(), findings: vec![] }
}

/// nUPE on movements towards new goals, without noise, in the units of the truth.
fn error_at_new_goals(model: &Model, goals: &Goals, unit: f64, seed: u64) -> f64 {
    let (mut learnt, mut truth) = (Vec::new(), Vec::new());
    let units = |x: &DVector<f64>, unit: f64| {
        DVector::from_fn(x.len(), |axis, _| if axis == 0 { unit * x[0] } else { x[axis] })
    };
    for movement in goals.movements(20, 1000 + seed).trajectories() {
        let goal = movement.context();
        let there = model.in_context(&units(goal, unit)).unwrap();
        for x in movement.states().column_iter().step_by(5) {
            let x = x.into_owned();
            learnt.push(units(&there.policy().action(units(&x, unit).as_view()), 1.0 / unit));
            truth.push(goals.policy(&x, goal));
        }
    }
    metrics::nupe(&DMatrix::from_columns(&truth), &DMatrix::from_columns(&learnt)).unwrap()
}

/// The program's errors with goals, for recordings with noise and in wrong units.
#[test]
#[ignore = "a hundred fits: minutes of a release build; prints the table of docs/decisions/gp.md"]
#[allow(clippy::print_stdout, reason = "it prints a table")]
fn new_goals_are_reached_through_noise_and_units() {
    let plain = Recorded { unit: 1.0, ..Recorded::default() };
    let noisy = Recorded { speed_noise: 0.05, ..plain };
    let positions = Recorded { positions_only: true, ..plain };
    for (name, how) in [
        ("clean", plain),
        ("5 % noise of velocities", noisy),
        ("5 % noise of both", Recorded { position_noise: 0.05, ..noisy }),
        ("positions", positions),
        ("positions with 1 %", Recorded { position_noise: 0.01, ..positions }),
        ("positions with 5 %", Recorded { position_noise: 0.05, ..positions }),
        ("x times 5", Recorded { unit: 5.0, ..plain }),
        ("x times 57", Recorded { unit: 57.0, ..plain }),
        ("x times 5, 5 % noise of velocities", Recorded { unit: 5.0, ..noisy }),
    ] {
        for (dim, attraction, count) in [
            (2, Attraction::Quadratic, 20),
            (2, Attraction::Well, 40),
            (3, Attraction::Quadratic, 40),
            (3, Attraction::Well, 40),
        ] {
            let goals = Goals { dim, attraction };
            let mut fitted = |seed| {
                let prepared = prepare(recorded(&goals, count, seed, how), &PrepareOptions::default()).unwrap();
                let options = FitOptions { seed, ..FitOptions::default() };
                let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () };
                let model = fit(&prepared, &options, &mut progress).unwrap();
                let error = error_at_new_goals(&model, &goals, how.unit, seed);
                let (verdict, numbers, scales) = (model.trust.verdict, &model.trust.numbers, model.scales());
                assert!(verdict != Verdict::Good || error < 0.06, "{name}: {error}");
                assert!(numbers.expected_error > error / 10.0 && (dim == 3 || error < 0.1), "{name}: {error}");
                assert!((scales[1] / scales[0] / how.unit).ln().abs() < 0.25, "{name}: {scales}");
                format!("{error:.1e} {verdict:?}, expected {:.1e}", numbers.expected_error)
            };
            println!("{name}\t{dim}-D {attraction:?}, {count}\t{}", [1, 2, 3].map(&mut fitted).join("\t"));
        }
    }
}

/// If a context is missing or has no effect, the error says so, with numbers to paste.
#[test]
fn a_context_that_is_missing_or_of_no_use_is_named() {
    for (line, what) in [
        ("rollout goals.json --from 1.2,-1", "the policy depends on goal_x, goal_y: a number is needed for each"),
        ("export goals.json --to mcap", "the policy depends on goal_x, goal_y: a number is needed for each"),
        ("export goals.json --to mcap --context goal_x=0.1", "the context needs a number for each of goal_x, goal_y"),
    ] {
        let ran = run_in(folder(), line);
        let place = if line.contains("goal_x") { "--context\n" } else { "--context, which is not given\n" };
        assert!(ran.code == Some(2) && ran.err.contains(what) && ran.err.contains(place), "{line}: {}", ran.err);
        let flag = &ran.err[ran.err.rfind("--context").unwrap()..];
        let again = run_in(
            folder(),
            &format!("{} {}", line.replace(" --context goal_x=0.1", ""), flag.trim().replace('\'', "")),
        );
        assert_eq!(again.code, Some(0), "{flag}: {}", again.err);
    }
    let ran = run_in(folder(), "export goals.json --to c --context goal_x=0.1,goal_y=0");
    assert!(ran.code == Some(2) && ran.err.contains("takes its context as an input"), "{}", ran.err);
}
