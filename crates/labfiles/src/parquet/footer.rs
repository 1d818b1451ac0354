//! The footer of a Parquet file, gone through before the library reads it: a list that claims
//! more entries than the footer has bytes would be given memory first and refused later.
//!
//! The footer is a structure of thrift's compact protocol; only its lengths matter here.

use crate::bytes::to_usize;

/// The deepest nesting of a footer.
const DEEPEST: usize = 32;

/// What is wrong with a footer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// What was found.
    pub(super) found: String,
    /// Its offset in the footer.
    pub(super) at: usize,
}

/// Go through a footer.
///
/// # Errors
/// If a length or a count exceeds the bytes that follow, a type is unknown, or the structure
/// does not end.
pub(super) fn check(footer: &[u8]) -> Result<(), Fault> {
    Walk {
        bytes: footer,
        at: 0,
    }
    .structure(0)
}

struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Walk<'_> {
    fn fault<T>(&self, found: impl Into<String>) -> Result<T, Fault> {
        Err(Fault {
            found: found.into(),
            at: self.at,
        })
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        match self.bytes.get(self.at) {
            Some(&byte) => {
                self.at += 1;
                Ok(byte)
            }
            None => self.fault("the footer ends within a value"),
        }
    }

    fn skip(&mut self, count: u64) -> Result<(), Fault> {
        let left = (self.bytes.len() - self.at) as u64;
        if count > left {
            return self.fault(format!("a value of {count} bytes where {left} are left"));
        }
        self.at += to_usize(count);
        Ok(())
    }

    /// A number in groups of seven bits.
    fn number(&mut self) -> Result<u64, Fault> {
        let mut value = 0u64;
        for shift in (0..70).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7F).checked_shl(shift).unwrap_or(0);
            if byte < 0x80 {
                return Ok(value);
            }
        }
        self.fault("a number that does not end")
    }

    fn structure(&mut self, depth: usize) -> Result<(), Fault> {
        if depth > DEEPEST {
            return self.fault("structures nested too deep");
        }
        loop {
            let header = self.byte()?;
            match (header & 0x0F, header >> 4) {
                (0, _) => return Ok(()),
                // Truth values are in the header.
                (1 | 2, 0) => drop(self.number()?),
                (1 | 2, _) => {}
                (kind, 0) => {
                    self.number()?;
                    self.value(kind, depth)?;
                }
                (kind, _) => self.value(kind, depth)?,
            }
        }
    }

    fn value(&mut self, kind: u8, depth: usize) -> Result<(), Fault> {
        match kind {
            1..=3 => self.skip(1),
            4..=6 => self.number().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => self.list(depth),
            12 => self.structure(depth + 1),
            other => self.fault(format!("a value of unknown type {other}")),
        }
    }

    fn list(&mut self, depth: usize) -> Result<(), Fault> {
        let header = self.byte()?;
        let count = match header >> 4 {
            15 => self.number()?,
            few => u64::from(few),
        };
        let left = (self.bytes.len() - self.at) as u64;
        if count > left {
            return self.fault(format!(
                "a list of {count} entries where {left} bytes are left"
            ));
        }
        if depth > DEEPEST {
            return self.fault("lists nested too deep");
        }
        for _ in 0..count {
            self.value(header & 0x0F, depth + 1)?;
        }
        Ok(())
    }
}

/// Unpacked bytes, or values of a dictionary where they are more, that a column's first page
/// claims. Its header is a structure of thrift's compact protocol: the first three fields are
/// 32-bit integers (kind, unpacked and packed bytes), the seventh is a dictionary's own header,
/// which begins with its number of values.
pub(super) fn first_claim(bytes: &[u8]) -> Option<u64> {
    const NEXT_FIELD_I32: u8 = 0x15;
    const FOURTH_NEXT_STRUCTURE: u8 = 0x4C;
    let mut rest = bytes.iter().copied();
    field(&mut rest, NEXT_FIELD_I32)?;
    let unpacked = field(&mut rest, NEXT_FIELD_I32)?;
    let dictionary = field(&mut rest, NEXT_FIELD_I32).and_then(|_packed| {
        rest.next().filter(|b| *b == FOURTH_NEXT_STRUCTURE)?;
        field(&mut rest, NEXT_FIELD_I32)
    });
    Some(unpacked.max(dictionary.unwrap_or(0)))
}

/// An integer field of thrift's compact protocol whose header is `mark`; a negative or endless
/// one is the greatest number.
fn field(bytes: &mut impl Iterator<Item = u8>, mark: u8) -> Option<u64> {
    bytes.next().filter(|b| *b == mark)?;
    let mut value = 0u64;
    for shift in (0..35).step_by(7) {
        let byte = bytes.next()?;
        value |= u64::from(byte & 0x7F) << shift;
        if byte < 0x80 {
            // Zigzag: even numbers are the positive ones, odd ones the negative.
            return Some(if value.is_multiple_of(2) {
                value / 2
            } else {
                u64::MAX
            });
        }
    }
    Some(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_beyond_the_footer_are_refused() {
        // Field 1, i32 2; field 2, list of one structure that is empty; end.
        assert_eq!(check(&[0x15, 4, 0x19, 0x1C, 0, 0]), Ok(()));
        let endless = check(&[0x19, 0xFC, 0xFF, 0xFF, 0xFF, 0xFF, 0x07]).unwrap_err();
        assert!(endless.found.contains("2147483647 entries"), "{endless:?}");
        assert!(check(&[0x18, 100, b'a']).is_err());
        assert!(check(&[0x15]).is_err());
        assert!(check(&[0x1C; 100]).is_err());
    }
}
