//! What a curve must keep clear of.

/// The side of a curve, seen in the direction in which it runs.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side(pub u32);

impl Side {
    /// The obstacle lies to the left of the curve: about the plane's normal, which is +z, +x or +y where the data lie in a
    /// coordinate plane and else has its largest coordinate positive.
    pub const LEFT: Self = Self(0);
    /// The obstacle lies to the right of the curve.
    pub const RIGHT: Self = Self(1);

    /// 1 to the left, −1 to the right.
    pub(super) fn sign(self) -> f64 {
        if self == Self::LEFT { 1.0 } else { -1.0 }
    }
}

/// A point or a segment that a planar curve must leave on one side, at a distance.
///
/// Where the curve would come too near it gets a *contact*: a node that rolls around the obstacle's end, or slides along
/// the segment, at just that distance. Contacts are taken up and given up one by one (an active set) until nothing is too
/// near and every contact pushes. At a contact position, tangent and curvature are continuous, as at a joint. What an open
/// curve does not pass, as it lies beyond the lines across its ends, is no obstacle to it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// One end of the segment.
    pub from: [f64; 3],
    /// The other; the same for a point.
    pub to: [f64; 3],
    /// The distance that is kept, 0 or more.
    pub clearance: f64,
    /// The side of the curve on which the obstacle stays.
    pub side: Side,
}

impl Obstacle {
    /// A point.
    pub const fn point(at: [f64; 3], clearance: f64, side: Side) -> Self {
        Self { from: at, to: at, clearance, side }
    }

    /// A segment.
    pub const fn segment(from: [f64; 3], to: [f64; 3], clearance: f64, side: Side) -> Self {
        Self { from, to, clearance, side }
    }
}
