//! Where the search for a true curve begins: tangents of circles through three points, or a solution by elements.

use super::legendre::project;
use super::quintic::{Rows, curvature, derivatives, speed};
use super::{Point, Problem};
use crate::curves::gauss_legendre;
use std::f64::consts::TAU;

/// Samples that a span is started from.
const SAMPLES: usize = 32;

/// One span of a start.
#[derive(Clone, Debug)]
pub struct SpanStart {
    /// Its length.
    pub length: f64,
    /// Its tangent's angle where it starts.
    pub angle: f64,
    /// Its curvature at the Gauss–Legendre nodes of as many points, in order of arc length.
    pub curvature: Vec<f64>,
}

impl SpanStart {
    /// The series of the turning rate, `L κ`.
    pub(super) fn series(&self, degree: usize) -> Vec<f64> {
        let rates: Vec<f64> = self.curvature.iter().map(|kappa| kappa * self.length).collect();
        project(degree, &rates)
    }
}

/// Spans that leave and reach their joints at given tangent angles, with a curvature linear in arc length.
pub fn from_angles(problem: &Problem, angles: &[f64]) -> Vec<SpanStart> {
    (0..problem.spans())
        .map(|span| {
            let end = problem.end_joint(span);
            let (from, to) = (problem.joints[span].position, problem.joints[end].position);
            let chord = direction(from, to);
            let first = chord + near(angles[span] - chord);
            let turn = near(angles[end] - chord) - near(angles[span] - chord);
            // The angle is a parabola in u between those of the joints; its mean is the chord's.
            let bow = 6.0 * (first + 0.5 * turn - chord);
            let angle = |u: f64| first + turn * u + bow * (u * u - u);
            let reach: f64 = gauss_legendre(SAMPLES).iter().map(|&(u, w)| w * (angle(u) - chord).cos()).sum();
            // A start that runs backwards is no worse than a long one.
            let length = (to[0] - from[0]).hypot(to[1] - from[1]) / reach.max(0.3);
            let curvature = gauss_legendre(SAMPLES)
                .iter()
                .map(|&(u, _)| (turn + bow * (2.0 * u - 1.0)) / length)
                .collect();
            SpanStart { length, angle: first, curvature }
        })
        .collect()
}

/// Spans along the circles through each joint and its neighbours; given tangents are kept.
pub fn from_circles(problem: &Problem) -> Vec<SpanStart> {
    let joints = &problem.joints;
    let n = joints.len();
    let point = |i: usize| joints[i % n].position;
    let mut angles: Vec<Option<f64>> = joints.iter().map(|j| j.angle[0].or(j.angle[1])).collect();
    for (i, angle) in angles.iter_mut().enumerate() {
        let inner = problem.closed || (0 < i && i + 1 < n);
        if angle.is_none() && inner {
            *angle = Some(circle_angle(point(i + n - 1), point(i), point(i + 1)));
        }
    }
    // A free end follows the circle of its neighbour, or the chord where there is none.
    for (i, neighbour) in [(0, 1), (n - 1, n - 2)] {
        let (first, second) = if i == 0 { (i, neighbour) } else { (neighbour, i) };
        let chord = direction(point(first), point(second));
        angles[i] = angles[i].or_else(|| angles[neighbour].map(|other| 2.0 * chord - other)).or(Some(chord));
    }
    from_angles(problem, &angles.into_iter().flatten().collect::<Vec<_>>())
}

/// Spans measured at a chain of quintic elements, the same number for each.
///
/// # Panics
///
/// If the elements do not divide into so many spans.
pub fn from_elements(elements: &[Rows], spans: usize) -> Vec<SpanStart> {
    assert!(elements.len().is_multiple_of(spans), "{} elements for {spans} spans", elements.len());
    elements.chunks(elements.len() / spans).map(measure).collect()
}

fn measure(chain: &[Rows]) -> SpanStart {
    let rule = gauss_legendre(SAMPLES);
    let arc = |rows: &Rows, to: f64| rule.iter().map(|&(t, w)| w * to * speed(rows, to * t)).sum::<f64>();
    let lengths: Vec<f64> = chain.iter().map(|rows| arc(rows, 1.0)).collect();
    let length: f64 = lengths.iter().sum();
    let at = |fraction: f64| {
        let mut rest = fraction * length;
        let mut i = 0;
        while i + 1 < chain.len() && rest > lengths[i] {
            rest -= lengths[i];
            i += 1;
        }
        let mut t = rest / lengths[i];
        for _ in 0..20 {
            t = (t - (arc(&chain[i], t) - rest) / speed(&chain[i], t)).clamp(0.0, 1.0);
        }
        curvature(&chain[i], t)
    };
    let [_, [x, y], _] = derivatives(&chain[0], 0.0);
    SpanStart { length, angle: y.atan2(x), curvature: rule.iter().map(|&(u, _)| at(u)).collect() }
}

/// The direction from one point to another.
fn direction(from: Point, to: Point) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

/// The same angle in ±π.
fn near(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The tangent at `b` of the circle through three points: the angles between chords and tangent are those at the rim.
fn circle_angle(a: Point, b: Point, c: Point) -> f64 {
    direction(a, b) + near(direction(b, c) - direction(a, c))
}
