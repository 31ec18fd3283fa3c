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

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a curve with these derivatives at the points of a rule, in their order, passes. Points are looked at from
    /// both ends, `WIDTH` pairs at a time; lanes behind the last pair hold what nobody may look at.
    fn passes<const N: usize>(firsts: [[f64; 2]; N]) -> bool {
        let pairs = N / 2;
        let mut guard = Guard::<2>::of(pairs);
        for begin in (0..pairs).step_by(WIDTH) {
            let lane = |end: usize, d: usize| {
                Lanes(core::array::from_fn(|lane| {
                    let pair = begin + lane;
                    if pair >= pairs {
                        return f64::NAN;
                    }
                    firsts[if end == 0 { pair } else { N - 1 - pair }][d]
                }))
            };
            guard.pass(&[0, 1].map(|end| [0, 1].map(|d| lane(end, d))));
        }
        guard.ends_well()
    }

    #[test]
    fn a_curve_that_turns_back_or_stops_between_any_two_points_does_not_pass() {
        const N: usize = 10;
        let even: [[f64; 2]; N] = core::array::from_fn(|k| {
            let angle = 0.9 * k as f64;
            [2.0 * libm::cos(angle), 2.0 * libm::sin(angle)]
        });
        assert!(passes(even));
        for k in 1..N {
            // From this point on it runs the other way, across, or a little less than across.
            let turned = |sine: f64, cosine: f64| {
                let mut firsts = even;
                for later in k..N {
                    let [x, y] = firsts[later];
                    firsts[later] = [cosine * x - sine * y, sine * x + cosine * y];
                }
                passes(firsts)
            };
            assert!(!turned(0.0, -1.0) && !turned(libm::sin(1.0), libm::cos(1.0)), "{k}");
            assert!(
                turned(libm::sin(0.6), libm::cos(0.6)) && turned(libm::sin(-2.4), libm::cos(-2.4)),
                "{k}"
            );
            // Or is so many times as fast.
            for (factor, good) in [(90.0, true), (1.0 / 90.0, true), (110.0, false), (1.0 / 110.0, false)] {
                let mut firsts = even;
                firsts[k..].iter_mut().flatten().for_each(|x| *x *= factor);
                assert_eq!(passes(firsts), good, "{k} {factor}");
            }
        }
        let mut stops = even;
        stops[4] = [0.0; 2];
        assert!(!passes(stops));
    }
}
