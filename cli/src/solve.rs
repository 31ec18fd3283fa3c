//! From a specification to a curve: the one place where the command calls the kernel's solver.

mod spans;

use crate::constraints::{Continuity, Given, NamedJoint, Specification};
use minvar::curve::{self, Curve, CurveError, Element, Joint, OptionName, Quantity, Reference, measure};
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
}

impl Functional {
    /// The name in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Mvc => "mvc",
            Self::Mec => "mec",
            Self::SiMvc => "si-mvc",
            Self::SiMec => "si-mec",
        }
    }

    /// The name and formula in pictures.
    pub(crate) fn formula(self) -> &'static str {
        match self {
            Self::Mvc => "MVC  ∫ (dκ/ds)² ds",
            Self::Mec => "MEC  ∫ κ² ds",
            Self::SiMvc => "SI-MVC  L³ ∫ (dκ/ds)² ds",
            Self::SiMec => "SI-MEC  L ∫ κ² ds",
        }
    }

    /// The functional of the same kind that does not change with the size, if this one does.
    pub(crate) fn scale_invariant(self) -> Option<Self> {
        match self {
            Self::Mvc => Some(Self::SiMvc),
            Self::Mec => Some(Self::SiMec),
            Self::SiMvc | Self::SiMec => None,
        }
    }

    /// The power of the length by which a value shrinks when the shape grows.
    pub(crate) fn scale_power(self) -> i32 {
        match self {
            Self::Mvc => 3,
            Self::Mec => 1,
            Self::SiMvc | Self::SiMec => 0,
        }
    }

    fn code(self) -> curve::Functional {
        match self {
            Self::Mvc => curve::Functional::MVC,
            Self::Mec => curve::Functional::MEC,
            Self::SiMvc => curve::Functional::SI_MVC,
            Self::SiMec => curve::Functional::SI_MEC,
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
    /// The index of the joint in the specification that it is about.
    pub(crate) joint: Option<usize>,
}

/// Computes the curve.
pub(crate) fn solve(specification: &Specification, options: &Options) -> Result<Solution, Error> {
    let joints: Vec<Joint> = specification.joints.iter().map(joint).collect();
    let mut curve = Curve::new(&joints, specification.closed);
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
    let wrong = |error: CurveError| Error::of(error, specification, options);
    let mut workspace = vec![0.0; curve::workspace_len(&curve, &kernel_options).map_err(wrong)?];
    let mut elements = vec![Element::ZERO; curve::elements_len(&curve, &kernel_options)];
    let report = curve::solve(&curve, &kernel_options, &mut workspace, &mut elements, &mut [], &mut Silent)
        .map_err(wrong)?;
    elements.truncate(report.elements);
    // A curve that stops somewhere has no curvature there: a matter of its status, not of the input.
    let range = measure::curvature_range(&elements);
    let [least, largest] = range.map_or([f64::NAN; 2], |range| range.map(|place| place.signed_curvature));
    let status = match report.status {
        Status::Converged if range.is_err() => Status::Stalled,
        status => status,
    };
    Ok(Solution {
        status,
        iterations: report.iterations,
        linearisations: report.linearisations,
        functional: options.functional,
        // One element a span is never compared with more.
        error: Some(report.error)
            .filter(|error| options.has_tolerance() && options.elements_per_span > 1 && error.is_finite()),
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
    })
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
    /// The kernel's error with the joints' and options' names as the user wrote them.
    fn of(error: CurveError, specification: &Specification, options: &Options) -> Self {
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
        let name = |joint: usize| specification.joints.get(joint).map_or("?", |named| named.name.as_str());
        let reference = options.reference.as_ref().map_or("?", |shape| shape.name.as_str());
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
            other => match joint {
                Some(joint) => {
                    other.to_string().replace(&format!("joint {joint}"), &format!("joint {}", name(joint)))
                }
                None => other.to_string(),
            },
        };
        Self { message, joint }
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
