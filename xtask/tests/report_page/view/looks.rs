//! The view in light and dark mode, in print, on a phone, and in browsers that cannot draw it.

use std::fs;

use super::{CANVAS, assert_another, page, picture, run};
use crate::browser::Page;

#[test]
fn dark_light_and_paper_have_their_colours() {
    let Some(mut page) = page() else { return };
    page.prefer("prefers-color-scheme", "light");
    let light = picture(&mut page);
    page.prefer("prefers-color-scheme", "dark");
    page.evaluate::<()>("new Promise(done => requestAnimationFrame(() => done()))");
    assert!(picture(&mut page) != light, "the dark does not change the picture");
    page.evaluate::<()>("dispatchEvent(new Event('beforeprint')), undefined");
    let paper: String = page.evaluate("document.querySelector('.view-paper').src");
    assert!(paper == light, "it is not printed in light colours");
    page.evaluate::<()>("dispatchEvent(new Event('afterprint')), undefined");
    assert!(page.evaluate::<bool>("document.querySelector('.view-paper') === null"), "the print stays on the screen");
}

#[test]
fn view_fits_a_phone() {
    let Some(mut page) = page() else { return };
    let mut before = picture(&mut page);
    page.resize(390, 844);
    page.middle_of(CANVAS);
    assert_another(&mut page, &mut before, "a narrow window");
    for element in [CANVAS, ".view-buttons", ".view-times", ".view-choices"] {
        let inside = format!("document.querySelector('{element}').getBoundingClientRect().right <= innerWidth");
        assert!(page.evaluate::<bool>(&inside), "{element} is cut off");
    }
}

#[test]
fn without_webgl_it_points_to_a_still_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.html");
    let html = fs::read_to_string(run().join("report.html")).unwrap();
    let none = "<head><script>HTMLCanvasElement.prototype.getContext = () => null</script>";
    fs::write(&file, html.replacen("<head>", none, 1)).unwrap();
    let Some(mut page) = Page::open(&file) else { return };
    page.wait_until("document.querySelector('.view-note') !== null");
    let text: String = page.evaluate("document.getElementById('view').innerText");
    assert!(text.contains("no WebGL 2"), "{text}");
    let there = "document.querySelector(document.querySelector('.view-note a').hash) !== null";
    assert!(page.evaluate::<bool>(there), "the still picture is not on the page");
    assert_eq!(page.complaints(), Vec::<String>::new());
}
