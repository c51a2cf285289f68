use motion::{Channel, Subject, upper_median};
use nalgebra::DVector;

use crate::notes::Notes;
use crate::options::PrepareOptions;
use crate::{PrepareError, StateChannel};

/// Factor of each channel, (n).
pub(crate) fn scales(
    channels: &[Channel],
    options: &PrepareOptions,
    notes: &mut Notes,
) -> Result<DVector<f64>, PrepareError> {
    let mut scales = DVector::repeat(channels.len(), 1.0);
    for (name, factor) in &options.scale {
        if !(*factor > 0.0 && factor.is_finite()) {
            return Err(PrepareError::Scale { name: name.clone(), factor: *factor });
        }
        if let Some(channel) = channels.iter().position(|channel| channel.name == *name) {
            scales[channel] = *factor;
        } else {
            let known: Vec<_> = channels.iter().map(|channel| channel.name.as_str()).collect();
            return Err(PrepareError::UnknownChannel { name: name.clone(), known: known.join(", ") });
        }
        notes.decided(Subject::Scale, format!("{name} times {factor}"), "given");
    }
    Ok(scales)
}

/// The smallest and the largest of some values.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Names, units and ranges of channels in the user's units, from their scaled values.
pub(crate) fn channels(
    channels: &[Channel],
    scales: &DVector<f64>,
    values: impl Fn(usize) -> Vec<f64>,
) -> Vec<StateChannel> {
    let described = |(at, channel): (usize, &Channel)| {
        let values: Vec<f64> = values(at).into_iter().map(|x| x / scales[at]).collect();
        let (low, high) = range(values.iter().copied());
        let median = upper_median(values).expect("demonstrations have samples");
        StateChannel { name: channel.name.clone(), unit: channel.unit.clone(), scale: scales[at], low, high, median }
    };
    channels.iter().enumerate().map(described).collect()
}
