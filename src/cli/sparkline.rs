//! A small curve of a signal in characters.

use impact_records::signal::robust::range;
use impact_records::signal::whole;

/// Bits of the eight dots of a braille character, by column and row from the top.
const DOTS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];
/// The braille character without dots.
const BLANK: u32 = 0x2800;

/// Draw values over their index: `width` × `height` characters, each of 2 × 4 dots. Every dot
/// column shows the whole range of the samples that fall into it; gaps are samples that are no
/// numbers. Without a finite value there are no lines.
pub(super) fn sparkline(values: &[f64], width: usize, height: usize) -> Vec<String> {
    let Some((low, high)) = range(values.iter().copied()) else {
        return Vec::new();
    };
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let (columns, rows) = (2 * width, 4 * height);
    let mut cells = vec![vec![BLANK; width]; height];
    let row = |v: f64| {
        let share = if high > low {
            (v / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0)
        } else {
            0.5
        };
        rows - 1 - whole::index((share * (rows - 1) as f64).round())
    };
    let mut before: Option<f64> = None;
    for column in 0..columns {
        let from = column * values.len() / columns;
        let to = ((column + 1) * values.len() / columns)
            .max(from + 1)
            .min(values.len());
        let mut own = values[from..to].iter().copied().filter(|v| v.is_finite());
        // Join to the column before, so that steep flanks are no gaps.
        let joined = own
            .clone()
            .chain(before.filter(|_| own.clone().next().is_some()));
        if let Some((a, b)) = range(joined) {
            for r in row(b)..=row(a) {
                cells[r / 4][column / 2] |= DOTS[column % 2][r % 4];
            }
        }
        before = own.next_back();
    }
    cells
        .iter()
        .map(|line| line.iter().filter_map(|c| char::from_u32(*c)).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_rises_and_gaps_stay_blank() {
        let ramp: Vec<f64> = (0..8).map(f64::from).collect();
        let lines = sparkline(&ramp, 4, 2);
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().all(|l| l.chars().count() == 4));
        assert_eq!(lines[0].chars().next(), char::from_u32(BLANK));
        assert_ne!(lines[1].chars().next(), char::from_u32(BLANK));
        let gap = sparkline(&[0.0, f64::NAN, f64::NAN, 1.0], 4, 1);
        assert_eq!(gap[0].chars().nth(1), char::from_u32(BLANK));
        assert!(sparkline(&[f64::NAN], 4, 1).is_empty());
        assert_eq!(sparkline(&[2.0; 5], 3, 1)[0].chars().count(), 3);
        assert!(!sparkline(&[-f64::MAX, f64::MAX], 3, 1).is_empty());
    }
}
