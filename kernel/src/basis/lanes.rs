//! Two numbers side by side: arithmetic laid out for a compiler's vector units.
//!
//! Every operation acts on each number by itself, in the order in which it is written, so that the result has the same
//! bits whether a machine does both at once or one after the other.

use crate::root::sqrt_pair;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// How many numbers stand side by side: as many as the smallest vector unit takes.
pub(crate) const WIDTH: usize = 2;

/// Numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct Lanes(pub(crate) [f64; WIDTH]);

impl Lanes {
    pub(crate) const ZERO: Self = Self([0.0; WIDTH]);
    pub(crate) const ONE: Self = Self([1.0; WIDTH]);

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        Self(sqrt_pair(self.0))
    }

    /// The sum of all, first to last.
    #[inline(always)]
    pub(crate) fn total(self) -> f64 {
        self.0[0] + self.0[1]
    }
}

macro_rules! each {
    ($name:ident, $method:ident, $operator:tt) => {
        impl $name for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self([self.0[0] $operator other.0[0], self.0[1] $operator other.0[1]])
            }
        }

        impl $name<f64> for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self([self.0[0] $operator other, self.0[1] $operator other])
            }
        }
    };
}

each!(Add, add, +);
each!(Sub, sub, -);
each!(Mul, mul, *);
each!(Div, div, /);

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self.0[0], -self.0[1]])
    }
}
