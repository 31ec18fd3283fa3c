//! What was given at the joints: points, tangents, curvatures; and the keys to a figure.

use super::solved::Solved;
use super::svg::{Anchor, Page, Spot, width};
use super::view::{Vector, add};
use minvar::curve::Given;

const DOT: f64 = 3.6;
const RING: f64 = 6.4;

/// The joints of a curve.
pub(super) fn draw(page: &mut Page, curve: &Solved, zoom: f64, spot: &impl Fn(Vector) -> Spot) {
    const HALF: f64 = 17.0;
    let last = curve.joints.len() - 1;
    for (i, (joint, place)) in curve.joints.iter().zip(curve.joint_places()).enumerate() {
        let ends =
            [add(place.point, -HALF / zoom, place.tangent), add(place.point, HALF / zoom, place.tangent)];
        if joint.tangent.iter().any(|tangent| tangent.given == Given::FIXED) {
            page.line("tangent", spot(ends[0]), spot(ends[1]));
        }
        let at = spot(place.point);
        // The side that the curve does not have is not read.
        let [arriving, leaving] = joint.curvature.map(|curvature| curvature.given == Given::FIXED);
        let open = !curve.closed;
        if (arriving && !(open && i == 0)) || (leaving && !(open && i == last)) {
            page.circle("ring", at, RING);
        }
        let fixed = joint.position.given == Given::FIXED;
        page.circle(if fixed { "fixed" } else { "free" }, at, DOT);
    }
}

/// A line of keys to classes of lines and marks.
pub(super) fn legend(page: &mut Page, left: f64, y: f64, items: &[(&str, &str)]) {
    let mut x = left;
    for (class, text) in items {
        let middle = [x + 11.0, y - 3.6];
        match *class {
            "fixed" | "free" => page.circle(class, middle, DOT),
            "ring" => {
                page.circle("ring", middle, RING);
                page.circle("fixed", middle, DOT);
            }
            "solid" => page.rectangle("solid", [x, y - 8.5], [22.0, 10.0]),
            "comb" => {
                let teeth: Vec<[Spot; 2]> = (0..5)
                    .map(|k| x + 1.0 + 5.0 * f64::from(k))
                    .map(|x| [[x, y - 9.0], [x, y + 1.0]])
                    .collect();
                page.teeth("comb-a", &teeth);
                page.line("comb-a", [x, y - 9.0], [x + 22.0, y - 9.0]);
            }
            class if class.starts_with('#') => {
                let style = format!("stroke:{class}");
                page.path("shade", &style, &[[x, middle[1]], [x + 22.0, middle[1]]], false);
            }
            class => page.path(class, "", &[[x, middle[1]], [x + 22.0, middle[1]]], false),
        }
        page.text("name", [x + 27.0, y], Anchor::Start, text);
        x += 27.0 + 1.06 * width(text) + 20.0;
    }
}
