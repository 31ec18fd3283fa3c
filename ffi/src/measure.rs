//! Measuring a chain of elements.

use crate::code::{finish, minvar_code, minvar_error};
use crate::curve::{minvar_element, same_layout};
use crate::raw::{array, put};
use kernel::curve::{CurvePoint, Element, measure};

/// What holds at a place of a chain, all in the caller's units.
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
    /// The low corner of the bounding box.
    pub box_low: [f64; 3],
    /// The high corner of the bounding box.
    pub box_high: [f64; 3],
}

/// # Safety
/// As [`array`]; the layouts are the same.
pub(crate) unsafe fn elements_of<'a>(
    elements: *const minvar_element,
    count: usize,
) -> Result<&'a [Element], crate::code::Failure> {
    // SAFETY: promised by the caller.
    unsafe { array(elements.cast::<Element>(), count) }
}

/// Measures a chain of `count` elements.
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
    let result = unsafe {
        (|| {
            let elements = elements_of(elements, count)?;
            let [least, largest] = measure::curvature_range(elements)?;
            let [box_low, box_high] = measure::bounding_box(elements)?;
            put(
                figures,
                minvar_figures {
                    length: measure::length(elements),
                    variation: measure::variation(elements),
                    bending: measure::bending(elements),
                    least_curvature: least.into(),
                    largest_curvature: largest.into(),
                    box_low,
                    box_high,
                },
            )
        })()
    };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}

/// What holds at parameter `t`, 0 to 1, of element `element`, from 0.
///
/// Errors: MINVAR_OUT_OF_RANGE, MINVAR_IRREGULAR, MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE.
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
    let result =
        unsafe { (|| put(point, measure::at(elements_of(elements, count)?, element, t)?.into()))() };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}

/// What holds at arc length `s` from the start, 0 to the length of the chain.
///
/// Errors: as minvar_point_at().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_point_at_length(
    elements: *const minvar_element,
    count: usize,
    s: f64,
    point: *mut minvar_point,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    let result = unsafe { (|| put(point, measure::at_length(elements_of(elements, count)?, s)?.into()))() };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}

/// The place of a chain that is nearest to the point x, y, z; of several equally near ones the first. No place is
/// missed: it is found from the roots of a polynomial.
///
/// Errors: as minvar_point_at().
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
    let result = unsafe { (|| put(point, measure::closest(elements_of(elements, count)?, [x, y, z])?.into()))() };
    // SAFETY: promised by the caller.
    unsafe { finish(result, error) }
}
