//! Elements in the forms that other programs read.

use crate::code::{finish, minvar_code, minvar_error};
use crate::curve::minvar_element;
use crate::measure::elements_of;
use crate::raw::{array_mut, put, reference};
use kernel::curve::{Element, convert};

/// The six Bézier control points of an element, x, y, z each.
///
/// Errors: MINVAR_NULL_POINTER.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_element_bezier(
    element: *const minvar_element,
    points: *mut [[f64; 3]; 6],
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts are the same.
    let result = unsafe { (|| put(points, reference(element.cast::<Element>())?.bezier()))() };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}

/// The numbers of control points and of knots of a chain's B-spline.
///
/// Errors: MINVAR_NULL_POINTER.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_bspline_len(
    elements: *const minvar_element,
    count: usize,
    control_count: *mut usize,
    knot_count: *mut usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    let result = unsafe {
        (|| {
            let (controls, knots) = convert::bspline_len(elements_of(elements, count)?);
            put(control_count, controls)?;
            put(knot_count, knots)
        })()
    };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}

/// The whole chain as one non-rational B-spline of degree 5, the same curve point by point, C1 where the tangent is
/// continuous. Knots from 0 to 1, six-fold at the ends, four-fold at smooth joints, five-fold at corners.
///
/// `controls` receives control points x, y, z, `knots` six more knots than control points; the lengths are the room, at
/// least what minvar_bspline_len() says.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR, MINVAR_RESULT_TOO_SHORT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_bspline(
    elements: *const minvar_element,
    count: usize,
    controls: *mut [f64; 3],
    controls_len: usize,
    knots: *mut f64,
    knots_len: usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    let result = unsafe {
        (|| {
            let elements = elements_of(elements, count)?;
            convert::bspline(elements, array_mut(controls, controls_len)?, array_mut(knots, knots_len)?)?;
            Ok(())
        })()
    };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}
