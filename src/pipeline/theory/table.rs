//! Tables of columns, written as CSV and as Parquet.

use polars::prelude::{Column, DataFrame};
use polars_io::parquet::write::ParquetWriter;

/// A column's values.
#[derive(Debug, Clone, PartialEq)]
enum Values {
    Numbers(Vec<Option<f64>>),
    Counts(Vec<u32>),
    Flags(Vec<bool>),
    Texts(Vec<String>),
}

/// A table: columns of one length, each with its name (unit included).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    columns: Vec<(String, Values)>,
}

impl Table {
    /// A table without columns.
    pub fn new() -> Self {
        Self::default()
    }

    /// With a column of numbers.
    pub fn numbers(self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.missing(name, values.into_iter().map(Some))
    }

    /// With a column of numbers some of which are missing.
    pub fn missing(self, name: &str, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        self.with(name, Values::Numbers(values.into_iter().collect()))
    }

    /// With a column of counts.
    pub fn counts(self, name: &str, values: impl IntoIterator<Item = usize>) -> Self {
        let values = values.into_iter().map(|v| v as u32).collect();
        self.with(name, Values::Counts(values))
    }

    /// With a column of yes and no.
    pub fn flags(self, name: &str, values: impl IntoIterator<Item = bool>) -> Self {
        self.with(name, Values::Flags(values.into_iter().collect()))
    }

    /// With a column of texts.
    pub fn texts(self, name: &str, values: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let values = values.into_iter().map(Into::into).collect();
        self.with(name, Values::Texts(values))
    }

    fn with(mut self, name: &str, values: Values) -> Self {
        self.columns.push((name.to_owned(), values));
        self
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, v)| v.len())
    }

    /// The table as CSV; numbers in the shortest form that reads back exactly, missing ones empty.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|c| c.0.as_str()).collect();
        let mut text = names.join(",");
        for row in 0..self.rows() {
            text.push('\n');
            for (i, (_, values)) in self.columns.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                values.write(row, &mut text);
            }
        }
        text.push('\n');
        text
    }

    /// The table as Parquet.
    ///
    /// # Errors
    /// What the library said.
    pub fn parquet(&self) -> Result<Vec<u8>, String> {
        let columns = self.columns.iter().map(|(n, v)| v.column(n)).collect();
        let mut frame = DataFrame::new(self.rows(), columns).map_err(|e| e.to_string())?;
        let mut bytes = Vec::new();
        ParquetWriter::new(&mut bytes)
            .finish(&mut frame)
            .map_err(|e| e.to_string())?;
        Ok(bytes)
    }
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Numbers(v) => v.len(),
            Self::Counts(v) => v.len(),
            Self::Flags(v) => v.len(),
            Self::Texts(v) => v.len(),
        }
    }

    fn write(&self, row: usize, text: &mut String) {
        use std::fmt::Write as _;
        let _ = match self {
            Self::Numbers(v) => v[row]
                .filter(|x| x.is_finite())
                .map_or(Ok(()), |x| write!(text, "{x}")),
            Self::Counts(v) => write!(text, "{}", v[row]),
            Self::Flags(v) => write!(text, "{}", v[row]),
            Self::Texts(v) if v[row].contains([',', '"', '\n']) => {
                write!(text, "\"{}\"", v[row].replace('"', "\"\""))
            }
            Self::Texts(v) => write!(text, "{}", v[row]),
        };
    }

    fn column(&self, name: &str) -> Column {
        match self {
            Self::Numbers(v) => Column::new(name.into(), v.clone()),
            Self::Counts(v) => Column::new(name.into(), v.clone()),
            Self::Flags(v) => Column::new(name.into(), v.clone()),
            Self::Texts(v) => Column::new(name.into(), v.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_written_as_csv_and_parquet() {
        let table = Table::new()
            .numbers("eta", [0.1, 2.0])
            .missing("lyapunov", [None, Some(-0.25)])
            .texts("motion", ["1", "1,5"])
            .flags("joined", [true, false])
            .counts("p", [1, 2]);
        let want = "eta,lyapunov,motion,joined,p\n0.1,,1,true,1\n2,-0.25,\"1,5\",false,2\n";
        assert_eq!(table.csv(), want);
        assert_eq!(&table.parquet().unwrap()[..4], b"PAR1");
    }
}
