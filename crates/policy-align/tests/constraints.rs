//! Estimated constraints: on robots, in the channels, and as a file for roll-outs.

#![allow(clippy::unwrap_used)] // A failing test panics.
#![allow(clippy::print_stdout, reason = "the slow test prints what it measures")]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use demo_gen::{Parabola, RollOut, hand_jacobian};
use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::{DMatrix, DVector, Vector3};
use policy_align::constraints::PointConstraint;
use policy_align::gp::Acting;
use policy_align::kinematics::RobotModel;
use policy_align::{
    ConstraintOn, ConstraintSet, ConstraintStretch, FitOptions, Model, PrepareOptions, Prepared, Progress, TaskLinks,
    constraint_file, estimate_constraints, fit, prepare,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Samples under one constraint.
const HALF: usize = 30;

/// A chain of joints about alternating axes, 0.3 m apart; the last link is the hand.
fn arm(axes: &[&str]) -> String {
    let links = (0..axes.len()).map(|at| format!(r#"<link name="link{at}"/>"#)).collect::<Vec<_>>().concat();
    let name = |at: usize| if at == axes.len() { "hand".to_owned() } else { format!("link{at}") };
    let joint = |(at, axis): (usize, &&str)| {
        format!(
            r#"<joint name="q{at}" type="continuous"><parent link="{}"/><child link="{}"/><origin xyz="0.3 0 0.05"/>
               <axis xyz="{axis}"/></joint>"#,
            name(at),
            name(at + 1)
        )
    };
    let joints = axes.iter().enumerate().map(joint).collect::<Vec<_>>().concat();
    format!(
        r#"<robot name="arm">{links}<link name="hand"/><link name="tip"/>{joints}
           <joint name="tip" type="fixed"><parent link="hand"/><child link="tip"/><origin xyz="0.2 0 0"/></joint></robot>"#
    )
}

const SEVEN: [&str; 7] = ["0 0 1", "0 1 0", "1 0 0", "0 1 0", "0 0 1", "0 1 0", "1 0 0"];
const FOUR: [&str; 4] = ["0 0 1", "0 1 0", "0 1 0", "0 0 1"];

/// Euler steps per sample of an accurately integrated movement. The link leaves its plane by a two-hundredth of its deviation with one
/// step. With 20 steps the deviation would exceed the error of slopes.
const IN_TIME: usize = 200;

/// Movements of a robot whose link stays in a plane, in another one from the middle on; also returns the normals.
fn recorded(
    (urdf, link): (&str, &str),
    movements: usize,
    (noise, sub_steps): (f64, usize),
    seed: u64,
) -> (Recordings, Vec<[Vector3<f64>; 2]>) {
    let robot = RobotModel::from_urdf(urdf).unwrap();
    let (n, hand) = (robot.n_joints(), robot.chain(robot.link(link).unwrap()));
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let potential = Parabola { weight: 0.2, centre: DVector::from_fn(n, |k, _| 0.3 + 0.1 * k as f64) };
    let roll_out = RollOut { time_step: 0.1, n_samples: HALF + 1, sub_steps };
    let planar = urdf.contains("planar");
    let mut normals = Vec::new();
    let episode = |k: usize| {
        let mut start = DVector::from_fn(n, |_, _| rng.random_range(-1.2..1.2));
        let (mut states, mut velocities) = (DMatrix::zeros(n, 2 * HALF), DMatrix::zeros(n, 2 * HALF));
        normals.push([0, 1].map(|half| {
            let z = if planar { 0.0 } else { rng.random_range(-1.0..1.0) };
            let normal = Vector3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), z).normalize();
            let rows = DMatrix::from_row_slice(1, 3, normal.as_slice());
            let constraint = PointConstraint::new(rows, n, hand_jacobian(&robot, &hand)).unwrap();
            let recording = roll_out.record(&potential, &constraint, start.as_view()).unwrap();
            states.columns_mut(half * HALF, HALF).copy_from(&recording.observed.states().columns(0, HALF));
            let own = recording.observed.velocities().unwrap();
            velocities.columns_mut(half * HALF, HALF).copy_from(&own.columns(0, HALF));
            start = recording.observed.state(HALF).into_owned();
            normal
        }));
        let deviation = noise * velocities.norm() / ((2 * HALF * n) as f64).sqrt();
        velocities.apply(|u| *u += deviation * rng.sample::<f64, _>(rand_distr::StandardNormal));
        Episode {
            name: k.to_string(),
            source: Source::default(),
            times: Times::Even { step: 0.1, len: 2 * HALF },
            positions: states,
            velocities: Some(velocities),
            constraint: None,
            context: DVector::zeros(0),
        }
    };
    let episodes = (0..movements).map(episode).collect();
    let channel = |joint: &policy_align::kinematics::Joint| Channel {
        name: joint.name().to_owned(),
        unit: Some("rad".to_owned()),
    };
    let state = robot.joints().iter().map(channel).collect();
    (Recordings { state, episodes, findings: vec![] }, normals)
}

fn learnt(recordings: &Recordings, max_rows: usize) -> (Model, Prepared) {
    let prepared = prepare(recordings, &PrepareOptions::default()).unwrap();
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () };
    let model = fit(&prepared, &FitOptions { max_rows, ..FitOptions::default() }, &mut progress).unwrap();
    let prepared = prepare(recordings, &PrepareOptions { scale: model.scale(), ..PrepareOptions::default() }).unwrap();
    (model, prepared)
}

/// Counts of true stretches found on the link, with normals within 1 and within 5 degrees; and of switches within two samples.
fn counted(found: &[ConstraintStretch], normals: &[[Vector3<f64>; 2]], link: &str) -> [usize; 4] {
    let mut counts = [0; 4];
    for (k, pair) in normals.iter().enumerate() {
        let own: Vec<&ConstraintStretch> = found.iter().filter(|stretch| stretch.episode == k.to_string()).collect();
        counts[3] += usize::from(own.iter().any(|stretch| stretch.samples.0.abs_diff(HALF) <= 2));
        for (half, normal) in pair.iter().enumerate() {
            let middle = half * HALF + HALF / 2;
            let at = own.iter().find(|stretch| (stretch.samples.0..=stretch.samples.1).contains(&middle));
            let Some(stretch) = at.filter(|stretch| stretch.acting == Acting::Constraint) else { continue };
            if stretch.on != ConstraintOn::Position(link.to_owned()) || stretch.normals.len() != 1 {
                continue;
            }
            let off = Vector3::from_column_slice(&stretch.normals[0]).cross(normal).norm().min(1.0).asin().to_degrees();
            counts[0] += 1;
            counts[1] += usize::from(off <= 1.0);
            counts[2] += usize::from(off <= 5.0);
        }
    }
    counts
}

/// Planes kept by the tip of a four-joint arm are named, and a roll-out reads them.
#[test]
fn planes_of_a_gripper_are_named_and_repeated() {
    let urdf = arm(&FOUR);
    let (recordings, normals) = recorded((&urdf, "tip"), 12, (0.0, 1), 1);
    let (model, prepared) = learnt(&recordings, 150);
    let links = TaskLinks::from_urdf(&urdf, &[], &model.channels()).unwrap();
    let found = estimate_constraints(&model, &prepared, Some(&links)).unwrap();
    let [on_link, near, _, switches] = counted(&found, &normals, "tip");
    assert!(near >= 22 && on_link >= 22 && switches >= 11, "{on_link}, {near} of 24, {switches} of 12");
    let stretch = &found[0];
    assert!(stretch.in_words(&model.state).starts_with("tip: "), "{}", stretch.in_words(&model.state));
    assert!(stretch.levels[0].is_some() && stretch.speeds[0] == 0.0 && stretch.angle < 1.0);

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), &urdf).unwrap();
    let own: Vec<&ConstraintStretch> = found.iter().filter(|stretch| stretch.episode == "0").collect();
    let text = constraint_file(&own, &model.state, Some("arm.urdf"));
    let set = ConstraintSet::from_toml(&text, &model.channels(), folder.path()).unwrap();
    let start = recordings.episodes[0].positions.column(0).into_owned();
    let roll_out = policy_align::RollOut { constraints: set, seconds: Some(2.0), ..policy_align::RollOut::default() };
    let path = roll_out.follow(&model, &start).unwrap();
    assert!(path.broken_by.unwrap().0 < 1e-3);
    let (last, recorded) = (path.states.column(20), recordings.episodes[0].positions.column(20));
    assert!((last - recorded).norm() < 0.1 * (recorded - start).norm());
}

/// Constraints in the channels: rows, levels and words are in the units of the recording, whatever the scale.
#[test]
fn channels_have_their_own_units() {
    let file = Path::new("../../docs/examples/toy.csv");
    let recordings = demo_io::read(file, &demo_io::ReadOptions::default(), &mut |_| ()).unwrap();
    let (model, prepared) = learnt(&recordings, 100);
    let plain = estimate_constraints(&model, &prepared, None).unwrap();
    let mut other = recordings.clone();
    for episode in &mut other.episodes {
        episode.positions.row_mut(1).apply(|y| *y *= 10.0);
        episode.velocities.iter_mut().for_each(|velocities| velocities.row_mut(1).apply(|y| *y *= 10.0));
    }
    let options = PrepareOptions { scale: vec![("y".to_owned(), 0.1)], ..PrepareOptions::default() };
    let prepared = prepare(&other, &options).unwrap();
    let model = Model { state: prepared.state.clone(), ..model };
    let scaled = estimate_constraints(&model, &prepared, None).unwrap();
    assert_eq!(plain.len(), 80);
    assert_eq!(plain.len(), scaled.len());
    for (plain, scaled) in plain.iter().zip(&scaled) {
        assert_eq!((plain.samples, plain.acting), (scaled.samples, Acting::Constraint));
        let expected = DVector::from_vec(vec![plain.normals[0][0], plain.normals[0][1] / 10.0]);
        let found = DVector::from_vec(scaled.normals[0].clone());
        assert!((&found - expected.normalize()).norm() < 1e-6, "{found} {expected}");
        let level = plain.levels[0].unwrap() / expected.norm();
        assert!((scaled.levels[0].unwrap() - level).abs() < 1e-6 * (1.0 + level.abs()));
    }
    assert!(constraint_file(&[&plain[0]], &model.state, None).contains("normal = [["));
}

/// In a recording with a label for every sample, stretches have one label each and keep it.
#[test]
fn named_constraints_keep_their_names() {
    let file = Path::new("../../docs/examples/toy.csv");
    let mut recordings = demo_io::read(file, &demo_io::ReadOptions::default(), &mut |_| ()).unwrap();
    let name = |episode: usize, sample: usize| ["rail", "", "wall"][(episode + sample / 20) % 3];
    for (k, episode) in recordings.episodes.iter_mut().enumerate() {
        episode.constraint = motion::Labels::of_samples((0..40).map(|sample| name(k, sample)));
    }
    let (model, prepared) = learnt(&recordings, 100);
    let found = estimate_constraints(&model, &prepared, None).unwrap();
    assert_eq!(found.len(), 80);
    for (at, stretch) in found.iter().enumerate() {
        let (episode, first) = (at / 2, 20 * (at % 2));
        assert_eq!((stretch.samples, stretch.acting), ((first, first + 19), Acting::Constraint));
        assert_eq!(stretch.label.as_deref().unwrap_or_default(), name(episode, first));
    }
}

/// Invalid input is refused in one sentence.
#[test]
fn wrong_robots_are_refused() {
    let channels = ["q0", "q1", "q2", "q3"].map(str::to_owned);
    let refused =
        |urdf: &str, links: &[String], channels: &[String]| TaskLinks::from_urdf(urdf, links, channels).unwrap_err();
    assert!(refused("<robot", &[], &channels).len() > 10);
    assert!(refused(&arm(&FOUR), &["claw".to_owned()], &channels).contains("claw"));
    assert!(refused(&arm(&FOUR), &[], &channels[..3]).contains("q3"));
}

/// With 5 % of noise on velocities, positions determine the plane and its switch: for movements in Euler steps, accurately integrated
/// ones, and ones that keep the plane less exactly.
#[test]
fn noisy_velocities_leave_planes_to_positions() {
    let urdf = arm(&FOUR);
    for sub_steps in [1, 20, IN_TIME] {
        let (recordings, normals) = recorded((&urdf, "tip"), 20, (0.05, sub_steps), 1);
        let (model, prepared) = learnt(&recordings, 200);
        let links = TaskLinks::from_urdf(&urdf, &[], &model.channels()).unwrap();
        let found = estimate_constraints(&model, &prepared, Some(&links)).unwrap();
        let [on_link, _, near, switches] = counted(&found, &normals, "tip");
        assert!(near >= 36 && on_link >= 36 && switches >= 18, "{on_link}, {near} of 40, {switches} of 20");
        assert!(found.len() <= 44, "{} stretches for 40, {sub_steps} Euler steps a sample", found.len());
    }
}

/// Prints the estimates for three robots.
#[test]
#[ignore = "a measurement of minutes; prints"]
fn measured() {
    let three = std::fs::read_to_string("../../robots/planar_three_link.urdf").unwrap();
    for (name, urdf, link, movements) in [
        ("7 joints", arm(&SEVEN), "tip", 40),
        ("4 joints", arm(&FOUR), "tip", 40),
        ("planar, 3 joints", three, "hand", 40),
    ] {
        for (noise, sub_steps) in [(0.0, 1), (0.0, IN_TIME), (0.05, 1), (0.05, 20), (0.05, IN_TIME)] {
            let (mut all, mut sum, mut error, mut stretches) = (0, [0; 4], 0.0_f64, 0);
            for seed in 1..=std::env::var("SEEDS").map_or(5, |seeds| seeds.parse().unwrap()) {
                let (recordings, normals) = recorded((&urdf, link), movements, (noise, sub_steps), seed);
                let (model, prepared) = learnt(&recordings, 400);
                error = error.max(model.trust.numbers.expected_error);
                let links = TaskLinks::from_urdf(&urdf, &[link.to_owned()], &model.channels()).unwrap();
                let found = estimate_constraints(&model, &prepared, Some(&links)).unwrap();
                all += 2 * normals.len();
                stretches += found.len();
                let counts = counted(&found, &normals, link);
                sum.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
                if seed == 1 {
                    for stretch in found.iter().take(4) {
                        println!("  {:?} {} ± {:.3}°", stretch.samples, stretch.in_words(&model.state), stretch.angle);
                    }
                }
            }
            let percent = |part: usize, of: usize| 100.0 * part as f64 / of as f64;
            println!(
                "{name}, noise {noise}, {sub_steps} Euler steps a sample: on the link {:.0} %, within 1° {:.0} %, 5° {:.0} %, switches {:.0} %, {:.2} stretches for one (expected error {error:.1e})",
                percent(sum[0], all),
                percent(sum[1], all),
                percent(sum[2], all),
                percent(sum[3], all / 2),
                stretches as f64 / all as f64
            );
        }
    }
}
