//! Markers of the joints, and their names where they cover least.

use super::page::{Anchor, Page, Spot, width};
use super::shape::Panel;
use super::{DOT, Mark, Picture, RING, Slide};
use crate::trace::{Sample, Trace, Vector, add, cross, norm, scale};

/// More joints than this have no names.
const MOST_NAMES: usize = 60;

/// So far the line on which a joint slides is drawn to either side.
const WAY: f64 = 44.0;

/// The unit vectors along which a joint may slide; in a planar curve's plane those that lie in it.
fn directions(slide: &Slide, plane: Option<Vector>) -> Vec<Vector> {
    let unit = |v: Vector| {
        // Of any size but zero: no square may overflow.
        let most = v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let v = scale(1.0 / most, v);
        scale(1.0 / norm(v), v)
    };
    match slide {
        Slide::Line(direction) => vec![unit(*direction)],
        Slide::Plane(normal) => {
            let normal = unit(*normal);
            if let Some(plane) = plane {
                let along = cross(plane, normal);
                if norm(along) > 1e-9 {
                    return vec![unit(along)];
                }
            }
            let least =
                (0..3).fold(0, |least, d| if normal[d].abs() < normal[least].abs() { d } else { least });
            let mut axis = [0.0; 3];
            axis[least] = 1.0;
            let first = unit(cross(normal, axis));
            vec![first, cross(normal, first)]
        }
    }
}

/// Markers and names of the joints.
pub(super) fn draw(page: &mut Page, picture: &Picture<'_>, trace: &Trace, panel: &Panel, tips: &[Vector]) {
    const HALF: f64 = 19.0;
    let per_element = trace.samples.len() / picture.elements.len().max(1);
    let sides = |mark: &Mark| {
        let leaving = trace.samples.get(mark.element * per_element);
        let before = match mark.element {
            0 if picture.closed => trace.samples.last(),
            0 => None,
            element => trace.samples.get(element * per_element - 1),
        };
        [before, leaving]
    };
    let shown = |mark: &Mark| sides(mark).into_iter().flatten().next().map(|sample| panel.spot(sample.point));

    let paths: Vec<[Spot; 2]> = picture
        .joints
        .iter()
        .filter_map(|mark| Some((sides(mark).into_iter().flatten().next()?.point, mark.slide.as_ref()?)))
        .flat_map(|(point, slide)| {
            directions(slide, trace.normal)
                .into_iter()
                .map(move |along| [-WAY, WAY].map(|way| panel.spot(add(point, way / panel.zoom, along))))
        })
        .collect();
    if !paths.is_empty() {
        page.clip("clip-shape", panel.corner, panel.size);
        page.open("slides", Some("clip-shape"));
        for [from, to] in &paths {
            page.line("slide", *from, *to);
        }
        page.close();
    }
    for mark in picture.joints {
        let given = sides(mark);
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            // At an open end the tick goes on beyond the curve.
            let other = given[1 - side];
            let Some(sample) = given[side].or(other) else { continue };
            let fixed = if given[side].is_some() { mark.tangent[side] } else { mark.tangent[1 - side] };
            if fixed {
                let beyond = add(sample.point, sign / panel.zoom, sample.tangent);
                let (from, to) = (panel.spot(sample.point), panel.spot(beyond));
                let end = [from[0] + HALF * (to[0] - from[0]), from[1] + HALF * (to[1] - from[1])];
                page.line("tangent", from, end);
            }
        }
    }
    for mark in picture.joints {
        if let Some(spot) = shown(mark) {
            if mark.curvature {
                page.circle("ring", spot, RING);
            }
            page.circle(if mark.fixed { "fixed" } else { "free" }, spot, DOT);
        }
    }
    if picture.joints.len() > MOST_NAMES {
        return;
    }
    let mut taken: Vec<[f64; 4]> = Vec::new();
    let mut ink: Vec<Spot> = trace.samples.iter().map(|sample| panel.spot(sample.point)).collect();
    for (tip, sample) in tips.iter().zip(&trace.samples) {
        let tooth = add(*tip, -1.0, sample.point);
        ink.extend([0.1, 0.3, 0.5, 1.0].map(|part| panel.spot(add(sample.point, part, tooth))));
    }
    for [from, to] in &paths {
        ink.extend((0..=44).map(|k| [0, 1].map(|d| from[d] + f64::from(k) / 44.0 * (to[d] - from[d]))));
    }
    let dots: Vec<Spot> = picture.joints.iter().filter_map(shown).collect();
    for mark in picture.joints {
        let Some(spot) = shown(mark) else { continue };
        let bends = |a: &&Sample, b: &&Sample| a.kappa.abs().total_cmp(&b.kappa.abs());
        let inward = sides(mark).into_iter().flatten().max_by(bends).map_or([0.0; 2], |sample| {
            let [x, y] = panel.spot(add(sample.point, 1.0, sample.curvature));
            let (x, y) = (x - spot[0], y - spot[1]);
            let length = x.hypot(y);
            if length > 0.0 { [x / length, y / length] } else { [0.0; 2] }
        });
        let (at, anchor, area) = name_place(&mark.name, spot, inward, &ink, &dots, &taken, panel);
        page.text("name", at, anchor, &mark.name);
        taken.push(area);
    }
}

/// Where a name covers least: the eight directions in turn, the hollow side of the curve preferred.
fn name_place(
    name: &str,
    spot: Spot,
    inward: Spot,
    ink: &[Spot],
    dots: &[Spot],
    taken: &[[f64; 4]],
    panel: &Panel,
) -> (Spot, Anchor, [f64; 4]) {
    const AWAY: f64 = 11.0;
    const SIZE: f64 = 11.5;
    const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let directions = [[D, -D], [-D, -D], [D, D], [-D, D], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0]];
    let [left, top] = panel.corner;
    let [right, bottom] = [left + panel.size[0], top + panel.size[1]];
    let candidates = directions.map(|[dx, dy]| {
        let w = width(name, SIZE);
        let x = spot[0] + AWAY * dx;
        let middle = spot[1] + AWAY * dy + 0.45 * SIZE * dy;
        let (anchor, low) = match dx {
            dx if dx > 0.1 => (Anchor::Start, x),
            dx if dx < -0.1 => (Anchor::End, x - w),
            _ => (Anchor::Middle, x - 0.5 * w),
        };
        let area = [low, middle - 0.5 * SIZE, low + w, middle + 0.5 * SIZE];
        let inside = |p: &&Spot| {
            p[0] > area[0] - 2.0 && p[0] < area[2] + 2.0 && p[1] > area[1] - 2.0 && p[1] < area[3] + 2.0
        };
        let overlaps = |other: &&[f64; 4]| {
            area[0] < other[2] && other[0] < area[2] && area[1] < other[3] && other[1] < area[3]
        };
        let off = area[0] < left || area[2] > right || area[1] < top || area[3] > bottom;
        let cost = 4.0 * ink.iter().filter(inside).count() as f64
            + 300.0 * dots.iter().filter(inside).count() as f64
            + 1000.0 * taken.iter().filter(overlaps).count() as f64
            + if off { 2000.0 } else { 0.0 }
            - 3.0 * (inward[0] * dx + inward[1] * dy);
        (cost, ([x, middle + 0.36 * SIZE], anchor, area))
    });
    let first = candidates[0];
    candidates.into_iter().skip(1).fold(first, |best, next| if next.0 < best.0 { next } else { best }).1
}
