//! Devices and pipes given as files are refused by name, without waiting for them.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fs::File;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use running::{Ran, command, folder};

/// The result of a command line that must end quickly.
fn soon(line: &str) -> Ran {
    let words = line.split_whitespace();
    let mut child = command(folder()).args(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(30) {
            child.kill().unwrap();
            panic!("{line} does not end");
        }
        sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap().into()
}

#[test]
fn endless_files_are_refused_by_name() {
    assert!(Command::new("mkfifo").arg(folder().join("waiting.json")).status().unwrap().success());
    // A sparse file, whose bytes are not on disk.
    File::create(folder().join("huge.json")).unwrap().set_len(1 << 42).unwrap();
    for file in ["/dev/zero", "waiting.json", "huge.json"] {
        let robot = format!("[[constraint]]\nrobot = \"{file}\"\nlink = \"hand\"\nplane = [0, 0, 1]\n");
        std::fs::write(folder().join("endless.toml"), robot).unwrap();
        for line in [
            format!("info {file}"),
            format!("predict {file} --at 1,1"),
            format!("predict toy.json {file}"),
            format!("check toy.csv --config {file}"),
            format!("rollout toy.json --from 1.5,1 --constraint {file}"),
            "rollout toy.json --from 1.5,1 --constraint endless.toml".to_owned(),
            format!("rollout toy.json --from 1.5,1 --limits {file}"),
            format!("evaluate toy.json {file} --as csv"),
        ] {
            // Recordings of any size are read.
            if file == "huge.json" && line.starts_with("evaluate") {
                continue;
            }
            let ran = soon(&line);
            assert_eq!((ran.code, ran.err.lines().count()), (Some(3), 3), "{line}: {}", ran.err);
            assert!(ran.err.contains(file.trim_start_matches("/dev/")), "{line}: {}", ran.err);
        }
    }
}
