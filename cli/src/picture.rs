//! A curve as a naval architect likes to see it: the shape with its curvature comb, and below it the curvature against the
//! arc length; of a space curve a view in a room, and the torsion too. The same curve gives the same bytes.

mod joints;
mod obstacles;
mod page;
mod plot;
mod scale;
mod shape;
#[cfg(test)]
mod tests;
mod view;

pub(crate) use scale::figure;

use crate::constraints::{Given, NamedJoint, PlacedObstacle, Specification};
use crate::trace::{STRAIGHT, Trace, Vector};
use minvar::curve::Element;
use page::{Anchor, Page, width};
use view::View;

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a> {
    /// The title: the curve's name.
    pub(crate) title: &'a str,
    /// Lines of figures under the title.
    pub(crate) figures: &'a [String],
    /// The curve, at least one element.
    pub(crate) elements: &'a [Element],
    /// Whether the last element returns to the first.
    pub(crate) closed: bool,
    /// The joints in the curve's order.
    pub(crate) joints: &'a [Mark],
    /// Closed polygons drawn behind the curve.
    pub(crate) polygons: &'a [Vec<Vector>],
    /// What the curve was to keep clear of.
    pub(crate) obstacles: &'a [PlacedObstacle],
}

/// A joint in a picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    /// The label.
    pub(crate) name: String,
    /// The element that begins here; the number of elements at the end of an open curve.
    pub(crate) element: usize,
    /// Whether its position was given.
    pub(crate) fixed: bool,
    /// On what its position slides.
    pub(crate) slide: Option<Slide>,
    /// Whether its tangent was given, arriving and leaving.
    pub(crate) tangent: [bool; 2],
    /// Whether its curvature was given on any side.
    pub(crate) curvature: bool,
}

/// On what a joint slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Slide {
    /// On a line of this direction.
    Line(Vector),
    /// In a plane across this normal.
    Plane(Vector),
}

impl Mark {
    /// The marks of a specification's joints, each with the element that begins there.
    pub(crate) fn of(specification: &Specification, starts: &[usize]) -> Vec<Self> {
        let mark = |(joint, &element): (&NamedJoint, &usize)| Self {
            name: joint.name.clone(),
            element,
            fixed: joint.position.is_fixed(),
            slide: match joint.position {
                Given::OnLine(_, direction) => Some(Slide::Line(direction)),
                Given::OnPlane(_, normal) => Some(Slide::Plane(normal)),
                _ => None,
            },
            tangent: joint.tangent.map(|tangent| tangent.is_fixed()),
            curvature: joint.curvature.iter().any(|given| matches!(given, Given::Fixed(_) | Given::Size(_))),
        };
        specification.joints.iter().zip(starts).map(mark).collect()
    }
}

const WIDTH: f64 = 800.0;
const MARGIN: f64 = 28.0;
const LABEL: f64 = 10.5;

// Okabe and Ito's colours: told apart by every eye, and in grey.
const STYLE: &str = "\
text { font-family: 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif; font-size: 10.5px; fill: #555 }
.title { font-size: 18px; font-weight: 600; fill: #1a1a1a }
.figures { font-size: 12px; fill: #555 }
.caption { font-size: 11.5px; fill: #333 }
.name { font-size: 11.5px; fill: #1a1a1a }
.paper { fill: #fff }
.frame { fill: none; stroke: #c4c4c4 }
.grid line { stroke: #ebebeb }
.zero { stroke: #9a9a9a }
.station { stroke: #b5b5b5; stroke-width: 0.7; stroke-dasharray: 2 2.5 }
.polygon { fill: #efefef; stroke: #a8a8a8 }
.clearance { fill: none; stroke: #8a8a8a; stroke-width: 0.8; stroke-dasharray: 1.5 2.5 }
.obstacle { fill: #6e6e6e; stroke: #6e6e6e; stroke-width: 2.4; stroke-linecap: round }
.shadow { fill: none; stroke: #cfcfcf; stroke-width: 1.4 }
.curve { fill: none; stroke: #0072b2; stroke-width: 2.2; stroke-linejoin: round; stroke-linecap: round }
.tooth { fill: none; stroke: #d55e00; stroke-width: 0.6; stroke-opacity: 0.55 }
.kappa { fill: none; stroke: #d55e00; stroke-width: 1.4; stroke-linejoin: round }
.envelope { fill: none; stroke: #d55e00; stroke-width: 1; stroke-linejoin: round }
.torsion { fill: none; stroke: #009e73; stroke-width: 1.4; stroke-linejoin: round }
.fixed { fill: #1a1a1a; stroke: #fff; stroke-width: 1.2 }
.free { fill: #fff; stroke: #1a1a1a; stroke-width: 1.4 }
.slide { stroke: #1a1a1a; stroke-width: 1; stroke-dasharray: 4 3 }
.ring { fill: none; stroke: #1a1a1a; stroke-width: 1 }
.tangent { stroke: #1a1a1a; stroke-width: 1.3; stroke-linecap: round }
";

/// The picture as an SVG file.
pub(crate) fn svg(picture: &Picture<'_>) -> String {
    let each = (1200 / picture.elements.len().max(1)).clamp(4, 240);
    let trace = Trace::new(picture.elements, each + 1);
    let view = View::of(&trace);
    let mut page = Page::default();

    let mut y = MARGIN + 14.0;
    page.text("title", [MARGIN, y], Anchor::Start, picture.title);
    for line in picture.figures {
        y += 18.0;
        page.text("figures", [MARGIN, y], Anchor::Start, line);
    }
    y += 24.0;
    let steepest = steepest(&trace);
    y = legend(&mut page, y, picture, steepest);

    // One left edge for all panels: the widest label of the plots decides.
    let plots = plot::plots(&trace);
    let widest = plots.iter().map(plot::Plot::label_width).fold(0.0, f64::max);
    let widest = widest.max(shape::label_width(picture, &trace, view, steepest));
    let left = MARGIN + widest + 8.0;

    y = shape::draw(&mut page, picture, &trace, view, steepest, [left, WIDTH - MARGIN], y + 24.0);
    let stations = stations(picture, &trace);
    for (index, plot) in plots.iter().enumerate() {
        let (first, last) = (index == 0, index + 1 == plots.len());
        y = plot.draw(&mut page, [left, WIDTH - MARGIN], y + 46.0, &stations, first, last);
    }
    page.finish([WIDTH, y + MARGIN], picture.title, STYLE)
}

/// The largest curvature, or `None` of a straight line.
fn steepest(trace: &Trace) -> Option<f64> {
    let largest =
        trace.samples.iter().map(|sample| sample.kappa.abs()).filter(|k| k.is_finite()).fold(0.0, f64::max);
    (largest * trace.length() > STRAIGHT).then_some(largest)
}

/// The joints' arc lengths and names; a closed curve's first joint comes again at the end.
fn stations<'a>(picture: &Picture<'a>, trace: &Trace) -> Vec<(f64, &'a str)> {
    let at = |mark: &'a Mark| Some((*trace.starts.get(mark.element)?, mark.name.as_str()));
    let again =
        picture.joints.first().filter(|_| picture.closed).map(|mark| (trace.length(), mark.name.as_str()));
    picture.joints.iter().filter_map(at).chain(again).collect()
}

/// The key to what this picture shows, on as many lines as it needs; gives the last line's height.
fn legend(page: &mut Page, mut y: f64, picture: &Picture<'_>, steepest: Option<f64>) -> f64 {
    const GAP: f64 = 15.0;
    const SYMBOL: f64 = 24.0;
    let joints = picture.joints;
    let comb = steepest.map(|kappa| format!("curvature comb, longest tooth {}", figure(kappa, 4)));
    let items = [
        (true, "curve", "curve".to_owned()),
        (comb.is_some(), "comb", comb.unwrap_or_default()),
        (joints.iter().any(|mark| mark.fixed), "fixed", "fixed point".to_owned()),
        (joints.iter().any(|mark| !mark.fixed && mark.slide.is_none()), "free", "free point".to_owned()),
        (joints.iter().any(|mark| mark.slide.is_some()), "slide", "sliding point".to_owned()),
        (joints.iter().any(|mark| mark.tangent != [false; 2]), "tangent", "fixed tangent".to_owned()),
        (joints.iter().any(|mark| mark.curvature), "ring", "fixed curvature".to_owned()),
        (!picture.polygons.is_empty(), "polygon", "keep clear".to_owned()),
        (!picture.obstacles.is_empty(), "obstacle", "obstacle, its clearance dotted".to_owned()),
    ];
    let mut x = MARGIN;
    for (_, symbol, text) in items.iter().filter(|(shown, ..)| *shown) {
        let size = SYMBOL + width(text, LABEL);
        if x > MARGIN && x + size > WIDTH - MARGIN {
            (x, y) = (MARGIN, y + 17.0);
        }
        let middle = [x + 8.0, y - 3.6];
        let [left, right] = [[x, middle[1]], [x + 16.0, middle[1]]];
        match *symbol {
            "curve" => page.line("curve", left, right),
            "comb" => {
                page.line("envelope", [x, y - 9.0], [x + 16.0, y - 9.0]);
                for tooth in 0..5 {
                    let x = x + 4.0 * f64::from(tooth);
                    page.line("tooth", [x, y - 9.0], [x, y + 1.0]);
                }
            }
            "tangent" => page.line("tangent", left, right),
            "slide" => {
                page.line("slide", [x - 1.0, middle[1]], [x + 17.0, middle[1]]);
                page.circle("free", middle, DOT);
            }
            "ring" => {
                page.circle("ring", middle, RING);
                page.circle("fixed", middle, DOT);
            }
            "polygon" => page.rectangle("polygon", [x, y - 8.5], [16.0, 10.0]),
            "obstacle" => {
                page.line("clearance", [x, y - 8.5], [x + 16.0, y - 8.5]);
                page.line("obstacle", left, right);
                page.line("clearance", [x, y + 1.3], [x + 16.0, y + 1.3]);
            }
            class => page.circle(class, middle, DOT),
        }
        page.text("", [x + SYMBOL - 2.0, y], Anchor::Start, text);
        x += size + GAP;
    }
    y
}

const DOT: f64 = 4.0;
const RING: f64 = 7.0;
