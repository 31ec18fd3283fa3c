//! The densities in space: `N = p (d1×d3) − 3 (d1·d2) u` and `u = d1×d2` are vectors, everything a function of them and of
//! `p = d1·d1`.

use super::{Block, Density, Local, Powers, Shape, Weighted};
use crate::basis::lanes::Lanes;

type Vector = [Lanes; 3];

#[inline(always)]
fn dot(a: &Vector, b: &Vector) -> Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn times(a: &Vector, by: Lanes) -> Vector {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// The matrix that takes `x` to `a × x`.
#[inline(always)]
fn skew(a: &Vector) -> Block<3> {
    let zero = Lanes::ZERO;
    [[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]]
}

/// `Jᵀ y`.
#[inline(always)]
fn back(j: &Block<3>, y: &Vector) -> Vector {
    core::array::from_fn(|x| j[0][x] * y[0] + j[1][x] * y[1] + j[2][x] * y[2])
}

#[inline(always)]
fn add_product(h: &mut Block<3>, j: &Block<3>, k: &Block<3>, by: Lanes) {
    for x in 0..3 {
        let column = [j[0][x] * by, j[1][x] * by, j[2][x] * by];
        for y in 0..3 {
            h[x][y] += column[0] * k[0][y] + column[1] * k[1][y] + column[2] * k[2][y];
        }
    }
}

#[inline(always)]
fn add_outer(h: &mut Block<3>, a: &Vector, b: &Vector) {
    for x in 0..3 {
        for y in 0..3 {
            h[x][y] += a[x] * b[y];
        }
    }
}

#[inline(always)]
fn add_symmetric(h: &mut Block<3>, a: &Vector, b: &Vector) {
    for x in 0..3 {
        for y in 0..3 {
            h[x][y] += a[x] * b[y] + b[x] * a[y];
        }
    }
}

#[inline(always)]
fn add_scaled(h: &mut Block<3>, m: &Block<3>, by: Lanes) {
    for x in 0..3 {
        for y in 0..3 {
            h[x][y] += m[x][y] * by;
        }
    }
}

#[inline(always)]
fn add_identity(h: &mut Block<3>, by: Lanes) {
    for x in 0..3 {
        h[x][x] += by;
    }
}

struct Products {
    p: Lanes,
    q: Lanes,
    u: Vector,
    v: Vector,
    n: Vector,
}

#[inline(always)]
fn products(d: &[Vector; 3]) -> Products {
    let [d1, d2, d3] = d;
    let (p, q) = (dot(d1, d1), dot(d1, d2));
    let (u, v) = (cross(d1, d2), cross(d1, d3));
    let q3 = q * 3.0;
    let n = core::array::from_fn(|w| p * v[w] - q3 * u[w]);
    Products { p, q, u, v, n }
}

impl Density<3> for Shape<3> {
    #[inline(always)]
    fn slope(d: &[Vector; 3]) -> Vector {
        let s = products(d);
        let cube = Lanes::ONE / (s.p * s.p * s.p);
        times(&s.n, cube)
    }

    #[inline(always)]
    fn value(weights: &Weighted, target: &Vector, d: &[Vector; 3]) -> Local<3> {
        let s = products(d);
        let powers = Powers::of(s.p);
        let mut local = Local::ZERO;
        local.length = powers.speed;
        let off = core::array::from_fn(|w| s.n[w] * powers.cube - target[w]);
        local.value = dot(&off, &off) * powers.speed * weights.variation
            + dot(&s.u, &s.u) * powers.fifth * weights.bending
            + powers.speed * weights.length;
        local
    }

    #[inline(always)]
    fn integrals(d: &[Vector; 3]) -> [Lanes; 3] {
        let s = products(d);
        let powers = Powers::of(s.p);
        [dot(&s.n, &s.n) * powers.eleventh, dot(&s.u, &s.u) * powers.fifth, powers.speed]
    }

    #[inline(always)]
    fn derivatives(weights: &Weighted, target: &Vector, d: &[Vector; 3]) -> Local<3> {
        let [d1, d2, d3] = d;
        let Products { p, q, u, v, n } = products(d);
        let powers = Powers::of(p);
        let ip = powers.inverse;
        let mut local = Local::ZERO;
        local.length = powers.speed;
        local.length_gradient = times(d1, powers.inverse_speed);
        let p1 = times(d1, Lanes([2.0; 2]));
        let length = weights.length;
        local.value = powers.speed * weights.length;
        let mut by_p = length * powers.inverse_speed * 0.5;
        let mut by_pp = length * powers.speed * (-0.25) * (ip * ip);
        let g = &mut local.gradient;
        let h = &mut local.hessian;

        if weights.varies {
            let w = weights.variation;
            let off = core::array::from_fn(|k| n[k] * powers.cube - target[k]);
            local.value += dot(&off, &off) * powers.speed * w;
            let by_nn = powers.eleventh * w * 2.0;
            let by_n = times(&off, powers.fifth * w * 2.0);
            let (nn, nr, rr) = (dot(&n, &n), dot(&n, target), dot(target, target));
            let by_np: Vector = core::array::from_fn(|k| {
                (n[k] * powers.eleventh * (-11.0) + target[k] * powers.fifth * 5.0) * ip * w
            });
            by_p += (nn * powers.eleventh * (-5.5) + nr * powers.fifth * 5.0) * ip * w
                + rr * powers.inverse_speed * w * 0.5;
            by_pp += ((nn * powers.eleventh * 35.75 - nr * powers.fifth * 17.5) * w
                - rr * powers.speed * w * 0.25)
                * (ip * ip);
            let (q3, s1, s2, s3) = (q * 3.0, skew(d1), skew(d2), skew(d3));
            let (v2, u3) = (times(&v, Lanes([2.0; 2])), times(&u, Lanes([3.0; 2])));
            let mut j = [[[Lanes::ZERO; 3]; 3]; 3];
            for k in 0..3 {
                for x in 0..3 {
                    j[0][k][x] = v2[k] * d1[x] - p * s3[k][x] - u3[k] * d2[x] + q3 * s2[k][x];
                    j[1][k][x] = -(u3[k] * d1[x]) - q3 * s1[k][x];
                    j[2][k][x] = p * s1[k][x];
                }
            }
            for k in 0..3 {
                g[k] = back(&j[k], &by_n);
                for l in 0..=k {
                    add_product(&mut h[k][l], &j[k], &j[l], by_nn);
                }
                let z = back(&j[k], &by_np);
                add_outer(&mut h[k][0], &z, &p1);
                if k == 0 {
                    add_outer(&mut h[0][0], &p1, &z);
                }
            }
            // y·N with y = F_N held.
            let y = by_n;
            let by_last = cross(&y, d1);
            let (a1, b1) = (cross(d3, &y), cross(d2, &y));
            let b1_3 = times(&b1, Lanes([-3.0; 2]));
            let last_3 = times(&by_last, Lanes([-3.0; 2]));
            let sy = skew(&y);
            add_identity(&mut h[0][0], dot(&y, &v) * 2.0);
            add_symmetric(&mut h[0][0], &p1, &a1);
            add_symmetric(&mut h[0][0], d2, &b1_3);
            add_identity(&mut h[1][0], dot(&y, &u) * (-3.0));
            add_outer(&mut h[1][0], d1, &b1_3);
            add_outer(&mut h[1][0], &last_3, d2);
            add_scaled(&mut h[1][0], &sy, -q3);
            add_symmetric(&mut h[1][1], d1, &last_3);
            add_outer(&mut h[2][0], &by_last, &p1);
            add_scaled(&mut h[2][0], &sy, p);
        }
        if weights.bends {
            let w = weights.bending;
            let fifth = powers.fifth * w;
            let uu = dot(&u, &u);
            local.value += uu * fifth;
            let by_uu = fifth * 2.0;
            let by_u = times(&u, by_uu);
            let by_up = times(&by_u, ip * (-2.5));
            let part = uu * by_uu * ip * (-2.5);
            by_p += part * 0.5;
            by_pp += part * ip * (-1.75);
            let (u1, u2) = (skew(&times(d2, Lanes([-1.0; 2]))), skew(d1));
            for (k, one) in [&u1, &u2].into_iter().enumerate() {
                let slope = back(one, &by_u);
                for x in 0..3 {
                    g[k][x] += slope[x];
                }
                add_product(&mut h[k][0], one, &u1, by_uu);
                let z = back(one, &by_up);
                add_outer(&mut h[k][0], &z, &p1);
                if k == 0 {
                    add_outer(&mut h[0][0], &p1, &z);
                }
            }
            add_product(&mut h[1][1], &u2, &u2, by_uu);
            add_scaled(&mut h[1][0], &skew(&by_u), Lanes::ONE);
        }
        for x in 0..3 {
            g[0][x] += by_p * p1[x];
            for y in 0..3 {
                h[0][0][x][y] += by_pp * p1[x] * p1[y];
            }
        }
        add_identity(&mut h[0][0], by_p * 2.0);
        local
    }
}
