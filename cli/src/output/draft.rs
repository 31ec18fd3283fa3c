//! Drafts: files that are complete on the disk under a name of their own, and take the place of others by renaming.
//!
//! A draft is locked as long as the process that wrote it lives. What is not locked was left behind by one that was
//! killed, and is cleared away by the next that writes in the folder.

use super::{failed, folder_of, reason, settle};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempPath};

/// Drafts, and old files kept until all new ones stand, have names that begin and end so.
const PREFIX: &str = ".minvar-";
const DRAFT: &str = ".part";
const OLD: &str = ".old";

/// How often a draft is begun again that another process cleared away before it was locked.
const MOST_BEGUN: usize = 100;

/// A complete file that waits to take its place.
#[derive(Debug)]
pub(super) struct Draft {
    /// The path that the user gave.
    path: PathBuf,
    /// Where the file is to stand.
    goal: PathBuf,
    size: usize,
    file: NamedTempFile,
}

impl Draft {
    /// Writes the content to the disk, beside its goal, with the permissions and the owner of the file that stands
    /// there.
    pub(super) fn write(path: &Path, goal: PathBuf, content: &[u8]) -> Result<Self, String> {
        let folder = folder_of(&goal);
        let mut file = begin(folder).map_err(|error| {
            format!("the folder {} takes no new file: {}", folder.display(), reason(&error))
        })?;
        // What only the owner may read, nobody else may while it is a draft.
        take_after(file.as_file(), &goal)
            .and_then(|()| file.write_all(content))
            .and_then(|()| file.as_file().sync_all())
            .map_err(|error| reason(&error))?;
        Ok(Self { path: path.to_owned(), goal, size: content.len(), file })
    }
}

/// A new file, readable as any other new file (`tempfile` alone would keep it from others), and locked.
fn begin(folder: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..MOST_BEGUN {
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(DRAFT);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The user's umask takes away from this.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let draft = builder.tempfile_in(folder)?;
        // Where the file system has no locks, nothing is cleared away either.
        let _ = draft.as_file().lock();
        if fs::symlink_metadata(draft.path()).is_ok() {
            return Ok(draft);
        }
        // Another process took it for one that was left behind, before it was locked.
    }
    Err(io::Error::other("others clear it away again and again"))
}

/// Gives a draft the permissions of the file whose place it will take, and its owner and group where the system lets
/// us.
fn take_after(draft: &File, goal: &Path) -> io::Result<()> {
    let old = match fs::metadata(goal) {
        Ok(old) => old,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let new = draft.metadata()?;
        if new.gid() != old.gid() {
            let _ = fchown(draft, None, Some(old.gid()));
        }
        if new.uid() != old.uid() {
            let _ = fchown(draft, Some(old.uid()), None);
        }
    }
    draft.set_permissions(old.permissions())
}

/// Removes what processes left behind that were killed: nobody holds its lock.
pub(super) fn clear_away(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let ours = name.starts_with(PREFIX) && (name.ends_with(DRAFT) || name.ends_with(OLD));
        if ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let path = entry.path();
            let _ = locked(&path).and_then(|lock| fs::remove_file(&path).map(|()| drop(lock)));
        }
    }
}

/// Locks a file that nobody holds.
fn locked(path: &Path) -> io::Result<File> {
    let file = File::options().read(true).write(true).open(path)?;
    file.try_lock().map_err(io::Error::from)?;
    Ok(file)
}

/// An old file under a name of its own, until it is known that all new ones stand.
#[derive(Debug)]
struct Kept {
    path: TempPath,
    /// Held as long as it may be needed.
    _lock: Option<File>,
}

/// Keeps a file by a second name for it. `None` where there is no file, or the file system has no second names.
fn keep(goal: &Path) -> Option<Kept> {
    let folder = folder_of(goal);
    let kept =
        Builder::new().prefix(PREFIX).suffix(OLD).make_in(folder, |path| fs::hard_link(goal, path)).ok()?;
    let path = kept.into_temp_path();
    let lock = locked(&path).ok();
    Some(Kept { path, _lock: lock })
}

/// What stood in a place before a draft took it.
#[derive(Debug)]
enum Before {
    Nothing,
    Kept(Kept),
    /// A file that could not be kept.
    Lost,
}

impl Before {
    fn of(goal: &Path) -> Self {
        match keep(goal) {
            Some(kept) => Self::Kept(kept),
            None if fs::symlink_metadata(goal).is_ok() => Self::Lost,
            None => Self::Nothing,
        }
    }

    /// Puts it there again. Whether that went well.
    fn restore(self, goal: &Path) -> bool {
        match self {
            Self::Nothing => fs::remove_file(goal).is_ok(),
            Self::Kept(kept) => kept.path.persist(goal).is_ok(),
            Self::Lost => false,
        }
    }
}

/// Puts all drafts in their places. If one cannot be, those before it are taken back; an error names those that could
/// not.
pub(super) fn replace_all(drafts: Vec<Draft>) -> Result<(), String> {
    // The last one is never taken back. All is made ready first, so that the files change in one go.
    let last = drafts.len().saturating_sub(1);
    let before: Vec<_> = drafts
        .iter()
        .enumerate()
        .map(|(index, draft)| if index < last { Before::of(&draft.goal) } else { Before::Nothing })
        .collect();
    let mut done: Vec<(PathBuf, PathBuf, Before)> = Vec::new();
    for (Draft { path, goal, size, file }, before) in drafts.into_iter().zip(before) {
        if let Err(error) = file.persist(&goal) {
            let mut message = failed(&path, size, reason(&error.error));
            for (path, goal, before) in done.into_iter().rev() {
                if !before.restore(&goal) {
                    message += &format!("; {} has been replaced already", path.display());
                }
                settle(folder_of(&goal));
            }
            return Err(message);
        }
        done.push((path, goal, before));
    }
    for (_, goal, _) in &done {
        settle(folder_of(goal));
    }
    Ok(())
}
