//! The room in which a space curve is seen: floor and back walls with a grid, and numbers along three edges.

use super::scale::ticks;
use super::svg::{Anchor, Page, Spot};
use super::view::{Bounds, Vector};

/// The corners of a box.
pub(super) fn corners(room: &Bounds<3>) -> [Vector; 8] {
    std::array::from_fn(|i| std::array::from_fn(|d| if i >> d & 1 == 0 { room.low[d] } else { room.high[d] }))
}

pub(super) fn draw(page: &mut Page, room: &Bounds<3>, step: f64, spot: &impl Fn(Vector) -> Spot) {
    let Bounds { low, high } = *room;
    let ticks: [Vec<(f64, String)>; 3] = std::array::from_fn(|d| ticks([low[d], high[d]], step));
    // The three faces that the viewer sees from inside, by the coordinate that is constant and its value.
    for (fixed, value) in [(2, low[2]), (0, low[0]), (1, high[1])] {
        let (a, b) = ((fixed + 1) % 3, (fixed + 2) % 3);
        let at = |x: f64, y: f64| {
            let mut point = [value; 3];
            (point[a], point[b]) = (x, y);
            spot(point)
        };
        for (x, _) in &ticks[a] {
            page.line("grid", at(*x, low[b]), at(*x, high[b]));
        }
        for (y, _) in &ticks[b] {
            page.line("grid", at(low[a], *y), at(high[a], *y));
        }
        let edges = [at(low[a], low[b]), at(high[a], low[b]), at(high[a], high[b]), at(low[a], high[b])];
        page.path("frame", "", &edges, true);
    }
    let mut edge = |d: usize, name: &str, offset: Spot, anchor: Anchor, at: &dyn Fn(f64) -> Vector| {
        for (value, label) in &ticks[d] {
            let [x, y] = spot(at(*value));
            page.text("", [x + offset[0], y + offset[1]], anchor, label);
        }
        let [x, y] = spot(at(0.5 * (low[d] + high[d])));
        page.text("caption", [x + 4.5 * offset[0], y + 2.4 * offset[1]], anchor, name);
    };
    edge(0, "x", [-3.0, 15.0], Anchor::End, &|x| [x, low[1], low[2]]);
    edge(1, "y", [5.0, 11.0], Anchor::Start, &|y| [high[0], y, low[2]]);
    edge(2, "z", [-7.0, 3.0], Anchor::End, &|z| [low[0], low[1], z]);
}
