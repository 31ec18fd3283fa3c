//! Measuring a chain of elements.

use crate::code::{Failure, Refusal, answer, minvar_code, minvar_error};
use crate::curve::{minvar_element, same_layout};
use crate::raw::{Output, array};
use kernel::curve::{CurvePoint, Element, MeasureError, measure};

/// What holds at a place of a chain of elements, all in the caller's units.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_point {
    /// The element, from 0.
    pub element: usize,
    /// The parameter in it, 0 to 1.
    pub parameter: f64,
    /// The arc length from the start of the chain.
    pub arc_length: f64,
    /// The position.
    pub point: [f64; 3],
    /// The unit tangent.
    pub tangent: [f64; 3],
    /// The curvature vector, perpendicular to the tangent, towards the centre of curvature; 1/length.
    pub curvature: [f64; 3],
    /// Planar chains: the curvature, positive to the left seen from the tip of the plane's normal (+z, +x or +y for
    /// planes parallel to a coordinate plane). Space curves: the curvature's size. 1/length.
    pub signed_curvature: f64,
    /// The derivative of signed_curvature by arc length; 1/length^2.
    pub curvature_derivative: f64,
    /// The torsion, positive for a right-handed helix; 0 where the curvature vanishes; 1/length.
    pub torsion: f64,
}

same_layout!(minvar_point = CurvePoint {
    element = element, parameter = parameter, arc_length = arc_length, point = point, tangent = tangent,
    curvature = curvature, signed_curvature = signed_curvature, curvature_derivative = curvature_derivative,
    torsion = torsion
});

impl From<CurvePoint> for minvar_point {
    fn from(found: CurvePoint) -> Self {
        Self {
            element: found.element,
            parameter: found.parameter,
            arc_length: found.arc_length,
            point: found.point,
            tangent: found.tangent,
            curvature: found.curvature,
            signed_curvature: found.signed_curvature,
            curvature_derivative: found.curvature_derivative,
            torsion: found.torsion,
        }
    }
}

/// The figures of a whole chain.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_figures {
    /// The length L.
    pub length: f64,
    /// The variation of curvature V, integral of (d kappa/ds)^2 ds; 1/length^3.
    pub variation: f64,
    /// The bending energy E, integral of kappa^2 ds; 1/length.
    pub bending: f64,
    /// The place of the least signed curvature (space curves: size of curvature).
    pub least_curvature: minvar_point,
    /// The place of the largest.
    pub largest_curvature: minvar_point,
    /// The low corner x, y, z of the smallest box parallel to the axes that holds the chain.
    pub box_low: [f64; 3],
    /// Its high corner.
    pub box_high: [f64; 3],
}

/// # Safety
/// As [`array`]; the layouts are the same.
pub(crate) unsafe fn elements_of<'a>(
    elements: *const minvar_element,
    count: usize,
) -> Result<&'a [Element], Failure> {
    // SAFETY: promised by the caller.
    unsafe { array(elements.cast::<Element>(), count, "elements") }
}

/// Measures a chain of `count` elements. Length, V and E are sums over the elements by 32-point rules, V and E by as
/// many of them as it takes: what happens between two elements (a jump of curvature at a G1 joint) does not count.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_measure(
    elements: *const minvar_element,
    count: usize,
    figures: *mut minvar_figures,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let figures = Output::new(figures, "figures")?;
            let [least, largest] = measure::curvature_range(elements)?;
            let [box_low, box_high] = measure::bounding_box(elements)?;
            figures.put(minvar_figures {
                length: measure::length(elements),
                variation: measure::variation(elements),
                bending: measure::bending(elements),
                least_curvature: least.into(),
                largest_curvature: largest.into(),
                box_low,
                box_high,
            });
            Ok(())
        })
    }
}

/// What holds at parameter `t`, 0 to 1, of element `element`, from 0.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE for `element` or `t` (NaN too),
/// MINVAR_IRREGULAR where the curve has no tangent there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_point_at(
    elements: *const minvar_element,
    count: usize,
    element: usize,
    t: f64,
    point: *mut minvar_point,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let point = Output::new(point, "point")?;
            let found = measure::at(elements, element, t);
            point.put(placed(
                found,
                if element < count { "t must be from 0 to 1" } else { "there is no such element" },
            )?);
            Ok(())
        })
    }
}

/// What holds at arc length `s` from the start, 0 to the length of the chain; beyond either end by rounding (1e-9 of
/// the length) is taken as that end. The start of an element rather than the end of the one before.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE for `s` (NaN too), MINVAR_IRREGULAR where
/// the curve has no tangent there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_point_at_length(
    elements: *const minvar_element,
    count: usize,
    s: f64,
    point: *mut minvar_point,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let point = Output::new(point, "point")?;
            point
                .put(placed(measure::at_length(elements, s), "s must be from 0 to the length of the chain")?);
            Ok(())
        })
    }
}

/// The place of a chain that is nearest to the point x, y, z; of several equally near ones the first. No place is
/// missed: it is found from the roots of a polynomial.
///
/// Errors: MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_OUT_OF_RANGE if x, y or z is NaN or infinite,
/// MINVAR_IRREGULAR where the curve has no tangent at the nearest place.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_closest_point(
    elements: *const minvar_element,
    count: usize,
    x: f64,
    y: f64,
    z: f64,
    point: *mut minvar_point,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<MeasureError>(error, || {
            let elements = elements_of(elements, count)?;
            let point = Output::new(point, "point")?;
            point.put(placed(measure::closest(elements, [x, y, z]), "x, y and z must be finite")?);
            Ok(())
        })
    }
}

/// A found place, or what was wrong; `rule` says what the arguments of a place must be.
fn placed(
    found: Result<CurvePoint, MeasureError>,
    rule: &'static str,
) -> Result<minvar_point, Refusal<MeasureError>> {
    match found {
        Ok(point) => Ok(point.into()),
        Err(MeasureError::OutOfRange) => Err(Failure::Place { rule }.into()),
        Err(error) => Err(error.into()),
    }
}
