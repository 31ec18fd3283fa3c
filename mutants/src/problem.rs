//! What keeps the tool from going on, in a sentence.

use std::fmt;
use std::path::Path;
use std::process::Command;

#[derive(Debug)]
pub struct Problem(pub String);

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Problem {
    /// Says which file could not be read or written.
    pub fn with(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        move |error| Self(format!("{}: {error}", path.display()))
    }
}

/// What a command that must succeed prints.
pub fn output(command: &mut Command) -> Result<String, Problem> {
    let said = command.output().map_err(|error| Problem(format!("{command:?}: {error}")))?;
    if !said.status.success() {
        let why = String::from_utf8_lossy(&said.stderr);
        return Err(Problem(format!("{command:?} failed, {}:\n{why}", said.status)));
    }
    Ok(String::from_utf8_lossy(&said.stdout).into_owned())
}
