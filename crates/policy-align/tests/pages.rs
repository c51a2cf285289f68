//! The pages that the program writes, in a real browser.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../../../xtask/tests/browser/mod.rs"]
mod browser;
mod running;

use std::path::PathBuf;

use browser::Page;
use running::{folder, run};

/// Widths of windows, CSS pixels: a small phone, a phone, a laptop.
const WIDTHS: [u32; 3] = [320, 390, 1280];

/// Names as people give them to files and channels.
const LONG: &str = "left_shoulder_pitch_joint_position_measured_in_radians";

/// The pages of a model and of a check, of a file with short names and of one with long names.
fn pages() -> Vec<PathBuf> {
    let text = std::fs::read_to_string(folder().join("toy.csv")).unwrap();
    let long = text.replace("episode,t,x,y,vx,vy", &format!("episode,t,{LONG},y,v_{LONG},vy"));
    std::fs::write(folder().join(format!("{LONG}.csv")), long).unwrap();
    let named = format!("--state {LONG},y --velocity v_{LONG},vy");
    for line in [
        "check toy.csv --html toy.html".to_owned(),
        format!("check {LONG}.csv {named} --html long.html"),
        format!("fit {LONG}.csv {named} -o {LONG}.json"),
    ] {
        let ran = run(&line);
        assert_eq!(ran.code, Some(0), "{line}: {}{}", ran.out, ran.err);
    }
    let long = format!("{LONG}.trust.html");
    ["toy.html", "long.html", "toy.trust.html", long.as_str()].map(|name| folder().join(name)).into()
}

#[test]
fn no_page_is_wider_than_its_window_and_all_of_it_is_right() {
    for file in pages() {
        let Some(mut page) = Page::open(&file) else { return };
        for width in WIDTHS {
            page.resize(width, 800);
            let needed = page.width_needed();
            assert!(needed <= width, "{}: {needed} of {width} pixels", file.display());
            // What hides what is too wide would pass, too.
            let cut: Vec<String> = page.evaluate(&format!(
                "[...document.querySelectorAll('main :is(h1, h2, p, li, td, th, figcaption)')]
                    .filter(element => element.getClientRects().length && !element.closest('thead'))
                    .filter(element => element.scrollWidth > element.clientWidth + 1 || element.getBoundingClientRect().right > {width})
                    .map(element => element.textContent.slice(0, 60))"
            ));
            assert_eq!(cut, Vec::<String>::new(), "{} at {width} pixels", file.display());
        }
        assert_eq!((page.complaints(), page.requests()), (vec![], vec![]), "{}", file.display());
    }
}

#[test]
fn pages_and_their_pictures_are_light_or_dark_as_the_reader_prefers() {
    for file in [pages().swap_remove(0), folder().join("toy.trust.html")] {
        let Some(mut page) = Page::open(&file) else { return };
        for (scheme, paper) in [("light", 215..=255), ("dark", 0..=60)] {
            page.prefer("prefers-color-scheme", scheme);
            for what in ["body", "figure img"] {
                let shades = page.shades(what);
                let middle = shades[shades.len() / 2];
                assert!(paper.contains(&middle), "{what} of {} in {scheme}: {middle}", file.display());
            }
        }
    }
}

#[test]
fn the_picture_of_a_policy_says_what_it_shows() {
    assert_eq!(run("plot toy.json -o field.svg --files toy.csv --rollout 1.5,1").code, Some(0));
    let svg = std::fs::read_to_string(folder().join("field.svg")).unwrap();
    for words in [
        "Policy of toy.json (grey: outside the demonstrations)",
        "x (no unit given)",
        "y (no unit given)",
        "demonstrated",
        "learnt policy",
        "equal potential",
        "rolled out",
    ] {
        assert!(svg.contains(&format!(">{words}</text>")), "no {words}");
    }
    // Round values of the potential, on white or black that lets them be read.
    assert!(svg.matches("font-size=\"10\"").count() >= 3, "no values on the lines");
    assert!(svg.contains("prefers-color-scheme:dark"));
}
