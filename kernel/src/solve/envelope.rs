//! A symmetric matrix stored by the envelope of its lower triangle, and its Cholesky factor.
//!
//! Row `r` keeps its entries from its first column that may be non-zero to the diagonal. The factor of a positive
//! definite matrix fills nothing outside the envelope. A matrix with one negative eigenvalue, to which something
//! else is added that makes it positive again, is `L D Lᵀ` with a single −1 in the diagonal `D`.

use super::problem::packed_len;
use super::workspace::Indices;
use crate::basis::lanes::{Lanes, WIDTH};
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;

/// The shape of an envelope.
#[derive(Clone, Copy)]
pub(crate) enum Envelope<'a, 'w> {
    /// At which column each row begins, and where it stands.
    Rows { first: &'a Indices<'w>, start: &'a Indices<'w> },
    /// So many whole rows, one after the other.
    Full(usize),
}

/// What a factorisation found.
#[derive(Clone, Copy, PartialEq, Default)]
pub(crate) struct Factored {
    /// The row whose pivot is negative, if there is one.
    pub(crate) negative: Option<usize>,
}

/// Which matrices are factored.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Allow {
    /// Positive definite ones.
    Definite,
    /// Those with one negative eigenvalue too.
    OneNegative,
}

/// Where a factorisation stopped: the matrix is not positive definite, or has more negative eigenvalues than are allowed.
pub(crate) struct Indefinite {
    /// The row whose pivot is not positive.
    pub(crate) row: usize,
    /// That pivot, 0 or negative, or not a number.
    pub(crate) pivot: f64,
}

/// How well a pivot is known, as a fraction of its matrix entry.
const PIVOT_ROUNDING: f64 = 1e-14;
/// How well a pivot is known, as a fraction of the matrix's norm.
const NORM_ROUNDING: f64 = 1e-16;
/// A negative pivot that is smaller than this part of its matrix entry would spoil the digits of all others.
const LEAST_NEGATIVE: f64 = 1e-8;
/// The inverse pivot of a direction without effect.
const IMMOVABLE: f64 = 1e-100;

impl Envelope<'_, '_> {
    #[inline]
    pub(crate) fn rows(&self) -> usize {
        match self {
            Self::Rows { first, .. } => first.len(),
            Self::Full(rows) => *rows,
        }
    }

    /// Row `r` as its first column and where it starts in the stored entries.
    #[inline]
    fn place(&self, r: usize) -> (usize, usize) {
        match self {
            Self::Rows { first, start } => (first.get(r), start.get(r)),
            Self::Full(_) => (0, packed_len(r)),
        }
    }

    /// Row `r` as its first column and its range in the stored entries.
    #[inline]
    fn row(&self, r: usize) -> (usize, core::ops::Range<usize>) {
        let (first, start) = self.place(r);
        (first, start..start + (r - first) + 1)
    }

    /// Adds to the entry in row `r`, column `c`, `c <= r`.
    #[inline]
    pub(crate) fn add(&self, matrix: &mut [f64], r: usize, c: usize, value: f64) {
        let (first, range) = self.row(r);
        matrix.add(range.start + c - first, value);
    }

    /// Makes a row, and its column, that of an unknown which stands alone.
    pub(crate) fn isolate(&self, matrix: &mut [f64], r: usize) {
        let (_, range) = self.row(r);
        matrix.part_mut(range.clone()).fill(0.0);
        matrix.put(range.end - 1, 1.0);
        for below in r + 1..self.rows() {
            let (first, range) = self.row(below);
            if first <= r {
                matrix.put(range.start + r - first, 0.0);
            }
        }
    }

    /// The largest absolute row sum: a bound on the matrix's eigenvalues (Gershgorin). `sums` is scratch.
    pub(crate) fn norm(&self, matrix: &[f64], sums: &mut [f64]) -> f64 {
        sums.fill(0.0);
        for r in 0..self.rows() {
            let (first, range) = self.row(r);
            let mut own = 0.0;
            for (c, value) in (first..).zip(matrix.part(range)) {
                own += value.abs();
                if c < r {
                    sums.add(c, value.abs());
                }
            }
            sums.add(r, own);
        }
        sums.iter().fold(0.0, |most, &sum| most.larger(sum))
    }

    /// The product `out = matrix · vector`.
    pub(crate) fn multiply(&self, matrix: &[f64], vector: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for r in 0..self.rows() {
            let (first, range) = self.row(r);
            let mut sum = 0.0;
            for (c, value) in (first..).zip(matrix.part(range)) {
                sum += value * vector.at(c);
                if c < r {
                    out.add(c, value * vector.at(r));
                }
            }
            out.add(r, sum);
        }
    }

    /// Factors `matrix + shift · I` into `factor`, row by row. In the diagonal stand the inverse pivots: dividing is slow.
    ///
    /// A pivot that is nothing but rounding, by what was subtracted to get it and by `norm`, the size of the whole
    /// matrix, belongs to a direction in which nothing changes (the parametrisation of a straight span, a motion of
    /// the whole shape). It is made so large that a solution has no part along it.
    pub(crate) fn factor(
        &self,
        matrix: &[f64],
        norm: f64,
        shift: f64,
        allow: Allow,
        factor: &mut [f64],
    ) -> Result<Factored, Indefinite> {
        // One loop for each shape: which it is need not be asked for every entry.
        match self {
            Self::Rows { first, start } => {
                factor_by(first.len(), |r| (first.get(r), start.get(r)), matrix, norm, shift, allow, factor)
            }
            Self::Full(rows) => factor_by(*rows, |r| (0, packed_len(r)), matrix, norm, shift, allow, factor),
        }
    }

    /// Solves `matrix · y = x` in place.
    pub(crate) fn solve(&self, factor: &[f64], factored: Factored, x: &mut [f64]) {
        self.forward(factor, x);
        if let Some(n) = factored.negative {
            x.put(n, -x.at(n));
        }
        self.backward(factor, x, self.rows());
    }

    /// Solves `L y = x` in place.
    pub(crate) fn forward(&self, factor: &[f64], x: &mut [f64]) {
        for r in 0..self.rows() {
            let (first, range) = self.row(r);
            let Some((inverse_pivot, row)) = factor.part(range).split_last() else { break };
            let Some((value, known)) = x.part_mut(first..=r).split_last_mut() else { break };
            *value = (*value - dot(row, known)) * inverse_pivot;
        }
    }

    /// Solves `Lᵀ y = x` in place, over the first `rows` rows.
    fn backward(&self, factor: &[f64], x: &mut [f64], rows: usize) {
        for r in (0..rows).rev() {
            let (first, range) = self.row(r);
            let Some((inverse_pivot, row)) = factor.part(range).split_last() else { break };
            let Some((value, targets)) = x.part_mut(first..=r).split_last_mut() else { break };
            *value *= inverse_pivot;
            for (entry, target) in row.iter().zip(targets) {
                *target -= entry * *value;
            }
        }
    }

    /// A direction of negative curvature of the matrix whose factorisation stopped: solves `L₁₁ᵀ v = −l` for the
    /// rows before the bad pivot; `vᵀ (matrix + shift) v` is the pivot.
    pub(crate) fn negative_direction(&self, factor: &[f64], failure: &Indefinite, v: &mut [f64]) {
        v.fill(0.0);
        let (first, range) = self.row(failure.row);
        for (c, entry) in (first..failure.row).zip(factor.part(range)) {
            v.put(c, -entry);
        }
        self.backward(factor, v, failure.row);
        v.put(failure.row, 1.0);
    }
}

/// [`Envelope::factor`], where `place` tells of a row its first column and where it starts.
#[inline(always)]
fn factor_by(
    rows: usize,
    place: impl Fn(usize) -> (usize, usize),
    matrix: &[f64],
    norm: f64,
    shift: f64,
    allow: Allow,
    factor: &mut [f64],
) -> Result<Factored, Indefinite> {
    let mut negative = None;
    for r in 0..rows {
        let (first, start) = place(r);
        // A row that were not there would be one that cannot be factored.
        let missing = Indefinite { row: r, pivot: f64::NAN };
        let Some((done, rest)) = factor.split_at_mut_checked(start) else { return Err(missing) };
        let Some(row) = rest.get_mut(..r - first + 1) else { return Err(missing) };
        row.copy(matrix.part(start..start + (r - first) + 1));
        for c in first..r {
            let (c_first, c_start) = place(c);
            let from = first.max(c_first);
            let other = done.get(c_start..c_start + (c - c_first) + 1).and_then(<[f64]>::split_last);
            let (Some((inverse_pivot, other)), Some((known, [entry, ..]))) =
                (other, row.split_at_mut_checked(c - first))
            else {
                return Err(missing);
            };
            let (Some(known_part), Some(other_part)) =
                (known.get(from - first..), other.get(from - c_first..))
            else {
                return Err(missing);
            };
            let mut sum = dot(known_part, other_part);
            if let Some(n) = negative.filter(|n| (from..c).contains(n)) {
                sum -= 2.0 * known.at(n - first) * other.at(n - c_first);
            }
            *entry = (*entry - sum) * inverse_pivot;
            if negative == Some(c) {
                *entry = -*entry;
            }
        }
        let Some((diagonal, entries)) = row.split_last_mut() else { return Err(missing) };
        let mut pivot = *diagonal + shift - dot(entries, entries);
        if let Some(n) = negative.filter(|n| (first..r).contains(n)) {
            pivot += 2.0 * entries.at(n - first) * entries.at(n - first);
        }
        let noise = PIVOT_ROUNDING * diagonal.abs() + NORM_ROUNDING * norm;
        let may_be_negative = allow == Allow::OneNegative && negative.is_none();
        *diagonal = if pivot > noise {
            1.0 / sqrt(pivot)
        } else if pivot >= -noise {
            entries.fill(0.0);
            IMMOVABLE
        } else if may_be_negative && -pivot > LEAST_NEGATIVE * diagonal.abs() {
            negative = Some(r);
            1.0 / sqrt(-pivot)
        } else {
            return Err(Indefinite { row: r, pivot });
        };
    }
    Ok(Factored { negative })
}

/// The inner product: the entries at even places summed in order and those at odd ones, side by side.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((pairs, rest), (other_pairs, other_rest)) = (a.as_chunks::<WIDTH>(), b.as_chunks::<WIDTH>());
    let mut sum = Lanes::ZERO;
    for (x, y) in pairs.iter().zip(other_pairs) {
        sum += Lanes(*x) * Lanes(*y);
    }
    let mut total = sum.total();
    for (x, y) in rest.iter().zip(other_rest) {
        total += x * y;
    }
    total
}
