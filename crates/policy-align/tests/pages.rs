//! Shows the program's pages in a real browser.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../../../xtask/tests/browser/mod.rs"]
mod browser;
mod running;

use std::path::PathBuf;
use std::sync::OnceLock;

use browser::Page;
use running::{folder, run};

/// Widths of windows, CSS pixels: a small phone, a phone, a laptop.
const WIDTHS: [u32; 3] = [320, 390, 1280];

/// A typical long name of a file or channel.
const LONG: &str = "left_shoulder_pitch_joint_position_measured_in_radians";

/// The pages of a model and of `check`, for a file with short names and one with long names.
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
    let named = ["toy.html", "long.html", "toy.trust.html", long.as_str()].map(|name| folder().join(name));
    named.into_iter().chain(pages_of_three_channels()).collect()
}

#[test]
fn pages_fit_every_window_without_errors() {
    for file in pages() {
        let Some(mut page) = Page::open(&file) else { return };
        for width in WIDTHS {
            page.resize(width, 800);
            let needed = page.width_needed();
            assert!(needed <= width, "{}: {needed} of {width} pixels", file.display());
            // Hiding overflowing parts would pass the check above, so clipped elements are refused.
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
fn policy_pictures_have_titles_axes_and_legends() {
    assert_eq!(run("plot toy.json -o field.svg --files toy.csv --rollout 1.5,1").code, Some(0));
    let svg = std::fs::read_to_string(folder().join("field.svg")).unwrap();
    assert!(svg.contains("width=\"660\" height=\"680\""));
    let ran = run("plot toy.json -o wide.svg --size 900x500 --title Rails --dims y,x");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let wide = std::fs::read_to_string(folder().join("wide.svg")).unwrap();
    assert!(
        wide.contains(">Rails</text>") && wide.contains("width=\"900\" height=\"500\"") && !wide.contains("Policy of")
    );
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
    // Round values of the potential, on a white or black background that makes them readable.
    assert!(svg.matches("font-size=\"10\"").count() >= 3, "no values on the lines");
    assert!(svg.contains("prefers-color-scheme:dark"));
}

/// Deterministic numbers between 0 and 1 that look random.
fn noise(at: usize) -> f64 {
    ((at as f64 + 2.0) * 12.9898).sin().mul_add(43_758.545_3, 0.0).rem_euclid(1.0)
}

/// The page of movements to different goals in three channels, which no policy of the state explains, and one of a good policy
/// in three channels; made once.
fn pages_of_three_channels() -> [PathBuf; 2] {
    static PAGES: OnceLock<[PathBuf; 2]> = OnceLock::new();
    PAGES.get_or_init(made_of_three_channels).clone()
}

fn made_of_three_channels() -> [PathBuf; 2] {
    let sample = |own_goal: bool, episode: usize, i: usize| {
        let place = |k: usize| {
            let [start, goal] = [noise(10 * episode + k), noise(10 * episode + k + 5)].map(|share| 2.0 * share - 1.0);
            let goal = if own_goal { goal } else { 0.2 };
            goal + (start - goal) * (-0.075 * i as f64).exp()
        };
        format!("{episode},{:.2},{:.5},{:.5},{:.5}\n", 0.05 * i as f64, place(0), place(1), place(2))
    };
    ["goals", "free"].map(|name| {
        let rows: String =
            (0..14).flat_map(|episode| (0..40).map(move |i| sample(name == "goals", episode, i))).collect();
        std::fs::write(folder().join(format!("{name}3.csv")), format!("episode,t,x [m],y [m],z [m]\n{rows}")).unwrap();
        let ran = run(&format!("fit {name}3.csv -o {name}3.json"));
        assert_eq!(ran.code, Some(i32::from(name == "goals")), "{}{}", ran.out, ran.err);
        folder().join(format!("{name}3.trust.html"))
    })
}

#[test]
fn a_wide_window_has_two_columns_and_a_phone_one() {
    let [wrong, good] = pages_of_three_channels();
    for file in [wrong, good, folder().join("toy.trust.html")] {
        let Some(mut page) = Page::open(&file) else { return };
        // All in one call, after the window has been resized.
        let sides = |page: &mut Page, width: u32| -> [[f64; 3]; 5] {
            page.resize(width, 900);
            page.wait_until(&format!("innerWidth === {width}"));
            page.evaluate(
                "['.opening', '#field', '#numbers', '#errors', '#left-out'].map(of => {
                    const {left, right, top} = document.querySelector(of).getBoundingClientRect();
                    return [left, right, top];
                })",
            )
        };
        for width in [1200, 1400, 1900] {
            let [opening, field, numbers, errors, left_out] = sides(&mut page, width);
            assert!(field[0] > opening[1] && numbers[1] < errors[0], "{}: {width}", file.display());
            assert!((field[2] - opening[2]).abs() < 30.0, "the picture is beside the verdict: {field:?}, {opening:?}");
            assert!(errors[2] > field[2] && left_out[2] > errors[2]);
            assert!(left_out[0] == opening[0] && left_out[1] == field[1], "what is wide has the width of both");
            let wrap: String = page.evaluate("getComputedStyle(document.querySelector('#decisions td')).overflowWrap");
            assert_eq!(wrap, "normal", "words as 'smoothing' stay whole");
            assert!(
                field[1] > 0.9 * f64::from(width) - 60.0 || width > 1800,
                "the width is used: {field:?} of {width}"
            );
        }
        let [opening, field, numbers, errors, _] = sides(&mut page, 400);
        assert!([field, numbers, errors].iter().all(|part| part[0] == opening[0]));
        assert!(opening[2] < field[2] && field[2] < numbers[2] && numbers[2] < errors[2]);
    }
}

#[test]
fn numbers_that_are_not_good_have_a_sign_and_a_colour() {
    let [wrong, good] = pages_of_three_channels();
    let Some(mut page) = Page::open(&wrong) else { return };
    let marked: Vec<String> = page.evaluate(
        "[...document.querySelectorAll('#numbers tbody tr')].filter(row => row.querySelector('.bad')).map(row => row.textContent)",
    );
    let is_marked = |what: &str| marked.iter().any(|row| row.starts_with(what));
    assert!(is_marked("Cross-validated error along the observed motion"), "{marked:?}");
    assert!(!is_marked("The same for the direct learner") && !is_marked("Coverage"), "{marked:?}");
    assert!(marked.iter().all(|row| row.contains("✗ not good: ")), "{marked:?}");
    for scheme in ["light", "dark"] {
        page.prefer("prefers-color-scheme", scheme);
        let colors: Vec<String> = page.evaluate(
            "['#numbers td .bad', '#numbers td'].map(of => getComputedStyle(document.querySelector(of)).color)",
        );
        assert_ne!(colors[0], colors[1], "{scheme}");
    }
    // PolicyAlign's policy has a different threshold.
    let ran = run("fit toy.csv --learner policy-align -o aligned.json");
    assert!(ran.out.contains("good: all checks passed"), "{}", ran.out);
    for good in [good, folder().join("toy.trust.html"), folder().join("aligned.trust.html")] {
        let Some(mut page) = Page::open(&good) else { return };
        assert_eq!(
            page.evaluate::<usize>("document.querySelectorAll('#numbers .bad').length"),
            0,
            "{}",
            good.display()
        );
        assert!(page.evaluate::<usize>("document.querySelectorAll('#numbers tbody tr').length") >= 10);
    }
}

#[test]
fn every_pair_of_three_channels_has_a_picture_and_two_channels_have_one() {
    let [_, good] = pages_of_three_channels();
    let Some(mut page) = Page::open(&good) else { return };
    // Pictures as in the page; their sizes are known once they are drawn.
    let pictures = "[...document.querySelectorAll('figure img')].map(img => [img.closest('figure').id, decodeURIComponent(img.src)])";
    page.wait_until(
        "[...document.querySelectorAll('figure img')].every(img => img.complete && img.naturalWidth > 100)",
    );
    let found: Vec<(String, String)> = page.evaluate(pictures);
    let ids: Vec<&str> = found.iter().map(|(id, _)| id.as_str()).collect();
    let expected = [
        "figure-field",
        "figure-errors",
        "figure-left-out-largest",
        "figure-left-out-median",
        "figure-left-out-least",
        "figure-space",
        "figure-pair-0-1",
        "figure-pair-0-2",
        "figure-pair-1-2",
    ];
    assert_eq!(ids, expected);
    let axes = [[">x [m]<", ">y [m]<"], [">x [m]<", ">z [m]<"], [">y [m]<", ">z [m]<"]];
    for ((id, svg), axes) in found[6..].iter().zip(axes) {
        assert!(axes.iter().all(|axis| svg.contains(axis)), "{id}");
        // A dot at every start, and arrowheads in the colour of the movements.
        assert_eq!(svg.matches("<circle").count(), 14, "{id}");
    }
    let space = &found[5].1;
    assert!([">x [m]<", ">y [m]<", ">z [m]<"].iter().all(|axis| space.contains(axis)));
    assert_eq!(space.matches("<circle").count(), 14);
    for (id, svg) in &found[2..5] {
        assert!(svg.contains("time (s)") && svg.contains("speed (m/s)"), "{id}");
        assert!(svg.contains("#56a0d3") && svg.contains("#d55e00"), "seen and predicted: {id}");
    }
    let captions: Vec<String> =
        page.evaluate("[...document.querySelectorAll('#left-out figcaption')].map(of => of.innerText.trim())");
    assert!(captions.len() == 3 && captions.iter().all(|of| of.starts_with("Episode ")), "{captions:?}");
    // The map has colours for many deviations.
    let mut shades = page.shades("#errors img");
    shades.sort_unstable();
    shades.dedup();
    assert!(shades.len() > 60, "{}", shades.len());
    let Some(mut page) = Page::open(&folder().join("toy.trust.html")) else { return };
    let found: Vec<(String, String)> = page.evaluate(pictures);
    assert!(found.iter().all(|(id, _)| !id.starts_with("figure-pair")) && found.len() == 5, "{}", found.len());
    assert_eq!(found[0].1.matches("<circle").count(), 40, "as many starts as movements");
}
