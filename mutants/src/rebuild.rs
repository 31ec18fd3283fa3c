//! The mutants that cannot be woven: array lengths, and what they and public constants need. cargo-mutants itself builds
//! the kernel anew for each, and runs the tests that are quick and near.

use crate::list::Mutant;
use crate::problem::Problem;
use crate::run::{Judged, Outcome, Results};
use crate::tree::Tree;
use serde::Deserialize;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The test programs that are run for these.
const TESTS: [&str; 8] = [
    "accuracy",
    "curve_measure",
    "curve_properties",
    "curve_space",
    "quadrature",
    "solver",
    "toolpath",
    "truth",
];

#[derive(Deserialize)]
struct Outcomes {
    outcomes: Vec<OfOne>,
}

#[derive(Deserialize)]
struct OfOne {
    scenario: Scenario,
    summary: String,
}

#[derive(Deserialize)]
enum Scenario {
    Baseline,
    Mutant { name: String },
}

/// Runs those that are not woven and have no outcome yet.
pub fn run_rest(
    mutants: &[&Mutant],
    tree: &Tree,
    results: &mut Results,
    repository: &Path,
    work: &Path,
) -> Result<(), Problem> {
    let is_left = |mutant: &&&Mutant| {
        let id = mutant.id;
        let known =
            tree.woven.contains_key(&id) || tree.refused.contains(&id) || tree.elsewhere.contains(&id);
        !known && !results.by_mutant.contains_key(&mutant.name)
    };
    let left: Vec<&Mutant> = mutants.iter().filter(is_left).copied().collect();
    if left.is_empty() {
        return Ok(());
    }
    eprintln!("{} mutants by building anew", left.len());
    let mut command = Command::new("cargo");
    command.args(["mutants", "--package", "minvar", "--test-package", "minvar,minvar-tests", "--jobs", "1"]);
    command
        .args(["--no-shuffle", "--colors", "never", "--baseline", "run", "--output"])
        .arg(work.join("rebuilt"));
    for mutant in &left {
        command.arg("--re").arg(format!("^{}$", escaped(&mutant.name)));
    }
    command.args(["--", "--lib"]).current_dir(repository);
    for test in TESTS {
        command.args(["--test", test]);
    }
    command
        .env("CARGO_PROFILE_TEST_DEBUG", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .env_remove("CARGO_TARGET_DIR");
    // It tells by its exit status that something survived.
    command.status().map_err(|error| Problem(format!("cargo mutants: {error}")))?;

    let path = work.join("rebuilt/mutants.out/outcomes.json");
    let text = fs::read(&path).map_err(Problem::with(&path))?;
    let found: Outcomes =
        serde_json::from_slice(&text).map_err(|error| Problem(format!("{}: {error}", path.display())))?;
    for OfOne { scenario, summary } in found.outcomes {
        let Scenario::Mutant { name } = scenario else { continue };
        let outcome = match summary.as_str() {
            "CaughtMutant" => Outcome::Caught,
            "MissedMutant" => Outcome::Survived,
            "Timeout" => Outcome::TimedOut,
            "Unviable" => Outcome::Refused,
            _ => continue,
        };
        results.add(Judged::rebuilt(&tree.kernel, name, outcome))?;
    }
    Ok(())
}

/// A name as a regular expression.
fn escaped(name: &str) -> String {
    name.chars()
        .flat_map(|c| [(!c.is_alphanumeric() && c != ' ').then_some('\\'), Some(c)])
        .flatten()
        .collect()
}
