//! Figures 4.13 and 4.14: S-shaped curves.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_scale};
use super::solved::{Solved, significant};
use super::view::View;
use minvar::curve::Functional;

pub(super) fn s_shaped() -> Figure {
    let mvc = Solved::appendix("MVC", "4.13", Functional::MVC, 4);
    let si = Solved::appendix("SI-MVC", "4.13", Functional::SI_MVC, 4);
    let curves = [(&mvc, "a"), (&si, "b")];
    let both = Shape::new(View::Plan, curves.map(|(curve, class)| Stroke::new(curve, class, 0.0)).to_vec());
    let plot = Plot::new("curvature κ", curves.map(|(curve, class)| Line::curvature(class, curve)).to_vec());
    let mut combs =
        curves.map(|(curve, class)| Shape::new(View::Plan, vec![Stroke::new(curve, class, 0.35)]));
    {
        let [a, b] = &mut combs;
        same_scale(&mut [a, b]);
    }
    let mut sheet = Sheet::new(
        "4.13  Planar S-shaped curves, MVC vs. SI-MVC",
        &[&[
            ("a", "MVC"),
            ("b", "SI-MVC"),
            ("comb", "curvature comb, one scale"),
            ("fixed", "point"),
            ("tangent", "tangent"),
        ]],
    );
    sheet.row(300.0, &[("①", &both), ("②", &plot)]);
    sheet.row(300.0, &[("", &combs[0]), ("", &combs[1])]);
    Figure {
        number: "4.13",
        title: "Planar S-shaped curves, MVC vs. SI-MVC",
        caption: "Positions and tangents at the ends and the point between. ① The SI-MVC is tighter and shorter, ② its \
                  curvature more nearly linear; that of the MVC is level at the ends."
            .into(),
        rows: curves.map(|(curve, _)| curve.row()).to_vec(),
        svg: sheet.finish(),
    }
}

pub(super) fn antipodal() -> Figure {
    let si = Solved::appendix("SI-MVC", "4.14", Functional::SI_MVC, 8);
    let mvc = Solved::appendix("MVC (not drawn)", "4.14", Functional::MVC, 1);
    let report = mvc.report.expect("a report");
    let shape = Shape::new(View::Plan, vec![Stroke::new(&si, "b", 0.4)]);
    let plot = Plot::new("curvature κ", vec![Line::curvature("b", &si)]).with_joints(&si);
    let mut sheet = Sheet::new(
        "4.14  A curve from antipodal tangent constraints",
        &[&[("b", "SI-MVC and curvature comb"), ("fixed", "point"), ("tangent", "tangent")]],
    );
    sheet.row(380.0, &[("①", &shape), ("②", &plot)]);
    Figure {
        number: "4.14",
        title: "A curve from antipodal tangent constraints",
        caption: format!(
            "① The SI-MVC and ② its curvature. The MVC expands to infinity: the solver's status is *{}* (“{}”), when the \
             curve is {} long and V has sunk to {}.",
            report.status.name(),
            report.status.sentence(),
            significant(report.length, 3),
            significant(report.variation, 2),
        ),
        rows: vec![si.row(), mvc.row()],
        svg: sheet.finish(),
    }
}
