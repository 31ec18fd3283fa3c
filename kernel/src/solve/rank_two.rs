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

use super::envelope::{Envelope, dot};

/// The gradients, the matrix between them, and room for `Y`.
pub(super) struct RankTwo<'a> {
    pub(super) gradients: [&'a [f64]; 2],
    pub(super) second: [[f64; 2]; 2],
    pub(super) solved: [&'a mut [f64]; 2],
    /// `I + C M`, inverted, times `C`.
    middle: [[f64; 2]; 2],
}

impl<'a> RankTwo<'a> {
    pub(super) fn new(gradients: [&'a [f64]; 2], second: [[f64; 2]; 2], solved: [&'a mut [f64]; 2]) -> Self {
        Self { gradients, second, solved, middle: [[0.0; 2]; 2] }
    }

    /// A bound on the size of its eigenvalues.
    pub(super) fn norm(&self) -> f64 {
        let [a, b] = self.gradients.map(|g| dot(g, g));
        let [[aa, ab], [_, bb]] = self.second;
        aa.abs() * a + 2.0 * ab.abs() * libm::sqrt(a * b) + bb.abs() * b
    }

    /// Takes a new factorisation. Returns whether the whole matrix is positive definite.
    pub(super) fn factored(&mut self, envelope: &Envelope<'_, '_>, factor: &[f64]) -> bool {
        for (solved, gradient) in self.solved.iter_mut().zip(self.gradients) {
            solved.copy_from_slice(gradient);
            envelope.forward(factor, solved);
            envelope.backward(factor, solved, envelope.rows());
        }
        let m: [[f64; 2]; 2] =
            core::array::from_fn(|i| core::array::from_fn(|j| dot(self.gradients[i], self.solved[j])));
        let c = self.second;
        let k: [[f64; 2]; 2] = core::array::from_fn(|i| {
            core::array::from_fn(|j| f64::from(u8::from(i == j)) + c[i][0] * m[0][j] + c[i][1] * m[1][j])
        });
        let determinant = k[0][0] * k[1][1] - k[0][1] * k[1][0];
        if !(determinant > 0.0 && k[0][0] + k[1][1] > 0.0) {
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
