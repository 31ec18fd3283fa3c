//! The functionals of space curves that know torsion, and torsion itself, with exact derivatives (thesis 4.2.1).
//!
//! ```text
//! space MVC  ∫ (dκ/ds)² + (dτ/ds)² ds     thesis (4.4); zero on helices
//! space MEC  ∫ κ² + τ² ds                 thesis (4.3)
//! ```
//!
//! with the scalar curvature `κ = |d1×d2| / |d1|³` and the torsion `τ = det(d1, d2, d3) / |d1×d2|²` of a curve with
//! parametric derivatives `d1 … d4`. Everything is a function of six invariants, polynomials in the derivatives,
//!
//! ```text
//! p = d1·d1   q = d1·d2   U = |u|²   g = u·u̇   w = u·d3   ẇ = u·d4       u = d1×d2,  u̇ = d1×d3
//! ```
//!
//! since `U' = 2 g` and `w' = ẇ` along the curve. With `h = g/U`,
//!
//! ```text
//! κ² = U p^(-3)      κ' = √U (p h − 3 q) p^(-5/2)
//! τ  = w / U         τ' = (ẇ − 2 w h) / U                d/ds = p^(-1/2) d/dt
//! ```
//!
//! so that by the parameter the densities are `U (p h − 3 q)² p^(-11/2) + τ'² p^(-1/2)` and `U p^(-5/2) + τ² p^(1/2)`.
//! Their derivatives by the invariants are written out; the chain rule to `d1 … d4` is common to all.
//!
//! Torsion is undefined where the curvature vanishes, and there the densities are infinite. A space curve whose
//! curvature, changing at a rate `κ'`, falls to a small `δ` turns its normal by half a turn on a length of `δ/κ'`: the
//! space MVC pays `π/4 (κ'/δ)³` for it.
//!
//! They are *softened* by a curvature `ε` with `S = U + ε² p³` for `U` in torsion's denominator: torsion is
//! `τ κ²/(κ² + ε²)` then, which vanishes with the curvature and is constant on helices still: what is `U` and `g` in the
//! formulas becomes `S` and `S'/2 = g + 3 ε² p² q`. The square of `κ'` has no derivatives where the curvature vanishes.
//! It is the square of the curvature vector's change `db/ds` less `κ² τ²`, and of that the softened form takes
//! `κ² τ² · κ²/(κ² + ε²) = w² / (S p³)` away: at inflections it is the square of `db/ds`. That square itself is a plain
//! density (see [`super::fairness`]) and not counted here: a softened density of the space MVC is what must be added.

use crate::root::sqrt;
use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 3>;
type Matrix = SMatrix<f64, 3, 3>;

/// What a space curve is to minimise where torsion counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpaceFunctional {
    /// `∫ (dκ/ds)² + (dτ/ds)² ds` (thesis 4.4); 1/length³.
    Mvc,
    /// `∫ κ² + τ² ds` (thesis 4.3); 1/length.
    Mec,
}

/// A density with its derivatives by `d1 … d4`. Of the second derivatives only the blocks `h[k][l]`, `k >= l`, are
/// filled. Where the value is infinite the derivatives are zero.
pub(crate) struct SpaceDensity {
    pub(crate) value: f64,
    pub(crate) gradient: [Vector; 4],
    pub(crate) hessian: [[Matrix; 4]; 4],
}

/// The torsion with its derivatives by `d1, d2, d3`, the second ones as in [`SpaceDensity`].
pub(crate) struct Torsion {
    pub(crate) value: f64,
    pub(crate) gradient: [Vector; 3],
    pub(crate) hessian: [[Matrix; 3]; 3],
}

// Places of the invariants: torsion and the space MEC depend on the first three, the space MVC on all.
const U: usize = 0;
const W: usize = 1;
const P: usize = 2;
const Q: usize = 3;
const G: usize = 4;
const V: usize = 5;

/// The invariants at a point, and the two exterior products that they are made of.
struct Invariants {
    /// `d1×d2`, normal to the osculating plane.
    normal: Vector,
    /// `d1×d3`, its derivative along the curve.
    change: Vector,
    x: [f64; 6],
}

impl Invariants {
    #[inline]
    fn at(d1: &Vector, d2: &Vector, d3: &Vector, d4: &Vector) -> Self {
        let normal = d1.cross(d2);
        let change = d1.cross(d3);
        let x = [
            normal.dot(&normal),
            normal.dot(d3),
            d1.dot(d1),
            d1.dot(d2),
            normal.dot(&change),
            normal.dot(d4),
        ];
        Self { normal, change, x }
    }
}

/// The derivatives of a function of the invariants by them; of the second ones both halves.
struct Outer {
    first: [f64; 6],
    second: [[f64; 6]; 6],
}

impl Outer {
    /// Those of a function of softened invariants by the invariants themselves.
    fn hardened(mut self, x: &[f64; 6], square: f64) -> Self {
        if square == 0.0 {
            return self;
        }
        let (p, q) = (x[P], x[Q]);
        let (by_p, mixed, by_q) = (3.0 * square * p * p, 6.0 * square * p * q, 3.0 * square * p * p);
        let f = self.first;
        let h = &mut self.second;
        for row in h.iter_mut() {
            row[P] += row[U] * by_p + row[G] * mixed;
            row[Q] += row[G] * by_q;
        }
        for j in 0..6 {
            h[P][j] += h[U][j] * by_p + h[G][j] * mixed;
            h[Q][j] += h[G][j] * by_q;
        }
        let bend = 6.0 * square;
        h[P][P] += bend * (f[U] * p + f[G] * q);
        h[P][Q] += bend * f[G] * p;
        h[Q][P] += bend * f[G] * p;
        self.first[P] += f[U] * by_p + f[G] * mixed;
        self.first[Q] += f[G] * by_q;
        self
    }

    fn plus(mut self, other: &Self) -> Self {
        for i in 0..6 {
            self.first[i] += other.first[i];
            for j in 0..6 {
                self.second[i][j] += other.second[i][j];
            }
        }
        self
    }

    /// From the first derivatives and the half `i >= j` of the second ones.
    #[inline]
    fn new(first: [f64; 6], half: [[f64; 6]; 6]) -> Self {
        let mut second = half;
        for i in 0..6 {
            for j in 0..i {
                second[j][i] = half[i][j];
            }
        }
        Self { first, second }
    }
}

/// The invariants with `U` and `g` softened by the square of a curvature.
#[inline]
fn softened(x: &[f64; 6], square: f64) -> [f64; 6] {
    let mut out = *x;
    let [_, _, p, q, ..] = *x;
    out[U] += square * p * p * p;
    out[G] += 3.0 * square * p * p * q;
    out
}

/// The value of a density by the invariants: infinite, never NaN, where it is undefined.
#[inline]
fn value_at(functional: SpaceFunctional, softening: f64, x: &[f64; 6]) -> f64 {
    let [big_u, w, p, q, _, v] = *x;
    let root = sqrt(p);
    let [big_s, _, _, _, g, _] = softened(x, softening * softening);
    let value = match functional {
        SpaceFunctional::Mvc => {
            let h = g / big_s;
            let t = (v - 2.0 * w * h) / big_s;
            let of_curvature = if softening > 0.0 {
                -w * w / (big_s * p * p * root)
            } else {
                let k = p * h - 3.0 * q;
                big_u * k * k / (p * p * p * p * p * root)
            };
            of_curvature + t * t / root
        }
        SpaceFunctional::Mec => {
            let torsion = w / big_s;
            big_u / (p * p * root) + torsion * torsion * root
        }
    };
    if value < f64::INFINITY { value } else { f64::INFINITY }
}

/// The density of a functional at a point of a curve with derivatives `d = [C', C'', C''', C'''']`, by the parameter.
/// Infinite where the curve is irregular and, unless it is softened by some curvature, where its curvature vanishes.
pub(crate) fn space_density(functional: SpaceFunctional, softening: f64, d: &[Vector; 4]) -> f64 {
    let [d1, d2, d3, d4] = d;
    value_at(functional, softening, &Invariants::at(d1, d2, d3, d4).x)
}

/// The density with its exact first and second derivatives.
pub(crate) fn space_density_derivatives(
    functional: SpaceFunctional,
    softening: f64,
    d: &[Vector; 4],
) -> SpaceDensity {
    let [d1, d2, d3, d4] = d;
    let at = Invariants::at(d1, d2, d3, d4);
    let value = value_at(functional, softening, &at.x);
    if value == f64::INFINITY {
        return SpaceDensity { value, gradient: [Vector::zeros(); 4], hessian: [[Matrix::zeros(); 4]; 4] };
    }
    let square = softening * softening;
    let soft = softened(&at.x, square);
    let (gradient, hessian) = match functional {
        SpaceFunctional::Mvc => {
            let of_curvature =
                if softening > 0.0 { turning_of_normal(&soft) } else { slope_of_curvature(&at.x) };
            chain::<6>(d, &at, &of_curvature.plus(&slope_of_torsion(&soft)).hardened(&at.x, square))
        }
        SpaceFunctional::Mec => {
            chain::<3>(d, &at, &bending(&at.x).plus(&twisting(&soft).hardened(&at.x, square)))
        }
    };
    SpaceDensity { value, gradient, hessian }
}

/// The torsion of a curve with derivatives `d = [C', C'', C''']`; not finite where its curvature vanishes, unless it is
/// softened by some curvature.
pub(crate) fn torsion(softening: f64, d: &[Vector; 3]) -> f64 {
    let [d1, d2, d3] = d;
    let [big_s, w, ..] = softened(&Invariants::at(d1, d2, d3, &Vector::zeros()).x, softening * softening);
    w / big_s
}

/// The torsion and its rate of change along the curve, `[τ, dτ/ds]`, of a curve with derivatives `d = [C' … C'''']`, as
/// [`torsion`] has it.
pub(crate) fn torsion_and_slope(softening: f64, d: &[Vector; 4]) -> [f64; 2] {
    let [d1, d2, d3, d4] = d;
    let [big_s, w, p, _, g, v] = softened(&Invariants::at(d1, d2, d3, d4).x, softening * softening);
    [w / big_s, (v - 2.0 * w * (g / big_s)) / big_s / sqrt(p)]
}

/// The torsion with its exact first and second derivatives.
pub(crate) fn torsion_derivatives(softening: f64, d: &[Vector; 3]) -> Torsion {
    let [d1, d2, d3] = *d;
    let d = [d1, d2, d3, Vector::zeros()];
    let at = Invariants::at(&d1, &d2, &d3, &d[3]);
    let square = softening * softening;
    let [big_s, w, ..] = softened(&at.x, square);
    let by_u = 1.0 / big_s;
    let value = w / big_s;
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];
    first[U] = -value * by_u;
    first[W] = by_u;
    half[U][U] = 2.0 * value * by_u * by_u;
    half[W][U] = -by_u * by_u;
    let outer = Outer::new(first, half).hardened(&at.x, square);
    let ([g1, g2, g3, _], [h1, h2, h3, _]) = chain::<3>(&d, &at, &outer);
    let three = |row: [Matrix; 4]| [row[0], row[1], row[2]];
    Torsion { value, gradient: [g1, g2, g3], hessian: [three(h1), three(h2), three(h3)] }
}

/// The derivatives by the invariants of the space MVC's first part, with `c = p^(-11/2)`
/// `c (p² g²/U − 6 p q g + 9 q² U)`.
#[inline]
fn slope_of_curvature(x: &[f64; 6]) -> Outer {
    let [big_u, _, p, q, g, _] = *x;
    let b = 1.0 / sqrt(p);
    let by_p = b * b;
    let c = by_p * by_p * by_p * by_p * by_p * b;
    let by_u = 1.0 / big_u;
    let h = g * by_u;
    let k = p * h - 3.0 * q;
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];

    // Kept with the factor that vanishes where κ' does.
    let slope = c * k;
    first[U] = -slope * (p * h + 3.0 * q);
    first[P] = slope * big_u * (2.0 * h - 5.5 * k * by_p);
    first[Q] = -6.0 * slope * big_u;
    first[G] = 2.0 * slope * p;
    let (ph, qp) = (p * h, q * by_p);
    half[U][U] = 2.0 * c * ph * ph * by_u;
    half[P][U] = c * by_p * (3.5 * ph * ph - 49.5 * q * q);
    half[P][P] = c * big_u * (15.75 * h * h - 148.5 * h * qp + 321.75 * qp * qp);
    half[Q][U] = 18.0 * c * q;
    half[Q][P] = c * big_u * (27.0 * h - 99.0 * qp);
    half[Q][Q] = 18.0 * c * big_u;
    half[G][U] = -2.0 * c * p * ph * by_u;
    half[G][P] = c * (27.0 * q - 7.0 * ph);
    half[G][Q] = -6.0 * c * p;
    half[G][G] = 2.0 * c * p * p * by_u;
    Outer::new(first, half)
}

/// Those of what stands for it in the softened form, `−w²/U p^(-5/2)`.
#[inline]
fn turning_of_normal(x: &[f64; 6]) -> Outer {
    let [big_u, w, p, ..] = *x;
    let (by_u, by_p) = (1.0 / big_u, 1.0 / p);
    let c = by_p * by_p * by_p * sqrt(p);
    let (ratio, square) = (w * by_u, w * w * by_u);
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];
    first[U] = c * ratio * ratio;
    first[W] = -2.0 * c * ratio;
    first[P] = 2.5 * c * by_p * square;
    half[U][U] = -2.0 * c * ratio * ratio * by_u;
    half[W][U] = 2.0 * c * ratio * by_u;
    half[W][W] = -2.0 * c * by_u;
    half[P][U] = -2.5 * c * by_p * ratio * ratio;
    half[P][W] = 5.0 * c * by_p * ratio;
    half[P][P] = -8.75 * c * by_p * by_p * square;
    Outer::new(first, half)
}

/// Those of its second part, with `b = p^(-1/2)` and `t = τ'`: `b t²`.
#[inline]
fn slope_of_torsion(x: &[f64; 6]) -> Outer {
    let [big_u, w, p, _, g, v] = *x;
    let b = 1.0 / sqrt(p);
    let by_p = b * b;
    let by_u = 1.0 / big_u;
    let h = g * by_u;
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];

    // The factor t with derivatives, then 2 b (∇t ∇tᵀ + t ∇²t).
    let square = by_u * by_u;
    let wh = w * h;
    let t = (v - 2.0 * wh) * by_u;
    let (tu, tw, tg, tv) = ((4.0 * wh - v) * square, -2.0 * h * by_u, -2.0 * w * square, by_u);
    let twice = 2.0 * b;
    let linear = twice * t;
    first[U] = linear * tu;
    first[W] = linear * tw;
    first[P] = -0.25 * linear * t * by_p;
    first[G] = linear * tg;
    first[V] = linear * tv;
    half[U][U] = twice * tu * tu + linear * (2.0 * v - 12.0 * wh) * square * by_u;
    half[W][U] = twice * tw * tu + linear * 4.0 * h * square;
    half[W][W] = twice * tw * tw;
    let by_root = -0.5 * linear * by_p;
    half[P][U] = by_root * tu;
    half[P][W] = by_root * tw;
    half[P][P] = 0.375 * linear * t * by_p * by_p;
    half[G][U] = twice * tg * tu + linear * 4.0 * w * square * by_u;
    half[G][W] = twice * tg * tw - linear * 2.0 * square;
    half[G][P] = by_root * tg;
    half[G][G] = twice * tg * tg;
    half[V][U] = twice * tv * tu - linear * square;
    half[V][W] = twice * tv * tw;
    half[V][P] = by_root * tv;
    half[V][G] = twice * tv * tg;
    half[V][V] = twice * tv * tv;
    Outer::new(first, half)
}

/// The derivatives by the invariants of the space MEC's first part, `U p^(-5/2)`.
#[inline]
fn bending(x: &[f64; 6]) -> Outer {
    let [big_u, _, p, ..] = *x;
    let by_p = 1.0 / p;
    let c = by_p * by_p * by_p * sqrt(p);
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];
    first[U] = c;
    first[P] = -2.5 * c * big_u * by_p;
    half[P][U] = -2.5 * c * by_p;
    half[P][P] = 8.75 * c * big_u * by_p * by_p;
    Outer::new(first, half)
}

/// Those of its second part, `(w/U)² p^(1/2)`.
#[inline]
fn twisting(x: &[f64; 6]) -> Outer {
    let [big_u, w, p, ..] = *x;
    let root = sqrt(p);
    let by_p = 1.0 / p;
    let by_u = 1.0 / big_u;
    let torsion = w * by_u;
    let square = torsion * torsion;
    let mut first = [0.0; 6];
    let mut half = [[0.0; 6]; 6];
    first[U] = -2.0 * root * square * by_u;
    first[W] = 2.0 * root * torsion * by_u;
    first[P] = 0.5 * square * root * by_p;
    half[U][U] = 6.0 * root * square * by_u * by_u;
    half[W][U] = -4.0 * root * torsion * by_u * by_u;
    half[W][W] = 2.0 * root * by_u * by_u;
    half[P][U] = -square * by_u * root * by_p;
    half[P][W] = torsion * by_u * root * by_p;
    half[P][P] = -0.25 * square * root * by_p * by_p;
    Outer::new(first, half)
}

/// The chain rule: the derivatives by `d1 … d4` of a function of the first `N` invariants.
#[inline]
fn chain<const N: usize>(d: &[Vector; 4], at: &Invariants, outer: &Outer) -> ([Vector; 4], [[Matrix; 4]; 4]) {
    let [d1, d2, d3, d4] = d;
    let u = &at.normal;
    let q = d1.dot(d2);
    let f = &outer.first;
    let f2 = &outer.second;
    // The invariants' derivatives by d1 and d2; by d3 only w (u) and g (c) have one, by d4 only ẇ (u).
    let c = u.cross(d1);
    let by1 =
        [d2.cross(u) * 2.0, d2.cross(d3), d1 * 2.0, *d2, d2.cross(&at.change) + d3.cross(u), d2.cross(d4)];
    let by2 = [c * 2.0, d3.cross(d1), Vector::zeros(), *d1, at.change.cross(d1), d4.cross(d1)];

    let zero = Vector::zeros();
    let mut gradient = [zero; 4];
    let mut hessian = [[Matrix::zeros(); 4]; 4];
    // Σ_j F_ij ∂x_j, by d1 and by d2.
    let (mut row1, mut row2) = ([zero; 6], [zero; 6]);
    for i in 0..N {
        gradient[0] += by1[i] * f[i];
        gradient[1] += by2[i] * f[i];
        for j in 0..N {
            row1[i] += by1[j] * f2[i][j];
            row2[i] += by2[j] * f2[i][j];
        }
        hessian[0][0] += by1[i] * row1[i].transpose();
        hessian[1][0] += by2[i] * row1[i].transpose();
        hessian[1][1] += by2[i] * row2[i].transpose();
    }
    gradient[2] = u * f[W] + c * f[G];
    let row3 = u * f2[W][W] + c * f2[W][G];
    hessian[2][0] = u * row1[W].transpose();
    hessian[2][1] = u * row2[W].transpose();
    hessian[2][2] = u * row3.transpose();

    // Σ F_i ∇²x_i: first U, p and q with the multiples of the identity, then the triple products.
    let z = d2 * (2.0 * f[U]) + d3 * f[G];
    let (mut i11, mut i21) = (2.0 * f[U] * d2.dot(d2) + 2.0 * f[P], f[Q] - 2.0 * f[U] * q);
    let mut pair = d3 * f[W];
    if N > G {
        let (s, e) = (d2.dot(d3), d1.dot(d3));
        i11 += 2.0 * f[G] * s;
        i21 -= f[G] * e;
        pair += d4 * f[V];
        let tangential = (d1 * d1.transpose() - Matrix::identity() * at.x[P]) * f[G];
        hessian[2][0] += c * row1[G].transpose() + (d2 * (d1 * 2.0).transpose() - d1 * d2.transpose()) * f[G];
        add_identity(&mut hessian[2][0], -f[G] * q);
        hessian[2][1] += c * row2[G].transpose() - tangential;
        let row3_by_g = u * f2[G][W] + c * f2[G][G];
        hessian[2][2] += c * row3_by_g.transpose();
        gradient[3] = u * f[V];
        hessian[3][0] = u * row1[V].transpose() - d2.cross_matrix() * f[V];
        hessian[3][1] = u * row2[V].transpose() + d1.cross_matrix() * f[V];
        hessian[3][2] = u * (u * f2[V][W] + c * f2[V][G]).transpose();
        hessian[3][3] = u * (u * f2[V][V]).transpose();
    }
    let half_z = d2 * f[U] + d3 * f[G];
    hessian[0][0] -= d2 * half_z.transpose() + half_z * d2.transpose();
    add_identity(&mut hessian[0][0], i11);
    hessian[1][0] += z * (d1 * 2.0).transpose() - d1 * z.transpose() + pair.cross_matrix();
    add_identity(&mut hessian[1][0], i21);
    hessian[1][1] -= d1 * (d1 * (2.0 * f[U])).transpose();
    add_identity(&mut hessian[1][1], 2.0 * f[U] * at.x[P]);
    hessian[2][0] -= d2.cross_matrix() * f[W];
    hessian[2][1] += d1.cross_matrix() * f[W];
    (gradient, hessian)
}

#[inline]
fn add_identity(to: &mut Matrix, times: f64) {
    for i in 0..3 {
        to[(i, i)] += times;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::order::Order;
    use SpaceFunctional::{Mec, Mvc};
    use std::vec::Vec;

    /// A column of numbers in [-1, 1], another for each seed.
    fn numbers<const N: usize>(seed: u64) -> [f64; N] {
        let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        core::array::from_fn(|_| {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
    }

    fn vectors<const N: usize>(seed: u64) -> [Vector; N] {
        let n = numbers::<12>(seed);
        core::array::from_fn(|k| Vector::new(n[3 * k], n[3 * k + 1], n[3 * k + 2]))
    }

    /// Derivatives at random, neither slow nor nearly straight.
    fn samples() -> Vec<[Vector; 4]> {
        let all = (1..200).map(vectors::<4>);
        all.filter(|d| d[0].norm() > 0.4 && d[0].cross(&d[1]).norm() > 0.3).collect()
    }

    /// The derivative of `f` at 0 by central differences, extrapolated three times from a step of `h`.
    fn slope(h: f64, f: impl Fn(f64) -> f64) -> f64 {
        let mut table: [f64; 4] = core::array::from_fn(|i| {
            let step = h / (1u32 << i) as f64;
            (f(step) - f(-step)) / (2.0 * step)
        });
        let mut power = 1.0;
        for column in 1..4 {
            power *= 4.0;
            for i in (column..4).rev() {
                table[i] += (table[i] - table[i - 1]) / (power - 1.0);
            }
        }
        table[3]
    }

    /// Along a curve with such derivatives, the fifth and more being zero; softened and not.
    #[test]
    fn the_slope_of_torsion_is_its_rate_of_change_along_the_curve() {
        for d in samples() {
            let at = |t: f64| {
                let [d1, d2, d3, d4] = d;
                [
                    d1 + d2 * t + d3 * (t * t / 2.0) + d4 * (t * t * t / 6.0),
                    d2 + d3 * t + d4 * (t * t / 2.0),
                    d3 + d4 * t,
                ]
            };
            for softening in [0.0, 0.3] {
                let [found, rate] = torsion_and_slope(softening, &d);
                assert!((found - torsion(softening, &at(0.0))).abs() <= 1e-14 * (1.0 + found.abs()));
                let wanted = slope(1e-2, |t| torsion(softening, &at(t))) / d[0].norm();
                assert!((rate - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "{softening}: {rate} {wanted}");
            }
        }
        // A helix of radius 1 and pitch 2π: curvature and torsion are a half, and by a curvature of a half it is softened to
        // a half of that.
        let helix = [
            Vector::new(0.0, 1.0, 1.0),
            Vector::new(-1.0, 0.0, 0.0),
            Vector::new(0.0, -1.0, 0.0),
            Vector::new(1.0, 0.0, 0.0),
        ];
        for (softening, wanted) in [(0.0, 0.5), (0.5, 0.25)] {
            let [found, rate] = torsion_and_slope(softening, &helix);
            assert!((found - wanted).abs() < 1e-15 && rate.abs() < 1e-15, "{softening}: {found} {rate}");
        }
    }

    /// Compares a gradient with differences of the value, and a Hessian with differences of the gradient.
    fn compare<const N: usize>(
        d: &[Vector; N],
        value: impl Fn(&[Vector; N]) -> f64,
        derivatives: impl Fn(&[Vector; N]) -> ([Vector; N], [[Matrix; N]; N]),
    ) {
        let moved = |k: usize, i: usize, by: f64| {
            let mut out = *d;
            out[k][i] += by;
            out
        };
        let (gradient, hessian) = derivatives(d);
        let steepest = gradient.iter().fold(0.0f64, |most, g| most.larger(g.amax()));
        let most = hessian.iter().flatten().fold(0.0f64, |most, block| most.larger(block.amax()));
        for k in 0..N {
            for i in 0..3 {
                let difference = slope(4e-3, |x| value(&moved(k, i, x)));
                let error = (difference - gradient[k][i]).abs() / steepest;
                assert!(error < 1e-8, "gradient {k} {i}: {error:e}");
                for l in 0..N {
                    for j in 0..3 {
                        let exact = if k >= l { hessian[k][l][(i, j)] } else { hessian[l][k][(j, i)] };
                        let difference = slope(4e-3, |x| derivatives(&moved(k, i, x)).0[l][j]);
                        let error = (difference - exact).abs() / most;
                        assert!(error < 1e-8, "hessian {k}{i} {l}{j}: {error:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn derivatives_of_the_densities_agree_with_differences() {
        assert!(samples().len() > 100);
        for (functional, softening) in [(Mvc, 0.0), (Mec, 0.0), (Mvc, 0.4), (Mec, 0.4)] {
            for d in samples() {
                let found = space_density_derivatives(functional, softening, &d);
                assert_eq!(found.value.to_bits(), space_density(functional, softening, &d).to_bits());
                compare(
                    &d,
                    |d| space_density(functional, softening, d),
                    |d| {
                        let found = space_density_derivatives(functional, softening, d);
                        (found.gradient, found.hessian)
                    },
                );
            }
        }
    }

    #[test]
    fn derivatives_of_torsion_agree_with_differences() {
        for [d1, d2, d3, _] in samples() {
            let d = [d1, d2, d3];
            for softening in [0.0, 0.4] {
                assert_eq!(
                    torsion_derivatives(softening, &d).value.to_bits(),
                    torsion(softening, &d).to_bits()
                );
                compare(
                    &d,
                    |d| torsion(softening, d),
                    |d| {
                        let found = torsion_derivatives(softening, d);
                        (found.gradient, found.hessian)
                    },
                );
            }
        }
    }

    #[test]
    fn softened_torsion_vanishes_with_curvature() {
        for [d1, d2, d3, d4] in samples() {
            let plain = torsion(0.0, &[d1, d2, d3]);
            let normal = d1.cross(&d2);
            let p = d1.dot(&d1);
            let square = normal.dot(&normal) / (p * p * p);
            let expected = plain * square / (square + 0.09);
            let found = torsion(0.3, &[d1, d2, d3]);
            assert!((found - expected).abs() < 1e-13 * (1.0 + plain.abs()), "{found} {expected}");
            // Straight here: no torsion, and densities that are finite.
            assert_eq!(torsion(0.3, &[d1, d1 * 2.0, d3]), 0.0);
            for functional in [Mvc, Mec] {
                let found = space_density_derivatives(functional, 0.3, &[d1, d1 * 2.0, d3, d4]);
                assert!(found.value.is_finite());
                assert!(found.gradient.iter().all(|part| part.amax().is_finite()));
            }
        }
    }

    /// The derivatives of a curve of which `d` are the derivatives by another parameter, of which `g` are the
    /// derivatives by the new one.
    fn reparametrised(d: &[Vector; 4], g: &[f64; 4]) -> [Vector; 4] {
        let [g1, g2, g3, g4] = *g;
        [
            d[0] * g1,
            d[1] * (g1 * g1) + d[0] * g2,
            d[2] * (g1 * g1 * g1) + d[1] * (3.0 * g1 * g2) + d[0] * g3,
            d[3] * (g1 * g1 * g1 * g1)
                + d[2] * (6.0 * g1 * g1 * g2)
                + d[1] * (3.0 * g2 * g2 + 4.0 * g1 * g3)
                + d[0] * g4,
        ]
    }

    /// `C' … C''''` of `(r cos t, r sin t, c t)`.
    fn helix(r: f64, c: f64, t: f64) -> [Vector; 4] {
        let (x, y) = (r * libm::cos(t), r * libm::sin(t));
        [Vector::new(-y, x, c), Vector::new(-x, -y, 0.0), Vector::new(y, -x, 0.0), Vector::new(x, y, 0.0)]
    }

    #[test]
    fn a_helix_has_no_variation_and_constant_curvature_and_torsion() {
        for seed in 1..50 {
            let [r, c, t, g1, g2, g3, g4] = numbers::<7>(seed);
            let r = r.abs() + 0.3;
            let speed = g1 + 1.5;
            let d = reparametrised(&helix(r, c, 3.0 * t), &[speed, g2, g3, g4]);
            let square = r * r + c * c;
            let (curvature, twist) = (r / square, c / square);
            let ds = speed * sqrt(square);
            let found = torsion(0.0, &[d[0], d[1], d[2]]);
            assert!((found - twist).abs() < 1e-13 * (1.0 + twist.abs()), "{found} {twist}");
            let energy = space_density(Mec, 0.0, &d);
            let expected = (curvature * curvature + twist * twist) * ds;
            assert!((energy - expected).abs() < 1e-12 * expected, "{energy} {expected}");
            let variation = space_density_derivatives(Mvc, 0.0, &d);
            assert!(variation.value < 1e-22, "{}", variation.value);
            for part in variation.gradient {
                assert!(part.amax() < 1e-9, "{part}");
            }
        }
    }

    /// `C' … C''''` of a knot on a torus, all of them sums of sines.
    fn knot(t: f64) -> [Vector; 4] {
        // (2 + cos 3t)(cos 2t, sin 2t) = 2 (cos 2t, sin 2t) + ½ (cos 5t + cos t, sin 5t − sin t), and sin 3t.
        core::array::from_fn(|k| {
            let wave = |a: f64, power: f64, quarter: usize| {
                let order = k + 1;
                let scale = (0..order).fold(a, |product, _| product * power);
                match (quarter + order) % 4 {
                    0 => scale * libm::cos(power * t),
                    1 => -scale * libm::sin(power * t),
                    2 => -scale * libm::cos(power * t),
                    _ => scale * libm::sin(power * t),
                }
            };
            Vector::new(
                wave(2.0, 2.0, 0) + wave(0.5, 5.0, 0) + wave(0.5, 1.0, 0),
                wave(2.0, 2.0, 3) + wave(0.5, 5.0, 3) - wave(0.5, 1.0, 3),
                wave(1.0, 3.0, 3),
            )
        })
    }

    #[test]
    fn the_densities_are_those_of_curvature_and_torsion_along_a_curve() {
        // The Frenet equations by differences of unit vectors: T' = κ |C'| N, B' = −τ |C'| N.
        let speed = |t: f64| knot(t)[0].norm();
        let tangent = |t: f64| knot(t)[0].normalize();
        let binormal = |t: f64| knot(t)[0].cross(&knot(t)[1]).normalize();
        let along = |t: f64, f: &dyn Fn(f64) -> Vector| {
            Vector::from_fn(|i, _| slope(2e-2, |x| f(t + x)[i])) / speed(t)
        };
        let curvature = |t: f64| along(t, &tangent).norm();
        let twist = |t: f64| -along(t, &binormal).dot(&binormal(t).cross(&tangent(t)));
        for i in 0..40 {
            let t = 0.157 * f64::from(i);
            let d = knot(t);
            let (k, w) = (curvature(t), twist(t));
            assert!((torsion(0.0, &[d[0], d[1], d[2]]) - w).abs() < 1e-9, "{i}");
            let energy = (k * k + w * w) * speed(t);
            assert!((space_density(Mec, 0.0, &d) - energy).abs() < 1e-8 * energy, "{i}");
            let (dk, dw) = (slope(2e-2, |x| curvature(t + x)), slope(2e-2, |x| twist(t + x)));
            let variation = (dk * dk + dw * dw) / speed(t);
            let found = space_density(Mvc, 0.0, &d);
            assert!((found - variation).abs() < 1e-6 * (variation + 1e-3), "{i}: {found} {variation}");
        }
    }

    #[test]
    fn the_densities_belong_to_the_shape() {
        for (seed, d) in (1..).zip(samples()) {
            let [a, b, c, g1, g2, g3, g4, grow] = numbers::<8>(seed);
            let turn = nalgebra::Rotation3::new(Vector::new(a, b, c) * 3.0);
            let g = [g1 + 1.5, g2, g3, g4];
            let scale = grow + 1.5;
            for (functional, power) in [(Mvc, scale * scale * scale), (Mec, scale)] {
                let value = space_density(functional, 0.0, &d);
                let close = |found: f64, expected: f64| {
                    assert!((found - expected).abs() < 1e-10 * expected, "{seed}: {found} {expected}");
                };
                close(space_density(functional, 0.0, &d.map(|x| turn * x)), value);
                close(space_density(functional, 0.0, &d.map(|x| x * scale)), value / power);
                close(space_density(functional, 0.0, &reparametrised(&d, &g)), value * g[0]);
            }
        }
    }

    #[test]
    fn a_density_is_infinite_where_the_curve_is_irregular_or_straight() {
        let [a, b, c, _] = vectors::<4>(3);
        let zero = Vector::zeros();
        for functional in [Mvc, Mec] {
            for d in [[zero, a, b, c], [a, zero, b, c], [a, a * 2.0, b, c], [a, a, a, a], [zero; 4]] {
                assert_eq!(space_density(functional, 0.0, &d), f64::INFINITY);
                let found = space_density_derivatives(functional, 0.0, &d);
                assert_eq!(found.value, f64::INFINITY);
                assert_eq!(found.gradient, [zero; 4]);
            }
        }
    }
}
