//! Markdown tables that are aligned as plain text too.

/// A table with a header line; every row must have as many cells.
///
/// # Panics
///
/// Where a row has fewer cells than the header.
pub fn markdown_table(header: &[&str], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([header[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let padded = cells.zip(&widths).map(|(cell, &width)| format!(" {cell:<width$} "));
        format!("|{}|\n", padded.collect::<Vec<_>>().join("|"))
    };
    let rule: Vec<String> = widths.iter().map(|width| "-".repeat(*width)).collect();
    let mut table = line(&mut header.iter().copied());
    table += &line(&mut rule.iter().map(String::as_str));
    for row in rows {
        table += &line(&mut row.iter().map(String::as_str));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [vec!["a ± b".to_owned(), "1".to_owned()], vec!["c".to_owned(), "22".to_owned()]];
        let expected = "| x     | long |\n| ----- | ---- |\n| a ± b | 1    |\n| c     | 22   |\n";
        assert_eq!(markdown_table(&["x", "long"], &rows), expected);
    }
}
