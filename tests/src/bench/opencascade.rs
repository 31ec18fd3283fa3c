//! OpenCASCADE's `FairCurve_MinimalVariation` between two points: one curve of degree 9 at its own tolerance.

use super::ours::loosest;
use super::peer::Peer;
use super::record::Record;
use super::rounds::race;
use super::task::Task;
use crate::appendix::figure;
use crate::compare::kernel_joints;
use minvar::curve::Functional;

/// The peer's name.
pub const NAME: &str = "opencascade";
/// Errors of an end's point, direction and curvature that are none.
const NO_ERROR: f64 = 1e-6;

/// The wicket, the coving, and the S curve without the point between its ends, where it passes anyway: there one quintic is
/// a tenth less fair than two, so that minvar takes two. All as they are given: in other units OpenCASCADE may fail.
///
/// # Errors
///
/// Those of the peer.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn run(peer: &mut Peer, mut done: impl FnMut(Vec<Record>)) -> Result<(), String> {
    for (id, name, elements_per_span) in
        [("4.2", "4.2 wicket", 1), ("4.22", "4.22 coving", 1), ("4.13", "4.13 S curve's ends", 2)]
    {
        let mut joints = kernel_joints(&figure(id));
        if joints.len() > 2 {
            joints = vec![joints[0], joints[joints.len() - 1]];
        }
        let task = Task::in_unit(1.0, name, joints, false, Functional::MVC);
        done(case(&Task { elements_per_span, ..task }, peer)?);
    }
    Ok(())
}

fn case(task: &Task, peer: &mut Peer) -> Result<Vec<Record>, String> {
    let (report, best) = task.solve(&task.options(0.0));
    task.hand_to(peer, &best)?;
    let asked = loosest(task, report.value);
    let mut records = Vec::new();
    for sliding in ["default", "free"] {
        let answer = peer.numbers(&format!("solve {sliding}"))?;
        let [code, variation, errors @ ..] = &answer[..] else {
            return Err(format!("{NAME} answered {answer:?}"));
        };
        let code = match *code as i32 {
            0 => "",
            1 => "not converged",
            2 => "infinite sliding",
            3 => "null height",
            _ => "not computed",
        };
        let error = errors.iter().copied().fold(0.0, f64::max);
        let mut notes = vec![format!("V {:.6e}", task.in_caller_units(*variation))];
        if !code.is_empty() {
            notes.push(code.into());
        }
        if !(error < NO_ERROR) {
            notes.push(format!("an end is off by {error:.0e}"));
        }
        let timing = race(task, asked.relative_decrease, peer, &[format!("time {sliding}")])?[0];
        records.push(Record {
            peer_excess: Some(variation / report.value - 1.0),
            reached: code.is_empty() && error < NO_ERROR,
            counts: true,
            minimum: task.in_caller_units(report.value),
            note: notes.join(", "),
            ..Record::new(task, NAME, sliding, &asked, &timing)
        });
    }
    Ok(records)
}
