//! Tests the program from a user's point of view.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stderr, reason = "what is not tried is said")]

mod running;

use std::io::{Read as _, Write as _};
use std::process::{Command, Stdio};

use running::{command, folder, run, run_in};
use serde_json::Value;

/// All verbs except `serve`, whose example needs a feature: tests/serve.rs.
const VERBS: [&str; 12] = [
    "check",
    "fit",
    "info",
    "predict",
    "rollout",
    "evaluate",
    "constraints",
    "plot",
    "convert",
    "export",
    "completions",
    "man",
];

#[test]
fn every_help_ends_with_an_example_that_runs() {
    for verb in VERBS {
        let help = run(&format!("{verb} --help"));
        assert_eq!((help.code, help.err.as_str()), (Some(0), ""), "{verb}");
        assert!(help.out.lines().all(|line| line.chars().count() <= 80), "{verb}:\n{}", help.out);
        let examples: Vec<&str> = help.out.lines().skip_while(|line| !line.starts_with("Example")).skip(1).collect();
        assert!(!examples.is_empty(), "{verb}");
        for example in examples {
            let line = example.trim().strip_prefix("policy-align ").unwrap_or_else(|| panic!("{verb}: {example}"));
            assert!(line.starts_with(verb), "{example}");
            let ran = run(line);
            assert_eq!(ran.code, Some(0), "{line}: {}", ran.err);
            if !matches!(verb, "completions" | "man") {
                let lines: Vec<&str> = ran.out.lines().collect();
                assert!(!lines.is_empty() && lines.len() <= 14, "{line}:\n{}", ran.out);
                assert!(lines.iter().all(|line| line.chars().count() <= 80), "{line}:\n{}", ran.out);
            }
        }
    }
}

/// There are many flags for reading files: `check` lists them all, and every command accepts them.
#[test]
fn the_help_of_fit_is_brief_and_begins_with_learning() {
    let (fit, check) = (run("fit --help").out, run("check --help").out);
    assert!(fit.lines().count() <= 90, "{fit}");
    assert_eq!(fit, run("fit -h").out);
    let place = |heading: &str| fit.find(heading).unwrap_or_else(|| panic!("{heading}: {fit}"));
    assert!(place("Learning:") < place("Preparing:") && place("Preparing:") < place("Reading files:"), "{fit}");
    for flag in ["--split-gap", "--decimal", "--trust", "--as"] {
        assert!(check.contains(flag) && !fit.contains(&format!("{flag} ")), "{flag}");
    }
    assert!(fit.contains("policy-align check --help"), "{fit}");
    assert_eq!(run("convert toy.csv --decimal . -o again.tsv").code, Some(0));
}

#[test]
fn the_help_lists_the_exit_codes() {
    let help = run("--help").out;
    for code in
        ["  0  done", "  1  a check failed", "  2  wrong usage", "  3  a file", "  4  a bug", "130  interrupted"]
    {
        assert!(help.contains(code), "{help}");
    }
}

/// Writes ten movements along x under one constraint common to all.
fn write_under_one_constraint(file: &str) {
    let sample = |episode: i32, i: i32| {
        let (k, left) = (f64::from(episode), (-0.1 * f64::from(i)).exp());
        format!("{episode},{:.2},{:.6},{:.6}\n", 0.1 * f64::from(i), (1.0 + 0.3 * k) * left, 0.2 * k)
    };
    let rows: String = (0..10).flat_map(|episode| (0..20).map(move |i| sample(episode, i))).collect();
    std::fs::write(folder().join(file), format!("episode,t,x,y\n{rows}")).unwrap();
}

/// One constraint for all movements: all findings that cast doubt are shown, however long.
#[test]
fn a_doubtful_verdict_shows_every_finding_that_casts_doubt() {
    write_under_one_constraint("same.csv");
    let ran = run("fit same.csv -o same.json");
    let document: Value = serde_json::from_str(&run("info same.json --json").out).unwrap();
    let findings = document["trust"]["findings"].as_array().unwrap();
    let doubts: Vec<_> = findings.iter().filter(|finding| finding["verdict"] != "good").collect();
    assert!(doubts.len() >= 2, "{}", ran.out);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_ne!(document["trust"]["verdict"], "good", "{}", ran.out);
    for said in [&ran.out, &run("info same.json").out] {
        for doubt in doubts.iter().flat_map(|doubt| [&doubt["what"], &doubt["next"]]) {
            let doubt = doubt.as_str().unwrap();
            assert!(words(said).contains(&words(doubt)), "{doubt}\n{said}");
        }
    }
}

#[test]
fn written_files_and_used_training_data_are_reported() {
    let ran = run("rollout toy.json --from 1.5,1 --plot named.svg");
    assert!(ran.out.contains("written      named.svg\n"), "{}", ran.out);
    std::fs::copy(folder().join("toy.csv"), folder().join("same-bytes.csv")).unwrap();
    let ran = run("evaluate toy.json same-bytes.csv");
    assert!(ran.out.contains("warning      same-bytes.csv is training data"), "{}", ran.out);
    assert!(!run("evaluate toy.json rails.csv").out.contains("training data"));
    let document: Value = serde_json::from_str(&run("evaluate toy.json same-bytes.csv --json").out).unwrap();
    assert_eq!(document["training_files"], serde_json::json!(["same-bytes.csv"]));
}

#[test]
fn all_constraints_are_in_json_and_five_of_them_on_the_terminal() {
    let rows = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let (head, rows) = rows.split_once('\n').unwrap();
    let named = rows.lines().map(|row| format!("{row},rail {}\n", row.split(',').next().unwrap()));
    std::fs::write(folder().join("named-rails.csv"), format!("{head},constraint\n{}", named.collect::<String>()))
        .unwrap();
    let out = run("evaluate toy.json named-rails.csv").out;
    let document: Value = serde_json::from_str(&run("evaluate toy.json named-rails.csv --json").out).unwrap();
    let all = document["constraints"].as_object().unwrap().len();
    assert!(all > 5 && all == document["episodes"].as_array().unwrap().len(), "{all}");
    assert_eq!(out.matches("constraint   rail ").count(), 5, "{out}");
    assert!(out.contains(&format!("and {} more: --json shows all", all - 5)), "{out}");
}

/// Support is 0 outside the data, where neither deviation nor potential exists.
#[test]
fn support_is_none_outside_the_data() {
    let ran = run("predict toy.json --at 50,50");
    assert_eq!(ran.out, "action       x 0, y 0 per second\nsupport      0 (outside the data)\n");
    let document: Value = serde_json::from_str(&run("predict toy.json --at 50,50 --json").out).unwrap();
    let prediction = &document["predictions"][0];
    assert_eq!((prediction["support"].as_f64(), &prediction["known"]), (Some(0.0), &Value::Bool(false)));
    assert!(prediction["potential"].is_null() && prediction["deviation"].is_null(), "{prediction}");
}

#[test]
fn results_are_json_if_asked_for() {
    for line in [
        "check toy.csv",
        "info toy.json",
        "predict toy.json --at 0.3,1.2",
        "rollout toy.json --from 1,1",
        "evaluate toy.json toy.csv",
        "predict toy.json --at 0.3,1.2 -o json-one.csv",
        "plot toy.json -o json.svg",
        "export toy.json --to c -o json.c",
        "export toy.json --to mcap -o json.mcap",
        "convert toy.csv -o json.tsv",
    ] {
        let ran = run(&format!("{line} --json"));
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        let document: Value = serde_json::from_str(&ran.out).unwrap();
        assert!(document.is_object() && ran.out.lines().count() == 1, "{line}");
        if let Some((_, file)) = line.split_once(" -o ") {
            assert!(folder().join(file).exists(), "{line}");
            assert!(line.starts_with("predict") || document == serde_json::json!({ "written": [file] }), "{document}");
        }
    }
}

#[test]
fn errors_have_three_lines_and_a_code() {
    std::fs::write(folder().join("bad.csv"), "episode,t,x,y\n1,0,0,0\n1,1,NaN,1\n1,2,2,2\n").unwrap();
    std::fs::write(folder().join("bad.toml"), "[[constraint]]\nnormal = [1]\n").unwrap();
    std::fs::write(folder().join("no.json"), "{}").unwrap();
    std::fs::write(folder().join("half.json"), "{").unwrap();
    for (line, code, said) in [
        ("check nothing.csv", 3, "nothing.csv"),
        ("check bad.csv", 3, "try: --nan drop"),
        ("info nothing.json", 3, "cannot be read"),
        ("info no.json", 3, "not a policy-align model: `format` is missing"),
        ("info toy.csv", 3, "not a policy-align model: the file is no JSON object"),
        ("info half.json", 3, "damaged or cut off: not JSON"),
        ("frobnicate", 2, "unrecognized subcommand"),
        ("check", 2, "required arguments"),
        ("fit toy.csv --folds five", 2, "invalid value 'five'"),
        ("fit toy.csv --learner avto", 2, "auto"),
        ("fit toy.csv --bandwidth big", 2, "--bandwidth auto"),
        ("fit toy.csv --bandwidth wide", 2, "--bandwidth has no effect with --learner auto"),
        ("fit toy.csv --learner slope --folds 3", 2, "no --folds, or --learner policy-align"),
        ("fit toy.csv --learner direct --init-d 3", 2, "no --init-d, or --learner policy-align"),
        ("fit toy.csv --learner policy-align --reading free", 2, "no --reading, or --learner auto"),
        ("plot toy.json --dt 0.1", 2, "--files with recordings, or no --dt"),
        ("export toy.json --to onnx --float", 2, "--to c, or no --float"),
        ("export toy.json --to mcap --name f", 2, "--to c, or no --name"),
        ("evaluate toy.json toy.csv --scale x=2", 2, "recordings are scaled as the model's"),
        ("constraints toy.json toy.csv --scale x=2", 2, "recordings are scaled as the model's"),
        ("fit toy.csv --hold-out nobody", 2, "there is no episode 'nobody'"),
        ("fit toy.csv --hold-out 0%", 2, "'0%' is not a share of 40 episodes"),
        ("fit toy.csv --hold-out x%", 2, "as 20%"),
        ("plot toy.json --size 800", 2, "as 800x600"),
        ("plot toy.json --size 800x60", 2, "from 200 to 10000"),
        ("fit toy.csv --scale q=2", 2, "'q'"),
        ("fit toy.csv -o none/model.json", 3, "cannot be written"),
        ("predict toy.json --at 1", 2, "one for each of x, y"),
        ("predict toy.json --at a,b", 2, "--at 0.3,1.2"),
        ("predict toy.json --at 99,99 --outside error", 1, "the state is outside the data (support 0)"),
        ("predict toy.json no.json", 3, "no.json, line 1"),
        ("rollout toy.json --from 99,99", 1, "outside the data (support 0, at least 0.5 needed)"),
        ("rollout toy.json --from 1,1 --seconds 0", 2, "seconds is 0"),
        ("rollout toy.json --from 1,1 --constraint bad.toml", 2, "constraint 1: `normal` has 1 number: it needs 2"),
        ("rollout toy.json --from 1,1 --constraint none.toml", 3, "none.toml"),
        ("plot toy.json -o field.gif", 2, ".svg or .png"),
        ("plot toy.json --dims x,q", 2, "two of x, y"),
        ("convert toy.csv -o toy.xyz", 2, "use one of"),
        ("export toy.json --to c --name 1st", 2, "--name policy"),
        ("evaluate toy.json toy.csv --truth vx", 2, "one column for each channel"),
        ("evaluate toy.json wall.toml", 3, "not a recording"),
        ("evaluate toy.json toy.csv --leave-constraint-out", 1, "--constraint-column"),
        ("export toy.json --to mcap -o toy.csv", 2, "end in .mcap"),
        ("export toy.json --to mcap --from 99,99", 1, "outside the data"),
        ("export toy.json --to c --from 1,1", 2, "--to mcap"),
        ("export toy.json --to lerobot --from 1,1", 2, "--to mcap"),
        ("export toy.json --to lerobot -o toy.csv", 3, "toy.csv"),
        ("convert toy.csv -o slow.csv --resample 0", 2, "0 Hz is not a rate"),
        ("convert toy.csv -o slow.csv --resample 0.1", 2, "a higher rate"),
        ("fit toy.csv -o toy.csv", 2, "would write over it"),
        ("check toy.csv --html ./toy.csv", 2, "would write over it"),
        ("convert toy.csv -o toy.csv", 2, "would write over it"),
        ("export toy.json --to c -o toy.json", 2, "would write over it"),
        ("fit toy.csv --scale x=0", 2, "--scale z=10"),
        ("check toy.csv --html none/page.html", 3, "cannot be written"),
    ] {
        let ran = run(line);
        let lines: Vec<&str> = ran.err.lines().filter(|line| !line.starts_with("warning: ")).collect();
        assert_eq!((ran.code, ran.out.as_str()), (Some(code), ""), "{line}: {}", ran.err);
        assert!(lines.len() == 3, "{line}: {}", ran.err);
        for (line, start) in lines.iter().zip(["error: ", "  in:  ", "  try: "]) {
            assert!(line.starts_with(start) && line.len() > start.len(), "{}", ran.err);
        }
        assert!(ran.err.contains(said), "{line}: {}", ran.err);
    }
    let ran = run("evaluate toy.json toy.csv --require 1e-12");
    assert_eq!(ran.code, Some(1), "{}", ran.out);
    assert!(ran.out.contains("not met"));
}

/// Words of a text, independent of line breaks.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// An error along the motion does not measure other directions: if the true policy is known, `--require` applies to
/// all directions.
#[test]
fn require_covers_all_directions_if_the_truth_is_known() {
    let rows = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let (head, rows) = rows.split_once('\n').unwrap();
    // A true policy that differs from the learnt one.
    let with = |row: &str| {
        let fields: Vec<&str> = row.split(',').collect();
        format!("{row},{},{}\n", fields[3], fields[2])
    };
    let text = format!("{head},pi_x,pi_y\n{}", rows.lines().map(with).collect::<String>());
    std::fs::write(folder().join("other-truth.csv"), text).unwrap();
    let ran = run("evaluate toy.json toy.csv --require 0.1");
    assert_eq!(ran.code, Some(0), "{}", ran.out);
    let said =
        "required at most 0.1: met (the error relative to the policy, along the motion; --truth also requires it";
    assert!(words(&ran.out).contains(said), "{}", ran.out);
    let ran = run("evaluate toy.json other-truth.csv --truth pi_* --require 0.1");
    assert_eq!(ran.code, Some(1), "{}", ran.out);
    assert!(
        words(&ran.out).contains("not met (the error relative to the policy, along the motion, and the nUPE"),
        "{}",
        ran.out
    );
}

/// A robot without effect is reported, and one with effect appears among the decisions; an unusable one is refused.
#[test]
fn effects_of_a_robot_are_reported() {
    let link = |name: &str| {
        format!(r#"<link name="{name}"><inertial><origin xyz="1 0 0"/><mass value="1"/></inertial></link>"#)
    };
    let joint = |name: &str, [parent, child]: [&str; 2]| {
        format!(
            r#"<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/></joint>"#
        )
    };
    let links = [link("base"), link("upper"), link("lower")].concat();
    let joints = joint("x", ["base", "upper"])
        + &joint("y", ["upper", "lower"]).replace("<axis", r#"<origin xyz="1 0 0"/><axis"#);
    std::fs::write(folder().join("arm.urdf"), format!(r#"<robot name="arm">{links}{joints}</robot>"#)).unwrap();
    let out = run("fit toy.csv --robot arm.urdf -o arm.json").out;
    assert!(
        words(&out).contains("robot has joints for 2 channels; neither its inertia nor constraints of its links"),
        "{out}"
    );
    let ran = run("fit toy.csv --robot arm.urdf --learner direct");
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("try: no --robot, or --learner auto or --learner slope"), "{}", ran.err);
}

/// Two errors that are measured differently have different names.
#[test]
fn fit_errors_name_their_reference() {
    let out = words(&run("fit toy.csv -o errors.json --hold-out 20%").out);
    for said in [
        "constraints detected: error relative to the motion ",
        " error cross-validated, relative to the policy: ",
        " hold-out 8 episodes, not learnt from: error relative to the policy ",
    ] {
        assert!(out.contains(said), "{said}: {out}");
    }
}

/// For a recorder with duplicate stamps in every episode, a few warnings are printed with the number of the others.
#[test]
fn warnings_are_counted() {
    let sample = |episode: i32, i: i32| format!("{episode},{},{}\n", f64::from(i / 2 * 2) * 0.1, f64::from(i * i + i));
    let rows: String = (0..9).flat_map(|episode| (0..12).map(move |i| sample(episode, i))).collect();
    std::fs::write(folder().join("again.csv"), format!("movement,t,x\n{rows}")).unwrap();
    let ran = run("convert again.csv -o once.csv");
    let warnings: Vec<&str> = ran.err.lines().filter(|line| line.contains("twice") || line.contains("more:")).collect();
    assert_eq!((ran.code, warnings.len()), (Some(0), 7), "{}", ran.err);
    assert!(warnings[6].ends_with("and 3 more: check --json lists all"), "{}", ran.err);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut child =
        command(folder()).args(["completions", "bash"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = [0; 1];
    let mut stdout = child.stdout.take().unwrap();
    stdout.read_exact(&mut first).unwrap();
    drop(stdout);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

#[test]
fn no_colour_goes_into_pipes_and_quiet_is_quiet() {
    for line in ["--help", "check --help", "check toy.csv", "info toy.json"] {
        let ran = run(line);
        assert!(!ran.out.contains('\u{1b}') && !ran.err.contains('\u{1b}'), "{line}");
    }
    let ran = run("check toy.csv --quiet");
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
}

#[test]
fn file_and_stdin_predictions_match_the_model() {
    let text = "y,other,x\n1.2,9,0.3\n-0.5,9,0.7\n90,9,90\n";
    std::fs::write(folder().join("states.csv"), text).unwrap();
    let ran = run("predict toy.json states.csv");
    let lines: Vec<Vec<&str>> = ran.out.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines[0], ["x", "y", "u_x", "u_y", "potential", "sd_x", "sd_y", "support", "known"]);
    assert_eq!(lines[1][..2], ["0.3", "1.2"]);
    let one: Value = serde_json::from_str(&run("predict toy.json --at 0.3,1.2 --json").out).unwrap();
    let action = &one["predictions"][0]["action"];
    assert_eq!([lines[1][2], lines[1][3]], [action[0].to_string(), action[1].to_string()]);
    assert_eq!((lines[1][8], lines[3][8], lines[3][2]), ("1", "0", "0"));
    assert_eq!(
        run("predict toy.json states.csv --outside nan").out.lines().last().unwrap().split(',').nth(2),
        Some("NaN")
    );

    let mut child = command(folder())
        .args(["predict", "toy.json", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"0.3;1.2\n0.7;-0.5\n").unwrap();
    let out = String::from_utf8(child.wait_with_output().unwrap().stdout).unwrap();
    assert_eq!(out.lines().nth(1), ran.out.lines().nth(1));
    assert_eq!(out.lines().count(), 3);
}

#[test]
fn a_configuration_is_complete_and_flags_win() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(running::examples().join("toy.csv"), folder.path().join("toy.csv")).unwrap();
    let printed = run_in(folder.path(), "fit --print-config --seed 4 --state x,y");
    assert!(printed.out.contains("seed = 4") && printed.out.contains("state = [\"x,y\"]"), "{}", printed.out);
    std::fs::write(folder.path().join("c.toml"), &printed.out).unwrap();
    let again = run_in(folder.path(), "fit --print-config --config c.toml --seed 5");
    assert_eq!(again.out, printed.out.replace("seed = 4", "seed = 5"));
    std::fs::write(folder.path().join("c.toml"), "[read]\nstat = ['x']\n").unwrap();
    let ran = run_in(folder.path(), "check toy.csv --config c.toml");
    assert_eq!(ran.code, Some(2));
    assert_eq!(ran.err, "error: unknown key 'stat'\n  in:  c.toml, line 2\n  try: 'state', the nearest key\n");
    std::fs::write(folder.path().join("c.toml"), "[read]\nstate = ['x']\n").unwrap();
    assert!(run_in(folder.path(), "check toy.csv --config c.toml --quiet").out.contains("1 state (x)"));
}

#[test]
fn a_path_can_be_read_again_and_keeps_its_constraint() {
    let ran = run("rollout toy.json --from 1.5,1 --constraint wall.toml -o again.csv --plot again.png");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let text = std::fs::read_to_string(folder().join("again.csv")).unwrap();
    assert!(text.lines().count() > 10);
    assert!(std::fs::read(folder().join("again.png")).unwrap().starts_with(b"\x89PNG"));
    let ran = run("check again.csv --quiet");
    assert!(ran.out.contains("1 episode") && ran.out.contains("with velocities"), "{} {}", ran.out, ran.err);
}

/// A roll-out that goes on after its constraint has ended says so; one that the constraint outlasts does not.
#[test]
fn the_end_of_constraints_is_named() {
    let file = |name: &str, until: f64| {
        std::fs::write(folder().join(name), format!("[[constraint]]\nnormal = [1, 0]\nuntil = {until}\n")).unwrap();
    };
    file("until-half.toml", 0.5);
    file("until-late.toml", 1e4);
    let short = run("rollout toy.json --from 1.5,1 --constraint until-half.toml");
    assert!(short.out.contains("satisfied exactly; free from 0.5 s on"), "{}{}", short.out, short.err);
    let long = run("rollout toy.json --from 1.5,1 --constraint until-late.toml");
    assert!(long.out.contains("satisfied exactly\n"), "{}{}", long.out, long.err);
}

/// Sixteen movements that turn towards the origin; only the last is constrained, to a plane across y = z.
fn write_one_constrained(file: &std::path::Path) {
    use std::fmt::Write as _;
    let mut text = "episode,t,x,y,z,vx,vy,vz\n".to_owned();
    for episode in 0..16 {
        let angle = 2.4 * f64::from(episode);
        let mut x: [f64; 3] = [1.2 * angle.cos(), 1.2 * angle.sin(), (1.7 * angle).sin()];
        for i in 0..30 {
            let mut u = [-x[0] - 2.0 * x[1], 2.0 * x[0] - x[1], -0.5 * x[2]];
            if episode == 15 {
                let across = (u[1] - u[2]) / 2.0;
                u = [u[0], u[1] - across, u[2] + across];
            }
            let numbers = x.iter().chain(&u).map(f64::to_string).collect::<Vec<_>>().join(",");
            writeln!(text, "{episode},{:.2},{numbers}", 0.05 * f64::from(i)).unwrap();
            for (x, u) in x.iter_mut().zip(u) {
                *x += 0.05 * u;
            }
        }
    }
    std::fs::write(file, text).unwrap();
}

/// Free movements show the policy; the one that a constraint turned aside is named before them, though it is the last.
#[test]
fn one_constrained_movement_among_free_ones_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_one_constrained(&folder.path().join("one.csv"));
    let fit = run_in(folder.path(), "fit one.csv -o one.json --no-report");
    assert_eq!(fit.code, Some(0), "{}", fit.err);
    assert!(
        words(&fit.out).contains("direct GP (constraints detected, but 94 % of the samples move freely"),
        "{}",
        fit.out
    );
    assert!(words(&run_in(folder.path(), "info one.json").out).contains("94 % of the samples move freely"));
    let named = run_in(folder.path(), "constraints one.json one.csv").out;
    assert!(named.contains("1 with a constraint, 15 without any"), "{named}");
    assert!(named.lines().nth(1).is_some_and(|line| line.starts_with("15 ")), "{named}");
    let at = run_in(folder.path(), "predict one.json --at 0.5,0.3,0.2 --json").out;
    let at: Value = serde_json::from_str(&at).unwrap();
    for (axis, policy) in [-1.1, 0.7, -0.1].into_iter().enumerate() {
        let action = at["predictions"][0]["action"][axis].as_f64().unwrap();
        assert!((action - policy).abs() < 1e-6, "{at}");
    }
}

#[test]
fn exported_roll_outs_equal_those_of_rollout() {
    assert_eq!(
        run("export toy.json --to mcap --from 1.5,1 --from -1,0.5 --constraint wall.toml -o two.mcap").code,
        Some(0)
    );
    assert_eq!(run("convert two.mcap -o two.csv").code, Some(0));
    assert_eq!(run("rollout toy.json --from 1.5,1 --constraint wall.toml -o one.csv").code, Some(0));
    // Without the time column: stamps in a bag are whole nanoseconds.
    let read = |name: &str| {
        let text = std::fs::read_to_string(folder().join(name)).unwrap();
        assert!(text.starts_with("episode,t,x,y,"), "{text:.40}");
        let row = |line: &str| [0, 2, 3, 4, 5].map(|column| line.split(',').nth(column).unwrap().to_owned());
        text.lines().skip(1).map(row).collect::<Vec<_>>()
    };
    let (two, one) = (read("two.csv"), read("one.csv"));
    assert!(one.len() > 10 && two.len() > one.len());
    assert_eq!(two[..one.len()], one, "to the last digit");
    assert_eq!(two[one.len()][..3], ["1", "-1.0", "0.5"]);
    // Without starts, the default number of roll-outs.
    let ran = run("export toy.json --to mcap -o many.mcap");
    assert!(ran.out.contains("12 roll-outs"), "{}{}", ran.out, ran.err);
    let ran = run("check many.mcap --quiet");
    assert!(ran.out.contains("12 episodes") && ran.out.contains("2 states (x, y) with"), "{}{}", ran.out, ran.err);
}

#[test]
fn resampled_recordings_are_as_long() {
    let ran = run("convert toy.csv -o often.csv --resample 100");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let ran = run("check often.csv --quiet");
    // 1.95 s per movement, including both ends.
    assert!(ran.out.contains("40 episodes, 7840 samples"), "{}", ran.out);
    assert!(ran.out.contains("0.01 s (100 Hz)"), "{}", ran.out);
}

#[test]
fn a_constraint_left_out_is_predicted_by_the_others() {
    let ran = run("evaluate toy.json rails.csv --leave-constraint-out --json");
    let document: Value = serde_json::from_str(&ran.out).unwrap();
    let left_out = document["constraints_left_out"].as_array().unwrap();
    let labels: Vec<&str> = left_out.iter().map(|left| left["constraint"].as_str().unwrap()).collect();
    assert_eq!(labels, ["east", "north", "ramp", "slope"]);
    for left in left_out {
        assert_eq!(left["learnt_from"], 9);
        assert_eq!(left["evaluation"]["episodes"].as_array().unwrap().len(), 3);
        assert!(left["evaluation"]["policy_error"].as_f64().unwrap() < 1e-3, "{left}");
    }
    assert_eq!(run("evaluate toy.json rails.csv --leave-constraint-out --require 1e-3").code, Some(0));
    // Movements in the opposite direction on one rail are not.
    let text = std::fs::read_to_string(folder().join("rails.csv")).unwrap();
    let backwards = |line: &str| {
        let mut fields: Vec<String> = line.split(',').map(ToOwned::to_owned).collect();
        if fields[6] == "ramp" {
            fields[2..6].iter_mut().for_each(|field| *field = (field.parse::<f64>().unwrap() * 0.5 + 0.7).to_string());
        }
        fields.join(",")
    };
    let other: Vec<String> = text.lines().map(backwards).collect();
    std::fs::write(folder().join("other.csv"), other.join("\n")).unwrap();
    let ran = run("evaluate toy.json other.csv --integration displacement --leave-constraint-out --require 1e-3");
    assert_eq!(ran.code, Some(1), "{}{}", ran.out, ran.err);
}

/// With y in millimetres, held-out episodes and the page's picture are in the units of the file.
#[test]
fn held_out_episodes_are_in_learnt_units() {
    let text = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let in_millimetres: Vec<bool> = header.split(',').map(|name| name.contains('y')).collect();
    assert_eq!(in_millimetres.iter().filter(|&&is_y| is_y).count(), 2, "{header}");
    let scaled = |line: &str| {
        let fields = line.split(',').zip(&in_millimetres);
        let millimetres = |field: &str| (1000.0 * field.parse::<f64>().unwrap()).to_string();
        let fields = fields.map(|(field, &is_y)| if is_y { millimetres(field) } else { field.to_owned() });
        fields.collect::<Vec<_>>().join(",")
    };
    let mixed: Vec<String> = std::iter::once(header.to_owned()).chain(lines.map(scaled)).collect();
    std::fs::write(folder().join("mixed.csv"), mixed.join("\n")).unwrap();
    let ran = run("fit mixed.csv -o mixed.json --hold-out 3 --hold-out 4 --json");
    assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
    let document: Value = serde_json::from_str(&ran.out).unwrap();
    let scale = document["decisions"].as_array().unwrap().iter().find(|decision| decision["what"] == "scale").unwrap();
    assert_eq!(scale["value"], "y times 0.001");
    assert!(document["hold_out"]["policy_error"].as_f64().unwrap() < 1e-3, "{}", document["hold_out"]);
}

#[test]
fn a_share_of_the_episodes_is_held_out() {
    let ran = run("fit toy.csv -o share.json --hold-out 20% --json");
    assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
    let document: Value = serde_json::from_str(&ran.out).unwrap();
    assert_eq!(document["hold_out"]["episodes"].as_array().unwrap().len(), 8);
    let names = "fit toy.csv -o named.json --hold-out 2,7,12,17,22,27,32,37 --json";
    let named: Value = serde_json::from_str(&run(names).out).unwrap();
    assert_eq!(document["hold_out"], named["hold_out"], "evenly spread");
    assert!(run("info share.json").out.contains("32 episodes"));
}

#[test]
fn check_page_matches_the_check() {
    assert_eq!(run("check toy.csv --html page.html").code, Some(0));
    let page = std::fs::read_to_string(folder().join("page.html")).unwrap();
    assert!(page.contains("All checks passed") && page.contains("data:image/svg+xml"));
    let ran = run("check toy.csv --json");
    let document: Value = serde_json::from_str(&ran.out).unwrap();
    for decision in document["decisions"].as_array().unwrap() {
        for key in ["what", "value", "flag"] {
            assert!(page.contains(decision[key].as_str().unwrap()), "{decision}");
        }
    }
    let text = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let odd = text.replace("episode,t,x,y,vx,vy", "episode,t,x,<y>,v1,v2");
    std::fs::write(folder().join("odd.csv"), odd).unwrap();
    let ran = run("check odd.csv --state x,<y> --velocity v1,v2 --scale <y>=100 --html odd.html");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let page = std::fs::read_to_string(folder().join("odd.html")).unwrap();
    assert!(page.contains("&lt;y&gt;") && !page.contains("<y>"), "names are text");
}

#[test]
fn completions_and_manual_pages_are_well_formed() {
    let available = |program: &str| {
        let found = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
        if !found {
            eprintln!("not tried: there is no {program}");
        }
        found
    };
    for shell in ["bash", "zsh", "fish"] {
        let ran = run(&format!("completions {shell}"));
        assert!(ran.code == Some(0) && ran.out.contains("rollout"));
        let script = folder().join(shell);
        std::fs::write(&script, ran.out).unwrap();
        if available(shell) {
            assert!(Command::new(shell).arg("-n").arg(&script).output().unwrap().status.success(), "{shell}");
        }
    }
    let pages = tempfile::tempdir().unwrap();
    assert_eq!(run(&format!("man --to {}", pages.path().display())).code, Some(0));
    assert_eq!(std::fs::read_dir(pages.path()).unwrap().count(), VERBS.len() + 3);
    if available("man") {
        for page in std::fs::read_dir(pages.path()).unwrap() {
            let path = page.unwrap().path();
            let arguments = ["--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z"];
            let output = Command::new("man").args(arguments).arg(&path).env("MANWIDTH", "80").output().unwrap();
            assert!(output.stderr.is_empty(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stderr));
        }
    }
}

/// Columns named by `--truth` are used; other columns are reported as unused.
#[test]
fn columns_of_the_truth_are_not_called_unused() {
    let toy = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let with = |row: (usize, &str)| match row {
        (0, header) => format!("{header},pi_x,pi_y,reward\n"),
        (_, line) => {
            let at = |column: usize| line.split(',').nth(column).unwrap().parse::<f64>().unwrap();
            format!("{line},{},{},0.5\n", -2.0 * at(2), -2.0 * at(3))
        }
    };
    std::fs::write(folder().join("truth.csv"), toy.lines().enumerate().map(with).collect::<String>()).unwrap();
    std::fs::write(folder().join("reading.toml"), "[read]\nepisode = 'episode'\n").unwrap();
    for line in [
        "evaluate toy.json truth.csv --truth pi_*",
        "evaluate toy.json truth.csv --truth pi_x,pi_y --config reading.toml",
    ] {
        let ran = run(line);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.contains("truth        nUPE"), "{}", ran.out);
        assert!(ran.err.contains("columns not used: reward:") && !ran.err.contains("pi_"), "{}", ran.err);
    }
    let ran = run("evaluate toy.json truth.csv --ignore reward");
    assert!(ran.err.contains("columns not used: pi_x, pi_y:"), "{}", ran.err);
}

/// A movement that PolicyAlign cannot align is named, and the Gaussian process's numbers are marked.
#[test]
fn a_movement_that_is_not_aligned_is_left_out_by_name() {
    let toy = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let away = |row: &str| {
        let fields: Vec<&str> = row.split(',').collect();
        let [x, y] = [2, 3].map(|at| fields[at].parse::<f64>().unwrap() + 40.0);
        format!("lone,{},{x},{y},{},{}\n", fields[1], fields[4], fields[5])
    };
    let lone: String = toy.lines().skip(1).take(40).map(away).collect();
    std::fs::write(folder().join("lone.csv"), toy + &lone).unwrap();
    let ran = run("fit lone.csv --learner policy-align --bandwidth narrow --init-d 6 -o lone.json");
    assert!(
        ran.out.contains("left out     1 episode (lone: not aligned: no other movement passes near it)"),
        "{}",
        ran.out
    );
    let page = std::fs::read_to_string(folder().join("lone.trust.html")).unwrap();
    assert!(page.contains("Left out: lone (not aligned"), "the page lists it");
    for number in [
        "relative to the policy (of PolicyAlign)",
        "error of the worst episode (of the Gaussian process)",
        "either half of the episodes (of the Gaussian process)",
        "no potential explains (of the slope GP)",
    ] {
        assert!(page.contains(number), "{number}");
    }
    let page = std::fs::read_to_string(folder().join("toy.trust.html")).unwrap();
    assert!(!page.contains("(of PolicyAlign)") && !page.contains("(of the Gaussian process)"));
}

/// The user may choose between two readings, which removes the doubt; the hint mentions it if another learner was
/// requested.
#[test]
fn a_reading_can_be_chosen_where_it_has_effect() {
    write_under_one_constraint("readings.csv");
    for (flags, verdict, next) in [
        ("", "doubtful", "set --reading free or --reading constrained"),
        ("--reading free", "good", "the policy is right if nothing was constrained, as given"),
        ("--reading constrained", "good", "the policy is right if constraints acted, as given"),
        ("--learner slope", "doubtful", "--learner auto with --reading free or --reading constrained"),
    ] {
        let ran = run(&format!("fit readings.csv {flags} -o readings.json --json"));
        let document: Value = serde_json::from_str(&ran.out).unwrap();
        let findings = document["trust"]["findings"].as_array().unwrap();
        let found = findings.iter().find(|of| of["what"].as_str().unwrap().starts_with("two readings explain"));
        let found = found.unwrap_or_else(|| panic!("{flags}: {}", ran.out));
        assert_eq!(found["verdict"], verdict, "{flags}");
        assert!(found["next"].as_str().unwrap().contains(next), "{flags}: {found}");
    }
}
