//! The shape: curve, comb, joints, polygons and obstacles in their true proportions.

use super::page::{Anchor, Page, Path, Spot, width};
use super::scale::{Axis, Ticks, round_step};
use super::view::View;
use super::{LABEL, Picture, joints, obstacles};
use crate::trace::{Sample, Trace, Vector, add, norm};
use minvar::curve::Element;

const LEAST_HEIGHT: f64 = 170.0;
const MOST_HEIGHT: f64 = 520.0;
const SPACING: f64 = 85.0;
/// The longest tooth, as a part of the curve's diagonal.
const TOOTH: f64 = 0.2;

/// A box of data, on the page or in space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds<const D: usize> {
    low: [f64; D],
    high: [f64; D],
}

impl<const D: usize> Bounds<D> {
    const EMPTY: Self = Self { low: [f64::INFINITY; D], high: [f64::NEG_INFINITY; D] };

    fn of(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    fn with(mut self, point: [f64; D]) -> Self {
        for d in 0..D {
            self.low[d] = self.low[d].min(point[d]);
            self.high[d] = self.high[d].max(point[d]);
        }
        self
    }

    fn size(&self) -> [f64; D] {
        std::array::from_fn(|d| self.high[d] - self.low[d])
    }

    fn diagonal(&self) -> f64 {
        self.size().iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}

/// The panel: how data become places on the page.
pub(super) struct Panel {
    view: View,
    u: Axis,
    v: Axis,
    /// Page units per unit of length.
    pub(super) zoom: f64,
    /// The upper left corner and the size.
    pub(super) corner: Spot,
    pub(super) size: Spot,
    /// Data between two grid lines, in every direction.
    step: f64,
    /// The room in which a space curve is drawn.
    room: Bounds<3>,
}

impl Panel {
    fn new(content: &[Vector], view: View, [left, right]: [f64; 2], top: f64) -> Self {
        let pad = match view {
            View::Plane(_) => [26.0, 26.0],
            View::Space => [64.0, 34.0],
        };
        let inside = [right - left - 2.0 * pad[0], MOST_HEIGHT - 2.0 * pad[1]];
        let fit = |bounds: &Bounds<2>| {
            let [du, dv] = bounds.size();
            let far = bounds.low.iter().chain(&bounds.high).fold(0.0_f64, |far, x| far.max(x.abs()));
            if du.max(dv) > 1e-12 * far {
                (inside[0] / du).min(inside[1] / dv)
            } else {
                // All in one point: show as much as it is far away.
                inside[1] / if far > 0.0 && far.is_finite() { far } else { 1.0 }
            }
        };
        let room = Bounds::of(content.iter().copied());
        let mut bounds = Bounds::of(content.iter().map(|point| view.project(*point)));
        let mut zoom = fit(&bounds);
        let mut step = round_step(SPACING / zoom);
        if view == View::Space {
            bounds = Bounds::of(corners(&room).map(|corner| view.project(corner)));
            zoom = fit(&bounds);
            step = round_step(0.5 * SPACING / zoom);
        }
        let size = [right - left, (bounds.size()[1] * zoom + 2.0 * pad[1]).max(LEAST_HEIGHT)];
        let axis = |d: usize, from: f64, to: f64| {
            let middle = 0.5 * (bounds.low[d] + bounds.high[d]);
            let half = 0.5 * size[d] / zoom;
            Axis::new(middle - half, middle + half, from, to)
        };
        let (u, v) = (axis(0, left, right), axis(1, top + size[1], top));
        Self { view, u, v, zoom, corner: [left, top], size, step, room }
    }

    pub(super) fn spot(&self, point: Vector) -> Spot {
        let [u, v] = self.view.project(point);
        [self.u.place(u), self.v.place(v)]
    }

    fn ticks(&self, axis: &Axis) -> Ticks {
        Ticks::new(axis.low, axis.high, self.step)
    }
}

fn corners(room: &Bounds<3>) -> [Vector; 8] {
    std::array::from_fn(|i| std::array::from_fn(|d| if i >> d & 1 == 0 { room.low[d] } else { room.high[d] }))
}

/// The width of the widest label at the left edge.
pub(super) fn label_width(picture: &Picture<'_>, trace: &Trace, view: View, steepest: Option<f64>) -> f64 {
    if view == View::Space {
        return 0.0;
    }
    let panel = Panel::new(&content(picture, trace, &comb(trace, steepest)), view, [72.0, 772.0], 0.0);
    let ticks = panel.ticks(&panel.v);
    ticks.values.iter().map(|value| width(&ticks.label(*value), LABEL)).fold(0.0, f64::max)
}

/// The tips of the comb's teeth at the samples; none of a straight line. Teeth stand on the outside of the bend, where they
/// do not cross.
fn comb(trace: &Trace, steepest: Option<f64>) -> Vec<Vector> {
    let Some(factor) = tooth_factor(trace, steepest) else { return Vec::new() };
    trace.samples.iter().map(|sample| add(sample.point, -factor, sample.curvature)).collect()
}

fn tooth_factor(trace: &Trace, steepest: Option<f64>) -> Option<f64> {
    let diagonal = Bounds::of(trace.samples.iter().map(|sample| sample.point)).diagonal();
    Some(TOOTH * diagonal / steepest?).filter(|factor| factor.is_finite())
}

/// All that must be on the picture.
fn content(picture: &Picture<'_>, trace: &Trace, tips: &[Vector]) -> Vec<Vector> {
    let points = trace.samples.iter().map(|sample| sample.point);
    let polygons = picture.polygons.iter().flatten().copied();
    let obstacles = picture.obstacles.iter().flat_map(|obstacle| {
        [obstacle.shape.from, obstacle.shape.to].into_iter().chain(obstacles::outline(&obstacle.shape, trace))
    });
    let finite = |p: &Vector| p.iter().all(|x| x.is_finite());
    points.chain(tips.iter().copied()).chain(polygons).chain(obstacles).filter(finite).collect()
}

/// Draws the panel between `left` and `right` with its upper edge at `top` and gives its lower end.
pub(super) fn draw(
    page: &mut Page,
    picture: &Picture<'_>,
    trace: &Trace,
    view: View,
    steepest: Option<f64>,
    [left, right]: [f64; 2],
    top: f64,
) -> f64 {
    let tips = comb(trace, steepest);
    let top = if view == View::Space { top - 8.0 } else { top };
    let panel = Panel::new(&content(picture, trace, &tips), view, [left, right], top);
    let lower = match view.names() {
        Some(names) => frame(page, &panel, names),
        None => room(page, &panel, trace),
    };

    for polygon in picture.polygons {
        let mut path = Path::polyline(polygon.iter().map(|point| panel.spot(*point)));
        path.close();
        page.path("polygon", &path);
    }
    obstacles::draw(page, picture.obstacles, trace, &panel);
    if let Some(factor) = tooth_factor(trace, steepest) {
        teeth(page, picture, trace, &panel, factor);
        for run in trace.samples.iter().zip(&tips).collect::<Vec<_>>().chunk_by(|(a, _), (b, _)| {
            // Where the curve has a corner the envelope breaks.
            a.element == b.element || norm(add(a.tangent, -1.0, b.tangent)) < 1e-3
        }) {
            page.path("envelope", &Path::polyline(run.iter().map(|(_, tip)| panel.spot(**tip))));
        }
    }
    page.path("curve", &curve(picture, &panel));
    joints::draw(page, picture, trace, &panel, &tips);
    lower
}

/// Grid, frame and labels of a planar curve.
fn frame(page: &mut Page, panel: &Panel, names: [&str; 2]) -> f64 {
    let [left, top] = panel.corner;
    let (right, bottom) = (left + panel.size[0], top + panel.size[1]);
    let (u_ticks, v_ticks) = (panel.ticks(&panel.u), panel.ticks(&panel.v));
    page.open("grid", None);
    for value in &u_ticks.values {
        let at = panel.u.place(*value);
        page.line("", [at, top], [at, bottom]);
    }
    for value in &v_ticks.values {
        let at = panel.v.place(*value);
        page.line("", [left, at], [right, at]);
    }
    page.close();
    page.rectangle("frame", panel.corner, panel.size);
    let mut free_from = f64::NEG_INFINITY;
    for value in &u_ticks.values {
        let (at, label) = (panel.u.place(*value), u_ticks.label(*value));
        let half = 0.5 * width(&label, LABEL);
        if at - half > free_from {
            page.text("", [at, bottom + 15.0], Anchor::Middle, &label);
            free_from = at + half + 6.0;
        }
    }
    for value in &v_ticks.values {
        page.text("", [left - 6.0, panel.v.place(*value) + 3.6], Anchor::End, &v_ticks.label(*value));
    }
    let caption = |name: &str, ticks: &Ticks| format!("{name}{}", ticks.factor());
    page.text("caption", [left, top - 7.0], Anchor::Start, &caption(names[1], &v_ticks));
    page.text("caption", [0.5 * (left + right), bottom + 32.0], Anchor::Middle, &caption(names[0], &u_ticks));
    bottom + 32.0
}

/// Floor, two walls, labels and shadow of a space curve.
fn room(page: &mut Page, panel: &Panel, trace: &Trace) -> f64 {
    let Bounds { low, high } = panel.room;
    let ticks: [Ticks; 3] = std::array::from_fn(|d| Ticks::new(low[d], high[d], panel.step));
    // The three faces that the viewer sees from inside, by the coordinate that is constant and its value.
    let faces = [(2, low[2]), (0, low[0]), (1, high[1])];
    for (fixed, value) in faces {
        let (a, b) = ((fixed + 1) % 3, (fixed + 2) % 3);
        let at = |x: f64, y: f64| {
            let mut point = [value; 3];
            (point[a], point[b]) = (x, y);
            panel.spot(point)
        };
        page.open("grid", None);
        for x in &ticks[a].values {
            page.line("", at(*x, low[b]), at(*x, high[b]));
        }
        for y in &ticks[b].values {
            page.line("", at(low[a], *y), at(high[a], *y));
        }
        page.close();
        let edges = [at(low[a], low[b]), at(high[a], low[b]), at(high[a], high[b]), at(low[a], high[b])];
        let mut outline = Path::polyline(edges);
        outline.close();
        page.path("frame", &outline);
    }

    let label = |page: &mut Page, d: usize, at: &dyn Fn(f64) -> Vector, offset: Spot, anchor: Anchor| {
        for value in &ticks[d].values {
            let [x, y] = panel.spot(at(*value));
            page.text("", [x + offset[0], y + offset[1]], anchor, &ticks[d].label(*value));
        }
    };
    label(page, 0, &|x| [x, low[1], low[2]], [-4.0, 14.0], Anchor::End);
    label(page, 1, &|y| [high[0], y, low[2]], [4.0, 14.0], Anchor::Start);
    label(page, 2, &|z| [low[0], low[1], z], [-7.0, 3.0], Anchor::End);
    let middle = |d: usize| 0.5 * (low[d] + high[d]);
    let caption = |d: usize| format!("{}{}", ["x", "y", "z"][d], ticks[d].factor());
    let [x, y] = panel.spot([middle(0), low[1], low[2]]);
    page.text("caption", [x - 34.0, y + 30.0], Anchor::End, &caption(0));
    let [x, y] = panel.spot([high[0], middle(1), low[2]]);
    page.text("caption", [x + 34.0, y + 30.0], Anchor::Start, &caption(1));
    let [x, y] = panel.spot([low[0], low[1], high[2]]);
    page.text("caption", [x - 7.0, y - 12.0], Anchor::End, &caption(2));

    let floor = |sample: &Sample| panel.spot([sample.point[0], sample.point[1], low[2]]);
    page.path("shadow", &Path::polyline(trace.samples.iter().map(floor)));
    panel.corner[1] + panel.size[1]
}

/// Teeth evenly spaced along the arc.
fn teeth(page: &mut Page, picture: &Picture<'_>, trace: &Trace, panel: &Panel, factor: f64) {
    const SPACING: f64 = 5.0;
    let count = (trace.length() * panel.zoom / SPACING).clamp(30.0, 400.0) as usize;
    page.open("comb", None);
    let mut next = 0;
    for k in 0..=count {
        let s = trace.length() * k as f64 / count as f64;
        while next + 1 < trace.samples.len() && trace.samples[next].s < s {
            next += 1;
        }
        let (before, after) = (&trace.samples[next.saturating_sub(1)], &trace.samples[next]);
        // The same sample, or neighbours on either side of a joint, are at the place itself.
        let part =
            if after.s > before.s { ((s - before.s) / (after.s - before.s)).clamp(0.0, 1.0) } else { 1.0 };
        let from = if before.element == after.element { before.t } else { 0.0 };
        let t = from + part * (after.t - from);
        let sample = trace.sample_at(&picture.elements[after.element], t);
        let tip = add(sample.point, -factor, sample.curvature);
        page.line("tooth", panel.spot(sample.point), panel.spot(tip));
    }
    page.close();
}

/// The curve as cubic Bézier pieces, each within a twentieth of a page unit of the quintic.
fn curve(picture: &Picture<'_>, panel: &Panel) -> Path {
    let mut path = Path::default();
    let mut end: Option<Spot> = None;
    for element in picture.elements {
        let start = panel.spot(element.point(0.0));
        if end.is_none_or(|end| (end[0] - start[0]).hypot(end[1] - start[1]) > 0.05) {
            path.start(start);
        }
        let pieces =
            [1, 2, 4, 8, 16, 32].into_iter().find(|pieces| deviation(element, *pieces, panel) < 0.05);
        let pieces = pieces.unwrap_or(64);
        for piece in 0..pieces {
            let [_, a, b, d] = cubic(element, piece, pieces).map(|point| panel.spot(point));
            path.cubic(a, b, d);
        }
        end = Some(panel.spot(element.point(1.0)));
    }
    if picture.closed {
        path.close();
    }
    path
}

/// The control points of the cubic with the same ends and end derivatives as one of `pieces` equal pieces.
fn cubic(element: &Element, piece: usize, pieces: usize) -> [Vector; 4] {
    let h = 1.0 / pieces as f64;
    let [p, dp, ..] = element.derivatives(piece as f64 * h);
    let [q, dq, ..] = element.derivatives((piece + 1) as f64 * h);
    [p, add(p, h / 3.0, dp), add(q, -h / 3.0, dq), q]
}

/// How far the cubic pieces are from the element on the page, at equal parameters.
fn deviation(element: &Element, pieces: usize, panel: &Panel) -> f64 {
    let mut largest = 0.0_f64;
    for piece in 0..pieces {
        let points = cubic(element, piece, pieces);
        for x in [0.2, 0.35, 0.5, 0.65, 0.8] {
            let y = 1.0 - x;
            let weights = [y * y * y, 3.0 * x * y * y, 3.0 * x * x * y, x * x * x];
            let sum =
                points.iter().zip(weights).fold([0.0; 3], |sum, (point, weight)| add(sum, weight, *point));
            let t = (piece as f64 + x) / pieces as f64;
            largest = largest.max(norm(add(sum, -1.0, element.point(t))) * panel.zoom);
        }
    }
    largest
}
