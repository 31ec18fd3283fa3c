//! Which changes of the kernel the tests notice.
//!
//! cargo-mutants lists thousands of small changes of the kernel (an operator, a function's value, a match arm). Building
//! the tests for each would take days; here all changes are woven into one copy of the kernel, of which one at a time is
//! active. What no test notices is a line that could be wrong.
//!
//! Results are kept in target/mutants/results.jsonl, so that a run can be stopped and goes on where it was. They hold for
//! one kernel; with new tests only what survived is run again, under the tests that changed. What survived was judged by
//! hand: mutants/judged.md.

mod constant;
mod edit;
mod judged;
mod list;
mod problem;
mod rebuild;
mod run;
mod table;
mod tests;
mod tree;
mod weave;

use clap::Parser;
use judged::{Judged, Labels};
use list::Mutant;
use problem::Problem;
use rand::{SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;
use run::{Results, Way};
use std::path::Path;
use std::process::ExitCode;
use tests::Tests;
use tree::Tree;

/// Which changes of the kernel the tests notice.
#[derive(Parser)]
struct Arguments {
    /// Run so many mutants, drawn at random; all without it.
    #[arg(long)]
    sample: Option<usize>,
    /// Another seed draws others.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Test programs at a time.
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Only mutants whose name (file, place, change) contains this.
    #[arg(long, default_value = "")]
    of: String,
    /// Only tests that take so many seconds at most; what survives them waits for a run without this.
    #[arg(long)]
    quick: Option<f64>,
    /// Run also those that must be built anew, a minute or more each.
    #[arg(long)]
    rebuild: bool,
    /// Run none: print what is known.
    #[arg(long)]
    table: bool,
}

fn main() -> ExitCode {
    match work_off(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

fn work_off(arguments: &Arguments) -> Result<(), Problem> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a folder of the repository");
    let work = repository.join("target/mutants");
    let mutants = list::list(repository, "minvar")?;
    eprintln!("{} mutants; weaving them in", mutants.len());
    let tree = Tree::grow(repository, &work, &mutants)?;
    let mut results = Results::read(work.join("results.jsonl"), &tree.kernel);
    if !arguments.table {
        let tests = Tests::prepare(&tree, &work)?;
        let seconds: f64 = tests.tests.iter().map(tests::Test::cost).sum();
        eprintln!("{} tests, {seconds:.0} s of the processor in all", tests.tests.len());
        let mut drawn: Vec<&Mutant> =
            mutants.iter().filter(|mutant| mutant.name.contains(&arguments.of)).collect();
        drawn.retain(|mutant| !tree.refused.contains(&mutant.id) && !tree.elsewhere.contains(&mutant.id));
        drawn.shuffle(&mut ChaCha8Rng::seed_from_u64(arguments.seed));
        drawn.truncate(arguments.sample.unwrap_or(usize::MAX));
        let way = Way { jobs: arguments.jobs, quick: arguments.quick, work: &work };
        run::run_all(&drawn, &tree, &tests, &mut results, &way)?;
        if arguments.rebuild {
            rebuild::run_rest(&drawn, &tree, &mut results, repository, &work)?;
        }
    }
    let labels = Labels::read(repository, &mutants)?;
    let judged = Judged::read(&repository.join("mutants/judged.md"))?;
    let survivors = work.join("survivors.txt");
    table::write_survivors(&survivors, &mutants, &results, &labels, &judged)?;
    println!("{}", table::table(&mutants, &tree, &results, &labels, &judged));
    println!("What survived and is not in mutants/judged.md stands in {}.", survivors.display());
    for wrong in judged.wrong(&mutants, &labels, &results) {
        println!("mutants/judged.md: {wrong}");
    }
    Ok(())
}
