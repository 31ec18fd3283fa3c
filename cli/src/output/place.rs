//! Where an output goes: what a path leads to, and whether two lead to the same place.

use super::{folder_of, reason};
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

/// Where an output goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// `-`: the standard output.
    Stdout,
    /// A path as the user gave it.
    File(PathBuf),
}

impl Target {
    /// `-` and the standard output's own name are the standard output, all else a path.
    pub(crate) fn new(path: &Path) -> Self {
        if path == "-" || matches!(follow(path), Ok(Followed::Descriptor(1))) {
            Self::Stdout
        } else {
            Self::File(path.to_owned())
        }
    }
}

/// What a path leads to.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// An open descriptor of this process: a file that it is open for is written at its end.
    Descriptor,
    /// A pipe or a device.
    Special,
    /// A file, that is there or not; links are followed.
    File(PathBuf),
}

/// Finds out, and whether a file may be put there; if not, why.
pub(super) fn place_of(path: &Path) -> Result<Place, String> {
    let goal = match follow(path)? {
        Followed::Descriptor(_) => return Ok(Place::Descriptor),
        Followed::Path(goal) => goal,
    };
    match fs::metadata(&goal) {
        Ok(about) if about.is_dir() => return Err("it is a folder".into()),
        Ok(about) if is_disk(&about) => return Err("it is a disk".into()),
        Ok(about) if !about.is_file() => return Ok(Place::Special),
        Ok(about) if about.permissions().readonly() => return Err("it is write-protected".into()),
        // Who may not write into a file may not replace it either. Opened so, it stays as it is.
        Ok(_) => drop(File::options().write(true).open(&goal).map_err(|error| reason(&error))?),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            if goal.file_name().is_none()
                || path.as_os_str().to_string_lossy().ends_with(std::path::is_separator)
            {
                return Err("it names no file".into());
            }
        }
        Err(error) => return Err(reason(&error)),
    }
    let folder = folder_of(&goal);
    if folder.is_dir() {
        Ok(Place::File(goal))
    } else {
        Err(format!("there is no folder {}", folder.display()))
    }
}

#[cfg(unix)]
fn is_disk(about: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    about.file_type().is_block_device()
}

#[cfg(not(unix))]
fn is_disk(_: &fs::Metadata) -> bool {
    false
}

/// The end of a row of links.
#[derive(Debug, PartialEq, Eq)]
enum Followed {
    /// An open descriptor of this process.
    Descriptor(u32),
    /// What is no link: a file, a folder, a device, or nothing.
    Path(PathBuf),
}

/// More links than any system follows.
const MOST_LINKS: usize = 64;

/// Follows links one by one, so that one to a file that is not there yet leads to it too.
fn follow(path: &Path) -> Result<Followed, String> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Some(number) = descriptor(&path) {
            return Ok(Followed::Descriptor(number));
        }
        match fs::read_link(&path) {
            // What a link says is meant from where it stands.
            Ok(to) => path = folder_of(&path).join(to),
            Err(_) => return Ok(Followed::Path(path)),
        }
    }
    Err("too many links lead on from there".into())
}

/// The number of the open descriptor of this process that a path names: `/dev/fd/3`, `/proc/self/fd/3`.
fn descriptor(path: &Path) -> Option<u32> {
    if !cfg!(unix) {
        return None;
    }
    let number = path.file_name()?.to_str()?.parse().ok()?;
    let folder = fs::canonicalize(folder_of(path)).ok()?;
    let own = [format!("/proc/{}/fd", std::process::id()), "/dev/fd".into()];
    own.iter().any(|own| folder == Path::new(own)).then_some(number)
}

/// The file that the standard output runs into, if it is one.
pub(crate) fn standard_output() -> Option<Target> {
    stream("/dev/stdout")
}

/// The file that the standard input comes from, if it is one.
pub(crate) fn standard_input() -> Option<Target> {
    stream("/dev/stdin")
}

fn stream(name: &str) -> Option<Target> {
    let path = fs::canonicalize(name).ok()?;
    path.is_file().then_some(Target::File(path))
}

/// The first two of the named targets that are one file (or both the standard output), however written.
pub(crate) fn same_twice<'a>(targets: &[(&'a str, Target)]) -> Option<(&'a str, &'a str)> {
    let places: Vec<_> = targets.iter().map(|(_, target)| Identity::of(target)).collect();
    (1..places.len()).find_map(|later| {
        let earlier = places[..later].iter().position(|place| place.is(&places[later]))?;
        Some((targets[earlier].0, targets[later].0))
    })
}

/// What two targets share if they are the same place.
#[derive(Debug)]
struct Identity {
    target: Target,
    /// Device and number of a file: it may have several names.
    file: Option<[u64; 2]>,
}

impl Identity {
    fn is(&self, other: &Self) -> bool {
        self.target == other.target || (self.file.is_some() && self.file == other.file)
    }

    fn of(target: &Target) -> Self {
        let Target::File(path) = target else { return Self { target: Target::Stdout, file: None } };
        let path = match follow(path) {
            Ok(Followed::Path(path)) => path,
            _ => path.clone(),
        };
        if let (Ok(path), Ok(about)) = (fs::canonicalize(&path), fs::metadata(&path)) {
            return Self {
                target: Target::File(path),
                file: about.is_file().then(|| number(&about)).flatten(),
            };
        }
        let name = path.file_name().unwrap_or_default();
        let target = match fs::canonicalize(folder_of(&path)) {
            Ok(folder) => folder.join(name),
            Err(_) => path.components().filter(|part| *part != Component::CurDir).collect(),
        };
        Self { target: Target::File(target), file: None }
    }
}

#[cfg(unix)]
fn number(about: &fs::Metadata) -> Option<[u64; 2]> {
    use std::os::unix::fs::MetadataExt;
    Some([about.dev(), about.ino()])
}

#[cfg(not(unix))]
fn number(_: &fs::Metadata) -> Option<[u64; 2]> {
    None
}
