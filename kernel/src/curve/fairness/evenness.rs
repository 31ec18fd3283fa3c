//! The evenness of a parametrisation, `∫ (d ln|C'|/dt − e)² dt = ∫ (q/p − e)² dt`: no property of the shape. With `e =
//! 0` it is 0 where the parameter is proportional to the arc length, with `e` of another curve where it is to that of
//! the other.

use super::Local;
use crate::basis::lanes::Lanes;

#[inline(always)]
fn dot<const D: usize>(a: &[Lanes; D], b: &[Lanes; D]) -> Lanes {
    let mut sum = a[0] * b[0];
    for x in 1..D {
        sum += a[x] * b[x];
    }
    sum
}

/// `d ln|C'|/dt`.
#[inline(always)]
pub(crate) fn quickening<const D: usize>(d: &[[Lanes; D]; 3]) -> Lanes {
    dot(&d[0], &d[1]) / dot(&d[0], &d[0])
}

/// The evenness's density against the quickening of another curve.
#[inline(always)]
pub(crate) fn evenness<const D: usize>(d: &[[Lanes; D]; 3], of: Lanes) -> Lanes {
    let off = quickening(d) - of;
    off * off
}

/// Adds the evenness, times a weight, to a density with its derivatives.
#[inline(always)]
pub(crate) fn add_evenness<const D: usize>(weight: Lanes, d: &[[Lanes; D]; 3], of: Lanes, to: &mut Local<D>) {
    let [d1, d2, _] = d;
    let inverse = Lanes::ONE / dot(d1, d1);
    let r = dot(d1, d2) * inverse;
    let twice = weight * 2.0;
    let off = r - of;
    to.value += off * off * weight;
    // (r − e)² with r = q/p, whose derivative by d1 is e1 = d2/p − 2 r d1/p and by d2 e2 = d1/p.
    let e1: [Lanes; D] = core::array::from_fn(|x| (d2[x] - d1[x] * r * 2.0) * inverse);
    let e2: [Lanes; D] = core::array::from_fn(|x| d1[x] * inverse);
    let square = inverse * inverse;
    for x in 0..D {
        to.gradient[0][x] += e1[x] * off * twice;
        to.gradient[1][x] += e2[x] * off * twice;
        for y in 0..D {
            let mixed = d1[x] * d2[y] + d2[x] * d1[y];
            let second11 = (d1[x] * d1[y] * r * 4.0 - mixed) * square * 2.0;
            to.hessian[0][0][x][y] += (e1[x] * e1[y] + second11 * off) * twice;
            to.hessian[1][0][x][y] += (e2[x] * e1[y] - d1[x] * d1[y] * square * off * 2.0) * twice;
            to.hessian[1][1][x][y] += e2[x] * e2[y] * twice;
        }
        to.hessian[0][0][x][x] += r * off * inverse * twice * (-2.0);
        to.hessian[1][0][x][x] += off * inverse * twice;
    }
}
