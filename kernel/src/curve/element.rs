//! One quintic Hermite element: plain data, and what can be read off it directly.

use crate::basis::hermite;

/// A quintic element in Hermite form (thesis 4.5): plain data in the caller's unit of length.
///
/// The six rows are `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`, each `[x, y, z]`; a planar curve in the
/// xy-plane has `z` constant. The parameter runs from 0 to 1.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// The rows `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`.
    pub rows: [[f64; 3]; 6],
}

impl Element {
    /// An element of zeros: what result slices are filled with before a solve.
    pub const ZERO: Self = Self { rows: [[0.0; 3]; 6] };

    /// `C`, `C'`, `C''` and `C'''` at parameter `t`.
    pub fn derivatives(&self, t: f64) -> [[f64; 3]; 4] {
        let basis = hermite::basis(t);
        let mut out = [[0.0; 3]; 4];
        for (order, row) in out.iter_mut().enumerate() {
            for d in 0..3 {
                let mut sum = 0.0;
                for a in 0..6 {
                    sum += basis[order][a] * self.rows[a][d];
                }
                row[d] = sum;
            }
        }
        out
    }

    /// The point `C(t)`.
    pub fn point(&self, t: f64) -> [f64; 3] {
        self.derivatives(t)[0]
    }

    /// The six control points of the same curve in Bézier form.
    pub fn bezier(&self) -> [[f64; 3]; 6] {
        hermite::to_bezier(&self.rows)
    }
}
