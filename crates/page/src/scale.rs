//! The common scale of the strips of one measure.

/// Ratio of largest to smallest value from which a scale is logarithmic.
const WIDE: f64 = 30.0;

/// Margin beyond the outermost values, as a share of the scale.
const MARGIN: f64 = 0.03;

/// Maximum number of ticks.
const TICKS: f64 = 4.2;

/// Maximum number of letters in the labels of all ticks, so that they do not touch.
const LETTERS: usize = 22;

/// Number of decades from which only powers of ten get ticks.
const MANY_DECADES: f64 = 1.7;

/// A reported result for comparison: a band of one standard deviation around a mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The reported mean.
    pub mean: f64,
    /// The reported standard deviation.
    pub sd: f64,
}

/// Maps values to positions on a strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    step: Step,
    /// Lower end of the scale; a logarithm on a logarithmic scale.
    from: f64,
    to: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Linear,
    Logarithmic,
}

impl Scale {
    /// A scale that contains all these values and references; logarithmic if the values span a wide range. None may be
    /// negative.
    pub fn around(values: impl IntoIterator<Item = f64>, references: impl IntoIterator<Item = Reference>) -> Scale {
        let mut values: Vec<f64> = values.into_iter().collect();
        let printed = references.into_iter().map(|Reference { mean, sd }| [mean - sd, mean, mean + sd]);
        let printed = printed.flatten();
        if logarithmic(&values) {
            values.extend(printed.filter(|&value| value > 0.0));
            let logarithms: Vec<f64> = values.iter().map(|value| value.log10()).collect();
            return Scale::spanning(Step::Logarithmic, range(&logarithms));
        }
        values.extend(printed.map(|value| value.max(0.0)));
        let (least, most) = range(&values);
        Scale::spanning(Step::Linear, (if least < most / 3.0 { 0.0 } else { least }, most))
    }

    fn spanning(step: Step, (from, to): (f64, f64)) -> Scale {
        let margin = if to > from { MARGIN * (to - from) } else { 0.5 };
        let from = if step == Step::Linear && from == 0.0 { from } else { from - margin };
        Scale { step, from, to: to + margin }
    }

    /// Position of a value, between 0 and 1; values beyond an end are clamped.
    pub(crate) fn place(self, value: f64) -> f64 {
        let value = match self.step {
            Step::Linear => value,
            Step::Logarithmic if value > 0.0 => value.log10(),
            Step::Logarithmic => self.from,
        };
        ((value - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// Round values on the scale, with their labels.
    pub(crate) fn ticks(self) -> Vec<(f64, String)> {
        let ticks: Vec<_> = match self.step {
            Step::Linear => {
                let step = round_step((self.to - self.from) / TICKS);
                let first = (self.from / step).ceil() as i32;
                let last = (self.to / step).floor() as i32;
                (first..=last).map(|i| f64::from(i) * step).map(|value| (value, short(value, step))).collect()
            }
            Step::Logarithmic => {
                let within: &[f64] = if self.to - self.from > MANY_DECADES { &[1.0] } else { &[1.0, 3.0] };
                let decades = self.from.floor() as i32..=self.to.floor() as i32;
                let values = decades.flat_map(|decade| within.iter().map(move |m| m * 10_f64.powi(decade)));
                let inside = values.filter(|value| (self.from..=self.to).contains(&value.log10()));
                inside.map(|value| (value, short(value, value))).collect()
            }
        };
        let letters: usize = ticks.iter().map(|(_, label)| label.len()).sum();
        ticks.into_iter().step_by(letters.div_ceil(LETTERS).max(1)).collect()
    }
}

fn logarithmic(values: &[f64]) -> bool {
    let (least, most) = range(values);
    least > 0.0 && most / least >= WIDE
}

/// Smallest and largest value; 0 if there are none.
fn range(values: &[f64]) -> (f64, f64) {
    let least = values.iter().copied().reduce(f64::min);
    let most = values.iter().copied().reduce(f64::max);
    (least.unwrap_or(0.0), most.unwrap_or(0.0))
}

/// 1, 2 or 5 times a power of ten, at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|m| m * power).into_iter().find(|&step| step >= least).unwrap_or(10.0 * power)
}

/// Formats a tick with as many decimals as its step needs.
fn short(value: f64, step: f64) -> String {
    let power = |value: f64| (value * 1.0001).log10().floor();
    let decimals = (-power(step)).max(0.0) as usize;
    if decimals > 4 && value > 0.0 {
        let digits = (power(value) - power(step)) as usize;
        format!("{value:.digits$e}")
    } else {
        format!("{value:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(scale: Scale) -> Vec<String> {
        scale.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn the_ends_of_a_scale_are_the_ends_of_the_strip() {
        let scale = Scale { step: Step::Logarithmic, from: -3.0, to: 1.0 };
        assert_eq!([1e-3, 0.1, 10.0, 1e-9, 0.0, 100.0].map(|value| scale.place(value)), [0.0, 0.5, 1.0, 0.0, 0.0, 1.0]);
        let scale = Scale::spanning(Step::Linear, (0.0, 0.0));
        assert_eq!(scale.place(0.0), 0.0);
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(Scale { step: Step::Linear, from: 0.0, to: 82.0 }), ["0", "20", "40", "60", "80"]);
        assert_eq!(ticks(Scale { step: Step::Linear, from: 0.00064, to: 0.00072 }), ["6.4e-4", "6.8e-4", "7.2e-4"]);
        assert_eq!(ticks(Scale { step: Step::Linear, from: 0.0, to: 0.031 }), ["0.00", "0.01", "0.02", "0.03"]);
        assert_eq!(ticks(Scale { step: Step::Logarithmic, from: -3.2, to: 0.2 }), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(ticks(Scale { step: Step::Logarithmic, from: -2.2, to: -0.7 }), ["0.01", "0.03", "0.1"]);
        assert_eq!(ticks(Scale { step: Step::Logarithmic, from: -5.5, to: -3.0 }), ["1e-5", "0.0001", "0.001"]);
    }

    #[test]
    fn wide_spread_is_shown_in_logarithms() {
        assert!(
            logarithmic(&[0.01, 0.4]) && !logarithmic(&[0.1, 0.4]) && !logarithmic(&[0.0, 4.0]) && !logarithmic(&[])
        );
    }
}
