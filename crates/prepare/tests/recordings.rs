//! Decisions and findings before learning, one mistake at a time.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use motion::{Channel, Episode, Finding, Labels, Recordings, Source, Subject, Times, Verdict};
use nalgebra::{DMatrix, DVector};
use prepare::{
    PrepareError, PrepareOptions, Prepared, Repair, Smoothing, VelocitySource, VelocityUse, prepare, trim_still,
};
use proptest::prelude::*;

const SAMPLES: usize = 40;
const STEP: f64 = 0.05;

/// x' = −x/2, y' = −y/4 from twelve places, with velocities.
fn recordings() -> Recordings {
    let state = ["x", "y"].map(|name| Channel { name: name.to_owned(), unit: None });
    let episodes = (0..12).map(|k| {
        let start = [f64::from(k).cos(), 1.5 * (1.7 * f64::from(k)).sin()];
        let rate = [0.5, 0.25];
        let value = |axis: usize, i: usize| start[axis] * (-rate[axis] * STEP * i as f64).exp();
        Episode {
            name: format!("e{k}"),
            source: Source { file: "made".to_owned(), records: None },
            times: (0..SAMPLES).map(|i| 7.0 + STEP * i as f64).collect(),
            positions: DMatrix::from_fn(2, SAMPLES, value),
            velocities: Some(DMatrix::from_fn(2, SAMPLES, |axis, i| -rate[axis] * value(axis, i))),
            constraint: Some("table".into()),
            context: nalgebra::DVector::zeros(0),
        }
    });
    Recordings { state: state.to_vec(), episodes: episodes.collect(), findings: Vec::new() }
}

fn changed(change: impl FnMut(&mut Episode)) -> Recordings {
    let mut recordings = recordings();
    recordings.episodes.iter_mut().for_each(change);
    recordings
}

fn prepared(recordings: &Recordings) -> Prepared {
    prepare(recordings, &PrepareOptions::default()).unwrap()
}

/// The decision on a subject.
fn decided<'a>(prepared: &'a Prepared, what: &str) -> &'a str {
    &prepared.decisions.iter().find(|decision| decision.what.to_string() == what).unwrap().value
}

/// The verdict of the finding that contains these words.
fn verdict(prepared: &Prepared, words: &str) -> Verdict {
    let found = prepared.findings.iter().find(|finding| finding.what.contains(words));
    found.unwrap_or_else(|| panic!("'{words}' is not in {:?}", prepared.findings)).verdict
}

proptest! {
    /// A factor after preparation has the same effect as `--scale` before it, also on noise and on the findings on units.
    #[test]
    fn rescaling_equals_the_scale_option(factor in -9.0..9.0f64, noise in prop::sample::select(vec![0.0, 0.01])) {
        let factor = factor.exp();
        let noisy = |values: &mut DMatrix<f64>| {
            let shake = |at: usize| noise * (1e4 * (at as f64).sin()).fract();
            values.iter_mut().enumerate().for_each(|(at, value)| *value += shake(at));
        };
        let recordings = changed(|episode| noisy(episode.velocities.as_mut().unwrap()));
        let options = PrepareOptions { scale: vec![("y".to_owned(), factor)], ..PrepareOptions::default() };
        let expected = prepare(&recordings, &options).unwrap();
        let found = prepared(&recordings).rescaled(&DVector::from_vec(vec![1.0, factor])).unwrap();
        prop_assert_eq!(&found.demonstrations, &expected.demonstrations);
        prop_assert_eq!(&found.noise, &expected.noise);
        prop_assert_eq!(found.velocities, expected.velocities);
        prop_assert_eq!(&found.findings, &expected.findings);
        prop_assert_eq!(found.state[1].scale, factor);
        // Smoothed positions have lost their noise, which is recorded separately.
        let smooth = |options: PrepareOptions| PrepareOptions { smoothing: Smoothing::Samples(9), ..options };
        let expected = prepare(&recordings, &smooth(options)).unwrap();
        let found = prepare(&recordings, &smooth(PrepareOptions::default())).unwrap();
        let found = found.rescaled(&DVector::from_vec(vec![1.0, factor])).unwrap();
        prop_assert_eq!(found.velocities, expected.velocities);
        for (found, expected) in found.noise.positions.iter().flatten().zip(expected.noise.positions.iter().flatten()) {
            prop_assert!((found - expected).abs() <= 1e-9 * expected, "{} {}", found, expected);
        }
        let pairs = found.demonstrations.trajectories().iter().zip(expected.demonstrations.trajectories());
        for (found, expected) in pairs {
            let scale = expected.states().amax();
            prop_assert!((found.states() - expected.states()).amax() <= 1e-12 * scale);
        }
    }
}

#[test]
fn good_recordings_give_no_findings() {
    let prepared = prepared(&recordings());
    assert_eq!(prepared.findings, []);
    assert_eq!(prepared.left_out, []);
    assert_eq!(prepared.velocities, VelocitySource::Recorded);
    assert_eq!(prepared.time_step, STEP);
    assert_eq!(prepared.averaged, 1);
    assert_eq!(prepared.episodes[3], "e3");
    assert_eq!(prepared.constraints[3].as_deref(), Some("table"));
    assert_eq!(decided(&prepared, "time step"), "0.05 s (20 Hz)");
    assert_eq!(decided(&prepared, "velocities"), "recorded");
    let original = recordings();
    for (trajectory, episode) in prepared.demonstrations.trajectories().iter().zip(&original.episodes) {
        assert_eq!(trajectory.states(), &episode.positions);
        assert_eq!(trajectory.velocities(), episode.velocities.as_ref());
        assert_eq!(trajectory.times(), None);
    }
    assert_eq!(prepared.state[0].scale, 1.0);
    assert_eq!(prepared.state[0].high, 1.0);
}

proptest! {
    /// The scale affects only the learner: states are multiplied by it, ranges stay as recorded.
    #[test]
    fn scale(factor in 0.01..100.0f64) {
        let options = PrepareOptions { scale: vec![("y".to_owned(), factor)], ..PrepareOptions::default() };
        let prepared = prepare(recordings(), &options).unwrap();
        let plain = self::prepared(&recordings());
        prop_assert!((prepared.state[1].high / plain.state[1].high - 1.0).abs() < 1e-12);
        prop_assert_eq!(prepared.state[1].scale, factor);
        for (a, b) in prepared.demonstrations.trajectories().iter().zip(plain.demonstrations.trajectories()) {
            for (a, b) in [(a.states(), b.states()), (a.velocities().unwrap(), b.velocities().unwrap())] {
                prop_assert_eq!(a.row(0), b.row(0));
                prop_assert_eq!(a.row(1), b.row(1) * factor);
            }
        }
    }

    /// Velocities multiplied by any factor are converted back to the steps' units, and this is reported.
    #[test]
    fn velocities_in_other_units(factor in prop_oneof![2.0..5000.0f64, 1e-4..0.5f64, -5000.0..-0.001f64]) {
        let prepared = prepared(&changed(|episode| episode.velocities.iter_mut().for_each(|u| *u *= factor)));
        prop_assert_eq!(verdict(&prepared, "times the steps"), Verdict::Doubtful);
        let plain = recordings();
        for (trajectory, episode) in prepared.demonstrations.trajectories().iter().zip(&plain.episodes) {
            let (found, true_ones) = (trajectory.velocities().unwrap(), episode.velocities.as_ref().unwrap());
            prop_assert!((found - true_ones).norm() < 0.11 * true_ones.norm());
        }
    }
}

#[test]
fn factors_have_names() {
    for (factor, words) in [
        (1000.0, "millimetres"),
        (0.001, "positions in millimetres"),
        (57.3, "degrees"),
        (-1.0, "sign"),
        (STEP, "steps, not velocities"),
        (7.7, "units and time step"),
    ] {
        let prepared = prepared(&changed(|episode| episode.velocities.iter_mut().for_each(|u| *u *= factor)));
        let finding = prepared.findings.iter().find(|finding| finding.what.contains("times the steps")).unwrap();
        assert!(finding.next.contains(words), "{factor}: {finding:?}");
    }
    let one = prepared(&changed(|episode| {
        *episode.velocities.as_mut().unwrap() = {
            let mut u = episode.velocities.clone().unwrap();
            u.row_mut(1).apply(|u| *u *= 57.2958);
            u
        }
    }));
    assert_eq!(verdict(&one, "velocities of channel y are 57.3 times its steps"), Verdict::Doubtful);
}

#[test]
fn mismatched_velocities_are_doubted() {
    let shuffled = prepared(&changed(|episode| episode.velocities.as_mut().unwrap().swap_rows(0, 1)));
    assert_eq!(verdict(&shuffled, "recorded velocities do not match the steps"), Verdict::Doubtful);
    assert_eq!(shuffled.velocities, VelocitySource::Positions);
    let believed = PrepareOptions { velocities: VelocityUse::Recorded, ..PrepareOptions::default() };
    let swapped = changed(|episode| episode.velocities.as_mut().unwrap().swap_rows(0, 1));
    assert_eq!(prepare(&swapped, &believed).unwrap().velocities, VelocitySource::Recorded);
    let ignored = PrepareOptions { velocities: VelocityUse::Ignored, ..PrepareOptions::default() };
    assert_eq!(prepare(recordings(), &ignored).unwrap().velocities, VelocitySource::Positions);
    let mut some = recordings();
    some.episodes[5].velocities = None;
    assert_eq!(prepared(&some).velocities, VelocitySource::Positions);
    let requested = prepare(&some, &believed).unwrap();
    assert_eq!(requested.velocities, VelocitySource::Positions);
    let what = "recorded velocities were requested, but only 11 of 12 episodes have them";
    assert_eq!(verdict(&requested, what), Verdict::Doubtful);
}

/// Steps after exact positions are a map, and are learnt from; other differences contain less information than the positions.
#[test]
fn velocities_that_are_differences() {
    for ((before, after), expected) in
        [((0, 1), VelocitySource::Recorded), ((1, 0), VelocitySource::Positions), ((1, 1), VelocitySource::Positions)]
    {
        let recordings = changed(|episode| {
            let x = &episode.positions;
            let velocity = |axis: usize, i: usize| {
                let (from, to) = (i.saturating_sub(before), (i + after).min(SAMPLES - 1));
                (x[(axis, to)] - x[(axis, from)]) / (STEP * (to - from).max(1) as f64)
            };
            episode.velocities = Some(DMatrix::from_fn(2, SAMPLES, velocity));
        });
        assert_eq!(prepared(&recordings).velocities, expected, "{before} before, {after} after");
        let requested = PrepareOptions { smoothing: Smoothing::Off, ..PrepareOptions::default() };
        let is_learnt = expected == VelocitySource::Recorded;
        let expected = if is_learnt { expected } else { VelocitySource::PositionsAsRequested };
        assert_eq!(prepare(&recordings, &requested).unwrap().velocities, expected);
    }
}

#[test]
fn stamps() {
    for (times, unit) in [(1e3, "milliseconds"), (1e6, "microseconds")] {
        let in_unit = |episode: &mut Episode| episode.times.stamps_mut().iter_mut().for_each(|t| *t *= times);
        let recordings = changed(in_unit);
        let slow = prepared(&recordings);
        assert_eq!(verdict(&slow, &format!("read as {unit}")), Verdict::Doubtful);
        assert!((slow.time_step - STEP).abs() < 1e-12);
        assert_eq!(slow.decisions.iter().filter(|decision| decision.what == Subject::TimeStep).count(), 1);
        assert_eq!(slow.findings.len(), 1, "one fault, one finding: {:?}", slow.findings);
        // What the user gave is kept.
        let step = PrepareOptions { time_step: Some(times * STEP), ..PrepareOptions::default() };
        let unit_given = PrepareOptions { time_unit_given: true, ..PrepareOptions::default() };
        for given in [step, unit_given] {
            let kept = prepare(&recordings, &given).unwrap();
            assert!((kept.time_step / (times * STEP) - 1.0).abs() < 1e-12);
            assert_eq!(verdict(&kept, "times the steps; they were converted"), Verdict::Doubtful);
        }
        let positions = changed(|episode| {
            in_unit(episode);
            episode.velocities = None;
        });
        let slow = prepared(&positions);
        assert_eq!(verdict(&slow, &format!("stamps may be {unit}")), Verdict::Doubtful);
        assert_eq!(slow.time_step, times * STEP);
    }
    // 1/60 is not taken for a degree in radians.
    let minutes = prepared(&changed(|episode| episode.times.stamps_mut().iter_mut().for_each(|t| *t /= 60.0)));
    let next = &minutes.findings.iter().find(|finding| finding.what.contains("0.0167 times the steps")).unwrap().next;
    assert!(next.contains("minutes"), "{next}");
    let positions = changed(|episode| {
        episode.times.stamps_mut().iter_mut().for_each(|t| *t *= 1000.0);
        episode.velocities = None;
    });
    let given = PrepareOptions { time_step: Some(STEP), ..PrepareOptions::default() };
    let fixed = prepare(&positions, &given).unwrap();
    assert_eq!((fixed.time_step, fixed.findings.len()), (STEP, 0));
    // Half a per cent of jitter counts as even; half a step does not.
    let jitter = |share: f64| {
        prepared(&changed(|episode| {
            let stamps = episode.times.stamps();
            let times = stamps.iter().enumerate();
            episode.times = times.map(|(i, t)| t + share * STEP * if i % 2 == 0 { 0.5 } else { -0.5 }).collect();
        }))
    };
    assert_eq!(jitter(0.004).demonstrations.trajectories()[0].times(), None);
    assert!(jitter(0.5).demonstrations.trajectories()[0].times().is_some());
    let hole =
        prepared(&changed(|episode| episode.times.stamps_mut().iter_mut().skip(20).for_each(|t| *t += 10.0 * STEP)));
    assert_eq!(verdict(&hole, "samples are missing"), Verdict::Good);
    assert!((hole.demonstrations.trajectories()[0].seconds(19, 20) - 11.0 * STEP).abs() < 1e-12);
}

#[test]
fn copied_still_and_short_episodes_are_left_out() {
    let mut twice = recordings();
    twice.episodes.extend(recordings().episodes.into_iter().take(2));
    let twice = prepared(&twice);
    assert_eq!(twice.episodes.len(), 12);
    assert_eq!(twice.left_out.len(), 2);
    assert_eq!(twice.left_out[1].why, "the same samples as episode e1");
    assert_eq!(verdict(&twice, "2 of 14 episodes are exact copies of another"), Verdict::Good);
    let still = prepared(&changed(|episode| {
        if episode.name == "e7" {
            episode.positions.fill(0.3);
        }
    }));
    assert_eq!(still.left_out[0].episode, "e7");
    assert_eq!(still.left_out[0].why, "never moves");
    let short = prepared(&changed(|episode| {
        if episode.name == "e5" {
            *episode = episode.part(0, 1);
        }
    }));
    assert_eq!((short.left_out[0].episode.as_str(), short.left_out[0].why.as_str()), ("e5", "only 1 sample"));
    // With a jump and one back near the start, the parts before and between are too short to learn from.
    let jumps = prepared(&changed(|episode| {
        if episode.name == "e2" {
            episode.positions.columns_mut(2, 2).add_scalar_mut(3.0);
        }
    }));
    let left_out: Vec<_> = jumps.left_out.iter().map(|left_out| (&*left_out.episode, &*left_out.why)).collect();
    assert_eq!(
        left_out,
        [("e2", "only 2 samples beside a jump"), ("e2 from sample 2", "only 2 samples beside a jump")]
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// A copied episode, at any position and with any name, does not change the training data.
    #[test]
    fn copied_episodes_do_not_change_the_training_data(of in 0..12usize, to in 0..13usize, name in "[a-z]{1,8}") {
        let mut copied = recordings();
        let copy = Episode { name, ..copied.episodes[of].clone() };
        copied.episodes.insert(to.max(of + 1), copy);
        let (with, without) = (prepared(&copied), prepared(&recordings()));
        prop_assert_eq!(with.demonstrations, without.demonstrations);
        prop_assert_eq!(with.left_out.len(), 1);
    }

    /// The same path at another speed or under another constraint is another movement.
    #[test]
    fn the_same_path_is_not_the_same_movement(of in 0..12usize, speed in any::<bool>(), factor in 1.1..3.0f64) {
        let mut twice = recordings();
        let mut other = Episode { name: "other".to_owned(), ..twice.episodes[of].clone() };
        if speed {
            other.times = (0..SAMPLES).map(|i| STEP / factor * i as f64).collect();
            other.velocities.iter_mut().for_each(|velocities| *velocities *= factor);
        } else {
            other.constraint = Some("another".into());
        }
        twice.episodes.push(other);
        prop_assert_eq!(prepared(&twice).left_out, []);
    }
}

#[test]
fn reader_findings_come_first() {
    let found = Finding::remark("the bag ends", "repair it");
    let mut cut = recordings();
    cut.findings.push(found.clone());
    cut.episodes.truncate(5);
    let prepared = prepared(&cut);
    assert_eq!(prepared.findings[0], found);
    assert!(prepared.findings.len() > 1);
}

#[test]
fn rest_at_the_ends_is_reported_and_trimmed() {
    let resting = changed(|episode| {
        for i in 0..15 {
            episode.positions.set_column(i, &episode.positions.column(15).into_owned());
        }
        episode.velocities = None;
    });
    let found = prepared(&resting);
    assert_eq!(verdict(&found, "episode e0 begins with 15 samples at rest (and 11 more)"), Verdict::Good);
    let mut trimmed = resting.clone();
    trim_still(&mut trimmed);
    assert!(trimmed.episodes.iter().all(|episode| episode.n_samples() == SAMPLES - 15));
    assert!(trimmed.episodes.iter().all(|episode| episode.times.stamps()[0] == 0.0));
    assert!(!prepared(&trimmed).findings.iter().any(|finding| finding.what.contains("at rest")));
}

#[test]
fn noise_as_large_as_the_movement_is_no_stand_still() {
    // Pseudo-random numbers whose 4σ exceeds their range.
    let number = |i: usize| (i.wrapping_mul(2_654_435_761) >> 7) % 1000;
    let mut loud = recordings();
    loud.episodes.truncate(1);
    loud.episodes[0].times = (0..200).map(|i| f64::from(i) * STEP).collect();
    loud.episodes[0].positions = DMatrix::from_fn(2, 200, |axis, i| number(i + 500 * axis) as f64);
    loud.episodes[0].velocities = None;
    assert!(!prepared(&loud).findings.iter().any(|finding| finding.what.contains("at rest")));
}

#[test]
fn degrees_are_recognised_by_unit_name_and_range() {
    let named = |name: &str, unit: Option<&str>, factor: f64| {
        let mut recordings = changed(|episode| {
            episode.positions *= factor;
            episode.velocities = None;
        });
        recordings.state[0] = Channel { name: name.to_owned(), unit: unit.map(str::to_owned) };
        prepared(&recordings).findings.iter().any(|finding| finding.what.contains("seem to be in degrees"))
    };
    assert!(named("x", Some("deg"), 1.0) && named("elbow_deg", None, 1.0) && named("q1", None, 57.3));
    assert!(!named("q1", None, 1.0) && !named("q1", Some("rad"), 57.3) && !named("x", None, 57.3));
}

#[test]
fn a_jump_is_cut() {
    let jump = prepared(&changed(|episode| {
        if episode.name == "e2" {
            episode.positions.columns_mut(15, 25).add_scalar_mut(2.0);
        }
    }));
    assert_eq!(
        verdict(&jump, "1 of 12 episodes jumps and was split there (made, episode e2, sample 15: 'x' changes by 2.0"),
        Verdict::Good
    );
    assert_eq!(jump.episodes.len(), 13);
    assert_eq!((&*jump.episodes[2], &*jump.episodes[3]), ("e2", "e2 from sample 15"));
    assert_eq!(jump.recordings(), [0, 1, 2, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
    let lengths: Vec<_> = jump.demonstrations.trajectories()[2..4].iter().map(motion::Trajectory::n_samples).collect();
    assert_eq!(lengths, [15, 25]);
    // A step that takes as many times longer is no jump: samples are missing.
    let gap = prepared(&changed(|episode| {
        let keep: Vec<usize> = (0..SAMPLES).filter(|i| !(4..24).contains(i)).collect();
        episode.times = Times::Stamped(keep.iter().map(|&i| episode.times.stamps()[i]).collect());
        episode.positions = episode.positions.select_columns(&keep);
        episode.velocities = episode.velocities.as_ref().map(|velocities| velocities.select_columns(&keep));
    }));
    assert_eq!(gap.episodes.len(), 12);
    assert_eq!(verdict(&gap, "samples are missing"), Verdict::Good);
    assert!(!says(&gap, "jump"));
}

proptest! {
    /// Single positions and velocities far from their neighbours are interpolated: nearly the recordings without them.
    #[test]
    fn glitches_are_interpolated(at in 4..SAMPLES - 4, pair in any::<bool>(), size in 1.0..50.0f64, of in 0..3usize) {
        let glitch = changed(|episode| {
            if of != 1 {
                episode.positions.column_mut(at).add_scalar_mut(size);
            }
            if of != 0 {
                let count = if pair { 2 } else { 1 };
                episode.velocities.as_mut().unwrap().columns_mut(at, count).add_scalar_mut(-size);
            }
        });
        let found = prepared(&glitch);
        let words = if of == 1 { "unlike the steps before and after" } else { "far from the samples before and after" };
        prop_assert_eq!(verdict(&found, words), Verdict::Good);
        prop_assert!(found.findings.iter().all(|finding| finding.verdict == Verdict::Good), "{:?}", found.findings);
        let plain = recordings();
        for (movement, episode) in found.demonstrations.trajectories().iter().zip(&plain.episodes) {
            prop_assert!((movement.states() - &episode.positions).amax() < 1e-3);
            prop_assert!((movement.velocities().unwrap() - episode.velocities.as_ref().unwrap()).amax() < 1e-3);
        }
        let keep = PrepareOptions { jumps: Repair::Keep, ..PrepareOptions::default() };
        let kept = prepare(&glitch, &keep).unwrap();
        prop_assert!(kept.decisions.iter().all(|decision| decision.what != Subject::Jumps));
    }

    /// A constant that is added to velocities is found and subtracted; if they are in another unit as well, only the unit is repaired.
    #[test]
    fn velocities_with_a_constant_offset(x in prop_oneof![-0.5..-0.1f64, 0.1..0.5f64], y in -0.5..0.5f64, factor in prop::sample::select(vec![1.0, 1000.0])) {
        let offset = changed(|episode| {
            let velocities = episode.velocities.as_mut().unwrap();
            velocities.row_mut(0).add_scalar_mut(x);
            velocities.row_mut(1).add_scalar_mut(y);
            *velocities *= factor;
        });
        let found = self::prepared(&offset);
        let words = "recorded velocities exceed the steps by a constant (x by";
        if factor != 1.0 {
            prop_assert!(!says(&found, words), "{:?}", found.findings);
            return Ok(());
        }
        prop_assert_eq!(verdict(&found, words), Verdict::Doubtful);
        let plain = recordings();
        for (movement, episode) in found.demonstrations.trajectories().iter().zip(&plain.episodes) {
            let error = (movement.velocities().unwrap() - episode.velocities.as_ref().unwrap()).row(0).amax();
            prop_assert!(error < 1e-3, "{error}");
        }
    }

    /// A velocity that changes once and remains is no glitch: a constraint has switched.
    #[test]
    fn switches_are_no_glitches(at in 2..SAMPLES - 2, factor in -20.0..20.0f64) {
        let switch = changed(|episode| {
            let velocities = episode.velocities.as_mut().unwrap();
            velocities.columns_mut(at, SAMPLES - at).scale_mut(factor);
            for i in 1..SAMPLES {
                let step = (velocities.column(i - 1) + velocities.column(i)) * (0.5 * STEP);
                let next = episode.positions.column(i - 1) + step;
                episode.positions.set_column(i, &next);
            }
        });
        prop_assert!(!says(&self::prepared(&switch), "interpolated"));
    }

    /// A row of a rotation matrix beside a position is no quaternion, nor is a window that is shifted from the quaternion.
    #[test]
    fn unit_vectors_beside_other_channels_are_no_quaternion(height in 0.01..0.3f64, noise in prop::sample::select(vec![0.0, 1e-3])) {
        let row = moving(&["z", "r11", "r12", "r13"], |k, t| {
            let (tilt, turn) = (0.4 + 0.1 * k as f64, 0.7 * k as f64 + t);
            let r = [tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()];
            let x = DVector::from_vec(vec![height * (1.0 + 0.5 * (2.0 * t).sin()), r[0], r[1], r[2]]);
            (x, DVector::from_vec(vec![height * (2.0 * t).cos(), -r[1], r[0], 0.0]))
        });
        prop_assert!(!says(&self::prepared(&row), "unit quaternion"));
        let shifted = moving(&["z", "qw", "qx", "qy", "qz"], |k, t| {
            let (s, c) = (0.5 + 0.15 * k as f64 + 0.2 * t).sin_cos();
            let off = noise * (1e4 * (k as f64 + t)).sin();
            let (up, side) = (0.3 * t.sin()).sin_cos();
            let x = DVector::from_vec(vec![height * (1.0 + t), c + off, 0.6 * s, 0.8 * s * side, 0.8 * s * up]);
            (x, DVector::zeros(5))
        });
        let ignored = PrepareOptions { velocities: VelocityUse::Ignored, ..PrepareOptions::default() };
        let found = prepare(&shifted, &ignored).unwrap();
        prop_assert!(says(&found, "qw, qx, qy, qz are a unit quaternion") && !says(&found, "z, qw"), "{:?}", found.findings);
    }
}

#[test]
fn wrapped_angles_are_unwrapped() {
    let turn = std::f64::consts::TAU;
    let winding = |wrapped: bool| {
        changed(|episode| {
            let start = episode.positions[(0, 0)];
            for i in 0..SAMPLES {
                let angle = 2.9 + 0.2 * start + 0.03 * i as f64;
                episode.positions[(0, i)] = if wrapped { angle - turn * (angle / turn).round() } else { angle };
            }
            // One that wraps to the other end fills the range.
            episode.positions[(0, 0)] = episode.positions[(0, 0)].clamp(-3.1, 3.1);
            episode.velocities = None;
        })
    };
    let (wrapped, plain) = (prepared(&winding(true)), winding(false));
    assert_eq!(verdict(&wrapped, "channel 'x' jumps by 6."), Verdict::Doubtful);
    for (trajectory, episode) in wrapped.demonstrations.trajectories().iter().zip(&plain.episodes) {
        let off = trajectory.states()[(0, 20)] - episode.positions[(0, 20)];
        assert!((off / turn - (off / turn).round()).abs() < 1e-9);
        for i in 2..SAMPLES {
            let step = trajectory.states()[(0, i)] - trajectory.states()[(0, i - 1)];
            assert!((step - 0.03).abs() < 1e-9, "{step}");
        }
    }
}

#[test]
fn remarks() {
    let mixed = prepared(&changed(|episode| {
        episode.positions.row_mut(1).apply(|y| *y *= 57.3);
        episode.velocities = None;
    }));
    assert_eq!(verdict(&mixed, "channel y varies"), Verdict::Doubtful);
    let joints = ["a", "b", "c", "d", "e"];
    let mixed = prepared(&moving(&joints, |k, t| {
        let (phase, degrees) = (k as f64, |joint: usize| if joint < 2 { 57.3 } else { 1.0 });
        let at = |joint: usize| degrees(joint) * (t + phase * (1.0 + joint as f64)).sin();
        let rate = |joint: usize| degrees(joint) * (t + phase * (1.0 + joint as f64)).cos();
        (DVector::from_fn(5, |joint, _| at(joint)), DVector::from_fn(5, |joint, _| rate(joint)))
    }));
    assert_eq!(verdict(&mixed, "channels a, b vary up to"), Verdict::Doubtful);
    let next = |flag: &str| mixed.findings.iter().any(|finding| finding.next.contains(flag));
    assert!(next("--degrees a,b ") && next("--scale a=0.001,b=0.001 "));
    // The mean of equal numbers may be another number.
    let constant = prepared(&changed(|episode| {
        episode.positions.row_mut(1).fill(0.1);
        episode.velocities = None;
    }));
    assert!(!says(&constant, "different unit"), "{:?}", constant.findings);
    let mut three = recordings();
    three.episodes.truncate(3);
    assert_eq!(verdict(&prepared(&three), "3 movements are too few"), Verdict::Doubtful);
    let round = prepared(&changed(|episode| {
        let first = episode.positions.column(0).norm() + 0.5;
        episode.positions = DMatrix::from_fn(2, SAMPLES, |axis, i| {
            let angle = std::f64::consts::TAU * i as f64 / (SAMPLES - 1) as f64;
            first * if axis == 0 { angle.cos() } else { angle.sin() }
        });
        episode.velocities = None;
    }));
    assert_eq!(verdict(&round, "12 of 12 episodes return to their start"), Verdict::Good);
    let coarse = prepared(&changed(|episode| {
        episode.positions.apply(|x| *x = (*x * 10.0).round() / 10.0);
        episode.velocities = None;
    }));
    assert_eq!(verdict(&coarse, "positions have few digits"), Verdict::Good);
    // 0.1 / √12 in each channel, or more.
    assert!(coarse.noise.positions.as_ref().unwrap().iter().all(|sd| *sd > 0.028));
}

#[test]
fn smoothing_as_requested() {
    let smoothed_by = |recordings: &Recordings, smoothing| {
        prepare(recordings, &PrepareOptions { smoothing, ..PrepareOptions::default() })
    };
    let positions = changed(|episode| {
        // Noise in every other sample.
        let noise = |(i, x): (usize, f64)| x + if i % 2 == 0 { 0.01 } else { -0.01 };
        let noisy: Vec<f64> = episode.positions.row(0).iter().copied().enumerate().map(noise).collect();
        episode.positions.row_mut(0).copy_from_slice(&noisy);
        episode.velocities = None;
    });
    let off = smoothed_by(&positions, Smoothing::Off).unwrap();
    assert_eq!((off.velocities, off.averaged), (VelocitySource::PositionsAsRequested, 1));
    assert_eq!(decided(&off, "smoothing"), "none: positions as recorded");
    assert_eq!(off.demonstrations.trajectories()[0].states(), &positions.episodes[0].positions);
    let smoothed = smoothed_by(&positions, Smoothing::Samples(9)).unwrap();
    assert_eq!(decided(&smoothed, "smoothing"), "positions, window of 9 samples");
    assert_eq!(
        smoothed,
        Prepared { smoothing: Smoothing::Samples(9), ..smoothed_by(&positions, Smoothing::Seconds(0.44)).unwrap() }
    );
    let mut rates = positions.clone();
    rates.episodes[1].times = (0..SAMPLES).map(|i| STEP / 2.0 * i as f64).collect();
    let by_time = smoothed_by(&rates, Smoothing::Seconds(0.44)).unwrap();
    assert_eq!(decided(&by_time, "smoothing"), "positions, windows of 9 to 17 samples");
    let off_by = |prepared: &Prepared| {
        let pairs = prepared.demonstrations.trajectories().iter().zip(recordings().episodes);
        pairs.map(|(movement, episode)| (movement.states() - episode.positions).norm_squared()).sum::<f64>().sqrt()
    };
    assert!(off_by(&smoothed) < 0.3 * off_by(&off), "{} {}", off_by(&smoothed), off_by(&off));
    // Recorded velocities are unchanged, whatever happens to the positions.
    let with = smoothed_by(&recordings(), Smoothing::Samples(5)).unwrap();
    assert_eq!(with.velocities, VelocitySource::Recorded);
    assert_eq!(with.demonstrations.trajectories()[3].velocities(), recordings().episodes[3].velocities.as_ref());
    for window in [0, 3, 8] {
        let refused = smoothed_by(&recordings(), Smoothing::Samples(window)).unwrap_err();
        assert_eq!(refused, PrepareError::Smoothing { window, step: STEP });
    }
    assert!(
        smoothed_by(&recordings(), Smoothing::Seconds(0.1)).unwrap_err().to_string().contains("a window of 3 samples")
    );
}

#[test]
fn apparent_faults_can_be_kept() {
    let spiked = changed(|episode| episode.positions.column_mut(20).add_scalar_mut(3.0));
    let keep = PrepareOptions { jumps: Repair::Keep, wraps: Repair::Keep, ..PrepareOptions::default() };
    let kept = prepare(&spiked, &keep).unwrap();
    assert_eq!(kept.episodes.len(), 12);
    assert_eq!(kept.demonstrations.trajectories()[0].states(), &spiked.episodes[0].positions);
}

/// Few samples of many channels may be rows taken for columns, or a recording with few samples per episode, but enough in
/// total.
#[test]
fn more_channels_than_samples_are_refused_or_doubtful() {
    let turned = |times: usize| {
        let mut recordings = Recordings {
            state: (0..SAMPLES).map(|i| Channel { name: i.to_string(), unit: None }).collect(),
            ..changed(|episode| {
                episode.positions = episode.positions.transpose();
                episode.velocities = None;
                episode.times.stamps_mut().truncate(2);
            })
        };
        let once = recordings.episodes.clone();
        for time in 1..times {
            recordings.episodes.extend(once.iter().cloned().map(|mut episode| {
                episode.name = format!("{} again {time}", episode.name);
                episode.positions *= time as f64 + 1.0;
                episode
            }));
        }
        recordings
    };
    let refused = prepare(turned(1), &PrepareOptions::default()).unwrap_err();
    assert_eq!(refused, PrepareError::LooksTransposed { dim: SAMPLES, longest: 2, samples: 24 });
    let what = "the state has 40 dimensions and the longest episode 2 samples: rows and columns may be exchanged";
    assert_eq!(verdict(&prepared(&turned(5)), what), Verdict::Doubtful);
}

/// A joint that is held still shows the noise of its encoder; a slow drift three times as large is motion.
#[test]
fn held_channels_are_named() {
    let words = "z is held: only noise changes there";
    let jittery = |jitter: f64, motion: f64| {
        let mut recordings = changed(|episode| {
            let n = episode.n_samples();
            episode.velocities = None;
            episode.positions = episode.positions.clone().insert_row(2, 0.3);
            for i in 0..n {
                let noise = (1e4 * (i as f64 + 1.7).sin()).rem_euclid(1.0);
                episode.positions[(2, i)] += jitter * noise + motion * i as f64 / n as f64;
            }
        });
        recordings.state.push(Channel { name: "z".to_owned(), unit: None });
        prepared(&recordings)
    };
    for jitter in [1e-9, 1e-4, 0.1] {
        assert_eq!(verdict(&jittery(jitter, 0.0), words), Verdict::Doubtful);
        let moving = jittery(jitter, 3.0 * jitter);
        assert!(!moving.findings.iter().any(|finding| finding.what.contains(words)), "{jitter}");
    }
}

/// A channel that is held still has velocities of noise alone, which are no mistake of units. Large ones are.
#[test]
fn velocities_of_a_held_channel_are_noise_or_do_not_belong_to_it() {
    let held = |size: f64, jitter: f64| {
        changed(|episode| {
            let (n, velocities) = (episode.n_samples(), episode.velocities.take().expect("recorded"));
            let usual = velocities.norm() / (n as f64).sqrt();
            episode.positions = episode.positions.clone().insert_row(2, 0.3);
            for (i, mut x) in episode.positions.column_iter_mut().enumerate() {
                x[2] += jitter * (13.0 * i as f64).sin();
            }
            let noisy = DMatrix::from_fn(3, n, |k, i| {
                if k < 2 { velocities[(k, i)] } else { size * usual * (1.0 + 0.5 * (7.0 * i as f64).sin()) }
            });
            episode.velocities = Some(noisy);
        })
    };
    let of = |size: f64, jitter: f64| {
        let mut recordings = held(size, jitter);
        recordings.state.push(Channel { name: "z".to_owned(), unit: None });
        prepared(&recordings)
    };
    for jitter in [0.0, 1e-4] {
        assert_eq!(decided(&of(0.1, jitter), "velocities"), "recorded");
        let what = "velocities of channel z are not 0, although it never moves; they were set to 0";
        assert_eq!(verdict(&of(0.6, jitter), what), Verdict::Doubtful);
    }
}

#[test]
fn unusable_input_is_refused() {
    let refused = |recordings: &Recordings| prepare(recordings, &PrepareOptions::default()).unwrap_err();
    let none = Recordings { episodes: Vec::new(), ..recordings() };
    assert_eq!(refused(&none), PrepareError::Empty);
    let still = changed(|episode| episode.positions.fill(1.0));
    let why = "never moves".to_owned();
    assert_eq!(refused(&still), PrepareError::NothingLeft { of: 12, why });
    let with = |options: PrepareOptions| prepare(recordings(), &options).unwrap_err();
    let scale =
        |name: &str, factor| PrepareOptions { scale: vec![(name.to_owned(), factor)], ..PrepareOptions::default() };
    let unknown = PrepareError::UnknownChannel { name: "z".to_owned(), known: "x, y".to_owned() };
    assert_eq!(with(scale("z", 2.0)), unknown);
    for factor in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(with(scale("x", factor)), PrepareError::Scale { name: "x".to_owned(), factor });
        let options = PrepareOptions { time_step: Some(factor), ..PrepareOptions::default() };
        assert_eq!(with(options), PrepareError::TimeStep { time_step: factor });
    }
}

/// Twelve movements of these channels: positions and velocities of a movement at each time.
fn moving(names: &[&str], at: impl Fn(usize, f64) -> (DVector<f64>, DVector<f64>)) -> Recordings {
    let mut recordings = recordings();
    recordings.state = names.iter().map(|&name| Channel { name: name.to_owned(), unit: None }).collect();
    for (k, episode) in recordings.episodes.iter_mut().enumerate() {
        let samples: Vec<_> = (0..SAMPLES).map(|i| at(k, STEP * i as f64)).collect();
        episode.positions = DMatrix::from_columns(&samples.iter().map(|(x, _)| x.clone()).collect::<Vec<_>>());
        episode.velocities = Some(DMatrix::from_columns(&samples.iter().map(|(_, u)| u.clone()).collect::<Vec<_>>()));
    }
    recordings
}

fn says(prepared: &Prepared, words: &str) -> bool {
    prepared.findings.iter().any(|finding| finding.what.contains(words))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A decaying movement across n; along n the velocity is the same everywhere, up to a share `sway` from one movement to
    /// the next.
    #[test]
    fn a_press_is_found(angle in 0.1..1.4f64, push in 0.1..2.0f64, sway in 0.0..0.3f64, recorded in any::<bool>()) {
        let (n, across) = (DVector::from_vec(vec![angle.cos(), angle.sin()]), DVector::from_vec(vec![-angle.sin(), angle.cos()]));
        let of = |sway: f64, push: f64| {
            let mut recordings = moving(&["x", "y"], |k, t| {
                let (start, push) = (3.0 * (2.1 * k as f64).cos(), push * (1.0 + sway * (1.3 * k as f64).sin()));
                let decay = start * (-t).exp();
                (&across * decay + &n * (push * t), &across * -decay + &n * push)
            });
            if !recorded {
                recordings.episodes.iter_mut().for_each(|episode| episode.velocities = None);
            }
            self::prepared(&recordings)
        };
        let words = "is the same everywhere";
        prop_assert_eq!(verdict(&of(sway, push), words), Verdict::Doubtful);
        // Pushed to either side, and not at all.
        prop_assert!(!says(&of(4.0, push), words));
        prop_assert!(!says(&of(0.0, 0.0), words));
        prop_assert!(!says(&self::prepared(&recordings()), words));
    }

    /// x' = −2x, limited in speed. Noise is that of velocities if these are recorded, else that of positions, which hides the limit from
    /// single steps.
    #[test]
    fn a_speed_limit_is_found(limit in 0.3..0.9f64, noise in prop::sample::select(vec![0.0, 0.01]), recorded in any::<bool>()) {
        let of = |limit: f64| {
            let mut seed = 0.5_f64;
            let mut noisy = || { seed = (997.0 * seed + 0.3).fract(); noise * (seed - 0.5) };
            let mut at = move |k: usize, t: f64| {
                let start = (1.0 + 0.05 * k as f64) * [1.0, -1.0][k % 2];
                // At the limit until |x| = limit/2, then an exponential.
                let until = ((start.abs() - limit / 2.0) / limit).max(0.0);
                let x = if t < until { start.abs() - limit * t } else { (start.abs() - limit * until) * (-2.0 * (t - until)).exp() };
                let u = if t < until { -limit } else { -2.0 * x };
                let y = 0.3 * (0.9 * k as f64).cos() * (-0.5 * t).exp();
                let off = DVector::from_vec(vec![noisy(), noisy()]);
                let (at, velocity) = (DVector::from_vec(vec![x * start.signum(), y]), DVector::from_vec(vec![u * start.signum(), -0.5 * y]));
                if recorded { (at, velocity + off) } else { (at + off, velocity) }
            };
            let at = std::cell::RefCell::new(&mut at);
            let mut recordings = moving(&["x", "y"], |k, t| (*at.borrow_mut())(k, t));
            if !recorded {
                recordings.episodes.iter_mut().for_each(|episode| episode.velocities = None);
            }
            self::prepared(&recordings)
        };
        let limited = of(limit);
        // With noise of positions, y is too slow beside x to tell whether the limit is x's or the hand's.
        let exact = recorded || noise == 0.0;
        let (words, tolerance) = if exact { ("same largest speed along x", 0.03) } else { ("same largest speed", 0.06) };
        prop_assert_eq!(verdict(&limited, words), Verdict::Doubtful);
        let what = limited.findings.iter().map(|finding| &finding.what).find(|what| what.contains(words)).unwrap();
        let named: f64 = what.split(": a speed").next().and_then(|rest| rest.rsplit(", ").next()).unwrap().parse().unwrap();
        prop_assert!((named / limit - 1.0).abs() < tolerance, "{}", what);
        prop_assert!(!says(&of(10.0), "largest speed"));
    }

    /// Velocities recorded later or earlier than positions: the finding states the lag, and positions replace late velocities.
    #[test]
    fn a_lag_is_found(samples in prop_oneof![-6..-1isize, 2..7isize], rate in 1.0..3.0f64, noise in 0.0..0.001f64) {
        let recordings = moving(&["x", "y"], |k, t| {
            let at = |t: f64| [(rate * t + k as f64).sin(), (0.7 * rate * t - k as f64).cos()];
            let u = [rate * (rate * t + k as f64).cos(), -0.7 * rate * (0.7 * rate * t - k as f64).sin()];
            let off = |axis: f64| noise * ((1e4 * (k as f64 + 7.0 * axis) + 1e3 * t).sin() * 43_758.545_3).fract();
            (DVector::from_column_slice(&at(t)) + DVector::from_column_slice(&[off(1.0), off(2.0)]), DVector::from_column_slice(&u))
        });
        prop_assert!(!says(&self::prepared(&recordings), "than the steps"));
        let mut late = recordings.clone();
        for episode in &mut late.episodes {
            let u = episode.velocities.clone().unwrap();
            let at = |i: usize| i.saturating_add_signed(-samples).min(SAMPLES - 1);
            episode.velocities = Some(DMatrix::from_fn(2, SAMPLES, |axis, i| u[(axis, at(i))]));
        }
        let words = format!("{} s {}", prepare_numbers(STEP * samples.unsigned_abs() as f64), if samples > 0 { "later" } else { "earlier" });
        let prepared = self::prepared(&late);
        prop_assert!(says(&prepared, &words), "{} not said", words);
        prop_assert_eq!(prepared.velocities == VelocitySource::Positions, samples > 0, "{:?}", prepared.velocities);
    }

    /// Beside noisy positions, late velocities are shifted: each sample has the velocity that it had before the delay.
    #[test]
    fn late_velocities_beside_noisy_positions_are_shifted(rate in 1.7..2.0f64, noise in 0.034..0.06f64) {
        let samples = 3;
        let mut late = moving(&["x", "y"], |k, t| {
            let of = |t: f64| [(rate * t + k as f64).sin(), (0.7 * rate * t - k as f64).cos()];
            let u = [rate * (rate * t + k as f64).cos(), -0.7 * rate * (0.7 * rate * t - k as f64).sin()];
            let off = |axis: f64| noise * ((1e4 * (k as f64 + 7.0 * axis) + 1e3 * t).sin() * 43_758.545_3).fract();
            (DVector::from_column_slice(&of(t)) + DVector::from_column_slice(&[off(1.0), off(2.0)]), DVector::from_column_slice(&u))
        });
        let on_time: Vec<DMatrix<f64>> = late.episodes.iter().map(|episode| episode.velocities.clone().unwrap()).collect();
        for (episode, u) in late.episodes.iter_mut().zip(&on_time) {
            episode.velocities = Some(DMatrix::from_fn(2, SAMPLES, |axis, i| u[(axis, i.saturating_sub(samples))]));
        }
        let prepared = self::prepared(&late);
        prop_assert!(says(&prepared, &format!("{} s later", prepare_numbers(STEP * samples as f64))), "{:?}", prepared.findings);
        prop_assert_eq!(verdict(&prepared, "than the steps"), Verdict::Good);
        let scale = prepared.state.iter().map(|channel| channel.scale).next().unwrap();
        for (movement, u) in prepared.demonstrations.trajectories().iter().zip(&on_time) {
            prop_assert_eq!(movement.n_samples(), SAMPLES - samples);
            prop_assert_eq!(movement.velocities().unwrap(), &(u.columns(0, SAMPLES - samples) * scale));
        }
    }

    /// q and −q are one orientation: recordings with sign changes give the same result as without, also if noise changes the norm.
    #[test]
    fn signs_of_quaternions(
        flips in prop::collection::vec((1..12usize, 0..SAMPLES), 1..6), noise in prop::sample::select(vec![0.0, 1e-3, 5e-3]),
    ) {
        let plain = moving(&["x", "qx", "qy", "qz", "qw"], |k, t| {
            let (angle, rate) = (0.3 * k as f64 + 0.8 * (-t).exp(), -0.4 * (-t).exp());
            let (s, c) = (angle / 2.0).sin_cos();
            let axis = [0.6, 0.8 * (k as f64).cos(), 0.8 * (k as f64).sin()];
            let q = DVector::from_vec(vec![t.sin(), axis[0] * s, axis[1] * s, axis[2] * s, c]);
            let off = DVector::from_fn(5, |axis, _| noise * ((1e4 * (k as f64 + 7.0 * axis as f64) + 1e3 * t).sin() * 43_758.545_3).fract());
            let u = DVector::from_vec(vec![t.cos(), axis[0] * c * rate, axis[1] * c * rate, axis[2] * c * rate, -s * rate]);
            (q + off, u)
        });
        let mut flipped = plain.clone();
        for (episode, from) in flips {
            let episode = &mut flipped.episodes[episode];
            for i in from..SAMPLES {
                episode.positions.fixed_view_mut::<4, 1>(1, i).scale_mut(-1.0);
                episode.velocities.as_mut().unwrap().fixed_view_mut::<4, 1>(1, i).scale_mut(-1.0);
            }
        }
        let (found, expected) = (self::prepared(&flipped), self::prepared(&plain));
        prop_assert_eq!(verdict(&found, "qx, qy, qz, qw are a unit quaternion"), Verdict::Doubtful);
        prop_assert_eq!(&found.demonstrations, &expected.demonstrations);
        if flipped != plain {
            let keep = PrepareOptions { wraps: Repair::Keep, ..PrepareOptions::default() };
            let kept = prepare(&flipped, &keep).unwrap();
            prop_assert!(says(&kept, "unit quaternion"));
            prop_assert!(kept.decisions.iter().all(|decision| decision.what != Subject::Quaternions));
        }
    }

    /// Channels near a plane at distance 1 from 0, such as a yaw and a height of 1 m, are no quaternion.
    #[test]
    fn channels_near_one_are_no_quaternion(range in 0.05..0.5f64, lift in 0.0..0.01f64) {
        let recordings = moving(&["x", "y", "yaw", "height"], |k, t| {
            let at = |phase: f64| range * (1.7 * k as f64 + phase).sin() * (-t).exp();
            let x = DVector::from_vec(vec![at(0.0), at(1.0), at(2.0), 1.0 + lift * (k as f64 + t).cos()]);
            let u = DVector::from_vec(vec![-at(0.0), -at(1.0), -at(2.0), -lift * (k as f64 + t).sin()]);
            (x, u)
        });
        prop_assert!(!says(&self::prepared(&recordings), "unit quaternion"));
    }

    /// The number of places at which movements end, whatever the number of movements.
    #[test]
    fn ends_are_counted(places in 1..6usize, near in 0.0..0.01f64) {
        let mut recordings = moving(&["x", "y"], |k, t| {
            let end = k % places;
            let away = (-4.0 * t).exp() * (1.0 + k as f64) + near * (k as f64).sin();
            let x = [2.0 * (end as f64 * 1.1).cos() + away, 2.0 * (end as f64 * 1.1).sin() - 0.5 * away];
            (DVector::from_column_slice(&x), DVector::zeros(2))
        });
        recordings.episodes.iter_mut().for_each(|episode| episode.velocities = None);
        let demonstrations = self::prepared(&recordings).demonstrations;
        prop_assert_eq!(prepare::end_places(&demonstrations), Some(places));
    }
}

/// Formats a number as findings do.
fn prepare_numbers(value: f64) -> String {
    prepare::numbers::short(value)
}

/// Names of constraints that change within an episode mark switches, if each lasts long enough.
#[test]
fn labels_tell_switches() {
    let labelled = |every: usize| {
        changed(|episode| episode.constraint = Labels::of_samples((0..SAMPLES).map(|i| (i / every).to_string())))
    };
    let switches = |recordings: &Recordings| {
        let prepared = prepared(recordings);
        let labels = |movement: &motion::Trajectory| movement.labels().map(Labels::switches);
        (prepared.demonstrations.trajectories().iter().filter_map(labels).sum::<usize>(), prepared)
    };
    let (count, long) = switches(&labelled(10));
    assert_eq!(count, 12 * (SAMPLES.div_ceil(10) - 1));
    assert_eq!(decided(&long, "switches"), format!("{count}, in 12 episodes"));
    assert!(long.constraints.iter().all(Option::is_none) && long.findings.is_empty(), "{:?}", long.findings);
    let (count, short) = switches(&labelled(2));
    assert_eq!((count, verdict(&short, "labels of constraints change every 2 samples")), (0, Verdict::Good));
    assert!(short.decisions.iter().all(|decision| decision.what != Subject::Switches));
    // Names of whole episodes are no switches.
    assert!(prepared(&recordings()).decisions.iter().all(|decision| decision.what != Subject::Switches));
}
