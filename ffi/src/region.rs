//! A region of a curve, held to the rest at its ends.

use crate::code::{answer, minvar_code, minvar_error};
use crate::curve::{minvar_element, minvar_joint};
use crate::measure::{elements_of, minvar_point};
use crate::raw::array_mut;
use kernel::curve::{CurveError, CurvePoint, Joint, Region};

/// A G2 joint held at a place of a curve, as minvar_point_at() and its like find it: position, tangent and curvature fixed
/// as they are there. A curve that starts or ends with it joins that curve with G2 continuity, to rounding. This only
/// fills in a struct: its numbers are checked by the functions that take the joint.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_held_at(place: minvar_point) -> minvar_joint {
    // SAFETY: the layouts are the same, and all are numbers without invalid values.
    unsafe {
        let place = core::mem::transmute::<minvar_point, CurvePoint>(place);
        core::mem::transmute::<Joint, minvar_joint>(Joint::held_at(&place))
    }
}

/// Holds the ends of a region of a curve, which is to be computed anew while the rest stays as it is (thesis 4.4, local
/// control).
///
/// The curve is a chain of `count` elements, which returns to its start if `closed` is not 0. The region is
/// `region_count` elements, 1 or more, from `first` on, from 0; of a closed curve they may run past the last element
/// into the first ones. Its ends may be joints of the curve or any other ends of elements.
///
/// `joints`: the region's joints in order, `joint_count`, two or more; inner ones may be moved, added and removed. The first
/// and the last are changed: what a joint's continuity makes common is fixed as the rest has it there, the position to the
/// last bit, of a G1 joint the tangent too, of a G2 joint the curvature vector as well. What the continuity leaves
/// independent stays as given, and so does a joint where an open curve ends: its own conditions hold.
///
/// Then the region is the open curve through these joints: minvar_curve_solve() computes it from its data,
/// minvar_curve_update() from its old elements. If the number of elements stays, `elements + first` may receive the new
/// ones, unless the region runs past the last. The functional is the region's own. For MINVAR_MVC and MINVAR_MEC, with a
/// tension or a bending term or without, a region of a minimum whose joints did not move comes out as it was.
/// Scale-invariant functionals and a given length look at the region's length alone, and the space functionals leave its
/// torsion free at both ends: these move it.
///
///     minvar_region_hold(elements, 6, 0, 2, 2, joints, 3, &error);
///     const minvar_curve region = minvar_curve_through(joints, 3, 0);
///     minvar_curve_update(&region, &options, workspace, workspace_len, NULL, NULL, elements + 2, 2, &report, &error);
///
/// Errors: MINVAR_BAD_REGION, MINVAR_TOO_FEW_JOINTS, MINVAR_BAD_REFERENCE for an element of the rest that has no direction
/// where the region joins it. The joints are untouched then; all else about them is looked at when the curve is solved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_region_hold(
    elements: *const minvar_element,
    count: usize,
    closed: i32,
    first: usize,
    region_count: usize,
    joints: *mut minvar_joint,
    joint_count: usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts of joints are the same as the kernel's.
    unsafe {
        answer::<CurveError>(error, || {
            let elements = elements_of(elements, count)?;
            let joints = array_mut(joints.cast::<Joint>(), joint_count, "joints")?;
            Region { elements, closed: closed != 0, first, count: region_count }.hold(joints)?;
            Ok(())
        })
    }
}
