//! From a specification to a curve: the one place where the command calls the kernel's solver.

use crate::constraints::{Continuity, Given, NamedJoint, Specification};
use minvar::curve::{self, Curve, CurveError, Element, Joint, Quantity, measure};
use minvar::solve::{Silent, Status};

/// What a curve minimises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Functional {
    /// Minimum variation: ∫ (dκ/ds)² ds
    Mvc,
    /// Minimum energy: ∫ κ² ds
    Mec,
}

impl Functional {
    /// The name in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Mvc => "mvc",
            Self::Mec => "mec",
        }
    }
}

/// How to solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Options {
    /// What is minimised.
    pub(crate) functional: Functional,
    /// Elements between two joints.
    pub(crate) elements_per_span: u32,
    /// The largest number of iterations.
    pub(crate) max_iterations: u32,
    /// 2, 3, or 0 to find out.
    pub(crate) dimension: u32,
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
    /// The elements in order: the same number for each span, the first span's first.
    pub(crate) elements: Vec<Element>,
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
    let curve = Curve::new(&joints, specification.closed);
    let kernel_options = curve::Options {
        functional: match options.functional {
            Functional::Mvc => curve::Functional::MVC,
            Functional::Mec => curve::Functional::MEC,
        },
        elements_per_span: options.elements_per_span,
        max_iterations: options.max_iterations,
        dimension: options.dimension,
        ..curve::Options::DEFAULT
    };
    let wrong = |error: CurveError| Error::of(error, specification);
    let mut workspace = vec![0.0; curve::workspace_len(&curve, &kernel_options).map_err(wrong)?];
    let mut elements = vec![Element::ZERO; curve::elements_len(&curve, &kernel_options)];
    let report = curve::solve(&curve, &kernel_options, &mut workspace, &mut elements, &mut [], &mut Silent)
        .map_err(wrong)?;
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
        value: report.value,
        fine_value: report.fine_value,
        length: report.length,
        variation: report.variation,
        bending: report.bending,
        gradient: report.gradient,
        curvature_min: least,
        curvature_max: largest,
        elements,
    })
}

fn quantity(given: &Given) -> Quantity {
    match *given {
        Given::Free => Quantity::FREE,
        Given::Initial(value) => Quantity::initial(value),
        Given::Fixed(value) => Quantity::fixed(value),
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
        guide: [0.0; 3],
    }
}

impl Error {
    /// The kernel's error with the joints' names in place of their numbers.
    fn of(error: CurveError, specification: &Specification) -> Self {
        let joint = match error {
            CurveError::NotFinite { joint, .. }
            | CurveError::UnknownCode { joint, .. }
            | CurveError::CoincidentJoints { joint, .. }
            | CurveError::ZeroTangent { joint }
            | CurveError::CurvatureNotPerpendicular { joint }
            | CurveError::CurvatureNeedsTangent { joint }
            | CurveError::SidesDiffer { joint, .. } => Some(joint),
            _ => None,
        };
        let name = |joint: usize| specification.joints.get(joint).map_or("?", |named| named.name.as_str());
        let message = match error {
            CurveError::CoincidentJoints { joint, next } => {
                format!(
                    "joints {} and {} are at the same point; give each point once",
                    name(joint),
                    name(next)
                )
            }
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
