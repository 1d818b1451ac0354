//! Atomic output: files are written under a temporary name in the same folder, flushed to the disk,
//! then renamed, so that a file is complete or absent. One lock per folder keeps two processes apart.
//!
//! The lock and the temporary names carry the name of impactid, the program that this crate was
//! made for.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use same_file::Handle;

use labfiles::said;

/// Name of the lock in an output folder.
const LOCK_NAME: &str = ".impactid.lock";

/// The folder in an output folder that outputs are written into, too.
const FIGURES: &str = "figures";

/// Ending of files that are being written.
const PART_ENDING: &str = ".impactid-part";

/// Why an output could not be written; what was there before is untouched.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder could not be created or written into.
    #[error("the folder {} cannot be written into: {}", path.display(), said(source))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file could not be written whole.
    #[error("{} could not be written: {}", path.display(), said(source))]
    File {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Another run writes into the folder.
    #[error("another run of impactid writes into {}", path.display())]
    Locked {
        /// The folder.
        path: PathBuf,
    },
}

impl OutputError {
    /// What the user can do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Locked { .. } => "wait until it has ended, or name another folder with --out",
            // Windows replaces no file that another program has open
            Self::File { path, source }
                if source.kind() == io::ErrorKind::PermissionDenied && path.is_file() =>
            {
                "close it in other programs, or name a folder that you may write into with --out"
            }
            Self::Folder { source, .. } | Self::File { source, .. } => remedy_for(source.kind()),
        }
    }
}

/// What the user can do if the system refuses to write.
pub(crate) fn remedy_for(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free space on the disk, then run again; nothing that was there before is lost"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "name a folder that you may write into with --out"
        }
        io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
            "a file has the folder's name: name another folder with --out"
        }
        io::ErrorKind::NotFound => "create the folder first, or name another one",
        _ => "check the disk and the folder's permissions, then run again",
    }
}

/// The temporary name of a file or folder, in the same folder.
fn hidden_beside(target: &Path) -> PathBuf {
    let name = target
        .file_name()
        .map(|n| n.to_string_lossy())
        .unwrap_or_default();
    target.with_file_name(format!(".{name}{}", own_ending()))
}

/// A file under its temporary name; removed unless it is put in place.
struct Part {
    path: PathBuf,
    placed: bool,
}

impl Drop for Part {
    fn drop(&mut self) {
        if !self.placed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl Part {
    fn of(target: &Path) -> Self {
        Self {
            path: hidden_beside(target),
            placed: false,
        }
    }

    /// A part with these bytes, flushed to the disk.
    fn holding(bytes: &[u8], target: &Path) -> io::Result<Self> {
        let part = Self::of(target);
        let mut file = File::create(&part.path)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        Ok(part)
    }

    /// Flush all that was written to the disk, then give the file its name.
    fn place(mut self, writer: BufWriter<File>, target: &Path) -> io::Result<()> {
        let file = writer
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        self.rename(target)?;
        target.parent().map_or(Ok(()), sync_folder)
    }

    fn rename(&mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.placed = true;
        Ok(())
    }

    /// Put the file in place, or where another program holds the one that is there, beside it.
    fn rename_or_beside(mut self, target: &Path) -> io::Result<Option<WrittenBeside>> {
        match self.rename(target) {
            Err(error) if is_held(&error, target) => {
                let written = new_name(target);
                self.rename(&written).map_err(|_| error)?;
                let wanted = target.to_path_buf();
                Ok(Some(WrittenBeside { wanted, written }))
            }
            placed => placed.map(|()| None),
        }
    }
}

/// A file that was written under another name, because another program holds the one of its own name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenBeside {
    /// Its own name; what was there stays.
    pub wanted: PathBuf,
    /// The name it has.
    pub written: PathBuf,
}

/// `ERROR_SHARING_VIOLATION` of Windows.
const SHARING_VIOLATION: i32 = 32;

/// Whether a file is not replaced because another program holds it, as Windows does not replace what is open and no system
/// what is mounted. The folder takes files: the new one is in it already.
fn is_held(error: &io::Error, target: &Path) -> bool {
    let held = [io::ErrorKind::PermissionDenied, io::ErrorKind::ResourceBusy];
    let shared = cfg!(windows) && error.raw_os_error() == Some(SHARING_VIOLATION);
    (shared || held.contains(&error.kind())) && target.is_file()
}

/// `report.new.pdf` of `report.pdf`.
fn new_name(target: &Path) -> PathBuf {
    let part = |of: Option<&std::ffi::OsStr>| of.map(|s| s.to_string_lossy().into_owned());
    let stem = part(target.file_stem()).unwrap_or_default();
    let ending = part(target.extension()).map_or_else(String::new, |e| format!(".{e}"));
    target.with_file_name(format!("{stem}.new{ending}"))
}

/// Flush the rename itself to the disk.
fn sync_folder(folder: &Path) -> io::Result<()> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    match File::open(folder) {
        Ok(open) if cfg!(unix) => open.sync_all(),
        _ => Ok(()),
    }
}

/// Write a file atomically: `fill` writes it, and it appears under its name when all is on the
/// disk. If anything fails, nothing appears and a file of that name is untouched.
///
/// ```
/// use std::io::{Error, Write};
/// use labfiles_write::output::write_whole;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("result.txt");
/// write_whole(&path, |file| writeln!(file, "R = 0.9"))?;
/// let failed = write_whole(&path, |file| {
///     writeln!(file, "R = ")?;
///     Err(Error::other("interrupted"))
/// });
/// assert!(failed.is_err());
/// assert_eq!(std::fs::read_to_string(&path)?, "R = 0.9\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::File`] with the system's error.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    write_whole_or(path, fill, |e| e).map_err(|source| OutputError::File {
        path: path.to_path_buf(),
        source,
    })
}

/// As [`write_whole`], with an error type of the caller's; `from_io` makes one of a system's error.
///
/// # Errors
/// Those of `fill`, and those that `from_io` makes of the system's errors.
pub(crate) fn write_whole_or<E>(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
    from_io: impl Fn(io::Error) -> E,
) -> Result<(), E> {
    let part = Part::of(path);
    let file = File::create(&part.path).map_err(&from_io)?;
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    fill(&mut writer)?;
    part.place(writer, path).map_err(from_io)
}

/// Write the files of a folder together: `fill` writes them into a hidden folder beside it, and all
/// appear when the last is on the disk. Other files of an existing folder stay. If anything fails,
/// nothing appears.
///
/// # Errors
/// Those of `fill`, and those that `from_io` makes of the system's errors.
pub(crate) fn write_folder_whole_or<E>(
    folder: &Path,
    fill: impl FnOnce(&Path) -> Result<(), E>,
    from_io: impl Fn(io::Error) -> E,
) -> Result<(), E> {
    let part = PartFolder(hidden_beside(folder));
    fs::create_dir_all(&part.0).map_err(&from_io)?;
    fill(&part.0)?;
    part.place(folder).map_err(from_io)
}

/// A folder under its temporary name; what is left of it is removed in the end.
struct PartFolder(PathBuf);

impl PartFolder {
    fn place(&self, folder: &Path) -> io::Result<()> {
        if folder.is_dir() {
            for entry in fs::read_dir(&self.0)? {
                let entry = entry?;
                fs::rename(entry.path(), folder.join(entry.file_name()))?;
            }
            return sync_folder(folder);
        }
        fs::rename(&self.0, folder)?;
        folder.parent().map_or(Ok(()), sync_folder)
    }
}

impl Drop for PartFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Write bytes as [`write_whole`] does.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("a.bin");
/// labfiles_write::output::write_bytes(&path, b"abc")?;
/// assert_eq!(std::fs::read(&path)?, b"abc");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`write_whole`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_whole(path, |writer| writer.write_all(bytes))
}

/// Write files, by their paths in a folder, together: they appear under their names when all are on the disk. If
/// one cannot be written there, none appears.
///
/// ```
/// use labfiles_write::output::write_together;
/// let folder = tempfile::tempdir()?;
/// let too_long = "b".repeat(300);
/// assert!(write_together(folder.path(), &[("a.txt", b"a"), (&too_long, b"b")]).is_err());
/// assert!(!folder.path().join("a.txt").exists());
/// write_together(folder.path(), &[("a.txt", b"a"), ("figures/b.txt", b"b")])?;
/// assert_eq!(std::fs::read(folder.path().join("figures/b.txt"))?, b"b");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError`] with the system's error.
pub fn write_together<N: AsRef<Path>, B: AsRef<[u8]>>(
    folder: &Path,
    files: &[(N, B)],
) -> Result<(), OutputError> {
    together(folder, files, |mut part, path| {
        part.rename(path).map(|()| None)
    })
    .map(drop)
}

/// As [`write_together`]; a file whose name is that of one that another program holds gets the name `NAME.new.ENDING`
/// beside it. Gives those.
///
/// # Errors
/// [`OutputError`] with the system's error.
pub fn write_together_or_beside<N: AsRef<Path>, B: AsRef<[u8]>>(
    folder: &Path,
    files: &[(N, B)],
) -> Result<Vec<WrittenBeside>, OutputError> {
    together(folder, files, Part::rename_or_beside)
}

/// Write files together, each put in place by `place`.
fn together<N: AsRef<Path>, B: AsRef<[u8]>>(
    folder: &Path,
    files: &[(N, B)],
    place: impl Fn(Part, &Path) -> io::Result<Option<WrittenBeside>>,
) -> Result<Vec<WrittenBeside>, OutputError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        |source| OutputError::File { path, source }
    };
    let files = files.iter();
    let files: Vec<(PathBuf, &[u8])> = files
        .map(|(name, bytes)| (folder.join(name), bytes.as_ref()))
        .collect();
    let folders: BTreeSet<&Path> = files.iter().filter_map(|(path, _)| path.parent()).collect();
    folders.iter().try_for_each(|folder| make_folder(folder))?;
    let part = |(path, bytes): &(PathBuf, &[u8])| Part::holding(bytes, path).map_err(failed(path));
    let parts: Vec<Part> = files.par_iter().map(part).collect::<Result<_, _>>()?;
    let mut beside = Vec::new();
    for (part, (path, _)) in parts.into_iter().zip(&files) {
        beside.extend(place(part, path).map_err(failed(path))?);
    }
    for folder in folders {
        sync_folder(folder).map_err(failed(folder))?;
    }
    Ok(beside)
}

/// Write a value as JSON on one line, as [`write_whole`] does.
///
/// # Errors
/// As [`write_whole`]; also if the value cannot be written as JSON.
pub fn write_json_line<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), OutputError> {
    write_whole(path, |writer| Ok(serde_json::to_writer(writer, value)?))
}

/// Create an output folder with all folders above it.
///
/// # Errors
/// [`OutputError::Folder`] with the system's error.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(path).map_err(|source| OutputError::Folder {
        path: path.to_path_buf(),
        source,
    })
}

/// Exclusive right to write into a folder, until it is dropped or the process ends.
///
/// ```
/// use labfiles_write::output::{Lock, OutputError};
/// let folder = tempfile::tempdir()?;
/// let held = Lock::take(folder.path())?;
/// assert!(matches!(Lock::take(folder.path()), Err(OutputError::Locked { .. })));
/// drop(held);
/// Lock::take(folder.path())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Lock {
    file: File,
    path: PathBuf,
}

impl Lock {
    /// Create the folder, take the right to write into it, and remove what an interrupted run
    /// left half-written.
    ///
    /// # Errors
    /// [`OutputError::Locked`] if another run has it, [`OutputError::Folder`] if the folder cannot
    /// be written into.
    pub fn take(folder: &Path) -> Result<Self, OutputError> {
        make_folder(folder)?;
        let path = folder.join(LOCK_NAME);
        let failed = |source| OutputError::Folder {
            path: folder.to_path_buf(),
            source,
        };
        loop {
            let file = OpenOptions::new()
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path)
                .map_err(failed)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(fs::TryLockError::WouldBlock) => {
                    return Err(OutputError::Locked {
                        path: folder.to_path_buf(),
                    });
                }
                Err(fs::TryLockError::Error(source)) => return Err(failed(source)),
            }
            if is_still(&file, &path) {
                clear_parts(folder);
                return Ok(Self { file, path });
            }
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // removed while it is held: who opened it before finds it gone and opens a new one
        let _ = fs::remove_file(&self.path);
        let _ = self.file.unlock();
    }
}

/// Whether the locked file is still the one under the lock's name.
fn is_still(file: &File, path: &Path) -> bool {
    let held = file.try_clone().and_then(Handle::from_file);
    match (held, Handle::from_path(path)) {
        (Ok(held), Ok(named)) => held == named,
        _ => false,
    }
}

/// Remove what interrupted runs left in a folder under temporary names.
pub fn clear_parts(folder: &Path) {
    clear_ending(folder, PART_ENDING);
}

/// Remove what this process has half-written in a folder; other runs' files stay.
pub fn clear_own_parts(folder: &Path) {
    clear_ending(folder, &own_ending());
}

/// Ending of the temporary names of this process.
pub(crate) fn own_ending() -> String {
    format!(".{}{PART_ENDING}", std::process::id())
}

fn clear_ending(folder: &Path, ending: &str) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with('.') && name.ends_with(ending) {
            remove(&entry.path());
        } else if name == FIGURES && entry.path().is_dir() {
            clear_ending(&entry.path(), ending);
        }
    }
}

/// Remove a file or a folder, which another thread may just be filling.
fn remove(path: &Path) {
    if !path.is_dir() {
        let _ = fs::remove_file(path);
        return;
    }
    let tries = 0..10;
    let _ = tries.map(|_| fs::remove_dir_all(path)).find(Result::is_ok);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_bytes(&path, b"first").unwrap();
        let failed = write_whole(&path, |w| {
            w.write_all(b"second")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        let error = failed.unwrap_err();
        assert!(error.remedy().contains("free space"));
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_error_of_another_type_is_passed_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let from_io = |e: io::Error| e.to_string();
        let failed = write_whole_or(&path, |_| Err("unread".to_owned()), from_io);
        assert_eq!(failed, Err("unread".to_owned()));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let absent = folder.path().join("absent").join("a.txt");
        assert!(write_whole_or(&absent, |_| Ok(()), from_io).is_err());
    }

    #[test]
    fn a_second_run_into_the_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let held = Lock::take(&out).unwrap();
        assert!(matches!(Lock::take(&out), Err(OutputError::Locked { .. })));
        drop(held);
        assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
        Lock::take(&out).unwrap();
    }

    #[test]
    fn a_lock_whose_file_another_run_has_removed_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK_NAME);
        let first = File::create(&path).unwrap();
        assert!(is_still(&first, &path));
        fs::remove_file(&path).unwrap();
        assert!(!is_still(&first, &path));
        // the next run has made one of its own
        let _second = File::create(&path).unwrap();
        assert!(!is_still(&first, &path));
    }

    #[test]
    fn new_names_keep_the_ending() {
        let of = |name: &str| new_name(Path::new(name));
        assert_eq!(of("out/report.pdf"), Path::new("out/report.new.pdf"));
        assert_eq!(of("report"), Path::new("report.new"));
    }

    #[test]
    fn leftovers_are_cleared_when_the_lock_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join(format!(".report.pdf.77{PART_ENDING}"));
        fs::write(&left, b"half").unwrap();
        let _held = Lock::take(folder.path()).unwrap();
        assert!(!left.exists());
    }
}
