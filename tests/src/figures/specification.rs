//! Figure 4.1: curves by constraints. The thesis prints no data; these are of its kinds.

use super::Figure;
use super::shape::{Shape, Stroke};
use super::sheet::Sheet;
use super::solved::Solved;
use super::view::View;
use minvar::curve::{Continuity, Curve, Joint, Options, Quantity};

fn solved(name: &str, joints: &[Joint]) -> Solved {
    let options = Options { elements_per_span: 4, ..Options::DEFAULT };
    Solved::of(name, &Curve::open(joints), &options)
}

pub(super) fn figure() -> Figure {
    let at = |x: f64, y: f64| Joint::at([x, y, 0.0]);
    let towards = |joint: Joint, x: f64, y: f64| joint.with_tangent(Quantity::fixed([x, y, 0.0]));
    let points = solved("① three points", &[at(-1.0, 0.0), at(-0.4, 0.9), at(1.2, 0.6)]);
    let tangent = solved("② a point-tangent and a point", &[towards(at(-1.0, 0.0), 0.2, 1.0), at(1.0, 0.4)]);
    let curvature = solved(
        "③ a point-tangent and a point-curvature",
        &[towards(at(-1.0, 0.0), 0.2, 1.0), at(1.0, 0.4).with_curvature(Quantity::fixed([-1.2, -0.5, 0.0]))],
    );
    let jump = solved(
        "④ a curvature discontinuity",
        &[
            towards(at(-1.2, 0.0), 0.0, 1.0),
            towards(at(-0.4, 0.8), 1.0, 0.0).with_continuity(Continuity::G1),
            towards(at(1.2, -0.8), 0.0, -1.0),
        ],
    );
    let curves = [points, tangent, curvature, jump];
    let mut shapes =
        curves.each_ref().map(|curve| Shape::new(View::Plan, vec![Stroke::new(curve, "a", 0.22)]));
    {
        let [a, b, c, d] = &mut shapes;
        super::sheet::same_scale(&mut [a, b, c, d]);
    }
    let [a, b, c, d] = &shapes;
    let mut sheet = Sheet::new(
        "4.1  Specification through geometric constraints",
        &[&[
            ("a", "MVC"),
            ("comb", "curvature comb"),
            ("fixed", "point"),
            ("tangent", "tangent"),
            ("ring", "curvature"),
        ]],
    );
    sheet.row(330.0, &[("①", a), ("②", b)]);
    sheet.row(330.0, &[("③", c), ("④", d)]);
    Figure {
        number: "4.1",
        title: "Specification through geometric constraints",
        caption: "① Three points give a circular arc, and so do ② a point and a point-tangent. ③ A curvature at the \
                  end adds control: the curve tightens smoothly towards it. ④ A curvature \
                  discontinuity (a G1 joint) lets two circular pieces of different radii meet. The thesis prints no \
                  data for this figure; these are of its four kinds."
            .into(),
        rows: curves.iter().map(Solved::row).collect(),
        svg: sheet.finish(),
    }
}
