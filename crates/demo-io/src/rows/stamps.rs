//! Converts stamps of every kind to seconds from an episode's first sample.
//!
//! Seconds since 1970 in f64 have a resolution of 2.4e-7 s, which makes the steps of a 1 kHz recording uneven. Therefore
//! stamps are stored as an integer and a fraction, and the first one is subtracted before any division.

use crate::TimeUnit;

/// A stamp in any unit, not yet converted to f64: `whole` + `part`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stamp {
    whole: i64,
    part: f64,
}

/// Below this, f64 holds all digits that occur in files.
const LARGE: f64 = 1e6;

impl Stamp {
    pub(crate) const MISSING: Stamp = Stamp { whole: 0, part: f64::NAN };

    pub(crate) fn whole(value: i64) -> Self {
        Stamp { whole: value, part: 0.0 }
    }

    pub(crate) fn number(value: f64) -> Self {
        let fits = value.abs() >= LARGE && value.abs() < 9e18;
        if fits { Stamp { whole: value.trunc() as i64, part: value.fract() } } else { Stamp { whole: 0, part: value } }
    }

    /// Parses digits, decimals, or a date; with the unit if the text determines it.
    pub(crate) fn text(text: &str) -> Option<(Self, Option<TimeUnit>)> {
        if let Ok(whole) = text.parse() {
            return Some((Stamp::whole(whole), None));
        }
        if let Ok(value) = text.parse::<f64>() {
            let plain = text.bytes().all(|letter| letter.is_ascii_digit() || letter == b'.' || letter == b'-');
            if let (true, true, Some((digits, decimals))) = (plain, value.abs() >= LARGE, text.split_once('.'))
                && let (Ok(whole), Ok(part)) = (digits.parse(), format!("0.{decimals}").parse::<f64>())
            {
                return Some((Stamp { whole, part: part.copysign(value) }, None));
            }
            return Some((Stamp::number(value), None));
        }
        nanoseconds_of_date(text).map(|whole| (Stamp::whole(whole), Some(TimeUnit::Nanoseconds)))
    }

    /// Adds the nanoseconds of another column; the unit of the sum is nanoseconds.
    pub(crate) fn with_nanoseconds(self, nanoseconds: f64) -> Self {
        let whole = self.whole.saturating_mul(1_000_000_000);
        let part = self.part * 1e9 + nanoseconds;
        if part.is_finite() {
            Stamp { whole: whole.saturating_add(part.trunc() as i64), part: part.fract() }
        } else {
            Stamp::MISSING
        }
    }

    pub(crate) fn is_finite(self) -> bool {
        self.part.is_finite()
    }

    /// Number of units since `first`.
    pub(crate) fn since(self, first: Stamp) -> f64 {
        (i128::from(self.whole) - i128::from(first.whole)) as f64 + (self.part - first.part)
    }

    fn magnitude(self) -> f64 {
        self.whole as f64 + self.part
    }

    /// The unit of a column's stamps, guessed from its name (`t_ms`, `time [us]`), else from the size of this first one: a stamp far too
    /// large for seconds since 1970 counts milliseconds, microseconds or nanoseconds.
    pub(crate) fn unit(self, name: &str) -> TimeUnit {
        unit_in(name).unwrap_or_else(|| match self.magnitude().abs() {
            size if size > 1e17 => TimeUnit::Nanoseconds,
            size if size > 1e14 => TimeUnit::Microseconds,
            size if size > 1e11 => TimeUnit::Milliseconds,
            _ => TimeUnit::Seconds,
        })
    }
}

/// The unit at the end of a column's name.
fn unit_in(name: &str) -> Option<TimeUnit> {
    let name = name.trim().to_ascii_lowercase();
    let name = name.trim_end_matches([']', ')']);
    TimeUnit::of(name.rsplit(['_', '[', '(', ' ']).next().filter(|unit| unit.len() < name.len())?)
}

/// Nanoseconds since 1970 of `2023-11-14 22:13:20.05` or `14.11.2023 22:13:20,05`, with `T` or a blank, with or without a
/// zone.
fn nanoseconds_of_date(text: &str) -> Option<i64> {
    let (date, clock) = text.trim().split_once(['T', ' ', 't'])?;
    let day_first = date.contains('.');
    let mut date = date.splitn(3, if day_first { ['.', '.'] } else { ['-', '/'] });
    let parts = [number(date.next()?)?, number(date.next()?)?, number(date.next()?)?];
    let [year, month, day] = if day_first { [parts[2], parts[1], parts[0]] } else { parts };
    if !(1..=9999).contains(&year) || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    let (clock, zone) = split_zone(clock.trim())?;
    let mut clock = clock.splitn(3, ':');
    let (hour, minute) = (number(clock.next()?)?, number(clock.next()?)?);
    let (second, fraction) = clock.next().map_or(Some((0, 0)), seconds)?;
    if hour > 24 || minute > 59 || second > 60 {
        return None;
    }
    let seconds = days_since_1970(year, month, day) * 86400 + hour * 3600 + minute * 60 + second - zone;
    seconds.checked_mul(1_000_000_000)?.checked_add(fraction)
}

fn number(digits: &str) -> Option<i64> {
    digits.bytes().all(|digit| digit.is_ascii_digit()).then(|| digits.parse().ok())?
}

/// Splits `20.05` into whole seconds and nanoseconds.
fn seconds(text: &str) -> Option<(i64, i64)> {
    let (whole, decimals) = text.split_once(['.', ',']).unwrap_or((text, ""));
    let nanoseconds: String = decimals.chars().chain("000000000".chars()).take(9).collect();
    Some((number(whole)?, number(&nanoseconds)?))
}

/// The time of day without its zone, and the zone in seconds east of Greenwich.
fn split_zone(clock: &str) -> Option<(&str, i64)> {
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock, 0));
    }
    let Some(at) = clock.rfind(['+', '-']) else { return Some((clock, 0)) };
    let (clock, zone) = clock.split_at(at);
    let sign = if zone.starts_with('-') { -1 } else { 1 };
    let digits: String = zone[1..].chars().filter(|&letter| letter != ':').collect();
    let (hours, minutes) = if digits.len() > 2 { digits.split_at_checked(2)? } else { (digits.as_str(), "0") };
    let (hours, minutes) = (number(hours)?, number(minutes)?);
    (hours < 24 && minutes < 60).then(|| (clock.trim_end(), sign * (hours * 3600 + minutes * 60)))
}

/// Days from 1970 to a date of the Gregorian calendar. Years count from March, so that the leap day is the last.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let era = year.div_euclid(400);
    let year_of_era = year.rem_euclid(400);
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds_between(name: &str, first: &str, second: &str) -> f64 {
        let (first, unit) = Stamp::text(first).unwrap();
        let unit = unit.unwrap_or_else(|| first.unit(name));
        Stamp::text(second).unwrap().0.since(first) / unit.per_second()
    }

    #[test]
    fn stamps_of_every_kind_give_the_same_step() {
        for (name, first, second) in [
            ("t", "0", "0.05"),
            ("timestamp", "1700000000000000000", "1700000000050000000"),
            ("timestamp", "1700000000000000", "1700000000050000"),
            ("timestamp", "1700000000000", "1700000000050"),
            ("timestamp", "1700000000.000", "1700000000.050"),
            ("t_ms", "10", "60"),
            ("time [us]", "0", "50000"),
            ("time_ns", "0", "50000000"),
            ("t", "2023-11-14 22:13:20.000", "2023-11-14 22:13:20.050000"),
            ("t", "2023-11-14T22:13:20Z", "2023-11-14T22:13:20,05Z"),
            ("t", "2023-11-14T23:13:20+01:00", "2023-11-14T22:13:20.05Z"),
            ("t", "2023-11-14T17:13:20-0500", "2023-11-14T22:13:20.05+00"),
            ("t", "14.11.2023 22:13:20.000", "14.11.2023 22:13:20,050"),
            ("t", "14.11.2023 22:13:20", "2023-11-14 22:13:20.05"),
            ("t", "4.3.2023 9:00:59,97", "04.03.2023 09:01:00.02"),
        ] {
            assert_eq!(seconds_between(name, first, second), 0.05, "{name}: {first} to {second}");
        }
    }

    #[test]
    fn dates_are_counted_as_the_calendar_does() {
        for (date, seconds) in [
            ("1970-01-01T00:00:00Z", 0),
            ("2000-02-29 00:00:00", 951_782_400),
            ("2023-11-14 22:13:20", 1_700_000_000),
            ("1969-12-31 23:59:59", -1),
        ] {
            assert_eq!(nanoseconds_of_date(date), Some(seconds * 1_000_000_000), "{date}");
        }
    }

    #[test]
    fn invalid_stamps_are_refused() {
        for text in [
            "",
            "soon",
            "12:30",
            "2023-13-01 00:00",
            "2023-11-14",
            "2023-11-14 22",
            "é-1-1 1:1",
            "1-1-1 1:1+é",
            "2023-11-14 22:13:20+24:00",
            "2023-11-14 22:13:20+01:60",
            "2023-11-14 22:13:20+0099999999999999999",
            "14.13.2023 1:00",
            "32.1.2023 1:00",
            "2023.11.14 1:00",
            "14.11.2023",
        ] {
            assert!(Stamp::text(text).is_none(), "{text}");
        }
    }

    #[test]
    fn seconds_and_nanoseconds_are_one_stamp() {
        let stamp = |seconds: &str, nanoseconds| Stamp::text(seconds).unwrap().0.with_nanoseconds(nanoseconds);
        let first = stamp("1700000000", 999_999_999.0);
        assert_eq!(stamp("1700000001", 1.0).since(first), 2.0);
        assert_eq!(stamp("0.5", 3.0).since(stamp("0", 0.0)), 500_000_003.0);
        assert!(!stamp("1", f64::NAN).is_finite());
    }

    #[test]
    fn the_greatest_integers_do_not_overflow() {
        let difference = Stamp::whole(i64::MAX).since(Stamp::whole(i64::MIN));
        assert_eq!(difference, 2f64.powi(64));
        assert!(!Stamp::MISSING.is_finite());
    }
}
