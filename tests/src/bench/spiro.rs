//! libspiro on planar points: what it takes to run a fair curve through them, and how fair it is.
//!
//! It minimises nothing: its spirals are curves of their own kind. So it is not asked to come within anything; what its
//! curve's variation is, the record says.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's cosine")]

use super::ours::loosest;
use super::peer::Peer;
use super::record::Record;
use super::rounds::race;
use super::task::Task;
use crate::appendix::figure;
use crate::compare::kernel_joints;
use crate::curves::add;
use minvar::curve::{Functional, Joint};
use minvar::solve::Status;

/// The peer's name.
pub const NAME: &str = "libspiro";
/// Numbers of points, and how many random sets there are of each.
const SIZES: [usize; 3] = [8, 32, 128];
const SETS: u64 = 5;
/// By how much the variation of the spiral through Woodford's points exceeds the least, as a fraction.
const WOODFORD: f64 = 5.1e-5;
/// A break of the direction or, times the length of a segment, of the curvature that shows that it did not converge.
const BREAK: f64 = 1e-6;

/// Woodford's data and random points.
///
/// # Errors
///
/// Those of the peer.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn run(peer: &mut Peer, mut done: impl FnMut(Vec<Record>)) -> Result<(), String> {
    let woodford = kernel_joints(&figure("4.11"));
    let records = case(&Task::new("4.11 Woodford", woodford, false, Functional::MVC), peer)?;
    // A spiral's variation is read off its parameters: one that is known tells whether it is read rightly.
    let excess = records[0].peer_excess.unwrap_or(f64::NAN);
    if !((excess - WOODFORD).abs() < 0.1 * WOODFORD) {
        return Err(format!(
            "{NAME} through Woodford's points: V is {excess:e} above the least, not {WOODFORD:e}"
        ));
    }
    done(records);
    for size in SIZES {
        for set in 1..=SETS {
            let name = format!("{size} points, set {set}");
            done(case(&Task::new(name, random(size, set), false, Functional::MVC), peer)?);
        }
    }
    Ok(())
}

/// Points along a walk that turns by up to 40° at each of its uneven steps: wilder data have no fairest curve, or one with
/// loops that nobody wants.
fn random(size: usize, set: u64) -> Vec<Joint> {
    const MOST_TURN: f64 = 0.7;
    let mut state = 1000 * size as u64 + set;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    // Seeds that are alike begin alike.
    (0..3).for_each(|_| {
        next();
    });
    let (mut point, mut heading) = ([0.0; 3], 0.0_f64);
    (0..size)
        .map(|_| {
            heading += MOST_TURN * (2.0 * next() - 1.0);
            let step = 0.7 + 0.6 * next();
            point = add(point, [step * heading.cos(), step * heading.sin(), 0.0]);
            Joint::at(point)
        })
        .collect()
}

fn case(task: &Task, peer: &mut Peer) -> Result<Vec<Record>, String> {
    let (report, best) = task.solve(&task.options(0.0));
    task.hand_to(peer, &best)?;
    let asked = loosest(task, report.value);
    let mut records = Vec::new();
    for kind in ["g4", "g2"] {
        let answer = peer.numbers(&format!("solve {kind}"))?;
        let note = match answer[..] {
            [] => "gave up".into(),
            [_, direction, curvature, _] if direction.max(curvature) < BREAK => String::new(),
            [_, direction, curvature, _] => {
                format!("did not converge: breaks of {direction:.0e} and {curvature:.0e}")
            }
            _ => return Err(format!("{NAME} answered {answer:?}")),
        };
        // Nothing passes through the points with less than the least variation; one quintic a span is that near to it.
        if let Some(v) = answer.first().filter(|&&v| note.is_empty() && v < 0.99 * report.value) {
            return Err(format!(
                "{} by {NAME} {kind}: V {v:e}, below the least {:e}",
                task.name, report.value
            ));
        }
        let timing = race(task, asked.relative_decrease, peer, &[format!("time {kind}")])?[0];
        let mut record = Record {
            peer_excess: answer.first().map(|v| v / report.value - 1.0),
            reached: note.is_empty(),
            counts: kind == "g4",
            minimum: task.in_caller_units(report.value),
            note,
            ..Record::new(task, NAME, kind, &asked, &timing)
        };
        if report.status != Status::Converged {
            record.minvar_reached = false;
            record.note = format!("{} minvar: {}", record.note, report.status.name()).trim().into();
        }
        records.push(record);
    }
    Ok(records)
}
