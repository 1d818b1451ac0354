//! The rows of a table of which a list continues along each.

/// The cells of each row: that of the first column, and those of the columns beside it that are as long.
pub(super) fn table_rows(first: &[f64], beside: &[Vec<f64>]) -> impl Iterator<Item = Vec<f64>> {
    first.iter().enumerate().map(|(row, cell)| {
        let after = beside.iter().filter_map(|column| column.get(row).copied());
        std::iter::once(*cell).chain(after).collect()
    })
}
