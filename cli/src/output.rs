//! Writing files whole: a reader finds the old file or the new one, never half of one.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Component, Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// Where an output goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// `-`: the standard output.
    Stdout,
    /// A path as the user gave it.
    File(PathBuf),
}

impl Target {
    /// `-` is the standard output, all else a path.
    pub(crate) fn new(path: &Path) -> Self {
        if path == "-" { Self::Stdout } else { Self::File(path.to_owned()) }
    }
}

/// An output that is complete and waits to be put in its place.
#[derive(Debug)]
pub(crate) struct Prepared(Place);

#[derive(Debug)]
enum Place {
    Stdout(Vec<u8>),
    /// A pipe or a device: nothing can be put in its place.
    Special(PathBuf, Vec<u8>),
    File(PathBuf, PathBuf, NamedTempFile),
}

/// Writes the content next to where it will stand. Files exist under their own name only after [`Prepared::commit`].
pub(crate) fn prepare(target: &Target, content: Vec<u8>) -> Result<Prepared, String> {
    let Target::File(path) = target else {
        return Ok(Prepared(Place::Stdout(content)));
    };
    let failed = |error: &dyn Display| format!("cannot write {}: {error}", path.display());
    // A link stays a link: what it points to is replaced.
    let goal = fs::canonicalize(path).unwrap_or_else(|_| path.clone());
    let mut mode = None;
    match fs::metadata(&goal) {
        Ok(about) if about.is_dir() => return Err(failed(&"it is a folder")),
        Ok(about) if !about.is_file() => return Ok(Prepared(Place::Special(path.clone(), content))),
        Ok(about) if about.permissions().readonly() => return Err(failed(&"it is write-protected")),
        Ok(about) => mode = Some(about.permissions()),
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(failed(&reason(&error))),
    }
    if goal.file_name().is_none() {
        return Err(failed(&"it names no file"));
    }
    let folder = match goal.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(failed(&format!("there is no folder {}", folder.display())));
    }
    let mut file = temporary(folder).map_err(|error| failed(&reason(&error)))?;
    file.write_all(&content)
        .and_then(|()| mode.map_or(Ok(()), |mode| fs::set_permissions(file.path(), mode)))
        .and_then(|()| file.as_file().sync_all())
        .map_err(|error| failed(&reason(&error)))?;
    Ok(Prepared(Place::File(path.clone(), goal, file)))
}

impl Prepared {
    /// Puts the output in its place.
    pub(crate) fn commit(self) -> Result<(), String> {
        let failed =
            |path: &Path, error: &io::Error| format!("cannot write {}: {}", path.display(), reason(error));
        match self.0 {
            Place::Stdout(content) => print(&content),
            Place::Special(path, content) => File::options()
                .write(true)
                .open(&path)
                .and_then(|mut file| file.write_all(&content))
                .or_else(no_reader)
                .map_err(|error| failed(&path, &error)),
            Place::File(path, goal, file) => {
                file.persist(goal).map(drop).map_err(|error| failed(&path, &error.error))
            }
        }
    }
}

/// Writes to the standard output. That nobody reads on is not an error.
pub(crate) fn print(content: &[u8]) -> Result<(), String> {
    let mut stdout = io::stdout().lock();
    stdout
        .write_all(content)
        .and_then(|()| stdout.flush())
        .or_else(no_reader)
        .map_err(|error| format!("cannot write to the standard output: {}", reason(&error)))
}

fn no_reader(error: io::Error) -> io::Result<()> {
    if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) }
}

/// The first two of the named paths that are one file (or both the standard output), however written.
pub(crate) fn same_twice<'a>(targets: &[(&'a str, Target)]) -> Option<(&'a str, &'a str)> {
    let places: Vec<_> = targets.iter().map(|(_, target)| identity(target)).collect();
    (1..places.len()).find_map(|later| {
        let earlier = places[..later].iter().position(|place| *place == places[later])?;
        Some((targets[earlier].0, targets[later].0))
    })
}

/// What two targets share exactly if they are the same place.
fn identity(target: &Target) -> Target {
    let Target::File(path) = target else { return Target::Stdout };
    if let Ok(path) = fs::canonicalize(path) {
        return Target::File(path);
    }
    let name = path.file_name().unwrap_or_default();
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    match fs::canonicalize(folder) {
        Ok(folder) => Target::File(folder.join(name)),
        Err(_) => Target::File(path.components().filter(|part| *part != Component::CurDir).collect()),
    }
}

/// A new file in the folder, readable as any other new file: `tempfile` alone would keep it from others.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".minvar-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The user's umask takes away from this.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// The system's reason, without the error's number.
pub(crate) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, content: &str) -> Result<(), String> {
        prepare(&Target::new(path), content.as_bytes().to_vec())?.commit()
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_only_on_commit_and_leaves_nothing_behind() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.svg");
        write(&path, "old").expect("the first write");
        let prepared = prepare(&Target::new(&path), b"new".to_vec()).expect("prepared");
        assert_eq!(fs::read_to_string(&path).expect("old file"), "old");
        prepared.commit().expect("committed");
        assert_eq!(fs::read_to_string(&path).expect("new file"), "new");
        drop(prepare(&Target::new(&path), b"never".to_vec()).expect("prepared"));
        assert_eq!(fs::read_to_string(&path).expect("new file"), "new");
        assert_eq!(names(folder.path()), ["a.svg"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_new_file_and_an_old_file_keeps_its_own() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let mode =
            |name: &str| fs::metadata(folder.path().join(name)).expect("a file").permissions().mode() & 0o777;
        fs::write(folder.path().join("plain"), "").expect("a plain file");
        write(&folder.path().join("ours"), "x").expect("our file");
        assert_eq!(mode("ours"), mode("plain"));
        fs::set_permissions(folder.path().join("ours"), fs::Permissions::from_mode(0o640)).expect("chmod");
        write(&folder.path().join("ours"), "y").expect("our file again");
        assert_eq!(mode("ours"), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_file_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").expect("a file");
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        write(&link, "new").expect("written through the link");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
        assert_eq!(fs::read_to_string(&file).expect("the file"), "new");
        write(Path::new("/dev/null"), "gone").expect("a device");
    }

    #[test]
    fn what_cannot_be_written_is_named_with_the_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("no").join("a.svg");
        let error = write(&missing, "x").expect_err("no such folder");
        assert!(error.contains(&missing.display().to_string()) && error.contains("no folder"), "{error}");
        let error = write(folder.path(), "x").expect_err("a folder");
        assert!(error.ends_with("it is a folder"), "{error}");
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn one_place_under_two_names_is_seen() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = |name: &str| Target::new(&folder.path().join(name));
        fs::write(folder.path().join("c"), "").expect("a file");
        assert_eq!(same_twice(&[("--svg", target("a")), ("--nc", target("b"))]), None);
        assert_eq!(same_twice(&[("--svg", target("a")), ("--nc", target("./a"))]), Some(("--svg", "--nc")));
        assert_eq!(same_twice(&[("--svg", target("c")), ("--nc", target("./c"))]), Some(("--svg", "--nc")));
        let stdout = || Target::new(Path::new("-"));
        assert_eq!(
            same_twice(&[("--svg", stdout()), ("--nc", target("b")), ("--csv", stdout())]),
            Some(("--svg", "--csv"))
        );
    }
}
