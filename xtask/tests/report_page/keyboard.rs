//! The page without a mouse.

use crate::browser::Page;
use crate::page;

/// What has the focus, as its place among all that can have it; −1 for nothing.
const FOCUSED: &str = "all.indexOf(document.activeElement)";

#[test]
fn tab_reaches_everything_in_order_and_it_is_seen() {
    let Some(mut page) = page() else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    page.evaluate::<()>(
        "void (all = [...document.querySelectorAll('a[href], button, input, select, summary, [tabindex=\"0\"]')])",
    );
    // One stop for a group of radio buttons.
    page.evaluate::<()>("void (all = all.filter(e => e.type != 'radio' || e.checked))");
    let stops: i64 = page.evaluate("all.length");
    assert!(stops > 10, "{stops} stops");
    for stop in 0..stops {
        page.press("Tab");
        let what: String = page.evaluate("document.activeElement.outerHTML.slice(0, 200)");
        assert_eq!(page.evaluate::<i64>(FOCUSED), stop, "{what}");
        assert!(page.evaluate::<bool>(IS_SEEN), "{what}");
    }
}

/// Whether what has the focus is in the window and outlined.
const IS_SEEN: &str = "(() => {
    const box = document.activeElement.getBoundingClientRect();
    const inside = box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
    return inside && getComputedStyle(document.activeElement).outlineStyle != 'none';
})()";

#[test]
fn the_first_stop_skips_the_contents() {
    let Some(mut page) = page() else { return };
    page.press("Tab");
    assert_eq!(page.evaluate::<String>("document.activeElement.className"), "skip");
    page.press("Enter");
    page.wait_until("document.activeElement.id == 'main'");
}

#[test]
fn a_figure_is_enlarged_and_left_again() {
    let Some(mut page) = page() else { return };
    // A page that still scrolls is clicked beside what was meant.
    page.prefer("prefers-reduced-motion", "reduce");
    page.evaluate::<()>("document.querySelector('.enlarge').focus()");
    page.press("Enter");
    page.wait_until("document.getElementById('enlarged').open");
    let wide = "document.querySelector('#enlarged img').getBoundingClientRect().width";
    assert!(page.evaluate::<f64>(wide) > page.evaluate::<f64>("document.querySelector('.enlarge img').width"));
    page.press("Escape");
    page.wait_until("!document.getElementById('enlarged').open");
    assert!(page.evaluate::<bool>("document.activeElement == document.querySelector('.enlarge')"));
    let at = page.middle_of(".enlarge");
    page.click(at);
    page.wait_until("document.getElementById('enlarged').open");
    click_anywhere(&mut page);
    page.wait_until("!document.getElementById('enlarged').open");
}

fn click_anywhere(page: &mut Page) {
    page.click((40.0, 40.0));
}

#[test]
fn what_is_folded_opens() {
    let Some(mut page) = page() else { return };
    page.evaluate::<()>("document.querySelector('summary').focus()");
    page.press("Enter");
    page.wait_until("document.querySelector('details').open");
}
