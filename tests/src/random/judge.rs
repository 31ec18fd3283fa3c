//! One result judged by itself: is what was fixed kept, do the elements meet as asked, and is the status true?

use super::finding::{Check, Findings};
use super::measured::{Measured, is_energy, measure, power, sharpest_turn, slowest};
use super::problem::Problem;
use crate::curves::{cross, distance, dot, end_shape, norm, unit};
use minvar::curve::{Continuity, Curve, Element, Functional, Given, Joint, Options, Report};
use minvar::solve::Status;

/// A direction's angle to another.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    libm::atan2(norm(cross(a, b)), dot(a, b))
}

/// The lengths of the polygon through the given positions.
fn chords(curve: &Curve<'_>) -> Vec<f64> {
    let points: Vec<[f64; 3]> = curve
        .joints
        .iter()
        .filter(|joint| joint.position.given != Given::FREE)
        .map(|joint| joint.position.value)
        .collect();
    let count = points.len();
    (0..count - usize::from(!curve.closed)).map(|i| distance(points[i], points[(i + 1) % count])).collect()
}

/// The length of the polygon through the given positions.
pub fn polygon(curve: &Curve<'_>) -> f64 {
    chords(curve).iter().sum()
}

/// A functional's natural size for the data: what a bend by one radian or so on every chord costs.
pub fn natural(curve: &Curve<'_>, functional: Functional) -> f64 {
    chords(curve)
        .iter()
        .map(|&chord| match power(functional) {
            1 => 1.0 / chord,
            3 => 1.0 / (chord * chord * chord),
            _ => 1.0,
        })
        .sum()
}

/// How far apart two values are as a fraction, what is below rounding and below the solver's own zero left out.
pub fn apart(a: f64, b: f64, floor: f64) -> f64 {
    ((a - b).abs() - floor).max(0.0) / a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
}

/// The part of the natural size below which a functional's value means nothing: the solver stops at a thousandth of its
/// relative decrease of 1e-12.
pub const MEANINGLESS: f64 = 1e-14;

/// Judges a result; returns what its elements measure.
pub fn judge(
    problem: &Problem,
    options: &Options,
    report: &Report,
    elements: &[Element],
    findings: &mut Findings,
) -> Measured {
    let functional = options.functional;
    let finite = elements.iter().flat_map(|element| element.rows).flatten().all(f64::is_finite)
        && [report.value, report.fine_value, report.length, report.variation, report.bending]
            .iter()
            .all(|x| x.is_finite() && *x >= 0.0);
    findings.must(Check::NotFinite, finite);
    let known = [Status::Converged, Status::Stalled, Status::IterationLimit, Status::Unbounded];
    let used_up =
        report.status != Status::IterationLimit || report.iterations == options.max_iterations as usize;
    findings.must(Check::Status, known.contains(&report.status) && used_up);
    // Little off a line in any direction, and moved far, is in no plane that the digits could tell.
    let vague = problem.place.shift != [0.0; 3] || problem.family == super::samples::Family::Straight;
    if problem.planar && !vague {
        findings.must(Check::Plane, report.planar);
    }
    constraints(problem, elements, findings);
    continuity(problem, elements, findings);
    let measured = measure(elements);
    let curve = problem.curve();
    if report.status == Status::Converged {
        let floor = 4.0 * measured.rounding(functional) + MEANINGLESS * natural(&curve, functional);
        findings.note(Check::Value, apart(report.value, measured.value(functional), floor));
        findings.note(Check::FineValue, apart(report.fine_value, measured.value(functional), floor));
        findings.note(Check::Cusp, sharpest_turn(elements));
        findings.note(Check::Grown, measured.length / polygon(&curve));
    }
    let coarse = is_energy(functional) && !problem.has_least_energy();
    if report.status == Status::Converged && !coarse {
        findings.note(Check::Slow, slowest(elements));
        findings.must(Check::Indefinite, report.decrement.is_finite());
    }
    if report.status == Status::Unbounded {
        findings.note(Check::NotGrown, polygon(&curve) / measured.length);
    }
    // A curve with a cusp has no figures, and one that only the elements' coarseness keeps from it hardly any.
    if report.status == Status::Converged && measured.settled && !findings.beyond(Check::Cusp) && !coarse {
        let variation = 4.0 * measured.rounding(Functional::MVC);
        let bending = 4.0 * measured.rounding(Functional::MEC);
        let most = elements.iter().flat_map(|e| e.rows).flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        findings.note(Check::Length, apart(report.length, measured.length, 1e-14 * most));
        findings.note(Check::Figures, apart(report.variation, measured.variation, variation));
        findings.note(Check::Figures, apart(report.bending, measured.bending, bending));
    }
    measured
}

/// Fixed positions to the last bit, tangents to 1e-12, curvatures to 1e-9 beside what rounding leaves of them: of
/// `C''`, and of the direction in which it points, which is a difference of points: a curve that turns by less than
/// rounding from one end of an element to the other is straight.
fn constraints(problem: &Problem, elements: &[Element], findings: &mut Findings) {
    let count = problem.joints.len();
    for (i, joint) in problem.joints.iter().enumerate() {
        let per_span = elements.len() / problem.curve().spans();
        let arriving =
            if i > 0 { Some(i * per_span - 1) } else { problem.closed.then(|| elements.len() - 1) };
        let leaving = Some(i * per_span).filter(|_| problem.closed || i + 1 < count);
        for (side, element) in [arriving, leaving].into_iter().enumerate() {
            if let Some(element) = element {
                kept(joint, side, &elements[element], findings);
            }
        }
    }
}

fn kept(joint: &Joint, side: usize, element: &Element, findings: &mut Findings) {
    if joint.position.given == Given::FIXED {
        findings.must(Check::Position, element.rows[if side == 0 { 5 } else { 0 }] == joint.position.value);
    }
    let (tangent, curvature, rounding) = end_shape(element, 1 - side);
    let keeps_tangent = joint.tangent[side].given == Given::FIXED;
    if keeps_tangent {
        findings.note(Check::Tangent, angle(tangent, unit(joint.tangent[side].value)));
    }
    if joint.curvature[side].given == Given::FIXED {
        // Without a fixed tangent a curvature keeps its size.
        let given = joint.curvature[side].value;
        let off =
            if keeps_tangent { distance(curvature, given) } else { (norm(curvature) - norm(given)).abs() };
        let straight = f64::EPSILON / distance(element.rows[0], element.rows[5]);
        let beyond = (off - 10.0 * rounding - straight).max(0.0);
        findings.note(Check::Curvature, if beyond == 0.0 { 0.0 } else { beyond / norm(given) });
    }
}

fn continuity(problem: &Problem, elements: &[Element], findings: &mut Findings) {
    let per_span = elements.len() / problem.curve().spans();
    for k in 0..elements.len() {
        if !problem.closed && k + 1 == elements.len() {
            continue;
        }
        let (one, other) = (&elements[k], &elements[(k + 1) % elements.len()]);
        findings.must(Check::Gap, one.rows[5] == other.rows[0]);
        let continuity = if (k + 1).is_multiple_of(per_span) {
            problem.joints[(k + 1) / per_span % problem.joints.len()].continuity
        } else {
            Continuity::G2
        };
        let ((t1, k1, e1), (t2, k2, e2)) = (end_shape(one, 1), end_shape(other, 0));
        if continuity != Continuity::G0 {
            findings.note(Check::Kink, angle(t1, t2));
        }
        if continuity == Continuity::G2 {
            let beyond = (distance(k1, k2) - 10.0 * (e1 + e2)).max(0.0);
            let size = norm(k1).max(norm(k2));
            findings.note(Check::CurvatureJump, if beyond == 0.0 { 0.0 } else { beyond / size });
        }
    }
}
