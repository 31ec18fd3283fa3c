//! The densities of the fairness functionals and their exact derivatives (thesis 4.2 to 4.8).
//!
//! With `d1, d2, d3` the parametric derivatives, `p = d1·d1`, `q = d1·d2` and `∧` the exterior product (a scalar in
//! the plane, the cross product in space), the curvature vector in its binormal form is `b = d1∧d2 / p^(3/2)`, and
//!
//! ```text
//! db/ds = N / p³   with   N = p (d1∧d3) − 3 q (d1∧d2)
//! variation   ∫ |db/ds − ρ|² ds = ∫ |N p⁻³ − ρ|² p^(1/2) dt      thesis (4.9); (4.6) with ρ = α dκ₀/ds
//! bending     ∫ |b|² ds         = ∫ |d1∧d2|² p^(−5/2) dt         thesis (4.1)
//! length      ∫ ds              = ∫ p^(1/2) dt
//! ```
//!
//! The thesis prints `du = C''×C'''` in 4.7, which must be `C'×C'''`. A density is a function of `N`, `d1∧d2` and `p`,
//! which are polynomials; its derivatives follow by the chain rule. It does not depend on the direction in which the
//! curve runs: it is the same for `(d1, −d2, d3)`.

mod evenness;
mod plane;
mod space;
#[cfg(test)]
mod tests;

pub(crate) use evenness::{add_evenness, evenness, quickening};
pub(crate) use plane::{curvature_with_derivatives, slope_with_derivatives};

use super::functional::Weights;
use crate::basis::lanes::Lanes;

/// The weights of the integrals times those of a quadrature rule.
pub(crate) struct Weighted {
    variation: Lanes,
    bending: Lanes,
    length: Lanes,
    bends: bool,
    varies: bool,
}

impl Weighted {
    #[inline(always)]
    pub(crate) fn by(weights: &Weights, rule: Lanes) -> Self {
        Self {
            variation: rule * weights.variation,
            bending: rule * weights.bending,
            length: rule * weights.length,
            bends: weights.bending != 0.0,
            varies: weights.variation != 0.0,
        }
    }
}

/// A bivector: one component in the plane, three in space.
pub(crate) type Normal = [Lanes; 3];

/// A matrix between two vectors.
pub(crate) type Block<const D: usize> = [[Lanes; D]; D];

/// A density at points side by side, with its derivatives by `d1, d2, d3`. Of the second derivatives the blocks
/// `[k][l]`, `l <= k`, are filled.
pub(crate) struct Local<const D: usize> {
    pub(crate) value: Lanes,
    pub(crate) gradient: [[Lanes; D]; 3],
    pub(crate) hessian: [[Block<D>; 3]; 3],
    /// `|d1|`, and its derivative by `d1`.
    pub(crate) length: Lanes,
    pub(crate) length_gradient: [Lanes; D],
}

impl<const D: usize> Local<D> {
    const ZERO: Self = Self {
        value: Lanes::ZERO,
        gradient: [[Lanes::ZERO; D]; 3],
        hessian: [[[[Lanes::ZERO; D]; D]; 3]; 3],
        length: Lanes::ZERO,
        length_gradient: [Lanes::ZERO; D],
    };
}

/// A dimension to hang [`Density`] on.
pub(crate) struct Shape<const D: usize>;

/// The densities in a dimension.
pub(crate) trait Density<const D: usize> {
    /// `db/ds`.
    fn slope(d: &[[Lanes; D]; 3]) -> Normal;

    /// The density times its weights, not finite where the curve is irregular, and the length's plain; no derivatives.
    fn value(weights: &Weighted, target: &Normal, d: &[[Lanes; D]; 3]) -> Local<D>;

    /// The densities of variation, bending and length.
    fn integrals(d: &[[Lanes; D]; 3]) -> [Lanes; 3];

    /// The density with its derivatives.
    fn derivatives(weights: &Weighted, target: &Normal, d: &[[Lanes; D]; 3]) -> Local<D>;
}

/// Powers of `p = |C'|²`.
struct Powers {
    inverse: Lanes,
    speed: Lanes,
    inverse_speed: Lanes,
    /// `p⁻³`.
    cube: Lanes,
    /// `p^(−5/2)`.
    fifth: Lanes,
    /// `p^(−11/2)`.
    eleventh: Lanes,
}

impl Powers {
    #[inline(always)]
    fn of(p: Lanes) -> Self {
        let inverse = Lanes::ONE / p;
        let speed = p.sqrt();
        let cube = inverse * inverse * inverse;
        let fifth = cube * speed;
        Self { inverse, speed, inverse_speed: speed * inverse, cube, fifth, eleventh: fifth * cube }
    }
}
