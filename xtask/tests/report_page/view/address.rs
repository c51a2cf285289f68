//! The view's state in the address of the page.

use serde_json::Value;

use super::{page, view};
use crate::browser::Page;

/// The part of the state that is kept.
fn kept(page: &mut Page) -> Value {
    page.evaluate(
        "(({ playing, azimuth, elevation, distance, x, y, z, ...kept }) =>
            ({ ...kept, camera: [azimuth, elevation, distance, x, y, z].map((v) => v.toFixed(2)) })
        )(policyAlignView.state())",
    )
}

#[test]
fn addresses_restore_the_view() {
    let Some(mut page) = page() else { return };
    view::<()>(&mut page, "select({ learner: 'naive', constraint: 'gap', start: 1 })");
    view::<()>(&mut page, "seek(33)");
    view::<()>(&mut page, "select({ ghost: true, loop: true, all: false })");
    view::<()>(&mut page, "setSpeed(2)");
    view::<()>(&mut page, "orbit(.4, .1)");
    page.wait_until("location.hash.includes('naive') && location.hash.includes('sample=33')");
    page.wait_until("location.hash.includes('ghost=yes') && location.hash.includes('speed=2')");
    let (address, before): (String, _) = (page.evaluate("location.hash"), kept(&mut page));
    view::<()>(
        &mut page,
        "select({ learner: 'expert', constraint: 'none', start: 0, ghost: false, loop: false, all: true })",
    );
    view::<()>(&mut page, "setSpeed(20)");
    view::<()>(&mut page, "seek(2)");
    view::<()>(&mut page, "look('top')");
    page.wait_until("location.hash.includes('expert')");
    page.evaluate::<()>(&format!("void (location.hash = {address:?})"));
    page.wait_until("policyAlignView.state().learner === 'naive'");
    assert_eq!(kept(&mut page), before);
    assert_eq!(page.complaints(), Vec::<String>::new());
}

#[test]
fn invalid_address_values_are_ignored() {
    let Some(mut page) = page() else { return };
    let before = kept(&mut page);
    page.evaluate::<()>(
        "void (location.hash = '#walk&learner=teacher&start=9&sample=x&speed=3&ghost=perhaps&loop=&camera=1,2,,4,5,6')",
    );
    page.evaluate::<()>("new Promise(done => setTimeout(done, 100))");
    assert_eq!(kept(&mut page), before);
    assert_eq!(page.complaints(), Vec::<String>::new());
}
