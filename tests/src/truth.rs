//! True fair curves in the plane, computed without elements: what quintics only approach.
//!
//! Every span is written by its turning rate `k(u) = L κ` over the fraction `u = s / L` of its length, as a series of
//! orthonormal Legendre polynomials. Its angle is then `θ(u) = θ₀ + ∫ k`, linear in the coefficients, its end follows from
//! `L ∫ (cos θ, sin θ) du`, and
//!
//! ```text
//! E = ∫ κ² ds = Σ (1/L) ∫ k² du        V = ∫ (dκ/ds)² ds = Σ (1/L³) ∫ k'² du
//! ```
//!
//! Joints are conditions with multipliers. Newton's method on the stationarity of the Lagrangian, with exact second
//! derivatives, ends at rounding; the series converges faster than any power of its degree: 20 gives twelve digits of
//! an MVC, an elastica of few spans needs 40. Nothing here knows the kernel: no elements, no parametrisation, no
//! quadrature of densities.
//!
//! [`legendre`] has the series, [`dense`] the linear algebra, [`system`] unknowns, functional and conditions, [`newton`]
//! the iteration, [`start`] where it begins, [`shape`] what is measured at the result, [`quintic`] the elements that it is
//! started from and compared with.

#![allow(clippy::disallowed_methods, reason = "a reference may use the platform's cosine and powers")]

pub mod dense;
pub mod legendre;
pub mod newton;
pub mod quintic;
pub mod shape;
pub mod start;
pub mod system;

pub use newton::{Stalled, TrueCurve, solve};
pub use shape::Span;
pub use start::SpanStart;

/// A point of the plane.
pub type Point = [f64; 2];

/// What two spans share at their joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuity {
    /// The point.
    G0,
    /// The tangent as well.
    G1,
    /// The curvature as well.
    G2,
}

/// What is known at a joint; `[arriving, leaving]` where the sides may differ.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// The point, or where the search for it starts.
    pub position: Point,
    /// Whether the point is kept.
    pub fixed: bool,
    /// The tangent's angle in radians, where it is kept. Multiples of 2π are those nearest the start.
    pub angle: [Option<f64>; 2],
    /// The curvature, where it is kept; positive to the left.
    pub curvature: [Option<f64>; 2],
    /// What both sides share.
    pub continuity: Continuity,
}

impl Joint {
    /// A G2 joint at a fixed point, all else free.
    pub const fn at(position: Point) -> Self {
        Self { position, fixed: true, angle: [None; 2], curvature: [None; 2], continuity: Continuity::G2 }
    }

    /// The same joint with this tangent angle on both sides.
    pub const fn with_angle(self, angle: f64) -> Self {
        Self { angle: [Some(angle); 2], ..self }
    }

    /// The same joint with this curvature on both sides.
    pub const fn with_curvature(self, curvature: f64) -> Self {
        Self { curvature: [Some(curvature); 2], ..self }
    }

    /// Whether a curve through this joint is the same as one without it.
    fn is_idle(&self) -> bool {
        !self.fixed
            && self.angle == [None; 2]
            && self.curvature == [None; 2]
            && self.continuity == Continuity::G2
    }
}

/// `Lᵖ (v V + e E + t L)` with `L` the whole length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Functional {
    /// The weight `v` of the variation.
    pub variation: f64,
    /// The weight `e` of the bending energy.
    pub bending: f64,
    /// The weight `t` of the length.
    pub tension: f64,
    /// The power `p` of the length before the sum.
    pub power: i32,
}

impl Functional {
    /// The variation `V`.
    pub const MVC: Self = Self { variation: 1.0, bending: 0.0, tension: 0.0, power: 0 };
    /// The bending energy `E`.
    pub const MEC: Self = Self { variation: 0.0, bending: 1.0, tension: 0.0, power: 0 };
    /// The scale-invariant variation `L³ V`.
    pub const SI_MVC: Self = Self { power: 3, ..Self::MVC };
    /// The scale-invariant bending energy `L E`.
    pub const SI_MEC: Self = Self { power: 1, ..Self::MEC };

    /// Whether similar curves have the same value.
    fn is_scale_invariant(&self) -> bool {
        (self.variation == 0.0 || self.power == 3)
            && (self.bending == 0.0 || self.power == 1)
            && (self.tension == 0.0 || self.power == -1)
    }
}

/// The curve that is sought.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Its joints in order. The ends of an open curve must be fixed points.
    pub joints: Vec<Joint>,
    /// Whether it returns to the first joint.
    pub closed: bool,
    /// What it minimises.
    pub functional: Functional,
    /// The whole length, where it is kept.
    pub length: Option<f64>,
}

impl Problem {
    /// A problem without a fixed length.
    pub fn new(joints: impl Into<Vec<Joint>>, closed: bool, functional: Functional) -> Self {
        Self { joints: joints.into(), closed, functional, length: None }
    }

    /// The number of spans.
    pub fn spans(&self) -> usize {
        if self.closed { self.joints.len() } else { self.joints.len() - 1 }
    }

    /// The joint where a span ends.
    fn end_joint(&self, span: usize) -> usize {
        (span + 1) % self.joints.len()
    }

    /// The spans that meet at a joint, arriving and leaving.
    fn sides(&self, joint: usize) -> [Option<usize>; 2] {
        let arriving = if joint > 0 { Some(joint - 1) } else { self.closed.then(|| self.spans() - 1) };
        [arriving, (joint < self.spans()).then_some(joint)]
    }
}
