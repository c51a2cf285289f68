//! The interactive view: it draws, does as it is told, and its hands are where forward kinematics has them.

mod address;
mod camera;
mod controls;
mod drawing;
mod hands;
mod legs;
mod looks;
mod playing;
mod scene;
mod words;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde::de::DeserializeOwned;

use super::browser::Page;

const CANVAS: &str = "#view canvas";

/// Pixels of the screen for each CSS pixel along a side: few are drawn quickly.
const PIXELS: f64 = 0.5;

/// The folder of a quick run of the grasp, made once: so what the program computes today is looked at.
fn run() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("grasp");
        // What an earlier program left there is not looked at.
        let _ = fs::remove_dir_all(&out);
        let mut program = Command::new(env!("CARGO_BIN_EXE_xtask"));
        program.args(["reproduce", "--quick", "--only", "table2", "--seed", "1", "--out"]).arg(&out);
        let output = program.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        out
    })
}

/// The page with the view, unless there is no browser; before one gets to the view, so that it has not begun to play.
fn opened() -> Option<Page> {
    opened_on(PIXELS)
}

/// The same on a screen with so many pixels for each CSS pixel along a side.
fn opened_on(pixels: f64) -> Option<Page> {
    let mut page = Page::open_on(&run().join("report.html"), pixels)?;
    page.wait_until("'policyAlignView' in window");
    Some(page)
}

/// The view, which does not play by itself.
fn page() -> Option<Page> {
    opened().map(at_rest)
}

/// Stops the view and scrolls to it.
fn at_rest(mut page: Page) -> Page {
    view::<()>(&mut page, "pause()");
    page.middle_of(CANVAS);
    page
}

/// Tells the view something, and what it answers.
fn view<T: DeserializeOwned>(page: &mut Page, what: &str) -> T {
    page.evaluate(&format!("policyAlignView.{what}"))
}

/// A number of its state.
fn state(page: &mut Page, name: &str) -> f64 {
    view(page, &format!("state().{name}"))
}

/// The picture of the present state.
fn picture(page: &mut Page) -> String {
    page.evaluate(&format!("(policyAlignView.render(), document.querySelector('{CANVAS}').toDataURL())"))
}

/// The picture is another than before.
#[track_caller]
fn assert_another(page: &mut Page, before: &mut String, cause: &str) {
    let now = picture(page);
    assert!(now != *before, "{cause} leaves the picture as it was");
    *before = now;
}
