//! A matrix of rank two beside the sparse one: what a product of two sums adds to the Hessian.
//!
//! With `S` the sparse matrix, `U` the two gradients and `C` a symmetric 2 × 2 matrix, `S + U C Uᵀ` is never formed. Where
//! `S` is positive definite,
//!
//! ```text
//! (S + U C Uᵀ)⁻¹ x = y − Y (I + C M)⁻¹ C Uᵀ y,   y = S⁻¹ x,   Y = S⁻¹ U,   M = Uᵀ Y
//! ```
//!
//! (Sherman, Morrison and Woodbury), and the whole is positive definite exactly if both eigenvalues of `I + C M` are
//! positive: they are those of `I + M^(1/2) C M^(1/2)`.
//!
//! A curve that is to be longer than it would like to be is under negative tension: `S` alone has a negative eigenvalue
//! then. The whole is positive definite all the same if the part of `C` with its positive eigenvalue makes up for that
//! (its determinant with `S` changes sign) and the rest does not undo it.

use super::envelope::{Allow, Envelope, Factored, dot};
use crate::root::sqrt;
use crate::total::Total;

/// The gradients, the matrix between them, and room for `Y`.
pub(super) struct RankTwo<'a> {
    pub(super) gradients: [&'a [f64]; 2],
    pub(super) second: [[f64; 2]; 2],
    pub(super) solved: [&'a mut [f64]; 2],
    /// Which sparse matrices it may be added to.
    pub(super) allow: Allow,
    /// `I + C M`, inverted, times `C`.
    middle: [[f64; 2]; 2],
}

impl<'a> RankTwo<'a> {
    pub(super) fn new(
        gradients: [&'a [f64]; 2],
        second: [[f64; 2]; 2],
        solved: [&'a mut [f64]; 2],
        allow: Allow,
    ) -> Self {
        Self { gradients, second, solved, allow, middle: [[0.0; 2]; 2] }
    }

    /// A bound on the size of its eigenvalues.
    pub(super) fn norm(&self) -> f64 {
        let [a, b] = self.gradients.map(|g| dot(g, g));
        let [[aa, ab], [_, bb]] = self.second;
        aa.abs() * a + 2.0 * ab.abs() * sqrt(a * b) + bb.abs() * b
    }

    /// Takes a new factorisation. Returns whether the whole matrix is positive definite.
    pub(super) fn take(&mut self, envelope: &Envelope<'_, '_>, factor: &[f64], factored: Factored) -> bool {
        for (solved, gradient) in self.solved.iter_mut().zip(self.gradients) {
            solved.copy(gradient);
            envelope.solve(factor, factored, solved);
        }
        let m: [[f64; 2]; 2] =
            core::array::from_fn(|i| core::array::from_fn(|j| dot(self.gradients[i], self.solved[j])));
        let c = self.second;
        let k: [[f64; 2]; 2] = core::array::from_fn(|i| {
            core::array::from_fn(|j| f64::from(u8::from(i == j)) + c[i][0] * m[0][j] + c[i][1] * m[1][j])
        });
        let determinant = k[0][0] * k[1][1] - k[0][1] * k[1][0];
        let definite = if factored.negative.is_none() {
            determinant > 0.0 && k[0][0] + k[1][1] > 0.0
        } else {
            let (largest, [x, y]) = largest_eigenpair(&c);
            let along = x * (m[0][0] * x + m[0][1] * y) + y * (m[1][0] * x + m[1][1] * y);
            largest > 0.0 && determinant < 0.0 && 1.0 + largest * along < 0.0
        };
        if !definite {
            return false;
        }
        let inverse = [
            [k[1][1] / determinant, -k[0][1] / determinant],
            [-k[1][0] / determinant, k[0][0] / determinant],
        ];
        self.middle = core::array::from_fn(|i| {
            core::array::from_fn(|j| inverse[i][0] * c[0][j] + inverse[i][1] * c[1][j])
        });
        true
    }

    /// Turns `S⁻¹ x` into the whole matrix's inverse times `x`.
    pub(super) fn correct(&self, y: &mut [f64]) {
        let u = self.gradients.map(|g| dot(g, y));
        let by: [f64; 2] = core::array::from_fn(|i| self.middle[i][0] * u[0] + self.middle[i][1] * u[1]);
        for (solved, by) in self.solved.iter().zip(by) {
            for (y, z) in y.iter_mut().zip(solved.iter()) {
                *y -= by * z;
            }
        }
    }

    /// Adds `U C Uᵀ x` to `to`.
    pub(super) fn add_product(&self, x: &[f64], to: &mut [f64]) {
        let u = self.gradients.map(|g| dot(g, x));
        for (i, gradient) in self.gradients.into_iter().enumerate() {
            let by = self.second[i][0] * u[0] + self.second[i][1] * u[1];
            for (y, g) in to.iter_mut().zip(gradient) {
                *y += by * g;
            }
        }
    }
}

/// The largest eigenvalue of a symmetric matrix, and its direction, of length 1.
fn largest_eigenpair([[a, b], [_, c]]: &[[f64; 2]; 2]) -> (f64, [f64; 2]) {
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let spread = sqrt(half * half + b * b);
    let (x, y) = if half >= 0.0 { (half + spread, *b) } else { (*b, spread - half) };
    let size = sqrt(x * x + y * y);
    (mean + spread, if size > 0.0 { [x / size, y / size] } else { [1.0, 0.0] })
}

#[cfg(test)]
mod tests {
    use super::largest_eigenpair;

    /// To the last digits, also where the matrix is nearly diagonal, whichever end is the larger.
    #[test]
    fn the_direction_of_the_largest_eigenvalue_keeps_its_digits() {
        for small in [1.0, 1e-3, 1e-9, -1e-12, 0.0] {
            for [a, c] in [[2.0, 1.0], [1.0, 2.0], [-1.0, -2.0], [-3.0, 1.0]] {
                let (value, [x, y]) = largest_eigenpair(&[[a, small], [small, c]]);
                // The smaller of the two parts, by the first equation or the second.
                let (large, found) = if a > c { (x, y) } else { (y, x) };
                let wanted = large * small / (value - if a > c { c } else { a });
                assert!((found - wanted).abs() <= 1e-15 * wanted.abs(), "{a} {small} {c}: {found} {wanted}");
                assert!((x * x + y * y - 1.0).abs() < 1e-15);
                assert!(value >= a && value >= c);
                assert!(((value - a) * (value - c) - small * small).abs() < 1e-15);
            }
        }
    }
}
