//! Error codes, the error with its sentence, and the statuses.

use core::ffi::c_char;
use core::fmt::{self, Write};
use kernel::curve::{CurveError, MeasureError};
use kernel::solve::Status;
use kernel::toolpath::{GcodeError, PathError};

/// What was wrong with a call. Nothing was computed and no result was written, unless the code says otherwise. The
/// numbers are fixed for good.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum minvar_code {
    /// Nothing: the call did what it says.
    MINVAR_OK = 0,
    /// A pointer is NULL that must not be.
    MINVAR_NULL_POINTER = 1,
    /// A pointer is not aligned for its type.
    MINVAR_MISALIGNED = 2,
    /// A length is larger than memory can be.
    MINVAR_TOO_LONG = 3,
    /// An open curve has fewer than two joints. `needed`, `given`.
    MINVAR_TOO_FEW_JOINTS = 10,
    /// A closed curve has fewer than three joints. `needed`, `given`.
    MINVAR_CLOSED_TOO_FEW_JOINTS = 11,
    /// A number of a joint is NaN or infinite. `index`: the joint.
    MINVAR_JOINT_NOT_FINITE = 12,
    /// A status or continuity of a joint is not one of the constants. `index`: the joint.
    MINVAR_UNKNOWN_CODE = 13,
    /// Two neighbouring joints coincide. `index`: the first of them.
    MINVAR_COINCIDENT_JOINTS = 14,
    /// A given tangent is the zero vector. `index`: the joint.
    MINVAR_ZERO_TANGENT = 15,
    /// A given curvature is not perpendicular to the given tangent. `index`: the joint.
    MINVAR_CURVATURE_NOT_PERPENDICULAR = 16,
    /// A curvature is given where the direction of the curve is unknown. `index`: the joint.
    MINVAR_CURVATURE_NEEDS_TANGENT = 17,
    /// The sides of a joint differ in what its continuity makes common. `index`: the joint.
    MINVAR_SIDES_DIFFER = 18,
    /// Fewer than two joints have positions.
    MINVAR_NO_POSITION = 19,
    /// Lengths beyond 1e-90 to 1e90.
    MINVAR_SIZE_OUT_OF_RANGE = 20,
    /// A planar curve was asked for but the data do not lie in a plane.
    MINVAR_NOT_PLANAR = 21,
    /// An option has a value that it cannot have; the message names it.
    MINVAR_BAD_OPTION = 22,
    /// The workspace is too short. `needed`, `given`, in doubles.
    MINVAR_WORKSPACE_TOO_SMALL = 23,
    /// An array for results is too short. `needed`, `given`, in its entries.
    MINVAR_RESULT_TOO_SHORT = 24,
    /// There are no elements.
    MINVAR_NO_ELEMENTS = 40,
    /// A number of an element is NaN, infinite or too large. `index`: the element.
    MINVAR_ELEMENT_NOT_FINITE = 41,
    /// An element has no tangent somewhere: its derivative vanishes. `index`: the element.
    MINVAR_IRREGULAR = 42,
    /// The place is not on the curve.
    MINVAR_OUT_OF_RANGE = 43,
    /// The tolerance is zero, negative or not finite.
    MINVAR_BAD_TOLERANCE = 60,
    /// The tolerance is finer than the numbers allow; the message says how fine it can be.
    MINVAR_TOLERANCE_TOO_FINE = 61,
    /// An element does not begin where the one before ends. `index`: the later element.
    MINVAR_GAP = 62,
    /// An element leaves the plane z = constant, which arcs need. `index`: the element.
    MINVAR_PATH_NOT_PLANAR = 63,
    /// The number of decimals is not 6 to 9.
    MINVAR_BAD_DECIMALS = 70,
    /// The feed is not positive and finite.
    MINVAR_BAD_FEED = 71,
    /// The plunge feed is not positive and finite.
    MINVAR_BAD_PLUNGE_FEED = 72,
    /// The depth is not finite or too large.
    MINVAR_BAD_DEPTH = 73,
    /// The safe height is not above the cut.
    MINVAR_BAD_SAFE_HEIGHT = 74,
    /// A coordinate is too large for the decimals. `index`: the element.
    MINVAR_COORDINATE_TOO_LARGE = 75,
    /// The caller's writer or visitor asked to stop: what was written is incomplete.
    MINVAR_STOPPED = 76,
}

use minvar_code::*;

/// An error with what it is about. Passed as the last argument, it may be NULL if nobody wants to know.
#[repr(C)]
pub struct minvar_error {
    /// The code, as returned.
    pub code: minvar_code,
    /// The joint, element or option that is to blame, where the code says so; else 0.
    pub index: usize,
    /// The length that is needed, where the code says so; else 0.
    pub needed: usize,
    /// The length that was given, where the code says so; else 0.
    pub given: usize,
    /// One sentence in English, NUL-terminated, that names the culprit.
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
    /// No further progress is possible in this precision; the figures say how near the minimum is.
    MINVAR_STALLED = 2,
    /// The allowed number of iterations was used up.
    MINVAR_ITERATION_LIMIT = 3,
    /// The shape grows without limit while the functional sinks: these data have no minimum.
    MINVAR_UNBOUNDED = 4,
    /// The observer asked to stop.
    MINVAR_CANCELLED = 5,
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

/// One English sentence on a status that a user can act on; static. A number that is no status gives "unknown status".
#[unsafe(no_mangle)]
pub extern "C" fn minvar_status_sentence(status: i32) -> *const c_char {
    let sentence = match status {
        0 => c"nothing was computed",
        1 => c"converged: the functional cannot be lowered by what the tolerance asks for",
        2 => c"stalled: no further progress is possible in this precision; the gradient says how near the minimum is",
        3 => c"stopped at the iteration limit: allow more iterations, or give better start values",
        4 => {
            c"unbounded: the curve grows without limit while the functional sinks; add a constraint, or choose a functional that has a minimum"
        }
        5 => c"cancelled by the observer",
        _ => c"unknown status",
    };
    sentence.as_ptr()
}

/// A failed call on its way to the caller.
pub(crate) struct Failure {
    pub(crate) code: minvar_code,
    pub(crate) index: usize,
    pub(crate) needed: usize,
    pub(crate) given: usize,
    message: Message,
}

/// A sentence cut to what fits into [`minvar_error`].
struct Message {
    text: [c_char; 192],
    len: usize,
}

impl Write for Message {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        for &byte in s.as_bytes() {
            if self.len + 1 < self.text.len() {
                self.text[self.len] = byte as c_char;
                self.len += 1;
            }
        }
        Ok(())
    }
}

impl Failure {
    /// A failure that the code alone describes.
    pub(crate) fn new(code: minvar_code) -> Self {
        let sentence = match code {
            MINVAR_NULL_POINTER => "a pointer is NULL that must not be",
            MINVAR_MISALIGNED => "a pointer is not aligned for its type",
            MINVAR_TOO_LONG => "a length is larger than memory can be",
            MINVAR_STOPPED => "the caller's function asked to stop: what was written is incomplete",
            _ => "the call failed",
        };
        Self::with(code, 0, 0, 0, &sentence)
    }

    /// An option outside its range.
    pub(crate) fn option(index: usize, rule: &str) -> Self {
        Self::with(MINVAR_BAD_OPTION, index, 0, 0, &format_args!("option {rule}"))
    }

    fn with(code: minvar_code, index: usize, needed: usize, given: usize, sentence: &dyn fmt::Display) -> Self {
        let mut message = Message { text: [0; 192], len: 0 };
        let _ = write!(message, "{sentence}");
        Self { code, index, needed, given, message }
    }
}

impl From<CurveError> for Failure {
    fn from(error: CurveError) -> Self {
        let (code, index, needed, given) = match error {
            CurveError::TooFewJoints { given } => (MINVAR_TOO_FEW_JOINTS, 0, 2, given),
            CurveError::ClosedTooFewJoints { given } => (MINVAR_CLOSED_TOO_FEW_JOINTS, 0, 3, given),
            CurveError::NotFinite { joint, .. } => (MINVAR_JOINT_NOT_FINITE, joint, 0, 0),
            CurveError::UnknownCode { joint, .. } => (MINVAR_UNKNOWN_CODE, joint, 0, 0),
            CurveError::CoincidentJoints { joint, .. } => (MINVAR_COINCIDENT_JOINTS, joint, 0, 0),
            CurveError::ZeroTangent { joint } => (MINVAR_ZERO_TANGENT, joint, 0, 0),
            CurveError::CurvatureNotPerpendicular { joint } => {
                (MINVAR_CURVATURE_NOT_PERPENDICULAR, joint, 0, 0)
            }
            CurveError::CurvatureNeedsTangent { joint } => (MINVAR_CURVATURE_NEEDS_TANGENT, joint, 0, 0),
            CurveError::SidesDiffer { joint, .. } => (MINVAR_SIDES_DIFFER, joint, 0, 0),
            CurveError::NoPosition => (MINVAR_NO_POSITION, 0, 0, 0),
            CurveError::SizeOutOfRange => (MINVAR_SIZE_OUT_OF_RANGE, 0, 0, 0),
            CurveError::NotPlanar => (MINVAR_NOT_PLANAR, 0, 0, 0),
            CurveError::BadOption(option) => (MINVAR_BAD_OPTION, option as usize, 0, 0),
            CurveError::WorkspaceTooSmall { needed, given } => (MINVAR_WORKSPACE_TOO_SMALL, 0, needed, given),
            CurveError::ElementsTooShort { needed, given } => (MINVAR_RESULT_TOO_SHORT, 0, needed, given),
        };
        Self::with(code, index, needed, given, &error)
    }
}

impl From<MeasureError> for Failure {
    fn from(error: MeasureError) -> Self {
        let (code, index, needed, given) = match error {
            MeasureError::NoElements => (MINVAR_NO_ELEMENTS, 0, 0, 0),
            MeasureError::NotFinite { element } => (MINVAR_ELEMENT_NOT_FINITE, element, 0, 0),
            MeasureError::Irregular { element } => (MINVAR_IRREGULAR, element, 0, 0),
            MeasureError::OutOfRange => (MINVAR_OUT_OF_RANGE, 0, 0, 0),
            MeasureError::TooShort { needed, given } => (MINVAR_RESULT_TOO_SHORT, 0, needed, given),
        };
        Self::with(code, index, needed, given, &error)
    }
}

impl From<PathError> for Failure {
    fn from(error: PathError) -> Self {
        let (code, index) = match error {
            PathError::NoElements => (MINVAR_NO_ELEMENTS, 0),
            PathError::Tolerance => (MINVAR_BAD_TOLERANCE, 0),
            PathError::ToleranceTooFine { .. } => (MINVAR_TOLERANCE_TOO_FINE, 0),
            PathError::NotFinite { element } => (MINVAR_ELEMENT_NOT_FINITE, element),
            PathError::Gap { element } => (MINVAR_GAP, element),
            PathError::NotPlanar { element } => (MINVAR_PATH_NOT_PLANAR, element),
            PathError::Irregular { element } => (MINVAR_IRREGULAR, element),
        };
        Self::with(code, index, 0, 0, &error)
    }
}

impl From<GcodeError> for Failure {
    fn from(error: GcodeError) -> Self {
        let (code, index) = match error {
            GcodeError::Path(error) => return error.into(),
            GcodeError::ToleranceBelowDecimals { .. } => (MINVAR_TOLERANCE_TOO_FINE, 0),
            GcodeError::Decimals => (MINVAR_BAD_DECIMALS, 0),
            GcodeError::Feed => (MINVAR_BAD_FEED, 0),
            GcodeError::PlungeFeed => (MINVAR_BAD_PLUNGE_FEED, 0),
            GcodeError::Depth => (MINVAR_BAD_DEPTH, 0),
            GcodeError::SafeHeight { .. } => (MINVAR_BAD_SAFE_HEIGHT, 0),
            GcodeError::CoordinateTooLarge { element } => (MINVAR_COORDINATE_TOO_LARGE, element),
            GcodeError::Write => (MINVAR_STOPPED, 0),
        };
        Self::with(code, index, 0, 0, &error)
    }
}

/// Ends a call: fills the error, if the caller wants it, and returns the code.
///
/// # Safety
/// `error` is NULL or valid for writing.
pub(crate) unsafe fn finish(result: Result<(), Failure>, error: *mut minvar_error) -> minvar_code {
    let failure = match result {
        Ok(()) => Failure::with(MINVAR_OK, 0, 0, 0, &"no error"),
        Err(failure) => failure,
    };
    let Failure { code, index, needed, given, message } = failure;
    if !error.is_null() && error.is_aligned() {
        // SAFETY: not NULL, aligned, and the caller promises that it can be written.
        unsafe { error.write(minvar_error { code, index, needed, given, message: message.text }) };
    }
    code
}
