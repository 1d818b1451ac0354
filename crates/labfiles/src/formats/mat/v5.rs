//! Level 5 files (v5, v6, and v7 with its compressed variables): tagged elements, nested.
//!
//! Every element has a tag of 8 bytes (kind, length) or, where its data fit in 4 bytes, one that
//! holds them. A variable is a matrix element, plain or inside a zlib stream.

use super::element::{Elements, Tag, kind_name};
use super::inflate::Stream;
use super::names::{Path, field_names};
use super::tree::{Packed, Tree, Variable};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::ByteOrder;
use crate::source::ReadError;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Bytes before the first element.
const HEADER: u64 = 128;
/// Deepest nesting of cells and structs that is followed.
const DEEPEST: usize = 48;

/// Byte order of a level 5 file, from its header; `None`: it is none (or is v7.3, an HDF5 file).
pub(super) fn byte_order(head: &[u8]) -> Option<ByteOrder> {
    match head.get(124..128)? {
        [_, 1, b'I', b'M'] => Some(ByteOrder::Little),
        [1, _, b'M', b'I'] => Some(ByteOrder::Big),
        _ => None,
    }
}

/// Walks through the arrays of one variable.
pub(super) struct Walker<'a, 't> {
    /// Its elements.
    pub elements: Elements<'a>,
    /// Its index.
    pub variable: usize,
    /// What was found so far.
    pub tree: &'t mut Tree,
}

/// What precedes the data of an array.
#[derive(Default)]
pub(super) struct Head {
    /// Its class.
    pub class: u8,
    /// Whether it holds true and false.
    pub logical: bool,
    /// Whether it is complex.
    pub complex: bool,
    /// Its dimensions.
    pub dims: Vec<u64>,
    /// Their product.
    pub count: u64,
    /// Its name.
    pub name: String,
    /// Offset of its first byte.
    pub at: u64,
    /// Offset of what follows its name.
    pub next: u64,
}

/// Find all variables of a level 5 file.
pub(super) fn scan(file: &FileBytes, order: ByteOrder) -> Result<Tree, ReadError> {
    let mut tree = Tree::default();
    let mut at = HEADER;
    while at < file.size() {
        let rest = file.slice(at, file.size() - at, "a variable")?;
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
    let left = file.size() - data;
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
            walk(Elements::new(file, None, order), tag, None, tree)?;
            Ok(tag.next.min(file.size()))
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
    let [kind, length] =
        [0, 4].map(|i| order.u32([head[i], head[i + 1], head[i + 2], head[i + 3]]));
    let length = u64::from(length);
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
    let place = Packed {
        at,
        packed: bytes,
        inflated,
    };
    let elements = Elements::new(file, Some(stream), order);
    walk(elements, tag, Some(place), tree)
}

/// Walk through the variable whose matrix element was found.
fn walk(
    elements: Elements<'_>,
    tag: Tag,
    packed: Option<Packed>,
    tree: &mut Tree,
) -> Result<(), ReadError> {
    if tag.bytes == 0 {
        return Ok(());
    }
    let variable = tree.variables.len();
    tree.variables.push(Variable {
        name: String::new(),
        packed,
        order: elements.order(),
    });
    let mut walker = Walker {
        elements,
        variable,
        tree,
    };
    walker.array(tag, &Path::to(""))
}

impl Walker<'_, '_> {
    fn head(&mut self, tag: Tag) -> Result<Head, ReadError> {
        let end = tag.at + tag.bytes;
        let flags_tag = self.elements.tag(tag.at, end, "array flags")?;
        if flags_tag.kind != 6 || flags_tag.bytes != 8 {
            let found = format!("{} of {} bytes", kind_name(flags_tag.kind), flags_tag.bytes);
            return Err(self
                .elements
                .refuse(tag.at, "array flags (uint32, 8 bytes)", found));
        }
        let flags = self.elements.list(flags_tag, "array flags")?;
        let flags = self.elements.word(&flags[..4]);
        let class = (flags & 0xff) as u8;
        let (logical, complex) = (flags & 0x200 != 0, flags & 0x800 != 0);
        if class == 17 {
            let (name, next) = self.name(flags_tag.next, end)?;
            return Ok(Head {
                class,
                name,
                next,
                ..Head::default()
            });
        }
        let dims_tag = self.elements.tag(flags_tag.next, end, "dimensions")?;
        let dims = self.elements.integers(dims_tag, "dimensions")?;
        let count = dims.iter().try_fold(1u64, |all, &d| all.checked_mul(d));
        let Some(count) = count.filter(|_| dims.len() >= 2) else {
            return Err(self.elements.refuse(
                dims_tag.at,
                "two or more dimensions",
                format!("{dims:?}"),
            ));
        };
        let (name, next) = self.name(dims_tag.next, end)?;
        Ok(Head {
            class,
            logical,
            complex,
            dims,
            count,
            name,
            at: tag.at,
            next,
        })
    }

    /// A name, and where the next element begins.
    fn name(&mut self, at: u64, end: u64) -> Result<(String, u64), ReadError> {
        let tag = self.elements.tag(at, end, "a name")?;
        Ok((self.elements.ascii(tag, "a name")?, tag.next))
    }

    /// One array: a leaf, or a container whose arrays follow.
    fn array(&mut self, tag: Tag, path: &Path) -> Result<(), ReadError> {
        if tag.kind != MATRIX {
            return Err(self
                .elements
                .refuse(tag.at, "a matrix element (14)", kind_name(tag.kind)));
        }
        if path.depth > DEEPEST {
            return Err(self.elements.refuse(
                tag.at,
                format!("at most {DEEPEST} nested arrays"),
                "more",
            ));
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
            5 => self.leave_out(path.name, "sparse".to_owned()),
            6..=15 => self.numeric(&head, end, &path),
            16 => self.function(&head, end, &path),
            17 => {
                let kind = self.class_of_object(&head, end);
                self.leave_out(path.name, kind)
            }
            other => {
                Err(self
                    .elements
                    .refuse(head.at, "an array class from 1 to 17", other.to_string()))
            }
        }
    }

    fn leave_out(&mut self, name: String, kind: String) -> Result<(), ReadError> {
        self.tree.refused.push((name, kind));
        Ok(())
    }

    /// The class of an opaque object, after its name and the name of its system of types.
    fn class_of_object(&mut self, head: &Head, end: u64) -> String {
        let mut class = || {
            let (_, next) = self.name(head.next, end).ok()?;
            Some(self.name(next, end).ok()?.0)
        };
        let class = class().filter(|name| !name.is_empty());
        class.unwrap_or_else(|| "object".to_owned())
    }

    /// Check that `children` elements can follow in the bytes left.
    fn check_children(&self, head: &Head, per: u64, at: u64, end: u64) -> Result<u64, ReadError> {
        let children = head.count.saturating_mul(per);
        let room = end.saturating_sub(at);
        if children.saturating_mul(8) <= room {
            Ok(children)
        } else {
            Err(self
                .elements
                .refuse(at, format!("{children} arrays"), format!("{room} bytes")))
        }
    }

    fn cell(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let mut at = head.next;
        for index in 0..self.check_children(head, 1, at, end)? {
            let tag = self.elements.tag(at, end, "a cell")?;
            let element = path.element(index, head.count, &head.dims, ['{', '}']);
            self.array(tag, &element)?;
            at = tag.next;
        }
        Ok(())
    }

    fn structure(&mut self, head: &Head, at: u64, end: u64, path: &Path) -> Result<(), ReadError> {
        let width_tag = self.elements.tag(at, end, "the length of field names")?;
        let width = self
            .elements
            .integers(width_tag, "the length of field names")?;
        let width = to_usize(width.first().copied().unwrap_or(0));
        let names_tag = self.elements.tag(width_tag.next, end, "field names")?;
        let names = self.elements.list(names_tag, "field names")?;
        let names = field_names(&names, width);
        let mut at = names_tag.next;
        if names.is_empty() {
            return Ok(());
        }
        self.check_children(head, names.len() as u64, at, end)?;
        for index in 0..head.count {
            let element = path.element(index, head.count, &head.dims, ['(', ')']);
            for name in &names {
                let tag = self.elements.tag(at, end, "a field")?;
                let mut field = element.child(&format!(".{name}"));
                field.depth = path.depth + 1;
                self.array(tag, &field)?;
                at = tag.next;
            }
        }
        Ok(())
    }

    fn object(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let class = self.elements.tag(head.next, end, "a class name")?;
        self.structure(head, class.next, end, path)
    }

    fn function(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
        let tag = self.elements.tag(head.next, end, "a function handle")?;
        let inner = Path {
            depth: path.depth + 1,
            ..path.clone()
        };
        self.array(tag, &inner)
    }
}
