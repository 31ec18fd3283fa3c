//! Solves the sets of Appendix A over and over, for a profiler to count what is done in [`profiled`]: `make profile`.
//!
//! `profile SET FUNCTIONAL DECREASE TIMES`, for example `profile 4.11 Mvc 1e-6 20`. `profile` alone lists the sets.

use minvar::curve::{Options, Report};
use minvar_tests::appendix::figure;
use minvar_tests::bench::ours::Solver;
use minvar_tests::bench::task::Task;
use minvar_tests::compare::SETS;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [id, functional, decrease, times] = &arguments[..] else {
        for (id, functional) in SETS {
            println!("{id} {functional:?}");
        }
        return ExitCode::SUCCESS;
    };
    let set = SETS.iter().find(|(one, of)| one == id && format!("{of:?}") == *functional);
    let (Some(&(id, functional)), Ok(relative_decrease), Ok(times)) =
        (set, decrease.parse::<f64>(), times.parse::<u32>())
    else {
        eprintln!("usage: profile [SET FUNCTIONAL DECREASE TIMES]");
        return ExitCode::FAILURE;
    };
    let task = Task::of_set(id, &figure(id), functional);
    let mut solver = Solver::new(&task, &Options { relative_decrease, ..task.default_options() });
    let mut report = profiled(&mut solver);
    for _ in 1..times {
        report = profiled(&mut solver);
    }
    let elements = task.spans();
    println!("{elements} {} {}", report.iterations, report.linearisations);
    ExitCode::SUCCESS
}

#[inline(never)]
fn profiled(solver: &mut Solver<'_>) -> Report {
    solver.solve()
}
