//! The C library and the system's compilers, for tests that build programs.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::{env, fs};

/// Every warning is an error in tests.
pub const WARNINGS: [&str; 6] = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"];

/// The repository.
///
/// # Panics
///
/// Never: the package is in the workspace.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in the workspace")
}

/// The directory that cargo builds in: a test program is in its `debug/deps`.
fn target() -> PathBuf {
    let program = env::current_exe().expect("a running program has a place");
    program.ancestors().nth(3).expect("cargo builds tests below its target directory").to_owned()
}

/// Where this file builds, apart from what else cargo does.
pub fn scratch() -> PathBuf {
    let place = target().join("tmp").join("c_programs");
    fs::create_dir_all(&place).expect("the target directory can be written");
    place
}

/// Runs a command that must be there; how it ends is the caller's to judge.
pub fn run(command: &mut Command, what: &str) -> Output {
    command.output().unwrap_or_else(|error| {
        panic!("{what} is needed for this test but cannot be run ({error}): {command:?}")
    })
}

/// Runs a command that must succeed and returns what it printed.
pub fn must(command: &mut Command, what: &str) -> String {
    let output = run(command, what);
    let text =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{what} failed, {}: {command:?}\n{text}", output.status);
    text
}

/// The directory with `libminvar.a` and `libminvar.so`, built once, under the name by which it is loaded too.
pub fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let target = target();
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--package", "minvar-ffi", "--release", "--target-dir"]).arg(&target);
        // A test writes no source: a header that has drifted fails here.
        cargo.env("MINVAR_HEADER", "check").current_dir(root());
        must(&mut cargo, "building libminvar");
        let library = target.join("release");
        for name in ["libminvar.a", "libminvar.so"] {
            assert!(library.join(name).is_file(), "cargo built no {name} in {}", library.display());
        }
        let loaded = scratch().join("libminvar.so.0");
        let _ = fs::remove_file(&loaded);
        fs::copy(library.join("libminvar.so"), loaded).expect("the target directory can be written");
        library
    })
}

/// A compiler by its variable or its usual name.
pub fn compiler(variable: &str, usual: &str) -> String {
    let name = env::var(variable).unwrap_or_else(|_| usual.into());
    let there = Command::new(&name).arg("--version").output().is_ok_and(|output| output.status.success());
    assert!(there, "no compiler `{name}`: install one (Debian: gcc and g++), or name yours by {variable}");
    name
}

/// A compiler's command with the flags of every test: warnings are errors, the headers are this repository's.
pub fn compile(source: &str) -> Command {
    let (name, standard) = if source.ends_with(".cpp") {
        (compiler("CXX", "c++"), "-std=c++17")
    } else {
        (compiler("CC", "cc"), "-std=c11")
    };
    let mut command = Command::new(name);
    command.arg(standard).args(WARNINGS).args(["-O1", "-g"]);
    command.arg("-I").arg(root().join("include"));
    command.arg("-D_POSIX_C_SOURCE=200809L");
    command.arg(concat!("-DMINVAR_VERSION_EXPECTED=\"", env!("CARGO_PKG_VERSION"), "\""));
    command
}
