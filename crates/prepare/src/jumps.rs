use crate::Verdict;
use crate::episodes::Take;
use crate::prepared::Notes;

/// A step so many times the usual one, and so many times most of those about it, is a jump.
const LONG: f64 = 10.0;
/// So many steps about a step tell what is usual there, itself included.
const ABOUT: usize = 7;
/// Shorter pieces than this are not worth learning from.
const LEAST: usize = 4;
/// More episodes than this share with jumps are no accidents.
const MANY: f64 = 0.2;

/// Cuts episodes where a single step stands out from all about it: samples are missing there, or one is wrong.
pub(crate) fn cut(takes: &mut Vec<Take>, notes: &mut Notes) {
    let (episodes, mut cut, mut first) = (takes.len(), 0, None);
    *takes = takes
        .drain(..)
        .flat_map(|take| {
            let jumps = jumps(&take);
            if jumps.is_empty() {
                return vec![take];
            }
            cut += 1;
            let usual = usual(&lengths(&take)).unwrap_or(1.0);
            first.get_or_insert_with(|| (take.name.clone(), jumps[0], take.step(jumps[0]).norm() / usual));
            pieces(&take, &jumps)
        })
        .collect();
    let Some((name, sample, times)) = first else { return };
    notes.decided("jumps", format!("{cut} episodes split"), "one step is far longer than its neighbours", "--jumps");
    let verdict = if f64::from(cut) > MANY * episodes as f64 { Verdict::Doubtful } else { Verdict::Good };
    notes.found(
        verdict,
        format!(
            "{cut} of {episodes} episodes have a jump (episode {name}: the step after sample {sample} is {times:.0} times the usual one) and were split there"
        ),
        "check for missing samples, lost tracking or wrapped angles",
    );
}

fn lengths(take: &Take) -> Vec<f64> {
    (0..take.n_samples() - 1).map(|i| take.step(i).norm()).collect()
}

/// The sample before each jump.
fn jumps(take: &Take) -> Vec<usize> {
    let steps = lengths(take);
    let Some(usual) = usual(&steps) else { return Vec::new() };
    let stands_out = |&i: &usize| {
        let first = i.saturating_sub(ABOUT / 2).min(steps.len().saturating_sub(ABOUT));
        let about = &steps[first..(first + ABOUT).min(steps.len())];
        let shorter = about.iter().filter(|&&other| LONG * other < steps[i]).count();
        steps[i] > LONG * usual && 2 * shorter > about.len()
    };
    (0..steps.len()).filter(stands_out).collect()
}

/// The middle of the steps that move.
fn usual(steps: &[f64]) -> Option<f64> {
    let mut moving: Vec<f64> = steps.iter().copied().filter(|&step| step > 0.0).collect();
    let middle = moving.len() / 2;
    (!moving.is_empty()).then(|| *moving.select_nth_unstable_by(middle, f64::total_cmp).1)
}

fn pieces(take: &Take, jumps: &[usize]) -> Vec<Take> {
    let mut from = 0;
    let mut pieces = Vec::new();
    for to in jumps.iter().map(|jump| jump + 1).chain([take.n_samples()]) {
        if to - from >= LEAST {
            let mut piece = take.part(from, to);
            if from > 0 {
                piece.name = format!("{} from sample {from}", take.name);
            }
            pieces.push(piece);
        }
        from = to;
    }
    pieces
}
