//! Joints: what a designer gives, point by point (thesis 4.1 and 4.5).

use super::element::Element;
use super::obstacle::Obstacle;

/// Whether a quantity is the solver's to choose.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Given(pub u32);

impl Given {
    /// Not given: the solver finds a start value and the best value.
    pub const FREE: Self = Self(0);
    /// A start value: the solver goes on from it.
    pub const INITIAL: Self = Self(1);
    /// Kept exactly.
    pub const FIXED: Self = Self(2);
    /// Of a position: it slides on the line through the value along [`Joint::guide`]; the value is where it starts.
    pub const ON_LINE: Self = Self(3);
    /// Of a position: it slides in the plane through the value across [`Joint::guide`]; the value is where it starts.
    pub const ON_PLANE: Self = Self(4);
    /// Of a curvature: its size is kept, its direction is free. The value's direction is where it starts, if it does not
    /// run along the tangent. A planar curve keeps the side to which it bends at the start.
    pub const SIZE: Self = Self(5);
}

/// How the two elements at a joint meet.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Continuity(pub u32);

impl Continuity {
    /// A corner: tangent and curvature independent on either side.
    pub const G0: Self = Self(0);
    /// A common tangent, curvatures independent on either side.
    pub const G1: Self = Self(1);
    /// Common tangent and curvature.
    pub const G2: Self = Self(2);
}

/// A vector and what it is: free, a start value, or fixed. The value of a free quantity is not read.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Free, initial or fixed.
    pub given: Given,
    /// The vector: a position or a curvature vector in the caller's units, or a tangent of any length but zero.
    pub value: [f64; 3],
}

impl Quantity {
    /// Left to the solver.
    pub const FREE: Self = Self { given: Given::FREE, value: [0.0; 3] };

    /// A start value.
    pub const fn initial(value: [f64; 3]) -> Self {
        Self { given: Given::INITIAL, value }
    }

    /// A value that is kept.
    pub const fn fixed(value: [f64; 3]) -> Self {
        Self { given: Given::FIXED, value }
    }

    /// A curvature vector of which only the size is kept.
    pub const fn of_size(value: [f64; 3]) -> Self {
        Self { given: Given::SIZE, value }
    }
}

/// A joint: a point of the curve with what is known there.
///
/// Tangent and curvature are given for the *arriving* side (index 0) and the *leaving* side (index 1). Where the
/// continuity makes a side's quantity common (the tangent at G1 and G2, the curvature at G2), both entries must be
/// the same. The curvature vector points to the centre of curvature, has the length 1/radius and is perpendicular
/// to the tangent.
///
/// A fixed curvature at a tangent that is not fixed means its size: the direction follows the tangent (thesis Fig.
/// 4.9). In the plane the side to which the curve bends is kept as well; in space the curvature may turn about the
/// tangent.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// G0, G1 or G2.
    pub continuity: Continuity,
    /// The point.
    pub position: Quantity,
    /// The tangent direction of the arriving and the leaving side.
    pub tangent: [Quantity; 2],
    /// The curvature vector of the arriving and the leaving side.
    pub curvature: [Quantity; 2],
    /// Where the position slides: the direction of its line, or the normal of its plane; of any length but zero. Not read
    /// otherwise.
    pub guide: [f64; 3],
}

impl Joint {
    /// A G2 joint at a fixed point, tangent and curvature free.
    pub const fn at(point: [f64; 3]) -> Self {
        Self {
            continuity: Continuity::G2,
            position: Quantity::fixed(point),
            tangent: [Quantity::FREE; 2],
            curvature: [Quantity::FREE; 2],
            guide: [0.0; 3],
        }
    }

    /// The same joint sliding on a line, from `point` on.
    pub const fn on_line(self, point: [f64; 3], direction: [f64; 3]) -> Self {
        Self { position: Quantity { given: Given::ON_LINE, value: point }, guide: direction, ..self }
    }

    /// The same joint sliding in a plane, from `point` on.
    pub const fn on_plane(self, point: [f64; 3], normal: [f64; 3]) -> Self {
        Self { position: Quantity { given: Given::ON_PLANE, value: point }, guide: normal, ..self }
    }

    /// The same joint with another continuity.
    pub const fn with_continuity(self, continuity: Continuity) -> Self {
        Self { continuity, ..self }
    }

    /// The same joint with another position.
    pub const fn with_position(self, position: Quantity) -> Self {
        Self { position, ..self }
    }

    /// The same joint with this tangent on both sides.
    pub const fn with_tangent(self, tangent: Quantity) -> Self {
        Self { tangent: [tangent; 2], ..self }
    }

    /// The same joint with this curvature on both sides.
    pub const fn with_curvature(self, curvature: Quantity) -> Self {
        Self { curvature: [curvature; 2], ..self }
    }
}

/// The designer's data: joints in order along the curve.
///
/// A closed curve goes on from the last joint to the first; the first is not repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<'a> {
    /// The joints; at least two, three of a closed curve.
    pub joints: &'a [Joint],
    /// Whether the curve returns to its first joint.
    pub closed: bool,
    /// A shape whose change of curvature is this curve's aim, if any.
    pub reference: Option<Reference<'a>>,
    /// What a planar curve must keep clear of; may be empty.
    pub obstacles: &'a [Obstacle],
}

/// A reference shape (thesis 4.6): the curve minimises `∫ |dκ/ds − α dκ₀/ds|² ds` with `κ₀` the reference's curvature
/// vector at the same element and parameter.
///
/// So that the same parameter means the same place, the speed's relative change along an element is held to the reference's
/// (by a term that is `α` times the functional's natural size; it is no part of the value that is reported).
///
/// With `α = 1` and the reference's own joints the curve is the reference; joints that move deform it. As `α` sinks to
/// 0 the curve becomes the minimum variation curve: a smoothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<'a> {
    /// The reference: as many elements as the curve has.
    pub elements: &'a [Element],
    /// The weight `α`, 0 to 1.
    pub weight: f64,
}

impl<'a> Curve<'a> {
    /// A curve through joints, closed or not.
    pub const fn new(joints: &'a [Joint], closed: bool) -> Self {
        Self { joints, closed, reference: None, obstacles: &[] }
    }

    /// An open curve.
    pub const fn open(joints: &'a [Joint]) -> Self {
        Self::new(joints, false)
    }

    /// The same curve with obstacles.
    pub const fn with_obstacles(self, obstacles: &'a [Obstacle]) -> Self {
        Self { obstacles, ..self }
    }

    /// The same curve with a reference shape.
    pub const fn with_reference(self, reference: Reference<'a>) -> Self {
        Self { reference: Some(reference), ..self }
    }

    /// The number of spans: intervals between consecutive joints.
    pub const fn spans(&self) -> usize {
        if self.closed { self.joints.len() } else { self.joints.len().saturating_sub(1) }
    }
}
