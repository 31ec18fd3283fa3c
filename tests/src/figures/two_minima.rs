//! Figure 4.9: two curves of one specification.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_ranges, same_scale};
use super::solved::Solved;
use super::view::View;
use minvar::curve::Functional;

pub(super) fn figure() -> Figure {
    let looped = Solved::appendix("① with the loop", "4.9-1", Functional::MVC, 8);
    let plain = Solved::appendix("② without", "4.9-2", Functional::MVC, 8);
    let shape = |curve| Shape::new(View::Plan, vec![Stroke::new(curve, "a", 0.03)]);
    let (mut left, mut right) = (shape(&looped), shape(&plain));
    same_scale(&mut [&mut left, &mut right]);
    let plot = |curve| Plot::new("curvature κ", vec![Line::curvature("a", curve)]).with_joints(curve);
    let (mut below_left, mut below_right) = (plot(&looped), plot(&plain));
    same_ranges(&mut [&mut below_left, &mut below_right]);
    let mut sheet = Sheet::new(
        "4.9  Multiple MVCs from one specification",
        &[&[
            ("a", "MVC"),
            ("comb", "curvature comb, one scale"),
            ("fixed", "point"),
            ("ring", "point and curvature 10"),
        ]],
    );
    sheet.row(300.0, &[("①", &left), ("②", &right)]);
    sheet.row(230.0, &[("①", &below_left), ("②", &below_right)]);
    Figure {
        number: "4.9",
        title: "Multiple MVCs from one specification",
        caption: "Five points, the curvature at the middle one kept at 10. ① From a start with a loop, ② from one \
                  without. The curve without the loop is shorter and probably the desired one, but has the larger \
                  variation; both spread the high curvature at the middle."
            .into(),
        rows: vec![looped.row(), plain.row()],
        svg: sheet.finish(),
    }
}
