/// Number of names that an error proposes.
const PROPOSALS: usize = 3;

/// Length in bytes up to which names are compared. Comparing takes time proportional to the product of two lengths,
/// and a single mistyped letter is unlikely in a name this long.
const LONGEST_NAME: usize = 64;

/// The names nearest to `wanted` by edit distance, nearest first, ties in the given order, ignoring case. Names
/// that share nothing with `wanted` are omitted, and so are very long ones.
pub(crate) fn near_names<'n>(wanted: &str, names: impl Iterator<Item = &'n str>) -> Vec<String> {
    if wanted.len() > LONGEST_NAME {
        return Vec::new();
    }
    let wanted = wanted.to_lowercase();
    let mut ranked: Vec<(usize, &str)> = names
        .filter(|name| name.len() <= LONGEST_NAME)
        .map(|name| (edit_distance(&wanted, &name.to_lowercase()), name))
        .filter(|(distance, name)| *distance < wanted.chars().count().max(name.chars().count()))
        .collect();
    ranked.sort_by_key(|(distance, _)| *distance);
    ranked.into_iter().take(PROPOSALS).map(|(_, name)| name.to_owned()).collect()
}

/// The least number of insertions, deletions and replacements of characters that turns `from` into `to`.
fn edit_distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, f) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, t) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(f != *t);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[to.len()]
}

/// The end of an error message, which proposes names.
pub(crate) fn proposal(near: &[String]) -> String {
    if near.is_empty() { String::new() } else { format!("; did you mean {}?", near.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_distance_counts_single_changes() {
        for (from, to, distance) in
            [("", "", 0), ("", "abc", 3), ("abc", "", 3), ("kitten", "sitting", 3), ("l_palm", "r_palm", 1)]
        {
            assert_eq!(edit_distance(from, to), distance, "{from} -> {to}");
        }
    }

    #[test]
    fn nearest_first_and_strangers_left_out() {
        let names = ["heel", "r_palm", "l_palm", "zzzzzzzzzzz"];
        assert_eq!(near_names("L_Plam", names.into_iter())[..2], ["l_palm", "r_palm"]);
        assert!(near_names("qq", ["zzz"].into_iter()).is_empty());
        assert_eq!(proposal(&[]), "");
    }

    #[test]
    fn names_of_more_than_64_letters_are_not_compared() {
        let [fits, long] = [64, 65].map(|length| "a".repeat(length));
        let nearly = "a".repeat(63) + "b";
        assert_eq!(near_names(&nearly, [long.as_str(), &fits].into_iter()), [fits.as_str()]);
        assert!(near_names(&long, [fits.as_str()].into_iter()).is_empty());
    }
}
