//! The quintic Hermite basis on [0, 1] (thesis 4.5), its derivatives, and the change to Bernstein–Bézier form.
//!
//! A quintic is written by six rows in the order of the thesis: `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`.

/// The six blending functions `H_0 … H_5` and their derivatives to third order at one parameter.
///
/// `basis(t)[k][a]` is the `k`-th derivative of `H_a` at `t`; any finite `t` is allowed, `[0, 1]` is the element.
pub const fn basis(t: f64) -> [[f64; 6]; 4] {
    let t2 = t * t;
    let t3 = t2 * t;
    let t4 = t3 * t;
    let t5 = t4 * t;
    [
        [
            1.0 - 10.0 * t3 + 15.0 * t4 - 6.0 * t5,
            t - 6.0 * t3 + 8.0 * t4 - 3.0 * t5,
            0.5 * (t2 - 3.0 * t3 + 3.0 * t4 - t5),
            0.5 * (t3 - 2.0 * t4 + t5),
            -4.0 * t3 + 7.0 * t4 - 3.0 * t5,
            10.0 * t3 - 15.0 * t4 + 6.0 * t5,
        ],
        [
            -30.0 * t2 + 60.0 * t3 - 30.0 * t4,
            1.0 - 18.0 * t2 + 32.0 * t3 - 15.0 * t4,
            0.5 * (2.0 * t - 9.0 * t2 + 12.0 * t3 - 5.0 * t4),
            0.5 * (3.0 * t2 - 8.0 * t3 + 5.0 * t4),
            -12.0 * t2 + 28.0 * t3 - 15.0 * t4,
            30.0 * t2 - 60.0 * t3 + 30.0 * t4,
        ],
        [
            -60.0 * t + 180.0 * t2 - 120.0 * t3,
            -36.0 * t + 96.0 * t2 - 60.0 * t3,
            1.0 - 9.0 * t + 18.0 * t2 - 10.0 * t3,
            3.0 * t - 12.0 * t2 + 10.0 * t3,
            -24.0 * t + 84.0 * t2 - 60.0 * t3,
            60.0 * t - 180.0 * t2 + 120.0 * t3,
        ],
        [
            -60.0 + 360.0 * t - 360.0 * t2,
            -36.0 + 192.0 * t - 180.0 * t2,
            -9.0 + 36.0 * t - 30.0 * t2,
            3.0 - 24.0 * t + 30.0 * t2,
            -24.0 + 168.0 * t - 180.0 * t2,
            60.0 - 360.0 * t + 360.0 * t2,
        ],
    ]
}

/// The fourth derivatives of the six blending functions at one parameter, as [`basis`] has those to third order.
pub const fn fourth(t: f64) -> [f64; 6] {
    [
        360.0 - 720.0 * t,
        192.0 - 360.0 * t,
        36.0 - 60.0 * t,
        -24.0 + 60.0 * t,
        168.0 - 360.0 * t,
        -360.0 + 720.0 * t,
    ]
}

/// The six Bézier control points of the quintic with the given Hermite rows, a row a coordinate vector.
pub fn to_bezier<const D: usize>(rows: &[[f64; D]; 6]) -> [[f64; D]; 6] {
    let mut points = [[0.0; D]; 6];
    for d in 0..D {
        let [p0, v0, a0, a1, v1, p1] = rows.map(|row| row[d]);
        points[0][d] = p0;
        points[1][d] = p0 + v0 / 5.0;
        points[2][d] = p0 + 2.0 * v0 / 5.0 + a0 / 20.0;
        points[3][d] = p1 - 2.0 * v1 / 5.0 + a1 / 20.0;
        points[4][d] = p1 - v1 / 5.0;
        points[5][d] = p1;
    }
    points
}

/// The six Hermite rows of the quintic with the given Bézier control points: the inverse of [`to_bezier`].
pub fn from_bezier<const D: usize>(points: &[[f64; D]; 6]) -> [[f64; D]; 6] {
    let mut rows = [[0.0; D]; 6];
    for d in 0..D {
        let [b0, b1, b2, b3, b4, b5] = points.map(|point| point[d]);
        rows[0][d] = b0;
        rows[1][d] = 5.0 * (b1 - b0);
        rows[2][d] = 20.0 * ((b2 - b1) - (b1 - b0));
        rows[3][d] = 20.0 * ((b5 - b4) - (b4 - b3));
        rows[4][d] = 5.0 * (b5 - b4);
        rows[5][d] = b5;
    }
    rows
}
