//! The larger and the smaller of two numbers.
//!
//! `f64::max` and `f64::min` may give either zero where one is 0 and the other −0, and which depends on the machine.

/// Both ignore a NaN beside a number, as `f64::max` and `f64::min` do; of two zeros they give the second.
pub(crate) trait Order {
    fn larger(self, other: Self) -> Self;
    fn smaller(self, other: Self) -> Self;
}

impl Order for f64 {
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other || other.is_nan() { self } else { other }
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if self < other || other.is_nan() { self } else { other }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_keep_their_order_and_numbers_win_over_nan() {
        let bits = |x: f64| x.to_bits();
        for (one, other) in [(0.0, -0.0), (-0.0, 0.0)] {
            assert_eq!(bits(f64::larger(one, other)), bits(other));
            assert_eq!(bits(f64::smaller(one, other)), bits(other));
        }
        assert_eq!(
            (1.0.larger(2.0), 2.0.larger(1.0), 1.0.smaller(2.0), 2.0.smaller(1.0)),
            (2.0, 2.0, 1.0, 1.0)
        );
        assert_eq!((1.0.larger(f64::NAN), f64::NAN.larger(1.0)), (1.0, 1.0));
        assert_eq!((1.0.smaller(f64::NAN), f64::NAN.smaller(1.0)), (1.0, 1.0));
        assert!(f64::NAN.larger(f64::NAN).is_nan() && f64::NAN.smaller(f64::NAN).is_nan());
    }
}
