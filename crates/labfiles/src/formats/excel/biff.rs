//! How far the cells of a sheet in an `.xls` workbook are spread, checked before the library lays them out
//! in one rectangle.

use crate::bytes::to_usize;
use crate::formats::excel::cells::{GREATEST_SPARSITY, HARMLESS_CELLS};
use crate::formats::excel::compound::number;

/// Cells of the largest sheet that the format has: 65536 rows of 256.
const GREATEST_SHEET: u64 = 1 << 24;

const BEGIN: u16 = 0x0809;
const END: u16 = 0x000A;
const BOUND_SHEET: u16 = 0x0085;
const DIMENSIONS: u16 = 0x0200;
const SEVERAL_NUMBERS: u16 = 0x00BD;
/// Records of one cell, which begin with its row and column.
const CELLS: [u16; 7] = [0x0006, 0x00D6, 0x00FD, 0x0203, 0x0204, 0x0205, 0x027E];

/// What is wrong with the sheets of a workbook's stream, if anything is.
pub(super) fn fault(stream: &[u8]) -> Option<String> {
    let sheets = Records(stream).filter(|r| r.kind == BOUND_SHEET);
    let places = sheets.filter_map(|r| number(r.data, 0));
    let sheets = places.filter_map(|at| stream.get(to_usize(at.into())..));
    sheets.map(Spread::of).find_map(|spread| spread.fault())
}

/// A record: what it is, and its contents.
struct Record<'a> {
    kind: u16,
    data: &'a [u8],
}

/// The records of a stream, as far as they are whole.
struct Records<'a>(&'a [u8]);

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        let (kind, length) = (short(self.0, 0)?, short(self.0, 2)?);
        let (data, rest) = self.0.get(4..)?.split_at_checked(length.into())?;
        self.0 = rest;
        Some(Record { kind, data })
    }
}

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    let field = bytes.get(at..at.checked_add(2)?)?;
    Some(u16::from_le_bytes(field.try_into().ok()?))
}

/// Where the cells of a sheet are.
struct Spread {
    cells: u64,
    rows: [u16; 2],
    columns: [u16; 2],
    /// Cells of the rectangle that the sheet states.
    stated: u64,
}

impl Spread {
    fn of(sheet: &[u8]) -> Self {
        let mut spread = Self {
            cells: 0,
            rows: [u16::MAX, 0],
            columns: [u16::MAX, 0],
            stated: 0,
        };
        let mut depth = 0_usize;
        for record in Records(sheet) {
            match record.kind {
                BEGIN => depth += 1,
                END if depth <= 1 => break,
                END => depth -= 1,
                DIMENSIONS => spread.stated = stated(record.data).unwrap_or(0),
                kind if CELLS.contains(&kind) => spread.add(record.data, 2),
                SEVERAL_NUMBERS => {
                    spread.add(record.data, 2);
                    spread.add(record.data, record.data.len().saturating_sub(2));
                }
                _ => {}
            }
        }
        spread
    }

    fn add(&mut self, data: &[u8], column_at: usize) {
        let Some((row, column)) = short(data, 0).zip(short(data, column_at)) else {
            return;
        };
        self.cells += 1;
        self.rows = [self.rows[0].min(row), self.rows[1].max(row)];
        self.columns = [self.columns[0].min(column), self.columns[1].max(column)];
    }

    fn fault(&self) -> Option<String> {
        let span = |[first, last]: [u16; 2]| u64::from(last.saturating_sub(first)) + 1;
        let laid_out = span(self.rows) * span(self.columns);
        let most = HARMLESS_CELLS.max(GREATEST_SPARSITY * self.cells);
        if laid_out > most {
            return Some(format!("{} cells scattered over {laid_out}", self.cells));
        }
        (self.stated > GREATEST_SHEET).then(|| format!("a sheet of {} cells", self.stated))
    }
}

/// Cells of the rectangle that a sheet's dimensions state.
fn stated(data: &[u8]) -> Option<u64> {
    let (rows, at) = match data.len() {
        0..=11 => ([0, 2].map(|at| short(data, at).map(u32::from)), 4),
        _ => ([0, 4].map(|at| number(data, at)), 8),
    };
    let columns = [at, at + 2].map(|at| short(data, at).map(u32::from));
    let span = |[first, last]: [Option<u32>; 2]| Some(u64::from(last?.wrapping_sub(first?)) + 1);
    Some(span(rows)?.saturating_mul(span(columns)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(kind: u16, data: &[u8]) -> Vec<u8> {
        let length = u16::try_from(data.len()).unwrap();
        [&kind.to_le_bytes(), &length.to_le_bytes(), data].concat()
    }

    /// A workbook of one sheet with numbers in cells (row, column).
    fn workbook(cells: &[[u16; 2]]) -> Vec<u8> {
        let globals = |at: u32| {
            let sheet = record(BOUND_SHEET, &[&at.to_le_bytes()[..], &[0; 4]].concat());
            [record(BEGIN, &[0; 4]), sheet, record(END, &[])].concat()
        };
        let at = u32::try_from(globals(0).len()).unwrap();
        let number = |[row, column]: &[u16; 2]| {
            let place = [row.to_le_bytes(), column.to_le_bytes()].concat();
            record(0x0203, &[&place[..], &[0; 10]].concat())
        };
        let cells: Vec<u8> = cells.iter().flat_map(number).collect();
        [globals(at), record(BEGIN, &[0; 4]), cells, record(END, &[])].concat()
    }

    #[test]
    fn cells_far_apart_are_refused() {
        assert_eq!(fault(&workbook(&[[0, 0], [5, 3]])), None);
        assert_eq!(fault(&workbook(&[])), None);
        let found = fault(&workbook(&[[0, 0], [65_535, 65_535]])).unwrap();
        assert_eq!(found, "2 cells scattered over 4294967296");
    }

    #[test]
    fn a_sheet_larger_than_the_format_has_is_refused() {
        let rows = [0_u32.to_le_bytes(), 0xF000_0000_u32.to_le_bytes()].concat();
        let data = [&rows[..], &[0, 0, 0xFF, 0, 0, 0]].concat();
        assert_eq!(stated(&data), Some(0xF000_0001 * 256));
        let sheet = [record(BEGIN, &[0; 4]), record(DIMENSIONS, &data)].concat();
        assert!(Spread::of(&sheet).fault().is_some());
    }
}
