//! A problem as a constraint file for the command.

use super::problem::Problem;
use minvar::curve::{Continuity, Given, Joint, Quantity};
use std::fmt::Write;

fn vector(value: [f64; 3]) -> String {
    format!("({:?},{:?},{:?})", value[0], value[1], value[2])
}

/// A condition, or nothing where the quantity is free.
fn condition(out: &mut String, what: &str, side: &str, quantity: Quantity) {
    let given = match quantity.given {
        Given::FIXED => "Fixed",
        Given::INITIAL => "Initial",
        _ => return,
    };
    let _ = write!(out, " ({given} {what}{side} {})", vector(quantity.value));
}

/// Both sides of a tangent or a curvature: once where they are the same.
fn sides(out: &mut String, what: &str, sides: [Quantity; 2]) {
    if sides[0] == sides[1] {
        condition(out, what, "", sides[0]);
    } else {
        condition(out, what, " Arriving", sides[0]);
        condition(out, what, " Leaving", sides[1]);
    }
}

/// Where the format wants a position that is free: evenly between the neighbours that are given, as the solver starts it.
fn position(joints: &[Joint], closed: bool, at: usize) -> Quantity {
    let count = joints.len();
    let given = |i: usize| joints[i % count].position.given != Given::FREE;
    if given(at) {
        return joints[at].position;
    }
    let steps = |next: &dyn Fn(usize) -> usize| (1..count).find(|&k| given(next(k)));
    let back = |k: usize| (at + count - k) % count;
    let on = |k: usize| (at + k) % count;
    let (Some(before), Some(after)) = (steps(&back), steps(&on)) else { return joints[at].position };
    debug_assert!(closed || (before <= at && at + after < count), "ends are given");
    let share = before as f64 / (before + after) as f64;
    let (from, to) = (joints[back(before)].position.value, joints[on(after)].position.value);
    Quantity::initial(std::array::from_fn(|d| from[d] + (to[d] - from[d]) * share))
}

/// The file's text.
pub fn write(problem: &Problem, comment: &str) -> String {
    let mut out = String::new();
    for line in comment.lines() {
        let _ = writeln!(out, "; {line}");
    }
    for (i, joint) in problem.joints.iter().enumerate() {
        let kind = match joint.continuity {
            Continuity::G0 => 0,
            Continuity::G1 => 1,
            _ => 2,
        };
        let place = position(&problem.joints, problem.closed, i);
        let initial = if place.given == Given::FIXED { "" } else { "Initial " };
        let _ = write!(out, "(G{kind}Joint p{i} {initial}{}", vector(place.value));
        sides(&mut out, "Tangent", joint.tangent);
        sides(&mut out, "Curvature", joint.curvature);
        out.push_str(")\n");
    }
    let names: Vec<String> = (0..problem.joints.len()).map(|i| format!("p{i}")).collect();
    let kind = if problem.closed { "Closed" } else { "Open" };
    let _ = writeln!(out, "(G2Curve random {kind} ({}))", names.join(","));
    out
}
