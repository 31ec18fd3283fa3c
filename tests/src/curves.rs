//! Curves for the tests: solving them in memory that is neither longer nor cleaner than promised, and an evaluation of
//! elements that shares nothing with the kernel.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's cosine and powers")]

use minvar::curve::{
    Curve, CurveError, Element, Functional, Joint, Options, Report, elements_len, solve, workspace_len,
};
use minvar::solve::Silent;

/// A point or a vector.
pub type Vector = [f64; 3];

/// What untouched elements hold in the tests.
pub const MARKER: Element = Element { rows: [[-7.25; 3]; 6] };

/// Solves a curve in a workspace of exactly the length asked for, full of NaN, into exactly as many elements as asked
/// for.
///
/// # Errors
///
/// Those of [`solve`].
pub fn solve_curve(
    joints: &[Joint],
    closed: bool,
    options: &Options,
) -> Result<(Report, Vec<Element>), CurveError> {
    let curve = Curve::new(joints, closed);
    let mut workspace = vec![f64::NAN; workspace_len(&curve, options)?];
    let mut elements = vec![MARKER; elements_len(&curve, options)];
    let report = solve(&curve, options, &mut workspace, &mut elements, &mut [], &mut Silent)?;
    Ok((report, elements))
}

/// `a + b`.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` times a number.
pub fn times(a: Vector, by: f64) -> Vector {
    a.map(|x| x * by)
}

/// The inner product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The vector of length one.
pub fn unit(a: Vector) -> Vector {
    times(a, 1.0 / norm(a))
}

/// The distance of two points.
pub fn distance(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}

/// Nodes and weights of Gauss–Legendre on [0, 1], by Newton's method on the recurrence.
pub fn gauss_legendre(points: usize) -> Vec<(f64, f64)> {
    let n = points as f64;
    (0..points)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut before, mut here) = (1.0, x);
                for k in 2..=points {
                    let k = k as f64;
                    (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
                }
                slope = n * (x * here - before) / (x * x - 1.0);
                let step = here / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// The point and the first three derivatives of a quintic at `t`, from its coefficients in powers of `t`.
pub fn derivatives(element: &Element, t: f64) -> [Vector; 4] {
    let mut out = [[0.0; 3]; 4];
    for d in 0..3 {
        let [p0, v0, a0, a1, v1, p1] = element.rows.map(|row| row[d]);
        let (h, v, a) = (p1 - p0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0);
        let mut c = [
            p0,
            v0,
            0.5 * a0,
            10.0 * h - 4.0 * v + 0.5 * a,
            -15.0 * h + 7.0 * v - a,
            6.0 * h - 3.0 * v + 0.5 * a,
        ];
        for row in &mut out {
            row[d] = c.iter().rev().fold(0.0, |sum, c| sum * t + c);
            for k in 0..6 {
                c[k] = if k < 5 { (k + 1) as f64 * c[k + 1] } else { 0.0 };
            }
        }
    }
    out
}

/// The unit tangent and the curvature vector at the start (`end` 0) or the end (1), read off the rows, and how well
/// rounding lets the curvature be known there: it is what remains of `C''` across the tangent.
pub fn end_shape(element: &Element, end: usize) -> (Vector, Vector, f64) {
    let (first, second) =
        if end == 0 { (element.rows[1], element.rows[2]) } else { (element.rows[4], element.rows[3]) };
    let speed = norm(first);
    let curvature = times(cross(cross(first, second), first), 1.0 / speed / speed / speed / speed);
    (times(first, 1.0 / speed), curvature, 1e-15 * norm(second) / speed / speed)
}

/// The unit tangent, the curvature vector and the derivative of the binormal curvature vector by arc length.
pub fn shape(element: &Element, t: f64) -> [Vector; 3] {
    let [_, d1, d2, d3] = derivatives(element, t);
    let speed = norm(d1);
    let tangent = times(d1, 1.0 / speed);
    let curvature = times(cross(cross(d1, d2), d1), 1.0 / speed.powi(4));
    // Thesis (4.9) by the parameter, then by arc length.
    let by_parameter = sub(
        times(cross(d1, d3), 1.0 / speed.powi(3)),
        times(cross(d1, d2), 3.0 * dot(d1, d2) / speed.powi(5)),
    );
    [tangent, curvature, times(by_parameter, 1.0 / speed)]
}

fn integral(elements: &[Element], density: impl Fn(&Element, f64) -> f64) -> f64 {
    let rule = gauss_legendre(40);
    elements
        .iter()
        .map(|element| rule.iter().map(|&(t, weight)| weight * density(element, t)).sum::<f64>())
        .sum()
}

/// The length of a chain.
pub fn length(elements: &[Element]) -> f64 {
    integral(elements, |element, t| norm(derivatives(element, t)[1]))
}

/// The variation of curvature (MVC) or the bending energy (MEC) of a chain.
pub fn functional_value(functional: Functional, elements: &[Element]) -> f64 {
    integral(elements, |element, t| {
        let [_, curvature, slope] = shape(element, t);
        let of = if functional == Functional::MEC { curvature } else { slope };
        dot(of, of) * norm(derivatives(element, t)[1])
    })
}

/// Points at even arc lengths along a chain, ends included.
pub fn even_points(elements: &[Element], intervals: usize) -> Vec<Vector> {
    const PIECES: usize = 32;
    let rule = gauss_legendre(8);
    let piece = |element: &Element, from: f64, to: f64| -> f64 {
        rule.iter()
            .map(|&(t, weight)| weight * (to - from) * norm(derivatives(element, from + t * (to - from))[1]))
            .sum()
    };
    // Arc lengths at the ends of the pieces.
    let mut table = vec![0.0];
    for element in elements {
        for k in 0..PIECES {
            let (from, to) = (k as f64 / PIECES as f64, (k + 1) as f64 / PIECES as f64);
            table.push(table[table.len() - 1] + piece(element, from, to));
        }
    }
    let total = table[table.len() - 1];
    (0..=intervals)
        .map(|i| {
            let s = total * i as f64 / intervals as f64;
            let at = table.partition_point(|&x| x <= s).clamp(1, table.len() - 1) - 1;
            let (element, from) = (&elements[at / PIECES], (at % PIECES) as f64 / PIECES as f64);
            let mut t = from + (s - table[at]) / (table[at + 1] - table[at]) / PIECES as f64;
            for _ in 0..8 {
                t -= (table[at] + piece(element, from, t) - s) / norm(derivatives(element, t)[1]);
                t = t.clamp(0.0, 1.0);
            }
            derivatives(element, t)[0]
        })
        .collect()
}

/// How far two chains are apart: the largest distance of points at the same fraction of the arc length, span by span.
pub fn deviation(a: &[Element], b: &[Element], spans: usize) -> f64 {
    let mut most = 0.0f64;
    for (one, other) in a.chunks(a.len() / spans).zip(b.chunks(b.len() / spans)) {
        for (p, q) in even_points(one, 24).into_iter().zip(even_points(other, 24)) {
            let off = distance(p, q);
            most = if off > most || off.is_nan() { off } else { most };
        }
    }
    most
}

/// The extent of the data or of a chain: the largest distance of points from the first one.
pub fn extent(points: impl IntoIterator<Item = Vector>) -> f64 {
    let mut points = points.into_iter();
    let Some(first) = points.next() else { return 0.0 };
    points.map(|point| distance(point, first)).fold(0.0, f64::max)
}
