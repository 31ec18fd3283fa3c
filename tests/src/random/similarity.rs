//! Maps that keep shapes: turn, scale, move; and the other direction along the curve.

use super::dice::{Dice, rotated};
use crate::curves::{Vector, add, times};
use minvar::curve::{Joint, Quantity};

/// First turned, then scaled, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// How it turns.
    pub turn: Turn,
    /// What lengths are multiplied by.
    pub scale: f64,
    /// What is added at last.
    pub shift: Vector,
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// None.
    None,
    /// The axes exchanged in a circle, so many times: no digit changes.
    Axes(usize),
    /// About an axis by an angle.
    About(Vector, f64),
}

impl Similarity {
    /// Everything stays where it is.
    pub const IDENTITY: Self = Self { turn: Turn::None, scale: 1.0, shift: [0.0; 3] };

    /// A rotation by any angle about any axis.
    pub fn any_turn(dice: &mut Dice) -> Self {
        Self { turn: Turn::About(dice.direction(), dice.angle()), ..Self::IDENTITY }
    }

    fn vector(&self, v: Vector) -> Vector {
        match self.turn {
            Turn::None => v,
            Turn::Axes(times) => std::array::from_fn(|d| v[(d + times) % 3]),
            Turn::About(axis, angle) => rotated(v, axis, angle),
        }
    }

    fn point(&self, p: Vector) -> Vector {
        add(times(self.vector(p), self.scale), self.shift)
    }

    /// The image of joints.
    pub fn joints(&self, joints: &[Joint]) -> Vec<Joint> {
        joints
            .iter()
            .map(|joint| Joint {
                position: Quantity { value: self.point(joint.position.value), ..joint.position },
                tangent: joint.tangent.map(|t| Quantity { value: self.vector(t.value), ..t }),
                curvature: joint
                    .curvature
                    .map(|k| Quantity { value: times(self.vector(k.value), 1.0 / self.scale), ..k }),
                ..*joint
            })
            .collect()
    }
}

/// The joints of the same curve gone through in the other direction.
pub fn reversed(joints: &[Joint]) -> Vec<Joint> {
    let back = |joint: &Joint| {
        let [arriving, leaving] = joint.tangent.map(|t| Quantity { value: times(t.value, -1.0), ..t });
        let [before, after] = joint.curvature;
        Joint { tangent: [leaving, arriving], curvature: [after, before], ..*joint }
    };
    joints.iter().rev().map(back).collect()
}
