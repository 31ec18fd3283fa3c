//! Writing all outputs of a call or none: a reader finds an old file or a new one, never part of one, whatever happens.
//!
//! Every file is first written whole as a [`draft`] beside where it will stand. Only when all drafts are on the disk do
//! pipes, devices and the standard output get what is theirs, and only when these have taken it do the drafts take
//! their places, by renaming. If one cannot, those before it are taken back. So an error leaves every file as it was;
//! what a pipe or a device has taken cannot be taken back. A call that is killed may leave some files new and others
//! old, each of them whole, and drafts, which the next call in the folder clears away.

mod draft;
mod place;

pub(crate) use place::{Target, same_twice, standard_input, standard_output};

use draft::Draft;
use place::{Place, place_of};
use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The outputs of a call: complete, and waiting to be handed over.
#[derive(Debug, Default)]
pub(crate) struct Outputs {
    ways: Vec<Way>,
    /// The folders that were looked through for what others left behind.
    cleared: Vec<PathBuf>,
}

#[derive(Debug)]
enum Way {
    /// To the standard output.
    Print(Vec<u8>),
    /// Into a pipe, a device or a descriptor: nothing can be put in its place.
    Pour { path: PathBuf, at_end: bool, content: Vec<u8> },
    /// In the place of a file.
    Replace(Draft),
}

impl Outputs {
    /// Makes an output ready. All that can fail for a file is done: after this only its name is missing.
    pub(crate) fn add(&mut self, target: &Target, content: Vec<u8>) -> Result<(), String> {
        let Target::File(path) = target else {
            self.ways.push(Way::Print(content));
            return Ok(());
        };
        let place = place_of(path).map_err(|reason| format!("cannot write {}: {reason}", path.display()))?;
        let way = match place {
            Place::Descriptor => Way::Pour { path: path.clone(), at_end: true, content },
            Place::Special => Way::Pour { path: path.clone(), at_end: false, content },
            Place::File(goal) => {
                self.clear(folder_of(&goal));
                let draft = Draft::write(path, goal, &content);
                Way::Replace(draft.map_err(|reason| failed(path, content.len(), reason))?)
            }
        };
        self.ways.push(way);
        Ok(())
    }

    /// Clears a folder once, before drafts of this call are in it.
    fn clear(&mut self, folder: &Path) {
        let Ok(folder) = folder.canonicalize() else { return };
        if !self.cleared.contains(&folder) {
            draft::clear_away(&folder);
            self.cleared.push(folder);
        }
    }

    /// Adds text for the standard output.
    pub(crate) fn print(&mut self, text: String) {
        self.ways.push(Way::Print(text.into_bytes()));
    }

    /// Hands all outputs over. After an error the files are as they were.
    pub(crate) fn commit(self) -> Result<(), String> {
        let mut drafts = Vec::new();
        for way in self.ways {
            match way {
                Way::Print(content) => print(&content)?,
                Way::Pour { path, at_end, content } => File::options()
                    .write(true)
                    .append(at_end)
                    .open(&path)
                    .and_then(|mut file| file.write_all(&content))
                    .or_else(no_reader)
                    .map_err(|error| failed(&path, content.len(), reason(&error)))?,
                Way::Replace(draft) => drafts.push(draft),
            }
        }
        draft::replace_all(drafts)
    }
}

/// What could not be written, how much of it there is, and why.
fn failed(path: &Path, size: usize, reason: impl std::fmt::Display) -> String {
    format!("cannot write {} ({size} bytes): {reason}", path.display())
}

/// Writes to the standard output. That nobody reads on is not an error.
fn print(content: &[u8]) -> Result<(), String> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(content).and_then(|()| stdout.flush()).or_else(no_reader).map_err(|error| {
        format!("cannot write {} bytes to the standard output: {}", content.len(), reason(&error))
    })
}

fn no_reader(error: io::Error) -> io::Result<()> {
    if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) }
}

/// The system's reason, without the error's number.
pub(crate) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}

/// Brings the names in a folder to the disk. Not every file system can: the files themselves are there already.
fn settle(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// The folder in which a file stands.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests;
