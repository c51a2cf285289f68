//! Writes one data set of a generator of `demo_gen::tasks` and the slope GP's results on it, as JSON: the counterpart of
//! `benches/peers/compare_constraints.py`.
//!
//! usage: constraints_file GENERATOR SET DECIBELS \[ROWS\], with GENERATOR one of cycle, cycle-task, wiping, wiping-flat; DECIBELS the
//! signal-to-noise ratio of the velocities, or `none`; ROWS the program's --max-rows, by default 400.
//!
//! A list contains samples one after the other. `states`, `velocities` and, for an arm, `jacobians` (6 rows of n), `positions` and
//! `tool_axes` belong to the training movements, each with `samples` samples. `test_states` and `test_actions` are true states of
//! held-out movements, and the policy there. `ours` is the policy of the slope GP, `ours_with_robot` the one that it learns with
//! the arm's Jacobians; `…_facts` describe both fits.

use demo_gen::tasks::{Contact, CyclesWithTask, Wiping};
use demo_gen::{Recording, demonstrations, with_velocity_noise};
use gp::{FrontEnd, Rows, TaskSpace};
use kinematics::Workspace;
use motion::Policy;
use nalgebra::{DMatrix, DVectorView, Matrix6xX, Vector3};
use policy_align::FitOptions;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value, json};

/// Number of held-out movements at the end.
const FRESH: usize = 20;

#[allow(clippy::print_stdout)] // This program prints its results.
fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [generator, set, decibels, rest @ ..] = &words[..] else {
        panic!("usage: constraints_file GENERATOR SET DECIBELS [ROWS]")
    };
    let max_rows = rest.first().map_or(400, |rows| rows.parse().expect("ROWS is a whole number"));
    let mut rng = ChaCha8Rng::seed_from_u64(set.parse().expect("SET is a whole number"));
    let (recordings, arm) = record(generator, &mut rng);
    let (shown, fresh) = recordings.split_at(recordings.len() - FRESH);
    let shown = match decibels.as_str() {
        "none" => shown.to_vec(),
        decibels => with_velocity_noise(shown, decibels.parse().expect("DECIBELS is a number"), &mut rng)
            .expect("velocities were recorded"),
    };
    let states = columns(fresh.iter().map(|recording| &recording.truth.states));
    let demonstrations = demonstrations(&shown).expect("one state space");
    let mut written = Map::new();
    written.insert("samples".into(), json!(shown[0].truth.states.ncols()));
    written.insert("dim".into(), json!(states.nrows()));
    written.insert("states".into(), list(&columns(shown.iter().map(|recording| &recording.truth.states))));
    written.insert(
        "velocities".into(),
        list(&columns(demonstrations.trajectories().iter().filter_map(|of| of.velocities()))),
    );
    written.insert("test_actions".into(), list(&columns(fresh.iter().map(|recording| &recording.truth.actions))));
    let rows = FrontEnd::of_velocities(&demonstrations).rows(&demonstrations).expect("velocities were recorded");
    written.extend(ours("ours", &rows, &states, max_rows));
    written.insert("test_states".into(), list(&states));
    if let Some(arm) = arm {
        written.extend(kinematics_of(&arm, &shown));
        let rows = rows.with_task_spaces(task_spaces(&arm, &shown)).expect("a Jacobian of every sample");
        written.extend(ours("ours_with_robot", &rows, &states, max_rows));
    }
    println!("{}", Value::Object(written));
}

fn record(generator: &str, rng: &mut ChaCha8Rng) -> (Vec<Recording>, Option<Wiping>) {
    let cycles = |largest_task| {
        let system = CyclesWithTask::default();
        let n_trajectories = system.n_trajectories + FRESH;
        CyclesWithTask { largest_task, n_trajectories, ..system }
    };
    let wiping = |contact| {
        let mut system =
            Wiping::new(include_str!("../../../robots/seven_joint_arm.urdf"), contact).expect("a sound URDF");
        system.n_trajectories += FRESH;
        system
    };
    match generator {
        "cycle" => (cycles(0.0).record(rng).expect("sound settings"), None),
        "cycle-task" => (cycles(0.3).record(rng).expect("sound settings"), None),
        "wiping" | "wiping-flat" => {
            let arm = wiping(if generator == "wiping" { Contact::Height } else { Contact::Flat });
            (arm.record(rng).expect("sound settings"), Some(arm))
        }
        _ => panic!("no such generator: {generator}"),
    }
}

/// The policy that the program learns from the velocities, with the noise that it estimates.
fn ours(name: &str, rows: &Rows, states: &DMatrix<f64>, max_rows: usize) -> Map<String, Value> {
    let learner = FitOptions { max_rows, ..FitOptions::default() }.gaussian_processes();
    let fit = learner.fit(rows, &mut ChaCha8Rng::seed_from_u64(1)).expect("enough movements");
    let actions = DMatrix::from_columns(&states.column_iter().map(|state| fit.action(state)).collect::<Vec<_>>());
    let facts = json!({
        "reading": format!("{:?}", fit.reading()),
        "pushed": fit.slope().report().push,
        "space": fit.slope().report().task_space,
        "rows": fit.slope().report().rows,
        "inducing": fit.slope().report().inducing,
        "expected": fit.expected_nupe(),
    });
    [(name.to_owned(), list(&actions)), (format!("{name}_facts"), facts)].into_iter().collect()
}

/// Position, orientation, and both, of the tool, as in the program's `--robot`.
fn task_spaces(arm: &Wiping, shown: &[Recording]) -> Vec<TaskSpace> {
    let mut workspace = Workspace::new();
    let states = shown.iter().flat_map(|recording| recording.truth.states.column_iter());
    let jacobian = |state: DVectorView<'_, f64>| {
        let mut jacobian = Matrix6xX::zeros(state.len());
        arm.tool().jacobian(state, &mut workspace, &mut jacobian).expect("a state of the arm");
        jacobian
    };
    let jacobians: Vec<Matrix6xX<f64>> = states.map(jacobian).collect();
    let space = |first: usize, count: usize| {
        let rows = |of: &Matrix6xX<f64>| DMatrix::from_fn(count, of.ncols(), |row, joint| of[(first + row, joint)]);
        TaskSpace::of_jacobians(jacobians.iter().map(rows).collect())
    };
    vec![space(0, 3), space(3, 3), space(0, 6)]
}

/// Data that knowledge of the arm adds to its recordings.
fn kinematics_of(arm: &Wiping, shown: &[Recording]) -> Map<String, Value> {
    let (mut jacobians, mut positions, mut axes) = (Vec::new(), Vec::new(), Vec::new());
    let mut workspace = Workspace::new();
    for state in shown.iter().flat_map(|recording| recording.truth.states.column_iter()) {
        let mut jacobian = Matrix6xX::zeros(state.len());
        let pose = arm.tool().jacobian(state.as_view(), &mut workspace, &mut jacobian).expect("a state of the arm");
        jacobians.extend_from_slice(jacobian.transpose().as_slice());
        positions.extend_from_slice(pose.translation.vector.as_slice());
        axes.extend_from_slice((pose.rotation * Vector3::z()).as_slice());
    }
    [("jacobians", jacobians), ("positions", positions), ("tool_axes", axes)]
        .map(|(name, values)| (name.to_owned(), json!(values)))
        .into_iter()
        .collect()
}

fn columns<'a>(parts: impl Iterator<Item = &'a DMatrix<f64>>) -> DMatrix<f64> {
    let parts: Vec<_> = parts.collect();
    let all: Vec<DVectorView<'_, f64>> = parts.iter().flat_map(|part| part.column_iter()).collect();
    DMatrix::from_columns(&all)
}

fn list(matrix: &DMatrix<f64>) -> Value {
    json!(matrix.as_slice())
}
