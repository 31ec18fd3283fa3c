//! What a curve is to minimise.

use super::torsion::SpaceFunctional;

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
    /// The variation of curvature and torsion, `∫ (dκ/ds)² + (dτ/ds)² ds` with the scalar curvature `κ` (thesis 4.4);
    /// 1/length³. It vanishes on helices. At G2 joints torsion is continuous too, to 1e-8 of itself or of the typical
    /// curvature. Planar data: the MVC.
    ///
    /// Torsion is undefined where curvature vanishes. A curve whose curvature falls below a hundredth of what is typical
    /// of its start (the root of its mean square) counts torsion as `τ κ²/(κ² + ε²)` with `ε` a tenth of that typical
    /// curvature; any other counts it as it is.
    pub const SPACE_MVC: Self = Self(4);
    /// The energy of bending and twisting, `∫ κ² + τ² ds` (thesis 4.3); 1/length. Torsion counts as in
    /// [`Functional::SPACE_MVC`]; it may jump at joints. Planar data: the MEC.
    pub const SPACE_MEC: Self = Self(5);

    /// The power of the length by which the functional's value shrinks when the shape grows.
    pub(crate) const fn scale_power(self) -> i32 {
        match self.0 {
            0 | 4 => 3,
            1 | 5 => 1,
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
        matches!(self.0, 1 | 3 | 5)
    }

    /// What of space curves it minimises where torsion counts.
    pub(crate) const fn of_space(self) -> Option<SpaceFunctional> {
        match self.0 {
            4 => Some(SpaceFunctional::Mvc),
            5 => Some(SpaceFunctional::Mec),
            _ => None,
        }
    }

    /// Whether the code is one of the above.
    pub const fn is_known(self) -> bool {
        self.0 <= Self::SPACE_MEC.0
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
    pub(crate) const NONE: Self = Self { variation: 0.0, bending: 0.0, length: 0.0 };
    pub(crate) const BENDING: Self = Self { variation: 0.0, bending: 1.0, length: 0.0 };

    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            variation: self.variation * factor,
            bending: self.bending * factor,
            length: self.length * factor,
        }
    }
}
