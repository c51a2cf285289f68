//! Natural order: `demo_2` before `demo_10`.

use std::cmp::Ordering;

/// Compares runs of digits as numbers, everything else character by character.
pub(crate) fn compare(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    while let (Some(x), Some(y)) = (left.chars().next(), right.chars().next()) {
        let (x_digits, y_digits) = (digits(left), digits(right));
        if x_digits.is_empty() || y_digits.is_empty() {
            if x != y {
                return x.cmp(&y);
            }
            (left, right) = (&left[x.len_utf8()..], &right[y.len_utf8()..]);
            continue;
        }
        let (x_value, y_value) = (x_digits.trim_start_matches('0'), y_digits.trim_start_matches('0'));
        let order = x_value.len().cmp(&y_value.len()).then_with(|| x_value.cmp(y_value));
        if order != Ordering::Equal {
            return order;
        }
        (left, right) = (&left[x_digits.len()..], &right[y_digits.len()..]);
    }
    left.len().cmp(&right.len()).then_with(|| a.cmp(b))
}

fn digits(text: &str) -> &str {
    &text[..text.bytes().take_while(u8::is_ascii_digit).count()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_sort_numerically() {
        let mut names = ["demo_10", "demo_2", "demo_1", "demo", "take 3b", "take 03a", "demo_002"];
        names.sort_by(|a, b| compare(a, b));
        assert_eq!(names, ["demo", "demo_1", "demo_002", "demo_2", "demo_10", "take 03a", "take 3b"]);
    }
}
