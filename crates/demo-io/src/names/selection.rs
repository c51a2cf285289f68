//! Patterns of names: `x`, `q*`, `q2-8`, `2-8`.

/// Patterns of quantities that a robot measures besides its state; they are state only if the user says so.
const MEASURED: [&str; 6] = ["*effort*", "*torque*", "*force*", "*wrench*", "*current*", "*temperature*"];

/// In these, "current" is what is now, not an electric current.
const ACTUAL: [&str; 5] = ["*current_*pos*", "*current_*ori*", "*current_*quat*", "*current_*rot*", "*current_*vel*"];

/// Whether a name, without the groups before it, is that of a measured quantity that is not state, or matches one of `others`.
pub(crate) fn is_not_state(name: &str, others: &[&str]) -> bool {
    let name = name.rsplit('/').next().unwrap_or(name).to_ascii_lowercase();
    let is_actual = ACTUAL.iter().any(|pattern| glob(pattern, &name));
    let measured = MEASURED.iter().filter(|pattern| !(is_actual && **pattern == "*current*"));
    measured.chain(others).any(|pattern| glob(pattern, &name))
}

/// The indices that patterns select, in the order of the patterns and, within a pattern, of the names; without
/// duplicates.
///
/// # Errors
///
/// The first pattern that matches nothing.
pub(crate) fn select<S: AsRef<str>>(patterns: &[String], names: &[S]) -> Result<Vec<usize>, String> {
    let mut chosen = Vec::new();
    for pattern in patterns.iter().flat_map(|pattern| split(pattern, names)) {
        let matching = matching(pattern, names);
        if matching.is_empty() {
            return Err(pattern.to_owned());
        }
        for index in matching {
            if !chosen.contains(&index) {
                chosen.push(index);
            }
        }
    }
    Ok(chosen)
}

/// As [`select`], but patterns may match nothing; returns a flag for each name.
pub(crate) fn flags<S: AsRef<str>>(patterns: &[String], names: &[S]) -> Vec<bool> {
    let mut flags = vec![false; names.len()];
    for pattern in patterns.iter().flat_map(|pattern| split(pattern, names)) {
        for index in matching(pattern, names) {
            flags[index] = true;
        }
    }
    flags
}

/// Splits a pattern at commas, unless the whole is a name.
fn split<'a, S: AsRef<str>>(pattern: &'a str, names: &[S]) -> Vec<&'a str> {
    if names.iter().any(|name| name.as_ref() == pattern) {
        return vec![pattern];
    }
    pattern.split(',').map(str::trim).filter(|part| !part.is_empty()).collect()
}

fn matching<S: AsRef<str>>(pattern: &str, names: &[S]) -> Vec<usize> {
    let all_that = |holds: &dyn Fn(&str) -> bool| -> Vec<usize> {
        names.iter().enumerate().filter(|(_, name)| holds(name.as_ref())).map(|(index, _)| index).collect()
    };
    let exact = all_that(&|name| name == pattern);
    if !exact.is_empty() {
        return exact;
    }
    let same_letters = all_that(&|name| name.eq_ignore_ascii_case(pattern));
    if !same_letters.is_empty() {
        return same_letters;
    }
    if let Some((first, last)) = range(pattern) {
        return (first..=last).take_while(|&index| index < names.len()).collect();
    }
    let globbed = all_that(&|name| glob(pattern, name));
    match numbered_range(pattern).filter(|_| globbed.is_empty()) {
        None => globbed,
        Some((stem, numbers)) => all_that(&|name| {
            let number = name.strip_prefix(stem).filter(|digits| digits.bytes().all(|digit| digit.is_ascii_digit()));
            number.and_then(|digits| digits.parse().ok()).is_some_and(|number: usize| numbers.contains(&number))
        }),
    }
}

/// Parses `2` or `2-8`.
fn range(pattern: &str) -> Option<(usize, usize)> {
    let (first, last) = pattern.split_once('-').unwrap_or((pattern, pattern));
    Some((first.trim().parse().ok()?, last.trim().parse().ok()?))
}

/// Parses `q2-8`: the names `q2` to `q8`.
fn numbered_range(pattern: &str) -> Option<(&str, std::ops::RangeInclusive<usize>)> {
    let (first, last) = pattern.rsplit_once('-')?;
    let stem = first.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let numbers = first[stem.len()..].parse().ok()?..=last.parse().ok()?;
    (!stem.is_empty()).then_some((stem, numbers))
}

/// Whether a pattern is a number or a range of numbers, such as `2` or `2-8`.
pub(crate) fn is_number(pattern: &str) -> bool {
    range(pattern).is_some()
}

/// The elements of patterns, split at commas.
pub(crate) fn parts<'a, S: AsRef<str>>(
    patterns: &'a [String],
    names: &'a [S],
) -> impl Iterator<Item = &'a str> + use<'a, S> {
    patterns.iter().flat_map(move |pattern| split(pattern, names))
}

/// The elements of patterns that match nothing.
pub(crate) fn unmatched<S: AsRef<str>>(patterns: &[String], names: &[S]) -> Vec<String> {
    parts(patterns, names).filter(|part| matching(part, names).is_empty()).map(str::to_owned).collect()
}

/// `*` matches any characters, `?` matches one. Nothing else is special, because names contain brackets.
pub(crate) fn glob(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        if p < pattern.len() && pattern[p] == '*' {
            star = Some((p, n));
            p += 1;
        } else if p < pattern.len() && (pattern[p] == '?' || pattern[p] == name[n]) {
            p += 1;
            n += 1;
        } else if let Some((at, eaten)) = star {
            star = Some((at, eaten + 1));
            p = at + 1;
            n = eaten + 1;
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|&letter| letter == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(pattern: &str, names: &[&str]) -> Result<Vec<usize>, String> {
        select(&[pattern.to_owned()], names)
    }

    #[test]
    fn names_globs_and_numbers_select() {
        let names = ["t", "q1", "q2", "gripper", "3"];
        assert_eq!(chosen("q*", &names), Ok(vec![1, 2]));
        assert_eq!(chosen("q2,q1", &names), Ok(vec![2, 1]));
        assert_eq!(chosen("1-2", &names), Ok(vec![1, 2]));
        assert_eq!(chosen("3", &names), Ok(vec![4]), "a name wins over a number");
        assert_eq!(chosen("Q1", &names), Ok(vec![1]));
        assert_eq!(chosen("q?,q*", &names), Ok(vec![1, 2]), "nothing twice");
        assert_eq!(chosen("q*,z", &names), Err("z".to_owned()));
        assert_eq!(chosen("7", &names), Err("7".to_owned()));
        assert_eq!(chosen("a,b", &["a,b", "a"]), Ok(vec![0]), "a name with a comma");
        assert_eq!(chosen("q1-2", &names), Ok(vec![1, 2]));
        assert_eq!(chosen("q2-9", &names), Ok(vec![2]));
        assert_eq!(chosen("q3-9", &names), Err("q3-9".to_owned()));
        assert_eq!(chosen("a-1", &["a1", "a-1"]), Ok(vec![1]), "a name with a minus");
        assert_eq!(chosen("s_9-10", &["s_9", "s_10", "s_1", "s_9a"]), Ok(vec![0, 1]));
    }

    #[test]
    fn globs_backtrack() {
        assert!(glob("*effort*", "joint_effort_1"));
        assert!(glob("a*b*c", "aXbbYc"));
        assert!(!glob("a*b", "abc"));
        assert!(glob("position[?]", "position[0]"));
        assert!(!glob("", "a"));
        assert!(glob("**", ""));
    }
}
