//! Tables of columns, written as CSV and as Parquet.

use polars::error::PolarsError;
use polars::prelude::{Column, DataFrame};
use polars_io::parquet::write::ParquetWriter;

use impact_report::kit::csv::Csv;

/// Most rows in a row group of a Parquet file.
const ROW_GROUP: usize = 1 << 18;

/// The values of a column; `None` is a missing value.
#[derive(Debug, Clone, PartialEq)]
enum Values {
    Numbers(Vec<Option<f64>>),
    Counts(Vec<Option<u32>>),
    Flags(Vec<Option<bool>>),
    Texts(Vec<Option<String>>),
}

/// How the value of a column follows from a row of type `T`.
pub(super) enum Get<T> {
    /// A text.
    Text(fn(&T) -> Option<String>),
    /// A number.
    Number(fn(&T) -> Option<f64>),
    /// A count; one above `u32::MAX` is written as that.
    Count(fn(&T) -> Option<usize>),
    /// Yes or no.
    Flag(fn(&T) -> Option<bool>),
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

    /// One row per element of `rows`, one column per name.
    pub(super) fn of<T>(rows: &[T], columns: &[(&str, Get<T>)]) -> Self {
        let add = |table: Self, (name, get): &(&str, Get<T>)| match get {
            Get::Text(f) => table.with(name, Values::Texts(rows.iter().map(f).collect())),
            Get::Number(f) => table.missing(name, rows.iter().map(f)),
            Get::Count(f) => table.with(name, counts(rows.iter().map(f))),
            Get::Flag(f) => table.with(name, Values::Flags(rows.iter().map(f).collect())),
        };
        columns.iter().fold(Self::new(), add)
    }

    /// With a column of numbers.
    #[must_use]
    pub fn numbers(self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.missing(name, values.into_iter().map(Some))
    }

    /// With a column of numbers some of which are missing.
    #[must_use]
    pub fn missing(self, name: &str, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        self.with(name, Values::Numbers(values.into_iter().collect()))
    }

    /// With a column of counts; one above `u32::MAX` is written as that.
    #[must_use]
    pub fn counts(self, name: &str, values: impl IntoIterator<Item = usize>) -> Self {
        self.with(name, counts(values.into_iter().map(Some)))
    }

    /// With a column of yes and no.
    #[must_use]
    pub fn flags(self, name: &str, values: impl IntoIterator<Item = bool>) -> Self {
        let values = values.into_iter().map(Some).collect();
        self.with(name, Values::Flags(values))
    }

    /// With a column of texts.
    #[must_use]
    pub fn texts(self, name: &str, values: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let values = values.into_iter().map(|text| Some(text.into())).collect();
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
        let mut csv = Csv::new(&names);
        for row in 0..self.rows() {
            csv.row();
            for (_, values) in &self.columns {
                values.write(row, &mut csv);
            }
        }
        csv.finish()
    }

    /// The table as Parquet.
    ///
    /// # Errors
    /// Those of the library.
    pub fn parquet(&self) -> Result<Vec<u8>, PolarsError> {
        let frame = self.frame()?;
        let rows = frame.height().max(1);
        let parts = (0..rows).step_by(ROW_GROUP).map(|first| {
            let first = i64::try_from(first).unwrap_or(i64::MAX);
            Ok(frame.slice(first, ROW_GROUP))
        });
        parquet(parts)
    }

    /// Tables of the same columns, one below the other, as Parquet; each is dropped before the next is made.
    ///
    /// # Errors
    /// Those of the library.
    pub(super) fn parquet_of(
        tables: impl IntoIterator<Item = Self>,
    ) -> Result<Vec<u8>, PolarsError> {
        parquet(tables.into_iter().map(|table| table.frame()))
    }

    fn frame(&self) -> Result<DataFrame, PolarsError> {
        let columns = self.columns.iter().map(|(n, v)| v.column(n)).collect();
        DataFrame::new(self.rows(), columns)
    }
}

/// Frames of the same columns, each a row group; without any nothing is written.
fn parquet(
    frames: impl IntoIterator<Item = Result<DataFrame, PolarsError>>,
) -> Result<Vec<u8>, PolarsError> {
    let mut frames = frames.into_iter();
    let mut bytes = Vec::new();
    let Some(first) = frames.next().transpose()? else {
        return Ok(bytes);
    };
    let mut writer = ParquetWriter::new(&mut bytes).batched(first.schema())?;
    writer.write_batch(&first)?;
    drop(first);
    for frame in frames {
        writer.write_batch(&frame?)?;
    }
    writer.finish()?;
    Ok(bytes)
}

fn counts(values: impl Iterator<Item = Option<usize>>) -> Values {
    let narrow = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    Values::Counts(values.map(|count| count.map(narrow)).collect())
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

    fn write(&self, row: usize, csv: &mut Csv) {
        match self {
            Self::Numbers(v) => csv.exact(&[v[row]]),
            Self::Counts(v) => csv.exact(&[v[row].map(f64::from)]),
            Self::Flags(v) => {
                csv.texts(&[v[row].map_or("", |yes| if yes { "true" } else { "false" })])
            }
            Self::Texts(v) => csv.texts(&[v[row].as_deref().unwrap_or_default()]),
        };
    }

    fn column(&self, name: &str) -> Column {
        match self {
            Self::Numbers(v) => Column::new(name.into(), v),
            Self::Counts(v) => Column::new(name.into(), v),
            Self::Flags(v) => Column::new(name.into(), v),
            Self::Texts(v) => Column::new(name.into(), v),
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

    #[test]
    fn tables_one_below_the_other_are_one_file() {
        use polars_io::SerReader;
        use polars_io::parquet::read::ParquetReader;
        let table = |values: [Option<f64>; 2]| Table::new().missing("x", values);
        let parts = [table([None, None]), table([Some(2.0), None])];
        let bytes = Table::parquet_of(parts).unwrap();
        let read = ParquetReader::new(std::io::Cursor::new(bytes)).finish();
        let column = read.unwrap().column("x").unwrap().f64().unwrap().to_vec();
        assert_eq!(column, [None, None, Some(2.0), None]);
    }

    #[test]
    fn columns_follow_from_rows() {
        let columns: [(&str, Get<f64>); 3] = [
            ("square", Get::Number(|x| Some(x * x))),
            ("whole", Get::Count(|x| (x.fract() == 0.0).then_some(7))),
            ("text", Get::Text(|x| (*x > 1.0).then(|| format!("{x}")))),
        ];
        let table = Table::of(&[1.0, 1.5], &columns);
        assert_eq!(table.csv(), "square,whole,text\n1,7,\n2.25,,1.5\n");
    }
}
