//! The densities in the plane, written out.
//!
//! With `d1 = (a, b)`, `d2 = (c, d)`, `d3 = (e, f)`, everything is a function of the three scalars
//! `p = d1·d1`, `u = d1∧d2` and `N = p (d1∧d3) − 3 (d1·d2) u`.

use super::{Density, Local, Normal, Powers, Shape, Weighted};
use crate::basis::lanes::Lanes;

/// `N`, `u` and `p`, and what `N` is made of.
struct Scalars {
    p: Lanes,
    q: Lanes,
    u: Lanes,
    v: Lanes,
    n: Lanes,
}

#[inline(always)]
fn scalars(d: &[[Lanes; 2]; 3]) -> Scalars {
    let [[a, b], [c, dd], [e, f]] = *d;
    let p = a * a + b * b;
    let q = a * c + b * dd;
    let u = a * dd - b * c;
    let v = a * f - b * e;
    Scalars { p, q, u, v, n: p * v - q * u * 3.0 }
}

/// The derivatives of `N` by `d1, d2, d3`.
#[inline(always)]
fn slopes_of_n(d: &[[Lanes; 2]; 3], s: &Scalars) -> [[Lanes; 2]; 3] {
    let [[a, b], [c, dd], [e, f]] = *d;
    let (u3, q3, v2) = (s.u * 3.0, s.q * 3.0, s.v * 2.0);
    [
        [a * v2 + s.p * f - c * u3 - q3 * dd, b * v2 - s.p * e - dd * u3 + q3 * c],
        [q3 * b - a * u3, -(b * u3) - q3 * a],
        [-(s.p * b), s.p * a],
    ]
}

/// `db/ds` with its derivatives by `d1, d2, d3`.
#[inline(always)]
pub(crate) fn slope_with_derivatives(d: &[[Lanes; 2]; 3]) -> (Lanes, [[Lanes; 2]; 3]) {
    let s = scalars(d);
    let inverse = Lanes::ONE / s.p;
    let cube = inverse * inverse * inverse;
    let value = s.n * cube;
    let down = value * inverse * 6.0;
    let mut by = slopes_of_n(d, &s).map(|row| row.map(|x| x * cube));
    for x in 0..2 {
        by[0][x] = by[0][x] - d[0][x] * down;
    }
    (value, by)
}

/// `b` with its derivatives by `d1, d2, d3`.
#[inline(always)]
pub(crate) fn curvature_with_derivatives(d: &[[Lanes; 2]; 3]) -> (Lanes, [[Lanes; 2]; 3]) {
    let [[a, b], [c, dd], _] = *d;
    let s = scalars(d);
    let inverse = Lanes::ONE / s.p;
    let third = inverse * (s.p.sqrt() * inverse);
    let value = s.u * third;
    let down = value * inverse * 3.0;
    let by = [[dd * third - a * down, -(c * third) - b * down], [-(b * third), a * third], [Lanes::ZERO; 2]];
    (value, by)
}

impl Density<2> for Shape<2> {
    #[inline(always)]
    fn slope(d: &[[Lanes; 2]; 3]) -> Normal {
        let s = scalars(d);
        [s.n / (s.p * s.p * s.p), Lanes::ZERO, Lanes::ZERO]
    }

    #[inline(always)]
    fn value(weights: &Weighted, target: &Normal, d: &[[Lanes; 2]; 3]) -> Local<2> {
        let s = scalars(d);
        let powers = Powers::of(s.p);
        let mut local = Local::ZERO;
        local.length = powers.speed;
        let off = s.n * powers.cube - target[0];
        local.value = off * off * powers.speed * weights.variation
            + s.u * s.u * powers.fifth * weights.bending
            + powers.speed * weights.length;
        local
    }

    #[inline(always)]
    fn integrals(d: &[[Lanes; 2]; 3]) -> [Lanes; 3] {
        let s = scalars(d);
        let powers = Powers::of(s.p);
        [s.n * s.n * powers.eleventh, s.u * s.u * powers.fifth, powers.speed]
    }

    #[inline(always)]
    fn derivatives(weights: &Weighted, target: &Normal, d: &[[Lanes; 2]; 3]) -> Local<2> {
        let [[a, b], [c, dd], [e, f]] = *d;
        let s = scalars(d);
        let Scalars { p, q, u, v, n } = s;
        let powers = Powers::of(p);
        let rho = target[0];
        let mut local = Local::ZERO;
        local.length = powers.speed;
        local.length_gradient = [a * powers.inverse_speed, b * powers.inverse_speed];

        // F = variation (N p⁻³ − ρ)² p^(1/2) + bending u² p^(−5/2) + length p^(1/2), and its derivatives.
        let w = weights.variation;
        let off = n * powers.cube - rho;
        local.value = off * off * powers.speed * w + powers.speed * weights.length;
        let w2 = w * 2.0;
        let by_nn = powers.eleventh * w2;
        let by_n = off * powers.fifth * w2;
        // The variation's part is N² p^(−11/2) − 2 ρ N p^(−5/2) + ρ² p^(1/2).
        let first = n * powers.eleventh;
        let second = rho * powers.fifth;
        let ip = powers.inverse;
        let by_np = (first * (-11.0) + second * 5.0) * ip * w;
        let rest = rho * rho * w + weights.length;
        let mut by_p = n * (first * (-5.5) + second * 5.0) * ip * w + rest * powers.inverse_speed * 0.5;
        let mut by_pp = (n * (first * 35.75 - second * 17.5) * w - rest * powers.speed * 0.25) * (ip * ip);

        let (v2, a2, b2) = (v * 2.0, a * 2.0, b * 2.0);
        let [n1, n2, n3] = slopes_of_n(d, &s);
        let p1 = [a2, b2];

        let mut g =
            [[by_n * n1[0], by_n * n1[1]], [by_n * n2[0], by_n * n2[1]], [by_n * n3[0], by_n * n3[1]]];
        // What N's and p's gradients are multiplied with from the right.
        let by_last = [by_nn * n3[0], by_nn * n3[1]];
        let by_second = [by_nn * n2[0], by_nn * n2[1]];
        let mut h = [[[[Lanes::ZERO; 2]; 2]; 3]; 3];

        // N's own second derivatives, times F_N.
        let ab = a * b;
        let (aa, bb) = (a * a, b * b);
        let second22 = [[ab * 6.0, (bb - aa) * 3.0], [(bb - aa) * 3.0, ab * (-6.0)]];
        let q6 = q * 6.0;
        let u6 = u * 6.0;
        let second21 = [[-u6, q6], [-q6, -u6]];
        let second31 = [[ab * (-2.0), -(bb * 2.0) - p], [aa * 2.0 + p, ab * 2.0]];
        let cross = b2 * f - a2 * e + (c * c - dd * dd) * 3.0;
        let cd6 = c * dd * 6.0;
        let second11 = [[v2 + a * f * 4.0 - cd6, cross], [cross, v2 - b * e * 4.0 + cd6]];

        let mut right = [[Lanes::ZERO; 2]; 2];
        for x in 0..2 {
            right[0][x] = by_nn * n1[x] + by_np * p1[x];
            right[1][x] = by_np * n1[x];
        }
        if weights.bends {
            let w = weights.bending;
            let fifth = powers.fifth * w;
            local.value += u * u * fifth;
            let by_uu = fifth * 2.0;
            let by_u = u * by_uu;
            let by_up = by_u * ip * (-2.5);
            by_p += u * by_up * 0.5;
            by_pp += u * by_up * ip * (-1.75);
            let (u1, u2) = ([dd, -c], [-b, a]);
            for x in 0..2 {
                g[0][x] += by_u * u1[x];
                g[1][x] += by_u * u2[x];
                right[1][x] += by_up * u1[x];
                for y in 0..2 {
                    h[0][0][x][y] += u1[x] * (by_uu * u1[y] + by_up * p1[y]);
                    h[1][0][x][y] += u2[x] * (by_uu * u1[y] + by_up * p1[y]);
                    h[1][1][x][y] += by_uu * u2[x] * u2[y];
                }
            }
            h[1][0][0][1] = h[1][0][0][1] - by_u;
            h[1][0][1][0] += by_u;
        }
        for x in 0..2 {
            right[1][x] += by_pp * p1[x];
            g[0][x] += by_p * p1[x];
        }
        for x in 0..2 {
            for y in 0..2 {
                // n1 (F_NN n1 + F_Np p1) + p1 (F_Np n1 + F_pp p1 + F_up u1): symmetric though it does not look it.
                h[0][0][x][y] += n1[x] * right[0][y] + p1[x] * right[1][y] + by_n * second11[x][y];
                h[1][0][x][y] += n2[x] * right[0][y] + by_n * second21[x][y];
                h[2][0][x][y] = n3[x] * right[0][y] + by_n * second31[x][y];
                h[1][1][x][y] += by_second[x] * n2[y] + by_n * second22[x][y];
                h[2][1][x][y] = by_last[x] * n2[y];
                h[2][2][x][y] = by_last[x] * n3[y];
            }
            h[0][0][x][x] += by_p * 2.0;
        }
        local.gradient = g;
        local.hessian = h;
        local
    }
}
