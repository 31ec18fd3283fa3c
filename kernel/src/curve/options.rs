//! How a curve is to be computed.

use super::error::{CurveError, OptionName};
use super::functional::Functional;

/// The options of a curve. [`Options::DEFAULT`] suits nearly all.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// What is minimised. Default MVC.
    pub functional: Functional,
    /// A weight times the length is added to the functional: a tension. In the functional's unit over a length, 0 or
    /// more; 0 with a scale-invariant functional. Default 0.
    pub tension: f64,
    /// A weight times the bending energy `∫ κ² ds` is added to the functional. In the functional's unit times a length, 0
    /// or more; 0 with a scale-invariant functional. Default 0.
    pub bending: f64,
    /// Elements between two joints, 1 to 1024 (thesis 4.6). One is normally enough to be fair, more approach the
    /// true curve. Default 1.
    pub elements_per_span: u32,
    /// The length of the curve, which a converged one has to a millionth ([`super::LENGTH_TRUSTED`]); 0 leaves it free.
    /// Default 0.
    pub length: f64,
    /// How far the curve may be from the true minimum, a length: spans are divided further until an estimate is below it,
    /// into at most `elements_per_span` elements each. 0 takes just `elements_per_span`. Default 0.
    pub tolerance: f64,
    /// Gauss–Lobatto points an element, 12 to 32; 0 takes 16 as long as no more are needed and 32 where they tell a
    /// difference. Fewer than 20 can be cheated by an optimiser, which shows when the result is measured. Space curves
    /// whose torsion counts take 32 at once. Default 0.
    pub quadrature_points: u32,
    /// The largest number of iterations (trial steps). Default 500.
    pub max_iterations: u32,
    /// 2 for a planar curve, 3 for a space curve, 0 to find out: planar where all data lie in a plane. Default 0.
    pub dimension: u32,
    /// Stages of a continuation that starts under tension (thesis 4.10): each solves with a tenth of the tension of the one
    /// before, the first with one that outweighs the functional; the last solution is where the search without it
    /// starts. It leads to the minimum of shortest length where start values alone lead elsewhere. At most 16. Default 0.
    pub continuation: u32,
    /// The curve has converged when a Newton step promises to lower the functional by less than this fraction, or when
    /// 20 iterations together lowered it by less than a thousand times that; up to two more steps polish it. Of a
    /// functional that vanishes: this fraction of a thousandth of what a bend by a radian on every chord costs. Above
    /// 1e-9 it has, too, when no step as long as an element's speed promises more, though the Hessian is not positive
    /// definite; and no other minima of single elements are looked for. 0 asks for as much as the arithmetic gives.
    /// Default 1e-12.
    pub relative_decrease: f64,
}

impl Options {
    /// The defaults named at each field.
    pub const DEFAULT: Self = Self {
        functional: Functional::MVC,
        tension: 0.0,
        bending: 0.0,
        elements_per_span: 1,
        length: 0.0,
        tolerance: 0.0,
        quadrature_points: 0,
        max_iterations: 500,
        dimension: 0,
        continuation: 0,
        relative_decrease: 1e-12,
    };

    pub(crate) fn check(&self) -> Result<(), CurveError> {
        let bad = |option| Err(CurveError::BadOption(option));
        if !self.functional.is_known() {
            return bad(OptionName::Functional);
        }
        let plain = self.functional.length_power() == 0;
        for (weight, name) in [(self.tension, OptionName::Tension), (self.bending, OptionName::Bending)] {
            if !(weight == 0.0 || (plain && weight > 0.0 && weight.is_finite())) {
                return bad(name);
            }
        }
        if !(1..=1024).contains(&self.elements_per_span) {
            return bad(OptionName::ElementsPerSpan);
        }
        if !(self.quadrature_points == 0 || (12..=32).contains(&self.quadrature_points)) {
            return bad(OptionName::QuadraturePoints);
        }
        if self.continuation > 16 {
            return bad(OptionName::Continuation);
        }
        if !matches!(self.dimension, 0 | 2 | 3) {
            return bad(OptionName::Dimension);
        }
        for (length, name) in [(self.length, OptionName::Length), (self.tolerance, OptionName::Tolerance)] {
            if !(length >= 0.0 && length.is_finite()) {
                return bad(name);
            }
        }
        if !(0.0..1.0).contains(&self.relative_decrease) {
            return bad(OptionName::RelativeDecrease);
        }
        Ok(())
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}
