//! The independent reference solver for fair curves (`ceres/`, C++), made safe to call.
//!
//! It shares nothing with the kernel: the thesis's parametrisation (`P' = m² t`, `P'' = m⁴ κ + α m² t`), derivatives by
//! nested automatic differentiation, its own quadrature, Ceres's Levenberg–Marquardt, and then Newton's method with the
//! exact Hessian to a gradient at rounding level. Its answer to "is this a minimum?" is therefore a second opinion.

/// The quintic Hermite rows of one element: `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`.
pub type Rows = [[f64; 3]; 6];

/// What is known of a vector at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Nothing: the start rules choose, the solver decides.
    Free,
    /// A start value, free to change.
    Initial([f64; 3]),
    /// A constraint.
    Fixed([f64; 3]),
}

/// How smoothly the curve passes a joint. It has no effect at the ends of an open curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuity {
    /// The point is shared.
    G0,
    /// The point and the tangent are shared.
    G1,
    /// The point, the tangent and the curvature are shared.
    G2,
}

/// One interpolated joint.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Where it is; never [`Given::Free`].
    pub position: Given,
    /// The tangent's direction, of any length.
    pub tangent: Given,
    /// The curvature vector, towards the centre of curvature. Fixed at a tangent that is not fixed, it keeps its size, and
    /// the rotation that takes the initial tangent to the present one carries it.
    pub curvature: Given,
    /// What the two spans share here.
    pub continuity: Continuity,
}

/// What is made small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functional {
    /// `∫ |dκ/ds|² ds`.
    Mvc = 0,
    /// `∫ κ² ds`.
    Mec = 1,
    /// `L³ ∫ |dκ/ds|² ds`. Minimised by Newton alone: it is no sum of squares over elements.
    SiMvc = 2,
}

/// A curve to be found.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The joints in order.
    pub joints: &'a [Joint],
    /// Whether a span joins the last joint to the first.
    pub closed: bool,
    /// Whether the curve stays in the xy plane. Curvature is signed then.
    pub planar: bool,
    /// Elements a span; inserted joints are free and G2.
    pub elements_per_span: usize,
    /// What is made small.
    pub functional: Functional,
    /// Gauss–Legendre points an element.
    pub points: usize,
}

impl<'a> Problem<'a> {
    /// A problem with one element a span and 40 quadrature points.
    pub fn new(joints: &'a [Joint], closed: bool, planar: bool, functional: Functional) -> Self {
        Self { joints, closed, planar, elements_per_span: 1, functional, points: 40 }
    }
}

/// How long to try. The tolerances are Ceres's own.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Levenberg–Marquardt iterations, 2000; 0 skips Ceres.
    pub ceres_iterations: usize,
    /// Newton iterations, 500; 0 skips the polish.
    pub newton_iterations: usize,
    /// Relative change of the cost, 1e-14.
    pub function_tolerance: f64,
    /// Largest gradient component, 1e-13.
    pub gradient_tolerance: f64,
    /// Relative step, 1e-13.
    pub parameter_tolerance: f64,
}

impl Options {
    /// Newton from the start. It reaches better minima of multi-element curves than Levenberg–Marquardt's end, which
    /// lies far along a flat valley.
    pub fn newton() -> Self {
        Self { ceres_iterations: 0, newton_iterations: 1000, ..Self::default() }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            ceres_iterations: 2000,
            newton_iterations: 500,
            function_tolerance: 1e-14,
            gradient_tolerance: 1e-13,
            parameter_tolerance: 1e-13,
        }
    }
}

/// Properties of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Measure {
    /// Variation `∫ |dκ/ds|² ds`.
    pub v: f64,
    /// Bending energy `∫ κ² ds`.
    pub e: f64,
    /// Length.
    pub l: f64,
    /// Least curvature: signed when planar (positive to the left), otherwise of its size.
    pub kappa_min: f64,
    /// Greatest curvature, likewise.
    pub kappa_max: f64,
}

/// How near a curve is to a stationary point over the thesis's free parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Certificate {
    /// The functional.
    pub value: f64,
    /// The largest `|∂ value / ∂ parameter|`.
    pub gradient: f64,
    /// What a Newton step would still gain, to second order, all curvatures of the functional taken positive.
    pub decrement: f64,
    /// The Hessian's smallest eigenvalue, in parameters scaled to one unit of span length: negative away from a minimum.
    pub smallest_eigenvalue: f64,
    /// The largest, for comparison.
    pub largest_eigenvalue: f64,
    /// The largest difference between the given rows and those that their parameters and the constraints make: large
    /// when the rows break a constraint or the continuity.
    pub defect: f64,
    /// How many free parameters there are.
    pub parameters: usize,
}

/// A curve found, and how.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The rows of each element in order.
    pub rows: Vec<Rows>,
    /// The functional at the start.
    pub start_value: f64,
    /// The functional where Ceres stopped.
    pub ceres_value: f64,
    /// Ceres's gradient (of half the value) where it stopped.
    pub ceres_gradient: f64,
    /// Levenberg–Marquardt iterations.
    pub ceres_iterations: usize,
    /// The functional after Newton, summed in extended precision.
    pub value: f64,
    /// The functional of the same rows by `2 points + 1` points: if it differs, the quadrature was cheated.
    pub finer_value: f64,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Whether a Newton step would gain less than 1e-12 of the value and no direction has negative curvature.
    pub converged: bool,
    /// Whether the curve grew out of all proportion, towards a minimum at infinity.
    pub runaway: bool,
    /// Properties of the curve.
    pub measure: Measure,
    /// How stationary it is.
    pub certificate: Certificate,
}

/// Where a solve begins.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// By the rules of thesis 4.9, cut into equal pieces of the parameter.
    Thesis,
    /// At given rows, one an element. What the problem fixes comes from the problem.
    Rows(&'a [Rows]),
}

mod raw {
    use super::{Certificate, Measure};

    pub(super) const MESSAGE: usize = 160;

    #[repr(C)]
    pub(super) struct Joint {
        pub(super) position: [f64; 3],
        pub(super) tangent: [f64; 3],
        pub(super) curvature: [f64; 3],
        pub(super) position_status: i32,
        pub(super) tangent_status: i32,
        pub(super) curvature_status: i32,
        pub(super) continuity: i32,
    }

    #[repr(C)]
    pub(super) struct Problem {
        pub(super) joints: *const Joint,
        pub(super) joint_count: usize,
        pub(super) closed: i32,
        pub(super) planar: i32,
        pub(super) elements_per_span: i32,
        pub(super) functional: i32,
        pub(super) points: i32,
    }

    #[repr(C)]
    pub(super) struct Options {
        pub(super) ceres_iterations: i32,
        pub(super) newton_iterations: i32,
        pub(super) function_tolerance: f64,
        pub(super) gradient_tolerance: f64,
        pub(super) parameter_tolerance: f64,
    }

    #[repr(C)]
    #[derive(Default)]
    pub(super) struct Report {
        pub(super) start_value: f64,
        pub(super) ceres_value: f64,
        pub(super) value: f64,
        pub(super) finer_value: f64,
        pub(super) ceres_gradient: f64,
        pub(super) ceres_iterations: i32,
        pub(super) newton_iterations: i32,
        pub(super) converged: i32,
        pub(super) runaway: i32,
        pub(super) measure: Measure,
        pub(super) certificate: Certificate,
    }

    unsafe extern "C" {
        pub(super) fn reference_element_count(problem: *const Problem) -> usize;
        pub(super) fn reference_start(problem: *const Problem, rows: *mut f64, message: *mut u8) -> i32;
        pub(super) fn reference_solve(
            problem: *const Problem,
            options: *const Options,
            start: *const f64,
            rows: *mut f64,
            result: *mut Report,
            message: *mut u8,
        ) -> i32;
        pub(super) fn reference_evaluate(
            rows: *const f64,
            element_count: usize,
            planar: i32,
            points: i32,
            measure: *mut Measure,
            message: *mut u8,
        ) -> i32;
        pub(super) fn reference_certify(
            problem: *const Problem,
            rows: *const f64,
            certificate: *mut Certificate,
            message: *mut u8,
        ) -> i32;
        pub(super) fn reference_gradient(
            problem: *const Problem,
            rows: *const f64,
            offset: *const f64,
            value: *mut f64,
            gradient: *mut f64,
            parameter_count: *mut usize,
            message: *mut u8,
        ) -> i32;
    }
}

/// The start rows of thesis 4.9, one an element.
pub fn start(problem: &Problem) -> Result<Vec<Rows>, String> {
    with(problem, |raw, count| {
        let mut rows = vec![[[0.0; 3]; 6]; count];
        // SAFETY: `rows` holds the 18 numbers an element that the call writes.
        called(|message| unsafe { raw::reference_start(raw, rows.as_mut_ptr().cast(), message) })?;
        Ok(rows)
    })
}

/// Minimises the functional.
pub fn solve(problem: &Problem, start: Start, options: &Options) -> Result<Solution, String> {
    with(problem, |raw, count| {
        let start = match start {
            Start::Thesis => std::ptr::null(),
            Start::Rows(rows) => matching(rows, count)?.as_ptr().cast(),
        };
        let options = raw::Options {
            ceres_iterations: int(options.ceres_iterations)?,
            newton_iterations: int(options.newton_iterations)?,
            function_tolerance: options.function_tolerance,
            gradient_tolerance: options.gradient_tolerance,
            parameter_tolerance: options.parameter_tolerance,
        };
        let mut rows = vec![[[0.0; 3]; 6]; count];
        let mut report = raw::Report::default();
        // SAFETY: `start` is null or holds `count` elements as `rows` does; the rest are single structs.
        called(|message| unsafe {
            raw::reference_solve(raw, &options, start, rows.as_mut_ptr().cast(), &mut report, message)
        })?;
        Ok(Solution {
            rows,
            start_value: report.start_value,
            ceres_value: report.ceres_value,
            ceres_gradient: report.ceres_gradient,
            ceres_iterations: report.ceres_iterations as usize,
            value: report.value,
            finer_value: report.finer_value,
            newton_iterations: report.newton_iterations as usize,
            converged: report.converged != 0,
            runaway: report.runaway != 0,
            measure: report.measure,
            certificate: report.certificate,
        })
    })
}

/// Measures any rows by `points` Gauss–Legendre points an element, summed in extended precision. The curvature range is
/// sampled at 200 places an element and refined.
pub fn evaluate(rows: &[Rows], planar: bool, points: usize) -> Result<Measure, String> {
    let mut measure = Measure::default();
    let points = int(points)?;
    // SAFETY: `rows` holds 18 numbers an element, and `measure` is one struct.
    called(|message| unsafe {
        raw::reference_evaluate(
            rows.as_ptr().cast(),
            rows.len(),
            planar.into(),
            points,
            &mut measure,
            message,
        )
    })?;
    Ok(measure)
}

/// Says how stationary rows are for a problem, wherever they come from.
pub fn certify(problem: &Problem, rows: &[Rows]) -> Result<Certificate, String> {
    with(problem, |raw, count| {
        let rows = matching(rows, count)?;
        let mut certificate = Certificate::default();
        // SAFETY: `rows` holds `count` elements of 18 numbers, and `certificate` is one struct.
        called(|message| unsafe {
            raw::reference_certify(raw, rows.as_ptr().cast(), &mut certificate, message)
        })?;
        Ok(certificate)
    })
}

/// The functional and its gradient over the free parameters of the rows.
pub fn gradient(problem: &Problem, rows: &[Rows]) -> Result<(f64, Vec<f64>), String> {
    with(problem, |raw, count| {
        let rows = matching(rows, count)?;
        let (mut value, mut used) = (0.0, 0);
        let mut gradient = vec![0.0; 18 * (count + 1)];
        // SAFETY: there are at most 18 parameters an element; no offset is a null pointer.
        called(|message| unsafe {
            raw::reference_gradient(
                raw,
                rows.as_ptr().cast(),
                std::ptr::null(),
                &mut value,
                gradient.as_mut_ptr(),
                &mut used,
                message,
            )
        })?;
        gradient.truncate(used);
        Ok((value, gradient))
    })
}

/// The functional at the parameters of the rows plus `offset`, which is as long as the gradient.
pub fn value_at(problem: &Problem, rows: &[Rows], offset: &[f64]) -> Result<f64, String> {
    let parameters = gradient(problem, rows)?.1.len();
    if offset.len() != parameters {
        return Err(format!("an offset of {} numbers for {parameters} parameters", offset.len()));
    }
    with(problem, |raw, count| {
        let rows = matching(rows, count)?;
        let (mut value, mut used) = (0.0, 0);
        // SAFETY: `offset` was found to be as long as the parameters; no gradient is a null pointer.
        called(|message| unsafe {
            raw::reference_gradient(
                raw,
                rows.as_ptr().cast(),
                offset.as_ptr(),
                &mut value,
                std::ptr::null_mut(),
                &mut used,
                message,
            )
        })?;
        Ok(value)
    })
}

fn with<T>(
    problem: &Problem,
    work: impl FnOnce(&raw::Problem, usize) -> Result<T, String>,
) -> Result<T, String> {
    let parts = |given: Given| match given {
        Given::Free => ([0.0; 3], 0),
        Given::Initial(value) => (value, 1),
        Given::Fixed(value) => (value, 2),
    };
    let mut joints = Vec::with_capacity(problem.joints.len());
    for joint in problem.joints {
        let (position, position_status) = parts(joint.position);
        let (tangent, tangent_status) = parts(joint.tangent);
        let (curvature, curvature_status) = parts(joint.curvature);
        joints.push(raw::Joint {
            position,
            tangent,
            curvature,
            position_status,
            tangent_status,
            curvature_status,
            continuity: joint.continuity as i32,
        });
    }
    let raw = raw::Problem {
        joints: joints.as_ptr(),
        joint_count: joints.len(),
        closed: problem.closed.into(),
        planar: problem.planar.into(),
        elements_per_span: int(problem.elements_per_span)?,
        functional: problem.functional as i32,
        points: int(problem.points)?,
    };
    // SAFETY: `raw` points to `joints`, which lives to the end of this function.
    let count = unsafe { raw::reference_element_count(&raw) };
    work(&raw, count)
}

fn matching(rows: &[Rows], count: usize) -> Result<&[Rows], String> {
    if rows.len() == count { Ok(rows) } else { Err(format!("{} elements given, {count} wanted", rows.len())) }
}

fn int(n: usize) -> Result<i32, String> {
    i32::try_from(n).map_err(|_| format!("{n} is too many"))
}

fn called(work: impl FnOnce(*mut u8) -> i32) -> Result<(), String> {
    let mut message = [0_u8; raw::MESSAGE];
    if work(message.as_mut_ptr()) == 0 {
        return Ok(());
    }
    let end = message.iter().position(|&b| b == 0).unwrap_or(message.len());
    Err(String::from_utf8_lossy(&message[..end]).into_owned())
}
