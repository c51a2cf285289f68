//! The view draws the selected movement.

use serde_json::Value;

use super::{assert_another, page, picture, view};

#[test]
fn view_is_not_blank() {
    let Some(mut page) = page() else { return };
    let count = "(() => {
        policyAlignView.render();
        const gl = document.querySelector('#view canvas').getContext('webgl2');
        const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
        gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        return new Set(new Uint32Array(pixels.buffer)).size;
    })()";
    let colors: usize = page.evaluate(count);
    assert!(colors > 500, "{colors} colours");
}

#[test]
fn every_choice_changes_the_picture() {
    let Some(mut page) = page() else { return };
    view::<()>(&mut page, "seek(12)");
    let first = picture(&mut page);
    assert!(picture(&mut page) == first, "the same state is drawn in two ways");
    let mut before = first.clone();
    for choice in [
        "{ all: false }",
        "{ ghost: true }",
        "{ learner: 'expert' }",
        "{ learner: 'naive' }",
        "{ constraint: 'gap' }",
        "{ constraint: 'none' }",
        "{ start: 1 }",
        "{ learner: 'all' }",
    ] {
        view::<()>(&mut page, &format!("select({choice})"));
        assert_another(&mut page, &mut before, choice);
    }
    view::<()>(&mut page, "select({ learner: 'slope_gp', constraint: 'obstacle', start: 0, ghost: false })");
    assert!(picture(&mut page) == first, "the first choice is not drawn as it was");
    assert_eq!(page.complaints(), Vec::<String>::new());
}

#[test]
fn unknown_choices_are_refused() {
    let Some(mut page) = page() else { return };
    for choice in ["{ learner: 'teacher' }", "{ constraint: 'fog' }", "{ start: 99 }", "{ speed: 3 }"] {
        let attempt =
            format!("(() => {{ try {{ policyAlignView.select({choice}) }} catch (e) {{ return e.name }} }})()");
        assert_eq!(page.evaluate::<Value>(&attempt), "RangeError", "{choice}");
    }
}
