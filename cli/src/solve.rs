//! From a specification to a curve: the one place where the command calls the kernel's solver.

mod spans;

use crate::constraints::{Continuity, Given, NamedJoint, Specification};
use minvar::curve::{
    self, Curve, CurveError, Element, Joint, Obstacle, OptionName, Quantity, Reference, Report, measure,
};
use minvar::solve::{Silent, Status};

/// What a curve minimises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Functional {
    /// Minimum variation: ∫ (dκ/ds)² ds
    Mvc,
    /// Minimum energy: ∫ κ² ds
    Mec,
    /// Scale-invariant minimum variation: L³ ∫ (dκ/ds)² ds, which has a minimum where mvc grows without limit
    SiMvc,
    /// Scale-invariant minimum energy: L ∫ κ² ds
    SiMec,
    /// Minimum variation of curvature and torsion, for space curves: ∫ (dκ/ds)² + (dτ/ds)² ds
    SpaceMvc,
    /// Minimum energy of bending and twisting, for space curves: ∫ κ² + τ² ds
    SpaceMec,
}

impl Functional {
    /// The name in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Mvc => "mvc",
            Self::Mec => "mec",
            Self::SiMvc => "si-mvc",
            Self::SiMec => "si-mec",
            Self::SpaceMvc => "space-mvc",
            Self::SpaceMec => "space-mec",
        }
    }

    /// The name and formula in pictures.
    pub(crate) fn formula(self) -> &'static str {
        match self {
            Self::Mvc => "MVC  ∫ (dκ/ds)² ds",
            Self::Mec => "MEC  ∫ κ² ds",
            Self::SiMvc => "SI-MVC  L³ ∫ (dκ/ds)² ds",
            Self::SiMec => "SI-MEC  L ∫ κ² ds",
            Self::SpaceMvc => "Space MVC  ∫ (dκ/ds)² + (dτ/ds)² ds",
            Self::SpaceMec => "Space MEC  ∫ κ² + τ² ds",
        }
    }

    /// The functional of the same kind that does not change with the size, if this one does and there is one.
    pub(crate) fn scale_invariant(self) -> Option<Self> {
        match self {
            Self::Mvc => Some(Self::SiMvc),
            Self::Mec => Some(Self::SiMec),
            Self::SiMvc | Self::SiMec | Self::SpaceMvc | Self::SpaceMec => None,
        }
    }

    /// The power of the length by which a value shrinks when the shape grows.
    pub(crate) fn scale_power(self) -> i32 {
        match self {
            Self::Mvc | Self::SpaceMvc => 3,
            Self::Mec | Self::SpaceMec => 1,
            Self::SiMvc | Self::SiMec => 0,
        }
    }

    fn code(self) -> curve::Functional {
        match self {
            Self::Mvc => curve::Functional::MVC,
            Self::Mec => curve::Functional::MEC,
            Self::SiMvc => curve::Functional::SI_MVC,
            Self::SiMec => curve::Functional::SI_MEC,
            Self::SpaceMvc => curve::Functional::SPACE_MVC,
            Self::SpaceMec => curve::Functional::SPACE_MEC,
        }
    }
}

/// How to solve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// What is minimised.
    pub(crate) functional: Functional,
    /// The weight of the length.
    pub(crate) tension: f64,
    /// The weight of the bending energy.
    pub(crate) bending: f64,
    /// The length of the curve; 0 leaves it free.
    pub(crate) length: f64,
    /// How far the curve may be from the true minimum; 0 takes just so many elements.
    pub(crate) tolerance: f64,
    /// Elements between two joints, with a tolerance at most.
    pub(crate) elements_per_span: u32,
    /// The largest number of iterations.
    pub(crate) max_iterations: u32,
    /// Stages of a continuation under tension.
    pub(crate) continuation: u32,
    /// The most local minima to look for; 0 takes what the usual start leads to.
    pub(crate) minima: usize,
    /// 2, 3, or 0 to find out.
    pub(crate) dimension: u32,
    /// A shape whose change of curvature is the aim.
    pub(crate) reference: Option<Shape>,
}

impl Options {
    /// Plain minimum variation, one element a span.
    #[cfg(test)]
    pub(crate) const PLAIN: Self = Self {
        functional: Functional::Mvc,
        tension: 0.0,
        bending: 0.0,
        length: 0.0,
        tolerance: 0.0,
        elements_per_span: 1,
        max_iterations: 500,
        continuation: 0,
        minima: 0,
        dimension: 0,
        reference: None,
    };

    /// Whether an accuracy of the curve was asked for.
    pub(crate) fn has_tolerance(&self) -> bool {
        self.tolerance > 0.0
    }
}

/// A reference shape.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// The name of its file.
    pub(crate) name: String,
    /// Its elements.
    pub(crate) elements: Vec<Element>,
    /// How much of its change of curvature is the aim, 0 to 1.
    pub(crate) weight: f64,
}

/// A curve and its figures.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// How the computation ended.
    pub(crate) status: Status,
    /// The number of iterations.
    pub(crate) iterations: usize,
    /// How often an element was linearised, over all elements.
    pub(crate) linearisations: usize,
    /// What was minimised.
    pub(crate) functional: Functional,
    /// The estimated distance from the true minimum: `None` where no tolerance was asked for or nothing is known.
    pub(crate) error: Option<f64>,
    /// The functional's value.
    pub(crate) value: f64,
    /// The functional's value by a finer rule.
    pub(crate) fine_value: f64,
    /// The arc length.
    pub(crate) length: f64,
    /// ∫ (dκ/ds)² ds
    pub(crate) variation: f64,
    /// ∫ κ² ds
    pub(crate) bending: f64,
    /// The largest gradient component as a fraction of the functional.
    pub(crate) gradient: f64,
    /// The least curvature: signed in a plane.
    pub(crate) curvature_min: f64,
    /// The greatest curvature: signed in a plane.
    pub(crate) curvature_max: f64,
    /// The elements in order.
    pub(crate) elements: Vec<Element>,
    /// The element that begins at each joint; their number at the end of an open curve.
    pub(crate) starts: Vec<usize>,
}

/// Why there is no curve: the input's fault.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Error {
    /// One sentence naming the culprit.
    pub(crate) message: String,
    /// The line and column of the joint or obstacle that it is about.
    pub(crate) place: Option<[usize; 2]>,
}

/// Computes the curve: one solution, or as many minima as are asked for and found, the lowest first. Where none is found
/// the one solution has not converged.
pub(crate) fn solve(specification: &Specification, options: &Options) -> Result<Vec<Solution>, Error> {
    with_curve(specification, options, |curve, kernel_options| {
        let mut workspace = vec![0.0; curve::workspace_len(curve, kernel_options)?];
        let len = curve::elements_len(curve, kernel_options);
        let mut elements = vec![Element::ZERO; (options.minima + 1) * len];
        let report =
            curve::solve(curve, kernel_options, &mut workspace, &mut elements, &mut [], &mut Silent)?;
        let usual = Solution::new(specification, options, &report, &elements);
        if options.minima == 0 {
            return Ok(vec![usual]);
        }
        let mut reports = vec![report; options.minima];
        let found =
            curve::minima(curve, kernel_options, &mut workspace, &mut elements, &mut reports, &mut Silent)?;
        let each = reports[..found].iter().zip(elements.chunks(len));
        let minima: Vec<_> =
            each.map(|(report, elements)| Solution::new(specification, options, report, elements)).collect();
        Ok(if minima.is_empty() { vec![usual] } else { minima })
    })
}

/// Calls the kernel with its own form of what is asked for; gives its errors the names that the user wrote.
fn with_curve<T>(
    specification: &Specification,
    options: &Options,
    work: impl FnOnce(&Curve<'_>, &curve::Options) -> Result<T, CurveError>,
) -> Result<T, Error> {
    let joints: Vec<Joint> = specification.joints.iter().map(joint).collect();
    let obstacles: Vec<Obstacle> = specification.obstacles.iter().map(|obstacle| obstacle.shape).collect();
    let mut curve = Curve::new(&joints, specification.closed).with_obstacles(&obstacles);
    if let Some(Shape { elements, weight, .. }) = &options.reference {
        curve = curve.with_reference(Reference { elements, weight: *weight });
    }
    let kernel_options = curve::Options {
        functional: options.functional.code(),
        tension: options.tension,
        bending: options.bending,
        elements_per_span: options.elements_per_span,
        length: options.length,
        tolerance: options.tolerance,
        max_iterations: options.max_iterations,
        continuation: options.continuation,
        dimension: options.dimension,
        ..curve::Options::DEFAULT
    };
    work(&curve, &kernel_options).map_err(|error| {
        let apart = first_apart(&error, &curve, &kernel_options);
        Error::of(error, specification, options, apart)
    })
}

/// The first obstacle that does not lie in one plane with the joints and the obstacles before it, if that may be the error.
fn first_apart(error: &CurveError, curve: &Curve<'_>, options: &curve::Options) -> Option<usize> {
    if !matches!(error, CurveError::ObstaclesNotPossible | CurveError::NotPlanar) {
        return None;
    }
    let counts: Vec<usize> = (0..=curve.obstacles.len()).collect();
    let possible = counts.partition_point(|&count| {
        let some = curve.with_obstacles(&curve.obstacles[..count]);
        curve::workspace_len(&some, options) != Err(*error)
    });
    possible.checked_sub(1)
}

impl Solution {
    /// What the kernel found: the elements that the report counts.
    fn new(specification: &Specification, options: &Options, report: &Report, elements: &[Element]) -> Self {
        let elements = elements[..report.elements].to_vec();
        // A curve that stops somewhere has no curvature there: a matter of its status, not of the input.
        let range = measure::curvature_range(&elements);
        let [least, largest] = range.map_or([f64::NAN; 2], |range| range.map(|place| place.signed_curvature));
        Self {
            status: match report.status {
                Status::Converged if range.is_err() => Status::Stalled,
                status => status,
            },
            iterations: report.iterations,
            linearisations: report.linearisations,
            functional: options.functional,
            error: Some(report.error).filter(|error| options.has_tolerance() && error.is_finite()),
            value: report.value,
            fine_value: report.fine_value,
            length: report.length,
            variation: report.variation,
            bending: report.bending,
            gradient: report.gradient,
            curvature_min: least,
            curvature_max: largest,
            starts: spans::starts(specification, &elements, options),
            elements,
        }
    }
}

fn quantity(given: &Given) -> Quantity {
    match *given {
        Given::Free => Quantity::FREE,
        Given::Initial(value) => Quantity::initial(value),
        Given::Fixed(value) => Quantity::fixed(value),
        Given::Size(value) => Quantity::of_size(value),
        Given::OnLine(value, _) => Quantity { given: curve::Given::ON_LINE, value },
        Given::OnPlane(value, _) => Quantity { given: curve::Given::ON_PLANE, value },
    }
}

fn joint(named: &NamedJoint) -> Joint {
    Joint {
        continuity: match named.continuity {
            Continuity::G0 => curve::Continuity::G0,
            Continuity::G1 => curve::Continuity::G1,
            Continuity::G2 => curve::Continuity::G2,
        },
        position: quantity(&named.position),
        tangent: [quantity(&named.tangent[0]), quantity(&named.tangent[1])],
        curvature: [quantity(&named.curvature[0]), quantity(&named.curvature[1])],
        guide: match named.position {
            Given::OnLine(_, guide) | Given::OnPlane(_, guide) => guide,
            _ => [0.0; 3],
        },
    }
}

impl Error {
    /// The kernel's error with the joints' and options' names as the user wrote them. `apart`: the obstacle that does
    /// not lie in the joints' plane.
    fn of(error: CurveError, specification: &Specification, options: &Options, apart: Option<usize>) -> Self {
        let joint = match error {
            CurveError::NotFinite { joint, .. }
            | CurveError::UnknownCode { joint, .. }
            | CurveError::CoincidentJoints { joint, .. }
            | CurveError::ZeroTangent { joint }
            | CurveError::ZeroGuide { joint }
            | CurveError::CurvatureNotPerpendicular { joint }
            | CurveError::CurvatureNeedsTangent { joint }
            | CurveError::SidesDiffer { joint, .. } => Some(joint),
            _ => None,
        };
        let obstacle = match error {
            CurveError::BadObstacle { obstacle } => Some(obstacle),
            _ => apart,
        };
        let name = |joint: usize| specification.joints.get(joint).map_or("?", |named| named.name.as_str());
        let reference = options.reference.as_ref().map_or("?", |shape| shape.name.as_str());
        let never = [
            (options.has_tolerance(), "--tolerance"),
            (options.length > 0.0, "--length"),
            (options.reference.is_some(), "--reference"),
            (options.dimension == 3, "--dimension 3"),
        ];
        let never = never.into_iter().find_map(|(given, option)| given.then_some(option));
        let message = match error {
            CurveError::CoincidentJoints { joint, next } => {
                format!(
                    "joints {} and {} are at the same point; give each point once",
                    name(joint),
                    name(next)
                )
            }
            CurveError::BadOption(option) => {
                let sentence = error.to_string();
                let rule = sentence.split_once(": ").map_or(sentence.as_str(), |(_, rule)| rule);
                format!("{}: {rule}", flag(option))
            }
            CurveError::LengthTooShort => {
                format!("--length {}: {error}", options.length)
            }
            CurveError::WrongElementCount { needed, given } => {
                format!(
                    "--reference {reference}: it has {given} elements and this curve {needed}; compute both with the same \
                     joints and --elements-per-span"
                )
            }
            CurveError::BadElement { element } => format!(
                "--reference {reference}: element {element} has a number that is not finite, or no direction at an end"
            ),
            CurveError::BadObstacle { obstacle } => {
                error.to_string().replace(&format!("obstacle {obstacle}"), "this obstacle")
            }
            CurveError::ObstaclesNotPossible | CurveError::NotPlanar if apart.is_some() => match never {
                Some(option) => format!("obstacles cannot be combined with {option}"),
                None => "this obstacle does not lie in one plane with the joints: only a planar curve keeps clear of \
                         obstacles"
                    .to_owned(),
            },
            other => match joint {
                Some(joint) => {
                    other.to_string().replace(&format!("joint {joint}"), &format!("joint {}", name(joint)))
                }
                None => other.to_string(),
            },
        };
        let joint = joint.and_then(|joint| specification.joints.get(joint));
        let obstacle = obstacle.and_then(|obstacle| specification.obstacles.get(obstacle));
        let place = joint
            .map(|joint| [joint.line, joint.column])
            .or(obstacle.map(|obstacle| [obstacle.line, obstacle.column]));
        Self { message, place }
    }
}

/// The command's name of a kernel's option.
fn flag(option: OptionName) -> &'static str {
    match option {
        OptionName::Functional => "--functional",
        OptionName::ElementsPerSpan => "--elements-per-span",
        OptionName::QuadraturePoints => "quadrature points",
        OptionName::Dimension => "--dimension",
        OptionName::Continuation => "--continuation",
        OptionName::RelativeDecrease => "relative decrease",
        OptionName::Tension => "--tension",
        OptionName::Bending => "--bending",
        OptionName::Length => "--length",
        OptionName::Tolerance => "--tolerance",
        OptionName::ReferenceWeight => "--reference-weight",
    }
}
