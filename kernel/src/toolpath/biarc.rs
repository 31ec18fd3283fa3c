//! A planar chain of elements as tangent-continuous circular arcs and lines within a tolerance.
//!
//! Parts of the curve become biarcs: two arcs that have the part's end points, given end tangents, and meet
//! with a common tangent at a joint `J` (Bolton, *Biarc curves*, 1975, with tangent legs of equal length,
//! which suits a curvature that changes at a steady rate). A biarc may span several elements, bend both ways
//! and turn by more than π. Between biarcs the path passes through the curve and may lean from it a little,
//! which makes the arcs longer: [`leaned`].
//!
//! The proof, for one arc from `A` to `B` with unit tangents `τ_A`, `τ_B`, normal `n` to the left of `τ_A`,
//! signed curvature `k`, and the part of the curve that it replaces (for a biarc, the curve is parted where
//! it crosses the normal at `J`):
//!
//! - With `q = C − A`, `e = q·n − k |q|²/2` equals ±(R² − ρ²)/(2R), `ρ` the distance from the centre, and is
//!   just the distance from the line when `k = 0`. It is a polynomial of degree 10, and its Bernstein
//!   coefficients bound it. From `|e|` follows `|R − ρ|` exactly.
//! - `q·τ_A ≥ 0` and `(C − B)·τ_B ≤ 0`, proven by coefficients as well, say that the curve stays in the arc's
//!   sector (arcs turn by less than π), where the distance from the arc is `|R − ρ|`. Both may fail by
//!   rounding or by a gap between elements, no more than a tenth of `R`, which displaces the curve along the
//!   circle by no more than π/2 times as much and is added to the bound. The far side of the circle stays out
//!   of reach because the curve is connected and `|R − ρ| ≤ R/4`.
//! - Conversely the arc's point nearest to the curve moves continuously from `A` to `B`: no point of the arc
//!   is farther from the curve than that either.

use super::{Chain, Kind, PathError, Position, flatten};
use crate::basis::bernstein::{Bernstein, Dyadic};
use crate::curve::Element;
use crate::order::Order;
use crate::root::sqrt;

/// Arcs whose chord makes an angle with the end tangents whose cosine is below this are not made: they turn
/// by 2.94 rad at most.
const LEAST_COSINE: f64 = 0.1;

/// How far the end of an arc or a line may turn from a biarc's tangent (radians) to take its place.
const KINK: f64 = 5e-5;

/// `(72√3)^(2/3)/12`: see [`leaned`].
const BEST_LEAN: f64 = 2.0801;

/// The share of the best lean that is taken. The whole leaves no room for a rate that changes; from 0.5 to
/// 0.8 the number of arcs was the same within some percent, a fifth below that without a lean.
const LEAN: f64 = 0.6;

/// The greatest lean, radians.
const STEEPEST_LEAN: f64 = 0.1;

/// Parts shorter than this share of an element's piece are not cut further to sharpen a bound.
const SHORTEST_PART: f64 = 1.0 / 16.0;

/// A move from where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Move {
    /// Straight on.
    Line {
        /// The end point.
        end: [f64; 2],
    },
    /// Along a circle, by less than π.
    Arc {
        /// The end point.
        end: [f64; 2],
        /// The centre. It may be very far when the arc is nearly straight.
        centre: [f64; 2],
        /// Whether the arc turns to the right.
        clockwise: bool,
    },
}

/// A circular arc or, with curvature 0, a straight line, in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// The start point.
    pub start: [f64; 2],
    /// The end point.
    pub end: [f64; 2],
    /// The unit tangent at the start.
    pub start_tangent: [f64; 2],
    /// The unit tangent at the end.
    pub end_tangent: [f64; 2],
    /// The signed curvature, 1/length, positive to the left.
    pub curvature: f64,
}

/// One move of a path with what is known about it: see [`arcs`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where the move begins: where the one before ended.
    pub start: [f64; 2],
    /// The move.
    pub motion: Move,
    /// Proven: neither the move from its part of the curve nor that part from the move is farther than this
    /// length.
    pub deviation: f64,
}

/// The arcs and lines of a planar curve: see [`arcs`].
#[derive(Clone, Debug)]
pub struct Arcs<'a> {
    chain: Chain<'a>,
    at: Position,
    point: [f64; 2],
    /// The path's unit tangent at `point`, if it may go on smoothly from there.
    tangent: Option<[f64; 2]>,
    stop: Position,
    step: f64,
    /// The second half of a biarc whose first half was handed out.
    waiting: Option<Segment>,
}

/// The two arcs of equal tangent legs between two points with unit tangents there.
///
/// They share their tangent at the joint. `None` if there is no such pair of arcs that each turn by less than
/// 2.94 rad: the points coincide, the curve would have to go straight backwards, or the turn is too large.
pub fn biarc(
    start: [f64; 2],
    start_tangent: [f64; 2],
    end: [f64; 2],
    end_tangent: [f64; 2],
) -> Option<[Arc; 2]> {
    let chord = minus(end, start);
    let sum = [start_tangent[0] + end_tangent[0], start_tangent[1] + end_tangent[1]];
    let difference = minus(start_tangent, end_tangent);
    // The legs' length d makes the two inner control points 2d apart: |chord − d·sum| = 2d, solved without
    // cancellation for parallel tangents.
    let square = dot(chord, chord);
    let along = dot(chord, sum);
    let denominator = along + sqrt(along * along + dot(difference, difference) * square);
    if denominator.is_nan() || denominator <= 0.0 {
        return None;
    }
    let leg = square / denominator;
    let joint =
        [0.5 * (start[0] + end[0] + leg * difference[0]), 0.5 * (start[1] + end[1] + leg * difference[1])];
    Some([Arc::leaving(start, start_tangent, joint)?, Arc::reaching(joint, end, end_tangent)?])
}

impl Arc {
    /// The arc with this tangent at its start; `None` if it turns by more than 2.94 rad.
    fn leaving(start: [f64; 2], start_tangent: [f64; 2], end: [f64; 2]) -> Option<Self> {
        let (end_tangent, bend) = reflect(start_tangent, minus(end, start))?;
        Some(Self { start, end, start_tangent, end_tangent, curvature: bend })
    }

    /// The arc with this tangent at its end; `None` if it turns by more than 2.94 rad.
    fn reaching(start: [f64; 2], end: [f64; 2], end_tangent: [f64; 2]) -> Option<Self> {
        let (start_tangent, bend) = reflect(end_tangent, minus(end, start))?;
        Some(Self { start, end, start_tangent, end_tangent, curvature: -bend })
    }

    /// The arc as a move.
    pub fn motion(&self) -> Move {
        if self.curvature == 0.0 {
            return Move::Line { end: self.end };
        }
        let radius = 1.0 / self.curvature;
        let n = left_of(self.start_tangent);
        let centre = [self.start[0] + radius * n[0], self.start[1] + radius * n[1]];
        Move::Arc { end: self.end, centre, clockwise: self.curvature < 0.0 }
    }

    /// The tangent of half the angle between chord and tangent, and the arc's greatest distance from its
    /// chord.
    fn bulge(&self) -> (f64, f64) {
        let chord = minus(self.end, self.start);
        let length = sqrt(dot(chord, chord));
        let sine = cross(self.start_tangent, chord).abs();
        let half = sine / (length + dot(self.start_tangent, chord));
        (half, 0.5 * length * half)
    }
}

/// The tangent at the other end of an arc with this chord, and the curvature if `tangent` is at the start.
fn reflect(tangent: [f64; 2], chord: [f64; 2]) -> Option<([f64; 2], f64)> {
    let square = dot(chord, chord);
    let along = dot(tangent, chord);
    // A chord without length has no arc either.
    if square == 0.0 || along < LEAST_COSINE * sqrt(square) {
        return None;
    }
    let twice = 2.0 * along / square;
    let other = [twice * chord[0] - tangent[0], twice * chord[1] - tangent[1]];
    Some((other, 2.0 * cross(tangent, chord) / square))
}

/// The planar chain as arcs and lines within `tolerance` (a length): each biarc the longest that a greedy
/// search can prove.
///
/// The path is tangent-continuous to `1e-4` rad except at corners of the curve. At its ends and at corners it
/// has the curve's tangents to `1e-4` rad, in between its tangents may differ from the curve's by up to 0.1
/// rad. An arc that is straight within what the tolerance leaves, and turns by less than `1e-4` rad, is a
/// line. Should no biarc be provable, as when the curve turns back within the rounding of its coordinates,
/// chords take its place and the path has small corners there.
///
/// Errors: [`PathError`], before the first move. Heights (`z`) must be the same throughout, and are not
/// reported.
pub fn arcs(elements: &[Element], tolerance: f64) -> Result<Arcs<'_>, PathError> {
    let chain = Chain::new(elements, tolerance, Kind::Arcs)?;
    let at = chain.start();
    let point = planar(chain.point(at));
    Ok(Arcs { chain, at, point, tangent: None, stop: chain.next_stop(at), step: 1.0, waiting: None })
}

impl Arcs<'_> {
    /// The start of the curve.
    pub fn start(&self) -> [f64; 2] {
        planar(self.chain.point(self.chain.start()))
    }

    /// The height `z` of the curve's plane.
    pub fn height(&self) -> f64 {
        self.chain.point(self.chain.start())[2]
    }
}

impl Iterator for Arcs<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        if let Some(segment) = self.waiting.take() {
            return Some(segment);
        }
        if self.at >= self.chain.end() {
            return None;
        }
        let (chain, from) = (&self.chain, self.at);
        let tangent = self.tangent.unwrap_or_else(|| tangent(chain, from, false));
        let (to, first, second) = match longest(chain, from, self.point, tangent, self.stop, self.step) {
            Some((to, [first, second])) => {
                let one = as_one(chain, from, to, &first.0, &second.0);
                let last = one.map_or(second.0, |(arc, _)| arc);
                (self.point, self.tangent) = (last.end, Some(last.end_tangent));
                match one {
                    Some(one) => (to, segment(chain, one), None),
                    None => (to, segment(chain, first), Some(segment(chain, second))),
                }
            }
            None => {
                let [x, y] = self.point;
                let (to, chord) = flatten::longest(chain, from, [x, y, self.height()], self.stop, self.step);
                let motion = Move::Line { end: planar(chord.end) };
                let line = Segment { start: self.point, motion, deviation: chord.deviation };
                (self.point, self.tangent) = (planar(chord.end), None);
                (to, line, None)
            }
        };
        self.step = self.chain.parameters_between(from, to);
        self.at = to;
        if to >= self.stop {
            self.stop = self.chain.next_stop(to);
            self.tangent = None;
        }
        self.waiting = second;
        Some(first)
    }
}

/// The longest proven biarc from `start`, which is the curve's point at `from`, and the bounds of its halves.
fn longest(
    chain: &Chain<'_>,
    from: Position,
    start: [f64; 2],
    start_tangent: [f64; 2],
    stop: Position,
    step: f64,
) -> Option<(Position, [(Arc, f64); 2])> {
    let between = |to: Position, end_tangent: [f64; 2]| {
        let [first, second] = biarc(start, start_tangent, planar(chain.point(to)), end_tangent)?;
        let middle = crossing(chain, from, to, &first)?;
        Some([(first, prove(chain, &first, from, middle)?), (second, prove(chain, &second, middle, to)?)])
    };
    let search = |share: f64| {
        chain.farthest(from, stop, step, |to| {
            let direct = tangent(chain, to, to >= stop);
            between(to, if to >= stop { direct } else { leaned(chain, to, direct, share) })
        })
    };
    let leaning = search(LEAN);
    if leaning.as_ref().is_some_and(|(to, _)| *to >= stop) {
        return leaning;
    }
    let straight = search(0.0);
    let reach =
        |found: &Option<(Position, _)>| found.as_ref().map_or(0.0, |f| chain.parameters_between(from, f.0));
    // The first leaning biarc after one that does not lean is shorter; those that follow make up for it.
    if reach(&leaning) > 0.6 * reach(&straight) { leaning } else { straight }
}

/// The curve's tangent `direct`, turned to let longer arcs keep the limit.
///
/// Where the curvature changes at a steady rate `a`, an arc of length `h` between points of the curve
/// deviates least, by `a h³/(72√3)`, if the path leans from the curve by `−a h²/12` at both its ends; the
/// next arc begins as this one ended. Biarcs along the curve's tangents are the worse pattern 0, `−a h²/6`,
/// 0, … with three times the deviation. With the `h` whose deviation is the limit, the lean is
/// `−(72√3)^(2/3)/12 · ∛(a limit²)`. `share` is how much of it is taken. Nothing is proven here: what a lean
/// is good for, the bounds tell.
fn leaned(chain: &Chain<'_>, at: Position, direct: [f64; 2], share: f64) -> [f64; 2] {
    let [x, y, _] = chain.coordinates(at.index);
    let (x, y) = (x.derivative(), y.derivative());
    let d1 = [x.value(at.t), y.value(at.t)];
    let (x, y) = (x.derivative(), y.derivative());
    let d2 = [x.value(at.t), y.value(at.t)];
    let (x, y) = (x.derivative(), y.derivative());
    let d3 = [x.value(at.t), y.value(at.t)];
    let square = dot(d1, d1);
    let rate = (cross(d1, d3) - 3.0 * cross(d1, d2) * (dot(d1, d2) / square)) / (square * square);
    let lean = share * BEST_LEAN * libm::cbrt(rate * chain.limit * chain.limit);
    let lean = lean.clamp(-STEEPEST_LEAN, STEEPEST_LEAN);
    let (c, s) = (libm::cos(lean), -libm::sin(lean));
    [c * direct[0] - s * direct[1], s * direct[0] + c * direct[1]]
}

/// The single arc in place of a biarc, if it fits the tangent at the end and is proven.
fn as_one(chain: &Chain<'_>, from: Position, to: Position, first: &Arc, second: &Arc) -> Option<(Arc, f64)> {
    let arc = Arc::leaving(first.start, first.start_tangent, second.end)?;
    let turned = cross(arc.end_tangent, second.end_tangent).abs();
    if turned > KINK || dot(arc.end_tangent, second.end_tangent) < 0.0 {
        return None;
    }
    Some((arc, prove(chain, &arc, from, to)?))
}

/// A proven arc as a move; a line if that is as good.
fn segment(chain: &Chain<'_>, (arc, deviation): (Arc, f64)) -> Segment {
    let (half_angle, bulge) = arc.bulge();
    if 2.0 * half_angle <= KINK && deviation + bulge <= chain.limit {
        let motion = Move::Line { end: arc.end };
        return Segment { start: arc.start, motion, deviation: deviation + bulge + chain.slack };
    }
    Segment { start: arc.start, motion: arc.motion(), deviation: deviation + chain.slack }
}

/// Where the curve crosses the normal of the first arc's end, going forward.
fn crossing(chain: &Chain<'_>, from: Position, to: Position, first: &Arc) -> Option<Position> {
    for (index, t0, t1) in chain.pieces(from, to) {
        let ahead = along(chain, index, first.end, first.end_tangent);
        if ahead.value(t1) >= 0.0 {
            // A start ahead of the joint would break the sector condition anyway.
            if ahead.value(t0) >= 0.0 {
                return None;
            }
            return Some(Position { index, t: ahead.crossing(&ahead.derivative(), t0, t1) });
        }
    }
    None
}

/// `(C − origin)·direction` on one element.
fn along(chain: &Chain<'_>, index: usize, origin: [f64; 2], direction: [f64; 2]) -> Bernstein {
    let [x, y, _] = chain.coordinates(index);
    relative(x, origin[0]) * direction[0] + relative(y, origin[1]) * direction[1]
}

/// The greatest distance between the arc and the curve between two positions, if it is proven to be within
/// the limit.
fn prove(chain: &Chain<'_>, arc: &Arc, from: Position, to: Position) -> Option<f64> {
    let n = left_of(arc.start_tangent);
    let (k, limit) = (arc.curvature, chain.limit);
    let allowed = chain.overlap;
    // Else the far side of the circle were not clearly apart from the sector.
    if allowed * k.abs() > 0.1 {
        return None;
    }
    let mut greatest = 0.0_f64;
    for (index, t0, t1) in chain.pieces(from, to) {
        let [x, y, _] = chain.coordinates(index).map(|p| p.restricted(t0, t1));
        let mut cell = Some(Dyadic::WHOLE);
        while let Some(here) = cell {
            let (s0, s1) = here.interval();
            let x = relative(x.restricted(s0, s1), arc.start[0]);
            let y = relative(y.restricted(s0, s1), arc.start[1]);
            let forward = x * arc.start_tangent[0] + y * arc.start_tangent[1];
            let chord = minus(arc.end, arc.start);
            let beyond =
                relative(x, chord[0]) * arc.end_tangent[0] + relative(y, chord[1]) * arc.end_tangent[1];
            let error = x * n[0] + y * n[1] - (x * x + y * y) * (0.5 * k);

            let (low, high) = error.range();
            let away = from_circle(low, k).larger(from_circle(high, k));
            let inside = forward.range().0 >= -allowed && beyond.range().1 <= allowed;
            if inside && away <= limit && away * k.abs() <= 0.25 {
                greatest = greatest.larger(away);
                cell = here.next();
                continue;
            }
            // Cutting helps only if the ends, which are points of the curve, are where they should be.
            let ends = [error.value(0.0), error.value(1.0)];
            let hopeless = ends.iter().any(|&e| from_circle(e, k) > limit)
                || forward.value(0.0).smaller(forward.value(1.0)) < -allowed
                || beyond.value(0.0).larger(beyond.value(1.0)) > allowed;
            if hopeless || here.width <= SHORTEST_PART {
                return None;
            }
            cell = Some(here.left_half());
        }
    }
    Some(greatest)
}

/// `|R − ρ|` from `e = ±(R² − ρ²)/(2R)`, whose sign is the curvature's inside the circle. Not a number beyond
/// the centre.
fn from_circle(e: f64, curvature: f64) -> f64 {
    let root = sqrt(1.0 - 2.0 * e * curvature);
    if root.is_nan() { f64::INFINITY } else { 2.0 * e.abs() / (1.0 + root) }
}

/// The polynomial less a constant.
fn relative(p: Bernstein, constant: f64) -> Bernstein {
    p - Bernstein::constant(constant)
}

/// The unit tangent; where two elements meet, that of the one before or of the one after.
fn tangent(chain: &Chain<'_>, at: Position, before: bool) -> [f64; 2] {
    let (index, t) =
        if before && at.t == 0.0 && at.index > 0 { (at.index - 1, 1.0) } else { (at.index, at.t) };
    let [x, y, _] = chain.coordinates(index);
    let d = [x.derivative().value(t), y.derivative().value(t)];
    // Regular, so not zero.
    let speed = sqrt(dot(d, d));
    [d[0] / speed, d[1] / speed]
}

fn planar(p: [f64; 3]) -> [f64; 2] {
    [p[0], p[1]]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The vector turned by +90°.
fn left_of(v: [f64; 2]) -> [f64; 2] {
    [-v[1], v[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle(a: [f64; 2], b: [f64; 2]) -> f64 {
        libm::atan2(cross(a, b), dot(a, b)).abs()
    }

    fn unit(angle: f64) -> [f64; 2] {
        [libm::cos(angle), libm::sin(angle)]
    }

    #[test]
    fn a_biarc_meets_points_and_tangents_and_is_smooth_at_its_joint() {
        for (a, b) in
            [(0.5, -0.7), (0.5, 0.7), (1.0, 1.0), (0.0, 0.0), (0.0, 1.2), (2.2, -2.4), (1e-9, -1e-9)]
        {
            let [one, two] = biarc([3.0, 1.0], unit(a), [7.0, 1.0], unit(b)).unwrap();
            assert!(angle(one.end_tangent, two.start_tangent) < 1e-14);
            assert_eq!((one.start, one.end, two.end), ([3.0, 1.0], two.start, [7.0, 1.0]));
            for arc in [one, two] {
                // The end lies on the circle and the tangent there is across the radius, both by the centre.
                if let Move::Arc { centre, .. } = arc.motion() {
                    let (r0, r1) = (minus(arc.start, centre), minus(arc.end, centre));
                    let radius = sqrt(dot(r0, r0));
                    assert!((sqrt(dot(r1, r1)) - radius).abs() < 1e-14 * radius);
                    assert!(dot(r1, arc.end_tangent).abs() < 1e-13 * radius.larger(1.0));
                }
            }
        }
    }

    #[test]
    fn impossible_biarcs_are_refused() {
        assert!(biarc([0.0; 2], unit(0.0), [0.0; 2], unit(0.0)).is_none());
        assert!(biarc([0.0; 2], unit(0.0), [-1.0, 0.0], unit(0.0)).is_none());
    }

    #[test]
    fn the_distance_from_a_circle_is_exact() {
        // Radius 2 to the left and to the right, points 0.5 inside and outside.
        for k in [0.5, -0.5] {
            for rho in [1.5, 2.5] {
                let e = (4.0 - rho * rho) / 4.0 * f64::signum(k);
                assert!((from_circle(e, k) - 0.5).abs() < 1e-15);
            }
        }
        assert_eq!(from_circle(-0.25, 0.0), 0.25);
    }

    #[test]
    fn a_straight_element_is_one_line() {
        let v = [3.0, 4.0, 0.0];
        let element = [Element { rows: [[0.0; 3], v, [0.0; 3], [0.0; 3], v, v] }];
        let mut path = arcs(&element, 1e-6).unwrap();
        let only = path.next().unwrap();
        assert_eq!(only.motion, Move::Line { end: [3.0, 4.0] });
        assert!(path.next().is_none());
    }
}
