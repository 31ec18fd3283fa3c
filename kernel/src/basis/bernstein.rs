//! Polynomials in Bernstein form on [0, 1]: values, arithmetic, bounds and real roots. Knows nothing of
//! curves.
//!
//! `p(t) = Σ c_k C(n,k) t^k (1−t)^(n−k)`. The form is used because it bounds what it describes: on [0, 1] a
//! polynomial lies between its least and its greatest coefficient, and has at most as many roots as its
//! coefficients have changes of sign (Farouki, *The Bernstein polynomial basis: a centennial retrospective*,
//! 2012).
//!
//! Nothing here panics or allocates. What cannot be represented (a product of too high a degree) is a
//! polynomial of NaN, whose [`range`](Bernstein::range) is everything and whose [`roots`](Bernstein::roots)
//! are an error.

use crate::order::Order;
use core::cell::Cell;
use core::fmt;
use core::ops::{Add, Mul, Sub};

use heapless::Vec;

/// The highest degree a [`Bernstein`] can have.
pub const MAX_DEGREE: usize = 31;

const CAPACITY: usize = MAX_DEGREE + 1;

/// Roots are isolated on intervals no shorter than this.
const FINEST: f64 = 1.0 / (1_u64 << 40) as f64;

/// A polynomial of degree 0 … [`MAX_DEGREE`] in Bernstein form on [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bernstein {
    /// At most `MAX_DEGREE`.
    degree: usize,
    /// The first `degree + 1` count, the others are zero.
    coefficients: [f64; CAPACITY],
}

/// Why [`Bernstein::roots`] has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootsError {
    /// All coefficients are zero: every parameter is a root.
    Zero,
    /// A coefficient is not finite.
    NotFinite,
}

impl fmt::Display for RootsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Zero => "the polynomial is zero everywhere, so every parameter is a root",
            Self::NotFinite => "a coefficient of the polynomial is not finite",
        })
    }
}

impl core::error::Error for RootsError {}

impl Bernstein {
    /// The polynomial with these `N` coefficients, of degree `N − 1`; `N` from 1 to 32 (checked by the
    /// compiler).
    pub fn new<const N: usize>(coefficients: [f64; N]) -> Self {
        const { assert!(N >= 1 && N <= CAPACITY) }
        let mut out = Self::constant(0.0);
        out.degree = N - 1;
        for (to, from) in out.coefficients.iter_mut().zip(coefficients) {
            *to = from;
        }
        out
    }

    /// As [`new`](Self::new), of a length known only at run time; `None` unless it is 1 … 32.
    pub fn from_slice(coefficients: &[f64]) -> Option<Self> {
        if coefficients.len() > CAPACITY {
            return None;
        }
        let mut out = Self::constant(0.0);
        out.degree = coefficients.len().checked_sub(1)?;
        for (to, from) in out.coefficients.iter_mut().zip(coefficients) {
            *to = *from;
        }
        Some(out)
    }

    /// The polynomial of degree 0 with this value.
    pub fn constant(value: f64) -> Self {
        let mut coefficients = [0.0; CAPACITY];
        coefficients[0] = value;
        Self { degree: 0, coefficients }
    }

    /// The degree of the form; the polynomial's own may be lower.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The `degree + 1` coefficients. The first and the last are the values at 0 and at 1.
    pub fn coefficients(&self) -> &[f64] {
        self.coefficients.get(..=self.degree).unwrap_or(&self.coefficients)
    }

    fn coefficients_mut(&mut self) -> &mut [f64] {
        let count = (self.degree + 1).min(CAPACITY);
        self.coefficients.split_at_mut(count).0
    }

    /// `p(t)` by de Casteljau's algorithm. For `t` in [0, 1] the error is below `3 degree ε max|c|`; other
    /// finite `t` extrapolate.
    pub fn value(&self, t: f64) -> f64 {
        self.restricted_right(t).coefficients[0]
    }

    /// `p'`, of degree one less.
    pub fn derivative(&self) -> Self {
        let mut out = Self::constant(0.0);
        out.degree = self.degree.saturating_sub(1);
        let n = self.degree as f64;
        for (to, pair) in out.coefficients.iter_mut().zip(self.coefficients().windows(2)) {
            if let [left, right] = pair {
                *to = n * (right - left);
            }
        }
        out
    }

    /// The same polynomial in the form of a higher degree (a lower one, or one above [`MAX_DEGREE`], changes
    /// nothing).
    pub fn elevated(&self, degree: usize) -> Self {
        if degree <= self.degree || degree > MAX_DEGREE {
            return *self;
        }
        let mut one = Self::constant(0.0);
        one.degree = degree - self.degree;
        one.coefficients_mut().fill(1.0);
        *self * one
    }

    /// The polynomial `s ↦ p(a + (b − a) s)`: the part over `[a, b]`, for `0 ≤ a ≤ b ≤ 1`.
    pub fn restricted(&self, a: f64, b: f64) -> Self {
        // Cut first at the end that leaves the longer part: the second cut's parameter is then a harmless
        // quotient.
        if b > 0.5 {
            let left = if b < 1.0 { self.restricted_left(b) } else { *self };
            if a > 0.0 { left.restricted_right(a / b) } else { left }
        } else {
            let right = if a > 0.0 { self.restricted_right(a) } else { *self };
            right.restricted_left((b - a) / (1.0 - a))
        }
    }

    /// The part over [0, t].
    fn restricted_left(mut self, t: f64) -> Self {
        let mut active = self.coefficients_mut();
        loop {
            for pair in Cell::from_mut(&mut *active).as_slice_of_cells().windows(2).rev() {
                if let [left, right] = pair {
                    right.set((1.0 - t) * left.get() + t * right.get());
                }
            }
            match active.split_first_mut() {
                Some((_, rest)) if rest.len() > 1 => active = rest,
                _ => return self,
            }
        }
    }

    /// The part over [t, 1].
    fn restricted_right(mut self, t: f64) -> Self {
        let mut active = self.coefficients_mut();
        loop {
            for pair in Cell::from_mut(&mut *active).as_slice_of_cells().windows(2) {
                if let [left, right] = pair {
                    left.set((1.0 - t) * left.get() + t * right.get());
                }
            }
            match active.split_last_mut() {
                Some((_, rest)) if rest.len() > 1 => active = rest,
                _ => return self,
            }
        }
    }

    /// `(low, high)` with `low ≤ p(t) ≤ high` for every `t` in [0, 1], up to the coefficients' own rounding:
    /// the convex hull of the coefficients. A coefficient that is not a number gives `(−∞, ∞)`.
    ///
    /// The excess over the true range falls with the square of the length when the polynomial is restricted.
    pub fn range(&self) -> (f64, f64) {
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        for &c in self.coefficients() {
            if c.is_nan() {
                return (f64::NEG_INFINITY, f64::INFINITY);
            }
            low = low.smaller(c);
            high = high.larger(c);
        }
        (low, high)
    }

    /// The real roots in [0, 1], ascending, a multiple root once.
    ///
    /// A root where the polynomial changes its sign is accurate to `2^-52` in the parameter or to what the
    /// rounding of the values (`4 (degree+1) ε max|c|`, called noise below) leaves certain, whichever is
    /// larger. No such root is missed.
    ///
    /// Where the polynomial touches zero without passing through it, rounding decides whether there is a root
    /// at all. The rule is: parameters at which zero cannot be excluded, either because the polynomial is no
    /// larger than noise or because the coefficients over an interval of length `2^-40` have both signs, form
    /// runs, and a run is one root: its change of sign if it has one, else its extremum, else the one of its
    /// ends and its middle where |p| is least. So a root of multiplicity m is found once, and roots nearer to
    /// each other than about `noise^(1/m)` are one. A polynomial that comes within noise of zero is said to
    /// have a root there.
    ///
    /// Errors: [`RootsError::Zero`] if all coefficients are zero, [`RootsError::NotFinite`].
    pub fn roots(&self) -> Result<Vec<f64, CAPACITY>, RootsError> {
        let mut size = 0.0_f64;
        for &c in self.coefficients() {
            if !c.is_finite() {
                return Err(RootsError::NotFinite);
            }
            size = size.larger(c.abs());
        }
        if size == 0.0 {
            return Err(RootsError::Zero);
        }
        let noise = 4.0 * (self.degree + 1) as f64 * f64::EPSILON * size;
        let derivative = self.derivative();
        let mut roots = Vec::new();
        let mut keep = |root: f64| {
            // Full only if the polynomial is noise: more runs than it has roots.
            let _ = roots.push(root);
        };
        let mut run: Option<(f64, f64)> = None;
        let mut cell = Some(Dyadic::WHOLE);
        while let Some(here) = cell {
            let (a, b) = here.interval();
            let local = self.restricted(a, b);
            let (low, high) = local.range();
            let found = if low > noise || high < -noise {
                None
            } else if local.crosses_once(noise) {
                Some(self.crossing(&derivative, a, b))
            } else if here.width > FINEST && high.larger(-low) > 2.0 * noise {
                cell = Some(here.left_half());
                continue;
            } else {
                run = Some((run.map_or(a, |(start, _)| start), b));
                cell = here.next();
                continue;
            };
            if let Some((start, end)) = run.take() {
                keep(self.root_of_run(&derivative, start, end));
            }
            if let Some(root) = found {
                keep(root);
            }
            cell = here.next();
        }
        if let Some((start, end)) = run {
            keep(self.root_of_run(&derivative, start, end));
        }
        Ok(roots)
    }

    /// Whether the coefficients change their sign exactly once whatever the noise: then so does the
    /// polynomial.
    fn crosses_once(&self, noise: f64) -> bool {
        let mut first = 0.0;
        let mut doubtful = 0;
        let mut crossed = false;
        for (k, &c) in self.coefficients().iter().enumerate() {
            if c.abs() <= noise {
                doubtful += 1;
                // Before the first certain sign, after the change, or two in a row: the count is not certain.
                if k == 0 || crossed || doubtful > 1 {
                    return false;
                }
            } else if k == 0 {
                first = c;
            } else if (c > 0.0) != (first > 0.0) {
                crossed = true;
            } else if crossed || doubtful > 0 {
                return false;
            }
        }
        crossed
    }

    fn root_of_run(&self, derivative: &Self, a: f64, b: f64) -> f64 {
        let middle = 0.5 * (a + b);
        let (at_a, at_middle, at_b) = (self.value(a), self.value(middle), self.value(b));
        if opposite(at_a, at_b) {
            return self.crossing(derivative, a, b);
        }
        if opposite(derivative.value(a), derivative.value(b)) {
            return derivative.crossing(&derivative.derivative(), a, b);
        }
        if at_middle.abs() <= at_a.abs().smaller(at_b.abs()) {
            middle
        } else if at_a.abs() < at_b.abs() {
            a
        } else {
            b
        }
    }

    /// The root between `a` and `b`, where the polynomial has opposite signs: Newton's method inside a
    /// shrinking bracket, halved where Newton leaves it or is slow.
    pub(crate) fn crossing(&self, derivative: &Self, a: f64, b: f64) -> f64 {
        let rising = self.value(b) > 0.0;
        let (mut low, mut high) = (a, b);
        let mut t = 0.5 * (a + b);
        let mut last_step = b - a;
        for _ in 0..120 {
            let value = self.value(t);
            if value == 0.0 {
                return t;
            }
            if (value > 0.0) == rising {
                high = t;
            } else {
                low = t;
            }
            if high - low <= f64::EPSILON {
                break;
            }
            let newton = t - value / derivative.value(t);
            let step = (newton - t).abs();
            // The comparisons are false for a NaN from a zero derivative.
            let next = if newton > low && newton < high && step < 0.5 * last_step {
                newton
            } else {
                0.5 * (low + high)
            };
            last_step = (next - t).abs();
            if last_step <= 0.5 * f64::EPSILON {
                return next;
            }
            t = next;
        }
        0.5 * (low + high)
    }
}

impl Add for Bernstein {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let mut out = self.elevated(other.degree);
        for (to, from) in out.coefficients.iter_mut().zip(other.elevated(self.degree).coefficients) {
            *to += from;
        }
        out
    }
}

impl Sub for Bernstein {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Bernstein {
    type Output = Self;

    fn mul(mut self, factor: f64) -> Self {
        for c in self.coefficients_mut() {
            *c *= factor;
        }
        self
    }
}

/// The product, of the sum of the degrees; NaN if that is above [`MAX_DEGREE`].
impl Mul for Bernstein {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let degree = self.degree + other.degree;
        if degree > MAX_DEGREE {
            return Self::constant(f64::NAN);
        }
        let mut out = Self { degree, coefficients: [0.0; CAPACITY] };
        let ours = binomials(self.degree);
        let theirs = binomials(other.degree);
        for (i, (a, weight_a)) in self.coefficients().iter().zip(ours).enumerate() {
            let scaled = a * weight_a;
            for (to, (b, weight_b)) in
                out.coefficients.iter_mut().skip(i).zip(other.coefficients().iter().zip(theirs))
            {
                *to += scaled * (b * weight_b);
            }
        }
        for (to, weight) in out.coefficients_mut().iter_mut().zip(binomials(degree)) {
            *to /= weight;
        }
        out
    }
}

/// Whether one is positive and one negative; their product might underflow.
fn opposite(a: f64, b: f64) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

/// `C(n, 0) … C(n, n)`, then ones. Exact: every product on the way is an integer below `2^53`.
fn binomials(n: usize) -> [f64; CAPACITY] {
    let mut row = [1.0; CAPACITY];
    let mut value = 1.0;
    for (k, entry) in row.iter_mut().enumerate().skip(1).take(n) {
        value = value * (n + 1 - k) as f64 / k as f64;
        *entry = value;
    }
    row
}

/// An interval `[index, index + 1] · width` of a repeated halving of [0, 1].
///
/// Walking the tree of halves in order needs no stack: where to go next follows from `index` alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dyadic {
    index: u64,
    /// A power of 1/2.
    pub(crate) width: f64,
}

impl Dyadic {
    pub(crate) const WHOLE: Self = Self { index: 0, width: 1.0 };

    pub(crate) fn interval(self) -> (f64, f64) {
        (self.index as f64 * self.width, (self.index + 1) as f64 * self.width)
    }

    pub(crate) fn left_half(self) -> Self {
        Self { index: 2 * self.index, width: 0.5 * self.width }
    }

    /// The next interval to the right that is not inside this one, the longest in the tree; `None` at the
    /// end.
    pub(crate) fn next(mut self) -> Option<Self> {
        while self.width < 1.0 {
            if self.index.is_multiple_of(2) {
                return Some(Self { index: self.index + 1, width: self.width });
            }
            self = Self { index: self.index / 2, width: 2.0 * self.width };
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Π (t − r)` over the given roots.
    fn with_roots(roots: &[f64]) -> Bernstein {
        let mut product = Bernstein::constant(1.0);
        for &r in roots {
            product = product * Bernstein::new([-r, 1.0 - r]);
        }
        product
    }

    fn assert_roots(p: Bernstein, expected: &[f64], accuracy: f64) {
        let found = p.roots().unwrap();
        assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= accuracy, "{found:?} for {expected:?}");
        }
    }

    #[test]
    fn arithmetic_agrees_with_the_values() {
        let p = Bernstein::new([1.0, -2.0, 0.5, 3.0, -1.0, 2.5]);
        let q = Bernstein::new([0.25, 4.0, -3.0, 1.0]);
        for k in 0..=16 {
            let t = f64::from(k) / 16.0;
            let (x, y) = (p.value(t), q.value(t));
            assert!(((p * q).value(t) - x * y).abs() < 1e-14);
            assert!(((p + q).value(t) - (x + y)).abs() < 1e-14);
            assert!(((q - p).value(t) - (y - x)).abs() < 1e-14);
            assert!((p.elevated(31).value(t) - x).abs() < 1e-14);
            assert!((p.restricted(0.25, 0.75).value(t) - p.value(0.25 + 0.5 * t)).abs() < 1e-14);
            assert!((p.restricted(0.1, 0.3).value(t) - p.value(0.1 + (0.3 - 0.1) * t)).abs() < 1e-14);
            let slope = (p.value(t + 1e-6) - p.value(t - 1e-6)) / 2e-6;
            assert!((p.derivative().value(t) - slope).abs() < 1e-7);
        }
    }

    #[test]
    fn the_power_basis_is_recovered() {
        // t^3 and (1 + 2t)^2 by hand.
        assert_eq!(Bernstein::new([0.0, 0.0, 0.0, 1.0]).value(0.5), 0.125);
        let square = Bernstein::new([1.0, 3.0]) * Bernstein::new([1.0, 3.0]);
        assert_eq!(square.coefficients(), &[1.0, 3.0, 9.0]);
    }

    #[test]
    fn simple_roots_are_found_to_rounding_in_order() {
        assert_roots(with_roots(&[0.9, 0.1, 0.5]), &[0.1, 0.5, 0.9], 1e-15);
        assert_roots(with_roots(&[0.0, 1.0, 0.25, 0.75]), &[0.0, 0.25, 0.75, 1.0], 1e-14);
        assert_roots(with_roots(&[-0.1, 1.2, 0.3]), &[0.3], 1e-15);
        assert_roots(with_roots(&[0.3, 0.3 + 1e-6]), &[0.3, 0.3 + 1e-6], 1e-9);
        assert_roots(Bernstein::new([1.0, 2.0, 3.0]), &[], 0.0);
        assert_roots(Bernstein::constant(2.0), &[], 0.0);
        assert_roots(
            with_roots(&[0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875]),
            &[0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875],
            1e-12,
        );
    }

    #[test]
    fn multiple_roots_are_one_root() {
        assert_roots(with_roots(&[0.4, 0.4]), &[0.4], 1e-9);
        assert_roots(with_roots(&[0.4, 0.4, 0.4, 0.8]), &[0.4, 0.8], 1e-4);
        assert_roots(with_roots(&[0.0, 0.0, 0.6]), &[0.0, 0.6], 1e-6);
        assert_roots(with_roots(&[0.5; 24]), &[0.5], 0.3);
    }

    #[test]
    fn roots_do_not_depend_on_the_size_of_the_coefficients() {
        for size in [1e-200, 1e-6, 1e6, 1e200] {
            assert_roots(with_roots(&[0.2, 0.7, 0.7]) * size, &[0.2, 0.7], 1e-8);
        }
    }

    #[test]
    fn degree_24_roots_of_a_chebyshev_polynomial_are_found() {
        // T_24(2t − 1) by its recurrence; roots (1 + cos((2k+1)π/48))/2.
        let x = Bernstein::new([-1.0, 1.0]);
        let (mut before, mut now) = (Bernstein::constant(1.0), x);
        for _ in 1..24 {
            (before, now) = (now, x * now * 2.0 - before);
        }
        let mut expected = [0.0; 24];
        for (k, root) in expected.iter_mut().enumerate() {
            let angle = (2 * k + 1) as f64 * core::f64::consts::PI / 48.0;
            *root = 0.5 - 0.5 * libm::cos(angle);
        }
        // Its coefficients are 1e8 times its values, so the roots keep half the digits.
        assert_roots(now, &expected, 1e-8);
    }

    #[test]
    fn zero_and_not_finite_are_told_apart() {
        assert_eq!(Bernstein::new([0.0; 5]).roots(), Err(RootsError::Zero));
        assert_eq!(Bernstein::new([1.0, f64::NAN]).roots(), Err(RootsError::NotFinite));
        let high = Bernstein::new([1.0; 20]) * Bernstein::new([1.0; 20]);
        assert_eq!(high.roots(), Err(RootsError::NotFinite));
        assert_eq!(high.range(), (f64::NEG_INFINITY, f64::INFINITY));
        assert!(Bernstein::from_slice(&[]).is_none() && Bernstein::from_slice(&[0.0; 33]).is_none());
    }

    #[test]
    fn opposite_signs_are_told_where_the_product_underflows() {
        for a in [1.0, 1e-200, f64::INFINITY] {
            for b in [1.0, 1e-200, f64::INFINITY] {
                assert!(opposite(a, -b) && opposite(-a, b), "{a} {b}");
                assert!(!opposite(a, b) && !opposite(-a, -b), "{a} {b}");
            }
            for none in [0.0, -0.0, f64::NAN] {
                assert!(
                    !opposite(a, none) && !opposite(-a, none) && !opposite(none, a) && !opposite(none, -a)
                );
            }
        }
    }

    /// Coefficients are certain, positive or negative, or noise, which may be either: one change of sign is certain
    /// exactly where all choices have one.
    #[test]
    fn one_change_of_sign_is_certain_where_noise_cannot_make_it_three_or_none() {
        let noise = 1e-3;
        for count in 1..=6_usize {
            for code in 0..3_usize.pow(count as u32) {
                let signs: [i32; 6] = core::array::from_fn(|k| (code / 3_usize.pow(k as u32) % 3) as i32 - 1);
                let value = |k: usize| if signs[k] == 0 { noise } else { 2.0 * noise * f64::from(signs[k]) };
                let coefficients: [f64; 6] = core::array::from_fn(value);
                let polynomial = Bernstein::from_slice(&coefficients[..count]).expect("a few coefficients");
                let always_once = (0..1_u32 << count).all(|choice| {
                    let sign = |k: usize| match signs[k] {
                        0 => choice >> k & 1 == 1,
                        sign => sign > 0,
                    };
                    (1..count).filter(|&k| sign(k) != sign(k - 1)).count() == 1
                });
                assert_eq!(polynomial.crosses_once(noise), always_once, "{:?}", &signs[..count]);
            }
        }
    }

    #[test]
    fn a_crossing_stays_between_its_ends_where_tangents_lead_away() {
        // (t − r) ((t − m)² + w): with a small w a tangent near m meets zero far outside.
        for r in [0.05, 0.2, 0.35, 0.6, 0.9] {
            for m in [0.45, 0.5, 0.55, 0.7] {
                for w in [1e-4, 1e-2, 0.1] {
                    for factor in [1.0, -3.0] {
                        let hill = Bernstein::new([m * m + w, m * m - m + w, (1.0 - m) * (1.0 - m) + w]);
                        let cubic = Bernstein::new([-r, 1.0 - r]) * hill * factor;
                        let found = cubic.crossing(&cubic.derivative(), 0.0, 1.0);
                        assert!((found - r).abs() < 1e-10, "{r} {m} {w}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_crossing_is_found_where_newtons_method_creeps() {
        // t³¹ = c: from the middle every tangent goes but a part of 31 of the way down.
        for exponent in [60.0, 90.0, 150.0] {
            let c = libm::pow(10.0, -exponent);
            let mut coefficients = [-c; CAPACITY];
            coefficients[MAX_DEGREE] = 1.0 - c;
            let power = Bernstein::new(coefficients);
            let (found, root) = (power.crossing(&power.derivative(), 0.0, 1.0), libm::pow(c, 1.0 / 31.0));
            assert!((found / root - 1.0).abs() < 1e-9, "{found} {root}");
        }
    }
}
