//! Figure 4.15: a figure-8 without any constraint.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::Sheet;
use super::solved::{Solved, significant};
use super::view::View;
use minvar::curve::Functional;

pub(super) fn figure() -> Figure {
    let si = Solved::appendix("SI-MVC", "4.15", Functional::SI_MVC, 4);
    let value = si.report.expect("a report").value;
    let shape = Shape::new(View::Plan, vec![Stroke::new(&si, "b", 0.7)]);
    let plot = Plot::new("curvature κ", vec![Line::curvature("b", &si)]).with_joints(&si);
    let mut sheet = Sheet::new(
        "4.15  An SI-MVC figure-8",
        &[&[("b", "SI-MVC and curvature comb"), ("free", "free joint")]],
    );
    sheet.row(330.0, &[("①", &shape), ("②", &plot)]);
    Figure {
        number: "4.15",
        title: "An SI-MVC figure-8",
        caption: format!(
            "① Started from a rough figure-8, nothing fixed, the curve becomes a lemniscate-like curve; ② its curvature. \
             Size and place are free, so only L³V = {} is of the shape.",
            significant(value, 6)
        ),
        rows: vec![si.row()],
        svg: sheet.finish(),
    }
}
