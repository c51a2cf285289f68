//! `serve` without a robot; crates/policy-align-py/tests/test_ros2.py tests it with one.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[cfg(feature = "ros2")]
mod models;
mod running;

use running::run;

#[test]
fn the_help_fits_a_terminal() {
    let help = run("serve --help");
    assert_eq!((help.code, help.err.as_str()), (Some(0), ""));
    assert!(help.out.lines().all(|line| line.chars().count() <= 80), "{}", help.out);
    assert!(run("--help").out.contains("Command a robot of ROS 2 by a policy"));
}

#[cfg(not(feature = "ros2"))]
#[test]
fn a_build_without_ros_2_names_the_feature() {
    let ran = run("serve toy.json --ros2 --rate 20");
    assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""));
    let lines = [
        "error: this program was built without ROS 2",
        "  in:  policy-align serve toy.json --ros2 --rate 20",
        "  try: cargo install --path crates/policy-align --features ros2",
    ];
    assert_eq!(ran.err.lines().collect::<Vec<_>>(), lines);
}

#[cfg(feature = "ros2")]
mod with_ros_2 {
    use std::time::Instant;

    use policy_align::Verdict;

    use super::models::{direct, toy};
    use super::running::{run, run_in};

    #[test]
    fn the_example_runs_and_stands_without_a_robot() {
        let help = run("serve --help").out;
        let example = help.lines().last().unwrap().trim().strip_prefix("policy-align ").unwrap();
        let ran = run(example);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        let lines = ["/joint_states → /velocity_controller/commands: x, y", "stopped: no joint state received"];
        assert_eq!(ran.err.lines().collect::<Vec<_>>(), lines);
        assert!(ran.out.starts_with("commands     ") && ran.out.lines().count() == 1, "{}", ran.out);
    }

    #[test]
    fn the_rate_is_kept_and_the_end_is_not_late() {
        let start = Instant::now();
        let ran = run("serve toy.json --ros2 --rate 0.001 --stale 2000 --seconds 0.3 --json");
        assert!((0.3..20.0).contains(&start.elapsed().as_secs_f64()));
        let last: serde_json::Value = serde_json::from_str(ran.out.lines().last().unwrap()).unwrap();
        assert_eq!((&last["commands"], &last["zero"]), (&1.into(), &1.into()), "{}", ran.out);
    }

    #[test]
    fn a_model_not_to_be_used_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mut model = direct(&toy(3, 4));
        model.trust.verdict = Verdict::DoNotUse;
        model.trust.findings[0].verdict = Verdict::DoNotUse;
        model.save(&folder.path().join("m.json")).unwrap();
        let ran = run_in(folder.path(), "serve m.json --ros2 --seconds 0.1");
        let lines = [
            "error: the verdict on the model is \"do not use\"",
            "  in:  m.json",
            "  try: policy-align info m.json, which says why; --force commands the robot anyway",
        ];
        assert_eq!((ran.code, ran.err.lines().collect::<Vec<_>>()), (Some(1), lines.to_vec()));
        assert_eq!(run_in(folder.path(), "serve m.json --ros2 --seconds 0.1 --force").code, Some(0));
    }
}
