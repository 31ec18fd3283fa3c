//! Places on a chain: by parameter, by arc length, nearest to a point.

use super::{
    CurvePoint, MeasureError, check, derivative_polynomial, derivatives, dot, length, normalised,
    part_length, plane_normal, properties,
};
use crate::basis::bernstein::Bernstein;
use crate::basis::hermite;
use crate::curve::element::Element;
use crate::order::Order;
use crate::root::sqrt;
use nalgebra::Vector3;

/// What holds at parameter `t`, 0 to 1, of an element.
///
/// # Errors
/// [`MeasureError::OutOfRange`], [`MeasureError::Irregular`], [`MeasureError::NotFinite`].
pub fn at(elements: &[Element], element: usize, t: f64) -> Result<CurvePoint, MeasureError> {
    check(elements)?;
    let mut found = properties(elements, element, t, plane_normal(elements))?;
    let (before, rest) = elements.split_at_checked(element).ok_or(MeasureError::OutOfRange)?;
    let (rows, unit) = normalised(rest.first().ok_or(MeasureError::OutOfRange)?);
    found.arc_length = length(before) + unit * part_length(&rows, t);
    Ok(found)
}

/// What holds at arc length `s` from the start, from 0 to [`length`]; beyond by rounding (1e-9 of the length) is taken
/// as the end.
///
/// # Errors
/// [`MeasureError::OutOfRange`], [`MeasureError::Irregular`], [`MeasureError::NotFinite`].
pub fn at_length(elements: &[Element], s: f64) -> Result<CurvePoint, MeasureError> {
    check(elements)?;
    let total = length(elements);
    if !(s >= -1e-9 * total && s <= total * (1.0 + 1e-9)) {
        return Err(MeasureError::OutOfRange);
    }
    let mut before = 0.0;
    let mut found = None;
    for (index, element) in elements.iter().enumerate() {
        let (rows, unit) = normalised(element);
        found = Some((index, rows, unit));
        let own = unit * part_length(&rows, 1.0);
        if s < before + own || index + 1 == elements.len() {
            break;
        }
        before += own;
    }
    let (place, rows, unit) = found.ok_or(MeasureError::NoElements)?;
    let wanted = ((s - before) / unit).larger(0.0);
    // Newton's method on the arc length, kept between bounds that close in.
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = (wanted / part_length(&rows, 1.0)).clamp(0.0, 1.0);
    for _ in 0..60 {
        let off = part_length(&rows, t) - wanted;
        if off > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let first = derivatives(&rows, t)[0];
        let newton = t - off / sqrt(first.dot(&first));
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 4.0 * f64::EPSILON {
            t = next;
            break;
        }
        t = next;
    }
    let mut found = properties(elements, place, t, plane_normal(elements))?;
    found.arc_length = before + unit * part_length(&rows, t);
    Ok(found)
}

/// The place of a chain that is nearest to a point; of several equally near ones the first. Found from the roots of
/// `(C − point)·C'`, a polynomial of degree 9 an element (Fang 5.2), so no place is missed.
///
/// # Errors
/// [`MeasureError::NoElements`], [`MeasureError::NotFinite`], [`MeasureError::OutOfRange`] for a point that is not
/// finite, [`MeasureError::Irregular`] where the nearest place has no tangent.
pub fn closest(elements: &[Element], point: [f64; 3]) -> Result<CurvePoint, MeasureError> {
    check(elements)?;
    if point.iter().any(|x| !x.is_finite()) {
        return Err(MeasureError::OutOfRange);
    }
    let mut best = (f64::INFINITY, 0, 0.0);
    for (index, element) in elements.iter().enumerate() {
        let (rows, unit) = normalised(element);
        let bezier = hermite::to_bezier(&rows.map(|row| row.into())).map(Vector3::from);
        let target = Vector3::from_fn(|d, _| (point[d] - element.rows[0][d]) / unit);
        // The element lies in the box of its control points: no nearer than that.
        let mut outside = 0.0f64;
        for d in 0..3 {
            let (low, high) = Bernstein::new(bezier.map(|point| point[d])).range();
            outside = outside.larger(low - target[d]).larger(target[d] - high);
        }
        if outside * unit > best.0 {
            continue;
        }
        let mut consider = |t: f64| {
            let basis = hermite::basis(t);
            let mut offset = -target;
            for a in 0..6 {
                offset += rows[a] * basis[0][a];
            }
            let distance = unit * sqrt(offset.dot(&offset));
            if distance < best.0 {
                best = (distance, index, t);
            }
        };
        consider(0.0);
        consider(1.0);
        let offset: [Bernstein; 3] =
            core::array::from_fn(|d| Bernstein::new(bezier.map(|point| point[d] - target[d])));
        let first: [Bernstein; 3] = core::array::from_fn(|d| derivative_polynomial(&bezier, 1, d));
        if let Ok(roots) = dot(&offset, &first).roots() {
            roots.iter().for_each(|&t| consider(t));
        }
    }
    at(elements, best.1, best.2)
}
