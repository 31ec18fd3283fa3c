//! Thesis Appendix A: the test curves and their published coefficients (`data/appendix_a.json`).

use crate::ceres::{Continuity, Functional, Given, Joint, Rows};
use serde::Deserialize;
use std::collections::BTreeMap;

/// One test curve.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The figure and its part, `4.10-2`.
    pub id: String,
    /// The figure's title.
    pub title: String,
    /// The joints in the order of the curve, with the repairs of the scanned listing (Fig. 4.13) applied.
    pub joints: Vec<Joint>,
    /// Whether the curve is closed.
    pub closed: bool,
    /// 2 in the plane z = 0, 3 in space.
    pub dimension: usize,
    /// What the thesis printed, if anything.
    pub solutions: Vec<Published>,
    /// Remarks on the listing.
    pub notes: Vec<String>,
}

/// A published solution.
#[derive(Clone, Debug)]
pub struct Published {
    /// The thesis's name for it.
    pub label: String,
    /// What was minimised.
    pub functional: Functional,
    /// Its elements in order.
    pub rows: Vec<Rows>,
    /// Elements a span.
    pub elements_per_span: usize,
    /// How many numbers have too few digits, so that one was lost in print or scan.
    pub suspect_digits: usize,
}

impl Figure {
    /// Whether the curve lies in the plane z = 0.
    pub fn planar(&self) -> bool {
        self.dimension == 2
    }

    /// The published solution for a functional.
    pub fn published(&self, functional: Functional) -> Option<&Published> {
        self.solutions.iter().find(|s| s.functional == functional)
    }
}

/// All figures of Appendix A, in its order.
///
/// # Panics
///
/// If the data file, which is part of this crate, is not what it should be.
pub fn figures() -> Vec<Figure> {
    let file: RawFile = serde_json::from_str(include_str!("../data/appendix_a.json"))
        .expect("appendix_a.json is well formed");
    file.figures.into_iter().map(Figure::from).collect()
}

/// The figure of an id such as `4.11` or `4.10-1`.
///
/// # Panics
///
/// If there is none.
pub fn figure(id: &str) -> Figure {
    figures().into_iter().find(|f| f.id == id).unwrap_or_else(|| panic!("Appendix A has no figure {id}"))
}

#[derive(Deserialize)]
struct RawFile {
    figures: Vec<RawFigure>,
}

#[derive(Deserialize)]
struct RawFigure {
    id: String,
    title: String,
    joints: Vec<RawJoint>,
    curve: RawCurve,
    dimension: usize,
    solutions: Vec<RawSolution>,
    notes: Vec<String>,
    effective_overrides: BTreeMap<String, RawOverride>,
}

#[derive(Deserialize)]
struct RawCurve {
    closure: Closure,
    order: Vec<String>,
}

#[derive(Deserialize, PartialEq)]
enum Closure {
    Open,
    Closed,
}

#[derive(Clone, Deserialize)]
struct RawJoint {
    name: String,
    kind: Kind,
    position: RawGiven,
    tangent: Option<RawGiven>,
    curvature: Option<RawGiven>,
}

#[derive(Clone, Copy, Deserialize)]
enum Kind {
    G0,
    G1,
    G2,
}

#[derive(Clone, Copy, Deserialize)]
struct RawGiven {
    status: Status,
    value: [f64; 3],
}

#[derive(Clone, Copy, Deserialize)]
enum Status {
    Initial,
    Fixed,
}

/// Replaces what it names and leaves the rest.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawOverride {
    position: Option<RawGiven>,
    tangent: Option<RawGiven>,
    curvature: Option<RawGiven>,
}

#[derive(Deserialize)]
struct RawSolution {
    label: String,
    functional: RawFunctional,
    elements: Vec<Rows>,
    elements_per_span: usize,
    suspect_digits: Vec<serde_json::Value>,
}

#[derive(Deserialize)]
enum RawFunctional {
    #[serde(rename = "MVC")]
    Mvc,
    #[serde(rename = "MEC")]
    Mec,
    #[serde(rename = "SI-MVC")]
    SiMvc,
}

impl From<RawFigure> for Figure {
    fn from(raw: RawFigure) -> Self {
        let joints = raw.curve.order.iter().map(|name| {
            let mut joint = raw
                .joints
                .iter()
                .find(|j| j.name == *name)
                .unwrap_or_else(|| panic!("figure {}: the curve names no joint {name}", raw.id))
                .clone();
            if let Some(repair) = raw.effective_overrides.get(name) {
                joint.position = repair.position.unwrap_or(joint.position);
                joint.tangent = repair.tangent.or(joint.tangent);
                joint.curvature = repair.curvature.or(joint.curvature);
            }
            Joint::from(joint)
        });
        Self {
            joints: joints.collect(),
            closed: raw.curve.closure == Closure::Closed,
            solutions: raw.solutions.into_iter().map(Published::from).collect(),
            id: raw.id,
            title: raw.title,
            dimension: raw.dimension,
            notes: raw.notes,
        }
    }
}

impl From<RawJoint> for Joint {
    fn from(raw: RawJoint) -> Self {
        let given = |g: Option<RawGiven>| match g {
            None => Given::Free,
            Some(RawGiven { status: Status::Initial, value }) => Given::Initial(value),
            Some(RawGiven { status: Status::Fixed, value }) => Given::Fixed(value),
        };
        Self {
            position: given(Some(raw.position)),
            tangent: given(raw.tangent),
            curvature: given(raw.curvature),
            continuity: match raw.kind {
                Kind::G0 => Continuity::G0,
                Kind::G1 => Continuity::G1,
                Kind::G2 => Continuity::G2,
            },
        }
    }
}

impl From<RawSolution> for Published {
    fn from(raw: RawSolution) -> Self {
        Self {
            label: raw.label,
            functional: match raw.functional {
                RawFunctional::Mvc => Functional::Mvc,
                RawFunctional::Mec => Functional::Mec,
                RawFunctional::SiMvc => Functional::SiMvc,
            },
            rows: raw.elements,
            elements_per_span: raw.elements_per_span,
            suspect_digits: raw.suspect_digits.len(),
        }
    }
}
