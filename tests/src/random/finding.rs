//! What a judge may find, how large it may be, and how serious it is beyond that.

use minvar::curve::{FARTHEST, SHOWN_GROWTH, TRUSTED};

/// A check of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Check {
    /// Good data were refused.
    Refused,
    /// A number of the result is NaN or infinite.
    NotFinite,
    /// The status is none that a silent solve may end with, or names a limit that was not reached.
    Status,
    /// A fixed position is not kept to the last bit.
    Position,
    /// A fixed tangent's direction is off, radians.
    Tangent,
    /// A fixed curvature is off, as a fraction of its size.
    Curvature,
    /// Elements do not meet in the same point.
    Gap,
    /// Tangents of two sides differ where they should not, radians.
    Kink,
    /// Curvatures of two sides differ where they should not, as a fraction.
    CurvatureJump,
    /// Data made in a plane were not computed in it.
    Plane,
    /// Converged, but the report's length is not what the elements measure, as a fraction.
    Length,
    /// Converged, but the report's variation or bending is not what the elements measure, as a fraction.
    Figures,
    /// Converged, but the functional of the elements is not what was minimised, as a fraction.
    Value,
    /// Converged, but the functional of the elements is not what the report's finer rule says, as a fraction.
    FineValue,
    /// Converged, but the curve turns by so much (radians) between neighbours of 256 places an element.
    Cusp,
    /// Converged, but the curve is so many times as long as its data.
    Grown,
    /// Converged, but somewhere an element's speed is its mean speed divided by so much: it nearly stops.
    Slow,
    /// Converged, but by the report's own decrement the Hessian is not positive definite there: 1, or 0.
    Indefinite,
    /// Unbounded, but the curve is no longer than this part of what would show it: data lengths over length.
    NotGrown,
    /// Scaled by a power of two, another result: 1, or 0.
    PowerOfTwo,
    /// Moved and scaled without rounding, another value or another number of iterations: 1, or 0.
    ExactMove,
    /// Moved and scaled without rounding, another status: 1, or 0.
    MoveStatus,
    /// Converged, but solving on from the result lowers the functional by this fraction.
    Restart,
    /// Another size and place change the status.
    PlaceStatus,
    /// Another size and place change the functional, as a fraction.
    Place,
    /// A rotation changes the status.
    TurnStatus,
    /// A rotation changes the functional, as a fraction.
    Turn,
    /// The reversed order changes the status.
    ReverseStatus,
    /// The reversed order changes the functional, as a fraction.
    Reverse,
    /// Converged, but the reference's minimum is lower by this fraction.
    Higher,
    /// Unbounded, but a finite minimum exists.
    FalseUnbounded,
    /// Stalled or at the limit, but a minimum exists.
    Missed,
}

impl Check {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 32] = [
        Self::Refused,
        Self::NotFinite,
        Self::Status,
        Self::Position,
        Self::Tangent,
        Self::Curvature,
        Self::Gap,
        Self::Kink,
        Self::CurvatureJump,
        Self::Plane,
        Self::Length,
        Self::Figures,
        Self::Value,
        Self::FineValue,
        Self::Cusp,
        Self::Grown,
        Self::Slow,
        Self::Indefinite,
        Self::NotGrown,
        Self::PowerOfTwo,
        Self::ExactMove,
        Self::MoveStatus,
        Self::Restart,
        Self::PlaceStatus,
        Self::Place,
        Self::TurnStatus,
        Self::Turn,
        Self::ReverseStatus,
        Self::Reverse,
        Self::Higher,
        Self::FalseUnbounded,
        Self::Missed,
    ];

    /// How large it may be.
    pub const fn allowed(self) -> f64 {
        match self {
            Self::Tangent | Self::Kink => 1e-12,
            Self::Curvature | Self::CurvatureJump | Self::Length => 1e-9,
            Self::Figures
            | Self::FineValue
            | Self::Restart
            | Self::Place
            | Self::Turn
            | Self::Reverse
            | Self::Higher => 1e-6,
            // 45 degrees.
            Self::Cusp => std::f64::consts::FRAC_PI_4,
            // What the kernel promises of a converged and of an unbounded curve.
            Self::Value => TRUSTED,
            Self::Grown => FARTHEST,
            Self::Slow => 30.0,
            Self::NotGrown => 1.0 / SHOWN_GROWTH,
            _ => 0.0,
        }
    }

    /// Whether it must never be beyond what is allowed. The others may be: a functional has several minima, and which
    /// one is found may hang by rounding; they are counted.
    pub const fn is_promise(self) -> bool {
        !matches!(
            self,
            Self::Slow
                | Self::Indefinite
                | Self::Restart
                | Self::PlaceStatus
                | Self::Place
                | Self::TurnStatus
                | Self::Turn
                | Self::ReverseStatus
                | Self::Reverse
                | Self::Higher
                | Self::FalseUnbounded
                | Self::Missed
        )
    }
}

/// The largest that each check found in one result, of those that were made.
#[derive(Clone, Debug, Default)]
pub struct Findings([Option<f64>; Check::ALL.len()]);

impl Findings {
    /// Notes what a check found; NaN counts as infinite.
    pub fn note(&mut self, check: Check, size: f64) {
        let size = if size.is_nan() { f64::INFINITY } else { size };
        let slot = &mut self.0[check as usize];
        *slot = Some(slot.map_or(size, |before| before.max(size)));
    }

    /// Notes a check that holds or not.
    pub fn must(&mut self, check: Check, holds: bool) {
        self.note(check, if holds { 0.0 } else { 1.0 });
    }

    /// What a check found, if it was made.
    pub const fn of(&self, check: Check) -> Option<f64> {
        self.0[check as usize]
    }

    /// Whether a check found more than is allowed.
    pub fn beyond(&self, check: Check) -> bool {
        self.of(check).is_some_and(|size| size > check.allowed())
    }
}
