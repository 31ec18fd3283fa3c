//! Figure 4.3: deformation from a reference shape, and smoothing of it. The thesis prints no data; the reference is a
//! curve with waves.

use super::Figure;
use super::plot::{Line, Plot};
use super::shape::{Shape, Stroke};
use super::sheet::{Sheet, same_ranges, same_scale};
use super::solved::Solved;
use super::view::View;
use minvar::curve::{Curve, Joint, Options, Quantity, Reference};

/// The waves' crests and hollows.
const POINTS: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.95, 0.0],
    [2.0, 1.3, 0.0],
    [3.0, 1.7, 0.0],
    [4.0, 1.3, 0.0],
    [5.0, 0.95, 0.0],
    [6.0, 0.0, 0.0],
];
const MIDDLE: usize = 3;
const LAST: usize = POINTS.len() - 1;

/// The ends' tangents.
const RISING: Quantity = Quantity::fixed([1.0, 1.2, 0.0]);
const FALLING: Quantity = Quantity::fixed([1.0, -1.2, 0.0]);

/// With one element a span: the reference is compared at equal parameters, so that elements whose lengths are free to
/// change would be compared at places of their own choice.
const OPTIONS: Options = Options::DEFAULT;

/// The joints: ends with their tangents, and the others as `inner` makes them.
fn joints(inner: impl Fn(usize) -> Joint) -> [Joint; POINTS.len()] {
    std::array::from_fn(|i| match i {
        0 => Joint::at(POINTS[i]).with_tangent(RISING),
        LAST => Joint::at(POINTS[i]).with_tangent(FALLING),
        i => inner(i),
    })
}

pub(super) fn figure() -> Figure {
    let initial = Solved::of("initial curve", &Curve::open(&joints(|i| Joint::at(POINTS[i]))), &OPTIONS);
    // Between the ends the joints slide up and down: this keeps places to compare, and constrains no shape.
    let bent = |name: &str, middle: Option<[f64; 3]>, weight| {
        let joints = joints(|i| match middle {
            Some(to) if i == MIDDLE => Joint::at(to),
            _ => Joint::at(POINTS[i]).on_line(POINTS[i], [0.0, 1.0, 0.0]),
        });
        let reference = Reference { elements: &initial.elements, weight };
        Solved::of(name, &Curve::open(&joints).with_reference(reference), &OPTIONS)
    };
    let [x, y, _] = POINTS[MIDDLE];
    let drag = |by: f64| Some([x, y + by, 0.0]);
    let up = bent("① dragged up by 0.3", drag(0.3), 1.0);
    let higher = bent("① dragged up by 0.6", drag(0.6), 1.0);
    let weights = [
        ("② α = 1", 1.0, "#440154"),
        ("② α = 0.75", 0.75, "#3b528b"),
        ("② α = 0.5", 0.5, "#21858c"),
        ("② α = 0.25", 0.25, "#2ca25f"),
        ("② α = 0", 0.0, "#d55e00"),
    ];
    let smoothed = weights.map(|(name, weight, _)| bent(name, None, weight));

    let strokes =
        vec![Stroke::new(&up, "a", 0.0), Stroke::new(&higher, "b", 0.0), Stroke::new(&initial, "d", 0.0)];
    let mut deformed = Shape::new(View::Plan, strokes);
    let shade = |(curve, (.., colour)): (_, &(_, _, &str))| Stroke {
        style: format!("stroke:{colour}"),
        ..Stroke::new(curve, "shade", 0.0)
    };
    let mut gradual = Shape::new(View::Plan, smoothed.iter().zip(&weights).map(shade).collect());
    same_scale(&mut [&mut deformed, &mut gradual]);
    let lines =
        vec![Line::curvature("a", &up), Line::curvature("b", &higher), Line::curvature("d", &initial)];
    let mut deformed_plot = Plot::new("curvature κ", lines);
    let lines = smoothed
        .iter()
        .zip(&weights)
        .map(|(curve, (.., colour))| Line::curvature("shade", curve).of_colour(colour));
    let mut gradual_plot = Plot::new("curvature κ", lines.collect());
    same_ranges(&mut [&mut deformed_plot, &mut gradual_plot]);
    let keys: Vec<(&str, &str)> = weights.iter().map(|(name, _, colour)| (*colour, *name)).collect();
    let mut sheet = Sheet::new(
        "4.3  Curve deformation and smoothing",
        &[
            &[
                ("d", "① initial curve"),
                ("a", "dragged by 0.3"),
                ("b", "by 0.6"),
                ("fixed", "fixed"),
                ("free", "slides up and down"),
                ("tangent", "tangent"),
            ],
            &keys,
        ],
    );
    sheet.row(330.0, &[("①", &deformed), ("②", &gradual)]);
    sheet.row(230.0, &[("①", &deformed_plot), ("②", &gradual_plot)]);
    let initial_row = initial.row();
    let rows = [&up, &higher].into_iter().chain(&smoothed).map(Solved::row);
    Figure {
        number: "4.3",
        title: "Curve deformation and smoothing",
        caption: "① A curve is deformed from its reference shape by dragging a point near its middle: its waves \
                  survive, because what is minimised is the change of dκ/ds from the reference's. ② The reference's \
                  weight α sinks from 1 to 0: the curve goes gradually from its initial shape to that of its end \
                  tangents alone, a circular arc. The thesis prints no data for this figure; the initial curve is the \
                  MVC through seven points with two tangents, and the joints between may slide up and down. V in the \
                  table is the curve's own variation, not its difference from the reference."
            .into(),
        rows: [initial_row].into_iter().chain(rows).collect(),
        svg: sheet.finish(),
    }
}
