//! `[records]` as written to the list of records: listed, named, and each with its setting.

use super::listing::{self, Listed, Opener, Shared};
use super::names::{self, Known};
use super::quantity::Desk;
use super::resolved::RecordEntry;
use super::settings::{Defaults, Wanted, defaults, note_settings, setting};
use super::written::{Attributes, Records};
use crate::record::Setting;

/// List all records in the order of acquisition: the rows of the run table, else the files'
/// names with numbers in order.
pub fn resolve(
    records: &Records,
    shared: Shared<'_>,
    open: Opener<'_>,
    desk: &mut Desk<'_>,
) -> Vec<RecordEntry> {
    let defaults = defaults(records, desk);
    let listed = match (&records.files, &records.run_table) {
        (Some(files), None) => listing::list_files(files, shared, open, desk),
        (None, Some(table)) => listing::list_rows(table.get_ref(), shared, open, desk),
        (Some(files), Some(_)) => {
            desk.fault(
                files,
                "records.files",
                "files and run_table are both given".to_owned(),
                "keep one of them",
            );
            return Vec::new();
        }
        (None, None) => {
            desk.book.fault(
                None,
                "records",
                "where the records are is not said".to_owned(),
                "write files = \"records/*.h5\" or run_table = \"runs.csv\"",
            );
            return Vec::new();
        }
    };
    listing::note_flags(&listed, desk);
    let entries = entries(&listed, &records.attributes, &defaults, desk);
    note_settings(&entries, desk);
    entries
}

fn entries(
    listed: &[Listed],
    attributes: &Attributes,
    defaults: &Defaults,
    desk: &mut Desk<'_>,
) -> Vec<RecordEntry> {
    let ids = names::of(listed.iter().map(|l| Known {
        file: &l.file,
        dataset: &l.dataset_name,
        given: l.row.as_ref().and_then(|r| r.record.as_deref()),
    }));
    let wanted = Wanted::of(attributes, desk);
    listed
        .iter()
        .zip(ids)
        .enumerate()
        .map(|(sequence, (one, id))| RecordEntry {
            id,
            file: one.file.clone(),
            dataset: one.dataset,
            setting: Setting {
                sequence,
                ..setting(one, &wanted, defaults, desk)
            },
            excluded: false,
        })
        .collect()
}
