//! Curves in their true proportions: with curvature combs, what was given at the joints, and what is in the way.

use super::marks;
use super::room;
use super::scale::{Axis, round_step, ticks};
use super::solved::Solved;
use super::svg::{Anchor, Page, Spot};
use super::view::{Bounds, Vector, View, add};
use minvar::curve::CurvePoint;

/// One curve of a panel.
#[derive(Clone, Debug)]
pub(super) struct Stroke<'a> {
    pub(super) curve: &'a Solved,
    pub(super) class: &'static str,
    /// CSS of its own, empty for that of the class.
    pub(super) style: String,
    /// The comb's teeth are the curvature times this; 0 for none.
    pub(super) comb: f64,
}

impl<'a> Stroke<'a> {
    pub(super) fn new(curve: &'a Solved, class: &'static str, comb: f64) -> Self {
        Self { curve, class, style: String::new(), comb }
    }

    /// Teeth stand on the outside of the bend, where they do not cross.
    fn tip(&self, place: &CurvePoint) -> Vector {
        add(place.point, -self.comb, place.curvature)
    }
}

/// A panel of curves.
#[derive(Clone, Debug)]
pub(super) struct Shape<'a> {
    pub(super) view: View,
    pub(super) strokes: Vec<Stroke<'a>>,
    /// The curve whose joints are marked.
    pub(super) marked: Option<&'a Solved>,
    /// Closed polygons drawn behind.
    pub(super) solids: Vec<Vec<Vector>>,
    /// Points that the panel must hold as well.
    pub(super) also: Vec<Vector>,
}

impl<'a> Shape<'a> {
    /// The curves, and the joints of the first one.
    pub(super) fn new(view: View, strokes: Vec<Stroke<'a>>) -> Self {
        let marked = strokes.first().map(|stroke| stroke.curve);
        Self { view, strokes, marked, solids: Vec::new(), also: Vec::new() }
    }

    /// All that the panel must hold.
    pub(super) fn content(&self) -> Vec<Vector> {
        let of_stroke = |stroke: &Stroke<'_>| {
            let samples = stroke.curve.samples();
            samples.iter().flat_map(|place| [place.point, stroke.tip(place)]).collect::<Vec<_>>()
        };
        let drawn = self.strokes.iter().flat_map(of_stroke);
        drawn.chain(self.solids.iter().flatten().copied()).chain(self.also.iter().copied()).collect()
    }

    /// Draws the panel at a corner in a size that its labels, 46 left and 36 below, are part of.
    pub(super) fn draw(&self, page: &mut Page, corner: Spot, size: Spot) {
        let (left, right) = (corner[0] + 46.0, corner[0] + size[0] - 8.0);
        let (top, bottom) = (corner[1] + 20.0, corner[1] + size[1] - 36.0);
        let content = self.content();
        let rooms = Bounds::of(content.iter().copied());
        let seen = match self.view {
            View::Room => Bounds::of(room::corners(&rooms).map(|point| self.view.project(point))),
            _ => Bounds::of(content.iter().map(|point| self.view.project(*point))),
        };
        let pad = if self.view == View::Room { 24.0 } else { 16.0 };
        let inside = [right - left - 2.0 * pad, bottom - top - 2.0 * pad];
        let zoom = (inside[0] / seen.size()[0]).min(inside[1] / seen.size()[1]);
        let axis = |d: usize, page: [f64; 2]| {
            let middle = 0.5 * (seen.low[d] + seen.high[d]);
            let half = 0.5 * (page[1] - page[0]).abs() / zoom;
            Axis { data: [middle - half, middle + half], page }
        };
        let (u, v) = (axis(0, [left, right]), axis(1, [bottom, top]));
        let spot = |point: Vector| {
            let [a, b] = self.view.project(point);
            [u.place(a), v.place(b)]
        };
        if self.view == View::Room {
            room::draw(page, &rooms, round_step(44.0 / zoom), &spot);
            for stroke in &self.strokes {
                let floor = |place: &CurvePoint| spot([place.point[0], place.point[1], rooms.low[2]]);
                let spots: Vec<Spot> = stroke.curve.samples().iter().map(floor).collect();
                page.path("shadow", "", &spots, false);
            }
        } else {
            let step = round_step(56.0 / zoom);
            for (value, label) in ticks(u.data, step) {
                let at = u.place(value);
                page.line("grid", [at, top], [at, bottom]);
                page.text("", [at, bottom + 14.0], Anchor::Middle, &label);
            }
            for (value, label) in ticks(v.data, step) {
                let at = v.place(value);
                page.line("grid", [left, at], [right, at]);
                page.text("", [left - 6.0, at + 3.6], Anchor::End, &label);
            }
            page.rectangle("frame", [left, top], [right - left, bottom - top]);
            let [along, up] = self.view.names();
            page.text("caption", [left, top - 6.0], Anchor::Start, up);
            page.text("caption", [0.5 * (left + right), bottom + 30.0], Anchor::Middle, along);
        }
        page.clip([left, top], [right - left, bottom - top]);
        for solid in &self.solids {
            page.path("solid", "", &solid.iter().map(|point| spot(*point)).collect::<Vec<_>>(), true);
        }
        for stroke in self.strokes.iter().filter(|stroke| stroke.comb > 0.0) {
            comb(page, stroke, zoom, &spot);
        }
        for stroke in &self.strokes {
            let spots: Vec<Spot> = stroke.curve.samples().iter().map(|place| spot(place.point)).collect();
            page.path(stroke.class, &stroke.style, &spots, false);
        }
        page.unclip();
        if let Some(marked) = self.marked {
            marks::draw(page, marked, zoom, &spot);
        }
    }
}

/// Teeth at equal distances, and the line through their tips.
fn comb(page: &mut Page, stroke: &Stroke<'_>, zoom: f64, spot: &impl Fn(Vector) -> Spot) {
    const SPACING: f64 = 5.0;
    let class = format!("comb-{}", stroke.class);
    let length = stroke.curve.samples().last().map_or(0.0, |place| place.arc_length);
    let count = (length * zoom / SPACING).clamp(30.0, 300.0) as usize;
    let tooth = |place: &CurvePoint| [spot(place.point), spot(stroke.tip(place))];
    page.teeth(&class, &stroke.curve.evenly(count).iter().map(tooth).collect::<Vec<_>>());
    let tips: Vec<Spot> = stroke.curve.samples().iter().map(|place| spot(stroke.tip(place))).collect();
    page.path(&class, "stroke-width:1;stroke-opacity:1", &tips, false);
}
