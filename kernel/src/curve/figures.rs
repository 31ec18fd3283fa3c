//! What an element is worth: its integrals by a finer rule than it is minimised with, and whether it is regular.

use super::fairness::{Density, Shape};
use super::guard::Guard;
use super::rows::{Mirrored, combine};
use crate::basis::hermite;
use crate::basis::lanes::Lanes;
use crate::basis::mirrored::{pair_count, pairs};
use crate::basis::quadrature::MAX_POINTS;
use nalgebra::SVector;

/// The figures of an element or of many, by 32 Gauss–Lobatto points on each half.
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

impl Figures {
    /// Adds an element's.
    pub(super) fn add<const D: usize>(&mut self, rows: &[SVector<f64, D>; 6])
    where
        Shape<D>: Density<D>,
    {
        let mut regular = true;
        for half in halves(rows) {
            let element = Mirrored::of(&half);
            let mut guard = Guard::of(pair_count(MAX_POINTS));
            let mut sums = [Lanes::ZERO; 3];
            for pairs in pairs(MAX_POINTS) {
                let d = element.at(pairs);
                guard.pass(&[d[0][0], d[1][0]]);
                let (one, other) = (Shape::integrals(&d[0]), Shape::integrals(&d[1]));
                for k in 0..3 {
                    sums[k] += (one[k] + other[k]) * pairs.weight;
                }
            }
            self.variation += sums[0].total();
            self.bending += sums[1].total();
            self.length += sums[2].total();
            regular &= guard.ends_well();
        }
        self.irregular += usize::from(!regular);
    }
}

/// The two halves of an element.
pub(super) fn halves<const D: usize>(rows: &[SVector<f64, D>; 6]) -> [[SVector<f64, D>; 6]; 2] {
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
        elements.iter().for_each(|rows| figures.add(rows));
        figures.irregular == 0
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
