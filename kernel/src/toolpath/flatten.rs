//! A chain of elements as straight chords within a tolerance. Planar and space curves, regular or not.
//!
//! The proof. The distance to a chord, a convex set, is a convex function; a curve in Bézier form is a convex
//! combination of its control points; so the curve is nowhere farther from the chord than its farthest
//! control point. Conversely the point of the chord nearest to a point of the curve moves continuously along
//! the curve, from the chord's start to its end, so it passes over every point of the chord, each time within
//! the same distance.

use super::{Chain, Kind, PathError, Position, distance};
use crate::basis::bernstein::Dyadic;
use crate::curve::Element;
use crate::order::Order;

/// Parts shorter than this share of an element's piece are not cut further to sharpen a bound.
const SHORTEST_PART: f64 = 1.0 / 8.0;

/// One chord. It begins where the chord before ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// The end point, on the curve.
    pub end: [f64; 3],
    /// Proven: neither the chord from its part of the curve nor that part from the chord is farther than this
    /// length.
    pub deviation: f64,
}

/// The chords of a curve: see [`chords`].
#[derive(Clone, Debug)]
pub struct Chords<'a> {
    chain: Chain<'a>,
    at: Position,
    point: [f64; 3],
    stop: Position,
    step: f64,
}

/// The chain as chords within `tolerance` (a length): as few as a greedy choice makes, each as long as can be
/// proven.
///
/// A chord may span several elements, but ends at corners. The bound is sharp within a tenth, so there are at
/// most about 5 % more chords than a greedy choice could do with; a greedy choice leaves one short chord at
/// the end.
///
/// Errors: [`PathError`] except `NotPlanar` and `Irregular`, before the first chord.
pub fn chords(elements: &[Element], tolerance: f64) -> Result<Chords<'_>, PathError> {
    let chain = Chain::new(elements, tolerance, Kind::Chords)?;
    let at = chain.start();
    Ok(Chords { chain, at, point: chain.point(at), stop: chain.next_stop(at), step: 1.0 })
}

impl Chords<'_> {
    /// Where the next chord begins: before the first one, the start of the curve.
    pub fn point(&self) -> [f64; 3] {
        self.point
    }
}

impl Iterator for Chords<'_> {
    type Item = Chord;

    fn next(&mut self) -> Option<Chord> {
        if self.at >= self.chain.end() {
            return None;
        }
        let (to, chord) = longest(&self.chain, self.at, self.point, self.stop, self.step);
        self.step = self.chain.parameters_between(self.at, to);
        self.at = to;
        self.point = chord.end;
        if to >= self.stop {
            self.stop = self.chain.next_stop(to);
        }
        Some(chord)
    }
}

/// The longest chord from `point`, which is the curve's at `from`, that the greedy search finds before
/// `stop`.
pub(super) fn longest(
    chain: &Chain<'_>,
    from: Position,
    point: [f64; 3],
    stop: Position,
    step: f64,
) -> (Position, Chord) {
    let attempt = |to| {
        let end = chain.point(to);
        bound(chain, from, to, point, end).map(|deviation| Chord { end, deviation: deviation + chain.slack })
    };
    chain.farthest(from, stop, step, attempt).unwrap_or_else(|| {
        // Not reached: control polygons shrink with the parameter and the tolerance is above rounding. Move
        // on all the same, and report the distance for what it is.
        let to = chain.advance(from, 1e-12);
        let end = chain.point(to);
        (to, Chord { end, deviation: distance(point, end) + chain.slack })
    })
}

/// The greatest distance of the curve between two positions from the chord `[a, b]`, if it is proven to be
/// within the limit.
fn bound(chain: &Chain<'_>, from: Position, to: Position, a: [f64; 3], b: [f64; 3]) -> Option<f64> {
    let mut greatest = 0.0_f64;
    for (index, t0, t1) in chain.pieces(from, to) {
        let [x, y, z] = chain.coordinates(index).map(|p| p.restricted(t0, t1));
        let mut cell = Some(Dyadic::WHOLE);
        while let Some(here) = cell {
            let (s0, s1) = here.interval();
            let [x, y, z] = [x, y, z].map(|p| p.restricted(s0, s1));
            let mut ends = 0.0_f64;
            let mut hull = 0.0_f64;
            let points = x.coefficients().iter().zip(y.coefficients()).zip(z.coefficients());
            for (k, ((&x, &y), &z)) in points.enumerate() {
                let away = distance_to_segment([x, y, z], a, b);
                hull = hull.larger(away);
                if k == 0 || k == 5 {
                    ends = ends.larger(away);
                }
            }
            if hull <= chain.limit {
                greatest = greatest.larger(hull);
                cell = here.next();
            } else if ends <= chain.limit && here.width > SHORTEST_PART {
                cell = Some(here.left_half());
            } else {
                return None;
            }
        }
    }
    Some(greatest)
}

fn distance_to_segment(p: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
    let (ux, uy, uz) = (b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    let (vx, vy, vz) = (p[0] - a[0], p[1] - a[1], p[2] - a[2]);
    let square = ux * ux + uy * uy + uz * uz;
    let share = if square > 0.0 { ((ux * vx + uy * vy + uz * vz) / square).clamp(0.0, 1.0) } else { 0.0 };
    // Any point of the segment gives an upper bound, so an inexact `share` does no harm.
    distance(p, [a[0] + share * ux, a[1] + share * uy, a[2] + share * uz])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(a: [f64; 3], b: [f64; 3]) -> Element {
        let v = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        Element { rows: [a, v, [0.0; 3], [0.0; 3], v, b] }
    }

    #[test]
    fn a_square_becomes_four_chords_with_exact_corners() {
        let corners = [[0.0, 0.0, 1.0], [10.0, 0.0, 1.0], [10.0, 10.0, 1.0], [0.0, 10.0, 1.0]];
        let square = [0, 1, 2, 3].map(|k: usize| line(corners[k], corners[(k + 1) % 4]));
        let mut count = 0;
        for (k, chord) in chords(&square, 0.1).unwrap().enumerate() {
            assert_eq!(chord.end, corners[(k + 1) % 4]);
            assert!(chord.deviation < 1e-9);
            count += 1;
        }
        assert_eq!(count, 4);
    }

    #[test]
    fn collinear_elements_become_one_chord() {
        let chain = [line([0.0; 3], [1.0, 2.0, 3.0]), line([1.0, 2.0, 3.0], [3.0, 6.0, 9.0])];
        assert_eq!(chords(&chain, 1e-6).unwrap().count(), 1);
    }
}
