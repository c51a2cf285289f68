/// The spacing of values on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Axis {
    /// Equal differences have equal lengths.
    Linear,
    /// Equal ratios have equal lengths. The lower end of the range is a power of ten. If `lowest` is less, the axis
    /// continues below it to the next tick, drawn broken, with decades ten times shorter. Values far below are then
    /// visible without taking space from the rest.
    Logarithmic {
        /// A positive value.
        lowest: f64,
    },
}

/// A decade within the range is as long as this many below it.
const SHORTER: f64 = 10.0;

impl Axis {
    /// Position of a value on the axis: decades above `from` on a logarithmic axis, the value itself on a linear one.
    pub(crate) fn place(self, value: f64, from: f64) -> f64 {
        match self {
            Axis::Linear => value,
            Axis::Logarithmic { .. } => {
                let decades = (value.max(f64::MIN_POSITIVE) / from).log10();
                if decades < 0.0 { decades / SHORTER } else { decades }
            }
        }
    }

    /// The positions of both ends.
    pub(crate) fn places(self, [from, to]: [f64; 2]) -> [f64; 2] {
        let low = match self {
            Axis::Linear => from,
            Axis::Logarithmic { lowest } => self.place(lowest.min(from), from).floor(),
        };
        [low, self.place(to, from)]
    }

    /// Lower and upper end of a band.
    pub(crate) fn band(self, mean: f64, sd: f64) -> [f64; 2] {
        let low = match self {
            Axis::Linear => mean - sd,
            Axis::Logarithmic { .. } if mean > 0.0 => mean * mean / (mean + sd),
            Axis::Logarithmic { .. } => 0.0,
        };
        [low, mean + sd]
    }
}

/// The label of a value at an integer position of a logarithmic axis: a decimal number, or a power of ten if that would
/// be long.
pub(crate) fn tick(place: f64, from: f64) -> String {
    let decades = if place < 0.0 { place * SHORTER } else { place };
    let exponent = (from.log10() + decades).round() as i32;
    if exponent.abs() <= 3 {
        return format!("{:.*}", usize::try_from(-exponent).unwrap_or(0), 10_f64.powi(exponent));
    }
    let raised = |letter: char| match letter {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LOGARITHMIC: Axis = Axis::Logarithmic { lowest: 1e-23 };

    proptest! {
        #[test]
        fn bands_are_symmetric_and_positive_on_logarithmic_axes(mean in 1e-6..1e6, share in 0.0..1e3) {
            let sd = mean * share;
            let [low, high] = Axis::Linear.band(mean, sd);
            prop_assert!(((mean - low) - (high - mean)).abs() <= 1e-12 * high);
            let [low, high] = LOGARITHMIC.band(mean, sd);
            prop_assert!(low > 0.0 && high == mean + sd);
            prop_assert!((mean / low - high / mean).abs() <= 1e-9 * (high / mean));
        }

        #[test]
        fn places_rise_with_values(a in -30.0..5.0, step in 0.01..10.0) {
            let [low, high] = [a, a + step].map(|exponent| LOGARITHMIC.place(10_f64.powf(exponent), 1e-3));
            prop_assert!(low < high);
        }
    }

    #[test]
    fn decades_below_the_range_are_ten_times_shorter() {
        let places = [1e-23, 1e-13, 1e-3, 1e-2, 1.0].map(|value| LOGARITHMIC.place(value, 1e-3));
        for (place, expected) in places.into_iter().zip([-2.0, -1.0, 0.0, 1.0, 3.0]) {
            assert!((place - expected).abs() < 1e-12, "{place} for {expected}");
        }
        let [low, high] = Axis::Logarithmic { lowest: 2e-21 }.places([1e-3, 10.0]);
        assert!((low + 2.0).abs() + (high - 4.0).abs() < 1e-12);
        assert_eq!(Axis::Logarithmic { lowest: 1.0 }.places([1e-3, 10.0])[0], 0.0);
        assert!(LOGARITHMIC.place(0.0, 1e-3) < -2.0, "0 is below all");
    }

    #[test]
    fn ticks_are_short() {
        let texts = [-2.0, -1.0, 0.0, 2.0, 3.0, 6.0, 7.0].map(|place| tick(place, 1e-3));
        assert_eq!(texts, ["10⁻²³", "10⁻¹³", "0.001", "0.1", "1", "1000", "10⁴"]);
    }
}
