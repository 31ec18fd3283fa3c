//! Error codes, the error with its sentence, and the statuses.

use core::ffi::c_char;
use core::fmt::{self, Write};
use kernel::curve::{CurveError, MeasureError, OptionName};
use kernel::solve::Status;
use kernel::toolpath::{GcodeError, PathError};

/// What was wrong with a call. Nothing was computed and no result was written, unless the code says otherwise. The
/// numbers are fixed for good.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum minvar_code {
    /// Nothing: the call did what it says.
    MINVAR_OK = 0,
    /// A pointer is NULL that must not be; the message names the argument.
    MINVAR_NULL_POINTER = 1,
    /// A pointer is not aligned for its type; the message names the argument. Where it is the error's own pointer, there
    /// is no message.
    MINVAR_MISALIGNED = 2,
    /// An array is longer than memory can be; the message names the argument.
    MINVAR_TOO_LONG = 3,
    /// An open curve has fewer than two joints. `needed`, `given`.
    MINVAR_TOO_FEW_JOINTS = 10,
    /// A closed curve has fewer than three joints. `needed`, `given`.
    MINVAR_CLOSED_TOO_FEW_JOINTS = 11,
    /// A number of a joint is NaN or infinite. `index`: the joint.
    MINVAR_JOINT_NOT_FINITE = 12,
    /// A `given` or the `continuity` of a joint is not one of the constants. `index`: the joint.
    MINVAR_UNKNOWN_CODE = 13,
    /// Two neighbouring joints are at the same point, to 1e-12 of the data's extent. `index`: the first of them.
    MINVAR_COINCIDENT_JOINTS = 14,
    /// A given tangent is the zero vector. `index`: the joint.
    MINVAR_ZERO_TANGENT = 15,
    /// A given curvature is not perpendicular to the given tangent, to 1e-6 of its length. `index`: the joint.
    MINVAR_CURVATURE_NOT_PERPENDICULAR = 16,
    /// A curvature is given where the direction of the curve is unknown. `index`: the joint.
    MINVAR_CURVATURE_NEEDS_TANGENT = 17,
    /// The sides of a joint differ in what its continuity makes common. `index`: the joint.
    MINVAR_SIDES_DIFFER = 18,
    /// Fewer than two joints have positions.
    MINVAR_NO_POSITION = 19,
    /// The data are too large or too small for the arithmetic: lengths must be from 1e-90 to 1e90, and given radii of
    /// curvature at least 1e-12 of the longest step between joints.
    MINVAR_SIZE_OUT_OF_RANGE = 20,
    /// A planar curve was asked for but the data do not lie in a plane.
    MINVAR_NOT_PLANAR = 21,
    /// An option has a value that it cannot have; the message names it. `index`: its place among the fields of the
    /// options, from 0; one more than the last for the reference's weight.
    MINVAR_BAD_OPTION = 22,
    /// The workspace is too short. `needed`, `given`, in doubles.
    MINVAR_WORKSPACE_TOO_SMALL = 23,
    /// An array for results is too short; the message names it. `needed`, `given`, in its entries.
    MINVAR_RESULT_TOO_SHORT = 24,
    /// The line or plane on which a joint slides has the zero vector as its direction. `index`: the joint.
    MINVAR_ZERO_GUIDE = 25,
    /// The length that is asked for is no greater than that of the polygon through the fixed joints.
    MINVAR_LENGTH_TOO_SHORT = 26,
    /// The reference shape has not as many elements as the curve. `needed`, `given`.
    MINVAR_WRONG_ELEMENT_COUNT = 27,
    /// An element of the reference shape, of the start or beside a region is not finite or has no direction at an end.
    /// `index`: the element.
    MINVAR_BAD_REFERENCE = 28,
    /// An obstacle has a number that is not finite or beyond 1e100, a negative clearance or an unknown side. `index`: the
    /// obstacle.
    MINVAR_BAD_OBSTACLE = 29,
    /// Obstacles need a planar curve, without a tolerance, a reference shape, a given length or a warm start.
    MINVAR_OBSTACLES_NOT_POSSIBLE = 30,
    /// A region has no elements, or some that the curve has not. `index`: its first element; `needed`: how many it has;
    /// `given`: how many the curve has.
    MINVAR_BAD_REGION = 31,
    /// There are no elements.
    MINVAR_NO_ELEMENTS = 40,
    /// A number of an element is NaN, infinite or (in paths) beyond 1e100. `index`: the element.
    MINVAR_ELEMENT_NOT_FINITE = 41,
    /// An element has no tangent somewhere: its derivative vanishes. `index`: the element.
    MINVAR_IRREGULAR = 42,
    /// An element, parameter, arc length or point that a place is asked for by is NaN or beyond the curve; the message
    /// says what it may be.
    MINVAR_OUT_OF_RANGE = 43,
    /// The tolerance is zero, negative, NaN or infinite.
    MINVAR_BAD_TOLERANCE = 60,
    /// The tolerance is finer than the numbers allow; the message says how fine it can be.
    MINVAR_TOLERANCE_TOO_FINE = 61,
    /// An element does not begin where the one before ends, to a thousandth of the tolerance. `index`: the later element.
    MINVAR_GAP = 62,
    /// An element leaves the plane z = constant, which arcs need. `index`: the element.
    MINVAR_PATH_NOT_PLANAR = 63,
    /// The number of decimals is not 6 to 9.
    MINVAR_BAD_DECIMALS = 70,
    /// The feed is not positive and finite, or rounds to zero.
    MINVAR_BAD_FEED = 71,
    /// The plunge feed is not positive and finite, or rounds to zero.
    MINVAR_BAD_PLUNGE_FEED = 72,
    /// The depth is not finite or too large for the decimals.
    MINVAR_BAD_DEPTH = 73,
    /// The safe height is not above the cut, not finite or too large; the message says how high the cut reaches.
    MINVAR_BAD_SAFE_HEIGHT = 74,
    /// A coordinate is too large for the decimals. `index`: the element.
    MINVAR_COORDINATE_TOO_LARGE = 75,
    /// The caller's writer or visitor asked to stop: what it got is incomplete. Other results are untouched.
    MINVAR_STOPPED = 76,
    /// No code: it keeps the enum at 32 bits where compilers would make it as short as its numbers (Arm's convention for
    /// programs without an operating system, `-fshort-enums`).
    MINVAR_CODE_HAS_32_BITS = 0x7fff_ffff,
}

use minvar_code::*;

/// An error with what it is about. The last argument of every function that can fail; it may be NULL if nobody wants to
/// know. Every call fills it: after a success with MINVAR_OK and "no error".
#[repr(C)]
pub struct minvar_error {
    /// The code, as returned.
    pub code: minvar_code,
    /// The joint, element, obstacle or option, from 0, that is to blame, where the code says so; else 0.
    pub index: usize,
    /// How many entries are needed, where the code says so; else 0.
    pub needed: usize,
    /// How many were given, where the code says so; else 0.
    pub given: usize,
    /// One sentence in English, ASCII, NUL-terminated, that names the culprit. Its words may change; the codes do not.
    pub message: [c_char; 192],
}

/// How a computation ended. A status is not an error: figures were computed, and the status says what they are worth.
/// The numbers are fixed for good.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum minvar_status {
    /// Nothing was computed yet.
    MINVAR_UNSOLVED = 0,
    /// A minimum was reached: the functional cannot be lowered by what the tolerance asks for.
    MINVAR_CONVERGED = 1,
    /// No further progress is possible though the tolerances are not met, or what was reached is no true minimum: a cusp, a
    /// functional that a finer quadrature does not confirm, an element that would rather stop at its end. More elements may
    /// help.
    MINVAR_STALLED = 2,
    /// The allowed number of iterations was used up.
    MINVAR_ITERATION_LIMIT = 3,
    /// The shape grows without limit while the functional sinks: these data have no minimum.
    MINVAR_UNBOUNDED = 4,
    /// The observer asked to stop.
    MINVAR_CANCELLED = 5,
    /// No status: it keeps the enum at 32 bits, as MINVAR_CODE_HAS_32_BITS does.
    MINVAR_STATUS_HAS_32_BITS = 0x7fff_ffff,
}

impl From<Status> for minvar_status {
    fn from(status: Status) -> Self {
        match status {
            Status::Unsolved => Self::MINVAR_UNSOLVED,
            Status::Converged => Self::MINVAR_CONVERGED,
            Status::Stalled => Self::MINVAR_STALLED,
            Status::IterationLimit => Self::MINVAR_ITERATION_LIMIT,
            Status::Unbounded => Self::MINVAR_UNBOUNDED,
            Status::Cancelled => Self::MINVAR_CANCELLED,
        }
    }
}

/// One English sentence on a status (of enum minvar_status) that a user can act on; static: not to be freed. A number
/// that is no status gives "unknown status".
#[unsafe(no_mangle)]
pub extern "C" fn minvar_status_sentence(status: u32) -> *const c_char {
    let sentence = match status {
        0 => c"nothing was computed",
        1 => c"converged: the functional cannot be lowered by what the tolerance asks for",
        2 => c"stalled: no further progress is possible, or the elements are too coarse for the curve; take more elements a span",
        3 => c"stopped at the iteration limit: allow more iterations, or give better start values",
        4 => {
            c"unbounded: the curve grows without limit while the functional sinks; add a constraint, or choose a functional that has a minimum"
        }
        5 => c"cancelled by the observer",
        _ => c"unknown status",
    };
    sentence.as_ptr()
}

/// What this boundary itself finds wrong. Names are the header's.
pub(crate) enum Failure {
    /// A pointer that cannot be used.
    Argument { code: minvar_code, name: &'static str },
    /// An option that is not one of the constants, by its place among the fields of the struct.
    Option { field: usize, rule: &'static str },
    /// A place that is not on the curve, and what it may be.
    Place { rule: &'static str },
    /// An array for results that is too short.
    TooShort { name: &'static str, needed: usize, given: usize },
    /// The visitor stopped.
    Stopped,
}

/// Why a call failed: this boundary or the kernel, whose error is a type of its own so that a program links the
/// sentences of what it calls and no others.
pub(crate) enum Refusal<E> {
    Boundary(Failure),
    Kernel(E),
}

impl<E> From<Failure> for Refusal<E> {
    fn from(failure: Failure) -> Self {
        Self::Boundary(failure)
    }
}

macro_rules! from_kernel {
    ($($error:ty),*) => {
        $(impl From<$error> for Refusal<$error> {
            fn from(error: $error) -> Self {
                Self::Kernel(error)
            }
        })*
    };
}

from_kernel!(CurveError, MeasureError, PathError, GcodeError);

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument { code, name } => {
                let wrong = match code {
                    MINVAR_NULL_POINTER => "is NULL",
                    MINVAR_MISALIGNED => "is not aligned for its type",
                    _ => "is longer than memory can be",
                };
                write!(f, "argument {name} {wrong}")
            }
            Self::Option { rule, .. } => write!(f, "option {rule}"),
            Self::Place { rule } => f.write_str(rule),
            Self::TooShort { name, needed, given } => {
                write!(f, "argument {name} needs room for {needed} entries; {given} given")
            }
            Self::Stopped => f.write_str("the visitor asked to stop: the path is incomplete"),
        }
    }
}

/// A code and the numbers that go with it.
pub(crate) struct Verdict {
    code: minvar_code,
    index: usize,
    needed: usize,
    given: usize,
}

impl Verdict {
    const fn new(code: minvar_code) -> Self {
        Self::at(code, 0)
    }

    const fn at(code: minvar_code, index: usize) -> Self {
        Self { code, index, needed: 0, given: 0 }
    }

    const fn short(code: minvar_code, needed: usize, given: usize) -> Self {
        Self { code, index: 0, needed, given }
    }
}

impl From<&Failure> for Verdict {
    fn from(failure: &Failure) -> Self {
        match *failure {
            Failure::Argument { code, .. } => Self::new(code),
            Failure::Option { field, .. } => Self::at(MINVAR_BAD_OPTION, field),
            Failure::Place { .. } => Self::new(MINVAR_OUT_OF_RANGE),
            Failure::TooShort { needed, given, .. } => Self::short(MINVAR_RESULT_TOO_SHORT, needed, given),
            Failure::Stopped => Self::new(MINVAR_STOPPED),
        }
    }
}

impl From<&CurveError> for Verdict {
    fn from(error: &CurveError) -> Self {
        match *error {
            CurveError::TooFewJoints { given } => Self::short(MINVAR_TOO_FEW_JOINTS, 2, given),
            CurveError::ClosedTooFewJoints { given } => Self::short(MINVAR_CLOSED_TOO_FEW_JOINTS, 3, given),
            CurveError::NotFinite { joint, .. } => Self::at(MINVAR_JOINT_NOT_FINITE, joint),
            CurveError::UnknownCode { joint, .. } => Self::at(MINVAR_UNKNOWN_CODE, joint),
            CurveError::CoincidentJoints { joint, .. } => Self::at(MINVAR_COINCIDENT_JOINTS, joint),
            CurveError::ZeroTangent { joint } => Self::at(MINVAR_ZERO_TANGENT, joint),
            CurveError::CurvatureNotPerpendicular { joint } => {
                Self::at(MINVAR_CURVATURE_NOT_PERPENDICULAR, joint)
            }
            CurveError::CurvatureNeedsTangent { joint } => Self::at(MINVAR_CURVATURE_NEEDS_TANGENT, joint),
            CurveError::SidesDiffer { joint, .. } => Self::at(MINVAR_SIDES_DIFFER, joint),
            CurveError::NoPosition => Self::new(MINVAR_NO_POSITION),
            CurveError::SizeOutOfRange => Self::new(MINVAR_SIZE_OUT_OF_RANGE),
            CurveError::NotPlanar => Self::new(MINVAR_NOT_PLANAR),
            CurveError::BadOption(option) => Self::at(MINVAR_BAD_OPTION, field_of(option)),
            CurveError::ZeroGuide { joint } => Self::at(MINVAR_ZERO_GUIDE, joint),
            CurveError::LengthTooShort => Self::new(MINVAR_LENGTH_TOO_SHORT),
            CurveError::WrongElementCount { needed, given } => {
                Self::short(MINVAR_WRONG_ELEMENT_COUNT, needed, given)
            }
            CurveError::BadObstacle { obstacle } => Self::at(MINVAR_BAD_OBSTACLE, obstacle),
            CurveError::ObstaclesNotPossible => Self::new(MINVAR_OBSTACLES_NOT_POSSIBLE),
            CurveError::BadRegion { first, count, elements } => {
                Self { index: first, ..Self::short(MINVAR_BAD_REGION, count, elements) }
            }
            CurveError::BadElement { element } => Self::at(MINVAR_BAD_REFERENCE, element),
            CurveError::WorkspaceTooSmall { needed, given } => {
                Self::short(MINVAR_WORKSPACE_TOO_SMALL, needed, given)
            }
            CurveError::ElementsTooShort { needed, given } => {
                Self::short(MINVAR_RESULT_TOO_SHORT, needed, given)
            }
        }
    }
}

impl From<&MeasureError> for Verdict {
    fn from(error: &MeasureError) -> Self {
        match *error {
            MeasureError::NoElements => Self::new(MINVAR_NO_ELEMENTS),
            MeasureError::NotFinite { element } => Self::at(MINVAR_ELEMENT_NOT_FINITE, element),
            MeasureError::Irregular { element } => Self::at(MINVAR_IRREGULAR, element),
            MeasureError::OutOfRange => Self::new(MINVAR_OUT_OF_RANGE),
            MeasureError::TooShort { needed, given } => Self::short(MINVAR_RESULT_TOO_SHORT, needed, given),
        }
    }
}

impl From<&PathError> for Verdict {
    fn from(error: &PathError) -> Self {
        match *error {
            PathError::NoElements => Self::new(MINVAR_NO_ELEMENTS),
            PathError::Tolerance => Self::new(MINVAR_BAD_TOLERANCE),
            PathError::ToleranceTooFine { .. } => Self::new(MINVAR_TOLERANCE_TOO_FINE),
            PathError::NotFinite { element } => Self::at(MINVAR_ELEMENT_NOT_FINITE, element),
            PathError::Gap { element } => Self::at(MINVAR_GAP, element),
            PathError::NotPlanar { element } => Self::at(MINVAR_PATH_NOT_PLANAR, element),
            PathError::Irregular { element } => Self::at(MINVAR_IRREGULAR, element),
        }
    }
}

impl From<&GcodeError> for Verdict {
    fn from(error: &GcodeError) -> Self {
        match *error {
            GcodeError::Path(error) => Self::from(&error),
            GcodeError::ToleranceBelowDecimals { .. } => Self::new(MINVAR_TOLERANCE_TOO_FINE),
            GcodeError::Decimals => Self::new(MINVAR_BAD_DECIMALS),
            GcodeError::Feed => Self::new(MINVAR_BAD_FEED),
            GcodeError::PlungeFeed => Self::new(MINVAR_BAD_PLUNGE_FEED),
            GcodeError::Depth => Self::new(MINVAR_BAD_DEPTH),
            GcodeError::SafeHeight { .. } => Self::new(MINVAR_BAD_SAFE_HEIGHT),
            GcodeError::CoordinateTooLarge { element } => Self::at(MINVAR_COORDINATE_TOO_LARGE, element),
            GcodeError::Write => Self::new(MINVAR_STOPPED),
        }
    }
}

/// The place of an option among the fields of minvar_options; the reference's weight comes after them.
const fn field_of(option: OptionName) -> usize {
    match option {
        OptionName::Functional => 0,
        OptionName::ElementsPerSpan => 1,
        OptionName::QuadraturePoints => 2,
        OptionName::Dimension => 4,
        OptionName::Continuation => 5,
        OptionName::RelativeDecrease => 6,
        OptionName::Tension => 7,
        OptionName::Bending => 8,
        OptionName::Length => 9,
        OptionName::Tolerance => 10,
        OptionName::ReferenceWeight => 11,
    }
}

/// A sentence cut to what fits into [`minvar_error`], with the NUL that ends it.
struct Message {
    text: [c_char; 192],
    len: usize,
}

impl Write for Message {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        for &byte in s.as_bytes() {
            // The last place is the NUL's.
            if let [place, _, ..] = self.text.get_mut(self.len..).unwrap_or_default() {
                *place = byte as c_char;
                self.len += 1;
            }
        }
        Ok(())
    }
}

/// Makes a call: fills the error, if the caller wants it, and returns the code.
///
/// # Safety
/// `error` is NULL, misaligned or valid for writing.
pub(crate) unsafe fn answer<E: fmt::Display>(
    error: *mut minvar_error,
    call: impl FnOnce() -> Result<(), Refusal<E>>,
) -> minvar_code
where
    for<'a> Verdict: From<&'a E>,
{
    if !error.is_aligned() {
        return MINVAR_MISALIGNED;
    }
    let result = call();
    let verdict = match &result {
        Ok(()) => Verdict::new(MINVAR_OK),
        Err(Refusal::Boundary(failure)) => failure.into(),
        Err(Refusal::Kernel(error)) => error.into(),
    };
    let Verdict { code, index, needed, given } = verdict;
    if !error.is_null() {
        let mut message = Message { text: [0; 192], len: 0 };
        // A message that is full loses its end, not the call.
        let _ = match &result {
            Ok(()) => message.write_str("no error"),
            Err(Refusal::Boundary(failure)) => write!(message, "{failure}"),
            Err(Refusal::Kernel(error)) => write!(message, "{error}"),
        };
        // SAFETY: not NULL, aligned, and the caller promises that it can be written.
        unsafe { error.write(minvar_error { code, index, needed, given, message: message.text }) };
    }
    code
}
