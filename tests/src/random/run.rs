//! One problem with one functional, from the data to what the judges found.

use super::dice::Dice;
use super::finding::{Check, Findings};
use super::invariance::{Comparison, Image, Solved};
use super::judge::judge;
use super::measured::is_energy;
use super::problem::Problem;
use super::samples::Family;
use crate::curves::solve_curve;
use minvar::curve::{Functional, Options, elements_len};
use minvar::solve::Status;
use std::time::Instant;

/// How one problem went.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The problem's number.
    pub index: u64,
    /// Its family.
    pub family: Family,
    /// Whether the functional is known to have no minimum but only an infimum, which finer elements approach for ever.
    pub infimum: bool,
    /// Whether nobody would call the data wild.
    pub gentle: bool,
    /// What was minimised.
    pub functional: Functional,
    /// How many joints.
    pub joints: usize,
    /// How many elements.
    pub elements: usize,
    /// How it ended; unsolved where it was refused.
    pub status: Status,
    /// The number of iterations.
    pub iterations: usize,
    /// How often an element was linearised.
    pub linearisations: usize,
    /// How long that took.
    pub seconds: f64,
    /// What the judges found.
    pub findings: Findings,
}

/// In how many other clothes a problem is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Images {
    /// In none.
    None,
    /// In one, which goes by the problem's number.
    One,
    /// In all.
    All,
}

/// Solves and judges.
pub fn run(seed: u64, index: u64, options: &Options, images: Images) -> Outcome {
    let problem = Problem::new(seed, index);
    let functional = options.functional;
    let mut outcome = Outcome {
        index,
        family: problem.family,
        infimum: is_energy(functional) && !problem.has_least_energy(),
        gentle: problem.is_gentle(),
        functional,
        joints: problem.joints.len(),
        elements: elements_len(&problem.curve(), options),
        status: Status::Unsolved,
        iterations: 0,
        linearisations: 0,
        seconds: 0.0,
        findings: Findings::default(),
    };
    let start = Instant::now();
    let Ok((report, elements)) = solve_curve(&problem.joints, problem.closed, options) else {
        outcome.findings.must(Check::Refused, false);
        return outcome;
    };
    outcome.seconds = start.elapsed().as_secs_f64();
    outcome.findings.must(Check::Refused, true);
    (outcome.status, outcome.iterations, outcome.linearisations) =
        (report.status, report.iterations, report.linearisations);
    let measured = judge(&problem, options, &report, &elements, &mut outcome.findings);
    let base = Solved { report, elements, measured };
    let comparison = Comparison::new(&problem, options, &base);
    for (i, image) in Image::ALL.into_iter().enumerate() {
        // Where nothing but the elements' coarseness keeps a functional from sinking, only what is exact can be compared.
        if outcome.infimum && !image.is_exact() {
            continue;
        }
        let turn = index as usize % Image::ALL.len() == i;
        if images == Images::All || (images == Images::One && turn) {
            let _ = comparison.with(image, &mut image_dice(seed, index, i), &mut outcome.findings);
        }
    }
    outcome
}

/// What the judges draw changes no problem, and no image that of another.
pub fn image_dice(seed: u64, index: u64, image: usize) -> Dice {
    Dice::new(!seed, index * Image::ALL.len() as u64 + image as u64)
}
