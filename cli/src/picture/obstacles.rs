//! What the curve keeps clear of: each point or segment, and around it the outline that the curve may touch.

use super::page::{Page, Path};
use super::shape::Panel;
use crate::constraints::PlacedObstacle;
use crate::trace::{Trace, Vector, add, cross, norm, scale};
use minvar::curve::Obstacle;

/// A point as it is drawn.
const POINT: f64 = 1.6;

/// Corners of half a circle of an outline.
const HALF: usize = 32;

/// The points at the clearance around an obstacle, once around; none without a clearance.
pub(super) fn outline(obstacle: &Obstacle, trace: &Trace) -> Vec<Vector> {
    let Obstacle { from, to, clearance, .. } = *obstacle;
    if clearance <= 0.0 {
        return Vec::new();
    }
    let normal = trace.normal.unwrap_or([0.0, 0.0, 1.0]);
    let step = add(to, -1.0, from);
    let along = if norm(step) > 0.0 {
        scale(1.0 / norm(step), step)
    } else {
        // Any direction in the plane.
        let least = (0..3).fold(0, |least, d| if normal[d].abs() < normal[least].abs() { d } else { least });
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        let along = cross(normal, axis);
        scale(1.0 / norm(along), along)
    };
    let across = cross(normal, along);
    let half = |centre: Vector, sign: f64| {
        (0..=HALF).map(move |k| {
            let (sin, cos) = (std::f64::consts::PI * k as f64 / HALF as f64).sin_cos();
            let radius = add(scale(sin, along), -cos, across);
            add(centre, sign * clearance, radius)
        })
    };
    half(to, 1.0).chain(half(from, -1.0)).collect()
}

/// Draws the obstacles.
pub(super) fn draw(page: &mut Page, obstacles: &[PlacedObstacle], trace: &Trace, panel: &Panel) {
    for PlacedObstacle { shape, .. } in obstacles {
        let outline = outline(shape, trace);
        let mut path = Path::polyline(outline.iter().map(|point| panel.spot(*point)));
        if !outline.is_empty() {
            path.close();
        }
        page.path("clearance", &path);
        let [from, to] = [shape.from, shape.to].map(|point| panel.spot(point));
        if shape.from == shape.to {
            page.circle("obstacle", from, POINT);
        } else {
            page.line("obstacle", from, to);
        }
    }
}
