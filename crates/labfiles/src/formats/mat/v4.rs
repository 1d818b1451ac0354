//! Level 4 files: matrices one after the other, each with a header of 20 bytes.
//!
//! The header's first number, MOPT in decimal digits, states byte order (M), number format (P)
//! and kind (T: 0 full, 1 text, 2 sparse).

use super::text;
use super::tree::{Content, Encoding, Leaf, Part, Tree, Variable};
use crate::bytes::{Cursor, FileBytes};
use crate::numbers::{ByteOrder, Number};
use crate::source::ReadError;

/// Longest name that is accepted, bytes.
const LONGEST_NAME: u32 = 256;

/// Byte order of a level 4 file, from its first header; `None`: it is none.
pub(super) fn byte_order(head: &[u8]) -> Option<ByteOrder> {
    let word = |at: usize, order| {
        Some(ByteOrder::u32(
            order,
            head.get(at..at + 4)?.try_into().ok()?,
        ))
    };
    let plausible = |order| {
        let mopt = word(0, order)?;
        let (o, p, t) = (mopt / 100 % 10, mopt / 10 % 10, mopt % 10);
        let name = word(16, order)?;
        let first = *head.get(20)?;
        let valid = mopt < 5000 && o == 0 && p <= 5 && t <= 2 && word(12, order)? <= 1;
        let named = (2..=LONGEST_NAME).contains(&name) && first.is_ascii_alphabetic();
        (valid && named).then_some(mopt)
    };
    [ByteOrder::Little, ByteOrder::Big]
        .into_iter()
        .find(|&order| plausible(order).is_some())
}

/// Find all variables of a level 4 file.
pub(super) fn scan(file: &FileBytes, order: ByteOrder) -> Result<Tree, ReadError> {
    let mut tree = Tree::default();
    let mut cursor = file.cursor(order);
    while cursor.left() > 0 {
        variable(file, &mut cursor, order, &mut tree)?;
    }
    Ok(tree)
}

struct Header {
    at: u64,
    number: Number,
    kind: u32,
    rows: u64,
    columns: u64,
    complex: bool,
    name: String,
}

fn header(file: &FileBytes, cursor: &mut Cursor<'_>) -> Result<Header, ReadError> {
    let at = cursor.at();
    let mopt = cursor.u32("a matrix header")?;
    let (machine, zero, format, kind) = (mopt / 1000, mopt / 100 % 10, mopt / 10 % 10, mopt % 10);
    let number = match format {
        0 => Number::F64,
        1 => Number::F32,
        2 => Number::I32,
        3 => Number::I16,
        4 => Number::U16,
        _ => Number::U8,
    };
    if zero != 0 || format > 5 || kind > 2 || machine > 4 {
        return Err(file.refuse(at, "a matrix header (MOPT)", format!("{mopt}")));
    }
    if machine > 1 {
        let found = ["VAX D-float", "VAX G-float", "Cray"][machine as usize - 2];
        let remedy = "save the file again on a machine with IEEE numbers";
        return Err(file.unsupported(at, format!("{found} numbers"), "IEEE numbers", remedy));
    }
    let rows = u64::from(cursor.u32("the number of rows")?);
    let columns = u64::from(cursor.u32("the number of columns")?);
    let complex = cursor.u32("the complex flag")? != 0;
    let length = cursor.u32("the length of the name")?;
    if length > LONGEST_NAME {
        return Err(cursor.refuse(
            format!("a name below {LONGEST_NAME} bytes"),
            length.to_string(),
        ));
    }
    let name = cursor.take(u64::from(length), "a name")?;
    let name = String::from_utf8_lossy(name)
        .trim_end_matches('\0')
        .to_owned();
    Ok(Header {
        at,
        number,
        kind,
        rows,
        columns,
        complex,
        name,
    })
}

fn variable(
    file: &FileBytes,
    cursor: &mut Cursor<'_>,
    order: ByteOrder,
    tree: &mut Tree,
) -> Result<(), ReadError> {
    let header = header(file, cursor)?;
    let what = format!("matrix '{}'", header.name);
    let count = header.rows.saturating_mul(header.columns);
    let bytes = count.saturating_mul(header.number.bytes());
    let mut part = || {
        let part = Part {
            at: cursor.at(),
            bytes,
            number: header.number,
        };
        cursor.take(bytes, &what).map(|_| part)
    };
    let real = part()?;
    let imaginary = if header.complex { Some(part()?) } else { None };
    if header.kind == 2 {
        tree.refused.push((header.name, "sparse".to_owned()));
        return Ok(());
    }
    let content = match (header.kind, imaginary) {
        (1, _) => Content::Text(real, Encoding::Codes),
        (_, Some(imaginary)) => Content::Complex(real, imaginary, complex_bits(header.number)),
        (_, None) => Content::Real(real),
    };
    let class = if header.kind == 1 { "char" } else { "double" };
    if header.name.is_empty() {
        return Err(file.refuse(header.at, "a named matrix", "an empty name"));
    }
    let mut leaf = Leaf {
        variable: tree.variables.len(),
        element: None,
        tail: header.name.clone(),
        name: header.name.clone(),
        dims: vec![header.rows, header.columns],
        content,
        class: class.to_owned(),
        logical: false,
        value: None,
    };
    leaf.value = text::short_value(&leaf, order, |part| {
        file.slice(part.at, part.bytes, &what).map(<[u8]>::to_vec)
    })?;
    tree.leaves.push(leaf);
    tree.variables.push(Variable {
        name: header.name,
        packed: None,
        order,
    });
    Ok(())
}

fn complex_bits(number: Number) -> u8 {
    if number == Number::F32 { 32 } else { 64 }
}
