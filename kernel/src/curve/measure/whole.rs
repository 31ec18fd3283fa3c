//! What holds for a whole chain: length, functionals, extremes of curvature, box.

use super::{
    CurvePoint, MeasureError, check, derivative_polynomial, dot, normalised, part_length, plane_normal,
    properties,
};
use crate::basis::bernstein::Bernstein;
use crate::basis::hermite;
use crate::curve::element::Element;
use crate::curve::figures::Figures;
use crate::order::Order;
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

/// The figures of every element in its own unit, and that unit.
fn figures(elements: &[Element], mut visit: impl FnMut(Figures, f64)) {
    for element in elements {
        let (rows, unit) = normalised(element);
        let mut figures = Figures::default();
        figures.add(&rows, |_| 0.0);
        visit(figures, unit);
    }
}

/// The variation of curvature `V = ∫ |dκ/ds|² ds` of a chain, with `κ` the binormal curvature vector (thesis 4.2), by
/// 32-point Gauss–Lobatto over each half of every element, and over the halves of that as often as it takes to settle it;
/// 1/length³. What happens between elements (a jump of curvature at a G1 joint) does not count.
pub fn variation(elements: &[Element]) -> f64 {
    let mut sum = 0.0;
    figures(elements, |own, unit| sum += own.variation / unit / unit / unit);
    sum
}

/// The bending energy `E = ∫ κ² ds` of a chain (thesis 4.1), by the same rules as [`variation`]; 1/length.
pub fn bending(elements: &[Element]) -> f64 {
    let mut sum = 0.0;
    figures(elements, |own, unit| sum += own.bending / unit);
    sum
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
    let mut corners = [elements.first().ok_or(MeasureError::NoElements)?.rows[0]; 2];
    let mut take = |d: usize, x: f64| {
        corners[0][d] = corners[0][d].smaller(x);
        corners[1][d] = corners[1][d].larger(x);
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
