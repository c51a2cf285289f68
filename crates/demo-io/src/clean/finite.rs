//! Missing numbers: an error, or dropped with their sample, or interpolated.

use crate::raw::RawEpisode;
use crate::{Fault, Nan, ReadError};

/// At most this many samples in a row are interpolated.
const LONGEST_FILL: usize = 3;

const REFUSED: &str = "--nan drop (leaves the sample out) or --nan fill (interpolates gaps of up to 3 samples)";
const UNFILLED: &str = "--nan drop (leaves the sample out); --nan fill interpolates at most 3 in a row, neither stamps nor the ends of an episode";

/// Applies `nan`, and returns the number of samples that were not finite.
pub(super) fn make_finite(raw: &mut RawEpisode, names: &[String], word: &str, nan: Nan) -> Result<usize, ReadError> {
    let n = names.len();
    let bad: Vec<usize> = (0..raw.len()).filter(|&sample| !is_finite(raw, sample, n)).collect();
    let (Some(&first), count) = (bad.first(), bad.len()) else { return Ok(0) };
    match nan {
        Nan::Refuse => Err(not_finite(raw, first, names, word, REFUSED)),
        Nan::Drop => {
            let mut bad = bad.into_iter().peekable();
            let finite: Vec<usize> = (0..raw.len()).filter(|sample| bad.next_if_eq(sample).is_none()).collect();
            *raw = raw.chosen(finite.iter().copied());
            Ok(())
        }
        Nan::Fill => bad.chunk_by(|a, b| a + 1 == *b).try_for_each(|run| {
            let (before, after) = (run[0].wrapping_sub(1), run[run.len() - 1] + 1);
            let fits = run[0] > 0 && after < raw.len() && run.len() <= LONGEST_FILL;
            if !fits || run.iter().any(|&sample| !raw.times[sample].is_finite()) {
                return Err(not_finite(raw, run[0], names, word, UNFILLED));
            }
            interpolate(raw, run, before, after, n);
            Ok(())
        }),
    }?;
    Ok(count)
}

fn is_finite(raw: &RawEpisode, sample: usize, n: usize) -> bool {
    let columns = sample * n..(sample + 1) * n;
    raw.times[sample].is_finite()
        && raw.positions[columns.clone()].iter().all(|value| value.is_finite())
        && (raw.velocities.is_empty() || raw.velocities[columns].iter().all(|value| value.is_finite()))
}

/// Error: names the missing values of a sample.
fn not_finite(raw: &RawEpisode, sample: usize, names: &[String], word: &str, remedy: &str) -> ReadError {
    let n = names.len();
    let here = |numbers: &[f64]| {
        let values = numbers.get(sample * n..(sample + 1) * n)?;
        values.iter().enumerate().find(|(_, value)| !value.is_finite()).map(|(channel, &value)| (channel, value))
    };
    let (what, value) = if !raw.times[sample].is_finite() {
        ("the stamp".to_owned(), raw.times[sample])
    } else if let Some((channel, value)) = here(&raw.positions) {
        (format!("'{}'", names[channel]), value)
    } else {
        let (channel, value) = here(&raw.velocities).unwrap_or((0, f64::NAN));
        (format!("the velocity of '{}'", names[channel]), value)
    };
    let found = if value.is_nan() { "missing or NaN".to_owned() } else { format!("{value}") };
    ReadError::NotFinite(Fault::new(format!("{what} is not a finite number: {found}"), raw.place(sample, word), remedy))
}

/// Interpolates missing values linearly in time between the samples around a run.
fn interpolate(raw: &mut RawEpisode, run: &[usize], before: usize, after: usize, n: usize) {
    let times = &raw.times;
    for numbers in [&mut raw.positions, &mut raw.velocities] {
        if numbers.is_empty() {
            continue;
        }
        for &sample in run {
            let share = (times[sample] - times[before]) / (times[after] - times[before]);
            let share = if share.is_finite() { share } else { 0.5 };
            for channel in 0..n {
                if !numbers[sample * n + channel].is_finite() {
                    let (low, high) = (numbers[before * n + channel], numbers[after * n + channel]);
                    numbers[sample * n + channel] = low + share * (high - low);
                }
            }
        }
    }
}
