//! The functional of one element by its Hermite rows, with gradient and Hessian: each is linear in the derivatives of the
//! density times basis values, so it is summed in the rows' coordinates once and mapped to the unknowns afterwards.
//!
//! The coordinates are the chord and the four derivatives at the ends: nothing else of the rows matters. Inside they
//! are even and odd ones (see [`crate::basis::mirrored`]).

use super::fairness::{Density, Local, Normal, Shape, Weighted, add_evenness, evenness, quickening};
use super::functional::Weights;
use super::space::Tie;
use crate::basis::hermite;
use crate::basis::lanes::Lanes;
use crate::basis::mirrored::{COORDINATES, EVEN, Pairs};
use nalgebra::SVector;

/// A combination of an element's six rows: its point or a derivative, by the values of the basis.
#[inline]
pub(super) fn combine<const D: usize>(rows: &[SVector<f64, D>; 6], weights: &[f64; 6]) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for a in 0..6 {
        sum += rows[a] * weights[a];
    }
    sum
}

/// `C, C', C''` of an element at a parameter.
pub(super) fn place<const D: usize>(rows: &[SVector<f64, D>; 6], t: f64) -> [SVector<f64, D>; 3] {
    let basis = hermite::basis(t);
    [0, 1, 2].map(|order: usize| combine(rows, &basis[order]))
}

/// `C', C'', C'''` of an element at a point of a rule.
#[inline]
pub(super) fn derivatives<const D: usize>(
    rows: &[SVector<f64, D>; 6],
    basis: &[[f64; 6]; 4],
) -> [SVector<f64, D>; 3] {
    core::array::from_fn(|k| combine(rows, &basis[k + 1]))
}

/// An element in even and odd coordinates.
#[derive(Clone, Copy)]
pub(super) struct Mirrored<const D: usize>([[f64; D]; COORDINATES]);

impl<const D: usize> Mirrored<D> {
    #[inline]
    pub(super) fn of(rows: &[SVector<f64, D>; 6]) -> Self {
        let [p0, v0, a0, a1, v1, p1] = rows;
        Self([(p1 - p0).into(), (v0 + v1).into(), (a0 - a1).into(), (v0 - v1).into(), (a0 + a1).into()])
    }

    /// `C', C'', C'''` at points `t`, and `C', −C'', C'''` at `1 − t`.
    #[inline(always)]
    pub(super) fn at(&self, pairs: &Pairs) -> [[[Lanes; D]; 3]; 2] {
        let mut out = [[[Lanes::ZERO; D]; 3]; 2];
        for k in 0..3 {
            let by = &pairs.by[k];
            for x in 0..D {
                let part = |a: usize| by[a] * self.0[a][x];
                let even = part(0) + part(1) + part(2);
                let odd = part(3) + part(4);
                out[0][k][x] = even + odd;
                out[1][k][x] = even - odd;
            }
        }
        out
    }
}

/// What is summed over an element, and over which rule.
#[derive(Clone, Copy)]
pub(super) struct Integrand<const D: usize> {
    pub(super) weights: Weights,
    /// Weight of the evenness of the parametrisation.
    pub(super) gauge: f64,
    pub(super) rule: &'static [Pairs],
    /// An element whose `db/ds`, times a factor, is the target of this one's.
    pub(super) reference: Option<(Mirrored<D>, f64)>,
}

impl<const D: usize> Integrand<D>
where
    Shape<D>: Density<D>,
{
    /// What `db/ds` and the quickening are to be at points `t` and `1 − t`.
    #[inline(always)]
    fn targets(&self, pairs: &Pairs) -> ([Normal; 2], [Lanes; 2]) {
        match &self.reference {
            None => ([[Lanes::ZERO; 3]; 2], [Lanes::ZERO; 2]),
            Some((element, factor)) => {
                let d = element.at(pairs);
                let slopes = [0, 1].map(|side: usize| Shape::<D>::slope(&d[side]).map(|x| x * *factor));
                (slopes, [quickening(&d[0]), quickening(&d[1])])
            }
        }
    }

    /// The functional of an element and its length. Calls `first` with `C'` at `t` and at `1 − t`.
    #[inline]
    pub(super) fn value(
        &self,
        rows: &[SVector<f64, D>; 6],
        mut first: impl FnMut(&[[Lanes; D]; 2]),
    ) -> [f64; 2] {
        let element = Mirrored::of(rows);
        let (mut value, mut length) = (Lanes::ZERO, Lanes::ZERO);
        for pairs in self.rule {
            let d = element.at(pairs);
            first(&[d[0][0], d[1][0]]);
            let (target, pace) = self.targets(pairs);
            let weights = Weighted::by(&self.weights, pairs.weight);
            let one = Shape::value(&weights, &target[0], &d[0]);
            let other = Shape::value(&weights, &target[1], &d[1]);
            value += one.value + other.value;
            if self.gauge > 0.0 {
                value += (evenness(&d[0], pace[0]) + evenness(&d[1], pace[1])) * pairs.weight * self.gauge;
            }
            length += (one.length + other.length) * pairs.weight;
        }
        [value.total(), length.total()]
    }

    /// The functional of an element with gradient and Hessian.
    pub(super) fn derivatives(&self, rows: &[SVector<f64, D>; 6]) -> RowDerivatives<D> {
        let element = Mirrored::of(rows);
        let mut sums = Sums {
            value: Lanes::ZERO,
            length: Lanes::ZERO,
            gradient: [[Lanes::ZERO; D]; COORDINATES],
            length_gradient: [[Lanes::ZERO; D]; COORDINATES],
            hessian: [[[[Lanes::ZERO; D]; D]; COORDINATES]; COORDINATES],
        };
        for pairs in self.rule {
            let d = element.at(pairs);
            let (target, pace) = self.targets(pairs);
            let weights = Weighted::by(&self.weights, pairs.weight);
            let mut one = Shape::derivatives(&weights, &target[0], &d[0]);
            let mut other = Shape::derivatives(&weights, &target[1], &d[1]);
            if self.gauge > 0.0 {
                add_evenness(pairs.weight * self.gauge, &d[0], pace[0], &mut one);
                add_evenness(pairs.weight * self.gauge, &d[1], pace[1], &mut other);
            }
            sums.add(pairs, &one, &other);
        }
        sums.unfold()
    }
}

struct Sums<const D: usize> {
    value: Lanes,
    length: Lanes,
    gradient: [[Lanes; D]; COORDINATES],
    length_gradient: [[Lanes; D]; COORDINATES],
    /// Blocks `[a][b]`, `b <= a`.
    hessian: [[[[Lanes; D]; D]; COORDINATES]; COORDINATES],
}

impl<const D: usize> Sums<D> {
    #[inline(always)]
    fn add(&mut self, pairs: &Pairs, one: &Local<D>, other: &Local<D>) {
        let (weight, by) = (pairs.weight, &pairs.by);
        self.value += one.value + other.value;
        self.length += (one.length + other.length) * weight;
        for x in 0..D {
            let mut sum = [Lanes::ZERO; 3];
            let mut difference = [Lanes::ZERO; 3];
            for k in 0..3 {
                let (a, b) = (one.gradient[k][x], other.gradient[k][x]);
                sum[k] = a + b;
                difference[k] = a - b;
            }
            let (a, b) = (one.length_gradient[x] * weight, other.length_gradient[x] * weight);
            let length = [a + b, a - b];
            for a in 0..COORDINATES {
                let g = if a < EVEN { &sum } else { &difference };
                self.gradient[a][x] += g[0] * by[0][a] + g[1] * by[1][a] + g[2] * by[2][a];
                self.length_gradient[a][x] += length[usize::from(a >= EVEN)] * by[0][a];
            }
        }
        // The whole symmetric matrices of sums and of differences.
        let mut sum = [[[[Lanes::ZERO; D]; D]; 3]; 3];
        let mut difference = sum;
        for k in 0..3 {
            for l in 0..=k {
                for x in 0..D {
                    for y in 0..D {
                        let a = one.hessian[k][l][x][y];
                        let b = other.hessian[k][l][x][y];
                        sum[k][l][x][y] = a + b;
                        sum[l][k][y][x] = a + b;
                        difference[k][l][x][y] = a - b;
                        difference[l][k][y][x] = a - b;
                    }
                }
            }
        }
        for b in 0..COORDINATES {
            let last = if b < EVEN { EVEN } else { COORDINATES };
            for y in 0..D {
                let own = column(&sum, by, b, y);
                for a in b..last {
                    for x in 0..D {
                        self.hessian[a][b][x][y] += across(&own, by, a, x);
                    }
                }
                if b < EVEN {
                    let mixed = column(&difference, by, b, y);
                    for a in EVEN..COORDINATES {
                        for x in 0..D {
                            self.hessian[a][b][x][y] += across(&mixed, by, a, x);
                        }
                    }
                }
            }
        }
    }

    /// From even and odd coordinates to the rows at the two ends.
    fn unfold(&self) -> RowDerivatives<D> {
        let mut out = RowDerivatives {
            cost: self.value.total(),
            length: self.length.total(),
            gradient: unfold_vector(&self.gradient),
            length_gradient: unfold_vector(&self.length_gradient),
            hessian: [[[[0.0; D]; D]; COORDINATES]; COORDINATES],
            ties: [Tie::NONE; 2],
        };
        // First over the columns, then over the rows.
        for x in 0..D {
            for y in 0..D {
                let entry = |a: usize, b: usize| {
                    if b <= a { self.hessian[a][b][x][y].total() } else { self.hessian[b][a][y][x].total() }
                };
                let mut half = [[0.0; COORDINATES]; COORDINATES];
                for a in 0..COORDINATES {
                    half[a] = unfold_row(&[entry(a, 0), entry(a, 1), entry(a, 2), entry(a, 3), entry(a, 4)]);
                }
                for b in 0..COORDINATES {
                    let full = unfold_row(&[half[0][b], half[1][b], half[2][b], half[3][b], half[4][b]]);
                    for a in 0..COORDINATES {
                        out.hessian[a][b][x][y] = full[a];
                    }
                }
            }
        }
        out
    }
}

/// The matrix `of` by derivatives, times the motion of coordinate `b` along axis `y`.
#[inline(always)]
fn column<const D: usize>(
    of: &[[[[Lanes; D]; D]; 3]; 3],
    by: &[[Lanes; COORDINATES]; 3],
    b: usize,
    y: usize,
) -> [[Lanes; D]; 3] {
    let mut out = [[Lanes::ZERO; D]; 3];
    for k in 0..3 {
        for x in 0..D {
            out[k][x] = of[k][0][x][y] * by[0][b] + of[k][1][x][y] * by[1][b] + of[k][2][x][y] * by[2][b];
        }
    }
    out
}

/// The part of a column along axis `x` of coordinate `a`.
#[inline(always)]
fn across<const D: usize>(
    column: &[[Lanes; D]; 3],
    by: &[[Lanes; COORDINATES]; 3],
    a: usize,
    x: usize,
) -> Lanes {
    column[0][x] * by[0][a] + column[1][x] * by[1][a] + column[2][x] * by[2][a]
}

/// `chord, C'(0) + C'(1), C''(0) − C''(1), C'(0) − C'(1), C''(0) + C''(1)` to `chord, C'(0), C''(0), C''(1), C'(1)`.
#[inline(always)]
fn unfold_row(x: &[f64; COORDINATES]) -> [f64; COORDINATES] {
    [x[0], x[1] + x[3], x[4] + x[2], x[4] - x[2], x[1] - x[3]]
}

#[inline(always)]
fn unfold_vector<const D: usize>(x: &[[Lanes; D]; COORDINATES]) -> [[f64; D]; COORDINATES] {
    let mut out = [[0.0; D]; COORDINATES];
    for d in 0..D {
        let total = |a: usize| x[a][d].total();
        let row = unfold_row(&[total(0), total(1), total(2), total(3), total(4)]);
        for a in 0..COORDINATES {
            out[a][d] = row[a];
        }
    }
    out
}

/// The cost of an element with gradient and Hessian by `chord, C'(0), C''(0), C''(1), C'(1)`, and its length with
/// gradient.
pub(super) struct RowDerivatives<const D: usize> {
    pub(super) cost: f64,
    pub(super) length: f64,
    pub(super) gradient: [[f64; D]; COORDINATES],
    pub(super) length_gradient: [[f64; D]; COORDINATES],
    pub(super) hessian: [[[[f64; D]; D]; COORDINATES]; COORDINATES],
    /// What the torsions of the nodes at the two ends do.
    pub(super) ties: [Tie<D>; 2],
}
