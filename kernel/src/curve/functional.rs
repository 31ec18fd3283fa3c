//! What a curve is to minimise.

/// What a curve is to minimise. `κ` is the curvature vector in its binormal form, `L` the length.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Functional(pub u32);

impl Functional {
    /// The variation of curvature, `∫ (dκ/ds)² ds` (thesis 4.2); 1/length³.
    pub const MVC: Self = Self(0);
    /// The bending energy, `∫ κ² ds` (thesis 4.1); 1/length.
    pub const MEC: Self = Self(1);
    /// The scale-invariant MVC, `L³ ∫ (dκ/ds)² ds` (thesis 4.5): it has a minimum where the MVC grows without limit.
    pub const SI_MVC: Self = Self(2);
    /// The scale-invariant MEC, `L ∫ κ² ds`.
    pub const SI_MEC: Self = Self(3);

    /// The power of the length by which the functional's value shrinks when the shape grows.
    pub(crate) const fn scale_power(self) -> i32 {
        match self.0 {
            0 => 3,
            1 => 1,
            _ => 0,
        }
    }

    /// The power of the length by which the functional multiplies its integral; 0 where it is a plain integral.
    pub(crate) const fn length_power(self) -> i32 {
        match self.0 {
            2 => 3,
            3 => 1,
            _ => 0,
        }
    }

    /// Whether the integral is that of the bending energy.
    pub(crate) const fn bends(self) -> bool {
        matches!(self.0, 1 | 3)
    }

    /// Whether the code is one of the above.
    pub const fn is_known(self) -> bool {
        self.0 <= Self::SI_MEC.0
    }
}

/// How much of each integral a curve minimises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Weights {
    /// Of `∫ (dκ/ds)² ds`.
    pub(crate) variation: f64,
    /// Of `∫ κ² ds`.
    pub(crate) bending: f64,
    /// Of `L`.
    pub(crate) length: f64,
}

impl Weights {
    pub(crate) const VARIATION: Self = Self { variation: 1.0, bending: 0.0, length: 0.0 };
    pub(crate) const BENDING: Self = Self { variation: 0.0, bending: 1.0, length: 0.0 };

    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            variation: self.variation * factor,
            bending: self.bending * factor,
            length: self.length * factor,
        }
    }
}
