//! What holds for a whole chain: length, functionals, extremes of curvature, box.

use super::{
    CurvePoint, MeasureError, check, derivative_polynomial, dot, normalised, part_length, plane_normal,
    properties,
};
use crate::basis::bernstein::Bernstein;
use crate::basis::hermite;
use crate::basis::mirrored::pairs;
use crate::basis::quadrature::MAX_POINTS;
use crate::curve::element::Element;
use crate::curve::functional::Weights;
use crate::curve::rows::{Integrand, combine};
use nalgebra::Vector3;

/// The length of a chain: 32-point Gauss–Lobatto an element, which is exact to rounding for elements without near
/// cusps.
pub fn length(elements: &[Element]) -> f64 {
    let mut sum = 0.0;
    for element in elements {
        let (rows, unit) = normalised(element);
        sum += unit * part_length(&rows, 1.0);
    }
    sum
}

/// The two halves of an element.
fn halves(rows: &[Vector3<f64>; 6]) -> [[Vector3<f64>; 6]; 2] {
    let basis = hermite::basis(0.5);
    let [p, v, a] = [0, 1, 2].map(|order: usize| combine(rows, &basis[order]));
    // A half's parameter runs half as fast: C' halves, C'' is quartered.
    let half =
        |p0, v0, a0, a1, v1, p1| -> [Vector3<f64>; 6] { [p0, v0 * 0.5, a0 * 0.25, a1 * 0.25, v1 * 0.5, p1] };
    [half(rows[0], rows[1], rows[2], a, v, p), half(p, v, a, rows[3], rows[4], rows[5])]
}

fn total(weights: Weights, elements: &[Element]) -> f64 {
    let integrand = Integrand::<3>::plain(weights, pairs(MAX_POINTS));
    let mut sum = 0.0;
    for element in elements {
        let (rows, unit) = normalised(element);
        // Each half by itself: finer than any rule that a curve is minimised with.
        let mut value = 0.0;
        for half in halves(&rows) {
            value += integrand.value(&half, |_| {})[0];
        }
        sum += if weights.bending != 0.0 { value / unit } else { value / unit / unit / unit };
    }
    sum
}

/// The variation of curvature `V = ∫ |dκ/ds|² ds` of a chain, with `κ` the binormal curvature vector (thesis 4.2), by
/// 32-point Gauss–Lobatto over each half of every element; 1/length³. What happens between elements (a jump of curvature at a G1 joint) does not count.
pub fn variation(elements: &[Element]) -> f64 {
    total(Weights::VARIATION, elements)
}

/// The bending energy `E = ∫ κ² ds` of a chain (thesis 4.1), by 32-point Gauss–Lobatto over each half of every
/// element; 1/length.
pub fn bending(elements: &[Element]) -> f64 {
    total(Weights::BENDING, elements)
}

fn cross(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> [Bernstein; 3] {
    core::array::from_fn(|d| a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3])
}

/// Calls `visit` with every parameter at which the curvature of an element may have an extreme: its ends, and the
/// roots of the curvature's derivative, a polynomial of degree 14 (planar) or 21.
fn curvature_extremes(element: &Element, normal: Option<[f64; 3]>, mut visit: impl FnMut(f64)) {
    visit(0.0);
    visit(1.0);
    let bezier = hermite::to_bezier(&normalised(element).0.map(|row| row.into())).map(Vector3::from);
    let [d1, d2, d3]: [[Bernstein; 3]; 3] =
        core::array::from_fn(|k| core::array::from_fn(|d| derivative_polynomial(&bezier, k + 1, d)));
    let (p, q) = (dot(&d1, &d1), dot(&d1, &d2));
    let (u, v) = (cross(&d1, &d2), cross(&d1, &d3));
    let numerator: [Bernstein; 3] = core::array::from_fn(|d| p * v[d] - q * u[d] * 3.0);
    let derivative = match normal {
        Some(n) => numerator[0] * n[0] + numerator[1] * n[1] + numerator[2] * n[2],
        None => dot(&u, &numerator),
    };
    // A circle's derivative is zero or noise: then every place is as good.
    if let Ok(roots) = derivative.roots() {
        roots.iter().for_each(|&t| visit(t));
    }
}

/// The places of least and of largest signed curvature (planar chains) or size of curvature (space curves).
///
/// # Errors
/// [`MeasureError::NoElements`], [`MeasureError::NotFinite`], [`MeasureError::Irregular`].
pub fn curvature_range(elements: &[Element]) -> Result<[CurvePoint; 2], MeasureError> {
    check(elements)?;
    let normal = plane_normal(elements);
    let mut range: Option<[CurvePoint; 2]> = None;
    let mut wrong = None;
    let mut before = 0.0;
    for (index, element) in elements.iter().enumerate() {
        let (rows, unit) = normalised(element);
        curvature_extremes(element, normal, |t| match properties(elements, index, t, normal) {
            Ok(mut found) => {
                found.arc_length = before + unit * part_length(&rows, t);
                let range = range.get_or_insert([found; 2]);
                if found.signed_curvature < range[0].signed_curvature {
                    range[0] = found;
                }
                if found.signed_curvature > range[1].signed_curvature {
                    range[1] = found;
                }
            }
            Err(error) => wrong = Some(error),
        });
        before += unit * part_length(&rows, 1.0);
    }
    match (range, wrong) {
        (Some(range), None) => Ok(range),
        (_, Some(error)) => Err(error),
        (None, None) => Err(MeasureError::NoElements),
    }
}

/// The smallest box with sides parallel to the axes that holds a chain: its low and its high corner.
///
/// # Errors
/// [`MeasureError::NoElements`], [`MeasureError::NotFinite`].
pub fn bounding_box(elements: &[Element]) -> Result<[[f64; 3]; 2], MeasureError> {
    check(elements)?;
    let mut corners = [elements[0].rows[0]; 2];
    let mut take = |d: usize, x: f64| {
        corners[0][d] = corners[0][d].min(x);
        corners[1][d] = corners[1][d].max(x);
    };
    for element in elements {
        let (rows, _) = normalised(element);
        let bezier = hermite::to_bezier(&rows.map(|row| row.into())).map(Vector3::from);
        for d in 0..3 {
            take(d, element.rows[0][d]);
            take(d, element.rows[5][d]);
            if let Ok(roots) = derivative_polynomial(&bezier, 1, d).roots() {
                roots.iter().for_each(|&t| take(d, element.point(t)[d]));
            }
        }
    }
    Ok(corners)
}
