//! The functions of which a direction is made, tabulated at Gauss–Legendre points.
//!
//! The first four are the cubic Hermite functions `h₀₀, h₁₀, h₀₁, h₁₁` of `u` in [0, 1]. The others vanish at both ends
//! with their slopes, and their second derivatives are the Legendre polynomials `P₂, P₃, …` of `m = 2u − 1`, which are
//! orthogonal to each other and to everything linear: the Hessian of `∫ θ''² du` is diagonal in them.

use crate::basis::lanes::{Lanes, WIDTH};
use crate::basis::quadrature::legendre;

/// The values, first and second derivatives of the first `N` functions at `u`.
pub(super) const fn functions<const N: usize>(u: f64) -> [[f64; N]; 3] {
    let (v, m) = (1.0 - u, 2.0 * u - 1.0);
    let hermite = [
        [(1.0 + 2.0 * u) * v * v, u * v * v, u * u * (3.0 - 2.0 * u), -u * u * v],
        [-6.0 * u * v, v * (1.0 - 3.0 * u), 6.0 * u * v, u * (3.0 * u - 2.0)],
        [6.0 * m, 6.0 * u - 4.0, -6.0 * m, 6.0 * u - 2.0],
    ];
    let mut out = [[0.0; N]; 3];
    let mut k = 0;
    while k < 3 {
        let mut i = 0;
        while i < 4 && i < N {
            out[k][i] = hermite[k][i];
            i += 1;
        }
        k += 1;
    }
    // Legendre polynomials by their recurrence, five at a time: P_{n−2} … P_{n+2}.
    let mut p = [1.0, m, 0.5 * (3.0 * m * m - 1.0), 0.0, 0.0];
    p[3] = (5.0 * m * p[2] - 2.0 * p[1]) / 3.0;
    p[4] = (7.0 * m * p[3] - 3.0 * p[2]) / 4.0;
    let mut i = 4;
    while i < N {
        let n = (i - 2) as f64;
        out[0][i] = 0.25
            * (p[4] / ((2.0 * n + 1.0) * (2.0 * n + 3.0)) - 2.0 * p[2] / ((2.0 * n - 1.0) * (2.0 * n + 3.0))
                + p[0] / ((2.0 * n - 1.0) * (2.0 * n + 1.0)));
        out[1][i] = 0.5 * (p[3] - p[1]) / (2.0 * n + 1.0);
        out[2][i] = p[2];
        let last = n + 2.0;
        let next = ((2.0 * last + 1.0) * m * p[4] - last * p[3]) / (last + 1.0);
        p = [p[1], p[2], p[3], p[4], next];
        i += 1;
    }
    out
}

/// The first three derivatives of the direction with these coefficients.
#[inline(always)]
pub(super) fn slopes<const N: usize>(q: &[f64; N], u: Lanes) -> [Lanes; 3] {
    let one = Lanes::ONE;
    let (v, m) = (one - u, u * 2.0 - one);
    let (uv, across) = (u * v, q[2] - q[0]);
    let first = uv * (6.0 * across) + v * (one - u * 3.0) * q[1] + u * (u * 3.0 - one * 2.0) * q[3];
    let second = m * (-6.0 * across) + (u * 6.0 - one * 4.0) * q[1] + (u * 6.0 - one * 2.0) * q[3];
    let third = one * (6.0 * (q[1] + q[3]) - 12.0 * across);
    let mut out = [first, second, third];
    // P_{n−1}, P_n and their derivatives by m, from n = 2 on.
    let (mut before, mut here) = (m, m * m * 1.5 - one * 0.5);
    let (mut slope_before, mut slope_here) = (one, m * 3.0);
    for i in 4..N {
        let n = (i - 2) as f64;
        let next = (m * here * (2.0 * n + 1.0) - before * n) * (1.0 / (n + 1.0));
        out[0] += (next - before) * (0.5 * q[i] / (2.0 * n + 1.0));
        out[1] += here * q[i];
        out[2] += slope_here * (2.0 * q[i]);
        let slope_next = slope_before + here * (2.0 * n + 1.0);
        (before, here) = (here, next);
        (slope_before, slope_here) = (slope_here, slope_next);
    }
    out
}

/// The first `N` functions at `C` pairs of points.
pub(super) struct Tables<const N: usize, const C: usize> {
    pub(super) weight: [Lanes; C],
    pub(super) at: [[Lanes; N]; C],
    /// `∫ ψᵢ'' ψⱼ''` and `∫ ψᵢ' ψⱼ'`.
    pub(super) bend: [[f64; N]; N],
    pub(super) slope: [[f64; N]; N],
    /// The two functions after those.
    pub(super) beyond: [[Lanes; BEYOND]; C],
    /// Their `∫ ψ''²`, `∫ ψ'²`, and `∫ ψ' ψⱼ'`.
    pub(super) beyond_bend: [f64; BEYOND],
    pub(super) beyond_own: [f64; BEYOND],
    pub(super) beyond_slope: [[f64; N]; BEYOND],
}

/// How many functions more are looked at to tell what is left out.
pub(super) const BEYOND: usize = 2;
/// The most functions that are tabulated, with those beyond.
const MOST: usize = FINE_FUNCTIONS + BEYOND;

impl<const N: usize, const C: usize> Tables<N, C> {
    pub(super) const fn new() -> Self {
        let mut out = Self {
            weight: [Lanes::ZERO; C],
            at: [[Lanes::ZERO; N]; C],
            bend: [[0.0; N]; N],
            slope: [[0.0; N]; N],
            beyond: [[Lanes::ZERO; BEYOND]; C],
            beyond_bend: [0.0; BEYOND],
            beyond_own: [0.0; BEYOND],
            beyond_slope: [[0.0; N]; BEYOND],
        };
        if let Some(rule) = legendre(WIDTH * C) {
            let mut k = 0;
            while k < WIDTH * C {
                let (u, w) = (rule.nodes[k], rule.weights[k]);
                let f = functions::<MOST>(u);
                out.weight[k / WIDTH].0[k % WIDTH] = w;
                let mut i = 0;
                while i < N {
                    out.at[k / WIDTH][i].0[k % WIDTH] = f[0][i];
                    let mut j = 0;
                    while j < N {
                        out.bend[i][j] += w * f[2][i] * f[2][j];
                        out.slope[i][j] += w * f[1][i] * f[1][j];
                        j += 1;
                    }
                    i += 1;
                }
                let mut b = 0;
                while b < BEYOND {
                    let (value, slope, bend) = (f[0][N + b], f[1][N + b], f[2][N + b]);
                    out.beyond[k / WIDTH][b].0[k % WIDTH] = value;
                    out.beyond_bend[b] += w * bend * bend;
                    out.beyond_own[b] += w * slope * slope;
                    let mut j = 0;
                    while j < N {
                        out.beyond_slope[b][j] += w * slope * f[1][j];
                        j += 1;
                    }
                    b += 1;
                }
                k += 1;
            }
        }
        out
    }
}

/// Few functions: to begin with.
pub(super) static COARSE: Tables<6, 4> = Tables::new();
/// Many: what a true curve is written with.
pub(super) static FINE: Tables<FINE_FUNCTIONS, FINE_PAIRS> = Tables::new();
pub(super) const FINE_PAIRS: usize = 16;
/// How many functions [`FINE`] has.
pub(super) const FINE_FUNCTIONS: usize = 24;

/// Sine and cosine to 1e-9 up to a turn of 4 radians: cheaper side by side than one by one.
#[inline(always)]
pub(super) fn rough_sine_cosine(angle: Lanes) -> [Lanes; 2] {
    let x = angle * 0.25;
    let z = x * x;
    let one = Lanes::ONE;
    let mut s = z * (-1.0 / 39_916_800.0) + one * (1.0 / 362_880.0);
    s = z * s + one * (-1.0 / 5_040.0);
    s = z * s + one * (1.0 / 120.0);
    s = z * s + one * (-1.0 / 6.0);
    s = x * (z * s + one);
    let mut c = z * (1.0 / 479_001_600.0) + one * (-1.0 / 3_628_800.0);
    c = z * c + one * (1.0 / 40_320.0);
    c = z * c + one * (-1.0 / 720.0);
    c = z * c + one * (1.0 / 24.0);
    c = z * c + one * (-0.5);
    c = z * c + one;
    for _ in 0..2 {
        let double = s * c * 2.0;
        c = one - s * s * 2.0;
        s = double;
    }
    [s, c]
}

/// Sine and cosine to rounding.
#[inline(always)]
pub(super) fn sine_cosine(angle: Lanes) -> [Lanes; 2] {
    let (s, c) = (angle.0.map(libm::sin), angle.0.map(libm::cos));
    [Lanes(s), Lanes(c)]
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    #[test]
    fn derivatives_of_the_functions_agree_with_differences() {
        let h = 1e-5;
        for step in 0..=20 {
            let u = f64::from(step) / 20.0;
            let [here, up, down] = [u, u + h, u - h].map(functions::<FINE_FUNCTIONS>);
            for i in 0..FINE_FUNCTIONS {
                for order in 0..2 {
                    let slope = (up[order][i] - down[order][i]) / (2.0 * h);
                    // The third derivative beyond, times h²/6, is what differences leave: up to n⁶ at the ends.
                    let n = i as f64;
                    let allowed = 1e-9 + h * h * libm::pow(n, if order == 0 { 4.0 } else { 6.0 });
                    assert!((slope - here[order + 1][i]).abs() < allowed, "{i} {order} at {u}");
                }
            }
        }
        for (u, ends) in [(0.0, [1.0, 0.0, 0.0, 0.0]), (1.0, [0.0, 0.0, 1.0, 0.0])] {
            let found = functions::<FINE_FUNCTIONS>(u);
            assert_eq!(found[0][..4], ends);
            for i in 4..FINE_FUNCTIONS {
                assert!(found[0][i].abs() < 1e-15 && found[1][i].abs() < 1e-15, "{i}");
            }
        }
    }

    /// The direction's derivatives, by recurrences of their own: those of the functions, and a difference of the last.
    #[test]
    fn slopes_are_the_derivatives_of_the_direction() {
        let q: [f64; FINE_FUNCTIONS] =
            core::array::from_fn(|i| if i % 3 == 0 { 0.5 - i as f64 } else { 1.0 / (1.0 + i as f64) });
        let h = 1e-6;
        for step in 0..=16 {
            let u = [f64::from(step) / 20.0, 0.1 + f64::from(step) / 20.0];
            let found = slopes(&q, Lanes(u));
            for lane in 0..2 {
                let of = |u: f64, order: usize| {
                    functions::<FINE_FUNCTIONS>(u)[order].iter().zip(&q).map(|(f, q)| f * q).sum::<f64>()
                };
                let u = u[lane];
                let third = (of(u + h, 2) - of(u - h, 2)) / (2.0 * h);
                assert!((found[0].0[lane] - of(u, 1)).abs() < 1e-11, "{u}");
                assert!((found[1].0[lane] - of(u, 2)).abs() < 1e-11, "{u}");
                assert!((found[2].0[lane] - third).abs() < 1e-4 * (1.0 + third.abs()), "{u}: {third}");
            }
        }
    }

    #[test]
    fn bends_are_orthogonal_beyond_the_cubics() {
        for i in 4..FINE_FUNCTIONS {
            for j in 0..FINE_FUNCTIONS {
                let own = if i == j { 1.0 / (2.0 * (i as f64 - 2.0) + 1.0) } else { 0.0 };
                assert!((FINE.bend[i][j] - own).abs() < 1e-13, "{i} {j}");
            }
        }
    }

    #[test]
    fn sines_are_as_near_as_said() {
        for step in -80..=80 {
            let angle = 0.05 * f64::from(step);
            let (wanted, found) =
                ([libm::sin(angle), libm::cos(angle)], rough_sine_cosine(Lanes([angle; 2])));
            for (w, f) in wanted.into_iter().zip(found) {
                assert!((f.0[0] - w).abs() < 2e-9, "{angle}: {} {w}", f.0[0]);
            }
        }
    }
}
