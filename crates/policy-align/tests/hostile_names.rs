//! Names come from other people's recordings and models: they must neither move a terminal's cursor nor become
//! commands.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use policy_align::Model;
use running::{Ran, command, examples};
use serde_json::Value;
use text::is_hidden;

/// Clears the screen, rings the bell, reverses the writing direction.
const HOSTILE: &str = "\u{1b}[2J\u{7}\u{202e}\u{9b}x";
const FILE: &str = "a;touch pwned $(touch pwned) 'x";

/// Channels, units and files with such names: `FILE.csv`, and `FILE.json` learnt from it.
fn hostile_folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let text = fs::read_to_string(examples().join("toy.csv")).unwrap();
        let text = text.replacen("episode,t,x,y,vx,vy", &format!("episode,t,{HOSTILE},y,p,q"), 1);
        fs::write(folder.path().join(format!("{FILE}.csv")), text).unwrap();
        let line = ["fit", &format!("{FILE}.csv"), "-o", &format!("{FILE}.json")];
        let output = command(folder.path()).args(line).args(named()).args(["--max-rows", "60"]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        folder
    });
    folder.path()
}

fn named() -> [String; 6] {
    let channels = format!("{HOSTILE},y");
    ["--state", &channels, "--velocity", "p,q", "--units", &format!("m{HOSTILE},m")].map(ToOwned::to_owned)
}

fn said(words: &[&str]) -> Ran {
    let ran: Ran = command(hostile_folder()).args(words).output().unwrap().into();
    for text in [&ran.out, &ran.err] {
        assert!(!text.contains(is_hidden), "{words:?} says {text:?}");
    }
    ran
}

#[test]
fn no_command_lets_a_name_move_the_cursor() {
    let (csv, json) = (format!("{FILE}.csv"), format!("{FILE}.json"));
    let mut model = Model::load(&hostile_folder().join(&json)).unwrap();
    model.made_by.program = HOSTILE.to_owned();
    model.data.files[0].name = HOSTILE.to_owned();
    model.save(&hostile_folder().join("signed.json")).unwrap();
    let named = named();
    let with_names = |words: &[&str]| {
        let words: Vec<&str> = words.iter().copied().chain(named.iter().map(String::as_str)).collect();
        said(&words)
    };
    let shown = r"\u{1b}[2J\u{7}\u{202e}\u{9b}x";
    for ran in [
        with_names(&["check", &csv]),
        with_names(&["fit", &csv, "-o", "again.json", "--max-rows", "60"]),
        said(&["info", "signed.json"]),
        said(&["predict", &json, "--at", "0.3,1.2"]),
        said(&["plot", &json, "-o", "field.svg"]),
        said(&["plot", &json, "-o", "with.svg", "--files", &csv]),
        said(&["rollout", &json, "--from", "1.5,1"]),
        said(&["export", &json, "--to", "mcap", "-o", "paths.mcap", "--from", "1.5,1"]),
        with_names(&["convert", &csv, "-o", "copy.tsv"]),
        said(&["evaluate", &json, &csv]),
    ] {
        assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
    }
    for (words, code) in [
        (vec!["predict", &json, "--at", "1"], 2),
        (vec!["plot", &json, "--dims", HOSTILE], 2),
        (vec!["info", HOSTILE], 3),
        (vec!["info", &csv], 3),
        (vec!["check", HOSTILE], 3),
        (vec![HOSTILE], 2),
    ] {
        let ran = said(&words);
        assert_eq!((ran.code, ran.err.lines().count()), (Some(code), 3), "{}", ran.err);
    }
    assert!(said(&["info", "signed.json"]).out.contains(shown));
    fs::write(hostile_folder().join("c.toml"), "[fit]\n\"a\\u001b[2J\" = 1\n").unwrap();
    assert!(said(&["fit", &csv, "--config", "c.toml"]).err.contains(r"unknown key 'a\u{1b}[2J'"));
}

#[test]
fn json_is_escaped_and_the_same() {
    let ran = said(&["info", &format!("{FILE}.json"), "--json"]);
    let document: Value = serde_json::from_str(&ran.out).unwrap();
    assert_eq!(document["state"][0]["name"], HOSTILE);
}

#[test]
fn data_keep_their_names() {
    fs::write(hostile_folder().join("states.csv"), format!("y,{HOSTILE}\n1.2,0.3\n")).unwrap();
    let line = ["predict".to_owned(), format!("{FILE}.json"), "states.csv".to_owned()];
    let ran: Ran = command(hostile_folder()).args(line).output().unwrap().into();
    assert!(ran.out.starts_with(&format!("{HOSTILE},y,u_{HOSTILE},")), "{}", ran.err);
}

#[test]
fn drawings_pages_and_comments_show_every_character() {
    let json = format!("{FILE}.json");
    assert_eq!(said(&["plot", &json, "-o", "drawn.svg"]).code, Some(0));
    assert_eq!(said(&["export", &json, "--to", "c", "-o", "policy.c"]).code, Some(0));
    for file in ["drawn.svg", "policy.c", &format!("{FILE}.trust.html")] {
        let text = fs::read_to_string(hostile_folder().join(file)).unwrap();
        let hidden: Vec<char> = text.chars().filter(|&c| is_hidden(c)).collect();
        assert!(hidden.is_empty() && text.contains(r"u{202e}"), "{file}: {hidden:?}");
    }
}

/// Suggested commands can be pasted: they do what they say, and nothing else.
#[test]
fn a_file_name_is_no_command() {
    let (csv, json) = (format!("{FILE}.csv"), format!("{FILE}.json"));
    let folder = hostile_folder();
    let bin = Path::new(env!("CARGO_BIN_EXE_policy-align")).parent().unwrap();
    let path = std::env::join_paths(
        std::iter::once(bin.to_owned()).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    let path = path.unwrap();
    for words in [
        &["check", &csv, "--state", "2,3", "--velocity", "4,5"] as &[&str],
        &["info", &json],
        &["plot", &json, "-o", "pasted.svg"],
        &["convert", &csv, "--state", "2,3", "--velocity", "4,5", "-o", &format!("{FILE}.tsv")],
        &["rollout", &json, "--from", " 1.5, 1"],
        &["export", &json, "--to", "onnx"],
        &["export", &json, "--to", "c"],
        &["export", &json, "--to", "lerobot"],
    ] {
        let ran = said(words);
        let next = ran.out.lines().find_map(|line| line.strip_prefix("Next:  "));
        let next = next.unwrap_or_else(|| panic!("{words:?}: {}{}", ran.out, ran.err));
        // Another shell reads the line as intended, whether or not the program that it names exists.
        let said = Command::new("sh").args(["-c", next]).current_dir(folder).env("PATH", &path).output().unwrap();
        assert!(!folder.join("pwned").exists(), "{next}");
        if next.starts_with("policy-align") && !next.starts_with("policy-align fit") {
            assert!(said.status.success(), "{next}: {}", String::from_utf8_lossy(&said.stderr));
        }
    }
}

/// The same holds for data shown on a terminal.
#[test]
fn a_terminal_shows_every_character_of_data() {
    if Command::new("script").arg("--version").output().is_err() {
        return;
    }
    fs::write(hostile_folder().join("shown.csv"), format!("y,{HOSTILE}\n1.2,0.3\n")).unwrap();
    let line = [env!("CARGO_BIN_EXE_policy-align"), "predict", &format!("{FILE}.json"), "shown.csv"];
    let line = line.map(|word| text::quoted(Path::new(word))).join(" ");
    let ran = Command::new("script").args(["-qec", &line, "/dev/null"]).current_dir(hostile_folder()).output().unwrap();
    let said = String::from_utf8(ran.stdout).unwrap().replace('\r', "");
    assert!(said.contains(r"\u{202e}") && !said.contains(is_hidden), "{said:?}");
}
