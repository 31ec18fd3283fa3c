//! What status comes of how a curve grew, and of what its figures say.

extern crate std;

use super::*;
use crate::curve::end::End;
use crate::curve::functional::Functional;
use crate::curve::joint::{Curve, Joint, Quantity};
use crate::curve::start::give_speeds;
use crate::curve::tests::planar;
use crate::solve::Silent;
use nalgebra::SVector;
use std::vec;
use std::vec::Vec;

/// How a computation ended, and what is made of it.
#[derive(Clone, Copy)]
struct Case {
    ended: Status,
    /// How many times as long the curve is as the polygon through its given positions; about, from 3 on.
    reach: usize,
    /// How many times as long it is as at the start.
    growth: f64,
    decrement: f64,
    /// By how much of it the functional differs from a finer rule's.
    off: f64,
    hurried: bool,
    iterations: usize,
    /// By how much of it the length differs from the one that is given, if one is.
    length: Option<f64>,
}

const CONVERGED: Case = Case {
    ended: Status::Converged,
    reach: 6,
    growth: 1.0,
    decrement: 0.0,
    off: 0.0,
    hurried: false,
    iterations: 7,
    length: None,
};

/// What is handed over of an arc of so many elements, of whose joints the first two are given.
fn status(case: &Case) -> Status {
    const TURN: f64 = 4.0;
    let count = case.reach;
    let part = TURN / count as f64;
    let point = |index: usize| {
        let angle = part * index as f64;
        [libm::sin(angle), 1.0 - libm::cos(angle)]
    };
    let free = Joint::at([0.0; 3]).with_position(Quantity::FREE);
    let mut joints = vec![free; count + 1];
    for index in 0..2 {
        let [x, y] = point(index);
        joints[index] = Joint::at([x, y, 0.0]);
    }
    let curve = Curve::open(&joints);
    let plain = Options { functional: Functional::MEC, max_iterations: 10, ..Options::DEFAULT };
    let mut model = planar(&curve, &plain);
    model.natural_cost = 1.0;
    model.start_length = TURN / case.growth;
    let mut state = vec![0.0; model.state_len()];
    for element in 0..count {
        let mut ends = [element, element + 1].map(|index| {
            let (sine, cosine) = (libm::sin(part * index as f64), libm::cos(part * index as f64));
            End {
                point: SVector::from(point(index)),
                frame: [SVector::from([cosine, sine]), SVector::from([-sine, cosine])],
                curvature: [1.0, 0.0],
                speed: 0.0,
                stretch: 0.0,
            }
        });
        give_speeds(&mut ends, part, part);
        (0..2).for_each(|end| model.set_end(element, end, &ends[end], &mut state));
    }
    let figures = figures_of(&model, &state);
    let length = case.length.map(|off| figures.length * (1.0 + off));
    let options = Options { length: length.unwrap_or(0.0), ..plain };
    let mut silent = Silent;
    let mut passes = Passes::new(&mut silent, &mut [], 1.0, 10, length);
    passes.iterations = case.iterations;
    if case.hurried {
        passes.hurry(1);
    }
    let bending = figures.bending;
    assert!((bending - TURN).abs() < 0.01 * TURN, "{bending}");
    let outcome = Outcome {
        status: case.ended,
        iterations: 0,
        linearisations: 0,
        value: bending * (1.0 + case.off),
        gradient: 0.0,
        decrement: case.decrement,
    };
    let mut elements: Vec<Element> = vec![Element::ZERO; count];
    let report = hand_over(&model, &outcome, &passes, &state, &mut elements, &options);
    assert!((report.length - TURN).abs() < 1e-4, "{}", report.length);
    assert_eq!((report.iterations, report.elements), (case.iterations, count));
    report.status
}

#[test]
fn a_status_says_what_came_out() {
    let (converged, stalled, unbounded) = (Status::Converged, Status::Stalled, Status::Unbounded);
    let limit = Status::IterationLimit;
    let of = |case: Case, wanted: Status| {
        let found = status(&case);
        let Case { ended, reach, growth, off, .. } = case;
        assert_eq!(found, wanted, "{ended:?}, {reach} times its data, {growth} times its start, {off} off");
    };
    of(CONVERGED, converged);
    // Of a length that is given anything is believed; of others nothing that is so much longer than its data.
    of(Case { reach: 48, ..CONVERGED }, converged);
    of(Case { reach: 52, ..CONVERGED }, unbounded);
    of(Case { reach: 52, length: Some(0.0), ..CONVERGED }, converged);
    for (off, wanted) in [(5e-7, converged), (-5e-7, converged), (2e-6, stalled), (-2e-6, stalled)] {
        of(Case { length: Some(off), ..CONVERGED }, wanted);
    }
    of(Case { length: Some(1e-5), growth: 11.0, ..CONVERGED }, unbounded);
    of(Case { length: Some(1e-5), growth: 9.0, ..CONVERGED }, stalled);
    // What grew too much from its start, or grew and is not known to be a minimum.
    of(Case { growth: 49.0, ..CONVERGED }, converged);
    of(Case { growth: 51.0, ..CONVERGED }, unbounded);
    of(Case { growth: 51.0, reach: 4, ..CONVERGED }, stalled);
    of(Case { growth: 11.0, decrement: f64::INFINITY, ..CONVERGED }, unbounded);
    of(Case { growth: 9.0, decrement: f64::INFINITY, ..CONVERGED }, converged);
    of(Case { growth: 11.0, decrement: f64::INFINITY, reach: 4, ..CONVERGED }, stalled);
    // What is not what was minimised.
    for off in [5e-5, -5e-5] {
        of(Case { off, ..CONVERGED }, converged);
    }
    for off in [2e-4, -2e-4] {
        of(Case { off, ..CONVERGED }, stalled);
        of(Case { off, growth: 9.0, ..CONVERGED }, stalled);
        of(Case { off, growth: 11.0, ..CONVERGED }, unbounded);
        of(Case { off, growth: 11.0, reach: 4, ..CONVERGED }, stalled);
    }
    // What was given up, and how far it had come.
    for ended in [stalled, limit] {
        let given_up = Case { ended, iterations: 10, ..CONVERGED };
        of(Case { growth: 6.0, ..given_up }, unbounded);
        of(Case { growth: 4.0, ..given_up }, ended);
        of(Case { growth: 6.0, reach: 4, ..given_up }, ended);
        of(Case { growth: 3.0, hurried: true, ..given_up }, unbounded);
        of(Case { growth: 1.5, hurried: true, ..given_up }, ended);
        of(Case { growth: 3.0, hurried: true, reach: 4, ..given_up }, ended);
    }
    // Nobody's limit was reached.
    of(Case { ended: limit, iterations: 9, ..CONVERGED }, stalled);
    of(Case { ended: unbounded, ..CONVERGED }, unbounded);
    of(Case { ended: unbounded, reach: 4, ..CONVERGED }, stalled);
    of(Case { ended: Status::Cancelled, reach: 52, growth: 100.0, off: 1.0, ..CONVERGED }, Status::Cancelled);
}
