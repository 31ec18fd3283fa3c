//! The C and C++ interface, used as C and C++ programs use it: compiled with the system's compilers against the headers
//! of this repository, linked with the static and with the shared library, and run.
//!
//! The programs are in `tests/c/`; each prints what it found wrong and exits with 1. `CC` and `CXX` choose other
//! compilers than `cc` and `c++`.

use minvar_tests::interface::{declared, header, symbols};
use minvar_tests::toolchain::{WARNINGS, compile, compiler, library, must, root, scratch};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn source(name: &str) -> PathBuf {
    root().join("tests/c").join(name)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Link {
    Static,
    Shared,
}

/// Builds a program from sources of `tests/c/`.
fn build(sources: &[&str], link: Link, flags: &[&str]) -> PathBuf {
    let name = sources[0].replace('.', "_");
    let flavour: String = flags.concat().chars().filter(char::is_ascii_alphanumeric).collect();
    let program = scratch().join(format!("{name}_{link:?}{flavour}"));
    let mut command = compile(sources[0]);
    command.args(flags).args(sources.iter().map(|name| source(name))).arg("-o").arg(&program);
    match link {
        // Nothing else is needed, no -lm -lpthread -ldl: those are the test programs' own.
        Link::Static => command.arg(library().join("libminvar.a")),
        Link::Shared => command
            .arg("-L")
            .arg(library())
            .arg("-lminvar")
            .arg(format!("-Wl,-rpath,{}", scratch().display())),
    };
    if sources[0] != "coving.c" {
        command.args(["-lm", "-pthread"]);
    }
    must(&mut command, "compiling a test program");
    program
}

/// Runs a test program; what it prints is shown where it fails.
fn passes(program: &Path) -> String {
    must(&mut Command::new(program), "a test program")
}

/// Builds and runs with either library.
fn passes_with_both(sources: &[&str], flags: &[&str]) {
    for link in [Link::Static, Link::Shared] {
        passes(&build(sources, link, flags));
    }
}

/// The compilers whose opinion counts: the system's, and clang where it is installed.
fn compilers(usual: &str, clang: &str) -> Vec<String> {
    let mut all = vec![usual.to_owned()];
    if Command::new(clang).arg("--version").output().is_ok_and(|output| output.status.success()) {
        all.push(clang.into());
    }
    all
}

#[test]
fn the_c_header_compiles_alone_in_every_language() {
    let c = compilers(&compiler("CC", "cc"), "clang");
    let cpp = compilers(&compiler("CXX", "c++"), "clang++");
    let languages = [(&c, "c", "c11"), (&c, "c", "c17"), (&cpp, "c++", "c++17"), (&cpp, "c++", "c++20")];
    for (compilers, language, standard) in languages {
        for compiler in compilers {
            let mut command = Command::new(compiler);
            command.args(["-x", language, &format!("-std={standard}"), "-fsyntax-only"]).args(WARNINGS);
            command.arg("-I").arg(root().join("include")).arg(source("header.c"));
            must(&mut command, "compiling minvar.h");
        }
    }
    passes_with_both(&["header.c"], &[]);
}

#[test]
fn the_cpp_header_compiles_without_a_warning() {
    for compiler in compilers(&compiler("CXX", "c++"), "clang++") {
        for standard in ["c++17", "c++20"] {
            // Optimised too: only then does a compiler see what may be uninitialised.
            for level in ["-O0", "-O2"] {
                let mut command = Command::new(&compiler);
                command
                    .arg(format!("-std={standard}"))
                    .arg(level)
                    .args(WARNINGS)
                    .args(["-Wsign-conversion", "-c"]);
                command.arg("-I").arg(root().join("include")).arg(source("wrapper_twice.cpp"));
                command.args(["-o", "/dev/null"]);
                must(&mut command, "compiling minvar.hpp");
            }
        }
    }
}

#[test]
fn structs_are_laid_out_in_c_as_in_rust() {
    let printed = passes(&build(&["layout.c"], Link::Static, &[]));
    let rust = fs::read_to_string(root().join("ffi/src/layout.rs")).expect("ffi/src/layout.rs");
    let figures: Vec<&str> = rust.lines().map(str::trim).filter(|line| line.starts_with("minvar_")).collect();
    assert!(figures.len() > 10, "no figures in ffi/src/layout.rs");
    assert_eq!(printed.lines().collect::<Vec<_>>(), figures);
    let declared = |line: &str| line.strip_prefix("typedef struct ")?.strip_suffix(" {").map(str::to_owned);
    let in_header: BTreeSet<String> = header().lines().filter_map(declared).collect();
    let checked: BTreeSet<String> =
        figures.iter().filter_map(|line| line.split(' ').next().map(str::to_owned)).collect();
    assert_eq!(checked, in_header, "the structs of minvar.h and those of ffi/src/layout.rs");
}

/// Arm's convention for programs without an operating system: an enum is as short as its numbers allow.
#[test]
fn structs_have_the_same_layout_where_enums_are_short() {
    let layout = |flags| passes(&build(&["layout.c"], Link::Static, flags));
    assert_eq!(layout(&["-fshort-enums"]), layout(&[]));
}

#[test]
fn a_c_program_computes_the_coving() {
    passes_with_both(&["coving.c"], &[]);
}

#[test]
fn a_c_program_edits_a_region_and_leaves_the_rest() {
    passes_with_both(&["region.c"], &[]);
}

#[test]
fn every_wrong_argument_is_refused_and_changes_nothing() {
    passes_with_both(&["bad_input.c"], &[]);
}

#[test]
fn callbacks_stop_the_work_and_dirty_memory_changes_nothing() {
    passes_with_both(&["callbacks.c"], &[]);
}

#[test]
fn after_a_fault_outputs_are_untouched_or_whole() {
    passes_with_both(&["faults.c"], &[]);
}

#[test]
fn threads_that_solve_at_once_get_the_same_bits() {
    passes_with_both(&["threads.c"], &[]);
}

#[test]
fn the_cpp_wrapper_does_what_the_c_interface_does() {
    let sources = ["wrapper.cpp", "wrapper_twice.cpp"];
    passes_with_both(&sources, &[]);
    passes(&build(&sources, Link::Static, &["-std=c++20"]));
}

#[test]
fn the_cpp_wrapper_refuses_a_library_of_another_interface() {
    passes_with_both(&["wrapper_stranger.cpp"], &[]);
}

#[test]
fn every_enum_that_a_comment_names_is_declared() {
    let header = header();
    let names: BTreeSet<&str> = header
        .split("One of enum ")
        .skip(1)
        .filter_map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next())
        .collect();
    assert!(names.len() > 5, "{names:?}");
    for name in names {
        assert!(header.contains(&format!("typedef enum {name} {{")), "{name} is not in minvar.h");
    }
}

/// What the library takes from outside: memory blocks copied, and `abort`, which nothing calls.
const FROM_OUTSIDE: [&str; 6] = ["abort", "bcmp", "memcmp", "memcpy", "memmove", "memset"];

fn foreign(needed: &BTreeSet<String>) -> Vec<String> {
    needed.iter().filter(|name| !FROM_OUTSIDE.contains(&name.as_str())).cloned().collect()
}

#[test]
fn the_shared_library_exports_the_header_and_nothing_else() {
    let shared = library().join("libminvar.so");
    assert!(declared().len() > 20, "no functions found in minvar.h: {:?}", declared());
    assert_eq!(symbols(&shared, &["--dynamic", "--defined-only"]), declared());
    let needed = symbols(&shared, &["--dynamic", "--undefined-only"]);
    assert_eq!(foreign(&needed), [""; 0], "libminvar.so needs more than memory blocks");
    let dynamic = must(Command::new("readelf").arg("--dynamic").arg(&shared), "readelf (Debian: binutils)");
    assert!(dynamic.contains("Library soname: [libminvar.so.0]"), "{dynamic}");
}

#[test]
fn the_static_library_needs_no_heap_and_no_printing() {
    let archive = library().join("libminvar.a");
    let own = symbols(&archive, &["--defined-only", "--extern-only"]);
    let missing: Vec<_> = declared().difference(&own).cloned().collect();
    assert_eq!(missing, [""; 0], "declared in minvar.h, not in libminvar.a");

    // What a program that calls every function takes from the archive, without the C library's part.
    let taken = scratch().join("everything.o");
    let mut command = Command::new(compiler("CC", "cc"));
    command.args(["-r", "-nostdlib", "-o"]).arg(&taken);
    command.args(declared().iter().map(|name| format!("-Wl,--undefined={name}"))).arg(&archive);
    must(&mut command, "linking the whole interface");
    assert!(declared().is_subset(&symbols(&taken, &["--defined-only"])), "not everything was linked");
    let needed = symbols(&taken, &["--undefined-only"]);
    assert_eq!(foreign(&needed), [""; 0], "libminvar.a needs more than memory blocks");
}
