//! What an element is worth: its integrals by a finer rule than it is minimised with, and whether it is regular.

use super::fairness::{Density, Shape};
use super::guard::Guard;
use super::rows::{Mirrored, combine, place};
use crate::basis::hermite;
use crate::basis::lanes::{Lanes, WIDTH};
use crate::basis::mirrored::{pair_count, pairs};
use crate::basis::quadrature::{FINEST, MAX_POINTS};
use crate::order::Order;
use crate::root::sqrt;
use nalgebra::SVector;

/// The figures of an element or of many, by 32 Gauss–Lobatto points on each half, and on each half of that again where the
/// rule does not resolve the variation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Figures {
    /// `∫ (dκ/ds)² ds`.
    pub(super) variation: f64,
    /// `∫ κ² ds`.
    pub(super) bending: f64,
    pub(super) length: f64,
    /// What of the functional knows torsion.
    pub(super) space: f64,
    /// Elements with a cusp, or that stop.
    pub(super) irregular: usize,
}

/// Variation, bending and length of a piece, and how much of the variation's density a polynomial of half the rule's
/// degree leaves over.
struct Sums {
    integrals: [f64; 3],
    tail: f64,
}

impl Sums {
    /// `pass` is called with `C'` at the points of the rule.
    fn of<const D: usize>(rows: &[SVector<f64, D>; 6], mut pass: impl FnMut(&[[Lanes; D]; 2])) -> Self
    where
        Shape<D>: Density<D>,
    {
        let element = Mirrored::of(rows);
        let (mut sums, mut tails) = ([Lanes::ZERO; 3], [Lanes::ZERO; 2]);
        for (pairs, by) in pairs(MAX_POINTS).iter().zip(&TAILS) {
            let d = element.at(pairs);
            pass(&[d[0][0], d[1][0]]);
            let (one, other) = (Shape::integrals(&d[0]), Shape::integrals(&d[1]));
            for k in 0..3 {
                sums[k] += (one[k] + other[k]) * pairs.weight;
            }
            tails[0] += (one[0] + other[0]) * by[0];
            tails[1] += (one[0] + other[0]) * by[1];
        }
        let [one, other] = tails.map(|tail| tail.total().abs());
        Self { integrals: sums.map(Lanes::total), tail: if one > other { one } else { other } }
    }

    /// Whether the rule resolves the piece, as far as that can be told of rows with errors of this size.
    fn are_resolved(&self, blur: f64) -> bool {
        let [variation, _, length] = self.integrals;
        // The error of a slope: a third derivative is the chord times 60 and more, over the speed's cube.
        let slope = 60.0 * blur / (length * length * length);
        let noise = slope * slope * length;
        !(self.tail > RESOLVED * variation + 2.0 * sqrt(variation * noise) + noise)
    }
}

/// The degrees of the Legendre polynomials by which the tail of a density is judged: even, as their sums over mirrored
/// points are, and two, as one may vanish by chance. The rule's error is what polynomials of degree 62 and more leave over:
/// of a density that is analytic about the square of what those of half that degree do.
const TAIL_DEGREES: [usize; 2] = [24, 28];
/// A density whose tail is this part of the whole is integrated to the square of it, about.
const RESOLVED: f64 = 1e-6;
/// A half is divided into no more than two to this power.
const MOST_HALVINGS: u32 = 9;

/// The weights by which the finest rule tells how much of each of those polynomials there is.
static TAILS: [[Lanes; 2]; MAX_POINTS / 2 / WIDTH] = tails();

const fn tails() -> [[Lanes; 2]; MAX_POINTS / 2 / WIDTH] {
    let mut out = [[Lanes::ZERO; 2]; MAX_POINTS / 2 / WIDTH];
    let mut pair = 0;
    while pair < MAX_POINTS / 2 {
        let x = 2.0 * FINEST.nodes[pair] - 1.0;
        let mut k = 0;
        while k < 2 {
            let degree = TAIL_DEGREES[k];
            let (mut before, mut here, mut next) = (1.0, x, 2);
            while next <= degree {
                let n = next as f64;
                (before, here) = (here, ((2.0 * n - 1.0) * x * here - (n - 1.0) * before) / n);
                next += 1;
            }
            out[pair / WIDTH][k].0[pair % WIDTH] = FINEST.weights[pair] * here * (2 * degree + 1) as f64;
            k += 1;
        }
        pair += 1;
    }
    out
}

impl Figures {
    /// Adds an element's. `space` gives what a piece adds to what knows torsion.
    pub(super) fn add<const D: usize>(
        &mut self,
        rows: &[SVector<f64, D>; 6],
        mut space: impl FnMut(&[SVector<f64, D>; 6]) -> f64,
    ) where
        Shape<D>: Density<D>,
    {
        let blur = 2.0 * f64::EPSILON * rows.iter().fold(0.0f64, |most, row| most.larger(row.amax()));
        let mut regular = true;
        for half in halves(rows) {
            let mut guard = Guard::of(pair_count(MAX_POINTS));
            let sums = Sums::of(&half, |first| guard.pass(first));
            regular &= guard.ends_well();
            if !regular || sums.are_resolved(blur) {
                self.take(&sums, space(&half));
                continue;
            }
            // From its own start: a part's chord is not to be what two far points differ by.
            let origin = half[0];
            let [p0, v0, a0, a1, v1, p1] = half;
            let near = [p0 - origin, v0, a0, a1, v1, p1 - origin];
            // The parts in order, each as long as can be, in units of the shortest.
            const WHOLE: u32 = 1 << MOST_HALVINGS;
            let (mut at, mut long) = (0, WHOLE / 2);
            while at < WHOLE {
                let unit = 1.0 / f64::from(WHOLE);
                let part = part(&near, f64::from(at) * unit, f64::from(long) * unit);
                let sums = Sums::of(&part, |_| {});
                if long > 1 && !sums.are_resolved(blur) {
                    long /= 2;
                    continue;
                }
                self.take(&sums, space(&part));
                at += long;
                while long < WHOLE / 2 && at.is_multiple_of(2 * long) {
                    long *= 2;
                }
            }
        }
        self.irregular += usize::from(!regular);
    }

    fn take(&mut self, sums: &Sums, space: f64) {
        self.variation += sums.integrals[0];
        self.bending += sums.integrals[1];
        self.length += sums.integrals[2];
        self.space += space;
    }
}

/// The part of an element that begins at a parameter and is so long.
fn part<const D: usize>(rows: &[SVector<f64, D>; 6], from: f64, long: f64) -> [SVector<f64, D>; 6] {
    let ([p0, v0, a0], [p1, v1, a1]) = (place(rows, from), place(rows, from + long));
    [p0, v0 * long, a0 * (long * long), a1 * (long * long), v1 * long, p1]
}

/// The two halves of an element.
fn halves<const D: usize>(rows: &[SVector<f64, D>; 6]) -> [[SVector<f64, D>; 6]; 2] {
    let basis = const { hermite::basis(0.5) };
    let [p, v, a] = [0, 1, 2].map(|order: usize| combine(rows, &basis[order]));
    // A half's parameter runs half as fast: C' halves, C'' is quartered.
    let half = |p0, v0, a0, a1, v1, p1| -> [SVector<f64, D>; 6] {
        [p0, v0 * 0.5, a0 * 0.25, a1 * 0.25, v1 * 0.5, p1]
    };
    [half(rows[0], rows[1], rows[2], a, v, p), half(p, v, a, rows[3], rows[4], rows[5])]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(x: f64, y: f64) -> SVector<f64, 2> {
        SVector::from([x, y])
    }

    /// From the origin to (1, 0) with these speeds and no bend at the ends.
    fn straight(first: f64, last: f64) -> [SVector<f64, 2>; 6] {
        [row(0.0, 0.0), row(first, 0.0), row(0.0, 0.0), row(0.0, 0.0), row(last, 0.0), row(1.0, 0.0)]
    }

    fn is_regular(elements: &[[SVector<f64, 2>; 6]]) -> bool {
        let mut figures = Figures::default();
        elements.iter().for_each(|rows| figures.add(rows, |_| 0.0));
        figures.irregular == 0
    }

    /// An element that is fifty times slower at its end than at its start, and turns there: a boundary layer of an energy.
    fn sharp() -> [SVector<f64, 2>; 6] {
        [row(0.0, 0.0), row(1.0, 0.0), row(0.0, 0.4), row(0.9, -0.5), row(0.01, 0.02), row(1.0, 0.3)]
    }

    #[test]
    fn what_a_rule_does_not_resolve_is_divided() {
        let element = sharp();
        let coarse = halves(&element).map(|half| Sums::of(&half, |_| {}).integrals);
        let mut whole = Figures::default();
        whole.add(&element, |_| 0.0);
        let mut parts = Figures::default();
        const COUNT: u32 = 100;
        for k in 0..COUNT {
            let long = 1.0 / f64::from(COUNT);
            for half in halves(&part(&element, f64::from(k) * long, long)) {
                let [variation, bending, length] = Sums::of(&half, |_| {}).integrals;
                parts.variation += variation;
                parts.bending += bending;
                parts.length += length;
            }
        }
        let off = |one: f64, other: f64| (one / other - 1.0).abs();
        assert!(off(coarse[0][0] + coarse[1][0], parts.variation) > 1e-4, "the rule does as it is");
        assert!(off(whole.variation, parts.variation) < 1e-9, "{whole:?} {parts:?}");
        assert!(off(whole.bending, parts.bending) < 1e-9 && off(whole.length, parts.length) < 1e-12);
        let mut seen = 0.0;
        whole.add(&element, |piece| {
            seen += 1.0;
            piece[5][0] - piece[0][0]
        });
        assert!((whole.space - 1.0).abs() < 1e-12 && seen > 2.0, "pieces that follow on each other: {seen}");
    }

    /// A straight element far from the origin has the noise of its coordinates in its figures, at any size of its own: that
    /// does not call for division. What is sharp is divided there as it is at the origin.
    #[test]
    fn noise_of_far_coordinates_is_not_divided() {
        let along = row(1.0, 0.3);
        let gentle = [row(0.0, 0.0), along, row(0.0, 0.0), row(0.0, 0.0), along, along];
        let pieces = |rows: &[SVector<f64, 2>; 6], size: f64, away: f64| {
            let mut rows = rows.map(|row| row * size);
            for point in [0, 5] {
                rows[point] += row(0.6, -0.7) * (size * away);
            }
            let mut count = 0;
            Figures::default().add(&rows, |_| {
                count += 1;
                0.0
            });
            count
        };
        for size in [1e-3, 0.1, 1.0, 10.0, 1e3] {
            for away in [0.0, 1.0, 1e3, 1e6, 1e9] {
                assert_eq!(pieces(&gentle, size, away), 2, "{size} {away}");
            }
            for away in [0.0, 1.0, 1e3] {
                assert!(pieces(&sharp(), size, away) > 2, "{size} {away}");
            }
        }
    }

    #[test]
    fn folds_and_stops_are_irregular() {
        assert!(is_regular(&[straight(1.0, 1.0), straight(0.5, 1.2)]));
        assert!(!is_regular(&[straight(1.0, 1.0), straight(-1.0, -1.0)]), "a fold");
        assert!(!is_regular(&[straight(0.0, 1.0)]), "a start without speed");
        assert!(!is_regular(&[straight(f64::NAN, 1.0)]), "no number");
        let mut sharp = straight(1.0, 1.0);
        sharp[4] = row(1e-6, 0.0);
        sharp[3] = row(0.0, 1.0);
        assert!(!is_regular(&[sharp]), "an end that nearly stops");
    }
}
