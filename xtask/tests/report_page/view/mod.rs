//! The interactive view: it draws, reacts to its controls, and its hands agree with forward kinematics.

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

/// Number of screen pixels per CSS pixel along a side; few pixels are drawn quickly.
const PIXELS: f64 = 0.5;

/// The folder of a quick run of the grasp, made once, so that the tests examine the program's current output.
fn run() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("grasp");
        // Removes the output of an earlier program.
        let _ = fs::remove_dir_all(&out);
        let mut program = Command::new(env!("CARGO_BIN_EXE_xtask"));
        program.args(["reproduce", "--quick", "--only", "table2", "--seed", "1", "--out"]).arg(&out);
        let output = program.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        out
    })
}

/// The page with the view, before the user scrolls to it, so that it does not play yet; `None` without a browser.
fn opened() -> Option<Page> {
    opened_on(PIXELS)
}

/// The same on a screen with `pixels` screen pixels per CSS pixel along a side.
fn opened_on(pixels: f64) -> Option<Page> {
    let mut page = Page::open_on(&run().join("report.html"), pixels)?;
    page.wait_until("'policyAlignView' in window");
    Some(page)
}

/// The page with the stopped view.
fn page() -> Option<Page> {
    opened().map(at_rest)
}

/// Stops the view and scrolls to it.
fn at_rest(mut page: Page) -> Page {
    view::<()>(&mut page, "pause()");
    page.middle_of(CANVAS);
    page
}

/// Calls a method of the view and returns its result.
fn view<T: DeserializeOwned>(page: &mut Page, what: &str) -> T {
    page.evaluate(&format!("policyAlignView.{what}"))
}

/// A number of the view's state.
fn state(page: &mut Page, name: &str) -> f64 {
    view(page, &format!("state().{name}"))
}

/// The picture of the current state.
fn picture(page: &mut Page) -> String {
    page.evaluate(&format!("(policyAlignView.render(), document.querySelector('{CANVAS}').toDataURL())"))
}

/// Checks that the picture has changed.
#[track_caller]
fn assert_another(page: &mut Page, before: &mut String, cause: &str) {
    let now = picture(page);
    assert!(now != *before, "{cause} leaves the picture as it was");
    *before = now;
}
