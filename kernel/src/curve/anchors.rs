//! What holds a curve of which nothing is fixed.
//!
//! A scale-invariant functional of such a curve does not change when the whole is moved, turned or scaled, nor, but for
//! what quintics are coarser than curves, when its joints slide along it. Written in any coordinates these motions are
//! bent, and away from a minimum a bent motion without effect looks like a negative curvature of the functional: steps
//! would follow it instead of the shape. So two joints hold the curve. First they stand with their tangents, and the
//! others move only across: what is left is the shape alone. Then all joints slide, one after the other and with the
//! whole, whose steps leave the two in their places.
//!
//! Of a circle two tangents are tied to the chord between them, and a closed curve that turns round, of which nothing
//! is fixed, becomes one. So only a planar curve is held that in all does not turn, like a figure-8.

use super::fairness::{Density, Shape};
use super::joint::{Curve, Given, Joint, Quantity};
use super::model::Model;
use super::natural::angle;
use super::options::Options;
use core::f64::consts::PI;

/// The first joint, and the one farthest from it, where nothing holds a curve that does not turn in all.
pub(super) fn anchors<const D: usize>(
    model: &Model<'_, D>,
    options: &Options,
    state: &[f64],
) -> Option<[usize; 2]>
where
    Shape<D>: Density<D>,
{
    let found = farthest(&model.curve, options)?;
    if D != 2 || !model.curve.closed {
        return None;
    }
    let mut turning = 0.0;
    for element in 0..model.element_count() {
        let ends = [model.end(element, 0, state), model.end(element, 1, state)];
        let chord = ends[1].point - ends[0].point;
        turning += angle(&ends[0].frame[0], &chord) + angle(&chord, &ends[1].frame[0]);
    }
    (turning.abs() < PI).then_some(found)
}

/// Two joints that are far from each other where nothing of a curve is fixed, nor its size.
fn farthest(curve: &Curve<'_>, options: &Options) -> Option<[usize; 2]> {
    let keeps_size = options.functional.length_power() == 0 || options.length > 0.0;
    if keeps_size || curve.reference.is_some() || !curve.obstacles.is_empty() {
        return None;
    }
    let free = |quantity: &Quantity| matches!(quantity.given, Given::FREE | Given::INITIAL);
    let loose = |joint: &Joint| {
        free(&joint.position) && joint.tangent.iter().all(free) && joint.curvature.iter().all(free)
    };
    let [first, rest @ ..] = curve.joints else { return None };
    if first.position.given != Given::INITIAL || !loose(first) || !rest.iter().all(loose) {
        return None;
    }
    let mut found = (0, 0.0);
    for (k, joint) in rest.iter().enumerate().filter(|(_, joint)| joint.position.given == Given::INITIAL) {
        let mut square = 0.0;
        for d in 0..3 {
            let step = joint.position.value[d] - first.position.value[d];
            square += step * step;
        }
        if square > found.1 {
            found = (k + 1, square);
        }
    }
    (found.0 > 0).then_some([0, found.0])
}
