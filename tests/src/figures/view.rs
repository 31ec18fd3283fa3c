//! From space to the page.

/// A point or a vector.
pub(super) type Vector = [f64; 3];

/// How curves are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// Along z: x to the right, y up.
    Plan,
    /// Along y: x to the right, z up.
    Front,
    /// From the front, the right and above: x to the right and near, y to the right and far, z up.
    Room,
}

impl View {
    /// To the right and up.
    pub(super) fn project(self, [x, y, z]: Vector) -> [f64; 2] {
        // The viewer of a room stands at an angle whose cosine and sine are 0.96 and 0.28, and looks down at 35°.
        match self {
            Self::Plan => [x, y],
            Self::Front => [x, z],
            Self::Room => [0.96 * x + 0.28 * y, 0.574 * (0.96 * y - 0.28 * x) + 0.819 * z],
        }
    }

    /// What is to the right and up.
    pub(super) const fn names(self) -> [&'static str; 2] {
        match self {
            Self::Plan => ["x", "y"],
            Self::Front => ["x", "z"],
            Self::Room => ["", ""],
        }
    }
}

/// A box of data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds<const D: usize> {
    pub(super) low: [f64; D],
    pub(super) high: [f64; D],
}

impl<const D: usize> Bounds<D> {
    pub(super) fn of(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        let empty = Self { low: [f64::INFINITY; D], high: [f64::NEG_INFINITY; D] };
        points.into_iter().fold(empty, |bounds, point| Self {
            low: std::array::from_fn(|d| bounds.low[d].min(point[d])),
            high: std::array::from_fn(|d| bounds.high[d].max(point[d])),
        })
    }

    pub(super) fn size(&self) -> [f64; D] {
        std::array::from_fn(|d| self.high[d] - self.low[d])
    }
}

/// `a + factor · b`
pub(super) fn add(a: Vector, factor: f64, b: Vector) -> Vector {
    std::array::from_fn(|d| a[d] + factor * b[d])
}
