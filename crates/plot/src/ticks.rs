//! Round values.

/// Round values from low to high: approximately `about`, and at least two.
pub(crate) fn ticks(low: f64, high: f64, about: f64) -> Vec<f64> {
    let power = 10_f64.powf(((high - low) / about).log10().floor());
    let every = |step: f64| {
        let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        (first..=last).map(|i| i as f64 * step).collect::<Vec<_>>()
    };
    let enough = |ticks: &Vec<f64>| ticks.len() >= 2;
    let coarsest = [10.0, 5.0, 2.0, 1.0, 0.5].map(|step| step * power);
    let not_finer = coarsest.iter().rposition(|step| step * about >= 0.999 * (high - low)).unwrap_or(0);
    coarsest[not_finer..].iter().map(|&step| every(step)).find(enough).unwrap_or_else(|| vec![low, high])
}

/// Number of decimals that distinguishes the ticks.
pub(crate) fn decimals(ticks: &[f64]) -> usize {
    let step = if let [a, b, ..] = ticks { b - a } else { 1.0 };
    (-(step.log10() + 1e-9).floor()).max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn ticks_are_round_and_within(low in -1e3..1e3, length in 1e-3..1e4, about in 2.0..12.0) {
            let high = low + length;
            let ticks = ticks(low, high, about);
            prop_assert!(ticks.len() >= 2 && ticks.len() as f64 <= 2.0 * about + 2.0);
            let slack = 1e-6 * length;
            prop_assert!(ticks.iter().all(|tick| (low - slack..=high + slack).contains(tick)));
            let text = |tick: &f64| format!("{:.*}", decimals(&ticks), tick);
            for (tick, text) in ticks.iter().map(|tick| (tick, text(tick))) {
                prop_assert!((text.parse::<f64>().unwrap() - tick).abs() < slack, "{tick} is written {text}");
            }
        }
    }
}
