//! Octave's text files (`save -text`, its default): `# name:` and `# type:` before each variable.

use super::names::Path;
use super::text;
use super::tree::{Content, Encoding, Leaf, Part, Tree, Variable};
use crate::bytes::{FileBytes, decode_text, to_usize};
use crate::numbers::{ByteOrder, Number};
use crate::source::ReadError;
use crate::text::cells::Lines;
use crate::text::number;

/// Nested structs and cells below a variable.
const DEEPEST: usize = 32;
/// Numbers that ranges may make of each byte of the file, beside a fixed number of them.
const RANGE_PER_BYTE: usize = 16;
/// Numbers that ranges may make in any case.
const RANGE_LEAST: usize = 1 << 20;

/// Whether a file's first bytes are those of Octave's text format.
pub(super) fn recognises(head: &[u8]) -> bool {
    let text = head.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(head);
    text.starts_with(b"# Created by Octave") || text.starts_with(b"# name: ")
}

/// Find all variables of a text file; their numbers are translated to bytes, which the tree then refers to.
pub(super) fn scan(file: &FileBytes) -> Result<(Tree, Vec<u8>), ReadError> {
    let lines = Lines::new(file.all(), false);
    let lines: Vec<(usize, &[u8])> = lines.filter(|(_, l)| !l.trim_ascii().is_empty()).collect();
    let mut pass = Pass {
        file,
        lines,
        at: 0,
        tree: Tree::default(),
        bytes: Vec::new(),
        ranges: RANGE_LEAST + RANGE_PER_BYTE * to_usize(file.size()),
    };
    while let Some(name) = pass.next_name() {
        pass.tree.variables.push(Variable {
            name: name.clone(),
            packed: None,
            order: ByteOrder::Little,
        });
        pass.value(&Path::to(&name))?;
    }
    Ok((pass.tree, pass.bytes))
}

struct Pass<'a> {
    file: &'a FileBytes,
    /// Lines that are not blank.
    lines: Vec<(usize, &'a [u8])>,
    at: usize,
    tree: Tree,
    bytes: Vec<u8>,
    /// Numbers that ranges may still make.
    ranges: usize,
}

/// The value of a line `# key: value`.
fn keyed(line: &[u8], key: &str) -> Option<String> {
    let rest = line.strip_prefix(b"#")?.trim_ascii_start();
    let rest = rest.strip_prefix(key.as_bytes())?.strip_prefix(b":")?;
    Some(decode_text(rest.trim_ascii()).into_owned())
}

/// Number of elements; the greatest number where there are more.
fn product(dims: &[u64]) -> u64 {
    let count = dims.iter().try_fold(1u64, |all, &d| all.checked_mul(d));
    count.unwrap_or(u64::MAX)
}

impl<'a> Pass<'a> {
    fn line(&self) -> &'a [u8] {
        self.lines.get(self.at).map_or(b"", |(_, line)| line)
    }

    fn refuse(&self, expected: &str) -> ReadError {
        let at = self
            .lines
            .get(self.at)
            .map_or(self.file.all().len(), |(at, _)| *at);
        let found = decode_text(self.line())
            .chars()
            .take(40)
            .collect::<String>();
        self.file.refuse(at as u64, expected, format!("'{found}'"))
    }

    /// The name of the next variable at the top; what is between is passed over.
    fn next_name(&mut self) -> Option<String> {
        while self.at < self.lines.len() {
            let name = keyed(self.line(), "name");
            self.at += 1;
            if name.is_some() {
                return name;
            }
        }
        None
    }

    /// The value of a key that must come next.
    fn key(&mut self, key: &str) -> Result<String, ReadError> {
        let value = keyed(self.line(), key).ok_or_else(|| self.refuse(&format!("# {key}:")))?;
        self.at += 1;
        Ok(value)
    }

    fn count(&mut self, key: &str) -> Result<u64, ReadError> {
        let text = self.key(key)?;
        text.parse()
            .map_err(|_| self.refuse("a number of rows or columns"))
    }

    /// The dimensions of an array: rows and columns, or all of them in a line.
    fn dims(&mut self) -> Result<Vec<u64>, ReadError> {
        if keyed(self.line(), "rows").is_some() {
            return Ok(vec![self.count("rows")?, self.count("columns")?]);
        }
        self.key("ndims")?;
        let words = decode_text(self.line()).into_owned();
        let dims: Option<Vec<u64>> = words.split_whitespace().map(|w| w.parse().ok()).collect();
        let dims = dims
            .filter(|d| d.len() >= 2)
            .ok_or_else(|| self.refuse("dimensions"))?;
        self.at += 1;
        Ok(dims)
    }

    /// A value, after its name.
    fn value(&mut self, path: &Path) -> Result<(), ReadError> {
        let kind = self.key("type")?;
        if path.depth > DEEPEST {
            return Err(self.refuse("values that are less deeply nested"));
        }
        let bare = kind.strip_prefix("global ").unwrap_or(&kind);
        match bare {
            "string" | "sq_string" => self.string(path),
            "scalar struct" => self.structure(path),
            "struct" => self.structures(path),
            "cell" => self.cell(path),
            "range" | "double_range" => self.range(path),
            _ if bare.contains("complex")
                || bare.contains("sparse")
                || bare.contains("diagonal") =>
            {
                self.leave_out(path, bare)
            }
            "matrix" | "float matrix" => self.matrix(path, bare),
            "bool" => self.scalar(path, bare),
            _ if bare.ends_with("scalar") => self.scalar(path, bare),
            _ if bare.ends_with("matrix") => self.matrix(path, bare),
            _ => self.leave_out(path, bare),
        }
    }

    /// Note a value that is not read, and pass over its lines.
    fn leave_out(&mut self, path: &Path, kind: &str) -> Result<(), ReadError> {
        self.tree.refused.push((path.name.clone(), kind.to_owned()));
        while self.at < self.lines.len() && keyed(self.line(), "name").is_none() {
            self.at += 1;
        }
        Ok(())
    }

    fn scalar(&mut self, path: &Path, kind: &str) -> Result<(), ReadError> {
        let value = number::parse_cell(self.line(), b'.');
        let value = value.ok_or_else(|| self.refuse("a number"))?;
        self.at += 1;
        self.numbers(path, kind, vec![1, 1], &[value])
    }

    /// Two dimensions are written row by row, more of them a number in each line, column by column.
    fn matrix(&mut self, path: &Path, kind: &str) -> Result<(), ReadError> {
        let by_rows = keyed(self.line(), "rows").is_some();
        let dims = self.dims()?;
        let count = to_usize(product(&dims));
        let mut values = Vec::new();
        while values.len() < count {
            let line = self.line();
            if line.is_empty() || line.starts_with(b"#") {
                return Err(self.refuse("the numbers of a matrix"));
            }
            for word in line
                .split(u8::is_ascii_whitespace)
                .filter(|w| !w.is_empty())
            {
                let value = number::parse_cell(word, b'.');
                values.push(value.ok_or_else(|| self.refuse("numbers"))?);
            }
            self.at += 1;
        }
        values.truncate(count);
        if by_rows && values.len() > 1 {
            let columns = to_usize(dims[1]);
            values = (0..columns)
                .flat_map(|column| values.iter().skip(column).step_by(columns).copied())
                .collect();
        }
        self.numbers(path, kind, dims, &values)
    }

    /// `# base, limit, increment` and the three numbers.
    fn range(&mut self, path: &Path) -> Result<(), ReadError> {
        if self.line().starts_with(b"#") {
            self.at += 1;
        }
        let words = self
            .line()
            .split(u8::is_ascii_whitespace)
            .filter(|w| !w.is_empty());
        let numbers: Option<Vec<f64>> = words.map(|w| number::parse_cell(w, b'.')).collect();
        let Some([base, limit, step]) = numbers.as_deref().and_then(|n| n.first_chunk()) else {
            return Err(self.refuse("base, limit and increment"));
        };
        let steps = (limit - base) / step * (1.0 + 1e-12);
        if !(0.0..self.ranges as f64 - 1.0).contains(&steps) {
            return Err(self.refuse("a range of as many numbers as the file may hold"));
        }
        let count = (0..self.ranges).take_while(|i| *i as f64 <= steps).count();
        self.at += 1;
        self.ranges -= count;
        let values: Vec<f64> = (0..count).map(|i| base + i as f64 * step).collect();
        self.numbers(path, "range", vec![1, count as u64], &values)
    }

    /// `# elements:` strings, each `# length:` and its text; the rows of an array of characters.
    fn string(&mut self, path: &Path) -> Result<(), ReadError> {
        let elements = match keyed(self.line(), "elements") {
            Some(_) => self.count("elements")?,
            None => return self.leave_out(path, "string"),
        };
        let mut rows = Vec::new();
        for _ in 0..elements {
            let length = self.count("length")?;
            if length > 0 {
                rows.push(self.line());
                self.at += 1;
            }
        }
        let text = match rows[..] {
            [row] => decode_text(row).into_owned(),
            _ => return Ok(()),
        };
        let part = Part {
            at: self.bytes.len() as u64,
            bytes: text.len() as u64,
            number: Number::U8,
        };
        self.bytes.extend_from_slice(text.as_bytes());
        let dims = vec![1, text.chars().count() as u64];
        self.leaf(path, "char", dims, Content::Text(part, Encoding::Utf8))
    }

    /// The fields of a struct: `# length:` of them, each with its name.
    fn structure(&mut self, path: &Path) -> Result<(), ReadError> {
        self.dims()?;
        for _ in 0..self.count("length")? {
            let name = self.key("name")?;
            self.value(&path.child(&format!(".{name}")))?;
        }
        Ok(())
    }

    /// A struct array: each field is a cell with the values of all elements.
    fn structures(&mut self, path: &Path) -> Result<(), ReadError> {
        let dims = self.dims()?;
        let from = self.tree.leaves.len();
        for _ in 0..self.count("length")? {
            let name = self.key("name")?;
            self.key("type")?;
            let count = product(&self.dims()?);
            for index in 0..count {
                self.key("name")?;
                let element = path.element(index, count, &dims, ['(', ')']);
                self.value(&element.child(&format!(".{name}")))?;
            }
        }
        self.tree.leaves[from..].sort_by_key(|leaf| leaf.element);
        Ok(())
    }

    fn cell(&mut self, path: &Path) -> Result<(), ReadError> {
        let dims = self.dims()?;
        let count = product(&dims);
        for index in 0..count {
            self.key("name")?;
            self.value(&path.element(index, count, &dims, ['{', '}']))?;
        }
        Ok(())
    }

    fn numbers(
        &mut self,
        path: &Path,
        class: &str,
        dims: Vec<u64>,
        values: &[f64],
    ) -> Result<(), ReadError> {
        let part = Part {
            at: self.bytes.len() as u64,
            bytes: 8 * values.len() as u64,
            number: Number::F64,
        };
        self.bytes
            .extend(values.iter().flat_map(|v| v.to_le_bytes()));
        self.leaf(path, class, dims, Content::Real(part))
    }

    fn leaf(
        &mut self,
        path: &Path,
        class: &str,
        dims: Vec<u64>,
        content: Content,
    ) -> Result<(), ReadError> {
        let mut leaf = Leaf {
            variable: self.tree.variables.len() - 1,
            element: path.element,
            tail: path.leaf_tail(),
            name: path.name.clone(),
            dims,
            content,
            class: class.to_owned(),
            logical: class.starts_with("bool"),
            value: None,
        };
        let held = &self.bytes;
        leaf.value = text::short_value(&leaf, ByteOrder::Little, |part| {
            let range = to_usize(part.at)..to_usize(part.at + part.bytes);
            Ok::<_, ReadError>(held[range].to_vec())
        })?;
        self.tree.leaves.push(leaf);
        Ok(())
    }
}
