//! A quantity against the arc length.

use super::scale::{Axis, range};
use super::solved::Solved;
use super::svg::{Anchor, Page, Spot};

/// A line of a plot: places and values; `None` breaks it.
#[derive(Clone, Debug)]
pub(super) struct Line {
    class: &'static str,
    /// CSS of its own, empty for that of the class.
    style: String,
    points: Vec<Option<Spot>>,
}

impl Line {
    pub(super) fn new(class: &'static str, points: Vec<Option<Spot>>) -> Self {
        Self { class, style: String::new(), points }
    }

    /// The curvature; of a planar curve signed.
    pub(super) fn curvature(class: &'static str, curve: &Solved) -> Self {
        let points = curve.samples().iter().map(|p| Some([p.arc_length, p.signed_curvature])).collect();
        Self::new(class, points)
    }

    /// The torsion, where the curve bends enough to have one.
    pub(super) fn torsion(class: &'static str, curve: &Solved) -> Self {
        let least = 0.03 * curve.steepest();
        let points = curve.samples().into_iter().map(|p| {
            let bends = p.signed_curvature.abs() > least;
            bends.then_some([p.arc_length, p.torsion])
        });
        Self::new(class, points.collect())
    }

    /// The same line in a colour of its own.
    pub(super) fn of_colour(self, colour: &str) -> Self {
        Self { style: format!("stroke:{colour}"), ..self }
    }

    fn each(&self) -> impl Iterator<Item = Spot> {
        self.points.iter().flatten().copied()
    }
}

/// A panel of lines.
#[derive(Clone, Debug)]
pub(super) struct Plot {
    /// What is up.
    pub(super) up: &'static str,
    /// What is to the right.
    pub(super) along: &'static str,
    pub(super) lines: Vec<Line>,
    /// Where dashed uprights mark the joints.
    pub(super) stations: Vec<f64>,
    /// The ranges along and up, or `None` for those of the lines.
    pub(super) along_range: Option<[f64; 2]>,
    pub(super) up_range: Option<[f64; 2]>,
}

impl Plot {
    pub(super) fn new(up: &'static str, lines: Vec<Line>) -> Self {
        Self { up, along: "arc length s", lines, stations: Vec::new(), along_range: None, up_range: None }
    }

    /// The same plot with the joints of a curve marked.
    pub(super) fn with_joints(self, curve: &Solved) -> Self {
        let stations = curve.joint_places().iter().map(|place| place.arc_length).collect();
        Self { stations, ..self }
    }

    /// The ranges along and up that hold every line.
    pub(super) fn ranges(&self) -> [[f64; 2]; 2] {
        let most = self.lines.iter().flat_map(Line::each).map(|[x, _]| x).fold(0.0, f64::max);
        [[0.0, most], range(self.lines.iter().flat_map(Line::each).map(|[_, y]| y))]
    }

    /// Draws the panel at a corner in a size that its labels, 46 left and 36 below, are part of.
    pub(super) fn draw(&self, page: &mut Page, corner: Spot, size: Spot) {
        let (left, right) = (corner[0] + 46.0, corner[0] + size[0] - 8.0);
        let (top, bottom) = (corner[1] + 20.0, corner[1] + size[1] - 36.0);
        let [along, up] = self.ranges();
        let x = Axis { data: self.along_range.unwrap_or(along), page: [left, right] };
        let y = Axis { data: self.up_range.unwrap_or(up), page: [bottom, top] };
        for (value, label) in x.ticks(70.0) {
            let at = x.place(value);
            page.line("grid", [at, top], [at, bottom]);
            page.text("", [at, bottom + 14.0], Anchor::Middle, &label);
        }
        for (value, label) in y.ticks(28.0) {
            let at = y.place(value);
            page.line("grid", [left, at], [right, at]);
            page.text("", [left - 6.0, at + 3.6], Anchor::End, &label);
        }
        for s in &self.stations {
            page.line("station", [x.place(*s), top], [x.place(*s), bottom]);
        }
        if y.data[0] <= 0.0 && y.data[1] >= 0.0 {
            page.line("zero", [left, y.place(0.0)], [right, y.place(0.0)]);
        }
        page.rectangle("frame", [left, top], [right - left, bottom - top]);
        page.clip([left, top], [right - left, bottom - top]);
        for line in &self.lines {
            for run in line.points.split(Option::is_none) {
                let spots: Vec<Spot> =
                    run.iter().flatten().map(|[a, b]| [x.place(*a), y.place(*b)]).collect();
                page.path(line.class, &line.style, &spots, false);
            }
        }
        page.unclip();
        page.text("caption", [left, top - 6.0], Anchor::Start, self.up);
        page.text("caption", [0.5 * (left + right), bottom + 30.0], Anchor::Middle, self.along);
    }
}
