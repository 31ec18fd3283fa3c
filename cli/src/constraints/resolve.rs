//! From names to the joints in the curve's order.

use super::fault::{did_you_mean, quote};
use super::parse::Parsed;
use super::words::{Place, Word, place_of};
use super::{Fault, NamedJoint, PlacedObstacle, Reading, Specification};
use std::collections::HashMap;

/// What a file holds, in its own order.
#[derive(Default)]
pub(super) struct Written<'a> {
    pub(super) joints: Vec<Joint>,
    pub(super) obstacles: Vec<PlacedObstacle>,
    pub(super) curve: Option<Curve<'a>>,
}

/// A joint and where it is written: from its parenthesis to its name.
pub(super) struct Joint {
    pub(super) place: Place,
    pub(super) value: NamedJoint,
}

/// A curve as it is written, its joints still names.
pub(super) struct Curve<'a> {
    /// From its parenthesis to its name.
    pub(super) place: Place,
    pub(super) name: &'a str,
    pub(super) closed: bool,
    pub(super) joints: Vec<Word<'a>>,
}

/// More unused joints than this are counted and not listed.
const MOST_WARNINGS: usize = 5;

/// Puts the joints into the curve's order.
pub(super) fn resolve(text: &str, written: Written<'_>) -> Parsed<Reading> {
    let Written { joints, obstacles, curve } = written;
    let mut by_name = HashMap::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        if let Some(first) = by_name.insert(joint.value.name.as_str(), index) {
            let message = format!("joint {} is defined twice", quote(&joint.value.name));
            let fault = Fault::error(text, joint.place, message);
            return Err(fault.earlier(text, joints[first].place, "first defined here"));
        }
    }
    let Some(curve) = curve else {
        let message = if joints.is_empty() && obstacles.is_empty() {
            "this file is empty: it has no curve"
        } else {
            "this file has no curve"
        };
        let end = place_of(text, text.trim_end().len());
        return Err(
            Fault::error(text, end, message).help("a curve is `(G2Curve name Open (a,b,…))` or `Closed`")
        );
    };
    let order = order(text, &curve, &joints, &by_name)?;

    let mut used = vec![false; joints.len()];
    for &index in &order {
        used[index] = true;
    }
    let mut warnings = Vec::new();
    let unused: Vec<_> =
        joints.iter().zip(&used).filter(|(_, used)| !**used).map(|(joint, _)| joint).collect();
    for joint in unused.iter().take(MOST_WARNINGS) {
        let message =
            format!("joint {} is not used by curve {}", quote(&joint.value.name), quote(curve.name));
        warnings.push(*Fault::warning(text, joint.place, message));
    }
    if let (Some(last), Some(more @ 1..)) = (warnings.last_mut(), unused.len().checked_sub(MOST_WARNINGS)) {
        last.help = Some(format!("{more} more joints are not used"));
    }

    let mut joints: Vec<_> = joints.into_iter().map(|joint| Some(joint.value)).collect();
    let in_order = order.into_iter().filter_map(|index| joints[index].take()).collect();
    let specification =
        Specification { name: curve.name.to_owned(), closed: curve.closed, joints: in_order, obstacles };
    Ok(Reading { specification, warnings })
}

/// The index of each of the curve's joints, each at most once.
fn order(
    text: &str,
    curve: &Curve<'_>,
    joints: &[Joint],
    by_name: &HashMap<&str, usize>,
) -> Parsed<Vec<usize>> {
    let mut order = Vec::with_capacity(curve.joints.len());
    let mut listed: Vec<Option<usize>> = vec![None; joints.len()];
    for (at, word) in curve.joints.iter().enumerate() {
        let fault = |message: String| Fault::error(text, word.place, message);
        let name = quote(word.text);
        let Some(&index) = by_name.get(word.text) else {
            let fault =
                fault(format!("curve {} names joint {name}, which is not defined", quote(curve.name)));
            return Err(
                match did_you_mean(word.text, joints.iter().map(|joint| joint.value.name.as_str())) {
                    Some(help) => fault.help(help),
                    None => fault,
                },
            );
        };
        if let Some(before) = listed[index] {
            let fault = if before + 1 == at {
                fault(format!("joint {name} is listed twice in a row"))
            } else {
                fault(format!("joint {name} is listed twice"))
            };
            let last = at + 1 == curve.joints.len();
            return Err(if before == 0 && last && curve.closed {
                fault.help("a closed curve returns to its first joint by itself: list it once")
            } else if before == 0 && last {
                fault.help("to return to the first joint write `Closed` and list it once")
            } else {
                fault.help("a curve passes a joint once: define a second joint at the same place")
            });
        }
        listed[index] = Some(at);
        order.push(index);
    }
    let (least, kind) = if curve.closed { (3, "a closed") } else { (2, "an open") };
    if order.len() < least {
        let (count, s) = (order.len(), if order.len() == 1 { "" } else { "s" });
        let message =
            format!("curve {} has {count} joint{s}: {kind} curve needs at least {least}", quote(curve.name));
        return Err(Fault::error(text, curve.place, message));
    }
    Ok(order)
}
