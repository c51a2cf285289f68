/// How many proposals an error makes.
const PROPOSALS: usize = 3;

/// The names nearest to `wanted` by edit distance, nearest first, ties in the order given; case does not count.
/// Names that share nothing with `wanted` are left out.
pub(crate) fn near_names<'n>(wanted: &str, names: impl Iterator<Item = &'n str>) -> Vec<String> {
    let wanted = wanted.to_lowercase();
    let mut ranked: Vec<(usize, &str)> = names
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

/// The end of an error message: what was perhaps meant.
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
}
