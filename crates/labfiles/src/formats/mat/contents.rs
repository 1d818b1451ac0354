//! Arrays that hold numbers or characters.

use super::element::{Tag, kind_name, number_of};
use super::names::{Path, class_name};
use super::text;
use super::tree::{Content, Encoding, Leaf, Part};
use super::v5::{Head, Walker};
use crate::numbers::Number;
use crate::source::ReadError;

impl Walker<'_, '_> {
    /// An array of characters.
    pub(super) fn characters(
        &mut self,
        head: &Head,
        end: u64,
        path: &Path,
    ) -> Result<(), ReadError> {
        let tag = self.data_tag(head, head.next, end, 2)?;
        let (number, encoding) = match tag.kind {
            1 | 2 => (Number::U8, Encoding::Codes),
            3 | 4 | 17 => (Number::U16, Encoding::Utf16),
            16 => (Number::U8, Encoding::Utf8),
            5 | 6 | 18 => (Number::U32, Encoding::Utf32),
            other => return Err(self.elements.refuse(tag.at, "characters", kind_name(other))),
        };
        // Some writers leave out the bytes of a blank text.
        let blank = tag.bytes == 0 && head.dims[0] == 1;
        if head.count > tag.bytes && !blank {
            let found = format!("{} bytes", tag.bytes);
            return Err(self
                .elements
                .refuse(tag.at, format!("{} characters", head.count), found));
        }
        let part = Part {
            at: tag.at,
            bytes: tag.bytes,
            number,
        };
        self.leaf(head, path, Content::Text(part, encoding))
    }

    /// The tag of an array's data, which an empty array may lack; it then is of a kind.
    fn data_tag(&mut self, head: &Head, at: u64, end: u64, kind: u32) -> Result<Tag, ReadError> {
        match self.elements.tag(at, end, "an array's data") {
            Err(_) if head.count == 0 => Ok(Tag {
                kind,
                bytes: 0,
                at: end,
                next: end,
            }),
            other => other,
        }
    }

    /// One part (real or imaginary) of a numeric array, and where the next element begins.
    fn part(&mut self, head: &Head, at: u64, end: u64) -> Result<(Part, u64), ReadError> {
        let tag = self.data_tag(head, at, end, 9)?;
        let Some(number) = number_of(tag.kind) else {
            return Err(self.elements.refuse(tag.at, "numbers", kind_name(tag.kind)));
        };
        if head.count.checked_mul(number.bytes()) != Some(tag.bytes) {
            let expected = format!("{} numbers of type {}", head.count, number.stored().name());
            return Err(self
                .elements
                .refuse(tag.at, expected, format!("{} bytes", tag.bytes)));
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

    /// An array of numbers.
    pub(super) fn numeric(&mut self, head: &Head, end: u64, path: &Path) -> Result<(), ReadError> {
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
            class: class_name(head.class).to_owned(),
            logical: head.logical,
            value: None,
        };
        let order = self.elements.order();
        leaf.value = text::short_value(&leaf, order, |part| {
            self.elements.data(part.at, part.bytes, "a value")
        })?;
        self.tree.leaves.push(leaf);
        Ok(())
    }
}
