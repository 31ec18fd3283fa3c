//! What is promised of a curve that was computed.

use crate::data::NO_JOINT;
use minvar::curve::{Element, LENGTH_TRUSTED};
use minvar_ffi::minvar_status::*;
use minvar_ffi::{minvar_element, minvar_joint, minvar_obstacle, minvar_options, minvar_report};
use minvar_tests::curves::{Vector, cross, derivatives, distance, dot, end_shape, norm, sub, times};

/// Fixed tangents and the tangents of both sides, radians.
const TANGENT: f64 = 1e-12;
/// Curvatures, as a fraction, beside what rounding leaves of them.
const CURVATURE: f64 = 1e-9;
/// How far a sliding joint may be off its line or plane, as a fraction of the coordinates that it comes from.
const SLIDE: f64 = 1e-12;
/// How far a curve may reach into a clearance, as a fraction of its extent.
const CLEAR: f64 = 1e-6;

/// A solved curve and what was asked for.
pub struct Solved<'a> {
    /// The joints.
    pub joints: &'a [minvar_joint],
    /// Whether the curve returns to its first joint.
    pub closed: bool,
    /// What it keeps clear of.
    pub obstacles: &'a [minvar_obstacle],
    /// The options.
    pub options: &'a minvar_options,
    /// The elements, as many as the report says.
    pub elements: &'a [minvar_element],
    /// The report.
    pub report: &'a minvar_report,
}

/// The kernel's elements of C's.
pub fn elements_of(elements: &[minvar_element]) -> Vec<Element> {
    elements.iter().map(|element| Element { rows: element.rows }).collect()
}

/// A vector of any size but zero as one of length one.
/// The direction of a vector of any length but zero.
pub fn direction(v: Vector) -> Vector {
    let most = v.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let v = v.map(|x| x / most);
    times(v, 1.0 / norm(v))
}

fn angle(a: Vector, b: Vector) -> f64 {
    libm::atan2(norm(cross(a, b)), dot(a, b))
}

/// The largest of numbers by size.
fn most(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().fold(0.0, |most, x| x.abs().max(most))
}

impl Solved<'_> {
    /// All promises.
    pub fn check(&self) {
        let report = self.report;
        let elements = elements_of(self.elements);
        assert_ne!(report.status, MINVAR_UNSOLVED);
        assert!(
            elements.iter().flat_map(|element| element.rows).flatten().all(f64::is_finite),
            "{:?}: an element is not finite: {elements:?}",
            report.status
        );
        let figures = [report.value, report.fine_value, report.length, report.variation, report.bending];
        let others = [report.error, report.gradient, report.decrement];
        assert!(
            !figures.iter().chain(&others).any(|x| x.is_nan()),
            "{:?}: a figure is NaN: {figures:?} {others:?}",
            report.status
        );
        let sound = figures.iter().all(|x| x.is_finite() && *x >= 0.0);
        if report.status == MINVAR_CONVERGED {
            assert!(sound, "converged, but {figures:?}");
            let off = (report.length - self.options.length).abs();
            let asked = self.options.length;
            assert!(
                asked == 0.0 || off <= LENGTH_TRUSTED * asked,
                "length {}, asked for {asked}",
                report.length
            );
        }
        assert!(
            report.status != MINVAR_ITERATION_LIMIT
                || report.iterations >= self.options.max_iterations as usize,
            "the limit of {} was not reached: {}",
            self.options.max_iterations,
            report.iterations
        );
        let spans = if self.closed { self.joints.len() } else { self.joints.len() - 1 };
        let even = self.options.tolerance == 0.0 && self.obstacles.is_empty();
        if even {
            let per_span = self.options.elements_per_span as usize;
            assert_eq!(elements.len(), spans * per_span, "elements");
            self.each_joint(&elements, |index| index * per_span);
        } else {
            self.fixed_points_in_order(&elements);
        }
        self.meets(&elements, even.then_some(self.options.elements_per_span as usize));
        if report.status == MINVAR_CONVERGED {
            self.keeps_clear(&elements);
        }
    }

    /// What is given at each joint is kept by the elements at it.
    fn each_joint(&self, elements: &[Element], start: impl Fn(usize) -> usize) {
        let last = self.joints.len() - 1;
        for (index, joint) in self.joints.iter().enumerate() {
            let leaving = (self.closed || index < last).then(|| start(index));
            let arriving = match index.checked_sub(1) {
                Some(_) => Some(start(index) - 1),
                None => self.closed.then(|| elements.len() - 1),
            };
            for (side, element) in [arriving, leaving].into_iter().enumerate() {
                if let Some(element) = element {
                    kept(joint, side, &elements[element]);
                }
            }
        }
    }

    /// Of an uneven chain: the fixed points come in the joints' order.
    fn fixed_points_in_order(&self, elements: &[Element]) {
        let mut at = 0;
        let last = self.joints.len() - 1;
        for (index, joint) in self.joints.iter().enumerate().filter(|(_, joint)| joint.position.given == 2) {
            if index == last && !self.closed {
                assert_eq!(elements[elements.len() - 1].rows[5], joint.position.value, "joint {index}");
                continue;
            }
            let found = elements[at..].iter().position(|element| element.rows[0] == joint.position.value);
            assert!(found.is_some(), "joint {index} is not where an element begins");
            at += found.unwrap_or_default() + 1;
        }
    }

    /// Elements meet as asked.
    fn meets(&self, elements: &[Element], per_span: Option<usize>) {
        let count = elements.len();
        for k in 0..count - usize::from(!self.closed) {
            let (one, other) = (&elements[k], &elements[(k + 1) % count]);
            assert_eq!(one.rows[5], other.rows[0], "a gap after element {k}");
            let continuity = match per_span {
                None => continue,
                Some(per_span) if (k + 1) % per_span == 0 => {
                    self.joints[(k + 1) / per_span % self.joints.len()].continuity
                }
                Some(_) => NO_JOINT.continuity,
            };
            if let Some([(t1, k1, e1), (t2, k2, e2)]) = shapes([(one, 1), (other, 0)]) {
                let kink = angle(t1, t2);
                assert!(continuity == 0 || kink <= TANGENT, "a kink of {kink:e} after element {k}");
                let jump = distance(k1, k2) - 10.0 * (e1 + e2);
                let size = norm(k1).max(norm(k2));
                assert!(
                    continuity < 2 || jump <= CURVATURE * size,
                    "a jump of {jump:e} of {size:e} after {k}"
                );
            }
        }
    }

    /// Nowhere does the curve come nearer to an obstacle than asked; what it runs towards at an open end lies beyond it.
    fn keeps_clear(&self, elements: &[Element]) {
        let extent =
            most(elements.iter().flat_map(|e| (0..3).map(|d| e.rows[5][d] - elements[0].rows[0][d])))
                + most(elements.iter().flat_map(|e| e.rows[1]));
        let places: Vec<_> = elements
            .iter()
            .flat_map(|element| (0..32).map(|k| derivatives(element, f64::from(k) / 32.0)[0]))
            .chain(elements.last().map(|element| element.rows[5]))
            .collect();
        let least = |near: &[f64]| {
            // Round a closed curve its last place is its first.
            let around = [near[near.len() - 2], near[0], near[1]];
            let inner = near.windows(3).chain(self.closed.then_some(&around[..]));
            inner.filter(|n| n[1] <= n[0] && n[1] <= n[2]).map(|n| n[1]).fold(f64::INFINITY, f64::min)
        };
        for obstacle in self.obstacles {
            let near: Vec<_> =
                places.iter().map(|place| from_segment(*place, obstacle.from, obstacle.to)).collect();
            assert!(
                least(&near) >= obstacle.clearance - CLEAR * extent,
                "the curve comes as near as {} to {:?} {:?}",
                least(&near),
                obstacle.from,
                obstacle.to
            );
        }
    }
}

/// The distance of a point from a segment.
fn from_segment(p: Vector, from: Vector, to: Vector) -> f64 {
    let (along, off) = (sub(to, from), sub(p, from));
    let square = dot(along, along);
    let at = if square > 0.0 { (dot(off, along) / square).clamp(0.0, 1.0) } else { 0.0 };
    norm(sub(off, times(along, at)))
}

/// Shapes at ends of elements, in numbers that can be squared; `None` where they cannot.
fn shapes<const N: usize>(ends: [(&Element, usize); N]) -> Option<[(Vector, Vector, f64); N]> {
    let speeds = ends.map(|(element, end)| norm(element.rows[if end == 0 { 1 } else { 4 }]));
    let seconds = ends.map(|(element, end)| norm(element.rows[if end == 0 { 2 } else { 3 }]));
    let plain = |x: &f64| (1e-70..=1e70).contains(x);
    (speeds.iter().all(plain) && seconds.iter().all(|x| *x == 0.0 || plain(x)))
        .then(|| ends.map(|(element, end)| end_shape(element, end)))
}

/// One side of a joint keeps what is given there.
fn kept(joint: &minvar_joint, side: usize, element: &Element) {
    let here = element.rows[if side == 0 { 5 } else { 0 }];
    let position = joint.position.value;
    match joint.position.given {
        2 => assert_eq!(here, position, "a fixed point moved"),
        given @ (3 | 4) => {
            let (off, guide) = (sub(here, position), direction(joint.guide));
            let along = dot(off, guide);
            let away = if given == 3 { norm(sub(off, times(guide, along))) } else { along.abs() };
            let size = most(here.into_iter().chain(position));
            assert!(away <= SLIDE * size, "a sliding joint is {away:e} off, coordinates {size:e}");
        }
        _ => {}
    }
    let Some([(tangent, curvature, rounding)]) = shapes([(element, 1 - side)]) else { return };
    let keeps_tangent = joint.tangent[side].given == 2;
    if keeps_tangent {
        let off = angle(tangent, direction(joint.tangent[side].value));
        assert!(off <= TANGENT, "a fixed tangent is off by {off:e}");
    }
    let given = joint.curvature[side].value;
    if matches!(joint.curvature[side].given, 2 | 5) {
        let whole = keeps_tangent && joint.curvature[side].given == 2;
        let off = if whole { distance(curvature, given) } else { (norm(curvature) - norm(given)).abs() };
        let straight = f64::EPSILON / distance(element.rows[0], element.rows[5]);
        let beyond = off - 10.0 * rounding - straight;
        // A given curvature may lean by so much.
        let leaning = if whole { 1e-6 } else { 0.0 };
        assert!(
            beyond <= (CURVATURE + leaning) * norm(given),
            "a fixed curvature {given:?} is off by {off:e}"
        );
    }
}
