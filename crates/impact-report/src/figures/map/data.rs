//! The map's data: the records' texts for hovering, and all layers as CSV.

use crate::figures::boundaries;
use crate::kit::csv::Csv;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::{Compared, RecordRow, RegionMap};
use impact_records::motion::Motion;
use impact_records::record::Sweep;

/// The text that is shown on hovering over a record.
pub(super) fn describe(record: &RecordRow, locale: Locale<'_>) -> String {
    let mut parts = vec![
        record.id.clone(),
        format!("z = {}", locale.motion(&record.motion)),
    ];
    if let Some(f) = record.frequency_hz {
        parts.push(format!("f = {} Hz", locale.fixed(f, 3)));
    }
    if let Some(r) = record.clearance_m {
        parts.push(format!("r = {} mm", locale.clearance(r)));
    }
    if let (Some(eta), Some(rho)) = (record.eta, record.rho) {
        parts.push(format!(
            "η = {}, ρ = {}",
            locale.fixed(eta, 4),
            locale.fixed(rho, 3)
        ));
    }
    let sweep = match record.sweep {
        Sweep::Up => Phrase::SweepUp,
        Sweep::Down => Phrase::SweepDown,
        Sweep::Unknown => Phrase::SweepUnknown,
    };
    parts.push(locale.translate(sweep));
    let share = locale.fixed(record.confidence, 2);
    parts.push(locale.translate_with(Phrase::ConfidenceOf, &[("share", &share)]));
    parts.join("\n")
}

/// All layers of the map as CSV.
pub(super) fn csv(compared: &Compared) -> String {
    let mut csv = Csv::new(&[
        "layer",
        "name",
        "motion",
        "sweep",
        "eta",
        "rho",
        "frequency_hz",
        "clearance_m",
        "eta_high",
        "rho_high",
        "frequency_high_hz",
    ]);
    for r in &compared.records {
        csv.row()
            .texts(&["record", &r.id, &r.motion.label(), r.sweep.name()])
            .numbers(&[r.eta, r.rho, r.frequency_hz, r.clearance_m]);
    }
    for b in &compared.brackets {
        csv.row()
            .texts(&[
                "bracket",
                boundaries::name(b.kind),
                &b.motion.label(),
                b.sweep.name(),
            ])
            .numbers(&[
                b.eta.map(|e| e[0]),
                b.rho,
                Some(b.frequency_low_hz),
                Some(b.clearance_m),
            ])
            .numbers(&[b.eta.map(|e| e[1]), b.rho, Some(b.frequency_high_hz)]);
    }
    for c in &compared.curves {
        let name = boundaries::name(c.kind);
        let motion = Motion::periodic(1, c.periods_n).label();
        for p in &c.points {
            csv.row()
                .texts(&["curve", name, &motion, ""])
                .numbers(&[Some(p[0]), Some(p[1])]);
        }
        for b in &c.band95 {
            let row = csv.row().texts(&["band95", name, &motion, ""]);
            row.numbers(&[Some(b[0]), Some(b[1]), None, None, Some(b[0]), Some(b[2])]);
        }
    }
    if let Some(map) = &compared.region_map {
        regions(&mut csv, "region", &map.cells, map);
        let differs = map.second.iter().zip(&map.cells);
        let differs: Vec<u16> = differs
            .map(|(second, first)| if second == first { u16::MAX } else { *second })
            .collect();
        regions(&mut csv, "region_from_other_start", &differs, map);
    }
    csv.finish()
}

/// The cells of a region map, row by row; neighbours of one motion are one row of the table.
fn regions(csv: &mut Csv, layer: &str, cells: &[u16], map: &RegionMap) {
    let columns = map.x.len();
    if columns == 0 {
        return;
    }
    for (row, rho) in cells.chunks(columns).zip(&map.y) {
        let mut first = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let last = first + run.len() - 1;
            let motion = map.motions.get(usize::from(run[0]));
            if let Some(motion) = motion {
                let (from, to) = (Some(map.x[first]), Some(map.x[last]));
                csv.row()
                    .texts(&[layer, "", &motion.label(), ""])
                    .numbers(&[from, Some(*rho), None, None, to, Some(*rho)]);
            }
            first = last + 1;
        }
    }
}
