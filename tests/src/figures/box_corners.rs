//! Figure 4.10: the corners of a box.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_ranges, same_scale};
use super::solved::Solved;
use super::view::View;
use minvar::curve::Functional;

pub(super) fn figure() -> Figure {
    let smooth = Solved::appendix("① G2", "4.10-1", Functional::MVC, 4);
    let round = Solved::appendix("② G1", "4.10-2", Functional::MVC, 4);
    let shape = |curve| Shape::new(View::Plan, vec![Stroke::new(curve, "a", 0.45)]);
    let (mut left, mut right) = (shape(&smooth), shape(&round));
    same_scale(&mut [&mut left, &mut right]);
    let plot = |curve| Plot::new("curvature κ", vec![Line::curvature("a", curve)]).with_joints(curve);
    let (mut below_left, mut below_right) = (plot(&smooth), plot(&round));
    same_ranges(&mut [&mut below_left, &mut below_right]);
    let mut sheet = Sheet::new(
        "4.10  Blending the corners of a box",
        &[&[
            ("a", "MVC"),
            ("comb", "curvature comb, one scale"),
            ("fixed", "point"),
            ("tangent", "tangent"),
            ("ring", "curvature 0"),
        ]],
    );
    sheet.row(420.0, &[("①", &left), ("②", &right)]);
    sheet.row(220.0, &[("①", &below_left), ("②", &below_right)]);
    Figure {
        number: "4.10",
        title: "Blending the corners of a box",
        caption: "① Positions, tangents and zero curvatures: the curvature is continuous, zero along the sides, about \
                  1.46 at the corners. ② Positions, tangents and curvature discontinuities (G1 joints): circular \
                  blends."
            .into(),
        rows: vec![smooth.row(), round.row()],
        svg: sheet.finish(),
    }
}
