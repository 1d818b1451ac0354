//! `[records]` as written to the list of records: listed, named, and each with its setting.

use super::context::ResolveContext;
use super::diagnostic::Code;
use super::discovery::{self, Discovered, Opener, Shared};
use super::names::{self, Known};
use super::resolved::RecordEntry;
use super::sections::records::{RecordsTable, defaults};
use super::settings::{Wanted, note_settings, setting};
use impact_records::record::Setting;

/// List all records in the order of acquisition: the rows of the run table, else the files'
/// names with numbers in order.
pub(super) fn resolve(
    records: &RecordsTable,
    shared: Shared<'_>,
    open: Opener<'_>,
    context: &mut ResolveContext<'_>,
) -> Vec<RecordEntry> {
    let defaults = defaults(records, context);
    let mut listed = match (&records.files, &records.run_table) {
        (Some(files), None) => discovery::list_files(files, shared, open, context),
        (None, Some(table)) => discovery::list_rows(table.get_ref(), shared, open, context),
        (Some(files), Some(_)) => {
            context.fault(
                Code::Conflict,
                files,
                "records.files",
                "files and run_table are both given",
                "keep one of them",
            );
            return Vec::new();
        }
        (None, None) => {
            context.faults.fault(
                Code::Missing,
                None,
                "records",
                "the location of the records is not given",
                "write files = \"records/*.h5\" or run_table = \"runs.csv\"",
            );
            return Vec::new();
        }
    };
    let ids = names::of(listed.iter().map(|l| Known {
        file: &l.file,
        dataset: &l.dataset_name,
        given: l.row.as_ref().and_then(|r| r.record.as_deref()),
    }));
    for (one, id) in listed.iter_mut().zip(ids) {
        one.id = id;
    }
    discovery::note_flags(&listed, context);
    let entries = entries(&listed, records, &defaults, context);
    note_settings(&entries, context);
    entries
}

fn entries(
    listed: &[Discovered],
    records: &RecordsTable,
    defaults: &Setting,
    context: &mut ResolveContext<'_>,
) -> Vec<RecordEntry> {
    let wanted = Wanted::of(records, context);
    listed
        .iter()
        .enumerate()
        .map(|(sequence, one)| RecordEntry {
            id: one.id.clone(),
            file: one.file.clone(),
            dataset: one.dataset,
            setting: Setting {
                sequence,
                ..setting(one, &wanted, defaults, context)
            },
            excluded: false,
        })
        .collect()
}
