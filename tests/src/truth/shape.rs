//! What is measured at a true curve: points, curvatures, their extremes, and how far a chain of elements is from it.

use super::Point;
use super::legendre::{Basis, sum};
use super::newton::TrueCurve;
use super::quintic::{Rows, derivatives};
use crate::curves::gauss_legendre;

/// Pieces of a span between which points are tabulated.
const PIECES: usize = 64;

/// One span of a true curve.
#[derive(Clone, Debug)]
pub struct Span {
    /// Where it starts.
    pub start: Point,
    /// Its length.
    pub length: f64,
    /// Its tangent's angle there, in radians.
    pub angle: f64,
    /// The turning rate `L κ` over `[0, 1]` by orthonormal Legendre polynomials.
    pub series: Vec<f64>,
}

impl Span {
    fn basis(&self, u: f64) -> Basis {
        Basis::at(self.series.len() - 1, u)
    }

    /// The curvature at a fraction of the length; positive to the left.
    pub fn curvature(&self, u: f64) -> f64 {
        sum(&self.series, &self.basis(u).value) / self.length
    }

    /// The curvature's derivative by arc length.
    pub fn curvature_slope(&self, u: f64) -> f64 {
        sum(&self.series, &self.basis(u).slope) / (self.length * self.length)
    }

    /// The tangent's angle.
    pub fn angle(&self, u: f64) -> f64 {
        self.angle + sum(&self.series, &self.basis(u).integral)
    }

    /// The point.
    pub fn point(&self, u: f64) -> Point {
        // Steps as short as the tabulated pieces: a short rule is exact to rounding on each.
        let pieces = (u * PIECES as f64).ceil().max(1.0);
        let width = u / pieces;
        let mut point = self.start;
        for piece in 0..pieces as usize {
            point = self.onward(point, piece as f64 * width, width);
        }
        point
    }

    /// The point a short way behind a known one.
    fn onward(&self, from: Point, u: f64, width: f64) -> Point {
        let mut point = from;
        for (node, weight) in gauss_legendre(8) {
            let (sin, cos) = self.angle(u + node * width).sin_cos();
            point[0] += weight * width * self.length * cos;
            point[1] += weight * width * self.length * sin;
        }
        point
    }

    /// Points at even fractions.
    fn table(&self) -> Vec<Point> {
        let width = 1.0 / PIECES as f64;
        let mut points = vec![self.start];
        for piece in 0..PIECES {
            points.push(self.onward(points[piece], piece as f64 * width, width));
        }
        points
    }

    /// The distance of a point from the span, whose table is at hand.
    fn distance(&self, table: &[Point], point: Point) -> f64 {
        let off = |p: Point| (point[0] - p[0]).hypot(point[1] - p[1]);
        let nearest =
            (0..table.len()).min_by(|&a, &b| off(table[a]).total_cmp(&off(table[b]))).unwrap_or_default();
        let from = nearest as f64 / PIECES as f64;
        let (mut u, mut foot) = (from, table[nearest]);
        for _ in 0..12 {
            let (sin, cos) = self.angle(u).sin_cos();
            let (x, y) = (point[0] - foot[0], point[1] - foot[1]);
            let (along, across) = (x * cos + y * sin, y * cos - x * sin);
            // Near a centre of curvature all feet are equally near: any short step will do there.
            let lever = (1.0 - across * self.curvature(u)).max(0.1);
            u = (u + along / (self.length * lever)).clamp(0.0, 1.0);
            foot = self.onward(table[nearest], from, u - from);
        }
        off(foot)
    }
}

impl TrueCurve {
    /// The curvature at the start and at the end.
    pub fn end_curvatures(&self) -> [f64; 2] {
        [self.spans[0].curvature(0.0), self.spans[self.spans.len() - 1].curvature(1.0)]
    }

    /// The least and the largest curvature.
    pub fn curvature_range(&self) -> [f64; 2] {
        const SAMPLES: usize = 400;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for span in &self.spans {
            for i in 0..=SAMPLES {
                let u = i as f64 / SAMPLES as f64;
                let mut candidate = span.curvature(u);
                range = [range[0].min(candidate), range[1].max(candidate)];
                let (mut low, mut high) = (u, (u + 1.0 / SAMPLES as f64).min(1.0));
                if span.curvature_slope(low) * span.curvature_slope(high) < 0.0 {
                    for _ in 0..60 {
                        let middle = 0.5 * (low + high);
                        if span.curvature_slope(low) * span.curvature_slope(middle) <= 0.0 {
                            high = middle;
                        } else {
                            low = middle;
                        }
                    }
                    candidate = span.curvature(low);
                    range = [range[0].min(candidate), range[1].max(candidate)];
                }
            }
        }
        range
    }

    /// How far quintic elements are from this curve: the largest distance to it of points at even parameters, `samples + 1`
    /// an element. What the curve has and the elements leave out, such as a loop, is not seen.
    pub fn distance(&self, elements: &[Rows], samples: usize) -> f64 {
        let tables: Vec<Vec<Point>> = self.spans.iter().map(Span::table).collect();
        let mut most = 0.0f64;
        for rows in elements {
            for i in 0..=samples {
                let [point, ..] = derivatives(rows, i as f64 / samples as f64);
                let off = self
                    .spans
                    .iter()
                    .zip(&tables)
                    .map(|(span, table)| span.distance(table, point))
                    .fold(f64::INFINITY, f64::min);
                // A distance that is no number must not pass for none.
                most = if off > most || off.is_nan() { off } else { most };
            }
        }
        most
    }
}
