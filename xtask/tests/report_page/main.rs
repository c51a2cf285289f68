//! The report in a real browser.

#![allow(clippy::unwrap_used)]

#[path = "../browser/mod.rs"]
mod browser;

mod keyboard;
mod looks;
mod paper;
mod report;
mod tables;
mod view;
mod words;

use browser::Page;
use report::report;

/// Maximum size of the page, bytes.
const LARGEST: u64 = 4_500_000;

/// The page; `None` without a browser.
fn page() -> Option<Page> {
    Page::open(&report().join("report.html"))
}

#[test]
fn page_logs_no_errors_and_fetches_nothing() {
    let Some(mut page) = page() else { return };
    assert_eq!(page.complaints(), Vec::<String>::new());
    assert_eq!(page.requests(), Vec::<String>::new());
}

#[test]
fn page_faults_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a page.html");
    let script = "console.error('said'); fetch('http://127.0.0.1:9/x').catch(() => {}); throw new Error('thrown')";
    std::fs::write(&file, format!("<!DOCTYPE html><script>{script}</script>")).unwrap();
    let Some(mut page) = Page::open(&file) else { return };
    page.wait_until("document.readyState == 'complete'");
    let complaints = page.complaints().join("\n");
    assert!(complaints.contains("said") && complaints.contains("thrown"), "{complaints}");
    assert_eq!(page.requests(), ["http://127.0.0.1:9/x"]);
}

#[test]
fn the_page_is_not_too_large() {
    let size = std::fs::metadata(report().join("report.html")).unwrap().len();
    assert!(size < LARGEST, "{size} bytes");
}
