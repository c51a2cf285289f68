//! Markdown tables.

/// A table with a header line; every row must have the same number of cells. Cells are not padded.
///
/// # Panics
///
/// If a row and the header have different numbers of cells.
pub fn markdown_table(header: &[&str], rows: &[Vec<String>]) -> String {
    let rule = vec!["---"; header.len()];
    let mut table = line(header) + &line(&rule);
    for row in rows {
        assert_eq!(row.len(), header.len(), "cells of a row");
        table += &line(row);
    }
    table
}

fn line<S: std::borrow::Borrow<str>>(cells: &[S]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stand_in_their_columns() {
        let rows = [vec!["a ± b".to_owned(), "1".to_owned()], vec![String::new(), "22".to_owned()]];
        let expected = "| x | long |\n| --- | --- |\n| a ± b | 1 |\n|  | 22 |\n";
        assert_eq!(markdown_table(&["x", "long"], &rows), expected);
    }

    #[test]
    #[should_panic(expected = "cells of a row")]
    fn a_row_with_a_cell_too_few_is_refused() {
        markdown_table(&["x", "y"], &[vec!["1".to_owned()]]);
    }
}
