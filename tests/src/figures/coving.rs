//! Figure 4.22: the coving, in inches.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::Sheet;
use super::solved::{Solved, significant};
use super::view::{Vector, View};
use crate::appendix;
use crate::compare::kernel_joints;
use minvar::curve::{Curve, Obstacle, Options, Quantity, Side, measure};

/// The duct's free corner.
const CORNER: Vector = [6.0, -6.0, 0.0];

/// The coving with another curvature at the wall, and what it keeps clear of.
fn solved(name: &str, curvature: Quantity, obstacles: &[Obstacle]) -> Solved {
    let mut joints = kernel_joints(&appendix::figure("4.22"));
    joints[0] = joints[0].with_curvature(curvature);
    let curve = Curve::open(&joints).with_obstacles(obstacles);
    Solved::of(name, &curve, &Options { elements_per_span: 8, ..Options::DEFAULT })
}

/// How far outside the duct the curve passes its corner; negative inside.
fn clearance(curve: &Solved) -> f64 {
    let place = measure::closest(&curve.elements, CORNER).expect("a fair curve has no cusp");
    let off: Vector = std::array::from_fn(|d| place.point[d] - CORNER[d]);
    // The duct lies to the left of the curve.
    off[0] * place.tangent[1] - off[1] * place.tangent[0]
}

pub(super) fn figure() -> Figure {
    let face = |from, to| Obstacle::segment(from, to, 0.25, Side::LEFT);
    let duct = [face([0.0, CORNER[1], 0.0], CORNER), face(CORNER, [CORNER[0], 0.0, 0.0])];
    let curves = [
        (solved("① curvature free", Quantity::FREE, &[]), "c"),
        (solved("② 0.27, as published", Quantity::fixed([0.27, 0.0, 0.0]), &[]), "b"),
        (solved("③ clear of the duct", Quantity::FREE, &duct), "a"),
    ];
    let strokes =
        curves.iter().map(|(curve, class)| Stroke::new(curve, class, if *class == "a" { 3.0 } else { 0.0 }));
    let mut shape = Shape::new(View::Plan, strokes.collect());
    shape.marked = Some(&curves[2].0);
    let rectangle =
        |x0: f64, y0: f64, x1: f64, y1: f64| vec![[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]];
    shape.solids = vec![
        rectangle(-0.8, 0.8, 0.0, -13.0),
        rectangle(-0.8, 0.8, 21.0, 0.0),
        rectangle(0.0, 0.0, CORNER[0], CORNER[1]),
    ];
    let plot =
        Plot::new("curvature κ", curves.iter().map(|(curve, class)| Line::curvature(class, curve)).collect());
    let mut sheet = Sheet::new(
        "4.22  Coving design",
        &[
            &[
                ("c", "① curvature at the wall free"),
                ("b", "② 0.27"),
                ("a", "③ clear of the duct, with comb"),
            ],
            &[
                ("fixed", "point"),
                ("tangent", "tangent"),
                ("solid", "wall, ceiling and duct of 6 by 6 inches"),
            ],
        ],
    );
    sheet.row(540.0, &[("", &shape)]);
    sheet.row(240.0, &[("", &plot)]);
    let clear = |i: usize| significant(clearance(&curves[i].0), 3);
    Figure {
        number: "4.22",
        title: "Coving design",
        caption: format!(
            "A coving that blends wall and ceiling and hides a heating duct; in inches. The designer of 1992 raised the \
             curvature at the wall until the coving cleared the duct: ② is the published one. ③ has the faces of a square duct \
             as obstacles, at a quarter of an inch, and finds the curvature: `c_examples/01_coving.c`. The corner of that duct \
             lies at ① {}, ② {} and ③ {} inches (negative: cut off).",
            clear(0),
            clear(1),
            clear(2)
        ),
        rows: curves.iter().map(|(curve, _)| curve.row()).collect(),
        svg: sheet.finish(),
    }
}
