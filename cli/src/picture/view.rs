//! From space to the page.

use crate::trace::{Plane, Trace, Vector};

/// How a curve is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// At right angles to the coordinate plane that it keeps to.
    Plane(Plane),
    /// From the front, the right and above: x to the right and near, y to the right and far, z up. No special
    /// direction (isometric, 45°), along which symmetric curves would hide behind themselves.
    Space,
}

impl View {
    pub(super) fn of(trace: &Trace) -> Self {
        trace.plane.map_or(Self::Space, Self::Plane)
    }

    /// To the right and up, in the curve's own unit.
    pub(super) fn project(self, p: Vector) -> [f64; 2] {
        // The viewer stands at an angle whose cosine and sine are 0.8 and 0.6, and looks down at 30°.
        const SIN: f64 = 0.5;
        const COS: f64 = 0.866_025_403_784_438_6;
        match self {
            Self::Plane(plane) => {
                let [u, v, _] = plane.axes();
                [p[u], p[v]]
            }
            Self::Space => [0.8 * p[0] + 0.6 * p[1], SIN * (0.8 * p[1] - 0.6 * p[0]) + COS * p[2]],
        }
    }

    /// The names of the coordinates to the right and up, of a plane.
    pub(super) fn names(self) -> Option<[&'static str; 2]> {
        match self {
            Self::Plane(plane) => {
                let [u, v, _] = plane.axes();
                Some([u, v].map(|d| ["x", "y", "z"][d]))
            }
            Self::Space => None,
        }
    }
}
