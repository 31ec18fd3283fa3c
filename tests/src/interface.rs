//! The C interface as its header declares it, and the symbols of what was built.

use crate::toolchain::{root, run};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::process::Command;

/// The text of `include/minvar.h`.
///
/// # Panics
///
/// If it cannot be read.
pub fn header() -> String {
    fs::read_to_string(root().join("include/minvar.h")).expect("include/minvar.h")
}

/// The functions that the header declares.
pub fn declared() -> BTreeSet<String> {
    let name = |line: &str| {
        let (before, _) = line.split_once('(')?;
        let name = before.rsplit([' ', '*']).next()?;
        (!line.starts_with([' ', '/', '#']) && !line.starts_with("typedef") && name.starts_with("minvar_"))
            .then(|| name.to_owned())
    };
    header().lines().filter_map(name).collect()
}

/// The symbols that `nm` lists, by name, versions cut off; of an archive those of all its members.
///
/// # Panics
///
/// If `nm` is missing or fails.
pub fn symbols(file: impl AsRef<OsStr>, flags: &[&str]) -> BTreeSet<String> {
    let printed =
        run(Command::new("nm").args(flags).arg("--format=posix").arg(file), "nm (Debian: binutils)");
    assert!(printed.status.success(), "nm failed: {}", String::from_utf8_lossy(&printed.stderr));
    let name = |line: &str| Some(line.split_once(' ')?.0.split('@').next()?.to_owned());
    // Weak ones (the C library's start-up hooks) bind to nothing if nobody has them.
    let strong = |line: &&str| line.split(' ').nth(1) != Some("w");
    String::from_utf8_lossy(&printed.stdout).lines().filter(strong).filter_map(name).collect()
}
