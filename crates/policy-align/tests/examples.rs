//! The examples of the documentation: how they are generated, and checks of the statements about them.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fmt::Write as _;
use std::path::Path;

use demo_gen::ToySystem;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use running::{examples, run_in};

/// Seconds between samples of the toy recording; its policy is faster by this factor.
const TIME_STEP: f64 = 0.05;

/// The toy system: 40 movements down a parabola, each under changing constraints, rounded to a thousandth of a
/// millimetre.
fn toy() -> String {
    let recordings = ToySystem::default().record(&mut ChaCha8Rng::seed_from_u64(5)).unwrap();
    let mut text = "episode,t,x,y,vx,vy\n".to_owned();
    for (episode, recording) in recordings.iter().enumerate() {
        let velocities = recording.observed.velocities().unwrap() / TIME_STEP;
        for (sample, (x, u)) in recording.observed.states().column_iter().zip(velocities.column_iter()).enumerate() {
            let t = TIME_STEP * sample as f64;
            let _ = writeln!(text, "{episode},{t:.2},{:.6},{:.6},{:.6},{:.6}", x[0], x[1], u[0], u[1]);
        }
    }
    text
}

/// Names of the rails, with three movements each, all in one bowl.
const RAILS: [&str; 4] = ["north", "east", "slope", "ramp"];

/// π = −2 x per second along constant rails, in closed form, with the rails' names.
fn rails() -> String {
    let mut text = "episode,t,x,y,vx,vy,constraint\n".to_owned();
    for episode in 0..3 * RAILS.len() {
        let (k, rail) = (episode as f64, episode % RAILS.len());
        let angle = 0.4 + std::f64::consts::FRAC_PI_4 * rail as f64;
        let along = [angle.cos(), angle.sin()];
        let start = [2.0 * (1.7 * k).cos(), 2.0 * (2.3 * k + 0.5).sin()];
        let far = along[0] * start[0] + along[1] * start[1];
        for sample in 0..25 {
            let t = TIME_STEP * f64::from(sample);
            let left = (-2.0 * t).exp();
            let [x, y] = [0, 1].map(|axis| start[axis] + along[axis] * far * (left - 1.0));
            let [u, v] = [0, 1].map(|axis| -2.0 * along[axis] * far * left);
            let _ = writeln!(text, "{episode},{t:.2},{x:.6},{y:.6},{u:.6},{v:.6},{}", RAILS[rail]);
        }
    }
    text
}

/// Velocity towards the movement's goal and away from a fixed hill, per second.
fn to_goal(x: [f64; 2], goal: [f64; 2]) -> [f64; 2] {
    let from = [x[0] - 0.2, x[1] + 0.3];
    let hill = 0.8 / 0.7 * (-(from[0] * from[0] + from[1] * from[1]) / 0.98).exp();
    [0, 1].map(|axis| goal[axis] - x[axis] + from[axis] * hill)
}

/// 32 movements along rails that change half way, each to a separate goal, in fine Euler steps.
fn goals() -> String {
    let mut text = "episode,t,x,y,vx,vy,goal_x,goal_y\n".to_owned();
    for episode in 0..32 {
        let k = f64::from(episode);
        let mut x = [1.5 * (1.7 * k).cos(), 1.5 * (2.3 * k + 0.5).sin()];
        let goal = [0.9 * (3.1 * k + 0.2).sin(), 0.9 * (1.3 * k + 1.0).cos()].map(|c| (c * 1000.0).round() / 1000.0);
        for sample in 0..30 {
            let angle = 0.9 * k + if sample < 15 { 0.0 } else { 1.1 };
            let along = [angle.cos(), angle.sin()];
            let velocity = |x: [f64; 2]| {
                let policy = to_goal(x, goal);
                let speed = along[0] * policy[0] + along[1] * policy[1];
                along.map(|n| speed * n)
            };
            let (t, [u, v]) = (0.1 * f64::from(sample), velocity(x));
            let [goal_x, goal_y] = goal;
            let _ = writeln!(text, "{episode},{t:.2},{:.6},{:.6},{u:.6},{v:.6},{goal_x:.3},{goal_y:.3}", x[0], x[1]);
            for _ in 0..50 {
                let v = velocity(x);
                x = [0, 1].map(|axis| x[axis] + 0.002 * v[axis]);
            }
        }
    }
    text
}

#[test]
fn the_recordings_are_made_by_seeds() {
    for (name, made) in [("toy.csv", toy()), ("rails.csv", rails()), ("goals.csv", goals())] {
        let stored = std::fs::read_to_string(examples().join(name)).unwrap();
        assert!(stored.len() <= 150_000);
        assert!(stored == made, "write {name} again: cargo test -p policy-align --test examples -- --ignored");
    }
}

#[test]
#[ignore = "writes docs/examples/toy.csv, rails.csv and goals.csv"]
fn write_the_recordings() {
    std::fs::write(examples().join("toy.csv"), toy()).unwrap();
    std::fs::write(examples().join("rails.csv"), rails()).unwrap();
    std::fs::write(examples().join("goals.csv"), goals()).unwrap();
}

/// The page with a session of the program.
const PAGE: &str = "../your-own-data.md";

/// The page with regenerated outputs of its console blocks, and every command with the outputs of the page and of the
/// program. A block is one command and its output.
fn replayed(page: &str, run: &dyn Fn(&str) -> String) -> (String, Vec<[String; 3]>) {
    let (mut fresh, mut sessions) = (String::new(), Vec::new());
    let mut rest = page;
    while let Some((before, block)) = rest.split_once("```console\n$ policy-align ") {
        let (command, block) = block.split_once('\n').unwrap();
        let (shown, after) = block.split_once("```").unwrap();
        let said = run(command);
        let _ = write!(fresh, "{before}```console\n$ policy-align {command}\n{said}```");
        sessions.push([command.to_owned(), shown.to_owned(), said]);
        rest = after;
    }
    assert!(!rest.contains("```console"), "a block begins with its command");
    (fresh + rest, sessions)
}

/// Whether outputs agree: same words, numbers within a hundredth or both nearly 0, any time of day. Machines round
/// differently, which also affects file sizes.
fn alike(found: &str, expected: &str) -> bool {
    let words = |text: &str| text.split_whitespace().map(ToOwned::to_owned).collect::<Vec<_>>();
    let (found, expected) = (words(found), words(expected));
    let number = |word: &str| word.trim_matches(|c: char| !c.is_ascii_digit() && c != '-').parse::<f64>().ok();
    let time = |word: &str| word.ends_with('Z') && word.starts_with("20");
    let same = |a: &String, b: &String| match (number(a), number(b)) {
        (Some(x), Some(y)) => (x - y).abs() <= (0.01 * x.abs().max(y.abs())).max(1e-4),
        _ => a == b || (time(a) && time(b)),
    };
    found.len() == expected.len() && found.iter().zip(&expected).all(|(a, b)| same(a, b))
}

/// `UPDATE_SESSION=1 cargo test -p policy-align --test examples` regenerates the outputs of the page.
#[test]
fn documented_session_is_reproduced() {
    let page = std::fs::read_to_string(examples().join(PAGE)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["toy.csv", "rails.csv", "wall.toml"] {
        std::fs::copy(examples().join(name), folder.path().join(name)).unwrap();
    }
    let run = |command: &str| {
        let ran = run_in(folder.path(), command);
        ran.out + &ran.err
    };
    let (fresh, sessions) = replayed(&page, &run);
    assert!(sessions.len() >= 6);
    if std::env::var_os("UPDATE_SESSION").is_some() {
        std::fs::write(examples().join(PAGE), fresh).unwrap();
    } else {
        for [command, shown, said] in sessions {
            assert!(
                alike(&said, &shown),
                "policy-align {command}\nsays\n{said}\nthe page says\n{shown}\nUPDATE_SESSION=1 writes it anew"
            );
        }
    }
    for written in ["toy.json", "toy.trust.html", "toy.svg", "toy.c"] {
        assert!(Path::new(&folder.path().join(written)).exists(), "{written}");
    }
}
