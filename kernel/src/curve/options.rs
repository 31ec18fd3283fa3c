//! How a curve is to be computed.

use super::error::{CurveError, OptionName};
use super::fairness::Functional;

/// The options of a curve. [`Options::DEFAULT`] suits nearly all.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// What is minimised. Default MVC.
    pub functional: Functional,
    /// Elements between two joints, 1 to 1024 (thesis 4.6). One is normally enough to be fair, more approach the
    /// true curve. Default 1.
    pub elements_per_span: u32,
    /// Gauss–Lobatto points an element, 12 to 32. Fewer than 20 can be cheated by an optimiser. Default 32.
    pub quadrature_points: u32,
    /// The largest number of iterations (trial steps). Default 500.
    pub max_iterations: u32,
    /// 2 for a planar curve, 3 for a space curve, 0 to find out: planar where all data lie in a plane. Default 0.
    pub dimension: u32,
    /// The curve has converged when a Newton step promises to lower the functional by less than this fraction, or when
    /// 20 iterations together lowered it by less than a thousand times that; up to two more steps polish it. 0 asks for
    /// as much as the arithmetic gives. Default 1e-12.
    pub relative_decrease: f64,
}

impl Options {
    /// The defaults named at each field.
    pub const DEFAULT: Self = Self {
        functional: Functional::MVC,
        elements_per_span: 1,
        quadrature_points: 32,
        max_iterations: 500,
        dimension: 0,
        relative_decrease: 1e-12,
    };

    pub(crate) fn check(&self) -> Result<(), CurveError> {
        let bad = |option| Err(CurveError::BadOption(option));
        if !self.functional.is_known() {
            return bad(OptionName::Functional);
        }
        if !(1..=1024).contains(&self.elements_per_span) {
            return bad(OptionName::ElementsPerSpan);
        }
        if !(12..=32).contains(&self.quadrature_points) {
            return bad(OptionName::QuadraturePoints);
        }
        if !matches!(self.dimension, 0 | 2 | 3) {
            return bad(OptionName::Dimension);
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
