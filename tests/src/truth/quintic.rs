//! Planar quintic Hermite elements, as far as a true curve is started from them and compared with them.

use super::Point;

/// An element's rows `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`.
pub type Rows = [[f64; 3]; 6];

/// The point and the first two derivatives at `t`, seen along z.
pub fn derivatives(rows: &Rows, t: f64) -> [Point; 3] {
    let mut out = [[0.0; 2]; 3];
    for axis in 0..2 {
        let [p0, v0, a0, a1, v1, p1] = rows.map(|row| row[axis]);
        // By Bézier points, which de Casteljau's construction takes down to the parameter.
        let mut b = [
            p0,
            p0 + v0 / 5.0,
            p0 + 2.0 * v0 / 5.0 + a0 / 20.0,
            p1 - 2.0 * v1 / 5.0 + a1 / 20.0,
            p1 - v1 / 5.0,
            p1,
        ];
        for left in (1..=5).rev() {
            if left == 2 {
                out[2][axis] = 20.0 * (b[2] - 2.0 * b[1] + b[0]);
            }
            if left == 1 {
                out[1][axis] = 5.0 * (b[1] - b[0]);
            }
            for i in 0..left {
                b[i] += t * (b[i + 1] - b[i]);
            }
        }
        out[0][axis] = b[0];
    }
    out
}

/// The speed at `t`.
pub fn speed(rows: &Rows, t: f64) -> f64 {
    let [_, [x, y], _] = derivatives(rows, t);
    x.hypot(y)
}

/// The curvature at `t`, positive to the left.
pub fn curvature(rows: &Rows, t: f64) -> f64 {
    let [_, d1, d2] = derivatives(rows, t);
    (d1[0] * d2[1] - d1[1] * d2[0]) / d1[0].hypot(d1[1]).powi(3)
}
