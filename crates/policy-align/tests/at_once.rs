//! Files that are not held in memory together: their digests, made in one process or in parts by several, give the same model.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fmt::Write as _;
use std::path::Path;

use running::{Ran, command, examples, run_in};
use serde_json::Value;

const FILES: usize = 5;
/// With this limit one of the files is read at once.
const AT_ONCE: &str = "--at-once 40kB";

/// The toy's movements in several files; `noise` is that of velocities, relative to their size.
fn folder(noise: f64) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(examples().join("toy.csv")).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let mut files = vec![format!("{header}\n"); FILES];
    for (at, row) in rows.lines().enumerate() {
        let fields: Vec<&str> = row.split(',').collect();
        let numbers: Vec<f64> = fields[1..].iter().map(|field| field.parse().unwrap()).collect();
        let file = &mut files[fields[0].parse::<usize>().unwrap() % FILES];
        let wave = |k: usize| ((at * 7 + k * 3) as f64 * 12.9898).sin() * 43_758.545_3;
        let off = |k: usize| noise * (wave(k) - wave(k).floor() - 0.5);
        let [t, x, y, vx, vy] = numbers[..] else { panic!("{row}") };
        writeln!(file, "{},{t},{x},{y},{},{}", fields[0], vx + off(0), vy + off(1)).unwrap();
    }
    for (at, file) in files.iter().enumerate() {
        std::fs::write(folder.path().join(format!("{at}.csv")), file).unwrap();
    }
    folder
}

fn done(ran: &Ran) {
    assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
}

/// A model without its creation time.
fn model(path: &Path) -> Value {
    let mut model: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    model["made_by"]["time"] = Value::Null;
    model["checksum"] = Value::Null;
    model
}

fn all_files() -> String {
    (0..FILES).map(|at| format!("{at}.csv")).collect::<Vec<_>>().join(" ")
}

/// Digests of exact and of noisy velocities give the same bits in one process with any number of threads and in parts made in any order,
/// and a policy as good as that of all files at once.
#[test]
fn parts_give_the_model_of_one_process() {
    for noise in [0.0, 0.1] {
        let folder = folder(noise);
        let path = folder.path();
        let files = all_files();
        let fit = |threads: &str, rest: &str| {
            let line = format!("fit {files} {rest}");
            let ran: Ran =
                command(path).env("RAYON_NUM_THREADS", threads).args(line.split_whitespace()).output().unwrap().into();
            done(&ran);
            ran
        };
        let said = fit("1", &format!("{AT_ONCE} -o one.json"));
        assert!(said.out.contains("at once") && said.out.contains("40 episodes, 1600 samples"), "{}", said.out);
        fit("3", &format!("{AT_ONCE} -o three.json"));
        for part in ["3/3", "1/3", "2/3"] {
            fit("2", &format!("{AT_ONCE} --shard {part}"));
        }
        fit("2", &format!("{AT_ONCE} --merge part-2-of-3.json part-3-of-3.json part-1-of-3.json -o merged.json"));
        let one = model(&path.join("one.json"));
        assert_eq!(one, model(&path.join("three.json")));
        assert_eq!(one, model(&path.join("merged.json")));
        assert_eq!(one["data"]["episodes"], 40);
        assert_eq!(one["data"]["files"].as_array().unwrap().len(), FILES);
        fit("2", "--at-once all -o all.json");
        let error = |model: &Value| model["trust"]["numbers"]["expected_error"].as_f64().unwrap();
        let all = model(&path.join("all.json"));
        assert!(error(&one) < 2.0 * error(&all) + 1e-6, "{} {}", error(&one), error(&all));
    }
}

/// Files of movements of π(x) = −2x, each along a separate line that moves at `push`; the first file's movements begin nearer to the goal.
fn rails(files: usize, nearer: f64, push: f64) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in 0..files {
        let mut text = "episode,t,x,y,vx,vy\n".to_owned();
        for episode in 0..8 {
            let angle = (file * 8 + episode) as f64 * 2.399_963;
            let size = if file == 0 { nearer } else { 1.0 };
            let mut x = [(3.0 * angle).cos() * size, (5.0 * angle).sin() * size];
            let along = [angle.cos(), angle.sin()];
            for sample in 0..40 {
                let speed = -2.0 * (x[0] * along[0] + x[1] * along[1]);
                let u = [speed * along[0] - push * along[1], speed * along[1] + push * along[0]];
                let t = f64::from(sample) * 0.05;
                writeln!(text, "{episode},{t:.2},{:.9},{:.9},{:.9},{:.9}", x[0], x[1], u[0], u[1]).unwrap();
                // The velocity depends only on the speed.
                let way = -(-2.0f64 * 0.05).exp_m1() / 2.0;
                x = [0, 1].map(|axis| x[axis] + along[axis] * speed * way + [-along[1], along[0]][axis] * push * 0.05);
            }
        }
        std::fs::write(folder.path().join(format!("{file}.csv")), text).unwrap();
    }
    folder
}

/// The model supports states that occur only in files that are not held in memory together.
#[test]
fn the_places_of_all_files_are_known() {
    let folder = rails(5, 0.3, 0.0);
    let fitted = run_in(folder.path(), &format!("fit {} --at-once 20kB -o m.json", all_files()));
    done(&fitted);
    assert!(fitted.out.contains("at once      320 samples"), "{}", fitted.out);
    let ran = run_in(folder.path(), "predict m.json --at 0.8,-0.2 --json");
    done(&ran);
    let said: Value = serde_json::from_str(&ran.out).unwrap();
    let action = &said["predictions"][0]["action"];
    let errors =
        [(0, -1.6), (1, 0.4)].map(|(axis, wanted): (usize, f64)| (action[axis].as_f64().unwrap() - wanted).abs());
    assert!(errors.iter().all(|error| *error < 1e-3) && said["predictions"][0]["known"] == true, "{}", ran.out);
}

/// A push is found in the files that are read at once, even if they are few.
#[test]
fn pushes_are_found_in_files_read_at_once() {
    let folder = rails(5, 1.0, 0.2);
    for at_once in ["20kB", "all"] {
        let fitted = run_in(folder.path(), &format!("fit {} --at-once {at_once} -o m.json", all_files()));
        done(&fitted);
        let model = model(&folder.path().join("m.json"));
        let error = model["trust"]["numbers"]["held_out_error"].as_f64().unwrap();
        assert!(error < 1e-3, "{at_once}: {}", fitted.out);
    }
}

/// Positions without velocities, and a file without usable data.
#[test]
fn positions_and_empty_files_are_read() {
    let folder = rails(5, 1.0, 0.0);
    let path = folder.path();
    std::fs::write(path.join("3.csv"), "episode,t,x,y,vx,vy\n0,0,0,0,0,0\n0,0.05,0,0,0,0\n0,0.1,0,0,0,0\n").unwrap();
    let fitted = run_in(path, &format!("fit {} --at-once 40kB --ignore vx,vy -o m.json", all_files()));
    done(&fitted);
    let model = model(&path.join("m.json"));
    assert_eq!(model["data"]["episodes"], 32);
    assert_eq!(model["data"]["left_out"][0]["episode"], "3/0");
}

/// The error of each wrong command line.
#[test]
fn parts_that_do_not_fit_are_refused() {
    let folder = folder(0.0);
    let path = folder.path();
    let files = all_files();
    let refused = |line: &str, expected: &str| {
        let ran = run_in(path, line);
        assert!(ran.code.is_some_and(|code| (1..4).contains(&code)), "{line}: {}{}", ran.out, ran.err);
        assert!(ran.err.contains(expected) && ran.err.lines().count() == 3, "{line}: {}", ran.err);
    };
    // Each suggested command leads towards the model.
    let mut line = format!("fit {files} {AT_ONCE} --shard 1/2");
    for next in ["--shard 2/2", "--merge part-1-of-2.json part-2-of-2.json", "plot model.json -o model.svg"] {
        let ran = run_in(path, &line);
        done(&ran);
        let (_, proposed) = ran.out.split_once("policy-align ").unwrap();
        assert!(proposed.trim().ends_with(next), "{}", ran.out);
        line = proposed.trim().to_owned();
    }
    let merge = |parts: &str| format!("fit {files} {AT_ONCE} --merge {parts} -o m.json");
    refused(&merge("part-1-of-2.json"), "no part has");
    refused(&merge("part-1-of-2.json part-1-of-2.json"), "is in two parts");
    refused(
        &format!("fit {files} {AT_ONCE} --scale x=2 --merge part-1-of-2.json part-2-of-2.json"),
        "other files, options",
    );
    let text = std::fs::read(path.join("part-2-of-2.json")).unwrap();
    std::fs::write(path.join("cut.json"), &text[..text.len() / 2]).unwrap();
    refused(&merge("part-1-of-2.json cut.json"), "not a part of a fit");
    refused(&merge("part-1-of-2.json model.json"), "not a part of a fit");
    refused(&format!("fit {files} {AT_ONCE} --shard 3/2"), "not a share");
    refused(&format!("fit {files} --shard 1/2"), "nothing to share");
    refused(&format!("fit {files} --at-once 5apples"), "not a size");
    refused(&format!("fit {files} {AT_ONCE} --hold-out 1"), "all files at once");
    refused(&format!("fit {files} {AT_ONCE} --learner policy-align"), "all files at once");
    let text = std::fs::read_to_string(path.join("1.csv")).unwrap();
    std::fs::write(path.join("1.csv"), text.replace("x,y,vx,vy", "x,z,vx,vz")).unwrap();
    refused(&format!("fit {files} {AT_ONCE}"), "channels are");
}

/// An interrupted fit resumes with the unread files and gives the same model; files that have changed since are read again, and so are all
/// files with other options.
#[test]
fn an_interrupted_fit_resumes() {
    let folder = folder(0.1);
    let path = folder.path();
    let files = all_files();
    let line = format!("fit {files} {AT_ONCE} -o m.json");
    done(&run_in(path, &format!("fit {files} {AT_ONCE} -o whole.json")));
    let kept = path.join("m.json.unfinished");
    assert!(!path.join("whole.json.unfinished").exists() && !kept.exists());

    // The last of the further files cannot be read. They are read one after the other, so that the others have been read before.
    let last = std::fs::read(path.join("4.csv")).unwrap();
    let damage = || {
        let text = String::from_utf8(last.clone()).unwrap();
        std::fs::write(path.join("4.csv"), text.replace("x,y,vx,vy", "x,z,vx,vz")).unwrap();
    };
    damage();
    let alone = || {
        let ran: Ran =
            command(path).env("RAYON_NUM_THREADS", "1").args(line.split_whitespace()).output().unwrap().into();
        ran
    };
    let refused = alone();
    assert!(refused.code != Some(0) && !path.join("m.json").exists(), "{}", refused.out);
    let lines = || std::fs::read_to_string(&kept).unwrap().lines().filter(|line| line.ends_with('}')).count();
    assert_eq!(lines(), 3, "three of four further files were read");

    // An interrupt may tear the last line.
    let text = std::fs::read(&kept).unwrap();
    std::fs::write(&kept, &text[..text.len() - 30]).unwrap();
    assert!(alone().err.contains("goes on: 2 of 4 further files were read by an earlier run"));
    std::fs::write(path.join("4.csv"), &last).unwrap();
    let went_on = run_in(path, &line);
    done(&went_on);
    assert!(went_on.err.contains("3 of 4 further files were read by an earlier run"), "{}", went_on.err);
    assert_eq!(model(&path.join("m.json")), model(&path.join("whole.json")));
    assert!(!kept.exists());

    // The kept digests are for other options, or for a file that has changed.
    damage();
    assert!(alone().code != Some(0) && lines() == 3);
    std::fs::write(path.join("4.csv"), &last).unwrap();
    let other = run_in(path, &format!("{line} --scale x=2"));
    assert!(other.code == Some(0) && !other.err.contains("goes on"), "{}", other.err);
    damage();
    assert!(alone().code != Some(0) && lines() == 3);
    std::fs::write(path.join("4.csv"), &last).unwrap();
    // The changed file has the same size.
    let text = std::fs::read_to_string(path.join("1.csv")).unwrap();
    let digit = |line: &str| format!("{}1\n", &line[..line.len() - 1]);
    let (header, rows) = text.split_once('\n').unwrap();
    std::fs::write(path.join("1.csv"), format!("{header}\n{}", rows.lines().map(digit).collect::<String>())).unwrap();
    done(&run_in(path, &format!("fit {files} {AT_ONCE} -o changed.json")));
    done(&run_in(path, &line));
    assert_eq!(model(&path.join("m.json")), model(&path.join("changed.json")));

    // Shares of rows depend on the sizes of all files: if one grows, the digests of the others change.
    damage();
    assert!(alone().code != Some(0) && lines() == 3);
    let longer = String::from_utf8(last).unwrap() + "99,0.0,0.1,0.1,0.1,0.1\n99,0.05,0.105,0.105,0.1,0.1\n";
    std::fs::write(path.join("4.csv"), longer).unwrap();
    let grown = run_in(path, &line);
    assert!(grown.code == Some(0) && !grown.err.contains("goes on"), "{}", grown.err);
}

/// A fit does not overwrite, follow or remove files that it has not made, and detects an unwritable folder before reading.
#[test]
fn files_of_others_are_left_alone() {
    let folder = folder(0.0);
    let path = folder.path();
    let line = format!("fit {} {AT_ONCE} -o m.json", all_files());
    let kept = path.join("m.json.unfinished");
    std::fs::write(&kept, "notes").unwrap();
    let refused = run_in(path, &line);
    assert!(refused.code == Some(3) && refused.err.contains("something else"), "{}", refused.err);
    assert_eq!(std::fs::read_to_string(&kept).unwrap(), "notes");
    std::fs::remove_file(&kept).unwrap();
    #[cfg(unix)]
    {
        std::fs::write(path.join("precious"), "policy-align unfinished 1\n").unwrap();
        std::os::unix::fs::symlink("precious", &kept).unwrap();
        assert_eq!(run_in(path, &line).code, Some(3));
        std::fs::remove_file(&kept).unwrap();
    }
    let nowhere = run_in(path, &line.replace("m.json", "nowhere/m.json"));
    assert!(nowhere.code == Some(3) && nowhere.err.contains("cannot be written"), "{}", nowhere.err);
    done(&run_in(path, &line));
    assert!(!kept.exists());
}

/// With this limit two of the file's five pieces of 256 kB are read at once.
const PIECES: &str = "--at-once 600kB";
const MOVEMENTS: usize = 210;
const SAMPLES: usize = 100;

/// Movements of π(x) = −2x with noise, each along a separate line, in one file.
fn large(name: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "episode,t,x,y,vx,vy\n".to_owned();
    for episode in 0..MOVEMENTS {
        let angle = episode as f64 * 2.399_963;
        let start = [(3.0 * angle).cos(), (5.0 * angle).sin()];
        let along = [angle.cos(), angle.sin()];
        let size = start[0] * along[0] + start[1] * along[1];
        for sample in 0..SAMPLES {
            let t = sample as f64 * 0.02;
            let here = size * (-2.0 * t).exp();
            let x = [0, 1].map(|axis| start[axis] + along[axis] * (here - size));
            let wave =
                |k: usize| ((episode * SAMPLES + sample) as f64 * 12.9898 + k as f64 * 78.233).sin() * 43_758.545_3;
            let u = [0, 1].map(|axis| -2.0 * here * along[axis] + 0.1 * (wave(axis) - wave(axis).floor() - 0.5));
            writeln!(text, "{episode},{t:.2},{:.9},{:.9},{:.9},{:.9}", x[0], x[1], u[0], u[1]).unwrap();
        }
    }
    std::fs::write(folder.path().join(name), text).unwrap();
    folder
}

/// A file larger than the limit gives the same bits with any number of threads, in parts made in any order, and after an interrupt, and a
/// policy as good as that of the whole file.
#[test]
fn pieces_of_one_file_give_one_model() {
    let folder = large("large.csv");
    let path = folder.path();
    let fit = |threads: &str, rest: &str| {
        let line = format!("fit large.csv --learner slope --max-rows 60 --inducing 0 {rest}");
        let ran: Ran =
            command(path).env("RAYON_NUM_THREADS", threads).args(line.split_whitespace()).output().unwrap().into();
        ran
    };
    let said = fit("1", &format!("{PIECES} -o one.json"));
    done(&said);
    assert!(said.out.contains("at once") && said.out.contains("210 episodes, 21000 samples"), "{}", said.out);
    done(&fit("3", &format!("{PIECES} -o three.json")));
    let part = fit("2", &format!("{PIECES} --shard 2/2"));
    assert!(part.out.contains("2 of 2: 1 piece of 3"), "{}", part.out);
    done(&fit("3", &format!("{PIECES} --shard 1/2")));
    done(&fit("2", &format!("{PIECES} --merge part-2-of-2.json part-1-of-2.json -o merged.json")));
    let one = model(&path.join("one.json"));
    assert_eq!(one, model(&path.join("three.json")));
    assert_eq!(one, model(&path.join("merged.json")));
    done(&fit("2", "--at-once all -o all.json"));
    let all = model(&path.join("all.json"));
    assert_eq!(one["data"]["files"], all["data"]["files"]);
    assert_eq!(one["data"]["files"].as_array().unwrap().len(), 1);
    let error = |model: &Value| model["trust"]["numbers"]["expected_error"].as_f64().unwrap();
    assert!(error(&one) < 2.0 * error(&all) + 1e-6, "{} {}", error(&one), error(&all));
    let missing = fit("2", &format!("{PIECES} --merge part-1-of-2.json -o none.json"));
    assert!(missing.err.contains("no part has large.csv from line"), "{}", missing.err);
    let twice =
        fit("2", &format!("{PIECES} --merge part-1-of-2.json part-2-of-2.json ./part-1-of-2.json -o none.json"));
    assert!(twice.err.contains("is in two parts\n  in:  part-1-of-2.json, ./part-1-of-2.json\n"), "{}", twice.err);
    done(&fit("2", &format!("{PIECES} --shard 1/2 --smooth 5 -o other.json")));
    let other = fit("2", &format!("{PIECES} --merge part-2-of-2.json other.json -o none.json"));
    assert!(
        other.err.contains("was made with other files, options") && other.err.contains("in:  other.json\n"),
        "{}",
        other.err
    );

    // A fit that cannot write its model has kept all digests; the next run uses the digests that an interrupt leaves.
    let kept = path.join("m.json.unfinished");
    let not_written = || {
        std::fs::create_dir(path.join("m.trust.html")).unwrap();
        let ran = fit("1", &format!("{PIECES} -o m.json"));
        std::fs::remove_dir(path.join("m.trust.html")).unwrap();
        assert!(ran.code != Some(0) && !path.join("m.json").exists(), "{}", ran.out);
        std::fs::read_to_string(&kept).unwrap()
    };
    let text = not_written();
    let lines: Vec<&str> = text.lines().filter(|line| line.ends_with('}')).collect();
    assert_eq!(lines.len(), 3);
    let header = text.lines().next().unwrap();
    let cut = |lines: &[&str]| {
        std::fs::write(&kept, format!("{header}\n{}\n{}", lines[..2].join("\n"), &lines[2][..lines[2].len() / 2]))
            .unwrap();
    };
    cut(&lines);
    let went_on = fit("2", &format!("{PIECES} -o m.json"));
    done(&went_on);
    assert!(went_on.err.contains("2 of 3 further pieces were read by an earlier run"), "{}", went_on.err);
    assert_eq!(one, model(&path.join("m.json")));
    assert!(!kept.exists());

    // Digests of the file's earlier state are not used.
    for name in ["m.json", "m.trust.html", "m.trust.json"] {
        std::fs::remove_file(path.join(name)).unwrap();
    }
    let text = not_written();
    cut(&text.lines().filter(|line| line.ends_with('}')).collect::<Vec<_>>());
    let file = path.join("large.csv");
    let content = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, content.replace("\n209,1.98,", "\n209,1.99,")).unwrap();
    let anew = fit("2", &format!("{PIECES} -o m.json"));
    assert!(anew.code == Some(0) && !anew.err.contains("goes on"), "{}", anew.err);
}

/// Movements have the same names as in the whole file, messages give its line numbers, and each file is listed once.
#[test]
fn pieces_keep_names_and_line_numbers() {
    let folder = large("a.csv");
    let path = folder.path();
    let text = std::fs::read_to_string(path.join("a.csv")).unwrap();
    let still = text.lines().skip(1).take(SAMPLES).map(|row| {
        let stamp = row.split(',').nth(1).unwrap();
        format!("still,{stamp},0.1,0.1,0,0\n")
    });
    let still: String = still.collect();
    let at = text.find("\n150,0.00").unwrap() + 1;
    std::fs::write(path.join("b.csv"), format!("{}{still}{}", &text[..at], &text[at..])).unwrap();
    std::fs::copy(path.join("a.csv"), path.join("c.csv")).unwrap();
    let fit =
        |rest: &str| run_in(path, &format!("fit a.csv b.csv c.csv --max-rows 60 --inducing 0 --at-once 1MB {rest}"));
    done(&fit("-o m.json"));
    let model = model(&path.join("m.json"));
    let data = &model["data"];
    assert_eq!((&data["episodes"], &data["left_out"][0]["episode"]), (&630.into(), &"b/still".into()));
    let mut names: Vec<&str> =
        data["files"].as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap()).collect();
    names.sort_unstable();
    assert_eq!(names, ["a.csv", "b.csv", "c.csv"]);
    for (episode, line) in [(0, 2), (150, 15_002), (209, 20_902)] {
        let wrong = text.replace(&format!("\n{episode},0.00,"), &format!("\n{episode},0.00,wrong"));
        std::fs::write(path.join("a.csv"), wrong).unwrap();
        let refused = fit("-o wrong.json");
        assert!(refused.code != Some(0) && refused.err.contains(&format!("a.csv, line {line}, ")), "{}", refused.err);
    }
    // Rows with a coordinate that changes in few movements.
    let level = |(at, row): (usize, &str)| match at {
        0 => "episode,t,x,y,z\n".to_owned(),
        at => {
            let fields: Vec<&str> = row.split(',').take(4).collect();
            let episode = (at - 1) / SAMPLES;
            let z = if episode < 80 && episode.is_multiple_of(20) { fields[2] } else { "0" };
            format!("{},{z}\n", fields.join(","))
        }
    };
    std::fs::write(path.join("level.csv"), text.lines().enumerate().map(level).collect::<String>()).unwrap();
    done(&run_in(path, "convert level.csv -o level.jsonl"));
    for (name, of) in [("level.csv", "level"), ("level.jsonl", "lines")] {
        let said = run_in(path, &format!("fit {name} --max-rows 60 --inducing 0 --at-once 600kB -o {of}.json"));
        done(&said);
        assert!(said.out.contains("at once") && said.out.contains("210 episodes, 21000 samples"), "{}", said.out);
        let model = self::model(&path.join(format!("{of}.json")));
        assert_eq!(model["data"]["files"][0]["name"], name);
        assert_eq!(model["state"].as_array().unwrap().len(), 3);
    }
    // A file that cannot be divided is read whole.
    let rows: Vec<&str> = text.lines().collect();
    let (first, second) = rows[1..].split_at(SAMPLES);
    let together = first.iter().zip(second).flat_map(|(a, b)| [*a, *b]).chain(second[SAMPLES..].iter().copied());
    std::fs::write(path.join("a.csv"), format!("{}\n{}\n", rows[0], together.collect::<Vec<_>>().join("\n"))).unwrap();
    let whole = run_in(path, "fit a.csv --max-rows 60 --inducing 0 --at-once 600kB -o whole.json");
    assert!(whole.code == Some(0) && !whole.out.contains("at once"), "{}{}", whole.out, whole.err);
    assert!(whole.out.contains("210 episodes, 21000 samples"), "{}", whole.out);
}

/// Ctrl-C while digests are made, in several attempts, since a fast machine may finish before the signal arrives.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_explains_how_to_resume() {
    use std::process::{Command, Stdio};
    let folder = large("large.csv");
    let (path, kept) = (folder.path(), folder.path().join("m.json.unfinished"));
    // The parent of the tests may have set the signal to be ignored, which a program inherits; `env` resets it.
    let interrupted = || {
        let fit = command(path);
        let mut env = Command::new("env");
        let arguments = "fit large.csv --learner slope --max-rows 60 --inducing 0 --at-once 600kB -o m.json";
        env.current_dir(path).arg("--default-signal=INT").arg(fit.get_program()).args(arguments.split_whitespace());
        let mut child = env.env("RAYON_NUM_THREADS", "1").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = || std::fs::read_to_string(&kept).map_or(0, |text| text.lines().count());
        while lines() < 2 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        // The process may have ended.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
        let ran: Ran = child.wait_with_output().unwrap().into();
        ran.err.contains("every piece that was read is kept; the same command goes on").then_some(ran.code)
    };
    assert_eq!((0..10).find_map(|_| interrupted()), Some(Some(130)));
    let went_on = run_in(path, "fit large.csv --learner slope --max-rows 60 --inducing 0 --at-once 600kB -o m.json");
    assert!(went_on.code == Some(0) && went_on.err.contains("goes on"), "{}", went_on.err);
}
