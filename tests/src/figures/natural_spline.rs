//! The natural cubic spline: what curves were before they were fair.

use minvar::curve::Element;

/// The parametric spline with equal parameter intervals, second derivatives zero at the ends. Each cubic is exactly a
/// quintic element.
pub(super) fn through(points: &[[f64; 3]]) -> Vec<Element> {
    let n = points.len();
    // Second derivatives m: m[i−1] + 4 m[i] + m[i+1] = 6 (p[i−1] − 2 p[i] + p[i+1]), by Gauss on the tridiagonal system.
    let mut m = vec![[0.0; 3]; n];
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        let right = |d: usize| 6.0 * (points[i - 1][d] - 2.0 * points[i][d] + points[i + 1][d]);
        m[i] = std::array::from_fn(|d| (right(d) - m[i - 1][d]) / pivot);
    }
    for i in (1..n - 1).rev() {
        m[i] = std::array::from_fn(|d| m[i][d] - upper[i] * m[i + 1][d]);
    }
    let element = |i: usize| {
        let (p, q, a, b) = (points[i], points[i + 1], m[i], m[i + 1]);
        let leaving = std::array::from_fn(|d| q[d] - p[d] - (2.0 * a[d] + b[d]) / 6.0);
        let arriving = std::array::from_fn(|d| q[d] - p[d] + (a[d] + 2.0 * b[d]) / 6.0);
        Element { rows: [p, leaving, a, b, arriving, q] }
    };
    (0..n - 1).map(element).collect()
}
