//! The mutants, as cargo-mutants lists them.

use crate::problem::{Problem, output};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;

/// What is changed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Genre {
    BinaryOperator,
    UnaryOperator,
    /// A function's body becomes a value.
    FnValue,
    MatchArm,
    MatchArmGuard,
    /// A field is left to the base of the struct.
    StructField,
}

/// A place in a file: line and column from 1, the column in characters.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Span {
    pub start: Place,
    pub end: Place,
}

/// One change.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Mutant {
    /// From 1; 0 is the kernel as it is.
    #[serde(skip)]
    pub id: u32,
    /// Unlike any other's: file, place, change.
    pub name: String,
    pub file: String,
    pub genre: Genre,
    pub replacement: String,
    pub span: Span,
}

impl Mutant {
    /// The kernel's folder that it is in.
    pub fn layer(&self) -> &str {
        let mut parts = self.file.split('/').skip_while(|part| *part != "src").skip(1);
        match (parts.next(), parts.next()) {
            (Some(layer), Some(_)) => layer,
            _ => "root",
        }
    }
}

/// All mutants of a package, in the order of the files.
pub fn list(repository: &Path, package: &str) -> Result<Vec<Mutant>, Problem> {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--list", "--json", "--package", package]).current_dir(repository);
    let text = output(&mut command)?;
    let mut mutants: Vec<Mutant> = serde_json::from_str(&text)
        .map_err(|error| Problem(format!("cargo mutants --list --json: {error}")))?;
    mutants.sort_by(|a, b| (&a.file, a.span.start, &a.name).cmp(&(&b.file, b.span.start, &b.name)));
    for (id, mutant) in (1..).zip(&mut mutants) {
        mutant.id = id;
    }
    Ok(mutants)
}
