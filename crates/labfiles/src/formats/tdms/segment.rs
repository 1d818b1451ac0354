//! The segments of a TDMS file: lead-in, metadata, and the places of their raw data.

use std::collections::HashMap;

use super::content::{Content, Object, Piece};
use super::index;
use super::layout::Layout;
use super::value::{self, Value};
use crate::bytes::{Cursor, FileBytes};
use crate::numbers::ByteOrder;
use crate::source::ReadError;

const META_DATA: u32 = 1 << 1;
const NEW_LIST: u32 = 1 << 2;
const RAW_DATA: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;

/// Bytes of a segment's lead-in.
const LEAD_IN: u64 = 28;
const NO_DATA: u32 = u32::MAX;
const AS_BEFORE: u32 = 0;

struct LeadIn {
    at: u64,
    flags: u32,
    data: u64,
    end: u64,
    cut_short: bool,
}

fn order(flags: u32) -> ByteOrder {
    match flags & BIG_ENDIAN {
        0 => ByteOrder::Little,
        _ => ByteOrder::Big,
    }
}

/// Find all segments of a file.
pub(super) fn scan(file: &FileBytes) -> Result<Content, ReadError> {
    let mut scanner = Scanner {
        file,
        content: Content::default(),
        by_path: HashMap::new(),
        list: Vec::new(),
        current: None,
        built: 0,
    };
    let mut at = 0;
    while at < file.size() {
        let Some(lead) = scanner.lead_in(at)? else {
            break;
        };
        scanner.segment(&lead)?;
        at = lead.end;
    }
    scanner.count();
    Ok(scanner.content)
}

struct Scanner<'a> {
    file: &'a FileBytes,
    content: Content,
    by_path: HashMap<String, usize>,
    /// The objects of the present segment, in the order of their data.
    list: Vec<usize>,
    /// The present layout.
    current: Option<usize>,
    /// Entries of all layouts built so far.
    built: u64,
}

impl Scanner<'_> {
    fn lead_in(&mut self, at: u64) -> Result<Option<LeadIn>, ReadError> {
        let left = self.file.size() - at;
        if left < LEAD_IN && at > 0 {
            self.content.notes.push(format!(
                "{left} bytes at byte {at} are no segment: not read"
            ));
            return Ok(None);
        }
        let mut cursor = self.file.cursor(ByteOrder::Little);
        cursor.seek(at);
        let tag = cursor.take(4, "a segment's tag")?;
        if tag != b"TDSm" {
            let found = String::from_utf8_lossy(tag).into_owned();
            return Err(self
                .file
                .refuse(at, "the tag TDSm of a segment", format!("{found:?}")));
        }
        let flags = cursor.u32("a segment's flags")?;
        cursor.set_order(order(flags));
        let version = cursor.u32("a version")?;
        if !matches!(version, 4712 | 4713) {
            return Err(self
                .file
                .refuse(at + 8, "version 4712 or 4713", version.to_string()));
        }
        let next = cursor.u64("the length of a segment")?;
        let raw = cursor.u64("the length of the metadata")?;
        let start = cursor.at();
        let end = start
            .checked_add(next)
            .filter(|&end| end <= self.file.size());
        let cut_short = end.is_none();
        let end = end.unwrap_or(self.file.size());
        let data = start.checked_add(raw).filter(|&data| data <= end);
        if cut_short {
            self.content.notes.push(format!(
                "the last segment (byte {at}) was cut short: read as far as it goes"
            ));
        }
        match data {
            Some(data) => Ok(Some(LeadIn {
                at,
                flags,
                data,
                end,
                cut_short,
            })),
            None if cut_short && at > 0 => Ok(None),
            None => Err(self.file.refuse(
                at + 20,
                format!("metadata within {} bytes", end - start),
                raw.to_string(),
            )),
        }
    }

    fn segment(&mut self, lead: &LeadIn) -> Result<(), ReadError> {
        if lead.flags & META_DATA != 0 {
            self.metadata(lead)?;
        } else if self.current.is_none() && lead.flags & RAW_DATA != 0 && lead.data < lead.end {
            return Err(self.file.refuse(
                lead.at,
                "metadata in the first segment with data",
                "none",
            ));
        }
        if lead.flags & RAW_DATA != 0 {
            self.raw_data(lead)?;
        }
        Ok(())
    }

    fn metadata(&mut self, lead: &LeadIn) -> Result<(), ReadError> {
        let fresh = lead.flags & NEW_LIST != 0 || self.current.is_none();
        if fresh {
            for object in std::mem::take(&mut self.list) {
                let object = &mut self.content.objects[object];
                (object.listed, object.active) = (false, false);
            }
        }
        let mut cursor = self
            .file
            .cursor(order(lead.flags))
            .part(lead.at + LEAD_IN, lead.data);
        let count = cursor.u32("the number of objects")?;
        let mut changed = fresh;
        for _ in 0..count {
            changed |= self.object(&mut cursor, lead)?;
        }
        if changed {
            self.lay_out(lead, fresh)?;
        }
        Ok(())
    }

    /// Read one object's metadata; gives whether the layout of the data changes with it.
    fn object(&mut self, cursor: &mut Cursor<'_>, lead: &LeadIn) -> Result<bool, ReadError> {
        let at = cursor.at();
        let path = value::text(cursor, "an object's path")?;
        let index = match self.by_path.get(&path) {
            Some(&index) => index,
            None => {
                let parts = split_path(&path).ok_or_else(|| {
                    self.file
                        .refuse(at, "a path such as /'group'/'channel'", format!("{path:?}"))
                })?;
                let index = self.content.objects.len();
                self.content.objects.push(Object {
                    path: parts,
                    ..Object::default()
                });
                self.by_path.insert(path, index);
                index
            }
        };
        let changed = self.raw_index(cursor, index)?;
        let properties = cursor.u32("the number of properties")?;
        for _ in 0..properties {
            let name = value::text(cursor, "a property's name")?;
            let code = cursor.u32("a property's type")?;
            let value = Value::read(cursor, code, order(lead.flags))?;
            self.content.objects[index].properties.insert(name, value);
        }
        Ok(changed)
    }

    fn raw_index(&mut self, cursor: &mut Cursor<'_>, index: usize) -> Result<bool, ReadError> {
        let at = cursor.at();
        let header = cursor.u32("a raw data index")?;
        let object = &mut self.content.objects[index];
        if !object.listed {
            object.listed = true;
            self.list.push(index);
        }
        let was_active = object.active;
        object.active = header != NO_DATA;
        match header {
            NO_DATA => return Ok(was_active),
            AS_BEFORE if object.share.is_some() => return Ok(!was_active),
            AS_BEFORE => {
                return Err(self
                    .file
                    .refuse(at, "a raw data index", "a reference to none before"));
            }
            _ => {}
        }
        if object.path.len() != 2 {
            return Err(self
                .file
                .refuse(at, "raw data of a channel", "raw data of a group"));
        }
        let share = index::share(self.file, cursor, header)?;
        let object = &mut self.content.objects[index];
        if share.count > 0 && *object.kind.get_or_insert(share.kind) != share.kind {
            let found = format!("channel {:?} that changes its type", object.path);
            return Err(self.file.refuse(at, "one type per channel", found));
        }
        object.share = Some(share);
        Ok(true)
    }

    /// Build the layout of the listed objects that have data.
    fn lay_out(&mut self, lead: &LeadIn, fresh: bool) -> Result<(), ReadError> {
        let objects = &self.content.objects;
        let active = self.list.iter().filter(|&&index| objects[index].active);
        let shares: Vec<_> = active
            .filter_map(|&index| Some((index, objects[index].share.clone()?)))
            .collect();
        if !fresh {
            self.spend(lead.at, shares.len())?;
        }
        let layout = Layout::new(shares).map_err(|found| {
            self.file.refuse(
                lead.at,
                "channels whose data fit together",
                found.to_string(),
            )
        })?;
        let same = self
            .current
            .is_some_and(|c| self.content.layouts[c] == layout);
        if !same {
            self.add(layout);
        }
        Ok(())
    }

    fn add(&mut self, layout: Layout) {
        self.current = Some(self.content.layouts.len());
        self.content.layouts.push(layout);
        self.content.pieces_of.push(Vec::new());
    }

    /// Count entries of layouts that a few bytes of metadata can call forth.
    fn spend(&mut self, at: u64, entries: usize) -> Result<(), ReadError> {
        self.built += entries as u64;
        if self.built <= self.file.size() / 4 + 4096 {
            Ok(())
        } else {
            Err(self
                .file
                .refuse(at, "layouts in proportion to the file", "far too many"))
        }
    }

    fn raw_data(&mut self, lead: &LeadIn) -> Result<(), ReadError> {
        let total = lead.end - lead.data;
        let Some(current) = self.current.filter(|_| total > 0) else {
            return Ok(());
        };
        let layout = &self.content.layouts[current];
        if layout.chunk == 0 {
            let found = format!("{total} bytes of data");
            return Err(self
                .file
                .refuse(lead.data, "no data, as no channel has any", found));
        }
        let device = layout
            .entries
            .iter()
            .any(|entry| entry.share.device.is_some());
        let interleaved = lead.flags & INTERLEAVED != 0 && !device;
        if interleaved && !layout.can_interleave() {
            let expected = "interleaved channels of equal lengths and fixed types";
            return Err(self.file.refuse(lead.at, expected, "others"));
        }
        let (chunks, rest) = (total / layout.chunk, total % layout.chunk);
        let cut = layout.cut(rest, lead.cut_short, interleaved);
        let order = order(lead.flags);
        let piece = Piece {
            at: lead.data,
            chunks,
            layout: current,
            order,
            interleaved,
        };
        let rest_at = lead.data + chunks * layout.chunk;
        if chunks > 0 {
            self.piece(piece);
        }
        if rest > 0 {
            self.spend(lead.at, cut.entries.len())?;
            self.content.notes.push(format!(
                "the chunk at byte {rest_at} is incomplete: read as far as it goes"
            ));
            self.add(cut);
            let layout = self.content.layouts.len() - 1;
            self.piece(Piece {
                at: rest_at,
                chunks: 1,
                layout,
                ..piece
            });
            self.current = Some(current);
        }
        Ok(())
    }

    fn piece(&mut self, piece: Piece) {
        self.content.pieces_of[piece.layout].push(self.content.pieces.len());
        self.content.pieces.push(piece);
    }

    /// Count each channel's samples and note where they are.
    fn count(&mut self) {
        let content = &mut self.content;
        for (index, layout) in content.layouts.iter().enumerate() {
            let pieces = content.pieces_of[index].iter();
            let chunks: u64 = pieces.map(|&piece| content.pieces[piece].chunks).sum();
            if chunks == 0 {
                continue;
            }
            let with_data = layout
                .entries
                .iter()
                .enumerate()
                .filter(|(_, e)| e.share.count > 0);
            for (position, entry) in with_data {
                let object = &mut content.objects[entry.object];
                object.samples += chunks * entry.share.count;
                object.places.push((index, position));
            }
        }
    }
}

/// The parts of `/'group'/'channel'`; a quote in a name is doubled.
fn split_path(path: &str) -> Option<Vec<String>> {
    if path == "/" {
        return Some(Vec::new());
    }
    let mut parts = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        let mut name = String::new();
        let mut characters = rest.strip_prefix("/'")?.char_indices().peekable();
        let end = loop {
            match characters.next()? {
                (_, '\'') if characters.next_if(|&(_, c)| c == '\'').is_some() => name.push('\''),
                (at, '\'') => break at,
                (_, other) => name.push(other),
            }
        };
        parts.push(name);
        rest = &rest[2 + end + 1..];
    }
    (parts.len() <= 2).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::split_path;

    #[test]
    fn paths_with_quotes_and_slashes() {
        let parts = |path| split_path(path);
        assert_eq!(parts("/"), Some(vec![]));
        assert_eq!(parts("/'a'"), Some(vec!["a".into()]));
        assert_eq!(
            parts("/'it''s'/'x/y'"),
            Some(vec!["it's".into(), "x/y".into()])
        );
        assert_eq!(parts("/'a"), None);
        assert_eq!(parts("a"), None);
        assert_eq!(parts("/'a'/'b'/'c'"), None);
    }
}
