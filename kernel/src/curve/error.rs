//! What can be wrong with a curve's data or options. Nothing was computed when one of these comes back.

use core::fmt;

/// Which quantity of a joint, or which option, an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The joint's continuity.
    Continuity,
    /// The joint's position.
    Position,
    /// A tangent.
    Tangent,
    /// A curvature.
    Curvature,
    /// The line or plane on which a position slides.
    Guide,
}

impl Part {
    const fn name(self) -> &'static str {
        match self {
            Self::Continuity => "continuity",
            Self::Position => "position",
            Self::Tangent => "tangent",
            Self::Curvature => "curvature",
            Self::Guide => "guide",
        }
    }
}

/// An option of [`super::Options`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionName {
    /// `functional`
    Functional,
    /// `elements_per_span`
    ElementsPerSpan,
    /// `quadrature_points`
    QuadraturePoints,
    /// `dimension`
    Dimension,
    /// `continuation`
    Continuation,
    /// `relative_decrease`
    RelativeDecrease,
    /// `tension`
    Tension,
    /// `bending`
    Bending,
    /// `length`
    Length,
    /// `tolerance`
    Tolerance,
    /// The reference's `weight`
    ReferenceWeight,
}

impl OptionName {
    /// The option's name and what it may be.
    const fn rule(self) -> &'static str {
        match self {
            Self::Functional => {
                "functional: must be MVC (0), MEC (1), scale-invariant MVC (2) or MEC (3), space MVC (4) or MEC (5)"
            }
            Self::ElementsPerSpan => "elements_per_span: must be from 1 to 1024",
            Self::QuadraturePoints => "quadrature_points: must be 0 (as many as needed) or from 12 to 32",
            Self::Dimension => {
                "dimension: must be 0 (found from the data), 2 (the data must lie in a plane) or 3"
            }
            Self::Continuation => "continuation: must be from 0 to 16 stages",
            Self::RelativeDecrease => "relative_decrease: must be a number from 0 to below 1",
            Self::Tension => "tension: must be a number from 0 up, and 0 with a scale-invariant functional",
            Self::Bending => "bending: must be a number from 0 up, and 0 with a scale-invariant functional",
            Self::Length => "length: must be 0 (free) or a positive number",
            Self::Tolerance => "tolerance: must be 0 (as many elements as asked for) or a positive number",
            Self::ReferenceWeight => {
                "weight of the reference shape: must be a number from 0 to 1, for MVC alone"
            }
        }
    }
}

/// Why a curve cannot be computed. Joints are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveError {
    /// An open curve needs two joints.
    TooFewJoints {
        /// How many there are.
        given: usize,
    },
    /// A closed curve needs three joints.
    ClosedTooFewJoints {
        /// How many there are.
        given: usize,
    },
    /// A number is NaN or infinite.
    NotFinite {
        /// The joint.
        joint: usize,
        /// Which of its quantities.
        part: Part,
    },
    /// A status or continuity is none of the defined codes.
    UnknownCode {
        /// The joint.
        joint: usize,
        /// Which of its quantities.
        part: Part,
    },
    /// Two neighbouring joints are at the same point, as far as the numbers tell.
    CoincidentJoints {
        /// The first of the two.
        joint: usize,
        /// The second.
        next: usize,
    },
    /// A given tangent has no direction.
    ZeroTangent {
        /// The joint.
        joint: usize,
    },
    /// The line or plane on which a joint slides has no direction.
    ZeroGuide {
        /// The joint.
        joint: usize,
    },
    /// The length that is asked for is not greater than that of the polygon of the fixed joints.
    LengthTooShort,
    /// A chain of elements, the reference shape or the start, has not as many as the curve.
    WrongElementCount {
        /// As many as the curve has.
        needed: usize,
        /// How many were given.
        given: usize,
    },
    /// An obstacle has a number that is not finite or beyond 1e100, a negative clearance or an unknown side.
    BadObstacle {
        /// The obstacle.
        obstacle: usize,
    },
    /// Obstacles need a planar curve, without a tolerance, a reference shape, a given length or a warm start.
    ObstaclesNotPossible,
    /// A region has no elements, or some that the curve has not.
    BadRegion {
        /// Its first element.
        first: usize,
        /// How many it has.
        count: usize,
        /// How many the curve has.
        elements: usize,
    },
    /// An element of the reference shape, of the start or beside a region is not a number, or stands still at an end.
    BadElement {
        /// The element.
        element: usize,
    },
    /// A given curvature vector is not perpendicular to the given tangent (by more than 1e-6 of its length).
    CurvatureNotPerpendicular {
        /// The joint.
        joint: usize,
    },
    /// A curvature is given where no tangent is, and the data do not tell to which side the curve runs.
    CurvatureNeedsTangent {
        /// The joint.
        joint: usize,
    },
    /// The two sides of a joint differ in a quantity that its continuity makes common.
    SidesDiffer {
        /// The joint.
        joint: usize,
        /// Which quantity.
        part: Part,
    },
    /// Fewer than two joints have a position.
    NoPosition,
    /// The data are too large or too small for the arithmetic: lengths from 1e-90 to 1e90 are allowed, and radii of curvature
    /// from 1e-12 of the longest step between joints on.
    SizeOutOfRange,
    /// The data do not lie in a plane though the options ask for a planar curve.
    NotPlanar,
    /// An option has a value that it cannot have.
    BadOption(OptionName),
    /// The workspace is too short.
    WorkspaceTooSmall {
        /// The length that is needed, in `f64`s.
        needed: usize,
        /// The length that was given.
        given: usize,
    },
    /// The slice for the resulting elements is too short.
    ElementsTooShort {
        /// The length that is needed, in elements.
        needed: usize,
        /// The length that was given.
        given: usize,
    },
}

impl fmt::Display for CurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooFewJoints { given } => {
                write!(f, "a curve needs at least two joints; {given} given")
            }
            Self::ClosedTooFewJoints { given } => {
                write!(f, "a closed curve needs at least three joints; {given} given")
            }
            Self::NotFinite { joint, part } => {
                write!(f, "the {} of joint {joint} has a number that is NaN or infinite", part.name())
            }
            Self::UnknownCode { joint, part } => {
                write!(f, "the {} of joint {joint} has a code that is not defined", part.name())
            }
            Self::CoincidentJoints { joint, next } => {
                write!(f, "joints {joint} and {next} are at the same point; give each point once")
            }
            Self::ZeroTangent { joint } => {
                write!(f, "the tangent of joint {joint} is the zero vector and has no direction")
            }
            Self::ZeroGuide { joint } => {
                write!(f, "the line or plane on which joint {joint} slides has the zero vector as its direction")
            }
            Self::LengthTooShort => f.write_str(
                "the length that was asked for is no greater than that of the polygon through the fixed joints",
            ),
            Self::WrongElementCount { needed, given } => {
                write!(f, "the reference shape or the start needs {needed} elements; {given} given")
            }
            Self::BadObstacle { obstacle } => write!(
                f,
                "obstacle {obstacle} has a number that is not finite or beyond 1e100, a negative clearance or an \
                 unknown side"
            ),
            Self::ObstaclesNotPossible => f.write_str(
                "obstacles need a planar curve, without a tolerance, a reference shape, a given length or a warm start",
            ),
            Self::BadRegion { first, count: 0, .. } => {
                write!(f, "the region from element {first} on has no elements")
            }
            Self::BadRegion { first, count, elements } => {
                write!(
                    f,
                    "a region of {count} elements from element {first} on is not within a curve of {elements}"
                )
            }
            Self::BadElement { element } => {
                write!(
                    f,
                    "element {element} of the reference shape, of the start or beside the region has a number that is \
                     not finite, or no direction at an end"
                )
            }
            Self::CurvatureNotPerpendicular { joint } => {
                write!(f, "the curvature of joint {joint} is not perpendicular to its tangent")
            }
            Self::CurvatureNeedsTangent { joint } => {
                write!(
                    f,
                    "joint {joint} has a curvature but the direction of the curve there is unknown; \
                     give an initial tangent"
                )
            }
            Self::SidesDiffer { joint, part } => {
                write!(
                    f,
                    "the two sides of joint {joint} have different {} though its continuity makes it common",
                    part.name()
                )
            }
            Self::NoPosition => f.write_str("fewer than two joints have a position"),
            Self::SizeOutOfRange => {
                f.write_str(
                    "the data are too large or too small: lengths must be from 1e-90 to 1e90, radii of curvature at least \
                     1e-12 of the longest step",
                )
            }
            Self::NotPlanar => f.write_str("a planar curve was asked for but the data do not lie in a plane"),
            Self::BadOption(option) => write!(f, "option {}", option.rule()),
            Self::WorkspaceTooSmall { needed, given } => {
                write!(f, "the workspace needs {needed} doubles; {given} given")
            }
            Self::ElementsTooShort { needed, given } => {
                write!(f, "the result needs room for {needed} elements; {given} given")
            }
        }
    }
}

impl core::error::Error for CurveError {}
