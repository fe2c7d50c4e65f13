//! Writing that loses nothing: a file is replaced as a whole or not at all.

use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What the names of temporary files begin and end with; letters and digits stand between.
const TEMPORARY: [&str; 2] = [".whipple-", ".tmp"];

/// A write that failed. Unless the operation is [`Operation::SyncFolder`], the earlier file (or its
/// absence) is unchanged.
#[derive(Debug, thiserror::Error)]
#[error("cannot {operation} {}: {cause}", path.display())]
pub struct FileError {
    /// The file or folder that was to be written.
    pub path: PathBuf,
    /// The step that failed.
    pub operation: Operation,
    /// Why, in terms a user can act on.
    pub cause: Cause,
    /// What the system says.
    pub source: io::Error,
}

/// The steps of a write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operation {
    /// Making the folder.
    CreateFolder,
    /// Looking at what stands at the path.
    Inspect,
    /// Making the temporary file beside the target (or opening a device).
    CreateFile,
    /// Removing a temporary file that a killed program has left.
    Remove,
    /// Writing the bytes and bringing them to the disk.
    Write,
    /// Putting the temporary file in the place of the target.
    Replace,
    /// Bringing the new folder entry to the disk; the new file is already in place.
    SyncFolder,
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CreateFolder => "make the folder",
            Self::Inspect => "look at",
            Self::CreateFile => "create",
            Self::Remove => "remove",
            Self::Write => "write",
            Self::Replace => "replace",
            Self::SyncFolder => "bring to the disk the folder of",
        })
    }
}

/// Why a write failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Cause {
    /// No space, or the quota is used up.
    #[error("the disk is full")]
    DiskFull,
    /// The file, folder or file system is read-only, or belongs to somebody else.
    #[error("it is read-only or permission is missing")]
    ReadOnly,
    /// A file where a folder should be.
    #[error("a file stands where a folder should be")]
    FileInTheWay,
    /// A folder where a file should be.
    #[error("a folder stands where a file should be")]
    FolderInTheWay,
    /// The folder does not exist.
    #[error("its folder does not exist")]
    FolderMissing,
    /// The file system lets nobody make folders there, as that of `/proc`.
    #[error("no folder can be made there")]
    NoFolders,
    /// Anything else, in the words of the system.
    #[error("{0}")]
    Other(String),
}

impl From<&io::Error> for Cause {
    fn from(error: &io::Error) -> Self {
        use io::ErrorKind as Kind;
        match error.kind() {
            Kind::StorageFull | Kind::QuotaExceeded => Self::DiskFull,
            Kind::PermissionDenied | Kind::ReadOnlyFilesystem => Self::ReadOnly,
            Kind::NotADirectory | Kind::AlreadyExists => Self::FileInTheWay,
            Kind::IsADirectory => Self::FolderInTheWay,
            Kind::NotFound => Self::FolderMissing,
            _ => Self::Other(error.to_string()),
        }
    }
}

/// Writes `bytes` to `path` so that a reader sees the earlier file or the new one, never a part:
/// temporary file in the same folder, fsync, rename, fsync of the folder.
///
/// The folder must exist. A symbolic link is followed, the mode of an earlier file is kept, and a
/// read-only file is refused. A device or pipe (`/dev/stdout`) is written directly.
///
/// # Errors
/// [`FileError`]; the earlier file is unchanged and the temporary file removed, except after
/// [`Operation::SyncFolder`], where the new file is in place but may not survive a power cut.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    replace_with(path, |file| file.write_all(bytes))
}

/// Makes the folder `path` if needed and proves that a file can be written in it, so that a long
/// run does not end without a place for its results.
///
/// # Errors
/// [`FileError`] if the folder cannot be made or a trial file cannot be written there.
pub fn ensure_writable_dir(path: &Path) -> Result<(), FileError> {
    fs::create_dir_all(path).map_err(|error| {
        let missing = error.kind() == io::ErrorKind::NotFound;
        let failure = failed(path, Operation::CreateFolder)(error);
        // All folders above are made on the way, so none of them is missing.
        if missing { FileError { cause: Cause::NoFolders, ..failure } } else { failure }
    })?;
    let mut trial = temporary_in(path).map_err(failed(path, Operation::CreateFile))?;
    trial
        .write_all(b"trial")
        .and_then(|()| trial.as_file().sync_all())
        .and_then(|()| trial.close())
        .map_err(failed(path, Operation::Write))
}

/// Removes the temporary files that programs which were killed within a write have left in `folder`. No other
/// program may write there meanwhile.
///
/// # Errors
/// [`FileError`] if the folder cannot be read, or such a file not be removed.
pub fn sweep(folder: &Path) -> Result<(), FileError> {
    let entries = fs::read_dir(folder).map_err(failed(folder, Operation::Inspect))?;
    for entry in entries {
        let path = entry.map_err(failed(folder, Operation::Inspect))?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let [begin, end] = TEMPORARY;
        let inner = name.strip_prefix(begin).and_then(|rest| rest.strip_suffix(end));
        if inner.is_some_and(|inner| inner.chars().all(|c| c.is_ascii_alphanumeric()))
            && path.is_file()
        {
            fs::remove_file(&path).map_err(failed(&path, Operation::Remove))?;
        }
    }
    Ok(())
}

/// [`write_atomic`] with the bytes produced by `fill`.
fn replace_with(
    path: &Path,
    fill: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), FileError> {
    let inspect = failed(path, Operation::Inspect);
    let earlier = match fs::metadata(path) {
        Ok(found) => Some(found),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(inspect(error)),
    };
    let mode = earlier.as_ref().map(fs::Metadata::permissions);
    let target = match &earlier {
        None => path.to_owned(),
        Some(found) if found.is_dir() => return Err(inspect(io::ErrorKind::IsADirectory.into())),
        Some(found) if !found.is_file() => return write_device(path, fill),
        Some(_) if mode.as_ref().is_some_and(fs::Permissions::readonly) => {
            return Err(failed(path, Operation::Replace)(io::ErrorKind::PermissionDenied.into()));
        }
        Some(_) => fs::canonicalize(path).map_err(inspect)?,
    };
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut fresh = temporary_in(folder).map_err(failed(path, Operation::CreateFile))?;
    fill(fresh.as_file_mut())
        .and_then(|()| mode.map_or(Ok(()), |mode| fresh.as_file().set_permissions(mode)))
        .and_then(|()| fresh.as_file().sync_all())
        .map_err(failed(path, Operation::Write))?;
    fresh.persist(&target).map_err(|refused| failed(path, Operation::Replace)(refused.error))?;
    sync_folder(folder).map_err(failed(path, Operation::SyncFolder))
}

/// Writes straight to a device or pipe, which cannot be replaced.
fn write_device(
    path: &Path,
    fill: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), FileError> {
    let mut device =
        OpenOptions::new().write(true).open(path).map_err(failed(path, Operation::CreateFile))?;
    fill(&mut device).map_err(failed(path, Operation::Write))
}

/// A new hidden file in `folder`, removed when dropped, with the mode of an ordinary new file.
fn temporary_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    let ordinary = <fs::Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666);
    #[cfg(unix)]
    builder.permissions(ordinary);
    let [begin, end] = TEMPORARY;
    builder.prefix(begin).suffix(end).tempfile_in(folder)
}

/// Brings the entries of `folder` to the disk; file systems that cannot do this are accepted.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(e) if !matches!(e.kind(), InvalidInput | PermissionDenied | Unsupported) => Err(e),
        _ => Ok(()),
    }
}

/// Other systems have no fsync for folders.
#[cfg(not(unix))]
fn sync_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

/// Turns the system's error at one step on `path` into a [`FileError`].
fn failed(path: &Path, operation: Operation) -> impl Fn(io::Error) -> FileError + Copy + '_ {
    move |source| FileError {
        path: path.to_owned(),
        operation,
        cause: Cause::from(&source),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::{Cause, FileError, Operation, ensure_writable_dir, replace_with, write_atomic};
    use std::fs;
    use std::io::{self, Write};
    use std::path::Path;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
    }

    fn why(result: Result<(), FileError>) -> (Operation, Cause) {
        let error = result.unwrap_err();
        (error.operation, error.cause)
    }

    #[test]
    fn writes_and_replaces_without_leftovers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.md");
        for content in ["first", "second and longer", ""] {
            write_atomic(&path, content.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), content);
        }
        assert_eq!(names_in(folder.path()), ["report.md"]);
    }

    #[test]
    fn earlier_file_survives_a_disk_that_fills_half_way() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.json");
        write_atomic(&path, b"earlier").unwrap();
        let failure = replace_with(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(
            failure.unwrap_err().to_string(),
            format!("cannot write {}: the disk is full", path.display())
        );
        assert_eq!(fs::read(&path).unwrap(), b"earlier");
        assert_eq!(names_in(folder.path()), ["record.json"]);
    }

    #[test]
    fn things_in_the_way_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write_atomic(&file, b"earlier").unwrap();
        let in_the_way = |operation| (operation, Cause::FileInTheWay);
        assert_eq!(why(write_atomic(&file.join("x"), b"")), in_the_way(Operation::Inspect));
        assert_eq!(why(ensure_writable_dir(&file)), in_the_way(Operation::CreateFolder));
        assert_eq!(why(ensure_writable_dir(&file.join("x"))), in_the_way(Operation::CreateFolder));
        assert_eq!(
            why(write_atomic(folder.path(), b"")),
            (Operation::Inspect, Cause::FolderInTheWay)
        );
        assert_eq!(
            why(write_atomic(&folder.path().join("none/x"), b"")),
            (Operation::CreateFile, Cause::FolderMissing)
        );
        assert!(write_atomic(Path::new(""), b"").is_err());
        assert_eq!(fs::read(&file).unwrap(), b"earlier");
        assert_eq!(names_in(folder.path()), ["file"]);
    }

    #[test]
    fn folder_is_made_and_left_empty() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        ensure_writable_dir(&deep).unwrap();
        ensure_writable_dir(&deep).unwrap();
        assert!(names_in(&deep).is_empty());
    }

    #[test]
    fn writers_at_the_same_time_leave_one_whole_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shared");
        let contents = [vec![b'a'; 100_000], vec![b'b'; 50_000]];
        std::thread::scope(|scope| {
            for content in &contents {
                scope.spawn(|| (0..5).for_each(|_| write_atomic(&path, content).unwrap()));
            }
        });
        assert!(contents.contains(&fs::read(&path).unwrap()));
        assert_eq!(names_in(folder.path()), ["shared"]);
    }

    #[cfg(unix)]
    mod unix {
        use super::*;
        use std::os::unix::fs::{PermissionsExt, symlink};

        fn set_mode(path: &Path, mode: u32) {
            fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
        }

        #[test]
        fn mode_is_kept_and_read_only_is_refused() {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("file");
            write_atomic(&path, b"earlier").unwrap();
            let plain = folder.path().join("plain");
            fs::write(&plain, b"").unwrap();
            let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
            assert_eq!(mode(&path), mode(&plain));
            set_mode(&path, 0o640);
            write_atomic(&path, b"later").unwrap();
            assert_eq!(mode(&path), 0o640);
            set_mode(&path, 0o444);
            assert_eq!(why(write_atomic(&path, b"")), (Operation::Replace, Cause::ReadOnly));
            assert_eq!(fs::read(&path).unwrap(), b"later");
        }

        #[test]
        fn read_only_folder_is_refused() {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("file");
            write_atomic(&path, b"earlier").unwrap();
            set_mode(folder.path(), 0o555);
            // Root may write anywhere: then there is nothing to test.
            if fs::write(folder.path().join("trial"), b"").is_err() {
                let refused = (Operation::CreateFile, Cause::ReadOnly);
                assert_eq!(why(write_atomic(&path, b"later")), refused);
                assert_eq!(why(ensure_writable_dir(folder.path())), refused);
                assert_eq!(fs::read(&path).unwrap(), b"earlier");
            }
            set_mode(folder.path(), 0o755);
        }

        #[test]
        fn symbolic_link_is_followed() {
            let folder = tempfile::tempdir().unwrap();
            let (target, link) = (folder.path().join("target"), folder.path().join("link"));
            write_atomic(&target, b"earlier").unwrap();
            symlink(&target, &link).unwrap();
            write_atomic(&link, b"later").unwrap();
            assert_eq!(fs::read(&target).unwrap(), b"later");
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        }

        #[test]
        fn full_device_is_reported() {
            let full = Path::new("/dev/full");
            if full.exists() {
                assert_eq!(why(write_atomic(full, b"x")), (Operation::Write, Cause::DiskFull));
                write_atomic(Path::new("/dev/null"), b"x").unwrap();
            }
        }
    }
}
