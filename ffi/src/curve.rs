//! Curves: joints, options, the three calls.

use crate::code::{Failure, answer, minvar_code, minvar_error, minvar_status};
use crate::raw::{Output, array, array_mut, reference};
use core::ffi::c_void;
use core::mem::MaybeUninit;
use kernel::curve::{
    self, Curve, CurveError, Element, Functional, Joint, Obstacle, Options, Reference, Report,
};
use kernel::solve::{Control, Observer, Record};

/// Whether a quantity is the solver's to choose.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_given {
    /// Not given: the solver finds a start value and the best value.
    MINVAR_FREE = 0,
    /// A start value: the solver goes on from it.
    MINVAR_INITIAL = 1,
    /// Kept exactly.
    MINVAR_FIXED = 2,
    /// Of a position: it slides on the line through the value along the joint's guide; the value is where it starts.
    MINVAR_ON_LINE = 3,
    /// Of a position: it slides in the plane through the value across the joint's guide; the value is where it starts.
    MINVAR_ON_PLANE = 4,
    /// Of a curvature: its size is kept, its direction is free. The value's direction is where it starts, if it does not
    /// run along the tangent. A planar curve keeps the side to which it bends at the start.
    MINVAR_SIZE = 5,
}

/// How the two elements at a joint meet.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_continuity {
    /// A corner: tangent and curvature independent on either side.
    MINVAR_G0 = 0,
    /// A common tangent, curvatures independent on either side.
    MINVAR_G1 = 1,
    /// Common tangent and curvature.
    MINVAR_G2 = 2,
}

/// What a curve is to minimise.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_functional {
    /// The variation of curvature, integral of (d kappa/ds)^2 ds (thesis 4.2); 1/length^3.
    MINVAR_MVC = 0,
    /// The bending energy, integral of kappa^2 ds (thesis 4.1); 1/length.
    MINVAR_MEC = 1,
    /// The scale-invariant MVC, L^3 times the variation of curvature (thesis 4.5): it has a minimum where the MVC grows
    /// without limit.
    MINVAR_SI_MVC = 2,
    /// The scale-invariant MEC, L times the bending energy.
    MINVAR_SI_MEC = 3,
    /// The variation of curvature and torsion, integral of (d kappa/ds)^2 + (d tau/ds)^2 ds (thesis 4.4); 1/length^3. It
    /// vanishes on helices; torsion is continuous at G2 joints. Where a curve has an inflection, torsion counts less near
    /// it. Planar data: MINVAR_MVC.
    MINVAR_SPACE_MVC = 4,
    /// The energy of bending and twisting, integral of kappa^2 + tau^2 ds (thesis 4.3); 1/length. Planar data:
    /// MINVAR_MEC.
    MINVAR_SPACE_MEC = 5,
}

/// A vector and what it is. The value of a free quantity is not read.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_quantity {
    /// One of enum minvar_given.
    pub given: u32,
    /// The vector x, y, z: a position, a tangent of any length but zero, or a curvature vector in 1/length.
    pub value: [f64; 3],
}

/// A joint: a point of the curve with what is known there (thesis 4.1, 4.5).
///
/// Tangent and curvature are given for the arriving side (0) and the leaving side (1). Where the continuity makes a
/// quantity common (the tangent at G1 and G2, the curvature at G2) both entries must be the same. The curvature vector
/// points to the centre of curvature, has length 1/radius and is perpendicular to the tangent. A fixed curvature at a
/// tangent that is not fixed means its size: the direction follows the tangent.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_joint {
    /// One of enum minvar_continuity.
    pub continuity: u32,
    /// The point.
    pub position: minvar_quantity,
    /// Arriving and leaving tangent.
    pub tangent: [minvar_quantity; 2],
    /// Arriving and leaving curvature vector.
    pub curvature: [minvar_quantity; 2],
    /// Where the position slides: the direction of its line, or the normal of its plane; of any length but zero. Not read
    /// otherwise.
    pub guide: [f64; 3],
}

/// A side of a curve, seen in the direction in which it runs.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_side {
    /// The obstacle lies to the left of the curve: about the plane's normal, which is +z, +x or +y where the data lie in a
    /// coordinate plane and else has its largest coordinate positive.
    MINVAR_LEFT = 0,
    /// The obstacle lies to the right of the curve.
    MINVAR_RIGHT = 1,
}

/// A point or a segment that a planar curve must leave on one side, at a distance.
///
/// Where the curve would come too near it gets a contact: a place between two elements that rolls around the obstacle's
/// end, or slides along the segment, at just that distance; position, tangent and curvature are continuous there. Contacts
/// are taken up and given up one by one (an active set) until nothing is too near and every contact pushes. What an open
/// curve does not pass, as it lies beyond the lines across its ends, is no obstacle to it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_obstacle {
    /// One end of the segment.
    pub from: [f64; 3],
    /// The other; the same for a point.
    pub to: [f64; 3],
    /// The distance that is kept, 0 or more.
    pub clearance: f64,
    /// One of enum minvar_side: the side of the curve on which the obstacle stays.
    pub side: u32,
}

/// The designer's data: joints in order along the curve, owned by the caller, only read, and only while a call lasts.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_curve {
    /// The joints; at least two, three of a closed curve.
    pub joints: *const minvar_joint,
    /// How many.
    pub joint_count: usize,
    /// Not 0: the curve goes on from the last joint to the first, which is not repeated.
    pub closed: i32,
    /// A reference shape (thesis 4.6), or NULL: the curve minimises the integral of (d kappa/ds - w d kappa0/ds)^2 ds
    /// with kappa0 the reference's curvature vector at the same element and parameter. As many elements as the curve has.
    /// The search starts from it. With the weight 1 and its own joints the curve is the reference, and joints that move
    /// deform it; with 0 it is the minimum variation curve. The speed's relative change along an element is held to the
    /// reference's. For MINVAR_MVC, without a tolerance.
    pub reference: *const minvar_element,
    /// How many elements the reference has; 0 without one.
    pub reference_count: usize,
    /// The weight w of the reference, 0 to 1.
    pub reference_weight: f64,
    /// What a planar curve must keep clear of, or NULL; not with a reference, a tolerance, a given length or an update.
    pub obstacles: *const minvar_obstacle,
    /// How many; 0 without.
    pub obstacle_count: usize,
}

/// The options of a curve: start from minvar_options_defaults().
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_options {
    /// One of enum minvar_functional. Default MINVAR_MVC.
    pub functional: u32,
    /// Elements between two joints, 1 to 1024 (thesis 4.6). More approach the true curve. Default 1.
    pub elements_per_span: u32,
    /// Gauss-Lobatto points an element, 12 to 32; 0 takes 16 as long as no more are needed and 32 where they tell a
    /// difference. Default 0.
    pub quadrature_points: u32,
    /// The largest number of iterations (trial steps). Default 500.
    pub max_iterations: u32,
    /// 2 for a planar curve, 3 for a space curve, 0 to find out: planar where all data lie in a plane. Default 0.
    pub dimension: u32,
    /// Stages of a continuation that starts under tension (thesis 4.10): each solves with a tenth of the tension of the one
    /// before; the last solution is where the search without it starts. It leads to the minimum of shortest length where
    /// start values alone lead elsewhere. At most 16. Default 0.
    pub continuation: u32,
    /// Converged when another step promises to lower the functional by less than this fraction, or 20 iterations
    /// together lowered it by less than a thousand times that; 0 to below 1. Of a functional that vanishes: this fraction
    /// of a thousandth of what a bend by a radian on every chord costs. Above 1e-9 converged, too, when no step as long as
    /// an element's speed promises more, and no other minima of single elements are looked for. Default 1e-12.
    pub relative_decrease: f64,
    /// This weight times the length is added to the functional: a tension. In the functional's unit over a length, 0 or
    /// more; 0 with a scale-invariant functional. Default 0.
    pub tension: f64,
    /// This weight times the bending energy is added to the functional. In the functional's unit times a length, 0 or
    /// more; 0 with a scale-invariant functional. Default 0.
    pub bending: f64,
    /// The length of the curve, which a converged one has to a millionth of it; 0 leaves it free. Default 0.
    pub length: f64,
    /// How far the curve may be from the true minimum, a length: spans are divided further until an estimate is below it,
    /// into at most `elements_per_span` elements each. 0 takes just `elements_per_span`. Default 0.
    pub tolerance: f64,
}

/// A quintic element in Hermite form (thesis 4.5). Plain data: it may be copied, stored and sent.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_element {
    /// The rows C(0), C'(0), C''(0), C''(1), C'(1), C(1), each x, y, z.
    pub rows: [[f64; 3]; 6],
}

/// What one iteration did: one trial step, accepted or not; one on a curve's directions alone, which come first where a
/// curve is planar, has only a value and a step. `value`, `predicted`, `actual` and `gradient` in the
/// functional's unit (1/length^3 for MVC, 1/length for MEC), `step` and `shift` without one.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_record {
    /// The functional after the iteration. In the first iterations it holds a term that keeps the parametrisation even.
    pub value: f64,
    /// The decrease that the quadratic model promised for this step.
    pub predicted: f64,
    /// The decrease that the step brought; negative where it was refused for raising the functional.
    pub actual: f64,
    /// The largest gradient component before the step, each times its unknown's natural size.
    pub gradient: f64,
    /// The length of the step in natural sizes.
    pub step: f64,
    /// The shift that was added to the scaled Hessian; 0 is a pure Newton step.
    pub shift: f64,
}

/// How a curve came out. All figures in the caller's units; `value`, `fine_value` and `decrement` in the functional's.
/// Of a shape that has grown beyond the arithmetic figures are infinite; none is NaN.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_report {
    /// How the computation ended.
    pub status: minvar_status,
    /// 1 if the curve was computed in a plane, 0 in space.
    pub planar: i32,
    /// How many elements the curve has: as many as minvar_curve_elements_len() says, or fewer with a tolerance or
    /// obstacles.
    pub elements: usize,
    /// The number of iterations: trial steps, accepted or not.
    pub iterations: usize,
    /// How often an element was linearised, over all elements: the work that was done.
    pub linearisations: usize,
    /// The number of unknowns.
    pub unknowns: usize,
    /// The functional's value by the rule that was minimised with.
    pub value: f64,
    /// The functional's value by a finer rule: 32 points on each half, and on the halves of that wherever they do not
    /// settle it; to 1e-6. A converged curve's differs from `value` by no more than 1e-4 of it; where by much more than
    /// rounding, the curve is wild for its elements: take more of them.
    pub fine_value: f64,
    /// The length L.
    pub length: f64,
    /// The variation of curvature V, integral of (d kappa/ds)^2 ds; 1/length^3.
    pub variation: f64,
    /// The bending energy E, integral of kappa^2 ds; 1/length.
    pub bending: f64,
    /// The estimated distance from the true minimum, where a tolerance was asked for, else 0; infinite where there is no
    /// estimate.
    pub error: f64,
    /// The largest gradient component, each times its unknown's natural size, as a fraction of the functional; infinite
    /// where little was asked for (a relative_decrease above 1e-9) and no step of the elements was needed for it.
    pub gradient: f64,
    /// The decrease that another Newton step would promise; infinite where the Hessian is not positive definite. Where
    /// no step was needed: an estimate of what the functional exceeds the true curve's by.
    pub decrement: f64,
}

/// Watches a solve: called on the solving thread after every iteration with the caller's context, the iteration's
/// number, from 1, and its record, which lives until the function returns. Return 0 to go on, anything else to stop with
/// MINVAR_CANCELLED and the best curve so far: a whole one, with a report that belongs to it. Who asked to stop is not
/// called again. It may call this library with other memory; it must return, not leave by longjmp() or an exception.
pub type minvar_observer =
    Option<unsafe extern "C" fn(context: *mut c_void, iteration: usize, record: *const minvar_record) -> i32>;

/// The same layout in C and in the kernel, field by field.
macro_rules! same_layout {
    ($ours:ty = $kernels:ty { $($our:ident = $kernel:ident),* }) => {
        const _: () = {
            assert!(size_of::<$ours>() == size_of::<$kernels>());
            assert!(align_of::<$ours>() == align_of::<$kernels>());
            $(assert!(core::mem::offset_of!($ours, $our) == core::mem::offset_of!($kernels, $kernel));)*
        };
    };
}
pub(crate) use same_layout;

same_layout!(minvar_quantity = curve::Quantity { given = given, value = value });
same_layout!(minvar_joint = Joint {
    continuity = continuity, position = position, tangent = tangent, curvature = curvature, guide = guide
});
same_layout!(minvar_obstacle = Obstacle { from = from, to = to, clearance = clearance, side = side });
same_layout!(minvar_element = Element { rows = rows });
same_layout!(minvar_record = Record {
    value = value, predicted = predicted, actual = actual, gradient = gradient, step = step, shift = shift
});

/// The kernel's view of C's data.
///
/// # Safety
/// `curve` is NULL or as its documentation says, and stays so while the view lives.
unsafe fn view<'a>(curve: *const minvar_curve) -> Result<Curve<'a>, Failure> {
    // SAFETY: promised by the caller.
    let data = unsafe { reference(curve, "curve")? };
    // SAFETY: promised by the caller; the layouts are the same, and the kernel's joint is numbers without invalid values.
    let joints = unsafe { array(data.joints.cast::<Joint>(), data.joint_count, "curve->joints")? };
    let mut curve = Curve::new(joints, data.closed != 0);
    if !(data.obstacles.is_null() && data.obstacle_count == 0) {
        // SAFETY: as above.
        curve.obstacles =
            unsafe { array(data.obstacles.cast::<Obstacle>(), data.obstacle_count, "curve->obstacles")? };
    }
    if data.reference.is_null() && data.reference_count == 0 {
        return Ok(curve);
    }
    // SAFETY: as above.
    let elements =
        unsafe { array(data.reference.cast::<Element>(), data.reference_count, "curve->reference")? };
    Ok(curve.with_reference(Reference { elements, weight: data.reference_weight }))
}

/// # Safety
/// `options` is NULL or valid for reading.
unsafe fn options_of(options: *const minvar_options) -> Result<Options, Failure> {
    // SAFETY: promised by the caller.
    let given = unsafe { reference(options, "options")? };
    Ok(Options {
        functional: Functional(given.functional),
        elements_per_span: given.elements_per_span,
        quadrature_points: given.quadrature_points,
        max_iterations: given.max_iterations,
        dimension: given.dimension,
        continuation: given.continuation,
        relative_decrease: given.relative_decrease,
        tension: given.tension,
        bending: given.bending,
        length: given.length,
        tolerance: given.tolerance,
    })
}

/// The options' defaults, named at each field of minvar_options.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_options_defaults() -> minvar_options {
    let defaults = Options::DEFAULT;
    minvar_options {
        functional: defaults.functional.0,
        elements_per_span: defaults.elements_per_span,
        quadrature_points: defaults.quadrature_points,
        max_iterations: defaults.max_iterations,
        dimension: defaults.dimension,
        continuation: defaults.continuation,
        relative_decrease: defaults.relative_decrease,
        tension: defaults.tension,
        bending: defaults.bending,
        length: defaults.length,
        tolerance: defaults.tolerance,
    }
}

const FREE: minvar_quantity = minvar_quantity { given: minvar_given::MINVAR_FREE as u32, value: [0.0; 3] };

/// A G2 joint at the fixed point x, y, z with free tangent and curvature. This and the three functions that follow only
/// fill in a struct: their arguments are checked by the functions that take the joints.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_at(x: f64, y: f64, z: f64) -> minvar_joint {
    minvar_joint {
        continuity: minvar_continuity::MINVAR_G2 as u32,
        position: minvar_quantity { given: minvar_given::MINVAR_FIXED as u32, value: [x, y, z] },
        tangent: [FREE; 2],
        curvature: [FREE; 2],
        guide: [0.0; 3],
    }
}

/// The same joint sliding on the line through the point x, y, z, where it starts, along dx, dy, dz, of any length but
/// zero.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_on_line(
    joint: minvar_joint,
    x: f64,
    y: f64,
    z: f64,
    dx: f64,
    dy: f64,
    dz: f64,
) -> minvar_joint {
    sliding(joint, minvar_given::MINVAR_ON_LINE, [x, y, z], [dx, dy, dz])
}

/// The same joint sliding in the plane through the point x, y, z, where it starts, across its normal nx, ny, nz, of any
/// length but zero.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_on_plane(
    joint: minvar_joint,
    x: f64,
    y: f64,
    z: f64,
    nx: f64,
    ny: f64,
    nz: f64,
) -> minvar_joint {
    sliding(joint, minvar_given::MINVAR_ON_PLANE, [x, y, z], [nx, ny, nz])
}

fn sliding(joint: minvar_joint, given: minvar_given, value: [f64; 3], guide: [f64; 3]) -> minvar_joint {
    minvar_joint { position: minvar_quantity { given: given as u32, value }, guide, ..joint }
}

/// The same joint with the tangent x, y, z, of any length but zero, on both sides. `given`: one of enum minvar_given.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_with_tangent(
    joint: minvar_joint,
    given: u32,
    x: f64,
    y: f64,
    z: f64,
) -> minvar_joint {
    minvar_joint { tangent: [minvar_quantity { given, value: [x, y, z] }; 2], ..joint }
}

/// The same joint with the curvature vector x, y, z, in 1/length towards the centre of curvature, on both sides.
/// `given`: one of enum minvar_given.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_with_curvature(
    joint: minvar_joint,
    given: u32,
    x: f64,
    y: f64,
    z: f64,
) -> minvar_joint {
    minvar_joint { curvature: [minvar_quantity { given, value: [x, y, z] }; 2], ..joint }
}

/// The same joint with another continuity: one of enum minvar_continuity.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_joint_with_continuity(joint: minvar_joint, continuity: u32) -> minvar_joint {
    minvar_joint { continuity, ..joint }
}

/// The curve through `joint_count` joints, without a reference shape or obstacles; `closed` as in minvar_curve. The joints
/// stay the caller's.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_curve_through(
    joints: *const minvar_joint,
    joint_count: usize,
    closed: i32,
) -> minvar_curve {
    minvar_curve {
        joints,
        joint_count,
        closed,
        reference: core::ptr::null(),
        reference_count: 0,
        reference_weight: 0.0,
        obstacles: core::ptr::null(),
        obstacle_count: 0,
    }
}

/// The number of elements that a curve will have, or with a tolerance or obstacles the most that it may have (an obstacle
/// counts as four spans): spans times `elements_per_span`, with one span fewer than joints of an open curve and as many as
/// joints of a closed one. Data and options are not checked otherwise; 0 if a pointer is NULL or misaligned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_curve_elements_len(
    curve: *const minvar_curve,
    options: *const minvar_options,
) -> usize {
    // SAFETY: promised by the caller.
    match unsafe { (view(curve), options_of(options)) } {
        (Ok(curve), Ok(options)) => curve::elements_len(&curve, &options),
        _ => 0,
    }
}

/// The workspace, in doubles, that minvar_curve_solve() needs for these data and options. It depends on the options, on
/// the number of joints, on what is given there and on whether the data lie in a plane, not on the numbers otherwise.
///
/// Errors: all that minvar_curve_solve() finds wrong with the data and options, but for MINVAR_CURVATURE_NEEDS_TANGENT,
/// which shows with the start values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_curve_workspace_len(
    curve: *const minvar_curve,
    options: *const minvar_options,
    len: *mut usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<CurveError>(error, || {
            let (curve, options) = (view(curve)?, options_of(options)?);
            let len = Output::new(len, "len")?;
            len.put(curve::workspace_len(&curve, &options)?);
            Ok(())
        })
    }
}

/// The caller's observer as the kernel's.
struct Watch {
    observer: minvar_observer,
    context: *mut c_void,
}

impl Observer for Watch {
    fn iteration(&mut self, number: usize, record: &Record) -> Control {
        let Some(observer) = self.observer else { return Control::Continue };
        // A copy of its own: an observer that writes to it, const or not, changes nothing.
        let mut record = *record;
        // SAFETY: the caller gave this function for this call; the layouts of the records are the same.
        let answer = unsafe { observer(self.context, number, (&raw mut record).cast()) };
        if answer == 0 { Control::Continue } else { Control::Cancel }
    }
}

fn report_of(found: &Report) -> minvar_report {
    minvar_report {
        status: found.status.into(),
        planar: i32::from(found.planar),
        elements: found.elements,
        iterations: found.iterations,
        linearisations: found.linearisations,
        unknowns: found.unknowns,
        value: found.value,
        fine_value: found.fine_value,
        length: found.length,
        variation: found.variation,
        bending: found.bending,
        error: found.error,
        gradient: found.gradient,
        decrement: found.decrement,
    }
}

/// Computes a curve (thesis chapter 4).
///
/// `workspace`: `workspace_len` doubles, at least what minvar_curve_workspace_len() says, in any condition; what is left
/// in it afterwards means nothing. `observer` may be NULL. `elements` receives minvar_curve_elements_len() elements in
/// order along the curve, or with a tolerance or obstacles as many as `report->elements` says; `elements_len` is the room.
/// `records` (may be NULL with `records_len` 0) receives a record an iteration as far as it reaches. What lies beyond in
/// either array is left alone. The arrays must not overlap.
///
/// Fixed positions and tangent directions are kept exactly; planar data give a curve in their plane.
///
/// A curve that did not converge is no error: `report->status` says how the computation ended, and elements and report
/// hold the best curve that was found.
///
/// Errors: MINVAR_TOO_FEW_JOINTS to MINVAR_OBSTACLES_NOT_POSSIBLE, whatever is wrong with data, options or memory. All are
/// found before any work: elements, records and report are untouched then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_curve_solve(
    curve: *const minvar_curve,
    options: *const minvar_options,
    workspace: *mut f64,
    workspace_len: usize,
    observer: minvar_observer,
    observer_context: *mut c_void,
    elements: *mut minvar_element,
    elements_len: usize,
    records: *mut minvar_record,
    records_len: usize,
    report: *mut minvar_report,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts of elements and records are the same as the kernel's.
    unsafe {
        answer::<CurveError>(error, || {
            let curve = view(curve)?;
            let options = options_of(options)?;
            let workspace = array_mut(workspace, workspace_len, "workspace")?;
            let elements = array_mut(elements.cast::<Element>(), elements_len, "elements")?;
            let records = array_mut(records.cast::<Record>(), records_len, "records")?;
            let report = Output::new(report, "report")?;
            let mut watch = Watch { observer, context: observer_context };
            report.put(report_of(&curve::solve(&curve, &options, workspace, elements, records, &mut watch)?));
            Ok(())
        })
    }
}

/// Computes a curve anew from its last solution: a warm start for data that changed a little, as when a joint is dragged.
///
/// As minvar_curve_solve(), but `elements` holds the last solution, minvar_curve_elements_len() elements, from which the
/// search starts, and receives the new one; what the joints fix is taken from the joints. The search ends in the minimum
/// that belongs to the last solution, so that a curve does not jump while it is dragged. A tolerance is not looked at: the
/// number of elements stays.
///
/// Errors: as minvar_curve_solve().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_curve_update(
    curve: *const minvar_curve,
    options: *const minvar_options,
    workspace: *mut f64,
    workspace_len: usize,
    observer: minvar_observer,
    observer_context: *mut c_void,
    elements: *mut minvar_element,
    elements_len: usize,
    report: *mut minvar_report,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts of elements are the same as the kernel's.
    unsafe {
        answer::<CurveError>(error, || {
            let curve = view(curve)?;
            let options = options_of(options)?;
            let workspace = array_mut(workspace, workspace_len, "workspace")?;
            let elements = array_mut(elements.cast::<Element>(), elements_len, "elements")?;
            let report = Output::new(report, "report")?;
            let mut watch = Watch { observer, context: observer_context };
            report.put(report_of(&curve::update(
                &curve,
                &options,
                workspace,
                elements,
                &mut [],
                &mut watch,
            )?));
            Ok(())
        })
    }
}

/// Looks for several minima of one curve: from the usual start values, from each start tangent turned round, and from each
/// span bent the other way or further (thesis 4.10: curves with and without a loop). The list is what these starts lead
/// to; it need not be complete.
///
/// `reports` has room for `reports_len` reports and receives one a minimum, the lowest first. `elements` has room for
/// `(reports_len + 1)` times minvar_curve_elements_len() elements: the first so many receive the first minimum's, and so on;
/// the last are scratch. `count` receives the number of minima. `observer` sees every solve begin with iteration 1; if it
/// asks to stop, the minima that were found before are the result, none if there were none, and the code is MINVAR_OK. The
/// rest as in minvar_curve_solve().
///
/// Errors: as minvar_curve_solve().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_curve_minima(
    curve: *const minvar_curve,
    options: *const minvar_options,
    workspace: *mut f64,
    workspace_len: usize,
    observer: minvar_observer,
    observer_context: *mut c_void,
    elements: *mut minvar_element,
    elements_len: usize,
    reports: *mut minvar_report,
    reports_len: usize,
    count: *mut usize,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller; the layouts of elements are the same as the kernel's.
    unsafe {
        answer::<CurveError>(error, || {
            let curve = view(curve)?;
            let options = options_of(options)?;
            let workspace = array_mut(workspace, workspace_len, "workspace")?;
            let elements = array_mut(elements.cast::<Element>(), elements_len, "elements")?;
            // C may hand over memory that was never written, and not every pattern is a status.
            let reports = array_mut(reports.cast::<MaybeUninit<minvar_report>>(), reports_len, "reports")?;
            let count = Output::new(count, "count")?;
            let mut watch = Watch { observer, context: observer_context };
            let make = |report: &Report| MaybeUninit::new(report_of(report));
            let figures = |report: &MaybeUninit<minvar_report>| {
                // SAFETY: asked of reports that were made alone.
                let report = report.assume_init_ref();
                [report.value, report.length, report.bending]
            };
            let found =
                curve::minima_as(&curve, &options, workspace, elements, reports, make, figures, &mut watch)?;
            count.put(found);
            Ok(())
        })
    }
}
