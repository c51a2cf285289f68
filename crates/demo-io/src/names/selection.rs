//! Patterns of names: `x`, `q*`, `2-8`.

/// The indices that patterns name, in the order of the patterns and, within one, of the names; none twice.
///
/// # Errors
///
/// The first pattern that names nothing.
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

/// As [`select`], but patterns that name nothing are no fault; one flag an index.
pub(crate) fn flags<S: AsRef<str>>(patterns: &[String], names: &[S]) -> Vec<bool> {
    let mut flags = vec![false; names.len()];
    for pattern in patterns.iter().flat_map(|pattern| split(pattern, names)) {
        for index in matching(pattern, names) {
            flags[index] = true;
        }
    }
    flags
}

/// The parts between commas, unless the whole is a name.
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
    all_that(&|name| glob(pattern, name))
}

/// `2` or `2-8`.
fn range(pattern: &str) -> Option<(usize, usize)> {
    let (first, last) = pattern.split_once('-').unwrap_or((pattern, pattern));
    Some((first.trim().parse().ok()?, last.trim().parse().ok()?))
}

/// `*` stands for any letters, `?` for one; nothing else is special, since names hold brackets.
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
