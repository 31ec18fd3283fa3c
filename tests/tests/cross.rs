//! The corpus of `tests/cross` on this machine, and that it holds what it is for. `make cross` runs it on the others.

use minvar_tests::cross::data;
use minvar_tests::cross::lines::{Line, differing, lines};
use minvar_tests::toolchain::{compile, library, must, root, scratch};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

fn committed() -> Vec<Line> {
    lines(&fs::read_to_string(root().join("tests/cross/hashes.txt")).expect("tests/cross/hashes.txt"))
}

/// The corpus with its long cases, as the host's compiler makes it.
fn corpus() -> PathBuf {
    let folder = root().join("tests/cross");
    let program = scratch().join("corpus");
    let mut sources: Vec<_> = fs::read_dir(folder.join("corpus"))
        .expect("tests/cross/corpus")
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "c"))
        .collect();
    sources.extend([folder.join("main.c"), folder.join("platform/hosted.c")]);
    let mut command = compile("corpus.c");
    command.args(["-ffp-contract=off", "-DWITH_LONG=1", "-I"]).arg(&folder);
    command.args(sources).arg(library().join("libminvar.a")).arg("-o").arg(&program);
    must(&mut command, "compiling the corpus");
    program
}

#[test]
fn the_corpus_has_the_curves_of_the_data_folder() {
    let committed = fs::read_to_string(root().join("tests/cross/corpus/curves.inc")).expect("curves.inc");
    assert!(committed == data::as_c(), "tests/data/curves has changed: run `make cross-curves cross-hashes`");
}

#[test]
fn this_machine_gives_the_committed_bits() {
    let found = lines(&must(&mut Command::new(corpus()), "the corpus"));
    let differing = differing(&committed(), &found);
    assert!(
        differing.is_empty(),
        "{} of {} lines differ. If results were meant to change: `make cross-hashes`, then `make cross`.\n{}",
        differing.len(),
        found.len(),
        differing.join("\n")
    );
}

/// The names of an enum's constants in minvar.h, with their numbers.
fn constants(of: &str) -> Vec<(String, u64)> {
    let header = fs::read_to_string(root().join("include/minvar.h")).expect("minvar.h");
    let (_, body) = header.split_once(&format!("typedef enum {of} {{")).expect("the enum is declared");
    let (body, _) = body.split_once('}').expect("an enum ends");
    let constant = |line: &str| {
        let (name, number) = line.trim().trim_end_matches(',').split_once(" = ")?;
        Some((name.strip_prefix("MINVAR_")?.to_owned(), number.parse().ok()?))
    };
    let mut all: Vec<_> = body.lines().filter_map(constant).collect();
    // What gives the enum its width.
    assert!(all.pop().is_some_and(|(_, number)| number == 0x7fff_ffff), "{of} ends with its width");
    all
}

#[test]
fn the_corpus_ends_in_every_status_and_every_error() {
    let all = committed();
    // What runs on every push has them already.
    let outcomes: BTreeSet<&str> =
        all.iter().filter(|line| !line.name.starts_with("long/")).map(|line| line.outcome.as_str()).collect();
    let statuses = constants("minvar_status");
    assert!(statuses.len() == 6, "{statuses:?}");
    for (name, _) in statuses.iter().filter(|(name, _)| name != "UNSOLVED") {
        let word = name.to_lowercase().replace('_', "-");
        assert!(outcomes.contains(word.as_str()), "no case ends {word}");
    }
    let codes = constants("minvar_code");
    assert!(codes.len() > 30, "{codes:?}");
    // The width of a pointer decides what is too long and what is misaligned.
    for (name, number) in codes.iter().filter(|(_, number)| *number > 3) {
        assert!(outcomes.contains(format!("error-{number}").as_str()), "no case ends with MINVAR_{name}");
    }
    assert!(!outcomes.contains("does-not-fit"), "a case has outgrown the memory of the corpus");
}

#[test]
fn no_two_lines_have_the_same_name() {
    let all = committed();
    let names: BTreeSet<&str> = all.iter().map(|line| line.name.as_str()).collect();
    assert!(all.len() > 1000 && names.len() == all.len(), "{} names of {} lines", names.len(), all.len());
}

#[test]
fn a_changed_hash_an_added_and_a_missing_line_are_named() {
    let line = |name: &str, hash: &str| Line { name: name.into(), hash: hash.into(), outcome: "ok".into() };
    let expected = [line("a", "01"), line("b", "02"), line("c", "03")];
    let found = [line("a", "01"), line("b", "12"), line("d", "04")];
    assert_eq!(differing(&expected, &found), ["b", "c", "d"]);
    assert_eq!(differing(&expected, &expected), [""; 0]);
}
