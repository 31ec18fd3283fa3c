//! Figure 4.2: the wicket.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::Sheet;
use super::solved::Solved;
use super::view::View;
use minvar::curve::Functional;

pub(super) fn figure() -> Figure {
    let mvc = Solved::appendix("MVC", "4.2", Functional::MVC, 4);
    let mec = Solved::appendix("MEC", "4.2", Functional::MEC, 4);
    let strokes = vec![Stroke::new(&mvc, "a", 0.3), Stroke::new(&mec, "b", 0.3)];
    let lines = vec![Line::curvature("a", &mvc), Line::curvature("b", &mec)];
    let mut sheet = Sheet::new(
        "4.2  The wicket",
        &[&[
            ("a", "MVC"),
            ("b", "MEC"),
            ("comb", "curvature comb"),
            ("fixed", "point"),
            ("tangent", "tangent"),
        ]],
    );
    sheet.row(400.0, &[("①", &Shape::new(View::Plan, strokes)), ("②", &Plot::new("curvature κ", lines))]);
    Figure {
        number: "4.2",
        title: "The wicket",
        caption: "Two point-tangents. The MVC is the half circle, its curvature constant; the MEC is taller, its \
                  curvature zero at the ends and higher inside. (Curvature is positive to the left: this curve turns \
                  right.)"
            .into(),
        rows: vec![mvc.row(), mec.row()],
        svg: sheet.finish(),
    }
}
