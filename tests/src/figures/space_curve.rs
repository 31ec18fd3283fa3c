//! Figures 4.16 to 4.18: a simple space curve.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_ranges, same_scale};
use super::solved::Solved;
use super::view::View;
use minvar::curve::Functional;

const KEYS: [(&str, &str); 4] = [("a", "MVC"), ("b", "MEC"), ("fixed", "point"), ("tangent", "tangent")];

fn curves() -> [Solved; 2] {
    [("MVC", Functional::MVC), ("MEC", Functional::MEC)]
        .map(|(name, functional)| Solved::appendix(name, "4.16", functional, 8))
}

pub(super) fn schematic() -> Figure {
    let curves = curves();
    let strokes = |comb| vec![Stroke::new(&curves[0], "a", comb), Stroke::new(&curves[1], "b", comb)];
    let room = Shape::new(View::Room, strokes(0.0));
    let plan = Shape::new(View::Plan, strokes(0.0));
    let front = Shape::new(View::Front, strokes(0.0));
    let mut sheet = Sheet::new("4.16  A simple space curve for comparing MVC with MEC", &[&KEYS]);
    sheet.row(400.0, &[("", &room)]);
    sheet.row(290.0, &[("", &plan), ("", &front)]);
    Figure {
        number: "4.16",
        title: "A simple space curve for comparing MVC with MEC",
        caption: "Three points with their tangents, in a room with shadows on its floor, from above and from the front."
            .into(),
        rows: curves.iter().map(Solved::row).collect(),
        svg: sheet.finish(),
    }
}

pub(super) fn plots() -> Figure {
    let curves = curves();
    let lines = |line: fn(&'static str, &Solved) -> Line| vec![line("a", &curves[0]), line("b", &curves[1])];
    let curvature = Plot::new("curvature κ", lines(Line::curvature));
    let torsion = Plot::new("torsion τ", lines(Line::torsion));
    let mut sheet = Sheet::new("4.17  Space curve: curvature and torsion", &[&KEYS[..2]]);
    sheet.row(330.0, &[("", &curvature.with_joints(&curves[0])), ("", &torsion.with_joints(&curves[0]))]);
    Figure {
        number: "4.17",
        title: "Space curve: curvature and torsion",
        caption: "The curves of 4.16. The MVC's curvature is smoother and its largest lower; its torsion is continuous \
                  and goes to zero at the ends, the MEC's jumps at the middle joint. (Torsion is positive for a \
                  right-handed helix, the opposite of the thesis's (2.8).)"
            .into(),
        rows: curves.iter().map(Solved::row).collect(),
        svg: sheet.finish(),
    }
}

pub(super) fn profiles() -> Figure {
    let curves = curves();
    let shape = |i: usize, class| Shape::new(View::Room, vec![Stroke::new(&curves[i], class, 0.5)]);
    let (mut left, mut right) = (shape(0, "a"), shape(1, "b"));
    same_scale(&mut [&mut left, &mut right]);
    let plot = |i: usize, class| {
        Plot::new("curvature κ", vec![Line::curvature(class, &curves[i])]).with_joints(&curves[i])
    };
    let (mut below_left, mut below_right) = (plot(0, "a"), plot(1, "b"));
    same_ranges(&mut [&mut below_left, &mut below_right]);
    let mut sheet = Sheet::new("4.18  Curvature profiles of the simple space curve", &[&KEYS]);
    sheet.row(360.0, &[("", &left), ("", &right)]);
    sheet.row(200.0, &[("", &below_left), ("", &below_right)]);
    Figure {
        number: "4.18",
        title: "Curvature profiles of the simple space curve",
        caption: "Normals scaled by the curvature, on the outside of the bend, at one scale. The MEC's profile has a \
                  corner at the middle joint, where its torsion jumps."
            .into(),
        rows: curves.iter().map(Solved::row).collect(),
        svg: sheet.finish(),
    }
}
