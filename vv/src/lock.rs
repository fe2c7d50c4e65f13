//! One run at a time writes in a folder.

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::files::{FileError, ensure_writable_dir, sweep};

/// Folders in that of a run or report which programs write in too.
const BELOW: [&str; 5] = ["vtu", "pictures", "records", "hard", "figures"];

/// Why a folder cannot be written in.
#[derive(Debug, thiserror::Error)]
pub enum LockError {
    /// It cannot be made or written in.
    #[error(transparent)]
    File(#[from] FileError),
    /// Another program has it.
    #[error(
        "another whipple writes in {} at this moment: wait until it has ended, or name another folder with \
         --out",
        .0.display()
    )]
    Taken(PathBuf),
}

/// A folder in which no other program that asks writes as long as this stands; the system lets it go when a
/// program ends, however it does. File systems that cannot lock, and systems that cannot open folders, let
/// everybody in.
#[derive(Debug)]
#[must_use = "the folder is free again when this is dropped"]
pub struct FolderLock {
    _folder: Option<File>,
}

impl FolderLock {
    /// Takes a folder, which is made if it is missing, and removes what a program that was killed within a
    /// write has left there.
    ///
    /// # Errors
    /// [`LockError`] if it cannot be written in, or another program has it.
    pub fn take(folder: &Path) -> Result<Self, LockError> {
        ensure_writable_dir(folder)?;
        let open = if cfg!(unix) { File::open(folder).ok() } else { None };
        if matches!(open.as_ref().map(File::try_lock), Some(Err(std::fs::TryLockError::WouldBlock)))
        {
            return Err(LockError::Taken(folder.to_owned()));
        }
        sweep(folder)?;
        for below in BELOW.map(|name| folder.join(name)).iter().filter(|below| below.is_dir()) {
            sweep(below)?;
        }
        Ok(Self { _folder: open })
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_folder_has_one_writer() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("out");
        let first = FolderLock::take(&out).expect("nobody has it");
        let refused = FolderLock::take(&out).expect_err("it is taken");
        assert!(refused.to_string().contains("wait until it has ended"), "{refused}");
        drop(first);
        let _second = FolderLock::take(&out).expect("it is free again");
    }

    #[test]
    fn what_is_left_of_a_write_goes_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path();
        fs::create_dir(out.join("vtu")).expect("a folder");
        let left = [".whipple-a1b2c3.tmp", "vtu/.whipple-a1b2c3.tmp"].map(|name| out.join(name));
        let kept = [".whipple.tmp", "whipple-a1.tmp", ".whipple-notes", "other/.whipple-a1.tmp"];
        let kept = kept.map(|name| out.join(name));
        fs::create_dir(out.join("other")).expect("a folder");
        left.iter().chain(&kept).for_each(|path| fs::write(path, b"x").expect("a file"));
        let _lock = FolderLock::take(out).expect("nobody has it");
        assert!(left.iter().all(|path| !path.exists()) && kept.iter().all(|path| path.exists()));
    }
}
