//! Appendix A solved by minvar and by the Ceres reference, side by side.

use crate::appendix::Figure;
use crate::ceres::{self, Continuity, Given, Problem, Rows, Solution, Start};
use minvar::curve::{self, Curve, Element, Options, Quantity, Report};
use minvar::solve::Silent;

/// The sets of Appendix A and the functionals for which they have a minimum with one element a span. The others: an
/// energy with a fixed curvature has none (figs 4.9 ①), the antipodal S and the free figure-8 grow without limit.
pub const SETS: [(&str, ceres::Functional); 17] = {
    use ceres::Functional::{Mec, Mvc};
    [
        ("4.2", Mvc),
        ("4.2", Mec),
        ("4.9-1", Mvc),
        ("4.9-2", Mvc),
        ("4.10-1", Mvc),
        ("4.10-1", Mec),
        ("4.10-2", Mvc),
        ("4.10-2", Mec),
        ("4.11", Mvc),
        ("4.11", Mec),
        ("4.13", Mvc),
        ("4.13", Mec),
        ("4.16", Mvc),
        ("4.16", Mec),
        ("4.21", Mvc),
        ("4.21", Mec),
        ("4.22", Mvc),
    ]
};

/// A figure's joints as the kernel takes them.
pub fn kernel_joints(figure: &Figure) -> Vec<curve::Joint> {
    let quantity = |given: &Given| match *given {
        Given::Free => Quantity::FREE,
        Given::Initial(value) => Quantity::initial(value),
        Given::Fixed(value) => Quantity::fixed(value),
    };
    figure
        .joints
        .iter()
        .map(|joint| {
            curve::Joint::at([0.0; 3])
                .with_continuity(match joint.continuity {
                    Continuity::G0 => curve::Continuity::G0,
                    Continuity::G1 => curve::Continuity::G1,
                    Continuity::G2 => curve::Continuity::G2,
                })
                .with_position(quantity(&joint.position))
                .with_tangent(quantity(&joint.tangent))
                .with_curvature(quantity(&joint.curvature))
        })
        .collect()
}

/// A kernel's joint, alike on both sides, as the reference takes it.
pub fn reference_joint(joint: &curve::Joint) -> ceres::Joint {
    let given = |quantity: &Quantity| match quantity.given {
        curve::Given::FREE => Given::Free,
        curve::Given::INITIAL => Given::Initial(quantity.value),
        _ => Given::Fixed(quantity.value),
    };
    ceres::Joint {
        position: given(&joint.position),
        tangent: given(&joint.tangent[0]),
        curvature: given(&joint.curvature[0]),
        continuity: match joint.continuity {
            curve::Continuity::G0 => Continuity::G0,
            curve::Continuity::G1 => Continuity::G1,
            _ => Continuity::G2,
        },
    }
}

/// minvar's solution of a figure.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn ours(
    figure: &Figure,
    functional: ceres::Functional,
    elements_per_span: usize,
) -> (Report, Vec<Element>) {
    let joints = kernel_joints(figure);
    let curve = Curve::new(&joints, figure.closed);
    let options = Options {
        functional: match functional {
            ceres::Functional::Mec => curve::Functional::MEC,
            _ => curve::Functional::MVC,
        },
        elements_per_span: u32::try_from(elements_per_span).expect("few elements"),
        ..Options::DEFAULT
    };
    let len = curve::workspace_len(&curve, &options).expect("the data are good");
    let mut workspace = vec![f64::NAN; len];
    let mut elements = vec![Element::ZERO; curve::elements_len(&curve, &options)];
    let report = curve::solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent)
        .expect("the data are good");
    (report, elements)
}

/// The reference's problem of a figure.
pub fn problem(figure: &Figure, functional: ceres::Functional, elements_per_span: usize) -> Problem<'_> {
    Problem { elements_per_span, ..Problem::new(&figure.joints, figure.closed, figure.planar(), functional) }
}

/// The rows of elements.
pub fn rows(elements: &[Element]) -> Vec<Rows> {
    elements.iter().map(|element| element.rows).collect()
}

/// The reference's solution: thousands of Levenberg–Marquardt iterations of Ceres from the thesis's start, then Newton's
/// method to rounding. Where that runs away to infinity, from the published coefficients.
///
/// # Panics
///
/// If the reference refuses the data, or runs away from both starts.
pub fn reference(figure: &Figure, functional: ceres::Functional, elements_per_span: usize) -> Solution {
    let problem = problem(figure, functional, elements_per_span);
    let options = ceres::Options::default();
    let found = ceres::solve(&problem, Start::Thesis, &options).expect("the data are good");
    if !found.runaway {
        return found;
    }
    let published = figure.published(functional).expect("a published start");
    let found = ceres::solve(&problem, Start::Rows(&published.rows), &options).expect("the data are good");
    assert!(!found.runaway, "the reference runs away from the published coefficients of {}", figure.id);
    found
}
