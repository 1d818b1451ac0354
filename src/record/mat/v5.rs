//! Level 5 files (v5, v6, and v7 with its compressed variables): tagged elements, nested.
//!
//! Every element has a tag of 8 bytes (kind, length) or, where its data fit in 4 bytes, one that
//! holds them. A variable is a matrix element, plain or inside a zlib stream.

use super::inflate::Stream;
use super::text;
use super::tree::{Content, Encoding, Leaf, Part, Place, Tree, Variable};
use crate::record::bytes::FileBytes;
use crate::record::numbers::{self, ByteOrder, Number};
use crate::record::source::ReadError;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Bytes before the first element.
const HEADER: u64 = 128;
/// Deepest nesting of cells and structs that is followed.
const DEEPEST: usize = 48;
/// Longest list of dimensions or of names that is believed, bytes.
const LONGEST_LIST: u64 = 1 << 20;

/// Byte order of a level 5 file, from its header; `None`: it is none (or is v7.3, an HDF5 file).
pub fn byte_order(head: &[u8]) -> Option<ByteOrder> {
    match head.get(124..128)? {
        [_, 1, b'I', b'M'] => Some(ByteOrder::Little),
        [1, _, b'M', b'I'] => Some(ByteOrder::Big),
        _ => None,
    }
}

/// Whether the header is that of v7.3, which is an HDF5 file.
pub fn is_hdf5(head: &[u8]) -> bool {
    matches!(
        head.get(124..128),
        Some([_, 2, b'I', b'M'] | [2, _, b'M', b'I'])
    )
}

/// The bytes of one variable: the file's own or inflated ones, read forward.
enum Input<'a> {
    Plain(&'a FileBytes),
    Packed(Box<Stream<'a>>),
}

/// Walks through one variable.
struct Walker<'a, 't> {
    file: &'a FileBytes,
    input: Input<'a>,
    order: ByteOrder,
    variable: usize,
    tree: &'t mut Tree,
    /// The last tag read and its offset: a small element's data stand in it.
    last: (u64, [u8; 8]),
}

/// An element's kind and where its data lie.
#[derive(Debug, Clone, Copy)]
struct Tag {
    kind: u32,
    bytes: u64,
    at: u64,
    next: u64,
}

/// The way that leads to an array.
#[derive(Debug, Clone)]
struct Path {
    name: String,
    tail: String,
    element: Option<u64>,
    depth: usize,
}

impl Path {
    fn child(&self, suffix: &str) -> Self {
        let tail = format!("{}{suffix}", self.tail);
        let name = format!("{}{suffix}", self.name);
        Self {
            name,
            tail,
            depth: self.depth + 1,
            ..*self
        }
    }

    fn leaf_tail(&self) -> String {
        let tail = self.tail.trim_start_matches('.');
        if tail.is_empty() {
            self.name.clone()
        } else {
            tail.to_owned()
        }
    }
}

/// What stands before the data of an array.
struct Head {
    class: u8,
    logical: bool,
    complex: bool,
    dims: Vec<u64>,
    count: u64,
    name: String,
    at: u64,
    next: u64,
}

/// Find all variables of a level 5 file.
pub fn scan(file: &FileBytes, order: ByteOrder) -> Result<Tree, ReadError> {
    let mut tree = Tree::default();
    let mut at = HEADER;
    while at < file.len() {
        let rest = file.slice(at, file.len() - at, "a variable")?;
        if rest.len() < 8 && rest.iter().all(|&byte| byte == 0) {
            break;
        }
        at = variable(file, order, at, &mut tree)?;
    }
    Ok(tree)
}

fn variable(
    file: &FileBytes,
    order: ByteOrder,
    at: u64,
    tree: &mut Tree,
) -> Result<u64, ReadError> {
    let mut cursor = file.cursor(order);
    cursor.seek(at);
    let kind = cursor.u32("the kind of an element")?;
    let bytes = u64::from(cursor.u32("the length of an element")?);
    let data = cursor.at();
    let left = file.len() - data;
    if bytes > left {
        let found = format!("only {left} bytes left");
        return Err(file.refuse(at, format!("a variable of {bytes} bytes"), found));
    }
    match kind {
        MATRIX => {
            let tag = Tag {
                kind,
                bytes,
                at: data,
                next: data + bytes.next_multiple_of(8),
            };
            walk(file, Input::Plain(file), tag, Place::Plain, order, tree)?;
            Ok(tag.next.min(file.len()))
        }
        COMPRESSED => {
            packed(file, order, data, bytes, tree)?;
            Ok(data + bytes)
        }
        other => Err(file.refuse(
            at,
            "a matrix (14) or compressed (15) element",
            format!("{other}"),
        )),
    }
}

fn packed(
    file: &FileBytes,
    order: ByteOrder,
    at: u64,
    bytes: u64,
    tree: &mut Tree,
) -> Result<(), ReadError> {
    let mut stream = Box::new(Stream::open(file, at, bytes)?);
    let mut head = [0; 8];
    stream.read_at(0, &mut head, "a variable's tag")?;
    let word = |bytes: &[u8]| {
        let array = [bytes[0], bytes[1], bytes[2], bytes[3]];
        match order {
            ByteOrder::Little => u32::from_le_bytes(array),
            ByteOrder::Big => u32::from_be_bytes(array),
        }
    };
    let (kind, length) = (word(&head[..4]), u64::from(word(&head[4..])));
    if kind != MATRIX {
        return Err(file.refuse(at, "a compressed matrix (14)", format!("element {kind}")));
    }
    let inflated = length + 8;
    stream.check_claim(inflated)?;
    let tag = Tag {
        kind,
        bytes: length,
        at: 8,
        next: inflated,
    };
    let place = Place::Packed {
        at,
        packed: bytes,
        inflated,
    };
    walk(file, Input::Packed(stream), tag, place, order, tree)
}

fn walk<'a>(
    file: &'a FileBytes,
    input: Input<'a>,
    tag: Tag,
    place: Place,
    order: ByteOrder,
    tree: &mut Tree,
) -> Result<(), ReadError> {
    if tag.bytes == 0 {
        return Ok(());
    }
    let variable = tree.variables.len();
    tree.variables.push(Variable {
        name: String::new(),
        place,
        order,
        elements: 1,
    });
    let mut walker = Walker {
        file,
        input,
        order,
        variable,
        tree,
        last: (0, [0; 8]),
    };
    let path = Path {
        name: String::new(),
        tail: String::new(),
        element: None,
        depth: 0,
    };
    walker.array(tag, &path)
}

impl Walker<'_, '_> {
    /// An error at an offset of the variable.
    fn refuse(&self, at: u64, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        match self.tree.variables[self.variable].place {
            Place::Plain => self.file.refuse(at, expected, found),
            Place::Packed { at: stream, .. } => {
                let found = format!("{} (byte {at} of the inflated variable)", found.into());
                self.file.refuse(stream, expected, found)
            }
        }
    }

    fn fetch(&mut self, at: u64, length: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        match &mut self.input {
            Input::Plain(file) => Ok(file.slice(at, length, what)?.to_vec()),
            Input::Packed(stream) => {
                let mut buffer = vec![0; length as usize];
                stream.read_at(at, &mut buffer, what)?;
                Ok(buffer)
            }
        }
    }

    fn word(&self, bytes: &[u8]) -> u32 {
        let array = [bytes[0], bytes[1], bytes[2], bytes[3]];
        match self.order {
            ByteOrder::Little => u32::from_le_bytes(array),
            ByteOrder::Big => u32::from_be_bytes(array),
        }
    }

    /// The tag at an offset; its data end before `end`.
    fn tag(&mut self, at: u64, end: u64, what: &str) -> Result<Tag, ReadError> {
        if at.saturating_add(8) > end {
            let found = format!("only {} bytes left", end.saturating_sub(at));
            return Err(self.refuse(at, format!("the tag of {what}"), found));
        }
        let head = self.fetch(at, 8, what)?;
        self.last.0 = at;
        self.last.1.copy_from_slice(&head);
        let first = self.word(&head[..4]);
        if first >> 16 != 0 {
            let (kind, bytes) = (first & 0xffff, u64::from(first >> 16));
            if bytes > 4 {
                return Err(self.refuse(
                    at,
                    "at most 4 bytes in a small element",
                    bytes.to_string(),
                ));
            }
            return Ok(Tag {
                kind,
                bytes,
                at: at + 4,
                next: at + 8,
            });
        }
        let bytes = u64::from(self.word(&head[4..]));
        let data = at + 8;
        if bytes > end - data {
            let found = format!("{bytes} bytes where {} are left", end - data);
            return Err(self.refuse(at, what, found));
        }
        Ok(Tag {
            kind: first,
            bytes,
            at: data,
            next: (data + bytes.next_multiple_of(8)).min(end),
        })
    }

    /// The data of a short element (a list of dimensions or names).
    fn list(&mut self, tag: Tag, what: &str) -> Result<Vec<u8>, ReadError> {
        if tag.bytes > LONGEST_LIST {
            return Err(self.refuse(tag.at, what, format!("{} bytes", tag.bytes)));
        }
        self.data(tag.at, tag.bytes, what)
    }

    /// The data at an offset; those of a small element were part of the tag just read, and in a
    /// stream lie behind.
    fn data(&mut self, at: u64, bytes: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        let (tag_at, tag) = self.last;
        match at == tag_at + 4 && bytes <= 4 {
            true => Ok(tag[4..4 + bytes as usize].to_vec()),
            false => self.fetch(at, bytes, what),
        }
    }

    fn integers(&mut self, tag: Tag, what: &str) -> Result<Vec<i64>, ReadError> {
        let bytes = self.list(tag, what)?;
        let number = match tag.kind {
            5 => Number::I32,
            6 => Number::U32,
            other => return Err(self.refuse(tag.at, format!("{what} as int32"), kind_name(other))),
        };
        let mut values = Vec::new();
        numbers::decode(number, self.order, &bytes, &mut values);
        if let Some(wild) = values
            .iter()
            .find(|v| !(0.0..=2_147_483_647.0).contains(*v))
        {
            return Err(self.refuse(
                tag.at,
                format!("{what} between 0 and 2147483647"),
                wild.to_string(),
            ));
        }
        Ok(values.into_iter().map(|v| v as i64).collect())
    }

    fn ascii(&mut self, tag: Tag, what: &str) -> Result<String, ReadError> {
        let bytes = self.list(tag, what)?;
        if !matches!(tag.kind, 1 | 2 | 16) {
            return Err(self.refuse(tag.at, format!("{what} as int8"), kind_name(tag.kind)));
        }
        match bytes.is_ascii() {
            true => Ok(String::from_utf8_lossy(&bytes)
                .trim_end_matches('\0')
                .to_owned()),
            false => Err(self.refuse(
                tag.at,
                format!("{what} in ASCII"),
                format!("{:?}", String::from_utf8_lossy(&bytes)),
            )),
        }
    }

    fn head(&mut self, tag: Tag) -> Result<Head, ReadError> {
        let end = tag.at + tag.bytes;
        let flags_tag = self.tag(tag.at, end, "array flags")?;
        if flags_tag.kind != 6 || flags_tag.bytes != 8 {
            let found = format!("{} of {} bytes", kind_name(flags_tag.kind), flags_tag.bytes);
            return Err(self.refuse(tag.at, "array flags (uint32, 8 bytes)", found));
        }
        let flags = self.list(flags_tag, "array flags")?;
        let flags = self.word(&flags[..4]);
        let class = (flags & 0xff) as u8;
        let (logical, complex) = (flags & 0x200 != 0, flags & 0x800 != 0);
        if class == 17 {
            let (dims, name) = (Vec::new(), self.opaque_name(flags_tag.next, end)?);
            let (at, next) = (end, end);
            return Ok(Head {
                class,
                logical,
                complex,
                dims,
                count: 0,
                name,
                at,
                next,
            });
        }
        let dims_tag = self.tag(flags_tag.next, end, "dimensions")?;
        let dims = self.integers(dims_tag, "dimensions")?;
        let dims: Vec<u64> = dims.into_iter().map(|d| d as u64).collect();
        let count = dims.iter().try_fold(1u64, |all, &d| all.checked_mul(d));
        let Some(count) = count.filter(|_| dims.len() >= 2) else {
            return Err(self.refuse(dims_tag.at, "two or more dimensions", format!("{dims:?}")));
        };
        let name_tag = self.tag(dims_tag.next, end, "a name")?;
        let name = self.ascii(name_tag, "a name")?;
        Ok(Head {
            class,
            logical,
            complex,
            dims,
            count,
            name,
            at: tag.at,
            next: name_tag.next,
        })
    }

    fn opaque_name(&mut self, at: u64, end: u64) -> Result<String, ReadError> {
        let tag = self.tag(at, end, "a name")?;
        self.ascii(tag, "a name")
    }

    /// One array: a leaf, or a container whose arrays follow.
    fn array(&mut self, tag: Tag, path: &Path) -> Result<(), ReadError> {
        if tag.kind != MATRIX {
            return Err(self.refuse(tag.at, "a matrix element (14)", kind_name(tag.kind)));
        }
        if path.depth > DEEPEST {
            return Err(self.refuse(tag.at, format!("at most {DEEPEST} nested arrays"), "more"));
        }
        if tag.bytes == 0 {
            return Ok(());
        }
        let head = self.head(tag)?;
        let mut path = path.clone();
        if path.depth == 0 {
            path.name = head.name.clone();
            self.tree.variables[self.variable].name = head.name.clone();
            if head.name.is_empty() {
                self.tree
                    .notes
                    .push(format!("unnamed variable at byte {} skipped", head.at));
                return Ok(());
            }
        }
        let end = tag.at + tag.bytes;
        match head.class {
            1 => self.cell(&head, end, &path),
            2 => self.structure(&head, head.next, end, &path),
            3 => self.object(&head, end, &path),
            4 => self.characters(&head, end, &path),
            5 => self.leave_out(path.name, "sparse"),
            6..=15 => self.numeric(&head, end, &path),
            16 => self.function(&head, end, &path),
            17 => self.leave_out(path.name, "opaque object"),
            other => Err(self.refuse(head.at, "an array class from 1 to 17", other.to_string())),
        }
    }

    fn leave_out(&mut self, name: String, kind: &'static str) -> Result<(), ReadError> {
        self.tree.refused.push((name, kind));
        Ok(())
    }

    /// Check that `children` elements can follow in the bytes left.
    fn check_children(&self, head: &Head, per: u64, at: u64, end: u64) -> Result<u64, ReadError> {
        let children = head.count.saturating_mul(per);
        let room = end.saturating_sub(at);
        match children.saturating_mul(8) <= room {
            true => Ok(children),
            false => Err(self.refuse(at, format!("{children} arrays"), format!("{room} bytes"))),
        }
    }

    /// The path of an element of a container, with its index where it has several.
    fn element(&mut self, head: &Head, path: &Path, index: u64, brackets: [char; 2]) -> Path {
        if head.count == 1 {
            return path.clone();
        }
        if path.depth == 0 {
            self.tree.variables[self.variable].elements = head.count;
        }
        let child = path.child(&subscript(&head.dims, index, brackets));
        match path.depth {
            0 => Path {
                element: Some(index),
                tail: String::new(),
                ..child
            },
            _ => child,
        }
    }

    fn cell(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let mut at = head.next;
        for index in 0..self.check_children(head, 1, at, end)? {
            let tag = self.tag(at, end, "a cell")?;
            let mut element = self.element(head, path, index, ['{', '}']);
            element.depth = path.depth + 1;
            self.array(tag, &element)?;
            at = tag.next;
        }
        Ok(())
    }

    fn structure(&mut self, head: &Head, at: u64, end: u64, path: &Path) -> Result<(), ReadError> {
        let width_tag = self.tag(at, end, "the length of field names")?;
        let width = self.integers(width_tag, "the length of field names")?;
        let width = width.first().copied().unwrap_or(0) as usize;
        let names_tag = self.tag(width_tag.next, end, "field names")?;
        let names = self.list(names_tag, "field names")?;
        let names = field_names(&names, width);
        let mut at = names_tag.next;
        if names.is_empty() {
            return Ok(());
        }
        self.check_children(head, names.len() as u64, at, end)?;
        for index in 0..head.count {
            let element = self.element(head, path, index, ['(', ')']);
            for name in &names {
                let tag = self.tag(at, end, "a field")?;
                let mut field = element.child(&format!(".{name}"));
                field.depth = path.depth + 1;
                self.array(tag, &field)?;
                at = tag.next;
            }
        }
        Ok(())
    }

    fn object(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let class = self.tag(head.next, end, "a class name")?;
        self.structure(head, class.next, end, path)
    }

    fn function(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let tag = self.tag(head.next, end, "a function handle")?;
        let inner = Path {
            depth: path.depth + 1,
            ..path.clone()
        };
        self.array(tag, &inner)
    }

    fn characters(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let tag = match self.tag(head.next, end, "characters") {
            Err(_) if head.count == 0 => Tag {
                kind: 2,
                bytes: 0,
                at: end,
                next: end,
            },
            other => other?,
        };
        let (number, encoding) = match tag.kind {
            1 | 2 => (Number::U8, Encoding::Codes),
            3 | 4 | 17 => (Number::U16, Encoding::Utf16),
            16 => (Number::U8, Encoding::Utf8),
            5 | 6 | 18 => (Number::U32, Encoding::Utf32),
            other => return Err(self.refuse(tag.at, "characters", kind_name(other))),
        };
        // Some writers leave out the bytes of a blank text.
        let blank = tag.bytes == 0 && head.dims[0] == 1;
        if head.count > tag.bytes && !blank {
            let found = format!("{} bytes", tag.bytes);
            return Err(self.refuse(tag.at, format!("{} characters", head.count), found));
        }
        let part = Part {
            at: tag.at,
            bytes: tag.bytes,
            number,
        };
        self.leaf(head, path, Content::Text(part, encoding))
    }

    /// One part (real or imaginary) of a numeric array, and where the next element begins.
    fn part(&mut self, head: &Head, at: u64, end: u64) -> Result<(Part, u64), ReadError> {
        let tag = match self.tag(at, end, "numbers") {
            Err(_) if head.count == 0 => Tag {
                kind: 9,
                bytes: 0,
                at: end,
                next: end,
            },
            other => other?,
        };
        let Some(number) = number_of(tag.kind) else {
            return Err(self.refuse(tag.at, "numbers", kind_name(tag.kind)));
        };
        if head.count.checked_mul(number.bytes()) != Some(tag.bytes) {
            let expected = format!("{} numbers of type {}", head.count, number.name());
            return Err(self.refuse(tag.at, expected, format!("{} bytes", tag.bytes)));
        }
        Ok((
            Part {
                at: tag.at,
                bytes: tag.bytes,
                number,
            },
            tag.next,
        ))
    }

    fn numeric(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let (real, next) = self.part(head, head.next, end)?;
        if !head.complex {
            return self.leaf(head, path, Content::Real(real));
        }
        let (imaginary, _) = self.part(head, next, end)?;
        let bits = if head.class == 7 { 32 } else { 64 };
        self.leaf(head, path, Content::Complex(real, imaginary, bits))
    }

    fn leaf(&mut self, head: &Head, path: &Path, content: Content) -> Result<(), ReadError> {
        let mut leaf = Leaf {
            variable: self.variable,
            element: path.element,
            tail: path.leaf_tail(),
            name: path.name.clone(),
            dims: head.dims.clone(),
            content,
            class: class_name(head.class),
            logical: head.logical,
            value: None,
        };
        let order = self.order;
        leaf.value = text::short_value(&leaf, order, |part| {
            self.data(part.at, part.bytes, "a value")
        })?;
        self.tree.leaves.push(leaf);
        Ok(())
    }
}

/// `(2)` or `{2}` for a vector, `(2,1)` or `{2,1}` otherwise; counts from 1 as MATLAB does.
fn subscript(dims: &[u64], mut index: u64, [open, close]: [char; 2]) -> String {
    if dims.iter().filter(|&&d| d != 1).count() <= 1 {
        return format!("{open}{}{close}", index + 1);
    }
    let mut parts = Vec::new();
    for &dim in dims {
        parts.push((index % dim.max(1) + 1).to_string());
        index /= dim.max(1);
    }
    format!("{open}{}{close}", parts.join(","))
}

/// Field names of fixed width; a name that stands again gets `_1_`, `_2_` before it.
fn field_names(bytes: &[u8], width: usize) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut seen = std::collections::HashMap::new();
    for field in bytes.chunks_exact(width.max(1)) {
        let end = field.iter().position(|&b| b == 0).unwrap_or(width);
        let name = crate::record::bytes::decode_text(&field[..end]).into_owned();
        let times: &mut u32 = seen.entry(name.clone()).or_default();
        names.push(if *times == 0 {
            name
        } else {
            format!("_{times}_{name}")
        });
        *times += 1;
    }
    names
}

fn number_of(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

fn kind_name(kind: u32) -> String {
    match (kind, number_of(kind)) {
        (_, Some(number)) => format!("an element of {}", number.name()),
        (14, _) => "a matrix element".into(),
        (15, _) => "a compressed element".into(),
        (16..=18, _) => "an element of text".into(),
        _ => format!("an element of unknown kind {kind}"),
    }
}

fn class_name(class: u8) -> &'static str {
    match class {
        4 => "char",
        6 => "double",
        7 => "single",
        8 => "int8",
        9 => "uint8",
        10 => "int16",
        11 => "uint16",
        12 => "int32",
        13 => "uint32",
        14 => "int64",
        _ => "uint64",
    }
}
