//! The solver on a problem of the tests' own.

use minvar::solve::{Executor, Observer, Outcome, Problem, Record, Settings, minimise, workspace_len};

/// Minimises from a state, which is left where that ended, in memory that nothing has been written to; with what every
/// iteration did.
pub fn run<P: Problem>(
    problem: &P,
    settings: &Settings,
    executor: &dyn Executor,
    observer: &mut dyn Observer,
    state: &mut [f64],
) -> (Outcome, Vec<Record>) {
    let mut workspace = vec![f64::NAN; workspace_len(problem, executor.width())];
    let mut records = vec![Record::ZERO; settings.max_iterations];
    let outcome = minimise(problem, settings, executor, state, &mut workspace, &mut records, observer);
    let outcome = outcome.expect("enough memory");
    records.truncate(outcome.iterations);
    (outcome, records)
}
