//! Figures 4.19 to 4.21: Peters' helical data.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::Sheet;
use super::solved::Solved;
use super::view::View;
use crate::appendix;
use crate::ceres;
use crate::compare::kernel_joints;
use minvar::curve::{Element, Functional};

/// Room, plan, curvature and torsion of a curve, at the same scales as its companions'.
fn sheet(title: &str, curve: &Solved, all: &[Solved; 3]) -> String {
    let limits = |line: fn(&'static str, &Solved) -> Line, of: &[Solved]| {
        Plot::new("", of.iter().map(|curve| line("a", curve)).collect()).ranges()
    };
    let drawn = |up, line: fn(&'static str, &Solved) -> Line, [along, range]: [[f64; 2]; 2]| {
        let mut plot = Plot::new(up, vec![line("a", curve)]).with_joints(curve);
        (plot.along_range, plot.up_range) = (Some(along), Some(range));
        plot
    };
    let curvature = drawn("curvature κ", Line::curvature, limits(Line::curvature, all));
    // The start's torsion jumps far off: the solved curves set the scale.
    let torsion = drawn("torsion τ", Line::torsion, limits(Line::torsion, &all[1..]));
    let room = Shape::new(View::Room, vec![Stroke::new(curve, "a", 4.0)]);
    let front = Shape::new(View::Front, vec![Stroke::new(curve, "a", 0.0)]);
    let keys = [("a", "curve"), ("comb", "curvature comb"), ("fixed", "point")];
    let mut sheet = Sheet::new(title, &[&keys]);
    sheet.row(450.0, &[("", &room), ("", &front)]);
    sheet.row(230.0, &[("", &curvature), ("", &torsion)]);
    sheet.finish()
}

fn start() -> Solved {
    let figure = appendix::figure("4.21");
    let problem = ceres::Problem::new(&figure.joints, figure.closed, figure.planar(), ceres::Functional::Mvc);
    let rows = ceres::start(&problem).expect("the data are good");
    let elements = rows.into_iter().map(|rows| Element { rows }).collect();
    Solved::given("start", kernel_joints(&figure), elements)
}

pub(super) fn figures() -> Vec<Figure> {
    let mvc = Solved::appendix("MVC", "4.21", Functional::MVC, 4);
    let mec = Solved::appendix("MEC", "4.21", Functional::MEC, 4);
    let all = [start(), mec, mvc];
    let texts = [
        (
            "4.19",
            "Peters' helical data: the initial curve",
            "The start by the rules of thesis 4.9 (one element a span): curvature and torsion uneven (the torsion runs off \
             the scale of the solved curves).",
        ),
        (
            "4.20",
            "Peters' helix: the MEC",
            "Zero curvature at the ends, and the derivative of the curvature jumps a little at each point.",
        ),
        (
            "4.21",
            "Peters' helix: the MVC",
            "Curvature and torsion of nearly constant size but for the middle, where the data pass from one \
             helix to another and the curve has an inflection.",
        ),
    ];
    let figure = |(curve, (number, title, caption)): (&Solved, (&'static str, &'static str, &str))| Figure {
        number,
        title,
        caption: caption.into(),
        rows: vec![curve.row()],
        svg: sheet(&format!("{number}  {title}"), curve, &all),
    };
    all.iter().zip(texts).map(figure).collect()
}
