//! minvar as a contender: the public call alone is timed, in memory that is there already.

use super::WITHIN;
use super::task::Task;
use minvar::curve::{Curve, Element, Joint, Options, Report, elements_len, solve, update, workspace_len};
use minvar::solve::{Silent, Status};
use std::hint::black_box;
use std::time::Instant;

/// minvar with its memory.
pub struct Solver<'a> {
    curve: Curve<'a>,
    options: Options,
    workspace: Vec<f64>,
    elements: Vec<Element>,
}

impl<'a> Solver<'a> {
    /// Memory for a task.
    ///
    /// # Panics
    ///
    /// If minvar refuses the data.
    pub fn new(task: &'a Task, options: &Options) -> Self {
        let curve = Curve::new(&task.joints, task.closed);
        let len = workspace_len(&curve, options).expect("the data are good");
        let elements = vec![Element::ZERO; elements_len(&curve, options)];
        Self { curve, options: *options, workspace: vec![0.0; len], elements }
    }

    /// Solves.
    ///
    /// # Panics
    ///
    /// If minvar refuses the data.
    pub fn solve(&mut self) -> Report {
        let curve = black_box(&self.curve);
        solve(curve, &self.options, &mut self.workspace, &mut self.elements, &mut [], &mut Silent)
            .expect("the data are good")
    }

    /// Solves other joints of the same kinds from the last solution.
    ///
    /// # Panics
    ///
    /// If minvar refuses the data.
    pub fn update(&mut self, joints: &[Joint]) -> Report {
        let curve = Curve::new(black_box(joints), self.curve.closed);
        update(&curve, &self.options, &mut self.workspace, &mut self.elements, &mut [], &mut Silent)
            .expect("the data are good")
    }

    /// The elements of the last solve.
    pub fn into_elements(self) -> Vec<Element> {
        self.elements
    }

    /// The mean microseconds of a solve, repeated for so many seconds.
    pub fn time(&mut self, seconds: f64) -> f64 {
        let start = Instant::now();
        let mut count = 0.0;
        loop {
            black_box(self.solve());
            count += 1.0;
            let passed = start.elapsed().as_secs_f64();
            if passed >= seconds {
                return 1e6 * passed / count;
            }
        }
    }
}

/// How minvar is asked to be done and no more.
pub struct Asked {
    /// The loosest `relative_decrease` of the decades that is within [`WITHIN`] of the minimum, else the tightest.
    pub relative_decrease: f64,
    /// Whether it is within.
    pub reached: bool,
    /// By how much the functional exceeds the minimum, as a fraction of it.
    pub excess: f64,
}

/// Finds how loosely minvar may be asked.
pub fn loosest(task: &Task, minimum: f64) -> Asked {
    let mut asked = Asked { relative_decrease: f64::NAN, reached: false, excess: f64::NAN };
    for relative_decrease in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let report = Solver::new(task, &task.options(relative_decrease)).solve();
        let excess = report.value / minimum - 1.0;
        let reached = excess <= WITHIN && report.status == Status::Converged;
        asked = Asked { relative_decrease, reached, excess };
        if reached {
            break;
        }
    }
    asked
}
