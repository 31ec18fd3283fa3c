//! The functional of one element by its Hermite rows, with gradient and Hessian: each is linear in the derivatives of the
//! density times basis values, so it is summed in the rows' coordinates once and mapped to the unknowns afterwards.

use super::fairness::{Dimension, Exterior, Functional, add_evenness, density, density_derivatives};
use crate::basis::hermite;
use crate::basis::quadrature::Rule;
use nalgebra::{SMatrix, SVector};

/// A combination of an element's six rows: its point or a derivative, by the values of the basis.
#[inline]
pub(super) fn combine<const D: usize>(rows: &[SVector<f64, D>; 6], weights: &[f64; 6]) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for a in 0..6 {
        sum += rows[a] * weights[a];
    }
    sum
}

/// `C', C'', C'''` of an element at a point of a rule.
#[inline]
pub(super) fn derivatives<const D: usize>(
    rows: &[SVector<f64, D>; 6],
    basis: &[[f64; 6]; 4],
) -> [SVector<f64, D>; 3] {
    core::array::from_fn(|k| combine(rows, &basis[k + 1]))
}

/// The functional of an element by its Hermite rows.
pub(super) fn row_cost<const D: usize>(
    functional: Functional,
    rule: &Rule,
    rows: &[SVector<f64, D>; 6],
) -> f64
where
    Dimension<D>: Exterior<D>,
{
    let mut sum = 0.0;
    for (t, weight) in rule.iter() {
        sum += weight * density(functional, &derivatives(rows, &hermite::basis(t)));
    }
    sum
}

/// The cost of an element with gradient and Hessian by its Hermite rows; of the Hessian, blocks `[a][b]`, `b <= a`.
pub(super) struct RowDerivatives<const D: usize> {
    pub(super) cost: f64,
    pub(super) gradient: [SVector<f64, D>; 6],
    pub(super) hessian: [[SMatrix<f64, D, D>; 6]; 6],
}

pub(super) fn row_derivatives<const D: usize>(
    functional: Functional,
    gauge: f64,
    rule: &Rule,
    rows: &[SVector<f64, D>; 6],
) -> RowDerivatives<D>
where
    Dimension<D>: Exterior<D>,
{
    let mut sum =
        RowDerivatives { cost: 0.0, gradient: [SVector::zeros(); 6], hessian: [[SMatrix::zeros(); 6]; 6] };
    for (t, weight) in rule.iter() {
        let basis = hermite::basis(t);
        let d = derivatives(rows, &basis);
        let mut at = density_derivatives(functional, &d);
        if gauge > 0.0 {
            add_evenness(gauge, &d, &mut at);
        }
        sum.cost += weight * at.value;
        // The full block h[k][l] for any k, l.
        let block = |k: usize, l: usize| if k >= l { at.hessian[k][l] } else { at.hessian[l][k].transpose() };
        for b in 0..6 {
            let column: [SMatrix<f64, D, D>; 3] = core::array::from_fn(|k| {
                (block(k, 0) * basis[1][b] + block(k, 1) * basis[2][b] + block(k, 2) * basis[3][b]) * weight
            });
            for k in 0..3 {
                sum.gradient[b] += at.gradient[k] * (weight * basis[k + 1][b]);
            }
            for a in b..6 {
                sum.hessian[a][b] +=
                    column[0] * basis[1][a] + column[1] * basis[2][a] + column[2] * basis[3][a];
            }
        }
    }
    sum
}
