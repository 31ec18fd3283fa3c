//! minvar by itself: a warm start against a start from the data, and what a joint costs in a long chain.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's functions")]

use super::WITHIN;
use super::ours::Solver;
use super::rounds::median;
use super::task::Task;
use crate::appendix::figure;
use crate::compare::SETS;
use minvar::curve::{Functional, Joint, Options};
use minvar::solve::Status;
use serde::Serialize;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// By how much a joint is dragged to and fro, as a part of the mean distance between joints.
const DRAG: f64 = 0.01;
/// Repetitions, of which the median counts.
const REPEATS: usize = 51;
/// How long the chains are.
const LENGTHS: [usize; 5] = [10, 100, 1_000, 10_000, 100_000];
/// A chain's joints stand beside a line, or inside a circle, by these parts of their distance, over and over.
const WAVE: [f64; 5] = [0.0, 0.5, 0.2, -0.4, 0.1];

#[derive(Serialize)]
struct Line {
    case: String,
    peer: &'static str,
    minvar_us: f64,
    peer_us: f64,
    ratio: f64,
    us_an_element: f64,
    linearisations_an_element: f64,
}

/// Measures, prints, and adds to the records.
///
/// # Errors
///
/// If the file cannot be written.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn run(to: &Path) -> Result<(), String> {
    let mut lines = Vec::new();
    println!(
        "\nA joint dragged by a hundredth of a span: an update against a solve from the data, both to {WITHIN:e}."
    );
    println!("| case | update µs | an element | solve µs | ratio |\n| --- | --- | --- | --- | --- |");
    for (id, functional) in SETS {
        let task = Task::of_set(format!("{id} {functional:?}"), &figure(id), functional);
        if let Some(line) = warm(&task) {
            println!(
                "| {} | {:.1} | {:.2} | {:.1} | {:.2} |",
                line.case, line.minvar_us, line.us_an_element, line.peer_us, line.ratio
            );
            lines.push(line);
        }
    }
    println!(
        "\nA wave of so many joints, to {WITHIN:e}.\n| joints | µs a joint | beside that of 100 |\n| --- | --- | --- |"
    );
    for closed in [false, true] {
        let tasks = LENGTHS.map(|joints| wave(joints, closed));
        let found = tasks.each_ref().map(chain);
        let unit = found[1].us_a_joint;
        for (task, Chain { us_a_joint, linearisations_a_joint }) in tasks.iter().zip(found) {
            println!("| {} | {us_a_joint:.2} | {:.2} |", task.name, us_a_joint / unit);
            lines.push(Line {
                case: task.name.clone(),
                peer: "a joint of 100",
                minvar_us: us_a_joint,
                peer_us: unit,
                ratio: unit / us_a_joint,
                us_an_element: us_a_joint,
                linearisations_an_element: linearisations_a_joint,
            });
        }
    }
    let failed = |error: std::io::Error| format!("{}: {error}", to.display());
    let mut file = OpenOptions::new().append(true).open(to).map_err(failed)?;
    for line in &lines {
        let text = serde_json::to_string(line).map_err(|error| error.to_string())?;
        writeln!(file, "{text}").map_err(failed)?;
    }
    Ok(())
}

fn micros(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    1e6 * start.elapsed().as_secs_f64()
}

fn options(task: &Task) -> Options {
    Options { relative_decrease: WITHIN, ..task.default_options() }
}

/// `None` where a solve from the data does not converge.
fn warm(task: &Task) -> Option<Line> {
    let mut dragged = task.joints.clone();
    let middle = &mut dragged[task.joints.len() / 2].position.value;
    // The task's unit is near the mean distance.
    (middle[0], middle[1]) = (middle[0] + DRAG, middle[1] - 0.7 * DRAG);
    let mut solver = Solver::new(task, &options(task));
    if solver.solve().status != Status::Converged {
        return None;
    }
    let mut linearisations = 0;
    let (mut updates, mut solves) = (Vec::new(), Vec::new());
    for _ in 0..REPEATS {
        solves.push(micros(|| {
            solver.solve();
        }));
        for joints in [&dragged, &task.joints] {
            updates.push(micros(|| linearisations = solver.update(joints).linearisations));
        }
    }
    let (minvar_us, peer_us, count) = (median(updates), median(solves), task.spans() as f64);
    Some(Line {
        case: task.name.clone(),
        peer: "minvar from the data",
        minvar_us,
        peer_us,
        ratio: peer_us / minvar_us,
        us_an_element: minvar_us / count,
        linearisations_an_element: linearisations as f64 / count,
    })
}

/// What a long chain costs.
struct Chain {
    us_a_joint: f64,
    linearisations_a_joint: f64,
}

fn wave(count: usize, closed: bool) -> Task {
    let joints: Vec<Joint> = (0..count)
        .map(|i| {
            let (along, aside) = (i as f64, WAVE[i % WAVE.len()]);
            if !closed {
                return Joint::at([along, aside, 0.0]);
            }
            let tau = std::f64::consts::TAU;
            let (angle, radius) = (tau * along / count as f64, count as f64 / tau);
            let out = radius - aside * (1.0f64).min(0.05 * radius);
            Joint::at([out * angle.cos(), out * angle.sin(), 0.0])
        })
        .collect();
    let name = format!("{count} joints, {}", if closed { "closed" } else { "open" });
    Task::in_unit(1.0, name, joints, closed, Functional::MVC)
}

fn chain(task: &Task) -> Chain {
    let count = task.joints.len();
    let mut solver = Solver::new(task, &options(task));
    let mut linearisations = 0;
    let times = (0..(100_000 / count).clamp(3, REPEATS))
        .map(|_| micros(|| linearisations = solver.solve().linearisations));
    let us_a_joint = median(times.collect()) / count as f64;
    Chain { us_a_joint, linearisations_a_joint: linearisations as f64 / count as f64 }
}
