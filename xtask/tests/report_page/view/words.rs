//! The text under the picture: which distances it names, and when it is read aloud.

use super::{page, view};

/// Counts from now on how often the text is written.
const COUNT: &str = "void (written = 0, new MutationObserver(changes => { written += changes.length; })
    .observe(document.querySelector('.view-words'), { childList: true, characterData: true, subtree: true }))";

/// Waits two frames, and returns the count so far.
const WRITTEN: &str = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(written))))";

/// Moves the slider's thumb.
fn slide(to: u32, event: &str) -> String {
    format!(
        "(slider => {{ slider.value = {to}; slider.dispatchEvent(new Event('{event}')); }})(document.querySelector('input.view-slider'))"
    )
}

#[test]
fn words_are_written_only_when_they_change() {
    let Some(mut page) = page() else { return };
    view::<()>(&mut page, "seek(3)");
    page.evaluate::<u32>("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))");
    page.evaluate::<()>(COUNT);
    for _ in 0..5 {
        view::<()>(&mut page, "orbit(.1, .05)");
        page.evaluate::<u32>(WRITTEN);
    }
    assert_eq!(page.evaluate::<u32>(WRITTEN), 0, "turning writes");
    for to in [10, 20, 30] {
        page.evaluate::<()>(&slide(to, "input"));
        assert_eq!(page.evaluate::<u32>(WRITTEN), 0, "the thumb on its way writes");
    }
    page.evaluate::<()>(&slide(30, "change"));
    let written: u32 = page.evaluate(WRITTEN);
    assert!((1..=2).contains(&written), "letting go of the thumb writes {written} times");
    let live = "[...document.querySelectorAll('#view [aria-live=polite], #view output')].length";
    assert_eq!(page.evaluate::<u32>(live), 1);
}

#[test]
fn hands_held_by_the_obstacle_are_named() {
    let Some(mut page) = page() else { return };
    let mut said = |learner: &str, start: usize| -> String {
        view::<()>(&mut page, &format!("select({{ learner: '{learner}', constraint: 'obstacle', start: {start} }})"));
        view::<()>(&mut page, "render()");
        let text: String = page.evaluate("document.querySelector('.view-words').textContent");
        text.lines().find(|line| line.starts_with(learner)).unwrap().to_owned()
    };
    assert!(!said("expert", 0).contains("is held"));
    assert!(said("naive", 0).contains("Its left hand is held by the plate before its place"));
    let held = said("expert", 1);
    assert!(held.contains("Its left hand is held") && !held.contains("right hand is held"), "{held}");
    let above: String = page.evaluate("document.querySelector('#walk > p').textContent");
    assert!(above.contains("From start 2 the obstacle stops the expert too"), "{above}");
}

#[test]
fn closest_and_final_distances_are_shown() {
    let Some(mut page) = page() else { return };
    view::<()>(&mut page, "select({ learner: 'policy_align', constraint: 'gap', start: 0 })");
    view::<()>(&mut page, "render()");
    let text: String = page.evaluate("document.querySelector('.view-words').textContent");
    let line = text.lines().find(|line| line.starts_with("PolicyAlign")).unwrap().to_owned();
    let numbers = |from: &str| -> Vec<f64> {
        let words = line.split(from).nth(1).unwrap().split(" cm").next().unwrap();
        words.split(" and ").map(|number| number.trim().parse().unwrap()).collect()
    };
    let (closest, end) = (numbers("closest "), numbers("at the end "));
    assert!(closest.iter().zip(&end).all(|(closest, end)| closest <= end) && closest[0] < end[0] - 5.0, "{line}");
}

#[test]
fn missed_policy_targets_are_mentioned() {
    let Some(mut page) = page() else { return };
    let words = "document.querySelector('.view-words').textContent";
    for constraint in ["gap", "obstacle", "none"] {
        for start in view::<Vec<usize>>(&mut page, "starts()") {
            view::<()>(
                &mut page,
                &format!("select({{ learner: 'policy_align', constraint: '{constraint}', start: {start} }})"),
            );
            view::<()>(&mut page, "render()");
            let text: String = page.evaluate(words);
            assert!(text.starts_with("From the robot’s left and right palm"), "{text}");
            let missed: bool = page.evaluate(MISSED);
            let line = text.lines().find(|line| line.starts_with("PolicyAlign")).unwrap().to_owned();
            assert_eq!(
                line.contains("where its policy wants the palms"),
                missed,
                "{constraint}, start {start}: {line}"
            );
        }
    }
}

/// Whether the final distance between a palm and its target differs between robot and policy by more than a millimetre.
const MISSED: &str = "(() => {
    const data = JSON.parse(document.getElementById('grasp-playback').textContent);
    const { constraint, start } = policyAlignView.state();
    policyAlignView.seek(1e9);
    const { palms } = data.movements.find(m => m.learner == 'policy_align' && m.constraint == constraint && m.start == start);
    const end = palms.reduce((sum, step) => sum.map((parts, i) => parts + step[i])).map(parts => parts / data.parts);
    const away = (palm, hand) => Math.hypot(...palm.map((x, i) => x - data.scene.target[3 * hand + i]));
    return policyAlignView.hands().some((palm, hand) =>
        Math.abs(away(palm, hand) - away(end.slice(3 * hand, 3 * hand + 3), hand)) > 0.001);
})()";
