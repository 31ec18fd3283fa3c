//! Paths measured independently of the kernel: moves and printed G-code as pieces, by dense samples, both ways.

// The measurement is to be independent of the kernel, and needs no equal bits.
#![allow(clippy::disallowed_methods)]

use minvar::curve::Element;
use minvar::toolpath::Plane;

/// A point of space.
pub type Point = [f64; 3];

/// The path as a control would follow it.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// From the one point to the other.
    Line(Point, Point),
    /// In the plane of x and y.
    Arc {
        /// The start; its height is the arc's.
        start: Point,
        /// The end.
        end: Point,
        /// The centre.
        centre: [f64; 2],
        /// The angle turned, positive counterclockwise.
        turn: f64,
    },
}

/// `a − b`.
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The length of a vector.
pub fn norm(a: Point) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

/// An arc from its ends and centre.
pub fn arc(start: Point, end: Point, centre: [f64; 2], clockwise: bool) -> Piece {
    let from = [start[0] - centre[0], start[1] - centre[1]];
    let angle = angle_to(from, [end[0] - start[0], end[1] - start[1]]);
    // As RS-274 has it: coinciding ends are a full turn.
    let full = std::f64::consts::TAU;
    let turn = match (clockwise, angle) {
        (true, 0.0..) => angle - full,
        (false, ..=0.0) => angle + full,
        _ => angle,
    };
    Piece::Arc { start, end, centre, turn }
}

/// The angle at an arc's centre from `from` to `from + by`: as accurate as `by` is, however far the centre.
fn angle_to(from: [f64; 2], by: [f64; 2]) -> f64 {
    let along = from[0] * (from[0] + by[0]) + from[1] * (from[1] + by[1]);
    (from[0] * by[1] - from[1] * by[0]).atan2(along)
}

impl Piece {
    /// The point at a share of the piece, 0 to 1.
    pub fn point(&self, s: f64) -> Point {
        match *self {
            Piece::Line(a, b) => [0, 1, 2].map(|d: usize| a[d] + s * (b[d] - a[d])),
            Piece::Arc { start, end, centre, turn } => {
                // By what is added to the start: a distant centre would take digits.
                let (x, y) = (start[0] - centre[0], start[1] - centre[1]);
                let (to_x, to_y) = (end[0] - start[0], end[1] - start[1]);
                let (r0, r1) = (x.hypot(y), (end[0] - centre[0]).hypot(end[1] - centre[1]));
                let grown = (to_x * (2.0 * x + to_x) + to_y * (2.0 * y + to_y)) / (r0 + r1);
                let (sin, half) = ((s * turn).sin(), (0.5 * s * turn).sin());
                let (dx, dy) = (-2.0 * half * half * x - sin * y, -2.0 * half * half * y + sin * x);
                let stretch = s * grown / r0;
                [start[0] + dx + stretch * (x + dx), start[1] + dy + stretch * (y + dy), start[2]]
            }
        }
    }

    /// The distance of a point from the piece.
    pub fn distance(&self, p: Point) -> f64 {
        match *self {
            Piece::Line(a, b) => {
                let (u, v) = (sub(b, a), sub(p, a));
                let uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
                let uv = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
                let s = if uu > 0.0 { (uv / uu).clamp(0.0, 1.0) } else { 0.0 };
                norm(sub(p, [a[0] + s * u[0], a[1] + s * u[1], a[2] + s * u[2]]))
            }
            Piece::Arc { start, end, centre, turn } => {
                let from = [start[0] - centre[0], start[1] - centre[1]];
                // The angle from the start in the direction of the turn.
                let angle = angle_to(from, [p[0] - start[0], p[1] - start[1]]);
                let angle = (angle * turn.signum()).rem_euclid(std::f64::consts::TAU);
                let ends = norm(sub(p, start)).min(norm(sub(p, end)));
                if angle <= turn.abs() {
                    ends.min(norm(sub(p, self.point(angle / turn.abs()))))
                } else {
                    ends
                }
            }
        }
    }

    /// Unit tangents at start and end, in the plane.
    pub fn tangents(&self) -> [[f64; 2]; 2] {
        match *self {
            Piece::Line(a, b) => {
                let d = sub(b, a);
                [[d[0] / norm(d), d[1] / norm(d)]; 2]
            }
            Piece::Arc { start, end, centre, turn } => [start, end].map(|p| {
                let (x, y) = (p[0] - centre[0], p[1] - centre[1]);
                let r = x.hypot(y) * turn.signum();
                [-y / r, x / r]
            }),
        }
    }
}

/// The greatest distances (curve from path, path from curve) over dense samples; the second is too large by
/// the sampling of the curve, at most the third.
pub fn measure(chain: &[Element], pieces: &[Piece], samples: usize) -> (f64, f64, f64) {
    let curve: Vec<Point> =
        chain.iter().flat_map(|e| (0..=samples).map(|k| e.point(k as f64 / samples as f64))).collect();
    // Where the piece nearest to one sample is, the next is near: but no promise is taken from that, all are
    // tried.
    let nearest = |p: Point, list: &[Piece]| list.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
    let from_path = curve.iter().map(|&p| nearest(p, pieces)).fold(0.0, f64::max);
    let polygon: Vec<Piece> = curve.windows(2).map(|w| Piece::Line(w[0], w[1])).collect();
    let sagitta = chain
        .iter()
        .flat_map(|e| {
            (0..samples).map(|k| {
                let (a, b) = (k as f64 / samples as f64, (k + 1) as f64 / samples as f64);
                Piece::Line(e.point(a), e.point(b)).distance(e.point(0.5 * (a + b)))
            })
        })
        .fold(0.0, f64::max);
    let per_piece = (3 * samples * chain.len() / pieces.len().max(1)).clamp(5, 200);
    let from_curve = pieces
        .iter()
        .flat_map(|piece| (0..=per_piece).map(|k| piece.point(k as f64 / per_piece as f64)))
        .map(|p| nearest(p, &polygon))
        .fold(0.0, f64::max);
    (from_path, from_curve, 1.5 * sagitta)
}

/// Asserts that path and curve are within a bound of each other; returns how far apart they were measured.
///
/// # Panics
///
/// If they are not.
pub fn assert_within(chain: &[Element], pieces: &[Piece], bound: f64, samples: usize) -> f64 {
    let (from_path, from_curve, sampling) = measure(chain, pieces, samples);
    assert!(from_path <= bound * (1.0 + 1e-9), "curve from path {from_path}, bound {bound}");
    assert!(
        from_curve <= bound * (1.0 + 1e-9) + sampling,
        "path from curve {from_curve}, bound {bound} + {sampling}"
    );
    from_path.max(from_curve - sampling)
}

/// What a control makes of a program: the cut in the curve's axes, with the checks that a control makes.
///
/// # Panics
///
/// If a control would refuse the program.
pub fn interpret(text: &str, plane: Plane) -> (Point, Vec<Piece>) {
    let axes = match plane {
        Plane::Xy => [0, 1, 2],
        Plane::Zx => [2, 0, 1],
        Plane::Yz => [1, 2, 0],
    };
    let mut machine = [f64::NAN; 3];
    let mut feed = None;
    let mut cutting = false;
    let mut start = None;
    let mut pieces = Vec::new();
    for line in text.lines() {
        let mut to = machine;
        let mut offset = [0.0; 3];
        let mut words = line.split(' ');
        let code = words.next().unwrap();
        for word in words {
            let value: f64 = word[1..].parse().unwrap();
            assert!(!word[1..].contains(['e', 'E', '+']) && &word[1..] != "-0", "{word}");
            match &word[..1] {
                "X" => to[0] = value,
                "Y" => to[1] = value,
                "Z" => to[2] = value,
                "I" => offset[0] = value,
                "J" => offset[1] = value,
                "K" => offset[2] = value,
                "F" => feed = Some(value),
                other => panic!("unexpected word {other}"),
            }
        }
        let curve = |m: [f64; 3]| axes.map(|axis: usize| m[axis]);
        match code {
            "G0" => assert!(!cutting || to[axes[2]] > machine[axes[2]], "a rapid move at cutting depth"),
            "G1" | "G2" | "G3" => {
                assert!(feed.is_some_and(|f| f > 0.0));
                let (from, end, centre) = (curve(machine), curve(to), curve(offset));
                if !cutting {
                    // The plunge.
                    assert!(code == "G1" && from[..2] == end[..2] && end[2] < from[2]);
                    cutting = true;
                    start = Some(end);
                } else if code == "G1" {
                    pieces.push(Piece::Line(from, end));
                } else {
                    assert_eq!(centre[2], 0.0);
                    let centre = [from[0] + centre[0], from[1] + centre[1]];
                    let r0 = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                    let r1 = (end[0] - centre[0]).hypot(end[1] - centre[1]);
                    assert!((r0 - r1).abs() <= (1e-3 * r0).min(0.5e-3), "radii {r0} and {r1}");
                    pieces.push(arc(from, end, centre, code == "G2"));
                }
            }
            _ => {}
        }
        if code == "G0" {
            cutting = false;
        }
        machine = to;
    }
    (start.unwrap(), pieces)
}
