//! What is unusual about episodes that can be read.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use crate::clean::rounded;
use crate::draft::Drafts;
use crate::roles::shortened;
use crate::statistics::{Statistics, Windows, median};
use crate::{Note, NoteKind, ReadOptions, recordings};

/// Leaves out repeated episodes and notes everything else.
pub(crate) fn notice(drafts: &mut Drafts, options: &ReadOptions) {
    leave_out_repeated(drafts);
    let statistics = Statistics::of(drafts);
    let mut notes = Vec::new();
    time(drafts, &mut notes);
    still(drafts, &statistics, options, &mut notes);
    jumps(drafts, &statistics, &mut notes);
    angles(drafts, &statistics, options, &mut notes);
    velocities(drafts, &mut notes);
    digits(drafts, &statistics, &mut notes);
    drafts.notes.append(&mut notes);
}

/// Spreads bits, as multiplication by any large odd number does.
const ODD: u64 = 0x517c_c1b7_2722_0a95;

/// An episode with the same positions as an earlier one.
fn leave_out_repeated(drafts: &mut Drafts) {
    let mut seen: HashMap<u64, Vec<usize>> = HashMap::new();
    let mut repeats: Vec<Option<usize>> = Vec::with_capacity(drafts.episodes.len());
    for (index, draft) in drafts.episodes.iter().enumerate() {
        let mix = |sum: u64, value: &f64| (sum.rotate_left(5) ^ value.to_bits()).wrapping_mul(ODD);
        let alike = seen.entry(draft.positions.iter().fold(0, mix)).or_default();
        let first = alike.iter().copied().find(|&other| drafts.episodes[other].positions == draft.positions);
        if first.is_none() {
            alike.push(index);
        }
        repeats.push(first);
    }
    for (index, first) in repeats.iter().enumerate() {
        if let Some(first) = first {
            let (twin, first) = (&drafts.episodes[index], &drafts.episodes[*first]);
            let text = format!(
                "episode {} is an exact copy of episode {} and was left out: {}",
                twin.name,
                first.name,
                twin.place(0, drafts.word)
            );
            drafts.notes.push(Note { kind: NoteKind::DuplicateEpisode, text });
        }
    }
    let mut repeats = repeats.into_iter();
    drafts.episodes.retain(|_| repeats.next().flatten().is_none());
}

/// Gaps and uneven steps, each episode by its own usual step.
fn time(drafts: &Drafts, notes: &mut Vec<Note>) {
    let overall = recordings::time_step(drafts.episodes.iter().map(|draft| &draft.times[..]));
    let mut gap: Option<(f64, String)> = None;
    let mut gaps = 0;
    let mut uneven: Option<(f64, String)> = None;
    let mut slowest = overall;
    let mut fastest = overall;
    for draft in &drafts.episodes {
        let own = if draft.len() < 4 { overall } else { recordings::time_step(std::iter::once(&draft.times[..])) };
        slowest = slowest.max(own);
        fastest = fastest.min(own);
        for (sample, pair) in draft.times.windows(2).enumerate() {
            let step = pair[1] - pair[0];
            let off = (step - own).abs() / own;
            if step > 3.0 * own {
                gaps += 1;
                gap.get_or_insert_with(|| (step, draft.place(sample + 1, drafts.word)));
            } else if off > 0.01 && uneven.as_ref().is_none_or(|(worst, _)| off > *worst) {
                uneven = Some((off, draft.place(sample + 1, drafts.word)));
            }
        }
    }
    if let Some((step, place)) = gap {
        let text = format!(
            "a gap of {} s, where steps usually take {} s: {place}{}; --split-gap SECONDS splits there",
            rounded(step),
            rounded(overall),
            and_more(gaps)
        );
        notes.push(Note { kind: NoteKind::Gap, text });
    }
    if let Some((off, place)) = uneven {
        let text =
            format!("time steps differ from {} s by up to {} %: {place}", rounded(overall), rounded(100.0 * off));
        notes.push(Note { kind: NoteKind::Uneven, text });
    }
    if slowest > 1.01 * fastest {
        let text = format!("episodes step by {} to {} s; each keeps its own step", rounded(fastest), rounded(slowest));
        notes.push(Note { kind: NoteKind::Uneven, text });
    }
}

fn and_more(count: usize) -> String {
    if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() }
}

fn still(drafts: &Drafts, statistics: &Statistics, options: &ReadOptions, notes: &mut Vec<Note>) {
    if options.trim_still {
        return;
    }
    let stretches: Vec<(usize, &str, &str)> = drafts
        .episodes
        .iter()
        .flat_map(|draft| {
            let (start, end) = statistics.still(draft);
            [(start, "begins", &draft.name[..]), (end, "ends", &draft.name[..])]
        })
        .filter(|&(samples, ..)| samples > 0)
        .collect();
    if let Some((samples, when, name)) = stretches.first() {
        let text = format!(
            "episode {name} {when} with {samples} samples at rest{}; --trim-still removes them",
            and_more(stretches.len())
        );
        notes.push(Note { kind: NoteKind::StandsStill, text });
    }
}

/// Steps over 20 times the usual one, alone or there and back.
fn jumps(drafts: &Drafts, statistics: &Statistics, notes: &mut Vec<Note>) {
    let n = drafts.channels.len();
    for channel in 0..n {
        let bound = 20.0 * (statistics.step[channel] + 6.0 * statistics.noise[channel]);
        if bound == 0.0 {
            continue;
        }
        let mut jump: Option<(f64, String)> = None;
        let mut jumps = 0;
        for draft in &drafts.episodes {
            let step =
                |sample: usize| draft.positions[sample * n + channel] - draft.positions[(sample - 1) * n + channel];
            let mut in_a_row = 0;
            for sample in 1..=draft.len() {
                if sample < draft.len() && step(sample).abs() > bound {
                    in_a_row += 1;
                    continue;
                }
                // Three in a row are a fast movement.
                if (1..=2).contains(&in_a_row) {
                    let first = sample - in_a_row;
                    jumps += 1;
                    jump.get_or_insert_with(|| (step(first), draft.place(first, drafts.word)));
                }
                in_a_row = 0;
            }
        }
        if let Some((step, place)) = jump {
            let name = &drafts.channels[channel].name;
            let text = format!(
                "'{name}' jumps by {}, where steps are usually {}: {place}{}",
                rounded(step),
                rounded(statistics.step[channel]),
                and_more(jumps)
            );
            notes.push(Note { kind: NoteKind::Jump, text });
        }
    }
}

fn angles(drafts: &Drafts, statistics: &Statistics, options: &ReadOptions, notes: &mut Vec<Note>) {
    let n = drafts.channels.len();
    let names: Vec<&str> = drafts.channels.iter().map(|channel| &channel.name[..]).collect();
    let in_radians = crate::selection::flags(&options.degrees, &names);
    let mut degrees = Vec::new();
    for (channel, described) in drafts.channels.iter().enumerate() {
        let (low, high) = (statistics.low[channel], statistics.high[channel]);
        if !in_radians[channel] && looks_like_degrees(&described.name, described.unit.as_deref(), low, high) {
            degrees.push(&described.name[..]);
        }
        let one_turn = (low >= -1.001 * PI && high <= 1.001 * PI) || (low >= -0.001 && high <= 1.001 * TAU);
        if one_turn && high - low > PI {
            let mut steps = drafts.episodes.iter().flat_map(|draft| {
                let value = move |sample: usize| draft.positions[sample * n + channel];
                (1..draft.len()).map(move |sample| (value(sample) - value(sample - 1), draft, sample))
            });
            if let Some((step, draft, sample)) = steps.find(|(step, ..)| step.abs() > PI) {
                let text = format!(
                    "'{}' jumps by {}, nearly a whole turn: {}; --unwrap makes angles continuous",
                    described.name,
                    rounded(step.abs()),
                    draft.place(sample, drafts.word)
                );
                notes.push(Note { kind: NoteKind::LooksWrapped, text });
            }
        }
    }
    if !degrees.is_empty() {
        let text = format!(
            "angles that seem to be in degrees: {}; --degrees with these names converts them",
            shortened(&degrees)
        );
        notes.push(Note { kind: NoteKind::LooksLikeDegrees, text });
    }
}

/// By its unit, else by its name, else a joint beyond what joints in radians reach.
fn looks_like_degrees(name: &str, unit: Option<&str>, low: f64, high: f64) -> bool {
    let name = name.to_lowercase();
    match unit.map(str::to_lowercase).as_deref() {
        Some("deg" | "degree" | "degrees" | "°") => return true,
        Some("") | None => {}
        Some(_) => return false,
    }
    let numbered = |stem: &str| {
        name.strip_prefix(stem)
            .is_some_and(|rest| rest.bytes().all(|letter| letter.is_ascii_digit() || b"_[]".contains(&letter)))
    };
    let joint =
        ["joint", "angle", "theta", "yaw", "pitch", "roll"].iter().any(|word| name.contains(word)) || numbered("q");
    let named =
        name.split(['_', '.', ' ', '[', '(', ']', ')']).any(|word| matches!(word, "deg" | "degree" | "degrees"));
    named || (joint && low.abs().max(high.abs()) > 1.1 * TAU)
}

/// Whether velocities belong to the steps: median of ‖u‖² Δt / uᵀΔx, which is 1 if they do.
fn velocities(drafts: &Drafts, notes: &mut Vec<Note>) {
    let mut ratios = Vec::new();
    Windows::new(drafts, 2).each_at(|draft, sample, n| {
        if draft.velocities.is_empty() {
            return;
        }
        let here = &draft.positions[sample * n..(sample + 1) * n];
        let next = &draft.positions[(sample + 1) * n..(sample + 2) * n];
        let u = &draft.velocities[sample * n..(sample + 1) * n];
        let along: f64 = u.iter().zip(here.iter().zip(next)).map(|(u, (here, next))| u * (next - here)).sum();
        let squared: f64 = u.iter().map(|u| u * u).sum();
        let ratio = squared * (draft.times[sample + 1] - draft.times[sample]) / along;
        if ratio.is_finite() {
            ratios.push(ratio);
        }
    });
    let Some(ratio) = median(&mut ratios) else { return };
    if (0.8..=1.25).contains(&ratio) {
        return;
    }
    let step = recordings::time_step(drafts.episodes.iter().map(|draft| &draft.times[..]));
    let near = |value: f64| (ratio / value - 1.0).abs() < 0.1;
    let guess = match ratio {
        _ if near(1000.0) || near(0.001) => "; millimetres beside metres?",
        _ if near(180.0 / PI) || near(PI / 180.0) => "; degrees beside radians?",
        _ if ratio < 0.0 => "; opposite sign, or a goal instead of a velocity?",
        _ if near(1.0 / step) || near(step) => "; steps instead of velocities?",
        _ => "",
    };
    let text = format!(
        "velocities are {} times the steps{guess} Make the units equal, or --ignore the velocity columns",
        rounded(ratio)
    );
    let text = if guess.is_empty() { text.replacen(" Make", "; make", 1) } else { text };
    notes.push(Note { kind: NoteKind::VelocityMismatch, text });
}

/// Whole numbers, and so few decimals that a channel has under a thousand steps.
fn digits(drafts: &Drafts, statistics: &Statistics, notes: &mut Vec<Note>) {
    if notes_say(drafts, NoteKind::Integers) || notes_say(drafts, NoteKind::CoarseFloats) {
        return;
    }
    let mut whole = Vec::new();
    let mut coarse = Vec::new();
    for (channel, described) in drafts.channels.iter().enumerate() {
        let spread = statistics.spread(channel);
        if spread == 0.0 {
            continue;
        }
        let grid = [1.0, 10.0, 100.0, 1000.0].into_iter().find(|&scale| {
            let mut on_grid = true;
            Windows::new(drafts, 1).each(|sample| {
                let value = sample[channel] * scale;
                on_grid &= (value - value.round()).abs() <= 1e-9 * value.abs().max(1.0);
            });
            on_grid
        });
        match grid {
            Some(1.0) => whole.push(&described.name[..]),
            Some(scale) if spread * scale < 1000.0 => coarse.push(&described.name[..]),
            _ => {}
        }
    }
    if !whole.is_empty() {
        let text = format!("positions are whole numbers: {}; rounding is noise of 0.29 units", shortened(&whole));
        notes.push(Note { kind: NoteKind::Integers, text });
    }
    if !coarse.is_empty() {
        let text =
            format!("positions have few decimals: {}; rounding is noise of 0.29 of the last", shortened(&coarse));
        notes.push(Note { kind: NoteKind::CoarseFloats, text });
    }
}

fn notes_say(drafts: &Drafts, kind: NoteKind) -> bool {
    drafts.notes.iter().any(|note| note.kind == kind)
}
