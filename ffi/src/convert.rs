//! Elements in the forms that other programs read.

use crate::code::{Failure, answer, minvar_code, minvar_error};
use crate::curve::minvar_element;
use crate::measure::elements_of;
use crate::raw::{Output, array_mut, reference};
use kernel::curve::{Element, MeasureError, convert, measure};

/// The six Bézier control points of one element, x, y, z each, in the caller's unit of length.
///
/// Any element will do: numbers that are not finite give control points that are not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_element_bezier(
    element: *const minvar_element,
    points: *mut [[f64; 3]; 6],
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts are the same.
    unsafe {
        answer::<MeasureError>(error, || {
            let element = reference(element.cast::<Element>(), "element")?;
            Output::new(points, "points")?.put(element.bezier());
            Ok(())
        })
    }
}

/// The numbers of control points and of knots that minvar_bspline() writes for a chain of `count` elements; 0 and 0
/// for none. The elements are read for corners, not checked.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_bspline_len(
    elements: *const minvar_element,
    count: usize,
    control_count: *mut usize,
    knot_count: *mut usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let control_count = Output::new(control_count, "control_count")?;
            let knot_count = Output::new(knot_count, "knot_count")?;
            let (controls, knots) = convert::bspline_len(elements);
            control_count.put(controls);
            knot_count.put(knots);
            Ok(())
        })
    }
}

/// The whole chain as one non-rational B-spline of degree 5: the same curve point by point, C1 where the tangent is
/// continuous. Knots from 0 to 1, six-fold at the ends, four-fold at smooth joints, five-fold at corners; a closed
/// chain gives a spline whose ends meet.
///
/// `controls` receives control points x, y, z in the caller's unit of length, `knots` six more knots than there are
/// control points. `controls_len` and `knots_len` are the room in entries (points, knots), at least what
/// minvar_bspline_len() says; entries beyond that are left alone. The arrays must not overlap.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_RESULT_TOO_SHORT, MINVAR_IRREGULAR where an element
/// starts or ends without speed at another, or with so much less than it that two knots coincide.
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
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let controls = array_mut(controls, controls_len, "controls")?;
            let knots = array_mut(knots, knots_len, "knots")?;
            measure::check(elements)?;
            let (control_count, knot_count) = convert::bspline_len(elements);
            if controls_len < control_count {
                return Err(Failure::TooShort {
                    name: "controls",
                    needed: control_count,
                    given: controls_len,
                }
                .into());
            }
            if knots_len < knot_count {
                return Err(Failure::TooShort { name: "knots", needed: knot_count, given: knots_len }.into());
            }
            convert::bspline(elements, controls, knots)?;
            Ok(())
        })
    }
}
