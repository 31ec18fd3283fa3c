//! Figures 4.11 and 4.12: Woodford's points.

use super::Figure;
use super::natural_spline;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_ranges, same_scale};
use super::solved::Solved;
use super::view::View;
use minvar::curve::Functional;

pub(super) fn comparison() -> Figure {
    let mvc = Solved::appendix("③ MVC", "4.11", Functional::MVC, 4);
    let mec = Solved::appendix("② MEC", "4.11", Functional::MEC, 4);
    let points: Vec<_> = mvc.joints.iter().map(|joint| joint.position.value).collect();
    let natural = Solved::given("① natural spline", mvc.joints.clone(), natural_spline::through(&points));
    let curves = [(&natural, "c"), (&mec, "b"), (&mvc, "a")];
    let mut shapes =
        curves.map(|(curve, class)| Shape::new(View::Plan, vec![Stroke::new(curve, class, 0.7)]));
    {
        let [a, b, c] = &mut shapes;
        same_scale(&mut [a, b, c]);
    }
    let mut plots = curves.map(|(curve, class)| {
        Plot::new("curvature κ", vec![Line::curvature(class, curve)]).with_joints(curve)
    });
    {
        let [a, b, c] = &mut plots;
        same_ranges(&mut [a, b, c]);
    }
    let all = Shape::new(View::Plan, curves.map(|(curve, class)| Stroke::new(curve, class, 0.0)).to_vec());
    let lines = curves.map(|(curve, class)| Line::curvature(class, curve));
    let together = Plot::new("curvature κ", lines.to_vec());
    let mut sheet = Sheet::new(
        "4.11  MVC vs. MEC and natural spline",
        &[&[
            ("c", "① natural spline"),
            ("b", "② MEC"),
            ("a", "③ MVC"),
            ("comb", "curvature comb"),
            ("fixed", "point"),
        ]],
    );
    sheet.row(310.0, &[("", &all), ("", &together)]);
    sheet.row(245.0, &[("①", &shapes[0]), ("②", &shapes[1]), ("③", &shapes[2])]);
    sheet.row(215.0, &[("①", &plots[0]), ("②", &plots[1]), ("③", &plots[2])]);
    Figure {
        number: "4.11",
        title: "MVC vs. MEC and natural spline",
        caption: "Woodford's seven points. The curves are nearly the same to the eye; their curvatures are not. ① The \
                  natural cubic spline (equal parameter intervals) has peaks at several points and zero curvature at \
                  the ends, ② the MEC is smoother, with corners at the points and zero curvature at the ends, ③ the MVC \
                  is free of peaks and corners, its curvature level at the ends and its largest the lowest of the \
                  three."
            .into(),
        rows: curves.map(|(curve, _)| curve.row()).to_vec(),
        svg: sheet.finish(),
    }
}

pub(super) fn scale_invariant() -> Figure {
    let mvc = Solved::appendix("① MVC", "4.11", Functional::MVC, 4);
    let si = Solved::appendix("② SI-MVC", "4.11", Functional::SI_MVC, 4);
    let curves = [(&mvc, "a"), (&si, "b")];
    let plot = Plot::new("curvature κ", curves.map(|(curve, class)| Line::curvature(class, curve)).to_vec());
    let mut sheet = Sheet::new(
        "4.12  Curvature plot: MVC and scale-invariant MVC",
        &[&[("a", "① MVC"), ("b", "② SI-MVC")]],
    );
    sheet.row(330.0, &[("", &plot.with_joints(&mvc))]);
    Figure {
        number: "4.12",
        title: "Curvature plot: MVC and scale-invariant MVC",
        caption: "The same points. Where the curvature varies little the two are hardly to be told apart. (The thesis \
                  took 137 and 3921 iterations; see the table.)"
            .into(),
        rows: curves.map(|(curve, _)| curve.row()).to_vec(),
        svg: sheet.finish(),
    }
}
