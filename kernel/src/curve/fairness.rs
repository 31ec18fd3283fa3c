//! The fairness functionals and their exact derivatives (thesis 4.2, 4.7, 4.8).
//!
//! With `d1, d2, d3` the parametric derivatives, `p = d1·d1`, `q = d1·d2` and `∧` the exterior product (a scalar in
//! the plane, the cross product in space), the curvature vector in its binormal form is `b = d1∧d2 / p^(3/2)`, and
//!
//! ```text
//! MVC  ∫ |db/ds|² ds = ∫ |N|² p^(-11/2) dt,   N = p (d1∧d3) − 3 q (d1∧d2)      thesis (4.9)
//! MEC  ∫ |b|²     ds = ∫ |N|² p^(-5/2)  dt,   N = d1∧d2                         thesis (4.1)
//! ```
//!
//! The thesis prints `du = C''×C'''` in 4.7, which must be `C'×C'''`. Both densities have the form `|N|² p^(-m/2)`
//! with `N` a polynomial, and so have their derivatives.

use nalgebra::{SMatrix, SVector};

/// What a curve is to minimise.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Functional(pub u32);

impl Functional {
    /// The variation of curvature, `∫ (dκ/ds)² ds` with `κ` the binormal curvature vector (thesis 4.2); 1/length³.
    pub const MVC: Self = Self(0);
    /// The bending energy, `∫ κ² ds` (thesis 4.1); 1/length.
    pub const MEC: Self = Self(1);

    /// The power of the length by which the functional's value shrinks when the shape grows.
    pub(crate) const fn scale_power(self) -> i32 {
        if self.0 == Self::MEC.0 { 1 } else { 3 }
    }

    /// Whether the code is one of the above.
    pub const fn is_known(self) -> bool {
        self.0 <= Self::MEC.0
    }
}

/// The exterior product of a dimension, written into three components of which the plane uses the last.
pub(crate) trait Exterior<const D: usize> {
    /// The first component in use.
    const FIRST: usize;
    /// `a ∧ b`.
    fn wedge(a: &SVector<f64, D>, b: &SVector<f64, D>) -> [f64; 3];
    /// `n × a`, restricted to the dimension: `n·(a∧x) = x·(n × a)`.
    fn cross(n: &[f64; 3], a: &SVector<f64, D>) -> SVector<f64, D>;
}

/// A dimension to hang [`Exterior`] on.
pub(crate) struct Dimension<const D: usize>;

impl Exterior<2> for Dimension<2> {
    const FIRST: usize = 2;

    #[inline]
    fn wedge(a: &SVector<f64, 2>, b: &SVector<f64, 2>) -> [f64; 3] {
        [0.0, 0.0, a[0] * b[1] - a[1] * b[0]]
    }

    #[inline]
    fn cross(n: &[f64; 3], a: &SVector<f64, 2>) -> SVector<f64, 2> {
        SVector::from([-n[2] * a[1], n[2] * a[0]])
    }
}

impl Exterior<3> for Dimension<3> {
    const FIRST: usize = 0;

    #[inline]
    fn wedge(a: &SVector<f64, 3>, b: &SVector<f64, 3>) -> [f64; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    #[inline]
    fn cross(n: &[f64; 3], a: &SVector<f64, 3>) -> SVector<f64, 3> {
        SVector::from([n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]])
    }
}

/// A density with its derivatives by `d1, d2, d3`. Of the second derivatives only the blocks `h[k][l]`, `k >= l`,
/// are filled.
pub(crate) struct Density<const D: usize> {
    pub(crate) value: f64,
    pub(crate) gradient: [SVector<f64, D>; 3],
    pub(crate) hessian: [[SMatrix<f64, D, D>; 3]; 3],
}

/// The density of a functional at a point of a curve with derivatives `d = [C', C'', C''']`; not finite where the
/// curve is irregular.
pub(crate) fn density<const D: usize>(functional: Functional, d: &[SVector<f64, D>; 3]) -> f64
where
    Dimension<D>: Exterior<D>,
{
    let [d1, d2, d3] = d;
    let p = d1.dot(d1);
    let mut sum = 0.0;
    let u = Dimension::<D>::wedge(d1, d2);
    if functional == Functional::MEC {
        for w in Dimension::<D>::FIRST..3 {
            sum += u[w] * u[w];
        }
        sum / (p * p * libm::sqrt(p))
    } else {
        let q = d1.dot(d2);
        let v = Dimension::<D>::wedge(d1, d3);
        for w in Dimension::<D>::FIRST..3 {
            let n = p * v[w] - 3.0 * q * u[w];
            sum += n * n;
        }
        sum / (p * p * p * p * p * libm::sqrt(p))
    }
}

/// `[n]×` restricted to the dimension: the matrix that takes `x` to `n × x`.
#[inline]
fn skew<const D: usize>(n: &[f64; 3]) -> SMatrix<f64, D, D>
where
    Dimension<D>: Exterior<D>,
{
    let mut out = SMatrix::<f64, D, D>::zeros();
    for c in 0..D {
        let mut unit = SVector::<f64, D>::zeros();
        unit[c] = 1.0;
        out.set_column(c, &Dimension::<D>::cross(n, &unit));
    }
    out
}

/// The density with its exact first and second derivatives.
pub(crate) fn density_derivatives<const D: usize>(
    functional: Functional,
    d: &[SVector<f64, D>; 3],
) -> Density<D>
where
    Dimension<D>: Exterior<D>,
{
    let [d1, d2, d3] = d;
    let zero = SVector::<f64, D>::zeros();
    let zero_matrix = SMatrix::<f64, D, D>::zeros();
    let p = d1.dot(d1);
    let u = Dimension::<D>::wedge(d1, d2);
    let bending = functional == Functional::MEC;
    let m = if bending { 2.5 } else { 5.5 };
    let power = if bending { p * p * libm::sqrt(p) } else { p * p * p * p * p * libm::sqrt(p) };

    // f = |N|² P with P = p^(-m); its derivatives by p.
    let f = 1.0 / power;
    let f1 = -m * f / p;
    let f2 = m * (m + 1.0) * f / (p * p);

    let mut square = 0.0;
    // Half the gradient of |N|², and the matrix Σ ∇N ∇Nᵀ + N ∇²N, by blocks.
    let mut half = [zero; 3];
    let mut h = [[zero_matrix; 3]; 3];
    let mut numerator = [0.0; 3];
    let q = d1.dot(d2);
    let v = Dimension::<D>::wedge(d1, d3);
    for w in Dimension::<D>::FIRST..3 {
        let mut unit = [0.0; 3];
        unit[w] = 1.0;
        // d(a∧b)·e_w: by a it is b × e_w = −e_w × b, by b it is e_w × a.
        let by_second = Dimension::<D>::cross(&unit, d1);
        let u_first = -Dimension::<D>::cross(&unit, d2);
        let (n, rows) = if bending {
            (u[w], [u_first, by_second, zero])
        } else {
            let v_first = -Dimension::<D>::cross(&unit, d3);
            let n = p * v[w] - 3.0 * q * u[w];
            let row1 = d1 * (2.0 * v[w]) + v_first * p - d2 * (3.0 * u[w]) - u_first * (3.0 * q);
            let row2 = -(d1 * (3.0 * u[w]) + by_second * (3.0 * q));
            (n, [row1, row2, by_second * p])
        };
        numerator[w] = n;
        square += n * n;
        for k in 0..3 {
            half[k] += rows[k] * n;
            for l in 0..=k {
                h[k][l] += rows[k] * rows[l].transpose();
            }
        }
    }

    let skew_n = skew::<D>(&numerator);
    if bending {
        // ∇²(N·(d1∧d2)): the block (d2, d1) is [N]×.
        h[1][0] += skew_n;
    } else {
        // N·(p (d1∧d3) − 3 q (d1∧d2)) with N held: a = N·(d1∧d3), b = N·(d1∧d2).
        let n = &numerator;
        let a = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
        let b = n[0] * u[0] + n[1] * u[1] + n[2] * u[2];
        let by_last = Dimension::<D>::cross(n, d1);
        let a1 = -Dimension::<D>::cross(n, d3);
        let b1 = -Dimension::<D>::cross(n, d2);
        let identity = SMatrix::<f64, D, D>::identity();
        h[0][0] += identity * (2.0 * a) + symmetric(&(d1 * 2.0), &a1) - symmetric(d2, &b1) * 3.0;
        h[1][0] -= (identity * b + d1 * b1.transpose() + by_last * d2.transpose() + skew_n * q) * 3.0;
        h[1][1] -= symmetric(d1, &by_last) * 3.0;
        h[2][0] += by_last * (d1 * 2.0).transpose() + skew_n * p;
    }

    let mut gradient = [zero; 3];
    for k in 0..3 {
        gradient[k] = half[k] * (2.0 * f);
        for l in 0..=k {
            h[k][l] *= 2.0 * f;
        }
    }
    gradient[0] += d1 * (2.0 * f1 * square);
    for k in 0..3 {
        // 2 half ⊗ ∇P + ∇P ⊗ 2 half, with ∇P = 2 f1 d1 in the first block.
        h[k][0] += half[k] * (d1 * (4.0 * f1)).transpose();
    }
    h[0][0] += d1 * (half[0] * (4.0 * f1)).transpose()
        + SMatrix::<f64, D, D>::identity() * (2.0 * f1 * square)
        + d1 * (d1 * (4.0 * f2 * square)).transpose();
    Density { value: square * f, gradient, hessian: h }
}

/// The evenness of a parametrisation, `∫ (d ln|C'|/dt)² dt = ∫ (q/p)² dt`: no property of the shape, 0 where the
/// parameter is proportional to the arc length.
pub(crate) fn evenness<const D: usize>(d: &[SVector<f64, D>; 3]) -> f64 {
    let r = d[0].dot(&d[1]) / d[0].dot(&d[0]);
    r * r
}

/// Adds the evenness, times a weight, to a density with its derivatives.
pub(crate) fn add_evenness<const D: usize>(weight: f64, d: &[SVector<f64, D>; 3], to: &mut Density<D>) {
    let [d1, d2, _] = d;
    let (p, q) = (d1.dot(d1), d1.dot(d2));
    let r = q / p;
    let (by1, by2) = (d2 / p - d1 * (2.0 * r / p), d1 / p);
    let identity = SMatrix::<f64, D, D>::identity();
    let second11 = identity * (-2.0 * r / p) - symmetric(d1, d2) * (2.0 / (p * p))
        + d1 * d1.transpose() * (8.0 * r / (p * p));
    let second21 = identity / p - d1 * d1.transpose() * (2.0 / (p * p));
    let twice = 2.0 * weight;
    to.value += weight * r * r;
    to.gradient[0] += by1 * (twice * r);
    to.gradient[1] += by2 * (twice * r);
    to.hessian[0][0] += (by1 * by1.transpose() + second11 * r) * twice;
    to.hessian[1][0] += (by2 * by1.transpose() + second21 * r) * twice;
    to.hessian[1][1] += by2 * by2.transpose() * twice;
}

/// `a bᵀ + b aᵀ`.
#[inline]
fn symmetric<const D: usize>(a: &SVector<f64, D>, b: &SVector<f64, D>) -> SMatrix<f64, D, D> {
    a * b.transpose() + b * a.transpose()
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    fn sample<const D: usize>(seed: u64) -> [SVector<f64, D>; 3] {
        let mut x = seed;
        let mut next = || {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (x >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        core::array::from_fn(|_| SVector::from_fn(|_, _| next() * 2.0))
    }

    fn derivatives_agree<const D: usize>(functional: Functional)
    where
        Dimension<D>: Exterior<D>,
    {
        for seed in 1..40 {
            let d = sample::<D>(seed);
            if d[0].norm() < 0.3 {
                continue;
            }
            let found = density_derivatives(functional, &d);
            let value = density(functional, &d);
            assert!((found.value - value).abs() <= 1e-13 * value.abs());
            let scale = found.hessian.iter().flatten().fold(1.0f64, |most, block| most.max(block.amax()));
            let h = 1e-6;
            for k in 0..3 {
                for i in 0..D {
                    let (mut up, mut down) = (d, d);
                    up[k][i] += h;
                    down[k][i] -= h;
                    let slope = (density(functional, &up) - density(functional, &down)) / (2.0 * h);
                    assert!((slope - found.gradient[k][i]).abs() < 1e-7 * scale, "gradient {k} {i}");
                    let (up, down) =
                        (density_derivatives(functional, &up), density_derivatives(functional, &down));
                    for l in 0..3 {
                        for j in 0..D {
                            let second = (up.gradient[l][j] - down.gradient[l][j]) / (2.0 * h);
                            let exact = if k >= l {
                                found.hessian[k][l][(i, j)]
                            } else {
                                found.hessian[l][k][(j, i)]
                            };
                            assert!(
                                (second - exact).abs() < 1e-6 * scale,
                                "hessian {k}{i} {l}{j}: {second} {exact}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn derivatives_of_the_densities_agree_with_differences() {
        derivatives_agree::<2>(Functional::MVC);
        derivatives_agree::<3>(Functional::MVC);
        derivatives_agree::<2>(Functional::MEC);
        derivatives_agree::<3>(Functional::MEC);
    }
}
