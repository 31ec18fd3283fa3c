//! Was there really no minimum? Where the solver says so, or gives up, other ways are tried.
//!
//! Every one of these functionals but the scale-invariant ones sinks to nothing as a curve grows beyond all bounds, so that
//! "no minimum" can only mean none in reach: a finite one that another start finds is a minimum that was missed.

use super::finding::{Check, Findings};
use super::invariance::resumed;
use super::judge::{MEANINGLESS, judge, natural, polygon};
use super::problem::Problem;
use super::samples::Family;
use crate::ceres::{self, Start};
use crate::compare::reference_joint;
use crate::curves::solve_curve;
use minvar::curve::{Curve, Functional, Given, Joint, Options, Quantity};
use minvar::solve::Status;

/// A minimum that exists, and which way finds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Which way found it.
    pub way: &'static str,
    /// The functional's value.
    pub value: f64,
    /// The length.
    pub length: f64,
}

/// A curve as long as this many polygons is no minimum in reach.
const IN_REACH: f64 = 10.0;

/// What was found about a result that did not converge.
#[derive(Clone, Debug)]
pub struct Examined {
    /// A minimum that the solver's own means find, if any.
    pub own: Option<Minimum>,
    /// A minimum that the reference finds, or why it does not; `None` where it was not asked.
    pub reference: Option<Result<Minimum, String>>,
}

impl Examined {
    /// Whether there is a minimum in reach.
    pub fn has_minimum(&self) -> bool {
        self.own.is_some() || matches!(self.reference, Some(Ok(_)))
    }
}

/// Examines a result that did not converge, near the origin.
pub fn examine(problem: &Problem, options: &Options) -> Examined {
    let own = other_minimum(problem, options);
    let reference = if is_small(problem) { reference(problem, options.functional) } else { None };
    Examined { own, reference }
}

/// By which fraction the reference's minimum is lower than the solver's; `None` where the reference cannot be asked or
/// finds none.
pub fn excess(problem: &Problem, options: &Options) -> Option<f64> {
    if !is_small(problem) {
        return None;
    }
    let (report, _) = solve_curve(&problem.plain, problem.closed, options).ok()?;
    let lower = reference(problem, options.functional)?.ok()?;
    let curve = Curve::new(&problem.plain, problem.closed);
    let floor = MEANINGLESS * natural(&curve, options.functional);
    Some((report.value - lower.value - floor).max(0.0) / report.value.max(f64::MIN_POSITIVE))
}

/// Looks for a minimum with the solver's own means: more elements, more iterations, another functional's result as the
/// start, every start tangent along the polygon.
fn other_minimum(problem: &Problem, options: &Options) -> Option<Minimum> {
    let try_with = |way: &'static str, joints: &[Joint], options: &Options| {
        let (report, elements) = solve_curve(joints, problem.closed, options).ok()?;
        if report.status != Status::Converged || report.length > IN_REACH * polygon(&problem.curve()) {
            return None;
        }
        let mut findings = Findings::default();
        let _ = judge(problem, options, &report, &elements, &mut findings);
        (!findings.beyond(Check::Value) && !findings.beyond(Check::Cusp)).then_some(Minimum {
            way,
            value: report.value,
            length: report.length,
        })
    };
    let long = Options { max_iterations: 5000, ..*options };
    let one_more = Options { elements_per_span: options.elements_per_span + 1, ..long };
    let other = if options.functional == Functional::MEC { Functional::MVC } else { Functional::MEC };
    let from_other = || {
        let options = Options { functional: other, ..*options };
        let (report, elements) = solve_curve(&problem.joints, problem.closed, &options).ok()?;
        (report.status == Status::Converged).then(|| resumed(&problem.joints, &elements, problem.closed))
    };
    try_with("on and on", &problem.joints, &long)
        .or_else(|| try_with("one more element a span", &problem.joints, &one_more))
        .or_else(|| try_with("the other functional first", &from_other()?, &long))
        .or_else(|| try_with("tangents along the polygon", &along_the_polygon(problem), &long))
        .or_else(|| {
            let (_, elements) = solve_curve(&problem.joints, problem.closed, options).ok()?;
            try_with("from where it stopped", &resumed(&problem.joints, &elements, problem.closed), &long)
        })
}

/// The joints with every tangent that is free started along the chord between the neighbours.
fn along_the_polygon(problem: &Problem) -> Vec<Joint> {
    let mut joints = problem.joints.clone();
    let count = joints.len();
    for i in 0..count {
        let before = if i > 0 {
            i - 1
        } else if problem.closed {
            count - 1
        } else {
            0
        };
        let after = if i + 1 < count {
            i + 1
        } else if problem.closed {
            0
        } else {
            i
        };
        let (from, to) = (problem.joints[before].position, problem.joints[after].position);
        let chord = crate::curves::sub(to.value, from.value);
        let known = [from, to].iter().all(|p| p.given != Given::FREE) && crate::curves::norm(chord) > 0.0;
        let free = joints[i].tangent.iter().chain(&joints[i].curvature).all(|q| q.given == Given::FREE);
        if known && free {
            joints[i] = joints[i].with_tangent(Quantity::initial(chord));
        }
    }
    joints
}

/// What the independent reference finds: Newton's method from the thesis's start, on the problem near the origin. `None`
/// where it cannot be asked: a functional that it does not know, or a free position.
fn reference(problem: &Problem, functional: Functional) -> Option<Result<Minimum, String>> {
    let functional = match functional {
        Functional::MVC => ceres::Functional::Mvc,
        Functional::MEC => ceres::Functional::Mec,
        Functional(2) => ceres::Functional::SiMvc,
        _ => return None,
    };
    let one_sided = |joint: &Joint| {
        joint.tangent[0] == joint.tangent[1]
            && joint.curvature[0] == joint.curvature[1]
            && joint.position.given != Given::FREE
    };
    if !problem.plain.iter().all(one_sided) {
        return None;
    }
    let joints: Vec<ceres::Joint> = problem.plain.iter().map(reference_joint).collect();
    let reference = ceres::Problem::new(&joints, problem.closed, problem.planar, functional);
    let near = Curve::new(&problem.plain, problem.closed);
    Some(ceres::solve(&reference, Start::Thesis, &ceres::Options::newton()).and_then(|found| {
        let trusted = (found.finer_value - found.value).abs() <= 1e-4 * found.value;
        let in_reach = found.measure.l <= IN_REACH * polygon(&near);
        if found.converged && !found.runaway && trusted && in_reach {
            Ok(Minimum { way: "the reference", value: found.value, length: found.measure.l })
        } else {
            Err(format!(
                "{}{}{}",
                if found.runaway { "runs away " } else { "" },
                if found.converged { "" } else { "not converged " },
                if trusted { "" } else { "quadrature cheated" }
            ))
        }
    }))
}

/// Whether the reference's cost is bearable: its Newton's method is dense.
fn is_small(problem: &Problem) -> bool {
    problem.joints.len() <= 12 && problem.family != Family::Straight
}
