//! The view plays by itself once, or repeatedly on request, and the curves follow.

use super::{CANVAS, opened, page, state, view};

#[test]
fn view_plays_once_when_it_becomes_visible() {
    let Some(mut page) = opened() else { return };
    assert!(!view::<bool>(&mut page, "state().playing"), "it plays unseen");
    page.middle_of(CANVAS);
    page.wait_until("policyAlignView.state().playing");
    // Skips a part, because a machine without graphics draws slowly.
    view::<()>(&mut page, "seek(95)");
    page.wait_until("!policyAlignView.state().playing");
    let end = state(&mut page, "sample");
    page.evaluate::<()>("void scrollTo({ top: 0, behavior: 'instant' })");
    page.evaluate::<()>("new Promise(done => setTimeout(done, 200))");
    page.middle_of(CANVAS);
    page.evaluate::<()>("new Promise(done => setTimeout(done, 200))");
    assert!(state(&mut page, "sample").to_bits() == end.to_bits(), "it begins a second time");
}

#[test]
fn reduced_motion_prevents_autoplay() {
    let Some(mut page) = opened() else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    page.middle_of(CANVAS);
    page.evaluate::<()>("new Promise(done => setTimeout(done, 300))");
    assert!(!view::<bool>(&mut page, "state().playing"));
}

#[test]
fn looping_restarts_at_the_end() {
    let Some(mut page) = page() else { return };
    let last = state(&mut page, "sample");
    view::<()>(&mut page, "select({ loop: true })");
    view::<()>(&mut page, &format!("seek({last} - 1)"));
    view::<()>(&mut page, "play()");
    page.wait_until(&format!("policyAlignView.state().sample < {last} / 2"));
    assert!(view::<bool>(&mut page, "state().playing"));
    view::<()>(&mut page, "pause()");
}

#[test]
fn the_cursor_of_the_curves_follows_the_slider() {
    let Some(mut page) = page() else { return };
    for sample in [0, 25, 99] {
        view::<()>(&mut page, &format!("seek({sample})"));
        view::<()>(&mut page, "render()");
        // The slider's thumb is 16 pixels wide and stays within the slider.
        let off: f64 = page.evaluate(
            "(() => {
                const [line, slider] = ['.view-now', '.view-slider'].map((s) => document.querySelector(s).getBoundingClientRect());
                const { value, max } = document.querySelector('.view-slider');
                return Math.abs(line.x + line.width / 2 - (slider.x + 8 + (slider.width - 16) * value / max));
            })()",
        );
        assert!(off < 1.5, "{off} pixels at {sample}");
    }
    let curves: usize = page.evaluate("document.querySelectorAll('.view-curve').length");
    view::<()>(&mut page, "select({ all: false })");
    view::<()>(&mut page, "render()");
    assert_eq!((curves, page.evaluate::<usize>("document.querySelectorAll('.view-curve').length")), (4, 1));
    let (x, y) = page.middle_of(".view-curves svg");
    page.click((x, y));
    page.wait_until("Math.abs(policyAlignView.state().sample - 49.5) < 1");
}
