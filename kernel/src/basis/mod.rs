//! Polynomials on [0, 1]: quadrature rules and the bases in which elements are written. Knows nothing of curves.

pub mod bernstein;
pub mod hermite;
pub(crate) mod lanes;
pub(crate) mod mirrored;
pub mod quadrature;
