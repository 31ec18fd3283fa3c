//! Cusps that a quadrature rule does not see.

use crate::basis::lanes::{Lanes, WIDTH};

/// Squares of speeds whose ratio is below this are those of a curve that stops.
const STOPS: f64 = 1e-4;

/// Watches the direction of a curve from either end inwards: it must turn by less than a right angle from each point of
/// the rule to the next, and its speed must change by less than a factor of a hundred.
pub(super) struct Guard<const D: usize> {
    /// The pairs of points that are still to come.
    pairs: usize,
    last: Option<[[f64; D]; 2]>,
    good: bool,
}

impl<const D: usize> Guard<D> {
    /// For so many pairs of points.
    pub(super) const fn of(pairs: usize) -> Self {
        Self { pairs, last: None, good: true }
    }

    #[inline]
    fn forward(a: &[f64; D], b: &[f64; D]) -> bool {
        let (mut along, mut one, mut other) = (0.0, 0.0, 0.0);
        for d in 0..D {
            along += a[d] * b[d];
            one += a[d] * a[d];
            other += b[d] * b[d];
        }
        along > 0.0 && one > STOPS * other && other > STOPS * one
    }

    #[inline]
    pub(super) fn pass(&mut self, first: &[[Lanes; D]; 2]) {
        for lane in 0..WIDTH {
            if self.pairs == 0 {
                return;
            }
            self.pairs -= 1;
            let here = first.map(|side| side.map(|x| x.0[lane]));
            if let Some(last) = &self.last {
                self.good &= Self::forward(&last[0], &here[0]) && Self::forward(&last[1], &here[1]);
            }
            self.last = Some(here);
        }
    }

    /// The two innermost points are neighbours too.
    pub(super) fn ends_well(&self) -> bool {
        self.good && self.last.is_none_or(|last| Self::forward(&last[0], &last[1]))
    }
}
